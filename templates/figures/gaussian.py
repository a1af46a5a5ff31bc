"""Normal density: peak, marks at the mean and k sigma, shaded tails; or several densities."""

from __future__ import annotations

from math import erf, erfc, exp, pi, sqrt

from quizgen.figures.kit import (
    ABSENT,
    DASHED,
    DEEP,
    DOTTED,
    LINE,
    THIN,
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Point,
    Style,
    Values,
    derived,
    equation,
    given,
    relation,
    require,
    spoken,
    text_width,
    words_of,
)
from quizgen.figures.kit import Style as Stroke

DARK = "invert"

PARAMETERS = {
    "sigma": Parameter("any", "standard deviation", low=1e-6),
    "mu": Parameter("as sigma", "mean", 0.0),
    "k": Parameter("sigma", "marks at mu ± k sigma; 0: none", 0.0, 0.0, 4.0),
    "tails": Parameter(
        "",
        "shaded: 2 both tails, 1 upper, -1 lower, 0 between the marks",
        2.0,
        -1.0,
        2.0,
        whole=True,
    ),
    "sigma2": Parameter("as sigma", "standard deviation of a second curve", ABSENT, 1e-6),
    "sigma3": Parameter("as sigma", "standard deviation of a third curve", ABSENT, 1e-6),
}

_LEFT, _RIGHT, _BASE, _PEAK = 26.0, 298.0, 36.0, 136.0
_SPAN = 4.4
"""The axis reaches this many of the largest standard deviations to each side."""


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, hide the density at the mean and the probability.

    Raises
    ------
    BankError
        If marks are asked for on several curves.
    """
    several = "sigma2" in values or "sigma3" in values
    require("gaussian", not (several and values["k"]), "marks need a single curve")
    pen = Pen()
    if values["k"]:
        _shade(pen, values)
    _axes(pen, values)
    _curves(pen, values)
    if values["k"]:
        _probability_label(pen, values, quiz=quiz)
    _peak_labels(pen, values, quiz=quiz)
    pen.onto(canvas)


def _sigmas(values: Values) -> list[float]:
    return [values[name] for name in ("sigma", "sigma2", "sigma3") if name in values]


def _place(values: Values, sigma: float, u: float) -> Point:
    """Where the density of one curve at u of its own standard deviations is drawn."""
    sigmas = _sigmas(values)
    half = (_RIGHT - _LEFT) / 2
    x = (_LEFT + _RIGHT) / 2 + u * sigma / max(sigmas) * half / _SPAN
    return (x, _BASE + (_PEAK - _BASE) * exp(-u * u / 2) * min(sigmas) / sigma)


def _samples(values: Values, sigma: float, start: float, stop: float) -> list[Point]:
    steps = max(2, int((stop - start) / 0.08))
    return [_place(values, sigma, start + (stop - start) * i / steps) for i in range(steps + 1)]


def _intervals(values: Values) -> list[tuple[float, float]]:
    k, tails = values["k"], values["tails"]
    if tails == 0:
        return [(-k, k)]
    lower, upper = (-_SPAN, -k), (k, _SPAN)
    return {2: [lower, upper], 1: [upper], -1: [lower]}[int(tails)]


def _shade(pen: Pen, values: Values) -> None:

    for start, stop in _intervals(values):
        curve = _samples(values, values["sigma"], start, stop)
        pen.area("shaded", [(curve[0][0], _BASE), *curve, (curve[-1][0], _BASE)], DEEP)


def _axes(pen: Pen, values: Values) -> None:

    pen.arrow("axis", (_LEFT - 8, _BASE), (_RIGHT + 8, _BASE), LINE)
    pen.arrow("axis", (_LEFT, _BASE - 6), (_LEFT, 160), LINE)
    pen.label((_RIGHT + 4, _BASE - 11), "n")
    pen.label((_LEFT + 7, 160), "g(n)", "l")
    centre = _place(values, values["sigma"], 0)
    pen.line("mean", [(centre[0], _BASE - 4), (centre[0], _BASE + 4)], THIN)
    _tick(pen, values, 0.0, "μ")
    for sign in (-1, 1):
        _ticks(pen, values, sign)


def _ticks(pen: Pen, values: Values, sign: int) -> None:
    k, text = values["k"], "−" if sign < 0 else "+"
    if not k:
        sigmas = _sigmas(values)
        symbol = f"μ {text} σ" if len(sigmas) == 1 else ""
        _tick(pen, values, sign * max(sigmas) / values["sigma"], symbol)
        return
    factor = "" if k == 1 else given(k)
    _tick(pen, values, sign * k, f"μ {text} {factor}σ")
    _foot(pen, values, sign * k)
    if k != 1:
        _foot(pen, values, sign)
    if abs(k - 1) >= 1:
        _tick(pen, values, sign, "")


def _foot(pen: Pen, values: Values, u: float) -> None:

    x, y = _place(values, values["sigma"], u)
    if abs(u) == values["k"]:
        pen.line("marks", [(x, _BASE - 4), (x, max(y, _BASE + 12))], DASHED)
    else:
        pen.line("ticks", [(x, _BASE - 3), (x, _BASE + 3)], THIN)


def _tick(pen: Pen, values: Values, u: float, symbol: str) -> None:
    """Name a place under the axis: the number, and below it the symbol."""
    x, _ = _place(values, values["sigma"], u)
    pen.line("ticks", [(x, _BASE - 3), (x, _BASE + 3)], THIN)
    pen.label((x, _BASE - 11), given(values["mu"] + u * values["sigma"]), size=9.5)
    if symbol:
        pen.label((x, _BASE - 24), symbol, size=9.5)


def _curves(pen: Pen, values: Values) -> None:
    sigmas = _sigmas(values)
    for number, sigma in enumerate(sigmas):
        reach = _SPAN * max(sigmas) / sigma
        curve = _samples(values, sigma, -min(reach, 6.0), min(reach, 6.0))
        ends = [(_LEFT, _BASE + 0.02), (_RIGHT, _BASE + 0.02)]
        whole = curve if reach <= 6 else [ends[0], *curve, ends[1]]
        pen.line(f"curve-{number}", whole, _style(number))


def _style(number: int) -> Style:

    return Stroke(1.4, dashes=((), (5.0, 2.5), (1.6, 2.0))[number])


def _peak_labels(pen: Pen, values: Values, *, quiz: bool) -> None:
    sigmas = _sigmas(values)
    if len(sigmas) == 1:
        _peak_label(pen, values, quiz=quiz)
        return
    for number, sigma in enumerate(sigmas):
        y = 150 - 15 * number
        text = f"σ = {given(sigma)},  {equation('g(μ)', _peak(sigma), hide=quiz)}"
        pen.line(f"legend-{number}", [(186, y), (206, y)], _style(number))
        pen.label((210, y), text, "l", 9.5)


def _peak_label(pen: Pen, values: Values, *, quiz: bool) -> None:

    x, y = _place(values, values["sigma"], 0)
    pen.line("peak", [(_LEFT, y), (x, y)], DOTTED)
    pen.dot("peak-point", (x, y), 2.0)
    text = equation("g(μ)", _peak(values["sigma"]), hide=quiz)
    if values["k"] and values["tails"] == -1:  # the probability stands on the left
        pen.label((x + 24, y - 15), text, "l")
    else:
        pen.label((_LEFT + 5, y - 9), text, "l")
    pen.label((x + 24, y + 1), f"σ = {given(values['sigma'])}", "l")


def _peak(sigma: float) -> float:
    return 1 / (sqrt(2 * pi) * sigma)


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
        return f"n {side} {given(mu + values['tails'] * width)}"
    shift = f" {'−' if mu > 0 else '+'} {given(abs(mu))}" if mu else ""
    return f"|n{shift}| {'>' if values['tails'] else '≤'} {given(width)}"


def _probability_text(values: Values, *, quiz: bool) -> str:
    return equation(f"P({_event(values)})", 100 * _probability(values), "%", hide=quiz)


def _probability_label(pen: Pen, values: Values, *, quiz: bool) -> None:

    text = _probability_text(values, quiz=quiz)
    width = text_width(text, 10)
    lower = values["tails"] == -1
    left, y = (_LEFT + 4, 123.0) if lower else (WIDTH - 4 - width, 112.0)
    if not lower and left < 194:  # too wide to stand beside the curve
        y = 153.0
    pen.label((left, y), text, "l", 10)
    x, top = _place(values, values["sigma"], _inside(values))
    foot = (x, _BASE + 0.45 * (top - _BASE))
    pen.line("leader", [(left + width * (0.25 if lower else 0.5), y - 8), foot], THIN)
    pen.dot("leader-end", foot, 1.4)


def _inside(values: Values) -> float:
    """Find a place in the shaded area, in standard deviations."""
    if values["tails"] == 0:
        return 0.6 * min(values["k"], 1.5)
    return (values["k"] + 0.3) * (-1 if values["tails"] == -1 else 1)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words.

    In a quiz, leave the density at the mean and the probability out.
    """
    words = words_of(__file__, lang)
    text = words["figure"].format(
        mu=given(values["mu"]), sigmas=words["and"].join(given(s) for s in _sigmas(values))
    )
    if values["k"]:
        text += words["marks"].format(k=given(values["k"]), event=_event(values))
    if quiz:
        return text
    for sigma in _sigmas(values):
        peak = _peak(sigma)
        text += words["peak"].format(
            sigma=given(sigma), relation=relation(peak), peak=derived(peak)
        )
    if values["k"]:
        text += words["area"].format(area=spoken(_probability_text(values, quiz=False)))
    return text
