"""Plots of the analysis, drawn as the papers' figures are; the page says below what they show."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from quizgen.classes.variant_difficulty import VariantEffect
from quizgen.figures import Figure, plot_figure
from quizgen.locale import load_words, localise_numbers

MOST_BARS = 24
WEAK = 0.2
"""Discrimination below which an item is shown in red."""
_SIZE = (340.0, 150.0)


def _draw_plot(draw: Any, lang: str, axes: tuple[str, str], caption: str, height: float) -> Figure:
    words = load_words(lang, "classes")["analysis"]

    def draw_named(ax: Any) -> None:
        draw(ax)
        ax.set_xlabel(words[axes[0]] if axes[0] else "")
        ax.set_ylabel(words[axes[1]])

    return plot_figure(draw_named, caption, lang, (_SIZE[0], height))


def plot_totals(
    totals: Sequence[float], points: float, passing: float, lang: str, caption: str
) -> Figure:
    """How many students have how many points; the pass mark is a red line."""

    def draw(ax: Any) -> None:
        from matplotlib.ticker import MaxNLocator

        bars = min(MOST_BARS, max(5, int(np.sqrt(len(totals)) * 2)))
        edges = np.linspace(0, max(points, 1), bars + 1)
        ax.hist(totals, bins=edges.tolist(), color="shade", edgecolor="ink", linewidth=0.7)
        ax.axvline(passing, color="red", linewidth=1.4, linestyle="-")
        ax.yaxis.set_major_locator(MaxNLocator(integer=True))

    return _draw_plot(draw, lang, ("axis_points", "axis_students"), caption, _SIZE[1])


def plot_items(rows: Sequence[tuple[str, float, float]], lang: str, caption: str) -> Figure:
    """Difficulty against discrimination, an item a point with its number in the table."""

    def draw(ax: Any) -> None:
        ax.axhline(0.0, color="rule", linestyle="-")
        ax.axhline(WEAK, color="grey", linestyle=(0, (4, 2.5)), linewidth=0.8)
        heights = [row[2] for row in rows]
        ax.set(xlim=(0, 1.03), ylim=(min(0.0, *heights) - 0.05, max(0.4, *heights) + 0.1))
        sketch = ax.figure.sketch(ax, zorder=4)
        for name, difficulty, discrimination in rows:
            ink = "red" if discrimination < WEAK else "ink"
            sketch.dot((difficulty, discrimination), 2.0, ink, part="items")
            sketch.label((difficulty, discrimination), name, "lb", 8, ink, shift=(3, 2))

    return _draw_plot(draw, lang, ("axis_difficulty", "axis_discrimination"), caption, 190.0)


def plot_effect(effect: VariantEffect, lang: str, caption: str) -> Figure:
    """Mean share of the points by value, with 95 % of its error."""

    def draw(ax: Any) -> None:
        places = np.arange(len(effect.levels))
        ax.errorbar(
            places,
            [level.share for level in effect.levels],
            [1.96 * level.error for level in effect.levels],
            fmt="o", color="ink", markersize=3, capsize=2.5, linewidth=0.8,
        )  # fmt: skip
        names = [
            f"{localise_numbers(lang, level.name[:24])}\n$n$ = {level.students}"
            for level in effect.levels
        ]
        ax.set_xticks(places, names)
        ax.set(xlim=(-0.5, len(places) - 0.5), ylim=(-0.03, 1.03))

    return _draw_plot(draw, lang, ("", "axis_share"), caption, 120.0)
