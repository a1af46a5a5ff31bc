"""A question with key and solution as plain text, for the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import singledispatch
from itertools import chain

from quizgen.bank import prose
from quizgen.locale import word
from quizgen.paper.paper import Item
from quizgen.question.compose import Key
from quizgen.question.picture import described
from quizgen.question.shown import Maths, PlacedPicture
from quizgen.question.solution import PartSolution


@singledispatch
def inline(part: prose.Inline | tuple[prose.Inline, ...]) -> str:
    """Inlines as text; formulas as Unicode can write them."""
    raise TypeError(type(part).__name__)


@inline.register(tuple)
def _inlines(parts: tuple[prose.Inline, ...]) -> str:
    return "".join(map(inline, parts))


@inline.register
def _plain(part: prose.Words | prose.Code) -> str:
    return part.text


@inline.register
def _styled(part: prose.Styled) -> str:
    return inline(part.children)


@inline.register
def _printed(part: Maths | PlacedPicture) -> str:
    return part.text


def blocks(parts: Iterable[prose.Block]) -> Iterator[str]:
    """Blocks as lines."""
    return chain.from_iterable(map(_lines, parts))


@singledispatch
def _lines(part: prose.Block) -> Iterable[str]:
    raise TypeError(type(part).__name__)


@_lines.register
def _paragraph(part: prose.Paragraph) -> Iterable[str]:
    return [inline(part.children)]


@_lines.register
def _code_block(part: prose.CodeBlock) -> Iterable[str]:
    return [f"    {line}" for line in part.text.splitlines()]


@_lines.register
def _items(part: prose.Items) -> Iterable[str]:
    return [f"  - {line}" for item in part.items for line in blocks(item)]


@_lines.register
def _table(part: prose.Table) -> Iterable[str]:
    return [" | ".join(map(inline, row)) for row in (part.head, *part.rows)]


def question_text(item: Item, *, solved: bool = True) -> str:
    """Question and, unless it is to be seen as by a learner, key and solution."""
    question, key = item.questions[0], item.keys[0]
    head = f"{question.template}: {question.title}  [{key.identity}]" if solved else question.title
    lines = [head, *blocks(question.stem)]
    told = described(key.draw, question.lang, quiz=True)
    lines += [f"   [{told}]"] if told else []
    for part, worked in zip(question.parts, key.solution.parts, strict=True):
        lines += ["", f"({part.label})" if part.label else "", *blocks(part.body)]
        if part.field.drawing:
            lines.append(f"   {part.field.drawing.alt}")
        for mark, text in (*part.field.options, *part.field.targets):
            lines.append(f"   {mark}  {inline(text)}")
        lines += [f"   [{hint}]" for hint in part.field.hints]
        lines += _solution(worked, question.lang) if solved else ()
    return "\n".join([*lines, *(_remarks(key, question.lang) if solved else ())])


def _remarks(key: Key, lang: str) -> Iterator[str]:
    """What stands behind all parts of a solution."""
    titles = {"why": "solution.why", "check": "solution.check", "precision": "precision.title",
              "note": "solution.note"}  # fmt: skip
    for name, title in titles.items():
        found = list(blocks(getattr(key.solution, name)))
        yield from ("", f"{word(lang, title)}:", *found) if found else ()


def _solution(part: PartSolution, lang: str) -> Iterator[str]:
    yield f"{word(lang, 'solution.steps')}:"
    for line in part.lines:
        cite = f"  [{line.formula}]" if line.formula else ""
        yield f"   {inline(line.maths)}{cite}"
        yield f"      {inline(line.why)}"
    yield f"{word(lang, 'solution.answer')}: {part.answer}".rstrip()
    yield from (f"   - {inline(option)}" for option in part.options)
    if part.why:
        yield f"   {inline(part.why)}"
    for mistake in (*part.reasons, *part.mistakes):
        value = f"{mistake.value}  " if mistake.shown else ""
        yield f"   ! {value}{mistake.name}: {inline(mistake.sentence)}"
