"""The layouts of a package's pages: Jinja as all pages of ours use it.

Jinja compiles a layout to Python, which takes longer than to fill it in. The bytecode is kept, as
Python keeps that of modules.
"""

from __future__ import annotations

import marshal
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib.util import MAGIC_NUMBER
from pathlib import Path
from types import CodeType
from typing import TYPE_CHECKING

import jinja2
from jinja2.bccache import Bucket, BytecodeCache

from quizgen.core.cache import compute_digest, read_cached, write_cached

if TYPE_CHECKING:
    from quizgen.question.compose import QuestionPart
    from quizgen.question.solution import PartSolution

ROWS, ROWS_EACH_STEP, ROWS_EACH_POINT = 0.6, 0.75, 0.2
"""Rows of 5 mm for any calculation, for each of its steps, and for each point."""
LEAST_ROWS, MOST_ROWS = 2, 7


def count_working_rows(part: QuestionPart, solved: PartSolution) -> int:
    """Return the rows to work in: by the steps of the solution, none where it has none."""
    steps = sum(len(line.sides) > 1 or not line.sides for line in solved.lines)
    if not part.field.control.needs_working or not steps:
        return 0
    rows = ROWS + ROWS_EACH_STEP * steps + ROWS_EACH_POINT * float(part.points)
    return max(LEAST_ROWS, min(MOST_ROWS, round(rows)))


_KIND = "layouts"


class _LayoutLoader(jinja2.PackageLoader):
    """Jinja's loader of a package, which names layouts without their folder.

    So their bytecode, which holds that name, fits any machine.
    """

    def get_source(
        self, environment: jinja2.Environment, template: str
    ) -> tuple[str, str, Callable[[], bool] | None]:
        """Return source and name of a layout, and a test whether it is still the same."""
        source, _, fresh = super().get_source(environment, template)
        return source, template, fresh


class _BytecodeStore(BytecodeCache):
    """Jinja's bytecode in the cache, keyed by the layout, Jinja's settings and Python's version."""

    def get_bucket(
        self, environment: jinja2.Environment, name: str, filename: str | None, source: str
    ) -> Bucket:
        """Return the bytecode stored for a layout, or an empty bucket for it."""
        del filename
        key = compute_digest(_compute_compiler_digest(), name.encode(), source.encode())
        bucket = Bucket(environment, key, "")
        self.load_bytecode(bucket)
        return bucket

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fill a bucket from the cache, if the bytecode is there."""
        with suppress(EOFError, ValueError, TypeError):
            found = marshal.loads(read_cached(_KIND, bucket.key) or b"")  # noqa: S302 (as Python's own)
            bucket.code = found if isinstance(found, CodeType) else None

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Write a bucket's bytecode to the cache."""
        write_cached(_KIND, bucket.key, marshal.dumps(bucket.code))


@cache
def _compute_compiler_digest() -> bytes:
    """Return a digest of all that makes bytecode of a layout, besides the layout."""
    own = Path(__file__).read_bytes()
    return compute_digest(own, jinja2.__version__.encode(), MAGIC_NUMBER).encode()


def jinja_environment(*packages: str) -> jinja2.Environment:
    """Return Jinja's environment for the ``pages`` of packages.

    Texts are escaped, unknown names fail.
    """
    return jinja2.Environment(
        loader=jinja2.ChoiceLoader([_LayoutLoader(name, "pages") for name in packages]),
        bytecode_cache=_BytecodeStore(),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )


def precompile_layouts(package: str) -> None:
    """Compile all layouts of a package and store their bytecode."""
    layouts = jinja_environment(package)
    for name in layouts.list_templates(extensions=("j2",)):
        layouts.get_template(name)
