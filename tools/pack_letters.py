"""Pack the letters that figures are labelled with: ``uv run python tools/do.py fonts``.

Writes into ``quizgen/figures`` the outlines that FreeType gives of the STIX fonts that ship with
matplotlib, unhinted, so that no figure waits for matplotlib and none depends on its version.
These fonts have two or three quadratic curves where their designer drew one cubic, and PDF knows
cubic curves only: they are joined again, where no point of them moves by more than ``MOVED``.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.ft2font import FT2Font, LoadFlags
from msgspec import msgpack
from numpy.typing import NDArray

from quizgen.figures._letters import PACKED, UNITS, Packed

RANGES = (
    range(0x20, 0x180),  # Latin
    range(0x370, 0x400),  # Greek
    range(0x2000, 0x2150),  # punctuation, signs beside numbers, letters as signs
    range(0x2190, 0x2300),  # arrows, operators
)
SIZE = 100
FONTS = Path(mpl.get_data_path()) / "fonts" / "ttf"
QUADRATIC, CUBIC, CLOSE = 3, 4, 79
MOVED = 0.0015 * SIZE
"""How far a joined curve may be from points of those it replaces: 0.015 pt of a letter of 10 pt."""
MOST = 5
"""Quadratic curves that are tried to be one cubic."""
BEND = np.cos(np.radians(4))
"""Cosine of the largest corner between two curves that were one."""

Points = NDArray[np.float64]


def packed(name: str) -> dict[str, Packed]:
    """Every wanted letter that a font has."""
    font = FT2Font(str(FONTS / name))
    font.set_size(SIZE, 72)
    present = font.get_charmap()
    return {chr(code): letter(font, code) for span in RANGES for code in span if code in present}


def letter(font: FT2Font, code: int) -> Packed:
    """One letter, in the steps that FreeType rounds to."""
    glyph = font.load_char(code, flags=LoadFlags.NO_HINTING)
    points, codes = joined(*font.get_path())
    steps = np.round(points * (UNITS / SIZE)).astype("<i2")
    return Packed(glyph.linearHoriAdvance / 65536 / SIZE, steps.tobytes(), codes)


def joined(points: Points, codes: NDArray[Any]) -> tuple[Points, bytes]:
    """An outline with cubic curves for its quadratic ones."""
    kept, told = [np.empty((0, 2))], b""
    for piece in pieces(points, codes):
        if isinstance(piece, list):
            curves = list(cubics(piece))
            kept += [curve[1:] for curve in curves]
            told += bytes([CUBIC] * 3 * len(curves))
        else:
            kept.append(points[piece : piece + 1])
            told += bytes([codes[piece]])
    return np.concatenate(kept), told


def pieces(points: Points, codes: NDArray[Any]) -> Iterator[int | list[Points]]:
    """The places of points that no curve leads to, and the curves between them."""
    curves: list[Points] = []
    place = 0
    while place < len(codes):
        if codes[place] == QUADRATIC:
            curves.append(points[place - 1 : place + 2])
            place += 2
            continue
        if curves:
            yield curves
            curves = []
        yield place
        place += 1
    if curves:
        yield curves


def cubics(curves: list[Points]) -> Iterator[Points]:
    """Quadratic curves that follow each other as fewer cubic ones."""
    while curves:
        count, found = max(
            (
                (count, one)
                for count in range(1, MOST + 1)
                if (one := together(curves[:count])) is not None
            ),
            key=lambda pair: pair[0],
        )
        yield found
        curves = curves[count:]


def together(curves: list[Points]) -> Points | None:
    """The cubic through the ends and tangents of quadratic curves, if it is near enough."""
    if len(curves) == 1:
        first, control, last = curves[0]
        return np.array([first, (first + 2 * control) / 3, (last + 2 * control) / 3, last])
    if any(corner(*pair) for pair in pairwise(curves)):
        return None
    times = np.linspace(0, 1, 17)
    drawn = np.concatenate([quadratic(curve, times) for curve in curves])
    found, off = fitted(drawn, direction(*curves[0][:2]), direction(*curves[-1][:0:-1]))
    return found if off <= MOVED else None


def corner(one: Points, other: Points) -> bool:
    """Whether two curves meet in a corner."""
    return bool(direction(*one[1:]) @ direction(*other[:2]) < BEND)


def direction(start: Points, end: Points) -> Points:
    """From one point to another, of length 1."""
    way = end - start
    return way / max(np.hypot(*way), 1e-9)


def quadratic(curve: Points, times: Points) -> Points:
    """Points of a quadratic curve."""
    t = times[:, None]
    return (1 - t) ** 2 * curve[0] + 2 * t * (1 - t) * curve[1] + t**2 * curve[2]


def fitted(drawn: Points, away: Points, back: Points) -> tuple[Points, float]:
    """The cubic nearest to points with these tangents, and how far it is from one of them.

    Least squares for the lengths of both tangents, and Newton's step for the times of the points,
    in turn (Schneider, Graphics Gems I, 1990).
    """
    lengths = np.concatenate([[0.0], np.hypot(*np.diff(drawn, axis=0).T).cumsum()])
    times = lengths / lengths[-1]
    first, last = drawn[0], drawn[-1]
    for _ in range(8):
        t = times[:, None]
        start, end = 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t)
        rest = drawn - ((1 - t) ** 3 + start) * first - (t**3 + end) * last
        sides = np.stack([(start * away).ravel(), (end * back).ravel()], axis=1)
        ways = np.linalg.lstsq(sides, rest.ravel(), rcond=None)[0]
        curve = np.array([first, first + ways[0] * away, last + ways[1] * back, last])
        off, times = nearer(curve, drawn, times)
    sound = (ways > 0).all() and (ways < lengths[-1]).all()
    return curve, float(off.max()) if sound else np.inf


def nearer(curve: Points, drawn: Points, times: Points) -> tuple[Points, Points]:
    """How far points are from a cubic at their times, and nearer times."""
    t = times[:, None]
    ways = np.diff(curve, axis=0)
    turns = np.diff(ways, axis=0)
    at = (1 - t) ** 3 * curve[0] + 3 * t * (1 - t) ** 2 * curve[1] + 3 * t**2 * (1 - t) * curve[2]
    gap = at + t**3 * curve[3] - drawn
    slope = 3 * quadratic(ways, times)
    bend = 6 * ((1 - t) * turns[0] + t * turns[1])
    below = (slope**2).sum(axis=1) + (gap * bend).sum(axis=1)
    step = (gap * slope).sum(axis=1) / np.where(below > 0, below, np.inf)
    return np.hypot(*gap.T), np.clip(times - step, 0, 1)


def main() -> None:
    """Write the file."""
    fonts = ("STIXGeneral.ttf", "STIXGeneralItalic.ttf")
    PACKED.write_bytes(msgpack.encode([packed(name) for name in fonts]))
    print(f"{PACKED.name}: {PACKED.stat().st_size} bytes")


if __name__ == "__main__":
    main()
