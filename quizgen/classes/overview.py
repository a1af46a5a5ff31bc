"""The page of the analysis: what the numbers of a class are, and their plots."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path

from markupsafe import Markup

from quizgen.classes import plots
from quizgen.classes.analysis import Analysis, Mistake, analysed
from quizgen.classes.decide import agreement
from quizgen.classes.folder import ClassFolder
from quizgen.classes.grades import FOLDER
from quizgen.classes.history import History
from quizgen.classes.keys import Keys, Outline
from quizgen.classes.mark import Marks
from quizgen.classes.reports import layouts, style
from quizgen.classes.rulings import read_rulings
from quizgen.classes.scale import Scale, read_scale
from quizgen.errors import ClassError
from quizgen.figures import Figure
from quizgen.files import PRIVATE, write_all
from quizgen.locale import FIRST, numbers_in, styles, table
from quizgen.marking.options import Options
from quizgen.paper.key import Key
from quizgen.paper.marking import Marker
from quizgen.render.fonts import bangla_faces

FILE = "analysis.html"
SURE = 0.05
"""Corrected probability below which a difference is shown as one."""
MOST_MISTAKES, MOST_PLOTS = 3, 6


def analyse(folder: ClassFolder, lang: str = FIRST) -> tuple[Analysis, Path]:
    """Analyse a class and write the page in a language.

    Raises
    ------
    ClassError
        If nothing has been marked.
    """
    keys = Keys(folder)
    found = analysed(_pairs(History(folder.path), keys))
    if not found.students:
        raise ClassError(f"{folder.path}: nothing has been marked yet (quizgen class mark)")
    scale = read_scale(folder.path)
    page = (
        layouts()
        .get_template("analysis.html.j2")
        .render(
            name=folder.settings.name,
            lang=lang,
            words=table(lang, "classes")["analysis"],
            bangla_fonts=bangla_faces([lang], folder.settings.name),
            found=found,
            style=Markup(styles(":lang({})")) + style(),
            svg=_plots(found, scale, lang),
            mean=statistics.fmean(found.totals),
            spread=statistics.stdev(found.totals) if found.students > 1 else 0.0,
            median_minutes=statistics.median(found.minutes) if found.minutes else 0.0,
            agreed=agreement(read_rulings(folder.path)),
            clear=_clear(found),
            said=partial(_said, lang),
            number=partial(_number, lang),
            chance=partial(_chance, lang),
            most=MOST_MISTAKES,
            told=lambda mistake: told(mistake, keys.key, lang),
        )
    )
    return found, write_all(folder.path / FOLDER, {FILE: page.encode()}, PRIVATE)[0]


def _pairs(history: History, keys: Keys) -> Iterator[tuple[Marks, Outline]]:
    for marks in history.current():
        yield marks, keys.outline(marks.student)


def _clear(found: Analysis) -> list[object]:
    return [one for one in found.effects if one.corrected < SURE]


def _plots(found: Analysis, scale: Scale, lang: str) -> dict[str, object]:
    passing = float(scale.bounds()[-1][1] * Fraction(found.points))
    rows = [
        (str(number), item.difficulty, item.discrimination)
        for number, item in enumerate(found.items, 1)
        if item.difficulty is not None and item.discrimination is not None
    ]
    shown = max(1, min(len(_clear(found)), MOST_PLOTS))
    words = table(lang, "classes")["analysis"]
    said = words["distribution"].format(points=_said(lang, "%g", found.points))
    effects = [
        (one, words["effect"].format(template=one.template, quantity=one.quantity))
        for one in found.effects[:shown]
    ]
    return {
        "distribution": _inline(plots.plot_totals(found.totals, found.points, passing, lang, said)),
        "scatter": _inline(plots.plot_items(rows, lang, words["scatter"])) if rows else "",
        "effects": [(one, _inline(plots.plot_effect(one, lang, text))) for one, text in effects],
    }


def _inline(figure: Figure) -> Markup:
    return Markup(figure.inline_svg.decode())  # made here, from numbers


def _said(lang: str, form: str, value: float | str) -> str:
    return numbers_in(lang, form % value)


def _number(lang: str, value: float | None) -> str:
    return "–" if value is None else _said(lang, "%.2f", value)


def _chance(lang: str, value: float) -> str:
    return _said(lang, "< %s", "0.001") if value < 0.001 else _said(lang, "%.3f", value)


def told(mistake: Mistake, key_of: Callable[[str], Key], lang: str) -> str:
    """What the checker says of a mistake, by the example of somebody who made it."""
    example = mistake.example
    for question in key_of(example.student).questions:
        for part in question.parts:
            if part.id == example.part:
                found = Marker(question, Options(lang)).mark(part, example.typed)
                return found.verdict.message or mistake.note
    return mistake.note
