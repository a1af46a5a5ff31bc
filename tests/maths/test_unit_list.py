"""The page of units says what the table has, and sizes are those of the standards."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

from quizgen.maths.units import get_unit

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from list_units import build_page  # noqa: E402 - tools are no package


def test_the_page_of_units_is_made_from_the_table():
    assert (ROOT / "docs" / "units.md").read_text("utf-8") == build_page()


def test_sizes_are_those_of_the_brochures():
    """SI brochure, 9th edition; international yard and pound; IEC 80000-13."""
    typed = {
        "in": "0.0254",
        "mi": "1609.344",
        "lb": "0.45359237",
        "Wh": "3600",
        "KiB": "8192",
        "ha": "10000",
    }
    assert {name: get_unit(name).factor for name in typed} == {
        name: Fraction(size) for name, size in typed.items()
    }
