"""The question as an exam asks it: the parts that its author wrote."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from quizgen.bank.draw import Draw
from quizgen.bank.prose import Block, Items, Paragraph, Styled, slots
from quizgen.errors import BankError
from quizgen.maths.numbers import written
from quizgen.question.contract import Built, Named
from quizgen.question.filling import Filler
from quizgen.question.kinds import build
from quizgen.question.levels.asking import Asked, Asking, Choice
from quizgen.question.solution import solve, solved_part

STATEMENT = "claim"
"""The blank in a part's section that its statement fills."""


def fits(_drawn: Draw) -> bool:
    """Every draw can be asked as it was written."""
    return True


@lru_cache(maxsize=32)
def asking(drawn: Draw, lang: str) -> Asking:
    """Stem and parts as authored, with the whole worked solution."""
    built = [build(drawn, index) for index in range(len(drawn.template.rules.part))]
    hidden, told = Filler(drawn, lang, hidden=True), Filler(drawn, lang)
    parts = tuple(_part(hidden, told, index, part) for index, part in enumerate(built))
    stem = hidden.blocks(hidden.text.stem)
    return Asking(stem, parts, solve(drawn, lang, tuple(part.solved for part in parts)))


def _part(hidden: Filler, told: Filler, index: int, built: Built[Any]) -> Asked:
    template = hidden.drawn.template
    label = template.labels[index]
    body = _body(hidden, label, built.statements)
    if label and not body:
        raise BankError(f"{template.path / hidden.lang}.md: section {label!r} is missing")
    return Asked(
        written(template.rules.part[index].points),
        body,
        built.spec,
        solved_part(told, index, built),
        built.control,
        _choices(hidden, built.options),
        _choices(hidden, built.targets),
    )


def _body(filler: Filler, label: str, statements: tuple[Named, ...]) -> tuple[Block, ...]:
    """The section of a part, and what it asks: its statement, or several in a numbered list."""
    section = filler.text.sections.get(label, ()) if label else ()
    if len(statements) == 1 and statements[0][0] == "claims":
        if STATEMENT in slots(section):
            return filler.saying(STATEMENT, *statements[0]).blocks(section)
        asked = Styled("strong", filler.sentence(*statements[0]))
        return (*filler.blocks(section), Paragraph((asked,)))
    listed = tuple((Paragraph(filler.sentence(*place)),) for place in statements)
    return (*filler.blocks(section), *((Items(listed, ordered=True),) if listed else ()))


def _choices(filler: Filler, names: tuple[Named, ...]) -> tuple[Choice, ...]:
    return tuple((mark, filler.sentence("options", name)) for mark, name in names)
