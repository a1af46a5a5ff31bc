"""One column of a CCD with a lamp on it: what flows over into neighbours, and the streak."""

from __future__ import annotations

from typing import Any

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_given,
    load_alt_words,
    relation_sign,
    require,
)

SIZE = (312.0, 180.0)

PARAMETERS = {
    "F": Parameter("e⁻", "what a photosite holds", None, 1.0, 1e7),
    "Q": Parameter("e⁻", "what the lamp releases in each of its photosites", None, 1.0, 1e9),
    "b": Parameter("e⁻", "what each other photosite collects", None, 0.0, 1e7),
    "h": Parameter("", "photosites that the lamp covers", None, 1.0, 1000.0, whole=True),
    "t": Parameter("ms", "exposure time", None, 1e-3, 1e6),
    "t_r": Parameter("µs", "time for one step of the transfer", None, 1e-3, 1e6),
}

_LEFT, _FULL, _HIGH, _TOP = 96.0, 120.0, 11.0, 158.0
_GAP = 10.0  # stands for rows that are left out
_LAMP, _NEAR, _ABOVE = (4, 5, 6), (2, 3, 7, 8), (0, 1)
_ROWS = 11
_CHARGE = r"$\mathrm{e}^-$"


def streak_of(values: Values) -> tuple[float, float]:
    """Photosites beside the lamp that are filled, and electrons that the streak adds."""
    over = values["h"] * (values["Q"] - values["F"])
    charge = values["h"] * values["Q"] * values["t_r"] / (1000 * values["t"])
    return over / (values["F"] - values["b"]), charge


def _row(number: int) -> float:
    """Upper edge of a row; two of the rows stand apart from the rest."""
    return _TOP - number * _HIGH - _GAP * ((number > 1) + (number > 8))


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, before anything has flown over and without the streak.

    Raises
    ------
    BankError
        If the lamp does not fill its photosites, or the others are full without it.
    """
    require("ccd_streak", values["b"] < values["F"] < values["Q"], "b < F < Q does not hold")
    art, (_, streak) = fig.sketch(), streak_of(values)
    ground = _FULL * values["b"] / values["F"]
    for row in range(_ROWS):
        lit = row in _LAMP
        if row in _NEAR and not quiz:
            art.area(_corners(row, ground, _FULL - ground), "pale-red", part="overflow")
        charge = _FULL if lit else ground
        art.area(_corners(row, 0, charge), "pale-blue", part="charge")
        if row in _ABOVE and not quiz:
            wide = min(max(_FULL * streak / values["F"], 3.0), _FULL - ground)
            art.area(_corners(row, ground, wide), "teal", part="streak")
        art.area(_corners(row, 0, _FULL), None, "ink", part="photosites")
        if lit:
            y = _row(row) - _HIGH / 2
            art.arrow((_LEFT - 24, y), (_LEFT - 4, y), "gold", 1.1, size=5.5, part="light")
    right = _LEFT + _FULL
    for row, way in ((4, 1), (6, -1)):
        y = _row(row) - _HIGH / 2
        path = [
            (right + 3, y),
            (right + 9, y),
            (right + 9, y + way * 2.2 * _HIGH),
            (right + 3, y + way * 2.2 * _HIGH),
        ]
        art.ray(path, "red", 1.0, heads=((2, 0.6),), size=5.5, part="flow")
    for gap in (_row(1) - _HIGH - _GAP / 2, _row(8) - _HIGH - _GAP / 2):
        for dx in (-6, 0, 6):
            art.dot((_LEFT + _FULL / 2 + dx, gap), 0.8, "ink", part="break")
    _write(art, values, quiz, ground)


def _corners(row: int, start: float, wide: float) -> list[tuple[float, float]]:
    x, y = _LEFT + start, _row(row)
    return [(x, y), (x + wide, y), (x + wide, y - _HIGH), (x, y - _HIGH)]


def _write(art: Any, values: Values, quiz: bool, ground: float) -> None:
    said = {name: format_given(value) for name, value in values.items()}
    right, low, (count, streak) = _LEFT + _FULL, _row(_ROWS - 1) - _HIGH, streak_of(values)
    middle = _row(5) - _HIGH / 2
    art.label((_LEFT - 28, middle), f"$h$ = {said['h']}", "r")
    art.label((right + 15, middle + 7), f"$Q$ = {said['Q']} {_CHARGE}", "l")
    art.label((right + 15, middle - 7), f"$t$ = {said['t']} ms", "l")
    for wide, row, text in (
        (ground, low - 9, f"$b$ = {said['b']} {_CHARGE}"),
        (_FULL, low - 22, f"$F$ = {said['F']} {_CHARGE}"),
    ):
        for x in (_LEFT, _LEFT + wide):
            art.line([(x, low - 2), (x, row - 3)], "rule", 0.6, part="helpers")
        art.measure((_LEFT, row), (_LEFT + wide, row), text, side="r")
    art.arrow((_LEFT - 74, _TOP), (_LEFT - 74, low), "ink", 1.2, part="transfer")
    art.label((_LEFT - 68, _TOP - 14), f"$t_r$ = {said['t_r']} µs", "l")
    if quiz:
        art.label((right + 15, _row(2) - _HIGH), "$n$ = ?", "l", fill="red")
        art.label((right + 8, _row(0) - _HIGH), "$e$ = ?", "l", fill="teal")
        return
    text = f"$n$ {relation_sign(count)} {format_derived(count)}"
    art.label((right + 15, _row(2) - _HIGH), text, "l", fill="red")
    text = f"$e$ {relation_sign(streak)} {format_derived(streak)} {_CHARGE}"
    art.label((right + 8, _row(0) - _HIGH), text, "l", fill="teal")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without how far it flows over, and the streak."""
    words = load_alt_words(__file__, lang)
    text = words["figure"].format(**{name: format_given(value) for name, value in values.items()})
    if quiz:
        return text + words["quiz"]
    count, streak = (f"{relation_sign(v)} {format_derived(v)}" for v in streak_of(values))
    return text + words["answer"].format(n=count, e=streak)
