"""A class of two questions, made in this process."""

from __future__ import annotations

from pathlib import Path

from quizgen.bank.bank import builtin_bank
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.generation import create_settings, generate_papers
from quizgen.classes.roster import RosterStudent
from quizgen.core.executor import InlineExecutor
from quizgen.paper.blueprint import Blueprint, load_blueprint
from quizgen.paper.paper import silent

TWO = """
[title]
en = "Two"
[[slot]]
templates = ["point-to-image-plane"]
[[slot]]
templates = ["rods-cones-and-peaks"]
"""


def blueprint(folder: Path) -> Blueprint:
    """A short one, as a file."""
    path = folder / "two.toml"
    path.write_text(TWO, encoding="utf-8")
    return load_blueprint(str(path))


def begun(folder: Path, students: list[RosterStudent]) -> tuple[ClassFolder, Blueprint]:
    """A folder with a secret and no papers."""
    plan = blueprint(folder)
    made = ClassFolder(folder / "class")
    made.create(create_settings("class", builtin_bank(), plan, "en"), students)
    return made, plan


def with_papers(folder: ClassFolder, plan: Blueprint, students: list[RosterStudent], executor=None):
    """What ``make`` reports."""
    return generate_papers(folder, students, plan, executor or InlineExecutor(), 2, silent)


def bytes_of(folder: Path) -> dict[str, bytes]:
    """Every file of a folder."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}
