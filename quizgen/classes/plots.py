"""Plots of the analysis as SVG, in the letters and lines of the papers' figures.

They hold numbers; what these are is said below them, in any language and script.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from quizgen.classes.effects import Effect
from quizgen.locale import numbers_in

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK, GREY, RED = "#000000", "#a0a0a0", "#c00000"
LOOK: dict[Any, Any] = {
    "font.family": "STIXGeneral",
    "font.size": 10.5,
    "mathtext.fontset": "stix",
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.0,
    "patch.linewidth": 0.8,
    "svg.hashsalt": "quizgen",
    "svg.fonttype": "path",
}
MOST_BARS = 24
_CM = 1 / 2.54
_HEAD = re.compile(r"^.*?(?=<svg)|<metadata>.*?</metadata>", re.DOTALL)


@contextmanager
def _axes(made: list[str], lang: str, height: float = 6.0) -> Iterator[Axes]:
    """Axes to plot on; the SVG is put into ``made`` afterwards, the same on any day."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(LOOK):
        figure = Figure(figsize=(13 * _CM, height * _CM), layout="constrained")
        axes = figure.add_subplot()
        yield axes
        _say_ticks(axes, lang)
        out = io.StringIO()
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    made.append(_HEAD.sub("", out.getvalue()))


def _say_ticks(axes: Axes, lang: str) -> None:
    """Write the numbers at the axes with the decimal sign of a language."""
    from matplotlib.ticker import ScalarFormatter

    class Told(ScalarFormatter):
        def __call__(self, x: float, pos: int | None = None) -> str:
            return numbers_in(lang, super().__call__(x, pos))

    for axis in (axes.xaxis, axes.yaxis):
        if isinstance(axis.get_major_formatter(), ScalarFormatter):
            axis.set_major_formatter(Told())


def distribution(totals: Sequence[float], points: float, passing: float, lang: str) -> str:
    """How many students have how many points; the pass mark is a red line."""
    from matplotlib.ticker import MaxNLocator

    made: list[str] = []
    edges = np.linspace(
        0, max(points, 1), min(MOST_BARS, max(5, int(np.sqrt(len(totals)) * 2))) + 1
    )
    with _axes(made, lang) as axes:
        axes.hist(totals, bins=edges.tolist(), color="#d2d2d2", edgecolor=INK)
        axes.axvline(passing, color=RED, linewidth=1.4)
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    return made[0]


def items(rows: Sequence[tuple[str, float, float]], lang: str) -> str:
    """Difficulty against discrimination, an item a point with its number in the table."""
    made: list[str] = []
    with _axes(made, lang, 8.0) as axes:
        axes.axhline(0.0, color=GREY)
        axes.axhline(0.2, color=GREY, linestyle=(0, (4, 2.5)))
        for name, difficulty, discrimination in rows:
            weak = discrimination < 0.2
            axes.plot(difficulty, discrimination, "o", color=RED if weak else INK, markersize=3)
            axes.annotate(name, (difficulty, discrimination), xytext=(3, 3),
                          textcoords="offset points", fontsize=8)  # fmt: skip
        axes.set_xlim(0, 1.03)
    return made[0]


def effect(found: Effect, lang: str) -> str:
    """Mean share of the points by value, with 95 % of its error."""
    made: list[str] = []
    places = np.arange(len(found.levels))
    with _axes(made, lang, 5.0) as axes:
        axes.errorbar(
            places,
            [level.share for level in found.levels],
            [1.96 * level.error for level in found.levels],
            fmt="o", color=INK, markersize=3, capsize=2.5, linewidth=0.8,
        )  # fmt: skip
        names = [
            f"{numbers_in(lang, level.name[:24])}\nn = {level.students}" for level in found.levels
        ]
        axes.set_xticks(places, names, fontsize=8)
        axes.set_xlim(-0.5, len(places) - 0.5)
        axes.set_ylim(-0.03, 1.03)
    return made[0]
