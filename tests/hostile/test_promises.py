"""Each promise of docs/security.md names a test that there is."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROWS = [
    line for line in (ROOT / "docs" / "security.md").read_text("utf-8").splitlines()
    if line.startswith("| ")
][1:]  # fmt: skip


@pytest.mark.parametrize("row", ROWS)
def test_a_promise_names_tests_that_there_are(row):
    named = re.findall(r"`(tests/[^`:]+\.py)(?:::(\w+))?`", row)
    assert named
    for file, test in named:
        tree = ast.parse((ROOT / file).read_text("utf-8"))
        there = {one.name for one in ast.walk(tree) if isinstance(one, ast.FunctionDef)}
        assert test in there if test else any(name.startswith("test_") for name in there)
