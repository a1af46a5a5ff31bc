"""The plot: right digits of every printed formula against the distance to its difficulty."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Any

from quizgen.figures import Figure, plot_figure
from quizgen.tradeoff.digits import MOST_DIGITS
from quizgen.tradeoff.report import TradeoffReport

SIZE = (380.0, 170.0)
ITERATED = "inverse-distortion"  # loses its digits by its steps, not by a subtraction


def draw_digits(report: TradeoffReport, alt: str, lang: str) -> Figure:
    """The printed formulas with their exam inputs, and the stable forms."""

    def draw(ax: Any) -> None:
        ax.set_xscale("log")
        ax.set_xlim(1, 1e-15)
        ax.set_ylim(0, MOST_DIGITS + 0.6)
        ax.set_xticks([10.0**-n for n in range(0, 16, 3)])
        ax.set_yticks(range(0, MOST_DIGITS + 1, 4))
        ax.minorticks_off()
        ax.tick_params(labelsize=10)
        ax.grid(True)
        ax.axvspan(1, report.exam, color="pale-gold", linewidth=0, zorder=0)
        for one in report.sweeps:
            colour, width = ("red", 1.6) if one.name == ITERATED else ("blue", 0.7)
            if "stable" in one.ways:
                stable = _compute_running_minimum(one.ways["stable"].digits)
                ax.plot(one.left, stable, color="teal", linewidth=0.8, linestyle="-")
            printed = _compute_running_minimum(one.ways["float64"].digits)
            ax.plot(one.left, printed, color=colour, linewidth=width, linestyle="-")
            ax.plot([one.exam_left], [one.exam_digits], "o", color=colour, markersize=4)

    return plot_figure(draw, alt, lang, SIZE)


def _compute_running_minimum(digits: Sequence[float]) -> list[float]:
    """The fewest digits up to each place: a result that is right by chance is no promise."""
    return list(accumulate((min(count, MOST_DIGITS) for count in digits), min))
