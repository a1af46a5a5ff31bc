"""Every output of a template, made once, so that lint finds what only printing does.

Lint draws and marks hundreds of variants without a page; a key that cannot be typeset, an option
that no course system takes or a figure that no card can hold would show first in ``exam``.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from quizgen.core.errors import QuizgenError

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank
    from quizgen.bank.template import Template
    from quizgen.bank.variant import Variant
    from quizgen.core.diagnostics import Diagnostic
    from quizgen.paper.paper import Paper

SEED = 0


def check_outputs(bank: Bank, template: Template) -> Iterator[Diagnostic]:
    """Yield what fails when one variant is written in every format.

    Text, page, print, card, export and practice: an author may never try them all.
    """
    from quizgen.question.compose import draw_instance

    drawn = draw_instance(template, SEED)
    paper: list[Paper] = []
    made = _diagnose_failure(
        template.file, "question", lambda: paper.append(_build_single_paper(drawn))
    )
    if made or not paper:
        yield from filter(None, (made,))
        return
    for output, make in _iter_outputs(bank, drawn, paper[0]):
        failure = _diagnose_failure(template.file, output, make)
        if failure:
            yield failure


def check_sheet(bank: Bank) -> Iterator[Diagnostic]:
    """Yield what fails when the formula sheet of a bank is rendered."""
    from quizgen.bank.formulas import read_formulas
    from quizgen.question.formula_sheet import compose_sheet
    from quizgen.render import SHEET_FORMATS, render_sheet

    if not read_formulas(bank):
        return
    # A language that only some templates have is none of the sheet's.
    made = compose_sheet(bank, "both" if len(bank.languages) > 1 else bank.languages[0])
    for output in SHEET_FORMATS:
        make = partial(render_sheet, made, output)
        failure = _diagnose_failure(
            bank.folder / "cards" / "formulas.toml", f"sheet {output}", make
        )
        if failure:
            yield failure


def _diagnose_failure(file: Path, output: str, make: Callable[[], object]) -> Diagnostic | None:
    """Return the diagnostic of an output that fails, else None."""
    from quizgen.core.diagnostics import diagnose

    try:
        made = make()
        if isinstance(made, Iterator):
            for _ in made:
                pass
    except QuizgenError as error:
        if error.rule:
            return error.diagnostic(file)
        return diagnose("QG601", error.file or file, f"{output}: {error.message}", error.place)
    except Exception as error:  # noqa: BLE001 - whatever stops a page stops a paper
        at = traceback.extract_tb(error.__traceback__)[-1]
        what = f"{output}: {type(error).__name__}: {error} (in {at.filename}:{at.lineno})"
        return diagnose("QG601", file, what)
    return None


def _build_single_paper(drawn: Variant) -> Paper:
    """Return a paper of one variant, in all languages of its template."""
    from quizgen.paper.blueprint import Blueprint, SlotRule
    from quizgen.paper.paper import Paper, PaperItem
    from quizgen.question.compose import compose_variant

    template = drawn.template
    pairs = [compose_variant(drawn, lang) for lang in template.languages]
    item = PaperItem("1", tuple(question for question, _ in pairs), tuple(key for _, key in pairs))
    slot = SlotRule(templates=(template.id,))
    blueprint = Blueprint({"en": template.id}, (slot,), name=template.id, minutes=1)
    return Paper(f"{template.id}-{SEED}", blueprint, template.languages, (item,))


def _iter_outputs(
    bank: Bank, drawn: Variant, paper: Paper
) -> Iterator[tuple[str, Callable[[], object]]]:
    """Yield the name of each output and a function that makes it."""
    from quizgen.cards.kinds.question import template_notes
    from quizgen.cards.request import DeckRequest
    from quizgen.lms import FORMATS
    from quizgen.question.levels import LEVELS, load_level
    from quizgen.render import KINDS, RENDERERS, render_paper
    from quizgen.web.question_view import QuestionRequest, run_request

    template, langs = drawn.template, drawn.template.languages
    for name in LEVELS:
        if load_level(name).is_applicable(drawn):
            for lang in langs:
                yield f"preview --level {name}", partial(_format_preview, drawn, lang, name)
    for output in RENDERERS:
        for kind in KINDS:
            yield f"{kind} {output}", partial(render_paper, paper, kind, output)
    yield "cards", lambda: template_notes(template, DeckRequest(langs, bank=bank))
    for lang in langs:
        yield "practice", partial(run_request, bank, QuestionRequest(template.id, str(SEED), lang))
    for name in FORMATS:
        yield f"export {name}", partial(_export_question, name, paper)


def _format_preview(drawn: Variant, lang: str, name: str) -> str:
    """Return a question at a level as plain text."""
    from quizgen.paper.paper import PaperItem
    from quizgen.question.compose import compose_variant
    from quizgen.render.text import format_question

    question, key = compose_variant(drawn, lang, level=name, figures=False)
    return format_question(PaperItem("1", (question,), (key,)))


def _export_question(name: str, paper: Paper) -> Iterable[object]:
    """Return all that an export makes of a question, to see that nothing fails."""
    from quizgen.lms import get_exporter
    from quizgen.lms.items import ExportItem, manual_parts

    (asked,) = paper.items
    item = ExportItem(f"{paper.code}.1", paper.code, asked.questions[0], asked.keys[0])
    target = get_exporter(name)
    return [target.write([item]), *manual_parts(item), *target.list_questions(item)]
