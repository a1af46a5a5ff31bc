"""Bayer mosaic: one letter per site, its raw value, the marked site and the sites used for it.

Red sites carry rising strokes, blue sites falling ones, green sites none, so the mosaic reads
without colour. Edge neighbours point with full arrows, diagonal neighbours with dashed ones.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from matplotlib.path import Path

from quizgen.figures.kit import (
    ABSENT,
    Parameter,
    Values,
    format_derived,
    format_given,
    load_alt_words,
    relation_sign,
    require,
)

from ._optics import draw_lines

LARGEST = 8
PATTERNS = ("RGGB", "BGGR", "GRBG", "GBRG")

PARAMETERS = {
    "phase": Parameter("", "pattern: 0 RGGB, 1 BGGR, 2 GRBG, 3 GBRG", 0.0, 0.0, 3.0, whole=True),
    "size": Parameter("px", "rows and columns of the tile", 4.0, 3.0, 8.0, whole=True),
    "x": Parameter(
        "px", "column of the marked site, from 0 at the left", 1.0, 0.0, 7.0, whole=True
    ),
    "y": Parameter("px", "row of the marked site, from 0 at the top", 1.0, 0.0, 7.0, whole=True),
    "channel": Parameter(
        "",
        "missing colour to show: 1 red, 2 green, 3 blue, 0 both missing ones",
        0.0,
        0.0,
        3.0,
        whole=True,
    ),
    "left": Parameter("px", "even column that the tile begins with", ABSENT, 0.0, 1e5, whole=True),
    "top": Parameter("px", "even row that the tile begins with", ABSENT, 0.0, 1e5, whole=True),
} | {
    f"v{y}{x}": Parameter("DN", f"raw value in row {y}, column {x}", ABSENT, 0.0, 99999.0)
    for y in range(LARGEST)
    for x in range(LARGEST)
}
SIZE = (200.0, 200.0)

_EDGES = ((0, -1), (-1, 0), (1, 0), (0, 1))
_CORNERS = ((-1, -1), (1, -1), (-1, 1), (1, 1))
_INKS = {"R": ("pale-red", "red"), "G": ("pale-teal", "teal"), "B": ("pale-blue", "blue")}


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the arrows and the results.

    Raises
    ------
    BankError
        If the marked site lies outside the tile or has the colour that is asked for.
    """
    size, x, y = _marked_site(values)
    channel, own = int(values["channel"]), letter(values, x, y)
    require("bayer", max(x, y) < size, "the marked site lies outside the tile")
    asked = f"the marked site is {own} itself; ask for another channel"
    require("bayer", channel == 0 or "RGB"[channel - 1] != own, asked)
    column, row = _first_site(values)
    require("bayer", not column % 2 and not row % 2, "left and top are not even")
    art = fig.sketch()
    cell = max(34.0, float(184 // size))
    for colour, (squares, strokes) in _lay_out_sites(int(values["phase"]), size, cell).items():
        fill, ink = _INKS[colour]
        art.shape(squares, fill, part=f"site-{colour}")
        if strokes:
            art.shape(strokes, None, ink, 0.8, part=f"hatch-{colour}")
    lines = [((0, i), (size, i)) for i in range(size + 1)]
    lines += [((i, 0), (i, size)) for i in range(size + 1)]
    draw_lines(art, np.array(lines) * cell, "ink", part="cells")
    _label_sites(art, values, size, cell)
    if "left" in values or "top" in values:
        for place in range(size):
            at = (place + 0.5) * cell
            art.label((at, size * cell + 4), str(column + place), "cb", 9, fill="grey")
            art.label((-5, size * cell - at), str(row + place), "r", 9, fill="grey")
    left, low = x * cell, (size - 1 - y) * cell
    marked = [(left, low), (left + cell, low), (left + cell, low + cell), (left, low + cell)]
    art.area(marked, None, "ink", 2.4, part="marked")
    if not quiz:
        _draw_answer(art, values, cell)


def _first_site(values: Values) -> tuple[int, int]:
    """Column and row of the tile's upper left site, counted on the sensor."""
    return int(values.get("left", 0)), int(values.get("top", 0))


@cache
def _lay_out_sites(phase: int, size: int, cell: float) -> dict[str, tuple[Path, Path | None]]:
    """Squares of each colour, and strokes in two corners of each, away from letter and value."""
    sites = {
        colour: [(x, y) for y in range(size) for x in range(size)
                 if _colour_at(phase, x, y) == colour]
        for colour in "RGB"
    }  # fmt: skip
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)])
    rising = np.array([((0, 1 - t), (t, 1)) for t in (0.12, 0.24)]
                      + [((1 - t, 0), (1, t)) for t in (0.12, 0.24)], float)  # fmt: skip
    found: dict[str, tuple[Path, Path | None]] = {}
    for colour, places in sites.items():
        corners = np.array([(x, size - 1 - y) for x, y in places], float)
        squares = (corners[:, None] + square) * cell
        codes = [Path.MOVETO, *[Path.LINETO] * 3, Path.CLOSEPOLY] * len(places)
        strokes = None
        if colour != "G":
            lines = rising if colour == "R" else rising * (-1, 1) + (1, 0)
            ends = (corners[:, None, None] + lines) * cell
            strokes = Path(ends.reshape(-1, 2), [Path.MOVETO, Path.LINETO] * 4 * len(places))
        found[colour] = Path(squares.reshape(-1, 2), codes), strokes
    return found


def _label_sites(art: Any, values: Values, size: int, cell: float) -> None:
    for y in range(size):
        for x in range(size):
            colour, value = letter(values, x, y), values.get(f"v{y}{x}")
            at = ((x + 0.5) * cell, (size - 0.5 - y) * cell)
            if value is None:
                art.label(at, colour, size=12, part="letters")
                continue
            art.label(at, colour, size=9, shift=(0, 6.5), part="letters")
            art.label(at, format_given(value), size=10 if value < 1000 else 8, shift=(0, -5.5))


def _marked_site(values: Values) -> tuple[int, int, int]:
    return int(values["size"]), int(values["x"]), int(values["y"])


def _colour_at(phase: int, x: int, y: int) -> str:
    return PATTERNS[phase][2 * (y % 2) + x % 2]


def letter(values: Values, x: int, y: int) -> str:
    """Colour of a site.

    Parameters
    ----------
    values : mapping of str to float
        Needs ``phase``.
    x, y : int
        Column and row, from 0.

    Returns
    -------
    {"R", "G", "B"}
    """
    return _colour_at(int(values["phase"]), x, y)


def _missing_channels(values: Values) -> list[str]:
    """Channels to show at the marked site: the one asked for, or both that it lacks."""
    if channel := int(values["channel"]):
        return ["RGB"[channel - 1]]
    own = letter(values, int(values["x"]), int(values["y"]))
    return [colour for colour in "GRB" if colour != own]


def neighbours(values: Values, channel: str) -> list[tuple[int, int]]:
    """Sites that bilinear demosaicing averages for a channel at the marked site.

    Parameters
    ----------
    values : mapping of str to float
        As ``PARAMETERS`` says.
    channel : {"R", "G", "B"}
        The missing colour.

    Returns
    -------
    list of tuple of int
        (column, row) of the nearest sites of that colour inside the tile: edge neighbours if
        there are any, else diagonal ones.
    """
    size, x0, y0 = _marked_site(values)
    for offsets in (_EDGES, _CORNERS):
        sites = [(x0 + dx, y0 + dy) for dx, dy in offsets]
        inside = [(x, y) for x, y in sites if 0 <= x < size and 0 <= y < size]
        if found := [(x, y) for x, y in inside if letter(values, x, y) == channel]:
            return found
    return []


def _write_mean(values: Values, channel: str) -> str:
    """The mean of the sites used as one line of numbers; empty unless all of them are known."""
    used = [values.get(f"v{y}{x}") for x, y in neighbours(values, channel)]
    numbers = [value for value in used if value is not None]
    if len(numbers) != len(used) or not numbers:
        return ""
    terms = " + ".join(map(format_given, numbers))
    if len(numbers) == 1:
        return f"{channel} = {terms}"
    mean = sum(numbers) / len(numbers)
    return f"{channel} = ({terms}) / {len(numbers)} {relation_sign(mean)} {format_derived(mean)}"


def _draw_answer(art: Any, values: Values, cell: float) -> None:
    """Draw arrows from the sites used across their borders, and write the means below."""
    size, x0, y0 = _marked_site(values)
    row = -13.0
    for channel in _missing_channels(values):
        ink = _INKS[channel][1]
        for x, y in neighbours(values, channel):
            way = np.array([x0 - x, y - y0], float)
            border = np.array([x + x0 + 1, 2 * size - 1 - y - y0]) * cell / 2
            reach = way * min(10.0, cell / 2 - 12) / (1.2 if way.all() else 1)
            dashes = (2.5, 1.5) if way.all() else None
            ends = (border - reach, border + reach)
            art.arrow(*ends, ink, 1.4, size=5.5, dashes=dashes, part=f"use-{channel}")
        if text := _write_mean(values, channel):
            art.label((size * cell / 2, row), text)
            row -= 16


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out which sites are used and the results."""
    words, (size, x, y) = load_alt_words(__file__, lang), _marked_site(values)
    pattern, (left, top) = PATTERNS[int(values["phase"])], _first_site(values)
    place = {"size": size, "x": x + left, "y": y + top, "letter": letter(values, x, y)}
    text: str = words["figure"].format(pattern=pattern, **place)
    text += "".join(words["row"].format(y=row + top, sites=sites) for row, sites in _rows(values))
    if quiz:
        return text
    for channel in _missing_channels(values):
        sites = ", ".join(f"({a + left}, {b + top})" for a, b in neighbours(values, channel))
        text += words["use"].format(channel=channel, sites=sites)
        if mean := _write_mean(values, channel):
            text += f" {mean}{words['stop']}"
    return text


def _rows(values: Values) -> list[tuple[int, str]]:
    """Rows that show values, as ``R 60, G 100``."""
    rows = []
    for y in range(int(values["size"])):
        sites = [(letter(values, x, y), values.get(f"v{y}{x}")) for x in range(int(values["size"]))]
        if any(value is not None for _, value in sites):
            known = (c if value is None else f"{c} {format_given(value)}" for c, value in sites)
            rows.append((y, ", ".join(known)))
    return rows
