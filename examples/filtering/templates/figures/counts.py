"""A histogram of few grey levels, with the number of pixels above each bar."""

from __future__ import annotations

from quizgen.figures.kit import ABSENT, DASHED, DEEP, LINE, Canvas, Parameter, Pen, Values, given

DARK = "invert"

MOST = 8
PARAMETERS = {
    **{f"h{k}": Parameter("px", f"pixels of level {k}", ABSENT, 0.0) for k in range(MOST)},
    "t": Parameter("", "threshold: 0 is the highest level of the dark class", ABSENT, 0.0, 6.0),
}

WORDS = {
    "en": {
        "figure": "Histogram of {count} grey levels. Pixels from dark to bright: {list}.",
        "threshold": " A dashed line stands between the levels {low} and {high}.",
    },
    "de": {
        "figure": "Histogramm von {count} Graustufen. Pixel von dunkel nach hell: {list}.",
        "threshold": " Eine gestrichelte Linie steht zwischen den Stufen {low} und {high}.",
    },
}

LEFT, LOW, HIGH, STEP, BAR = 24.0, 26.0, 110.0, 34.0, 22.0


def _bars(values: Values) -> list[float]:
    return [values[f"h{k}"] for k in range(MOST) if f"h{k}" in values]


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the threshold."""
    bars = _bars(values)
    pen = Pen(2 * LEFT + STEP * len(bars), HIGH + 24)
    tall = max(*bars, 1.0)
    for k, bar in enumerate(bars):
        x, top = LEFT + STEP * (k + 0.5), LOW + (HIGH - LOW) * bar / tall
        corners = [(x - BAR / 2, LOW), (x + BAR / 2, LOW), (x + BAR / 2, top), (x - BAR / 2, top)]
        pen.area("bars", corners, DEEP)
        pen.label((x, top + 8), given(bar), size=9)
        if k in {0, len(bars) - 1}:  # all of them would show the level that is asked for
            pen.label((x, LOW - 11), given(k), size=9.5)
    pen.line("axis", [(LEFT - 4, LOW), (pen.width - LEFT + 6, LOW)], LINE)
    if "t" in values and not quiz:
        x = LEFT + STEP * (values["t"] + 1)
        pen.line("threshold", [(x, LOW - 6), (x, HIGH + 16)], DASHED)
    pen.label((pen.width - 8, LOW - 11), "g")
    pen.onto(canvas)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out the threshold."""
    words = WORDS.get(lang, WORDS["en"])
    bars = _bars(values)
    listed = ", ".join(map(given, bars))
    told = words["figure"].format(count=len(bars), list=listed)
    if "t" not in values or quiz:
        return told
    low = int(values["t"])
    return told + words["threshold"].format(low=low, high=low + 1)
