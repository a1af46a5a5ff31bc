"""Normal density: peak, marks at the mean and k sigma, shaded tails; or several densities."""

from __future__ import annotations

from math import erf, erfc, exp, pi, sqrt
from statistics import NormalDist
from typing import Any

import numpy as np

from quizgen.figures.kit import (
    ABSENT,
    Parameter,
    Values,
    format_derived,
    format_equation,
    format_given,
    load_alt_words,
    relation_sign,
    require,
    strip_mathtext,
)
from quizgen.figures.sketch import measure_label

from ._plots import format_learned, mark_place, mark_point

PARAMETERS = {
    "sigma": Parameter("any", "standard deviation", low=1e-6),
    "mu": Parameter("as sigma", "mean", 0.0),
    "k": Parameter("sigma", "marks at mu ± k sigma; 0: none", 0.0, 0.0, 4.0),
    "tails": Parameter(
        "", "shaded: 2 both tails, 1 upper, -1 lower, 0 between the marks", 2.0, -1.0, 2.0,
        whole=True,
    ),
    "sigma2": Parameter("as sigma", "standard deviation of a second curve", ABSENT, 1e-6),
    "sigma3": Parameter("as sigma", "standard deviation of a third curve", ABSENT, 1e-6),
}  # fmt: skip
SIZE = (286.0, 108.0)

_SPAN = 4.4  # the axis reaches this many of the largest standard deviations to each side
_MIDDLE, _PEAK = 143.0, 92.0  # the mean, and the highest peak, in points
_ASIDE = 58.0  # of the probability from the mean, in points
_INKS = ("blue", "red", "teal")
_DASHES = (None, (5.0, 2.0), (1.4, 1.6))


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, hide the density at the mean and the probability.

    Raises
    ------
    BankError
        If marks are asked for on several curves.
    """
    sigmas = _list_sigmas(values)
    require("gaussian", len(sigmas) == 1 or not values["k"], "marks need a single curve")
    art, left = fig.sketch(), _left_end(values)
    if values["k"]:
        _shade(art, values)
    _draw_axes(art, values, left)
    for number, sigma in enumerate(sigmas):
        reach = _SPAN * max(sigmas) / sigma
        curve = _trace(values, np.linspace(-reach, reach, 221), sigma)
        art.line(curve, _INKS[number], 1.4, dashes=_DASHES[number], part=f"curve-{number}")
    if len(sigmas) > 1:
        _draw_legend(art, sigmas, quiz=quiz)
        return
    _name_peak(art, values, left, quiz=quiz)
    if values["k"]:
        _name_probability(art, values, quiz=quiz)


def _list_sigmas(values: Values) -> list[float]:
    return [values[name] for name in ("sigma", "sigma2", "sigma3") if name in values]


def _peak(sigma: float) -> float:
    return 1 / (sqrt(2 * pi) * sigma)


def _trace(values: Values, u: Any, sigma: float) -> Any:
    """Points of a curve at u of its own standard deviations."""
    sigmas = _list_sigmas(values)
    x = _MIDDLE + u * (sigma / max(sigmas) * _MIDDLE / _SPAN)
    return np.column_stack([x, np.exp(-u * u / 2) * (_PEAK * min(sigmas) / sigma)])


def _place(u: float) -> tuple[float, float]:
    """Point of a single curve at u standard deviations."""
    return _MIDDLE + u * _MIDDLE / _SPAN, _PEAK * exp(-u * u / 2)


def _left_end(values: Values) -> float:
    """Where the upright axis stands: left of the probability, if that is written on the left."""
    if not values["k"] or values["tails"] != -1:
        return 0.0
    width, _ = measure_label(_format_probability(values, quiz=False))
    return min(0.0, _MIDDLE - _ASIDE - width - 10)


def _draw_axes(art: Any, values: Values, left: float) -> None:
    mu, k, sigma = values["mu"], values["k"], max(_list_sigmas(values))
    right, top = 2 * _MIDDLE + 12, _PEAK + 27
    art.arrow((left - 5, 0), (right, 0), "ink", 0.7, part="axis")
    art.arrow((left, -3), (left, top), "ink", 0.7, part="axis")
    art.label((right + 4, 0), "$n$", "l")
    art.label((left + 6, top - 4), "$g(n)$", "l")
    steps = sorted({0.0, k, -k} if 0 < abs(k - 1) < 1 else {0.0, 1.0, -1.0, k, -k})
    several = "sigma2" in values or "sigma3" in values
    for u in steps:
        x, _ = _place(u)
        art.line([(x, -3), (x, 3)], "ink", 0.6, part="ticks")
        near = 0 < abs(u) < 1  # too close to the mean to be centred
        align = "ct" if not near else "lt" if u > 0 else "rt"
        x += 2 * near * (1 if u > 0 else -1)
        art.label((x, -5.5), format_given(mu + u * sigma), align, 9)
        if not several or not u:
            factor = "" if abs(u) == 1 else format_given(abs(u))
            name = rf"$\mu {'+' if u > 0 else '-'} {factor}\sigma$" if u else r"$\mu$"
            art.label((x, -18), name, align, 9, "grey")


def _shade(art: Any, values: Values) -> None:
    k = values["k"]
    tails = {0: [(-k, k)], 1: [(k, _SPAN)], -1: [(-_SPAN, -k)], 2: [(-_SPAN, -k), (k, _SPAN)]}
    for start, stop in tails[int(values["tails"])]:
        curve = _trace(values, np.linspace(start, stop, 80), values["sigma"])
        art.area([(curve[0, 0], 0), *curve, (curve[-1, 0], 0)], "pale-blue", part="shaded")
    for u in (-k, k):
        x, y = _place(u)
        art.line([(x, 0), (x, y)], "blue", 0.9, dashes=(3, 2), part="marks")


def _name_peak(art: Any, values: Values, left: float, *, quiz: bool) -> None:
    """Name the height at the mean on the axis, and the distance sigma at the turning point."""
    x, y = _place(0)
    side = 1 if values["tails"] == -1 and values["k"] else -1  # the probability has the other
    turn = _place(side)
    art.line([(x, 0), (x, y)], "rule", 0.6, part="mean")
    art.line([(left, y), (x, y)], "grey", 0.7, dashes=(1.2, 1.8), part="peak")
    art.dot((x, y), 2.0, "blue", part="peak-point")
    text = format_equation(r"$g(\mu)$", _peak(values["sigma"]), hide=quiz)
    art.label((left + 6, y - 5), text, "lt", part="peak-value")
    name = rf"$\sigma$ = {format_given(values['sigma'])}"
    art.measure((x, turn[1]), turn, name, side="r" if side > 0 else "l", part="sigma")


def _name_probability(art: Any, values: Values, *, quiz: bool) -> None:
    side = -1 if values["tails"] == -1 else 1
    between = values["tails"] == 0
    x, y = _place(0.5 * min(values["k"], 1.5) if between else side * (values["k"] + 0.2))
    left, high = _MIDDLE + _ASIDE * side, 0.42 * _PEAK
    start = (left - 2, high) if between else (left + 14 * side, high - 6)
    art.line([start, (x, 0.4 * y)], "grey", 0.6, part="leader")
    art.dot((x, 0.4 * y), 1.3, "grey", part="leader")
    text = _format_probability(values, quiz=quiz)
    art.label((left + 2 * side, high), text, "l" if side > 0 else "r", part="probability")


def _draw_legend(art: Any, sigmas: list[float], *, quiz: bool) -> None:
    for number, sigma in enumerate(sigmas):
        y, left = 104 - 15 * number, 2 * _MIDDLE - 128
        density = format_equation(r"$g(\mu)$", _peak(sigma), hide=quiz)
        art.line([(left, y), (left + 22, y)], _INKS[number], 1.4, dashes=_DASHES[number],
                 part=f"legend-{number}")  # fmt: skip
        art.label((left + 28, y), rf"$\sigma$ = {format_given(sigma)},   {density}", "l", 9.5)


def _probability(values: Values) -> float:
    k, tails = values["k"], values["tails"]
    if tails == 0:
        return erf(k / sqrt(2))
    return erfc(k / sqrt(2)) * (1.0 if tails == 2 else 0.5)


def _event(values: Values) -> str:
    """Name the shaded event by the numbers at its ends: ``|n − 3| > 4`` or ``n > 7``."""
    mu, width = values["mu"], values["k"] * values["sigma"]
    if abs(values["tails"]) == 1:
        side = ">" if values["tails"] == 1 else "<"
        return f"$n$ {side} {format_given(mu + values['tails'] * width)}"
    shift = f" {'−' if mu > 0 else '+'} {format_given(abs(mu))}" if mu else ""
    return f"|$n${shift}| {'>' if values['tails'] else '≤'} {format_given(width)}"


def _format_probability(values: Values, *, quiz: bool) -> str:
    return format_equation(f"$P$({_event(values)})", 100 * _probability(values), "%", hide=quiz)


MARKS = {"g_0": "", "P_1": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(fig: Any, values: Values, marks: Values) -> None:
    """Draw a learner's values: ``g_0``, the density at the mean, and ``P_1`` in percent.

    A share stands where tails of that size, on the shaded sides, would begin.
    """
    if "g_0" in marks:
        left, height = _left_end(values), _PEAK * marks["g_0"] / _peak(values["sigma"])
        box = (left, 0.0, 2 * _MIDDLE, _PEAK + 12)
        text = rf"$g(\mu)$ = {format_learned(marks['g_0'])}"
        mark_point(fig, box, (left, height), text, side=-1)
    if "P_1" in marks:
        share, tails = min(max(marks["P_1"] / 100, 1e-9), 1 - 1e-9), int(values["tails"])
        above = {0: (1 - share) / 2, 2: share / 2}.get(tails, share)
        u = NormalDist().inv_cdf(1 - above) * (-1 if tails == -1 else 1)
        x, y = _place(u)
        # Beside the probability a low line, above it a high one.
        top = 22.0 if abs(u) > 1.75 else max(0.63 * _PEAK, y + 8)
        box = (0.0, 0.0, 2 * _MIDDLE, top)
        mark_place(fig, box, x, f"{format_learned(marks['P_1'])} %")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words.

    In a quiz, leave the density at the mean and the probability out.
    """
    words = load_alt_words(__file__, lang)
    sigmas = _list_sigmas(values)
    text = words["figure"].format(
        mu=format_given(values["mu"]), sigmas=words["and"].join(map(format_given, sigmas))
    )
    if values["k"]:
        event = strip_mathtext(_event(values))
        text += words["marks"].format(k=format_given(values["k"]), event=event)
    if quiz:
        return text
    for sigma in sigmas:
        peak = _peak(sigma)
        text += words["peak"].format(
            sigma=format_given(sigma), relation=relation_sign(peak), peak=format_derived(peak)
        )
    if values["k"]:
        area = strip_mathtext(_format_probability(values, quiz=False))
        text += words["area"].format(area=area)
    return text
