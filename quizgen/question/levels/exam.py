"""The question as an exam asks it: the parts that its author wrote."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from quizgen.bank.markdown import Block, Emphasis, ListBlock, Paragraph, slot_names
from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError
from quizgen.kinds.contract import AskedPart, LabelledName
from quizgen.maths.numbers import parse_written_number
from quizgen.question.interpolation import Interpolator
from quizgen.question.levels.contract import Choice, LevelPart, LevelQuestion
from quizgen.question.part_context import ask_part
from quizgen.question.solution import build_solution, solve_part

STATEMENT = "claim"
"""The blank in a part's section that its statement fills."""


def is_applicable(_drawn: Variant) -> bool:
    """Return True: every variant can be asked as it was written."""
    return True


@lru_cache(maxsize=32)
def ask(drawn: Variant, lang: str) -> LevelQuestion:
    """Return stem and parts as authored, with the whole worked solution."""
    built = [ask_part(drawn, index) for index in range(len(drawn.template.rules.part))]
    hidden, told = Interpolator(drawn, lang, hidden=True), Interpolator(drawn, lang)
    parts = tuple(_build_asked_part(hidden, told, index, part) for index, part in enumerate(built))
    stem = hidden.blocks(hidden.text.stem)
    return LevelQuestion(
        stem, parts, build_solution(drawn, lang, tuple(part.solved for part in parts))
    )


def _build_asked_part(
    hidden: Interpolator, told: Interpolator, index: int, built: AskedPart[Any]
) -> LevelPart:
    """Return one authored part with its solution.

    Two interpolators: the question's knows drawn values alone, the solution's all of them.
    Raises ``BankError`` if the language file has no section for the part.
    """
    template = hidden.drawn.template
    label = template.labels[index]
    body = _build_part_body(hidden, label, built.statements)
    if label and not body:
        file = template.path / f"{hidden.lang}.md"
        raise BankError(f"section {label!r} is missing", rule="QG157", file=file)
    return LevelPart(
        parse_written_number(template.rules.part[index].points),
        body,
        built.spec,
        solve_part(told, index, built),
        built.control,
        _label_choices(hidden, built.options),
        _label_choices(hidden, built.targets),
    )


def _build_part_body(
    filler: Interpolator, label: str, statements: tuple[LabelledName, ...]
) -> tuple[Block, ...]:
    """Return the section of a part with its statement, or several in a numbered list."""
    section = filler.text.sections.get(label, ()) if label else ()
    if len(statements) == 1 and statements[0][0] == "claims":
        if STATEMENT in slot_names(section):
            return filler.with_sentence(STATEMENT, *statements[0]).blocks(section)
        asked = Emphasis("strong", filler.sentence(*statements[0]))
        return (*filler.blocks(section), Paragraph((asked,)))
    listed = tuple((Paragraph(filler.sentence(*place)),) for place in statements)
    return (*filler.blocks(section), *((ListBlock(listed, ordered=True),) if listed else ()))


def _label_choices(filler: Interpolator, names: tuple[LabelledName, ...]) -> tuple[Choice, ...]:
    """Return the marks of options with their wordings."""
    return tuple((mark, filler.sentence("options", name)) for mark, name in names)
