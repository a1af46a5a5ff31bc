"""Digits against the input: a plot, the places of its slider, where digits that count are lost."""

from __future__ import annotations

import math
from typing import Any

from quizgen.tradeoff.digits import ALL_DIGITS
from quizgen.tradeoff.labels import Labels
from quizgen.tradeoff.plot import (
    BOUNDS,
    DIGITS,
    HEIGHT,
    LEFT,
    RIGHT,
    Axes,
    Scale,
    digit_axis,
    frame,
    label,
    line,
    path,
    power_text,
    raised,
    text,
)
from quizgen.tradeoff.sweeps import WAYS, Sweep

ORDER = ("float64", "float32", "stable")
"""Ways below the slider, after the exact value."""
_KINDS = {"float32": "third", "float64": "second", "stable": "on"}


def across(sweep: Sweep) -> Scale:
    """The axis of the input: harder to the right."""
    return Scale(sweep.places[0].at, sweep.places[-1].at, LEFT, RIGHT, log=sweep.log)


def sweep_panel(sweep: Sweep, axes: Axes, said: dict[str, str], start: int) -> str:
    """Correct digits of each way along the path, and the digits that grading and pixels need."""
    x, labels = across(sweep), Labels(BOUNDS)
    parts = [frame(x, DIGITS), digit_axis(DIGITS, x, axes.digits, axes.every), _inputs(x, sweep)]
    for needed, words, down in (
        (sweep.level, said["level"], -4),
        (sweep.graded, said["graded"], 13),
    ):
        parts.append(line(LEFT, DIGITS(needed), RIGHT, DIGITS(needed), "rule"))
        parts.append(text(LEFT + 4, DIGITS(needed) + down, words, "start"))
        labels.written(LEFT + 4, DIGITS(needed) + down, words, "start")
    for way in WAYS:
        points = [(x(p.at), DIGITS(p.digits[WAYS.index(way)])) for p in sweep.places]
        parts.append(path(points, f"line {_KINDS[way]} {way}"))
        for px, py in points:
            labels.keep_clear(px, py, 3)
    for way in WAYS:
        px, py = _labelled(sweep, x, way)
        parts.append(label(labels.place(said[way], px, py), "head"))
    cursor = line(x(sweep.places[start].at), DIGITS.start, x(sweep.places[start].at), DIGITS.end,
                  "cursor")  # fmt: skip
    return "".join(parts) + cursor


def _labelled(sweep: Sweep, x: Scale, way: str) -> tuple[float, float]:
    """Where a way is named: where it has lost half of its digits, else at its end."""
    index = WAYS.index(way)
    half = (p for p in sweep.places if p.digits[index] < ALL_DIGITS / 2)
    place = next(half, sweep.places[-1])
    return x(place.at), DIGITS(place.digits[index])


def _inputs(x: Scale, sweep: Sweep) -> str:
    parts = [text(RIGHT, HEIGHT - 8, sweep.symbol, "end", "head")]
    for at in _ticks(sweep):
        said = power_text(at) if sweep.log else f"{at:g}"
        parts.append(line(x(at), DIGITS.start, x(at), DIGITS.end, "grid"))
        parts.append(text(x(at), DIGITS.start + 15, said))
    return "".join(parts)


def _ticks(sweep: Sweep) -> list[float]:
    low, high = sorted((sweep.places[0].at, sweep.places[-1].at))
    if not sweep.log:
        return [float(at) for at in range(math.ceil(low), math.floor(high) + 1, 2)]
    first, last = math.ceil(math.log10(low)), math.floor(math.log10(high))
    return [10.0**n for n in range(first, last + 1, max(1, math.ceil((last - first) / 5)))]


def places(sweep: Sweep, said: dict[str, str], failed: str) -> list[list[Any]]:
    """What each position of the slider shows: where, in words, and the numbers in three pieces."""
    x = across(sweep)
    return [
        [
            round(x(place.at), 1),
            f"{sweep.symbol} = {input_text(place.at)}",
            said["position"].format(
                at=f"{sweep.symbol} = {input_text(place.at)}",
                digits=int(min(place.digits[WAYS.index("float64")], 16)),
            ),
            pieces(place.right, ALL_DIGITS, failed),
            *(
                pieces(place.values[WAYS.index(way)], place.digits[WAYS.index(way)], failed)
                for way in ORDER
            ),
        ]
        for place in sweep.places
    ]


def input_text(value: float) -> str:
    """An input, short.

    Examples
    --------
    >>> input_text(4.25), input_text(0.0032), input_text(470000.0), input_text(3.2e-7)
    ('4.25', '0.0032', '4.7·10⁵', '3.2·10⁻⁷')
    """
    if 1e-3 <= value < 9999.5:  # beyond, %g has exponents as programs write them
        return f"{value:.4g}"
    mantissa, power = f"{value:.1e}".split("e")
    return f"{mantissa}·10{raised(int(power))}"


def pieces(value: float, right: float, failed: str) -> tuple[str, str, str]:
    """A number of seventeen digits: those that are right, the rest, its power of ten."""
    if math.isnan(value) or math.isinf(value):
        return "", failed, ""
    if value == 0:
        return ("0", "", "") if right >= ALL_DIGITS else ("", "0", "")
    mantissa, power = f"{value:.16e}".split("e")
    sign = len(mantissa) - 18
    kept = sign + int(right) + (1 if right >= 2 else 0) if right >= 1 else 0
    tail = f"·10{raised(int(power))}" if int(power) else ""
    if right >= ALL_DIGITS:
        return mantissa, "", tail
    return mantissa[:kept], mantissa[kept:], tail


def lost(sweep: Sweep, way: str, needed: float, never: str) -> str:
    """From where on a way has too few digits."""
    at = sweep.lost_from(way, needed)
    return never if at is None else f"{sweep.symbol} = {input_text(at)}"
