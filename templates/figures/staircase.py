"""A quantiser as a staircase: the code over the intensity, by one of four ways of rounding."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_equation,
    format_given,
    load_alt_words,
    strip_mathtext,
)

from ._plots import trace_lines

PARAMETERS = {
    "n": Parameter("", "number of levels", low=2.0, high=16.0, whole=True),
    "rule": Parameter(
        "", "0 nearest, 1 down, 2 down by n equal parts, 3 up", 0.0, 0.0, 3.0, whole=True
    ),
}
SIZE = (262.0, 116.0)

_MOST = 64  # levels of a learner that can still be drawn


def list_jumps(values: Values) -> list[float]:
    """Intensities at which the code rises by 1."""
    n = int(values["n"])
    first, parts = ((0.5, n - 1), (1.0, n - 1), (1.0, n), (0.0, n - 1))[int(values["rule"])]
    return [(first + k) / parts for k in range(n - 1)]


def draw(ax: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the line without steps, n and the step."""
    n, jumps = int(values["n"]), list_jumps(values)
    ax.set(xlim=(0, 1), ylim=(0, 1.12 * (n - 1)))
    tenths = [tenth / 10 for tenth in range(11)]
    ax.set_xticks(tenths, map(format_given, tenths))
    ax.set_yticks(range(n), ["0", *[""] * (n - 1)])  # how many there are is asked
    ax.grid()
    ax.set_xlabel("$I$")
    ax.set_ylabel("$k$")
    art = ax.figure.sketch(ax)
    if not quiz:
        art.line([(0, 0), (1, n - 1)], "red", 0.8, dashes=(1.2, 1.8), part="line")
        text = f"$n$ = {n},   {format_equation('$Δ$', 1 / (n - 1))}"
        art.label((0, 1.12 * (n - 1)), text, "l", 10, "red", shift=(28, 11.5), part="answer")
    rises = [[(jump, level), (jump, level + 1)] for level, jump in enumerate(jumps)]
    treads = _list_treads(jumps, 1.0)
    art.shape(trace_lines(rises), None, "blue", 0.4, part="rises")
    art.shape(trace_lines(treads), None, "blue", 1.8, part="staircase")
    for at, level in ((0, 0), (1, n - 1)):
        if at in jumps:  # a tread of a single point
            art.dot((at, level), 2.2, "blue", part="staircase")


def _list_treads(jumps: list[float], rise: float) -> list[list[tuple[float, float]]]:
    """Ends of the treads, each so much higher than the one before."""
    ends = enumerate(pairwise([0.0, *jumps, 1.0]))
    return [[(a, level * rise), (b, level * rise)] for level, (a, b) in ends if b > a]


MARKS = {"n": "", "Delta": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(ax: Any, values: Values, marks: Values) -> None:
    """Draw the staircase of a learner's ``n`` or ``Delta`` over the same range of intensities."""
    wanted = marks["n"] if "n" in marks else 1 + 1 / max(marks["Delta"], 1e-3)
    n = min(max(round(wanted), 2), _MOST)
    jumps = list_jumps({**values, "n": n})
    treads = _list_treads(jumps, (values["n"] - 1) / (n - 1))
    art = ax.figure.sketch(ax, zorder=6)
    art.line([end for tread in treads for end in tread], "gold", 1.1, part="learned")
    name, value = ("n", marks["n"]) if "n" in marks else ("Δ", marks["Delta"])
    art.label((1, 1.12 * (values["n"] - 1)), f"${name}$ = {format_derived(value)}", "r", 10,
              "gold", shift=(0, 11.5), part="learned")  # fmt: skip


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out n and the step."""
    words = load_alt_words(__file__, lang)
    at = ", ".join(format_derived(round(jump, 3)) for jump in list_jumps(values))
    told = words["figure"].format(jumps=at) + words[f"ends {int(values['rule'])}"]
    if quiz:
        return told
    n = int(values["n"])
    step = strip_mathtext(format_equation("Δ", 1 / (n - 1)))
    return told + words["answer"].format(n=n, step=step)
