"""The question as an exam asks it: the parts that its author wrote."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from msgspec.structs import replace

from quizgen.bank.markdown import FIELD_MARK, slot_names
from quizgen.bank.rules import PART_LABELS
from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError
from quizgen.core.positions import TEXT
from quizgen.kinds.contract import AskedPart, LabelledName
from quizgen.locale import translate
from quizgen.maths.numbers import parse_written_number
from quizgen.question.interpolation import Interpolator
from quizgen.question.levels.contract import Choice, LevelPart, LevelQuestion
from quizgen.question.part_context import ask_part
from quizgen.question.placed_fields import can_be_placed, iter_placed_fields
from quizgen.question.solution import build_solution, solve_part
from quizgen.typeset.prose import Block, Emphasis, ListBlock, Paragraph, PlacedField, to_inlines

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
    stem = hidden.blocks(hidden.text.stem)
    asking = (
        hidden.with_fields(_build_fields(hidden, built)) if drawn.template.places_fields else hidden
    )
    labels = drawn.template.labels
    bodies = [
        _build_part_body(asking, label, part.statements)
        for label, part in zip(labels, built, strict=True)
    ]
    places = _locate_fields(asking, bodies)
    parts = tuple(
        _build_asked_part(asking, told, index, part, bodies, places)
        for index, part in enumerate(built)
    )
    return LevelQuestion(
        stem, parts, build_solution(drawn, lang, tuple(part.solved for part in parts))
    )


def _build_fields(filler: Interpolator, built: list[AskedPart[Any]]) -> Iterator[PlacedField]:
    """Yield the field of each part that may stand inside a sentence."""
    for label, part in zip(filler.drawn.template.labels, built, strict=True):
        if can_be_placed(part.control):
            options = _label_choices(filler, part.options)
            if part.control.form == "truth":
                ways = ("true", "false")
                options = tuple(
                    (way, to_inlines(translate(filler.lang, f"ask.{way}"))) for way in ways
                )
            yield PlacedField(label, options)


def _locate_fields(
    filler: Interpolator, bodies: list[tuple[Block, ...]]
) -> dict[str, tuple[int, str]]:
    """Return by label the part whose section holds a field, and the words around the field.

    Raises ``BankError`` if a field stands twice, or in the section of another part than its own
    or the last one before it that has a section: parts are read, asked and marked in order.
    """
    labels, found = filler.drawn.template.labels, dict[str, tuple[int, str]]()
    for host, body in enumerate(bodies):
        for label, near in iter_placed_fields(body) if filler.fields else ():
            index = labels.index(label)
            blank = f"{{{{ {FIELD_MARK}{label or PART_LABELS[0]} }}}}"
            if label in found:
                raise filler.format_problem(f"{blank} stands twice", "QG160", TEXT, blank)
            if index < host or any(bodies[host + 1 : index + 1]):
                what = (
                    f"{blank} may stand in the section of part {label!r}, or in that of a part "
                    "before it if the parts between and it have no section"
                )
                raise filler.format_problem(what, "QG160", TEXT, blank)
            found[label] = (host, near)
    return found


def _build_asked_part(
    hidden: Interpolator,
    told: Interpolator,
    index: int,
    built: AskedPart[Any],
    bodies: list[tuple[Block, ...]],
    places: dict[str, tuple[int, str]],
) -> LevelPart:
    """Return one authored part with its solution.

    Two interpolators: the question's knows drawn values alone, the solution's all of them.
    Raises ``BankError`` if the language file has no section for the part.
    """
    template = hidden.drawn.template
    label, body = template.labels[index], bodies[index]
    host, near = places.get(label, (index, None))
    if label and not body and near is None:
        file = template.path / f"{hidden.lang}.md"
        raise BankError(f"section {label!r} is missing", rule="QG157", file=file)
    return LevelPart(
        parse_written_number(template.rules.part[index].points),
        body,
        built.spec,
        solve_part(told, index, built),
        built.control if near is None else replace(built.control, boxes=()),
        _label_choices(hidden, built.options),
        _label_choices(hidden, built.targets),
        near,
        bodies[host] if host != index else (),
    )


def _build_part_body(
    filler: Interpolator, label: str, statements: tuple[LabelledName, ...]
) -> tuple[Block, ...]:
    """Return the section of a part with its statement, or several in a numbered list."""
    named = label or (PART_LABELS[0] if filler.fields else "")
    section = filler.text.sections.get(named, ())
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
