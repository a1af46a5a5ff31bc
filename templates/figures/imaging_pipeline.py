"""From light to a stored picture: ten blocks, of light and charge above, of numbers below."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from matplotlib.path import Path

from quizgen.figures.kit import Parameter, Values, load_alt_words
from quizgen.figures.sketch import measure_label

SIZE = (400.0, 150.0)

STEPS = ("lens", "mosaic", "charge", "gain", "converter",
         "black", "flat", "demosaic", "gamma", "eight")  # fmt: skip
PARAMETERS = {
    "left_out": Parameter("", "step from 1 that is left out, 0: none", 0.0, 0.0, 10.0, whole=True),
}

_WIDE, _HIGH, _NEXT, _ROWS = 58.0, 34.0, 84.0, (104.0, 32.0)
_COLOURS = {"R": "pale-red", "G": "pale-teal", "B": "pale-blue"}


def place_of(step: int) -> tuple[float, float]:
    """Centre of a block in points; steps count from 0."""
    return 30 + _NEXT * (step % 5), _ROWS[step // 5]


def draw(fig: Any, values: Values, *, quiz: bool, lang: str) -> None:
    """Draw the figure with the names of the steps; in a quiz, with numbers in place of them."""
    art, words = fig.sketch(), load_alt_words(__file__, lang)
    for step, name in enumerate(STEPS):
        x, y = place_of(step)
        box = [
            (x + a * _WIDE / 2, y + b * _HIGH / 2) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        art.area(box, "paper", "ink", 0.8, part=f"block-{name}")
        if step % 5 < 4:
            start = x + _WIDE / 2
            art.arrow((start + 2, y), (start + _NEXT - _WIDE - 2, y), "grey", 1.0, part="way")
        if quiz:
            art.label((x, y), str(step + 1))
            continue
        _ICONS[name](art, x, y)
        for row, text in enumerate(_break(words[name])):
            art.label((x, y - _HIGH / 2 - 4 - 10.5 * row), text, "ct", 8.5)
        if step + 1 == values["left_out"]:
            for a, b in ((box[0], box[2]), (box[1], box[3])):
                art.line([a, b], "red", 1.6, part="left-out")
    (x, y), (end, low) = place_of(4), place_of(5)
    turn = (x + _WIDE / 2, y), (x + _WIDE / 2 + 10, y), (x + _WIDE / 2 + 10, 64), (end, 64)
    art.line(turn, "grey", 1.0, part="way")
    art.arrow(turn[-1], (end, low + _HIGH / 2 + 2), "grey", 1.0, part="way")


def _break(text: str) -> list[str]:
    """Break words into two lines where they are wider than a block has room for."""
    if measure_label(text, 8.5)[0] <= _NEXT - 6 or " " not in text:
        return [text]
    middle = min((i for i, c in enumerate(text) if c == " "), key=lambda i: abs(i - len(text) / 2))
    return [text[:middle], text[middle + 1 :]]


def _draw_lens(art: Any, x: float, y: float) -> None:
    path = Path([(x, y + 13), (x + 9, y), (x, y - 13), (x - 9, y), (x, y + 13), (x, y + 13)],
                [1, 3, 3, 3, 3, 79])  # fmt: skip
    art.shape(path, "pale-blue", "blue", 0.9, part="icon")
    for side in (-1, 1):
        art.line([(x - 22, y + 8 * side), (x, y + 8 * side), (x + 22, y)], "gold", 0.9, part="icon")


def _draw_mosaic(art: Any, x: float, y: float) -> None:
    for letter, a, b in (("R", -1, 0), ("G", 0, 0), ("G", -1, -1), ("B", 0, -1)):
        left, low = x + 12 * a, y + 12 * b
        square = [(left, low), (left + 12, low), (left + 12, low + 12), (left, low + 12)]
        art.area(square, _COLOURS[letter], "ink", 0.5, part="icon")
        art.label((left + 6, low + 6), letter, size=8)


def _draw_charge(art: Any, x: float, y: float) -> None:
    art.line(
        [(x - 12, y + 11), (x - 12, y - 11), (x + 12, y - 11), (x + 12, y + 11)],
        "ink",
        1.2,
        part="icon",
    )
    for dx, dy in ((-7, -6), (0, -6), (7, -6), (-3.5, 0), (3.5, 0)):
        art.dot((x + dx, y + dy), 2.4, "pale-blue", "blue", 0.7, part="icon")


def _draw_gain(art: Any, x: float, y: float) -> None:
    art.area([(x - 11, y - 12), (x - 11, y + 12), (x + 12, y)], "shade", "ink", 0.9, part="icon")


def _draw_converter(art: Any, x: float, y: float) -> None:
    stairs = [(x - 16 + 8 * ((i + 1) // 2), y - 12 + 6 * (i // 2)) for i in range(9)]
    art.line([(x - 16, y - 12), (x + 16, y + 12)], "rule", 0.8, part="icon")
    art.line(stairs, "blue", 1.2, part="icon")


def _draw_demosaic(art: Any, x: float, y: float) -> None:
    for place, colour in enumerate(_COLOURS.values()):
        left, low = x - 14 + 6 * place, y - 12 + 4 * place
        square = [(left, low), (left + 16, low), (left + 16, low + 16), (left, low + 16)]
        art.area(square[::-1], colour, "ink", 0.6, part="icon")


def _draw_gamma(art: Any, x: float, y: float) -> None:
    curve = [(x - 12 + 24 * i / 24, y - 12 + 24 * (i / 24) ** (1 / 2.2)) for i in range(25)]
    art.line([(x - 12, y + 12), (x - 12, y - 12), (x + 12, y - 12)], "grey", 0.7, part="icon")
    art.line(curve, "blue", 1.2, part="icon")


def _write(text: str) -> Callable[[Any, float, float], None]:
    return lambda art, x, y: art.label((x, y), text, size=12, part="icon")


_ICONS: dict[str, Callable[[Any, float, float], None]] = {
    "lens": _draw_lens,
    "mosaic": _draw_mosaic,
    "charge": _draw_charge,
    "gain": _draw_gain,
    "converter": _draw_converter,
    "black": _write("$I - D$"),
    "flat": _write(r"$I\,/\,F$"),
    "demosaic": _draw_demosaic,
    "gamma": _draw_gamma,
    "eight": _write("0 … 255"),
}


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without the steps."""
    words = load_alt_words(__file__, lang)
    if quiz:
        return words["quiz"]
    text = words["figure"].format(steps=words["and"].join(words[step] for step in STEPS))
    left_out = int(values["left_out"])
    return text + words["left out"].format(words[STEPS[left_out - 1]]) if left_out else text
