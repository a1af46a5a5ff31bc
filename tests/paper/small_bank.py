"""A bank of one template in a folder of its own, whose files a test may change."""

from __future__ import annotations

import shutil
from pathlib import Path

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.paper.blueprint import Blueprint, SlotRule

NAME = "point-to-image-plane"
ONE = Blueprint({"en": "One"}, (SlotRule(templates=(NAME,)),), name="one")


def copied(root: Path) -> Path:
    """Copy the template and its solver below a root; return the template's folder."""
    source = builtin_bank().template_paths[NAME]
    folder = root / "templates" / source.parent.name / NAME
    shutil.copytree(source, folder)
    solver = f"{builtin_bank().rules(NAME).solver}.py"
    target = root / "solvers" / solver
    target.parent.mkdir(parents=True)
    (root / "solvers" / "__init__.py").touch()
    (target.parent / "__init__.py").touch()
    shutil.copy(builtin_bank().root / "solvers" / solver, target)
    return folder


def fresh(root: Path) -> Bank:
    """The bank as its files stand now."""
    return Bank(root, trusted=True)
