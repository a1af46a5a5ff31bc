"""The page of the analysis: what the numbers of a class are, and their plots."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path

from markupsafe import Markup

from quizgen.classes import plots
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
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, write_all
from quizgen.figures import Figure
from quizgen.grading.options import GradingOptions
from quizgen.locale import FIRST, language_css, load_words, localise_numbers
from quizgen.paper.answer_key import AnswerKey
from quizgen.paper.grading import QuestionGrader
from quizgen.render.fonts import bangla_faces

FILE = "analysis.html"
SURE = 0.05
"""Corrected probability below which a difference is shown as one."""
MOST_MISTAKES, MOST_PLOTS = 3, 6


def write_analysis_page(folder: ClassFolder, lang: str = FIRST) -> tuple[ClassAnalysis, Path]:
    """Analyse a class and write the page in a language.

    Raises
    ------
    ClassError
        If nothing has been marked.
    """
    keys = KeyIndex(folder)
    found = analyse_class(_iter_marks_with_outlines(GradingHistory(folder.path), keys))
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
    return found, write_all(folder.path / FOLDER, {FILE: page.encode()}, PRIVATE)[0]


def _iter_marks_with_outlines(
    history: GradingHistory, keys: KeyIndex
) -> Iterator[tuple[StudentMarks, PaperOutline]]:
    for marks in history.current():
        yield marks, keys.outline(marks.student)


def _select_significant_effects(found: ClassAnalysis) -> list[object]:
    return [one for one in found.effects if one.corrected < SURE]


def _draw_plots(found: ClassAnalysis, scale: GradeScale, lang: str) -> dict[str, object]:
    passing = float(scale.grade_bounds()[-1][1] * Fraction(found.points))
    rows = [
        (str(number), item.difficulty, item.discrimination)
        for number, item in enumerate(found.items, 1)
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
            plots.plot_totals(found.totals, found.points, passing, lang, said)
        ),
        "scatter": _get_inline_svg(plots.plot_items(rows, lang, words["scatter"])) if rows else "",
        "effects": [
            (one, _get_inline_svg(plots.plot_effect(one, lang, text))) for one, text in effects
        ],
    }


def _get_inline_svg(figure: Figure) -> Markup:
    return Markup(figure.inline_svg.decode())  # made here, from numbers


def _format_localised(lang: str, form: str, value: float | str) -> str:
    return localise_numbers(lang, form % value)


def _format_statistic(lang: str, value: float | None) -> str:
    return "–" if value is None else _format_localised(lang, "%.2f", value)


def _format_probability(lang: str, value: float) -> str:
    return (
        _format_localised(lang, "< %s", "0.001")
        if value < 0.001
        else _format_localised(lang, "%.3f", value)
    )


def mistake_sentence(mistake: ClassMistake, key_of: Callable[[str], AnswerKey], lang: str) -> str:
    """What the checker says of a mistake, by the example of somebody who made it."""
    example = mistake.example
    for question in key_of(example.student).questions:
        for part in question.parts:
            if part.id == example.part:
                found = QuestionGrader(question, GradingOptions(lang)).grade_part(
                    part, example.typed
                )
                return found.verdict.message or mistake.note
    return mistake.note
