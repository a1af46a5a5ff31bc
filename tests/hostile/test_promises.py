"""Each promise of the documents stands there and names a test that there is."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

import pytest
from sweep import together

ROOT = Path(__file__).parents[2]
ROWS = [
    line for line in (ROOT / "docs" / "security.md").read_text("utf-8").splitlines()
    if line.startswith("| ")
][1:]  # fmt: skip


PROMISES = tomllib.loads((ROOT / "tests" / "promises.toml").read_text("utf-8"))


def find_missing(file: str, test: str) -> list[str]:
    """What is named and is not there: a test, or any test of a file."""
    tree = ast.parse((ROOT / file).read_text("utf-8"))
    there = {one.name for one in ast.walk(tree) if isinstance(one, ast.FunctionDef)}
    known = test in there if test else any(name.startswith("test_") for name in there)
    return [] if known else [f"{file}::{test}"]


@pytest.mark.parametrize("row", ROWS)
def test_a_promise_of_security_names_tests_that_there_are(row):
    named = re.findall(r"`(tests/[^`:]+\.py)(?:::(\w+))?`", row)
    assert named
    assert not [one for file, test in named for one in find_missing(file, test)]


@together(("page", "rows"), PROMISES.items())
def test_a_promise_stands_on_its_page_and_names_tests_that_there_are(page, rows):
    text = (ROOT / ("" if page == "README.md" else "docs") / page).read_text("utf-8")
    words = " ".join(text.split())
    for says, *tests in rows:
        assert says in words
        assert tests
        for file, _, test in (named.partition("::") for named in tests):
            assert not find_missing(f"tests/{file}", test)
