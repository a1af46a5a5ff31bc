"""A bank of one template and its solver, in a folder of its own."""

from __future__ import annotations

import shutil
from pathlib import Path

from quizgen.bank.bank import builtin_bank

NAME = "point-to-image-plane"


def own_bank(root: Path) -> None:
    """Copy the template, its solver and the formulas below a root."""
    shutil.copytree(builtin_bank().template_paths[NAME], root / "templates" / "projection" / NAME)
    (root / "templates" / "cards").mkdir()
    shutil.copy(builtin_bank().cards["formulas"], root / "templates" / "cards")
    solver = "solvers/projection/perspective.py"
    (root / solver).parent.mkdir(parents=True)
    shutil.copy(builtin_bank().root / solver, root / solver)
