"""Derivations: whether every line holds, earns what it says, and can be missed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from quizgen.bank.template import Template
from quizgen.bank.variant import Variant
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.kinds.derivation import DerivationSpec
from quizgen.maths.numbers import parse_written_number
from quizgen.question.part_context import ask_part


def derivation_lines(template: Template) -> set[str]:
    """Return the names of all lines of a template's derivations, each with its sentence."""
    answers = (part.answer for part in template.rules.part)
    return {name for one in answers if one.get("kind") == "derivation" for name in one["lines"]}


def find_derivation_faults(draws: Iterable[Variant]) -> list[Diagnostic]:
    """Return what is wrong with the lines of derivations, each fault once."""
    found: dict[tuple[str, str], Diagnostic] = {}
    for drawn in draws:
        for index, part in enumerate(drawn.template.rules.part):
            if part.answer.get("kind") == "derivation":
                for code, what in _iter_faults(drawn, index):
                    said = f"part {drawn.template.labels[index] or '1'}: {what}"
                    place = ("part", index, "answer")
                    key = (code, what.partition(":")[0])
                    found.setdefault(key, diagnose(code, drawn.template.file, said, place))
    return [*found.values()]


def _iter_faults(drawn: Variant, index: int) -> Iterator[tuple[str, str]]:
    """Yield code and message of each fault of one derivation."""
    spec = ask_part(drawn, index).spec
    if not isinstance(spec, DerivationSpec):
        return
    yield from spec.find_faults()
    points = parse_written_number(drawn.template.rules.part[index].points)
    if spec.total != points:
        yield "QG242", f"lines and reasons have {spec.total} points, the part has {points}"
