"""Questions as HTML for pages of a course, which have neither our style sheet nor our fields.

How formulas are written is one choice for a whole file: ``formula_dialect`` sets it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial
from html import escape
from itertools import islice, zip_longest

from markupsafe import Markup
from msgspec.structs import replace

from quizgen import typeset
from quizgen.bank.pictures import PictureFile
from quizgen.core.errors import require_one_of
from quizgen.figures import Figure
from quizgen.kinds.asking import nonempty, unit_hint
from quizgen.lms.interactions import (
    ChoiceInteraction,
    FeedbackText,
    Interaction,
    MatchInteraction,
    NumericInteraction,
    OrderInteraction,
    PartInteractions,
    TextEntryInteraction,
    needs_manual_grading,
)
from quizgen.lms.items import ExportItem
from quizgen.locale import translate
from quizgen.maths.units import format_unit
from quizgen.paper.paper import PaperItem
from quizgen.question import html
from quizgen.question.compose import QuestionPart
from quizgen.question.html import HtmlDialect, display_mathml
from quizgen.question.solution import PartSolution
from quizgen.render.html import render_html_fragment
from quizgen.render.text import inlines_to_plain_text
from quizgen.typeset.prose import Block, Inline, PlacedField, PlainText, name_inline

# Tries after which Moodle shows a hint.
HINT_COUNT = 3

# Classes mean nothing without our style sheet; the language stands once around the whole.
_STYLING = re.compile(r' (?:class|lang)="[^"]*"')


def _tex_formula(node: typeset.Node, lang: str, marks: str = "()") -> str:
    """Return a formula in LaTeX between the delimiters of MathJax: ``()`` or ``[]``."""
    return rf"\{marks[0]}{escape(typeset.to_latex(node, lang), quote=False)}\{marks[1]}"


# How formulas are written: as MathML, or for a filter such as MathJax.
FORMULA_DIALECTS = {
    "mathml": HtmlDialect(typeset.to_mathml, display_mathml, ours=False),
    "tex": HtmlDialect(_tex_formula, partial(_tex_formula, marks="[]"), ours=False),
}
_manner = ContextVar("manner", default=FORMULA_DIALECTS["mathml"])


@contextmanager
def pictures_from(source: Callable[[PictureFile], str]) -> Iterator[None]:
    """Let pages refer to pictures of a bank instead of embedding them, within this context."""
    before = _manner.set(_manner.get()._replace(source=source))
    try:
        yield
    finally:
        _manner.reset(before)


@contextmanager
def formula_dialect(name: str) -> Iterator[None]:
    """Write formulas as one of ``FORMULA_DIALECTS`` within this context.

    Raises
    ------
    InvalidChoiceError
        Naming the dialects there are.
    """
    before = _manner.set(
        FORMULA_DIALECTS[require_one_of("way of formulas", name, FORMULA_DIALECTS)]
    )
    try:
        yield
    finally:
        _manner.reset(before)


def to_course_html(words: Inline | FeedbackText, lang: str) -> Markup:
    """Return a sentence, or pieces of one, as HTML."""
    return html.inlines_to_html(words, lang, _manner.get())


def _blocks_html(parts: Sequence[Block], lang: str) -> Markup:
    """Return blocks of a question as HTML in the chosen dialect of formulas."""
    return html.blocks_to_html(parts, lang, _manner.get())


def with_language(page: Markup, lang: str) -> Markup:
    """Return a page that says its language, since that of the course may be another."""
    return Markup('<div lang="{}">{}</div>').format(lang, page)


def stem_html(item: ExportItem, source: FigureAddress) -> Markup:
    """Return what stands before the parts."""
    return _blocks_html(item.question.stem, item.lang) + image_tag(item.question.figure, source)


def part_html(
    part: QuestionPart,
    interactions: Sequence[Interaction],
    lang: str,
    source: FigureAddress,
    *,
    alone: bool = False,
) -> Markup:
    """Return a part, with its options if a person grades it, and how its answer is to be typed.

    ``alone`` says that no other part stands before it, which may hold the text of its field.
    """
    options = _options_list(part, lang) if needs_manual_grading(interactions) else Markup("")
    advice = Markup(" ").join(_typing_advice(part, interactions, lang))
    hint = Markup("<p><small>{}</small></p>").format(advice) if advice else Markup("")
    drawing = part.field.drawing
    field = image_tag(drawing.figure if drawing else None, source)
    body = part.body or (part.shared if alone else ())
    return part_label_html(part) + _blocks_html(body, lang) + field + options + hint


def part_label_html(part: QuestionPart) -> Markup:
    """Return the letter of a part in a line of its own; empty where there is one part."""
    return Markup("<p><strong>({})</strong></p>").format(part.label) if part.label else Markup("")


_MARK = re.compile("\N{NULL}(\\d+)\N{NULL}")
"""Stands for the fields of a part, by its place, until all of the text is there."""


def mark_fields(
    parts: Sequence[PartInteractions],
    lang: str,
    source: FigureAddress,
    placed: Collection[int],
    *,
    escape: Callable[[Markup], Markup] = Markup,
) -> str:
    """Return the parts with a mark for the fields of each: in its blank, or below its text.

    ``placed`` are the places of parts whose fields stand in a sentence or a cell.
    """
    text, said = "", {""}
    bodies = [part.body for part, _ in parts]
    for place, (part, found) in enumerate(parts):
        mark, lost = f"\N{NULL}{place}\N{NULL}", part.shared and part.shared not in bodies
        bodies.append(part.shared)  # the text around fields stands once, also if its part does not
        own = part_html(part, found, lang, source, alone=bool(lost))
        if place not in placed:
            text += escape(own) + mark
            continue
        advice = own.removeprefix(part_label_html(part))
        text += escape(own) if part.body or advice not in said else ""
        said.add(advice)
        blank = PlacedField(part.label).text
        text = text.replace(blank, blank.rstrip("_") + mark)
    return text


def list_marks(text: str) -> list[int]:
    """Return the places of parts in the order of their marks."""
    return [int(mark) for mark in _MARK.findall(text)]


def fill_marks(text: str, fields: Sequence[str]) -> Markup:
    """Return the parts with their fields in place of the marks."""
    return Markup(_MARK.sub(lambda mark: fields[int(mark[1])], text))  # noqa: S704 - escaped


def _options_list(part: QuestionPart, lang: str) -> Markup:
    """Return the options of a part as a list, each after its letter; empty without options."""
    options = (*part.field.options, *part.field.targets)
    rows = [option_html(letter, words, lang) for letter, words in options]
    items = Markup("").join(Markup("<li>{}</li>").format(row) for row in rows)
    return Markup("<ul>{}</ul>").format(items) if rows else Markup("")


def option_html(letter: str, words: FeedbackText, lang: str) -> Markup:
    """Return an option after its letter, which the worked solution names it by."""
    return Markup("{}. {}").format(letter, to_course_html(words, lang))


def field_html(
    interaction: NumericInteraction, field: Markup, lang: str, number: str = ""
) -> Markup:
    """Return a field between the name of its value, else its number, and its unit."""
    name = (
        to_course_html((name_inline(interaction.name),), lang) + " = "
        if interaction.name
        else number
    )
    unit = "" if interaction.unit in {"", "1"} else f" {format_unit(interaction.unit)}"
    return Markup("<p>{}{}{}</p>").format(name, field, unit)


def target_texts(pairs: MatchInteraction) -> dict[str, str]:
    """Return the targets of a match as plain text, which is all that a drop-down can show."""
    return {
        letter: letter
        if words == (PlainText(letter),)
        else f"{letter}. {inlines_to_plain_text(words)}"
        for letter, words in pairs.targets
    }


def question_mark(item: ExportItem, suffix: str) -> Markup:
    """Return the token of a question, which reports of a course carry with its text."""
    return Markup("<p><small>[{}]</small></p>").format(item.token(suffix))


def _typing_advice(
    part: QuestionPart, interactions: Sequence[Interaction], lang: str
) -> Iterable[Markup]:
    """Return the sentences on what to type in a part, each once."""
    if needs_manual_grading(interactions):
        return [to_course_html(part.field.hint, lang)]
    advice = [text for one in interactions for text in _interaction_advice(one, lang)]
    if len(interactions) == 1 and isinstance(interactions[0], NumericInteraction):
        return map(Markup.escape, nonempty(_unit_text(interactions[0].unit, lang), *advice))
    return map(Markup.escape, dict.fromkeys(advice))


def _unit_text(unit: str, lang: str) -> str:
    """Return the sentence on the unit to type in; empty for a plain number."""
    names = {"%": "ask.percent", "°": "ask.degrees"}
    if unit in names:
        return translate(lang, names[unit])
    return unit_hint(unit, lang) if unit != "1" else ""


def _interaction_advice(interaction: Interaction, lang: str) -> Iterator[str]:
    """Yield the sentences on what to type for one interaction."""
    match interaction:
        case NumericInteraction():
            yield translate(lang, "export.number")
            if interaction.precision:
                yield interaction.precision
        case ChoiceInteraction(many=True):
            yield translate(lang, "ask.multi")
        case TextEntryInteraction(printed=True):
            yield translate(lang, "ask.code")
        case OrderInteraction():
            yield translate(lang, "export.places")


def solution_html(
    item: ExportItem,
    source: FigureAddress,
    labels: Sequence[str] = (),
    *,
    has_feedback: bool = True,
) -> Markup:
    """Return the worked solution, with its figure if it has one of its own.

    Parameters
    ----------
    item : ExportItem
    source : callable
    labels : sequence of str
        Of the parts to show; all parts if it is empty.
    has_feedback : bool
        Whether the system itself gives feedback on misconceptions, so that the solution need not.
    """
    rows = zip(item.parts, item.key.solution.parts, strict=True)
    parts, solutions = [], []
    for (part, interactions), solution in rows:
        if labels and part.label not in labels:
            continue
        is_automatic = has_feedback and not needs_manual_grading(interactions)
        parts.append(part)
        solutions.append(_without_feedback(interactions, solution) if is_automatic else solution)
    whole = item.key.solution
    if len(parts) < len(item.parts):
        # Remarks are on all parts together.
        whole = replace(whole, check=(), note=(), why=(), precision=())
    key = replace(item.key, solution=replace(whole, parts=tuple(solutions)))
    question = replace(item.question, parts=tuple(parts))
    shown = PaperItem(question.number, (question,), (key,))
    page = render_html_fragment(
        "worked.html.j2",
        _manner.get(),
        item=shown,
        figure=item.solution_figure,
        draw=lambda figure: image_tag(figure, source),
    )
    return Markup(_STYLING.sub("", page))  # noqa: S704 - a page without some attributes


def _without_feedback(interactions: Sequence[Interaction], solution: PartSolution) -> PartSolution:
    """Return a solution without feedback that the system gives itself.

    Feedback on single pairs and places shows in no system, so it stays in their solution.
    """
    if any(isinstance(one, MatchInteraction | OrderInteraction) for one in interactions):
        return solution
    return replace(solution, mistakes=(), reasons=())


def hint_html(item: ExportItem) -> Iterator[Markup]:
    """Yield a hint for each try: why the next step of each part is taken."""
    parts = item.key.solution.parts
    for row in islice(zip_longest(*(part.lines for part in parts)), HINT_COUNT):
        steps = [
            _with_label(part.label, to_course_html(line.why, item.lang))
            for part, line in zip(parts, row, strict=True)
            if line
        ]
        yield Markup("").join(steps)


def _with_label(label: str, words: Markup) -> Markup:
    """Return a paragraph after the letter of its part, if it has one."""
    return Markup("<p>{}{}</p>").format(f"({label}) " if label else "", words)


# From a figure to the address that a page finds it at.
FigureAddress = Callable[[Figure], str]


def image_name(figure: Figure) -> str:
    """Return the name of a figure's file, equal for figures that look the same."""
    return f"{hashlib.sha256(figure.standalone_svg).hexdigest()[:16]}.svg"


def image_path(shown: Figure | PictureFile) -> str:
    """Return the path of an image in a package."""
    return f"figures/{shown.file if isinstance(shown, PictureFile) else image_name(shown)}"


def image_tag(figure: Figure | None, source: FigureAddress) -> Markup:
    """Return a figure as HTML with its alternative text, or nothing if there is no figure."""
    if figure is None:
        return Markup("")
    tag = Markup('<p><img src="{}" alt="{}" width="{:.0f}" height="{:.0f}"/></p>')
    return tag.format(source(figure), figure.alt, figure.width_pt * 4 / 3, figure.height_pt * 4 / 3)


def question_images(item: ExportItem, labels: Collection[str]) -> dict[str, bytes]:
    """Return the files that the text of some parts shows: the figure, and fields to draw in."""
    drawings = (part.field.drawing for part in item.question.parts if part.label in labels)
    return _figure_files([item.question.figure, *(one.figure for one in drawings if one)])


def solution_images(item: ExportItem, labels: Collection[str]) -> dict[str, bytes]:
    """Return the files that the solution of some parts shows: its figure, and right drawings."""
    rows = zip(item.question.parts, item.key.solution.parts, strict=True)
    drawings = (done.drawing for part, done in rows if part.label in labels)
    return _figure_files([item.solution_figure, *(one.figure for one in drawings if one)])


def all_images(item: ExportItem) -> dict[str, bytes]:
    """Return all files of a question and its solution by their paths in a package."""
    labels = [part.label for part in item.question.parts]
    found = question_images(item, labels) | solution_images(item, labels)
    drawn = {f"figures/{name}": data for name, data in found.items()}
    pictures = item.key.draw.template.pictures.values()
    return drawn | {image_path(picture): picture.data for picture in pictures}


def _figure_files(figures: Iterable[Figure | None]) -> dict[str, bytes]:
    """Return the SVG files of figures by name; equal figures are one file."""
    return {image_name(figure): figure.standalone_svg for figure in figures if figure}
