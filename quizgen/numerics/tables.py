"""Numbers that formulas are made of: data, computed or measured.

``tables.json`` is what ``tests/numerics/make_coefficients.py`` prints. ``cie.json`` has luminous
efficiencies every 5 nm from CIE 018, Tables 1 and 2: the photopic observer of 1924 from 360 to
830 nm and the scotopic one of 1951 from 380 to 780 nm (facts of the standards; cross-checked
against colour-science 0.4.7, whose 1 nm values sum to 106.856917101 and 97.071316574).
"""

from __future__ import annotations

import json
from importlib.resources import files
from typing import Any

Row = tuple[float, ...]


def read_numeric_table(name: str) -> dict[str, Any]:
    """Return the content of a JSON file in this folder, such as ``cie.json``."""
    found: dict[str, Any] = json.loads((files(__package__) / name).read_text("utf-8"))
    return found


_FOUND = read_numeric_table("tables.json")
MILLS_SHIFT: float = _FOUND["mills_shift"]
MILLS_SCALE: float = _FOUND["mills_scale"]
MILLS: Row = tuple(_FOUND["mills"])
"""Shaped Mills ratio, powers of t."""
