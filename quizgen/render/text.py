"""A question with key and solution as plain text, for the terminal."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import singledispatch
from itertools import chain

from quizgen.locale import format_amount, translate
from quizgen.paper.paper import PaperItem
from quizgen.question.compose import QuestionKey
from quizgen.question.figure import describe_question_figure
from quizgen.question.interpolation import PlacedPicture
from quizgen.question.solution import PartSolution, scheme_examples, scheme_title
from quizgen.typeset import prose
from quizgen.typeset.prose import PlacedField, TypesetMaths


@singledispatch
def inlines_to_plain_text(part: prose.Inline | tuple[prose.Inline, ...]) -> str:
    """Return inlines as plain text, formulas as Unicode can write them."""
    raise TypeError(type(part).__name__)


@inlines_to_plain_text.register(tuple)
def _join_inlines(parts: tuple[prose.Inline, ...]) -> str:
    """Return several inlines as one text."""
    return "".join(map(inlines_to_plain_text, parts))


@inlines_to_plain_text.register
def _get_part_text(part: prose.PlainText | prose.InlineCode) -> str:
    """Return words or code as they are."""
    return part.text


@inlines_to_plain_text.register
def _format_styled(part: prose.Emphasis) -> str:
    """Return emphasised words without their emphasis."""
    return inlines_to_plain_text(part.children)


@inlines_to_plain_text.register
def _get_printed_text(part: TypesetMaths | PlacedPicture | PlacedField) -> str:
    """Return the plain text of a formula, the description of a picture, or a blank."""
    return part.text


def blocks_to_plain_text(parts: Iterable[prose.Block]) -> Iterator[str]:
    """Yield the lines of blocks."""
    return chain.from_iterable(map(_reject_block, parts))


@singledispatch
def _reject_block(part: prose.Block) -> Iterable[str]:
    """Raise ``TypeError``: no writer is registered for this type of block."""
    raise TypeError(type(part).__name__)


@_reject_block.register
def _format_paragraph(part: prose.Paragraph) -> Iterable[str]:
    """Return a paragraph as one line."""
    return [inlines_to_plain_text(part.children)]


@_reject_block.register
def _format_code_block(part: prose.CodeBlock) -> Iterable[str]:
    """Return the lines of code, indented."""
    return [f"    {line}" for line in part.text.splitlines()]


@_reject_block.register
def _format_list(part: prose.ListBlock) -> Iterable[str]:
    """Return one line for each item of a list."""
    return [f"  - {line}" for item in part.items for line in blocks_to_plain_text(item)]


@_reject_block.register
def _format_table(part: prose.TableBlock) -> Iterable[str]:
    """Return one line for each row of a table, its cells parted by bars."""
    return [" | ".join(map(inlines_to_plain_text, row)) for row in (part.head, *part.rows)]


def _shorten_lists(identity: str) -> str:
    """Return what was drawn with the first three and the last value of long lists."""
    return re.sub(r"\[((?:[^];]*; ){3})(?:[^];]*; ){3,}([^]]*)\]", r"[\1…; \2]", identity)


def format_question(item: PaperItem, *, solved: bool = True) -> str:
    """Return a question as text; ``solved`` adds its key and solution."""
    question, key = item.questions[0], item.keys[0]
    head = question.title
    if solved:
        head = f"{question.template}: {head}  [{_shorten_lists(key.identity)}]"
    lines = [head, *blocks_to_plain_text(question.stem)]
    told = describe_question_figure(key.draw, question.lang, quiz=True)
    lines += [f"   [{told}]"] if told else []
    for part, worked in zip(question.parts, key.solution.parts, strict=True):
        lines += ["", f"({part.label})" if part.label else "", *blocks_to_plain_text(part.body)]
        if part.field.drawing:
            lines.append(f"   {part.field.drawing.alt}")
        for mark, text in (*part.field.options, *part.field.targets):
            lines.append(f"   {mark}  {inlines_to_plain_text(text)}")
        lines += [f"   [{hint}]" for hint in part.field.hints]
        lines += _iter_solution_lines(worked, question.lang) if solved else ()
    return "\n".join([*lines, *(_iter_remark_lines(key, question.lang) if solved else ())])


def _iter_remark_lines(key: QuestionKey, lang: str) -> Iterator[str]:
    """Yield what follows all parts of a solution."""
    titles = {"why": "solution.why", "check": "solution.check", "precision": "precision.title",
              "note": "solution.note"}  # fmt: skip
    for name, title in titles.items():
        found = list(blocks_to_plain_text(getattr(key.solution, name)))
        yield from ("", f"{translate(lang, title)}:", *found) if found else ()


def _iter_scheme_lines(part: PartSolution, lang: str) -> Iterator[str]:
    """Yield the mark scheme of a part: each criterion with its points and examples."""
    yield f"{scheme_title(part, lang).rstrip('.')}:"
    for row in part.scheme:
        yield f"   [{format_amount(row.points, lang)}] {inlines_to_plain_text(row.idea)}"
        for name, examples in scheme_examples(row):
            yield f"       {translate(lang, f'solution.{name}')}: {'; '.join(examples)}"
        if row.follows:
            yield f"       {translate(lang, 'solution.follows')}"


def _iter_solution_lines(part: PartSolution, lang: str) -> Iterator[str]:
    """Yield the steps and reasons of one part."""
    yield f"{translate(lang, 'solution.steps')}:"
    for line in part.lines:
        cite = f"  [{line.formula}]" if line.formula else ""
        yield f"   {inlines_to_plain_text(line.maths)}{cite}"
        yield f"      {inlines_to_plain_text(line.why)}"
    yield f"{translate(lang, 'solution.answer')}: {part.answer}".rstrip()
    if part.scheme:
        yield from _iter_scheme_lines(part, lang)
    else:
        yield from (f"   - {inlines_to_plain_text(option)}" for option in part.options)
    if part.why:
        yield f"   {inlines_to_plain_text(part.why)}"
    for mistake in (*part.reasons, *part.mistakes):
        value = f"{mistake.value}  " if mistake.shown else ""
        yield f"   ! {value}{mistake.name}: {inlines_to_plain_text(mistake.listed_sentence)}"
