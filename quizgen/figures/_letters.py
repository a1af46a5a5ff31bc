"""Labels as outlines: letters in italics, digits and units upright, primes and subscripts.

Outlines were taken once from the STIX fonts and lie packed beside this module, made by
``tools/pack_letters.py`` under the licence of ``letters-licence.txt``: a label costs a few
additions and is the same whatever is installed. Curves are cubic, as PDF has them.

The markup is tiny: ``p'_y = 6 {mm}``. A letter outside braces is italic, ``'`` is a prime,
``_`` lowers the next character (or a group in braces), braces set upright.
"""

from __future__ import annotations

import re
import sys
from array import array
from collections.abc import Sequence
from functools import cache, lru_cache
from pathlib import Path
from typing import NamedTuple

from msgspec import msgpack

Point = tuple[float, float]

PACKED = Path(__file__).with_name("letters.msgpack")
UNITS = 6400.0
"""Steps of the packed outlines in the size of a letter."""
SUBSCRIPT = 0.76
"""Size of a subscript; 7.6 pt beside 10 pt letters."""

_TOKEN = re.compile(r"(?P<text>\{[^}]*\}|.)(?P<prime>'*)(?:_(?P<sub>\{[^}]*\}|.))?", re.DOTALL)


class Outline(NamedTuple):
    """A letter: points in units of its size, drawing codes, and its width."""

    points: Sequence[Point]
    codes: bytes
    width: float


class Packed(NamedTuple):
    """A letter as it is packed: its width, and its points as 16-bit numbers with their codes."""

    width: float
    points: bytes
    codes: bytes


@cache
def _packed() -> tuple[dict[str, Packed], dict[str, Packed]]:
    """Upright and italic letters."""
    letters = tuple[dict[str, Packed], dict[str, Packed]]
    return msgpack.decode(PACKED.read_bytes(), type=letters)


@cache
def glyph(character: str, italic: bool) -> Outline:
    """A letter from where it starts on its baseline."""
    found = _packed()[italic].get(character)
    if found is None:
        raise LookupError(f"no glyph for {character!r}")
    steps = array("h", found.points)
    if sys.byteorder == "big":
        steps.byteswap()
    ways = iter([step / UNITS for step in steps])
    return Outline(list(zip(ways, ways, strict=True)), found.codes, found.width)


class Run(NamedTuple):
    """Characters of one style on one line: where they start, their size and how wide they are."""

    text: str
    italic: bool
    at: tuple[float, float]
    size: float
    width: float


@lru_cache(maxsize=4096)
def runs(label: str) -> tuple[tuple[Run, ...], float]:
    """Lay out a label at size 1 with its baseline starting at the origin.

    Parameters
    ----------
    label : str
        Text in the markup of this module.

    Returns
    -------
    tuple of Run, float
        And the advance width of the whole.
    """
    found: list[Run] = []
    x = 0.0
    for token in _TOKEN.finditer(label):
        x = _token(found, token, x)
    return tuple(found), x


def width(label: str) -> float:
    """Advance width of a label at size 1."""
    return runs(label)[1]


def _token(found: list[Run], token: re.Match[str], x: float) -> float:
    x = _run(found, token["text"], x, 1.0, 0.0)
    above = _run(found, "′" * len(token["prime"]), x, 1.0, 0.0)
    below = _run(found, token["sub"] or "", x, SUBSCRIPT, -0.2)
    return max(above, below)


def _run(found: list[Run], text: str, x: float, size: float, rise: float) -> float:
    upright = text.startswith("{")
    for character in text.strip("{}"):
        italic = character.isalpha() and not upright
        wide = glyph(character, italic=italic).width * size
        found.append(Run(character, italic, (x, rise), size, wide))
        x += wide
    return x
