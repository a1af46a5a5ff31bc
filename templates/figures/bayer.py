"""Bayer mosaic: one letter per site, its raw value, the marked site and the sites used for it.

Red sites carry rising strokes, blue sites falling ones, green sites none, so the mosaic reads
without colour. Edge neighbours point with full arrows, diagonal neighbours with dashed ones.
"""

from __future__ import annotations

from quizgen.figures.kit import (
    ABSENT,
    BOLD,
    THIN,
    Canvas,
    Parameter,
    Pen,
    Style,
    Values,
    derived,
    given,
    relation,
    require,
    words_of,
)
from quizgen.figures.kit import Style as Stroke

DARK = "invert"

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
} | {
    f"v{y}{x}": Parameter("DN", f"raw value in row {y}, column {x}", ABSENT, 0.0, 99999.0)
    for y in range(LARGEST)
    for x in range(LARGEST)
}

_LETTERS = "RGB"
_EDGES = ((0, -1), (-1, 0), (1, 0), (0, 1))
_CORNERS = ((-1, -1), (1, -1), (-1, 1), (1, 1))
_PAPER = {"R": "#fbdcdc", "G": "#dcf2dc", "B": "#dce4fb"}
_MARGIN = 8.0


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the arrows and the results.

    Raises
    ------
    BankError
        If the marked site lies outside the tile or has the colour that is asked for.
    """
    _check(values)
    size = int(values["size"])
    cell = max(34.0, float(184 // size))
    results = [] if quiz else [text for c in _asked(values) for text in _result(values, c)]
    foot = 16.0 * len(results) + (2 if results else 0)
    pen = Pen(2 * _MARGIN + size * cell, 2 * _MARGIN + size * cell + foot)
    sites = [(x, y) for y in range(size) for x in range(size)]
    for paint in (_site, _hatch, _grid, _site_label):
        for x, y in sites:
            paint(pen, values, x, y, cell)
    _mark(pen, values, cell, BOLD)
    if not quiz:
        _arrows(pen, values, cell)
    for row, text in enumerate(reversed(results)):
        pen.label((pen.width / 2, 11 + 16 * row), text, size=9.5)
    pen.onto(canvas)


def _check(values: Values) -> None:
    size, x, y = int(values["size"]), int(values["x"]), int(values["y"])
    require("bayer", max(x, y) < size, "the marked site lies outside the tile")
    channel = int(values["channel"])
    own = letter(values, x, y)
    require(
        "bayer",
        channel == 0 or _LETTERS[channel - 1] != own,
        f"the marked site is {own} itself; ask for another channel",
    )


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
    return PATTERNS[int(values["phase"])][2 * (y % 2) + x % 2]


def _asked(values: Values) -> list[str]:
    channel = int(values["channel"])
    if channel:
        return [_LETTERS[channel - 1]]
    own = letter(values, int(values["x"]), int(values["y"]))
    missing = [c for c in _LETTERS if c != own]
    return sorted(missing, key="GRB".index)


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
    size, x0, y0 = int(values["size"]), int(values["x"]), int(values["y"])
    for offsets in (_EDGES, _CORNERS):
        sites = [(x0 + dx, y0 + dy) for dx, dy in offsets]
        inside = [(x, y) for x, y in sites if 0 <= x < size and 0 <= y < size]
        found = [(x, y) for x, y in inside if letter(values, x, y) == channel]
        if found:
            return found
    return []


def _result(values: Values, channel: str) -> list[str]:
    """Print the mean as one line of numbers, if all of them are known."""
    used = [values.get(f"v{y}{x}") for x, y in neighbours(values, channel)]
    numbers = [value for value in used if value is not None]
    if len(numbers) != len(used) or not numbers:
        return []
    mean = sum(numbers) / len(numbers)
    terms = " + ".join(given(value) for value in numbers)
    if len(numbers) > 1:
        terms = f"({terms}) / {len(numbers)}"
    return [f"{channel} = {terms} {relation(mean)} {derived(mean)}"]


def _corner(values: Values, x: float, y: float, cell: float, foot: float) -> tuple[float, float]:
    """Lower left corner of a site, in points."""
    return (_MARGIN + x * cell, foot + _MARGIN + (values["size"] - 1 - y) * cell)


def _foot(pen: Pen, values: Values, cell: float) -> float:
    return pen.height - 2 * _MARGIN - values["size"] * cell


def _square(pen: Pen, values: Values, x: float, y: float, cell: float) -> list[tuple[float, float]]:
    left, low = _corner(values, x, y, cell, _foot(pen, values, cell))
    return [(left, low), (left + cell, low), (left + cell, low + cell), (left, low + cell)]


def _site(pen: Pen, values: Values, x: int, y: int, cell: float) -> None:

    colour = letter(values, x, y)
    square = _square(pen, values, x, y, cell)
    pen.area(f"site-{colour}", square, Style(colour=_PAPER[colour]))


def _hatch(pen: Pen, values: Values, x: int, y: int, cell: float) -> None:
    """Strokes in two opposite corners, away from the letter: rising for red, falling for blue."""
    colour = letter(values, x, y)
    if colour == "G":
        return
    stroke = Style(0.7, "#707070")
    left, low = _corner(values, x, y, cell, _foot(pen, values, cell))
    for t in (0.12, 0.24):
        for a, b in (((0, 1 - t), (t, 1)), ((1 - t, 0), (1, t))):
            ends = [(u if colour == "R" else 1 - u, v) for u, v in (a, b)]
            pen.line(
                f"hatch-{colour}", [(left + u * cell, low + v * cell) for u, v in ends], stroke
            )


def _grid(pen: Pen, values: Values, x: int, y: int, cell: float) -> None:

    pen.area("cells", _square(pen, values, x, y, cell), THIN)


def _site_label(pen: Pen, values: Values, x: int, y: int, cell: float) -> None:
    colour, value = letter(values, x, y), values.get(f"v{y}{x}")
    left, low = _corner(values, x, y, cell, _foot(pen, values, cell))
    middle = (left + cell / 2, low + cell / 2)
    if value is None:
        pen.label(middle, f"{{{colour}}}", size=11)
        return
    pen.label((middle[0], middle[1] + 5.5), f"{{{colour}}}", size=9.5)
    pen.label((middle[0], middle[1] - 5), given(value), size=9.5 if value < 1000 else 8)


def _mark(pen: Pen, values: Values, cell: float, style: Style) -> None:

    square = _square(pen, values, values["x"], values["y"], cell)
    pen.area("marked", square, Stroke(style.width + 0.4))


def _arrows(pen: Pen, values: Values, cell: float) -> None:

    x0, y0 = int(values["x"]), int(values["y"])
    foot = _foot(pen, values, cell)
    for channel in _asked(values):
        for x, y in neighbours(values, channel):
            dx, dy = x0 - x, y0 - y
            left, low = _corner(values, (x + x0) / 2, (y + y0) / 2, cell, foot)
            border = (left + cell / 2, low + cell / 2)
            reach = min(8.0, cell / 2 - 9.5) / (1.2 if dx and dy else 1)
            start = (border[0] - dx * reach, border[1] + dy * reach)
            end = (border[0] + dx * reach, border[1] - dy * reach)
            diagonal = dx and dy
            pen.arrow(
                f"use-{channel}", start, end, Style(1.2, dashes=(2.5, 1.5) if diagonal else ())
            )


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out which sites are used and the results."""
    words, x, y = words_of(__file__, lang), int(values["x"]), int(values["y"])
    text = words["figure"].format(
        pattern=PATTERNS[int(values["phase"])],
        size=int(values["size"]),
        x=x,
        y=y,
        letter=letter(values, x, y),
    )
    text += "".join(words["row"].format(y=row, sites=sites) for row, sites in _rows(values))
    if quiz:
        return text
    for channel in _asked(values):
        sites = ", ".join(f"({a}, {b})" for a, b in neighbours(values, channel))
        text += words["use"].format(channel=channel, sites=sites)
        text += "".join(f" {result}{words['stop']}" for result in _result(values, channel))
    return text


def _rows(values: Values) -> list[tuple[int, str]]:
    """Rows that show values, as ``R 60, G 100``."""
    rows = []
    for y in range(int(values["size"])):
        sites = [(letter(values, x, y), values.get(f"v{y}{x}")) for x in range(int(values["size"]))]
        if any(value is not None for _, value in sites):
            known = (c if value is None else f"{c} {given(value)}" for c, value in sites)
            rows.append((y, ", ".join(known)))
    return rows
