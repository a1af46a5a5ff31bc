"""A whole small Bayer sensor with a letter at each site, and how many sites each colour has."""

from __future__ import annotations

from typing import Any

from quizgen.figures.kit import Parameter, Values, load_alt_words

SIZE = (312.0, 170.0)

PATTERNS = ("RGGB", "BGGR", "GRBG", "GBRG")
PARAMETERS = {
    "phase": Parameter("", "pattern: 0 RGGB, 1 BGGR, 2 GRBG, 3 GBRG", 0.0, 0.0, 3.0, whole=True),
    "W": Parameter("px", "columns", None, 1.0, 16.0, whole=True),
    "H": Parameter("px", "rows", None, 1.0, 16.0, whole=True),
}

_FILLS = {"R": "pale-red", "G": "pale-teal", "B": "pale-blue"}


def count_lines(values: Values, colour: str) -> tuple[int, int]:
    """How many columns and how many rows hold red or blue."""
    place = PATTERNS[int(values["phase"])].index(colour)
    return (int(values["W"]) + 1 - place % 2) // 2, (int(values["H"]) + 1 - place // 2) // 2


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, without the counts."""
    art, pattern = fig.sketch(), PATTERNS[int(values["phase"])]
    columns, rows = int(values["W"]), int(values["H"])
    cell = min(18.0, 150 / rows)
    top = rows * cell
    for place in range(4):  # the sites of a letter of the tile at once
        letter = pattern[place]
        for y in range(place // 2, rows, 2):
            for x in range(place % 2, columns, 2):
                left, low = x * cell, top - (y + 1) * cell
                corners = [
                    (left, low),
                    (left + cell, low),
                    (left + cell, low + cell),
                    (left, low + cell),
                ]
                art.area(corners, _FILLS[letter], "ink", 0.5, part=f"site-{letter}")
                art.label((left + cell / 2, low + cell / 2), letter, size=9)
    tile = [(0, top), (2 * cell, top), (2 * cell, top - 2 * cell), (0, top - 2 * cell)]
    art.area(tile, None, "ink", 1.8, part="tile")
    if quiz:
        return
    right = columns * cell + 16
    (red_w, red_h), (blue_w, blue_h) = count_lines(values, "R"), count_lines(values, "B")
    red, blue = red_w * red_h, blue_w * blue_h
    lines = (
        f"$R$ = {red_w} · {red_h} = {red}",
        f"$B$ = {blue_w} · {blue_h} = {blue}",
        f"$G$ = {columns} · {rows} − {red} − {blue} = {columns * rows - red - blue}",
    )
    for row, text in enumerate(lines):
        art.label((right, top - 9 - 17 * row), text, "l", part="counts")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without the counts."""
    words, pattern = load_alt_words(__file__, lang), PATTERNS[int(values["phase"])]
    columns, rows = int(values["W"]), int(values["H"])
    text = words["figure"].format(W=columns, H=rows, pattern=pattern)
    if quiz:
        return text
    red, blue = ((c[0] * c[1]) for c in (count_lines(values, "R"), count_lines(values, "B")))
    return text + words["answer"].format(R=red, G=columns * rows - red - blue, B=blue)
