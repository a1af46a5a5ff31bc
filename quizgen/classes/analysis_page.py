"""The page of the analysis: what the numbers of a class are, and their plots."""

from __future__ import annotations

import csv
import io
import statistics
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.grade_scale import GradeScale, read_grade_scale
from quizgen.classes.gradebook import FOLDER
from quizgen.classes.grading import StudentMarks
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.item_analysis import ClassAnalysis, ClassMistake, analyse_class
from quizgen.classes.key_index import KeyIndex, PaperOutline
from quizgen.classes.manual_grading import marker_agreement
from quizgen.classes.rulings import read_rulings
from quizgen.classes.student_reports import report_css, report_environment
from quizgen.classes.variant_difficulty import VariantEffect
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import escape_csv_formula
from quizgen.figures import Figure, plot_figure
from quizgen.grading.options import GradingOptions
from quizgen.locale import FIRST, language_css, load_words, localise_numbers
from quizgen.paper.answer_key import AnswerKey
from quizgen.paper.grading import QuestionGrader
from quizgen.render.fonts import bangla_faces

FILE, TABLE = "analysis.html", "items.csv"
ITEM_COLUMNS = ("number", "item", "points", "students", "difficulty", "discrimination", "blank",
                "undecided", "minutes", "mistakes", "never chosen")  # fmt: skip
SURE = 0.05
"""Corrected probability below which a difference is shown as one."""
MOST_MISTAKES, MOST_PLOTS = 3, 6


def write_analysis_page(folder: ClassFolder, lang: str = FIRST) -> tuple[ClassAnalysis, Path]:
    """Analyse the graded papers of a class; return the analysis and the path of its page.

    Writes ``analysis.html`` and the statistics of the items as ``items.csv``.

    Raises
    ------
    ClassError
        If nothing has been marked.
    """
    keys = KeyIndex(folder)
    found = analyse_class(iter_marks_with_outlines(GradingHistory(folder.path), keys))
    if not found.students:
        raise ClassError(f"{folder.path}: nothing has been marked yet (quizgen class mark)")
    scale = read_grade_scale(folder.path)
    page = (
        report_environment()
        .get_template("analysis.html.j2")
        .render(
            name=folder.settings.name,
            lang=lang,
            words=load_words(lang, "classes")["analysis"],
            bangla_fonts=bangla_faces([lang], folder.settings.name),
            found=found,
            style=Markup(language_css(":lang({})")) + report_css(),
            svg=_draw_plots(found, scale, lang),
            mean=statistics.fmean(found.totals),
            spread=statistics.stdev(found.totals) if found.students > 1 else 0.0,
            median_minutes=statistics.median(found.minutes) if found.minutes else 0.0,
            agreed=marker_agreement(read_rulings(folder.path)),
            clear=_select_significant_effects(found),
            said=partial(_format_localised, lang),
            number=partial(_format_statistic, lang),
            chance=partial(_format_probability, lang),
            most=MOST_MISTAKES,
            told=lambda mistake: mistake_sentence(mistake, keys.key, lang),
        )
    )
    made = {TABLE: _format_items(found), FILE: page.encode()}
    return found, write_all(folder.path / FOLDER, made, PRIVATE)[-1]


def _format_items(found: ClassAnalysis) -> bytes:
    """Return the statistics of the items as CSV, a row for each, by their printed numbers."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(ITEM_COLUMNS)
    for item in found.items:
        figures = (item.points, item.students, item.difficulty, item.discrimination)
        mistakes = "; ".join(f"{one.students} {one.note}" for one in item.mistakes)
        writer.writerow(
            [
                item.number,
                escape_csv_formula(item.item),
                *("" if value is None else f"{value:.4g}" for value in figures),
                item.blank,
                item.undecided,
                "" if item.minutes is None else f"{item.minutes:.4g}",
                *map(escape_csv_formula, (mistakes, "; ".join(item.never))),
            ]
        )
    return out.getvalue().encode("utf-8-sig")


def iter_marks_with_outlines(
    history: GradingHistory, keys: KeyIndex
) -> Iterator[tuple[StudentMarks, PaperOutline]]:
    """Yield each student's current marks with the outline of that student's paper.

    Whose key was edited is left out.
    """
    changed = keys.find_changed()
    for marks in history.current():
        if marks.student not in changed:
            yield marks, keys.outline(marks.student)


def _select_significant_effects(found: ClassAnalysis) -> list[object]:
    """Return the effects that remain significant after Holm's correction."""
    return [one for one in found.effects if one.corrected < SURE]


def _draw_plots(found: ClassAnalysis, scale: GradeScale, lang: str) -> dict[str, object]:
    """Return the plots of the page as inline SVG, by the names that its layout uses."""
    passing = float(scale.grade_bounds()[-1][1] * Fraction(found.points))
    rows = [
        (item.number, item.difficulty, item.discrimination)
        for item in found.items
        if item.difficulty is not None and item.discrimination is not None
    ]
    shown = max(1, min(len(_select_significant_effects(found)), MOST_PLOTS))
    words = load_words(lang, "classes")["analysis"]
    said = words["distribution"].format(points=_format_localised(lang, "%g", found.points))
    effects = [
        (one, words["effect"].format(template=one.template, quantity=one.quantity))
        for one in found.effects[:shown]
    ]
    return {
        "distribution": _get_inline_svg(
            plot_totals(found.totals, found.points, passing, lang, said)
        ),
        "scatter": _get_inline_svg(plot_items(rows, lang, words["scatter"])) if rows else "",
        "effects": [(one, _get_inline_svg(plot_effect(one, lang, text))) for one, text in effects],
    }


def _get_inline_svg(figure: Figure) -> Markup:
    """Return a figure's SVG as markup that the layout does not escape."""
    return Markup(figure.inline_svg.decode())  # made here, from numbers


def _format_localised(lang: str, form: str, value: float | str) -> str:
    """Return a number in a printf format, with the digits and decimal sign of a language."""
    return localise_numbers(lang, form % value)


def _format_statistic(lang: str, value: float | None) -> str:
    """Return a statistic with two decimals; a dash if the points do not determine it."""
    return "–" if value is None else _format_localised(lang, "%.2f", value)


def _format_probability(lang: str, value: float) -> str:
    """Return a probability with three decimals, or that it is less than 0.001."""
    return (
        _format_localised(lang, "< %s", "0.001")
        if value < 0.001
        else _format_localised(lang, "%.3f", value)
    )


def mistake_sentence(mistake: ClassMistake, key_of: Callable[[str], AnswerKey], lang: str) -> str:
    """Return the feedback on a mistake, from an answer of a student who made it.

    Numbers differ from paper to paper, so the sentence needs one paper's key; without it, the note.
    """
    example = mistake.example
    for question in key_of(example.student).questions:
        for part in question.parts:
            if part.id == example.part:
                found = QuestionGrader(question, GradingOptions(lang)).grade_part(
                    part, example.typed
                )
                return found.verdict.message or mistake.note
    return mistake.note


MOST_BARS = 24
WEAK = 0.2
"""Discrimination below which an item is shown in red."""
_SIZE = (340.0, 150.0)


def _draw_plot(draw: Any, lang: str, axes: tuple[str, str], caption: str, height: float) -> Figure:
    """Return a figure that ``draw(ax)`` fills, with named axes.

    ``axes`` are the keys of the axis names in ``classes.toml``, ``height`` is in points.
    """
    words = load_words(lang, "classes")["analysis"]

    def draw_named(ax: Any) -> None:
        """Draw the plot, then name its axes."""
        draw(ax)
        ax.set_xlabel(words[axes[0]] if axes[0] else "")
        ax.set_ylabel(words[axes[1]])

    return plot_figure(draw_named, caption, lang, (_SIZE[0], height))


def plot_totals(
    totals: Sequence[float], points: float, passing: float, lang: str, caption: str
) -> Figure:
    """Return a histogram of the students' points; a red line marks the pass mark."""

    def draw(ax: Any) -> None:
        """Draw the histogram of the totals, with a line at the points that pass."""
        from matplotlib.ticker import MaxNLocator

        bars = min(MOST_BARS, max(5, int(np.sqrt(len(totals)) * 2)))
        edges = np.linspace(0, max(points, 1), bars + 1)
        ax.hist(totals, bins=edges.tolist(), color="shade", edgecolor="ink", linewidth=0.7)
        ax.axvline(passing, color="red", linewidth=1.4, linestyle="-")
        ax.yaxis.set_major_locator(MaxNLocator(integer=True))

    return _draw_plot(draw, lang, ("axis_points", "axis_students"), caption, _SIZE[1])


def plot_items(rows: Sequence[tuple[str, float, float]], lang: str, caption: str) -> Figure:
    """Return a scatter plot of difficulty and discrimination, each item labelled by its number.

    ``rows`` are item number, difficulty (mean share of the points) and discrimination.
    """

    def draw(ax: Any) -> None:
        """Draw a dot for each question at (difficulty, discrimination), the weak ones in red."""
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
    """Return the mean share of the points for each value, with 95 % error bars."""

    def draw(ax: Any) -> None:
        """Draw the share of right answers at each level, with bars of 95 % confidence."""
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
