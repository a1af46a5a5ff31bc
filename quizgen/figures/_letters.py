"""Labels as outlines: letters in italics, digits and units upright, primes and subscripts.

Outlines are taken from the fonts that ship with matplotlib and kept, so a label costs a few
additions; matplotlib's own text layout costs about 1 ms a label, its mathematics several.

The markup is tiny: ``p'_y = 6 {mm}``. A letter outside braces is italic, ``'`` is a prime,
``_`` lowers the next character (or a group in braces), braces set upright.
"""

from __future__ import annotations

import re
from functools import cache, lru_cache
from pathlib import Path as File
from threading import Lock
from typing import NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.ft2font import FT2Font, LoadFlags
from numpy.typing import NDArray

_EM = 100.0
SUBSCRIPT = 0.76
"""Size of a subscript; 7.6 pt beside 10 pt letters."""

_TOKEN = re.compile(r"(?P<text>\{[^}]*\}|.)(?P<prime>'*)(?:_(?P<sub>\{[^}]*\}|.))?", re.DOTALL)


class Outline(NamedTuple):
    """A laid-out label: points in units of its size, drawing codes, and its width."""

    points: NDArray[np.float64]
    codes: NDArray[np.uint8]
    width: float


_FONT = Lock()
"""A font holds the letter that it was asked for last."""


@cache
def _font(italic: bool) -> FT2Font:
    name = "STIXGeneralItalic.ttf" if italic else "STIXGeneral.ttf"
    font = FT2Font(str(File(mpl.get_data_path()) / "fonts" / "ttf" / name))
    font.set_size(_EM, 72)
    return font


@cache
def _glyph(character: str, italic: bool) -> Outline:
    with _FONT:
        font = _font(italic)
        if not font.get_char_index(ord(character)):
            raise LookupError(f"no glyph for {character!r}")
        glyph = font.load_char(ord(character), flags=LoadFlags.NO_HINTING)
        points, codes = font.get_path()
    return Outline(points / _EM, codes.astype(np.uint8), glyph.linearHoriAdvance / 65536 / _EM)


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
        wide = _glyph(character, italic=italic).width * size
        found.append(Run(character, italic, (x, rise), size, wide))
        x += wide
    return x


@lru_cache(maxsize=4096)
def outline(label: str) -> Outline:
    """A label as ``runs`` lays it out: one compound path, and its advance width."""
    laid, wide = runs(label)
    glyphs = [_glyph(run.text, italic=run.italic) for run in laid]
    points = [glyph.points * run.size + run.at for glyph, run in zip(glyphs, laid, strict=True)]
    return Outline(np.concatenate(points), np.concatenate([one.codes for one in glyphs]), wide)
