"""A histogram of few grey levels, with the number of pixels above each bar."""

from __future__ import annotations

from typing import Any

from quizgen.figures.kit import ABSENT, Parameter, Values, format_given

SIZE = (250.0, 90.0)
PARAMETERS = {
    "counts": Parameter("px", "pixels of level 0, 1, ...", low=0.0, kind="list"),
    "t": Parameter("", "threshold: the highest level of the dark class", ABSENT, 0.0, 6.0),
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


def draw(ax: Any, values: Values, *, quiz: bool) -> None:
    """Draw the bars; in a quiz, leave out the threshold."""
    counts = values["counts"]
    ax.bar(range(len(counts)), counts, width=0.65, color="shade", edgecolor="ink")
    for level, count in enumerate(counts):
        ax.annotate(format_given(count), (level, count), (0, 3), textcoords="offset points",
                    ha="center")  # fmt: skip
    last = len(counts) - 1
    ax.set_xticks([0, last])  # all of them would show the level that is asked for
    ax.set(xlim=(-0.7, last + 0.7), ylim=(0, 1.15 * max(*counts, 1.0)), yticks=[], xlabel="$g$")
    ax.spines.left.set_visible(False)
    if "t" in values and not quiz:
        ax.axvline(values["t"] + 0.5, color="red", linestyle="--")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out the threshold."""
    words = WORDS.get(lang, WORDS["en"])
    counts = values["counts"]
    text = words["figure"].format(count=len(counts), list=", ".join(map(format_given, counts)))
    if "t" not in values or quiz:
        return text
    low = int(values["t"])
    return text + words["threshold"].format(low=low, high=low + 1)
