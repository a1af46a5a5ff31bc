"""Kept drawings of the built-in figures, one element a line, so that a change is read in a diff."""

from __future__ import annotations

import re
from pathlib import Path

from figure_cases import REFERENCE, draw

FOLDER = Path(__file__).parents[1] / "snapshots" / "figures"


def write_snapshot(name):
    """The reference instance of a figure as its solution shows it, an element a line."""
    figure = draw(name, REFERENCE[name], quiz=False, lang="en")
    return re.sub(r"(?<=>)(?=<)", "\n", figure.inline_svg.decode()) + "\n"
