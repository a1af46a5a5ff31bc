"""Numbers have types, and what nobody calls goes."""

from __future__ import annotations

import ast
import re
import sys
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import measure  # noqa: E402

FILES = [
    p
    for folder in ("quizgen", "solvers", "templates")
    for p in sorted((ROOT / folder).rglob("*.py"))
    if p.name != "_build_hook.py"  # hatchling calls it
]


@cache
def tree(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def test_few_parameters_are_typed_any():
    found = [
        a for path in FILES for f in measure.functions(tree(path)) for a in measure.parameters(f)
    ]
    assert sum(map(measure.is_any, found)) <= 0.03 * len(found)


CALLED_FROM_OUTSIDE = {"list_commands", "get_command", "format_commands", "get_code"} | {
    "get_source", "get_bucket", "load_bytecode", "dump_bytecode", "reset_ticks", "draw_markers",
    "get_canvas_width_height", "points_to_pixels", "option_image_nocomposite",
    "option_scale_image", "draw_gouraud_triangles", "is_defined",
}  # fmt: skip
"""Methods that click looks for in a group, Python in a loader, Jinja in a loader or a cache, and
matplotlib in an axis or a renderer; ``is_defined`` is for those who compute with our arrays."""


def _names(node) -> list[str]:
    """The names that a piece of syntax uses: of things, of fields, or as a text (``getattr``)."""
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name) | ast.keyword(arg=str(name)):
            return [name]
        case ast.Constant(value=str(text)):
            return re.findall(r"\w+", text)
    return []


def used_in(node) -> set[str]:
    """All names of a module but those of its docstrings, which would hide what nobody calls."""
    docs = {id(n.value) for n in ast.walk(node) if isinstance(n, ast.Expr)}
    return {name for n in ast.walk(node) if id(n) not in docs for name in _names(n)}


def test_every_public_function_has_a_caller_in_the_product():
    product = [path for path in FILES if not path.is_relative_to(ROOT / "solvers")]
    used = set(CALLED_FROM_OUTSIDE).union(*(used_in(tree(path)) for path in product))
    for page in (ROOT / "quizgen").rglob("*.j2"):
        used |= set(re.findall(r"\w+", page.read_text(encoding="utf-8")))
    idle = [
        f"{path.relative_to(ROOT)}: {function.name}"
        for path in product
        for function in measure.functions(tree(path))
        if not function.name.startswith("_") and function.name not in used
    ]
    assert not idle


def test_no_two_test_files_have_one_name():
    """pytest collects only one of them."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(names) == sorted(set(names))


def test_a_type_is_described_by_one_thread_at_a_time():
    """msgspec crashes where two begin together: whoever asks it has ``core.decoding`` prepare it."""
    asks = re.compile(
        r"msgspec\.convert\b|msgspec\.\w+\.Decoder\b|msgspec\.\w+\.decode\([^)]*type="
    )
    described = re.compile(r"^ +prepare_type\(", re.MULTILINE)
    sources = {path: path.read_text(encoding="utf-8") for path in FILES}
    asking = [path for path, source in sources.items() if asks.search(source)]
    assert [path for path in asking if not described.search(sources[path])] == []
