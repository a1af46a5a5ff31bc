"""The closed list of units: SI lengths and times, light, and the units of imaging.

A unit is a product of powers of base units times an exact factor, so ``um/px``, ``lx*s`` and
``mm^2`` work without a units library. Names that are not listed are refused, never guessed
(a units library reads ``6 EV`` as exavolt and ``5.6 MP`` as megapoise).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache

from flint import fmpq

from quizgen.errors import FormulaError
from quizgen.maths.numbers import rational

Dimension = tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit: how it is written, its exact factor to base units, and its dimension."""

    text: str
    factor: Fraction
    dimension: Dimension


PREFIXES = {
    "n": Fraction(1, 10**9),
    "u": Fraction(1, 10**6),
    "µ": Fraction(1, 10**6),
    "μ": Fraction(1, 10**6),
    "m": Fraction(1, 10**3),
    "c": Fraction(1, 10**2),
    "d": Fraction(1, 10),
    "k": Fraction(10**3),
    "M": Fraction(10**6),
    "G": Fraction(10**9),
}

_PREFIXED = {
    # unit: (base, factor, prefixes allowed)
    "m": ("m", 1, "nuµμmcdkM"),
    "s": ("s", 1, "nuµμm"),
    "Hz": ("Hz", 1, "kMG"),
    "W": ("W", 1, "uµμmk"),
    "eV": ("eV", 1, "mkM"),
    "lm": ("lm", 1, "mk"),
    "lx": ("lx", 1, "mk"),
    "px": ("px", 1, "kM"),
    "bit": ("bit", 1, "kMG"),
    "B": ("bit", 8, "kMG"),
}

_PLAIN = {
    "": ("", Fraction(1)),
    "1": ("", Fraction(1)),
    "%": ("", Fraction(1, 100)),
    "deg": ("deg", Fraction(1)),
    "°": ("deg", Fraction(1)),
    "stop": ("stop", Fraction(1)),
    "EV": ("stop", Fraction(1)),
    "dB": ("dB", Fraction(1)),
    "DN": ("DN", Fraction(1)),
    "e-": ("e-", Fraction(1)),
    "photon": ("photon", Fraction(1)),
    "row": ("row", Fraction(1)),
    "frame": ("frame", Fraction(1)),
    "lp": ("lp", Fraction(1)),
    "KiB": ("bit", Fraction(8 * 2**10)),
    "MiB": ("bit", Fraction(8 * 2**20)),
    "GiB": ("bit", Fraction(8 * 2**30)),
}


_MADE_OF = {"lx": (("lm", 1), ("m", -2)), "Hz": (("s", -1),)}
"""Units with a name of their own for a product of others."""


def _simple_units() -> dict[str, tuple[str, Fraction]]:
    table = dict(_PLAIN)
    for name, (base, factor, prefixes) in _PREFIXED.items():
        table[name] = (base, Fraction(factor))
        table.update({p + name: (base, factor * PREFIXES[p]) for p in prefixes})
    return table


SIMPLE = _simple_units()
"""Every simple unit: written name to (base unit, exact factor)."""

_PART = re.compile(r"(?P<op>[*/·]?)(?P<name>e-|[^*/·^]+)(?:\^(?P<power>-?\d))?")


@cache
def unit(text: str) -> Unit:
    """Look a unit up.

    Parameters
    ----------
    text : str
        A listed name, or a product such as ``um/px`` or ``lx*s``.

    Raises
    ------
    FormulaError
        If a name is not in the list.
    """
    compact = text.replace(" ", "")
    factor, powers = Fraction(1), dict[str, int]()
    position = 0
    while position < len(compact):
        match = _PART.match(compact, position)
        if match is None or match["name"] not in SIMPLE:
            raise FormulaError(f"unknown unit {text!r}", position + 1)
        name, size = SIMPLE[match["name"]]
        power = int(match["power"] or 1) * (-1 if match["op"] == "/" else 1)
        factor *= size**power
        for base, times in _MADE_OF.get(name, ((name, 1),)):
            powers[base] = powers.get(base, 0) + power * times
        position = match.end()
    powers.pop("", None)
    return Unit(text, factor, tuple(sorted((b, p) for b, p in powers.items() if p)))


@cache
def factor(text: str) -> fmpq:
    """Exact factor from a unit to base units: 1/1000 for ``mm``.

    Raises
    ------
    FormulaError
        If a name is not in the list.
    """
    return rational(unit(text).factor)


SHOWN = {"um": "µm", "deg": "°", "us": "µs", "uW": "µW", "e-": "e⁻"}


@lru_cache(maxsize=1024)
def shown(text: str) -> str:
    """How a unit is printed: ``um/px`` becomes ``µm/px``, ``1/mm`` becomes ``mm⁻¹``.

    The unit of a pure number prints as nothing.
    """
    if text == "1":
        return ""
    if text.startswith("1/") and text.count("/") == 1:
        return f"{shown(text[2:])}⁻¹"
    return "/".join(SHOWN.get(part, part) for part in text.split("/"))
