"""A class made by the command, the same whenever a test runs."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

import pytest

from quizgen.classes import generation
from quizgen.cli.main import main

BLUEPRINT = """
total = 12
minutes = [8, 20]
[title]
en = "A short test"
bn = "ছোট পরীক্ষা"
[[slot]]
templates = ["normalise-from-8-bit-range"]
[[slot]]
templates = ["exposure-equivalence"]
[[slot]]
templates = ["blur-and-light-factors"]
"""


def run(*arguments: object) -> int:
    """The exit code of a command."""
    try:
        main([str(one) for one in arguments])
    except SystemExit as ended:
        return int(ended.code or 0)
    return 0


def made(root: Path, students: Iterable[tuple[str, str, str]]) -> Path:
    """The folder of a class with papers for students: id, name, language."""
    (root / "short.toml").write_text(BLUEPRINT, "utf-8")
    with (root / "roster.csv").open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream).writerows([("id", "name", "lang"), *students])
    wished = ("--blueprint", root / "short.toml", "--out", root / "class", "--jobs", 1)
    with pytest.MonkeyPatch.context() as same:
        same.setattr(generation, "new_secret", lambda: "5" * 32)
        assert run("class", "make", root / "roster.csv", *wished) == 0
    return root / "class"
