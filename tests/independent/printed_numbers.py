"""Numbers, quantities and points as they stand in a printed text, exact and in base units."""

from __future__ import annotations

import re
from fractions import Fraction

MILLI, MICRO, NANO = Fraction(1, 10**3), Fraction(1, 10**6), Fraction(1, 10**9)
UNITS = {
    "nm": NANO, "µm": MICRO, "um": MICRO, "mm": MILLI, "cm": Fraction(1, 100), "m": Fraction(1),
    "km": Fraction(1000), "s": Fraction(1), "ms": MILLI, "µs": MICRO, "us": MICRO,
    "px": Fraction(1), "Mpx": Fraction(10**6), "µm/px": MICRO, "px/s": Fraction(1),
    "m/s": Fraction(1), "km/h": Fraction(10, 36), "mW": MILLI, "W": Fraction(1),
    "mW/nm": MILLI / NANO, "lm": Fraction(1), "lm/W": Fraction(1), "dB": Fraction(1),
    "%": Fraction(1, 100), "°": Fraction(1), "B": Fraction(1), "bit": Fraction(1),
    "MiB": Fraction(2**20), "MB": Fraction(10**6), "kB": Fraction(1000), "KiB": Fraction(1024),
    "Mbit/s": Fraction(10**6), "Gbit/s": Fraction(10**9), "ms/px": MILLI, "eV": Fraction(1),
    "lp/mm": Fraction(1000), "Hz": Fraction(1), "GB": Fraction(10**9), "MB/s": Fraction(10**6),
    "": Fraction(1),
}  # fmt: skip
"""Units of the pages, in metres, seconds, watts, lumens, pixels, bytes, degrees, and bare ratios."""

RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_POWER = r"\s*[·⋅]\s*10(?:\^\(?(?P<flat>-?\d+)\)?|(?P<high>⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+))"
NUMBER = rf"(?P<top>-?\d+(?:\.\d+)?)(?:/(?P<bottom>\d+)|{_POWER})?"
UNIT = "|".join(sorted(map(re.escape, filter(None, UNITS)), key=len, reverse=True))
QUANTITY = re.compile(rf"(?<![\w.'^])(?<!\w-){NUMBER}(?:\s*(?P<unit>{UNIT})(?![A-Za-z/]))?")
APERTURE = re.compile(r"(?<!\w)f/(\d+(?:\.\d+)?)")


def _value(found: re.Match[str]) -> Fraction:
    value = Fraction(found["top"]) / Fraction(found["bottom"] or 1)
    power = found["flat"] or (found["high"] or "0").translate(RAISED)
    return value * Fraction(10) ** int(power)


def quantities(text: str) -> list[tuple[Fraction, str]]:
    """All numbers of a text in order, each in base units and with the unit that stands there."""
    found = QUANTITY.finditer(APERTURE.sub("", text))
    return [(_value(one) * UNITS[one["unit"] or ""], one["unit"] or "") for one in found]


def numbers(text: str) -> list[Fraction]:
    """All numbers of a text in order, as they stand there."""
    return [_value(one) for one in QUANTITY.finditer(APERTURE.sub("", text))]


def named(text: str, name: str) -> Fraction:
    """What stands behind ``name =``; the text must not name two values."""
    behind = re.findall(rf"(?<![\w'^/]){re.escape(name)}\s*=\s*(?=(.{{1,40}}))", text)
    values = {quantities(one)[0][0] for one in behind if QUANTITY.match(one)}
    assert len(values) == 1, f"{name} is {values or 'not given'} in: {text}"
    return values.pop()


def points(text: str) -> list[tuple[Fraction, ...]]:
    """All groups of numbers in round brackets, in base units."""
    groups = re.findall(r"\(([^()]*)\)", text)
    cells = [[quantities(cell) for cell in re.split("[;,]", group)] for group in groups]
    return [tuple(cell[0][0] for cell in row) for row in cells if len(row) > 1 and all(row)]


def point(text: str, name: str) -> tuple[Fraction, ...]:
    """The numbers of ``name = (...)``."""
    (group,) = set(re.findall(rf"(?<![\w']){re.escape(name)}\s*=\s*(\([^()]*\))", text))
    return points(group)[0]
