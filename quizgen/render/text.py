"""A question with key and solution as plain text, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from quizgen.bank.prose import Code, CodeBlock, Items, Paragraph, Styled, Table, Words
from quizgen.locale import word
from quizgen.paper.paper import Item
from quizgen.question.filling import Maths
from quizgen.question.solution import PartSolution


def inline(parts: Any) -> str:
    """Inlines as text; formulas as they would be typed."""
    if isinstance(parts, tuple):
        return "".join(inline(part) for part in parts)
    if isinstance(parts, Words | Code):
        return parts.text
    if isinstance(parts, Styled):
        return inline(parts.children)
    if isinstance(parts, Maths):
        return parts.typed
    raise TypeError(type(parts).__name__)


def blocks(parts: Any) -> Iterator[str]:
    """Blocks as lines."""
    for part in parts:
        if isinstance(part, Paragraph):
            yield inline(part.children)
        elif isinstance(part, CodeBlock):
            yield from (f"    {line}" for line in part.text.splitlines())
        elif isinstance(part, Items):
            for item in part.items:
                yield from (f"  - {line}" for line in blocks(item))
        elif isinstance(part, Table):
            yield from (" | ".join(map(inline, row)) for row in (part.head, *part.rows))


def question_text(item: Item) -> str:
    """Question, key and solution."""
    question, key = item.questions[0], item.keys[0]
    lines = [f"{question.template}: {question.title}  [{key.identity}]", *blocks(question.stem)]
    for part, solved in zip(question.parts, key.solution.parts, strict=True):
        lines += ["", f"({part.label})" if part.label else "", *blocks(part.body)]
        for mark, text in (*part.field.options, *part.field.targets):
            lines.append(f"   {mark}  {inline(text)}")
        lines += [f"   [{hint}]" for hint in part.field.hints]
        lines += _solution(solved, question.lang)
    titles = {"why": "solution.why", "check": "solution.check", "precision": "precision.title",
              "note": "solution.note"}  # fmt: skip
    for name, title in titles.items():
        found = list(blocks(getattr(key.solution, name)))
        lines += ["", f"{word(question.lang, title)}:", *found] if found else []
    return "\n".join(lines)


def _solution(part: PartSolution, lang: str) -> Iterator[str]:
    yield f"{word(lang, 'solution.steps')}:"
    for line in part.lines:
        yield f"   {line.maths.typed}"
        yield f"      {inline(line.why)}"
    yield f"{word(lang, 'solution.answer')}: {part.answer}".rstrip()
    yield from (f"   - {inline(option)}" for option in part.options)
    for mistake in part.mistakes:
        yield f"   ! {mistake.value}  {mistake.name}: {inline(mistake.sentence)}"
