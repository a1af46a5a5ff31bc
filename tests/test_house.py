"""Files and functions stay short enough to be read at once; numbers have types."""

from __future__ import annotations

import ast
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import measure  # noqa: E402

FILES = [p for folder in ("quizgen", "solvers") for p in sorted((ROOT / folder).rglob("*.py"))]


@cache
def tree(path):
    return ast.parse(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_no_long_file_and_no_long_function(path):
    assert path.read_text(encoding="utf-8").count("\n") <= 400
    assert not [f.name for f in measure.functions(tree(path)) if measure.length(f) > 40]


def test_few_parameters_are_typed_any():
    found = [
        a for path in FILES for f in measure.functions(tree(path)) for a in measure.parameters(f)
    ]
    assert sum(map(measure.is_any, found)) <= 0.03 * len(found)
