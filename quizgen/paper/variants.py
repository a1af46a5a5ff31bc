"""The numbers of a paper's questions: none stands twice, and none tells another's answer."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.markdown import leaves
from quizgen.bank.sampler import Sampler, sampler_for
from quizgen.bank.template import Template
from quizgen.bank.variant import SiblingContent, Variant, draw_variant, leading_digits
from quizgen.core.errors import SamplingError
from quizgen.grading.reading.formulas import parse_authored
from quizgen.kinds import expression
from quizgen.kinds.contract import asked_quantities
from quizgen.maths.canonical import CanonicalForm, canonical_equation
from quizgen.maths.notation import format_tree
from quizgen.maths.numbers import parse_written_number, to_float
from quizgen.maths.tree import Expr, substitute
from quizgen.maths.values import Value
from quizgen.question.figure import has_coloured_figure
from quizgen.question.part_context import ask_part, authored_answer
from quizgen.typeset.prose import PlainText

REDRAWS = 50
"""Tries to avoid the same numbers twice in one paper."""
OTHER_ANSWERS = 30
"""Tries to avoid an answer that the paper asks, or states, somewhere else."""
COUNTED = 10
"""Whole numbers below are asked in many questions, and tell nothing."""
DIGITS = 3
"""Digits of a number that is not in another question by chance."""


class _SeenContent(msgspec.Struct):
    """What the questions drawn so far ask and state, so that the next tells none of it."""

    questions: set[str] = msgspec.field(default_factory=set)
    asked: set[str] = msgspec.field(default_factory=set)
    printed: set[str] = msgspec.field(default_factory=set)
    """Answers as keys print them, to three figures."""
    given: set[str] = msgspec.field(default_factory=set)
    written: frozenset[str] = frozenset()
    """Numbers that stand in the prose of all questions of the paper but the next one."""

    def add(self, one: Variant) -> None:
        """Add what a variant asks and states."""
        self.questions.add(one.identity)
        self.asked |= _collect_notable_answers(one)
        self.printed |= _round_as_printed(one)
        self.given |= _collect_stated_numbers(one)

    def tells(self, one: Variant) -> bool:
        """Return whether a variant asks what is asked or stated, or states what is asked."""
        asked = _collect_notable_answers(one)
        stated = _collect_stated_numbers(one)
        told = self.given | self.written
        answers = self.asked | self.printed
        return bool(
            asked & (self.asked | told) or _round_as_printed(one) & told or answers & stated
        )


def draw_variants(
    bank: Bank, names: Sequence[str], seed: str, beside: Sequence[Sequence[Variant]] = (),
    *, colour: bool = True,
) -> Iterator[Variant]:  # fmt: skip
    """Yield the variants of a paper in order.

    Parameters
    ----------
    bank : Bank
    names : sequence of str
        The templates.
    seed : str
    beside : sequence of sequences of Variant
        Other papers of the same templates, with which no question is to share what it asks.
    colour : bool
        Whether a figure may need colour to be read.

    Raises
    ------
    SamplingError
        If a question would stand in the paper again and has no other numbers.
    """
    seen = _SeenContent()
    written = {name: _list_written_numbers(bank.template(name)) for name in names}
    for place, name in enumerate(names, 1):
        seen.written = frozenset[str]().union(*(written[one] for one in names if one != name))
        near = [paper[place - 1] for paper in beside]
        one = _draw_least_revealing(bank.template(name), seed, place, seen, near, colour=colour)
        seen.add(one)
        yield one


def _draw_least_revealing(
    template: Template,
    seed: str,
    place: int,
    seen: _SeenContent,
    near: Sequence[Variant],
    *,
    colour: bool,
) -> Variant:
    """Return the first variant that is new and tells nothing, else the one that tells least.

    Raises ``SamplingError`` if none is new.
    """
    new: list[Variant] = []
    for again in range(REDRAWS):
        one = draw_variant(template, seed, f"{place}.{again}" if again else place)
        if one.identity not in seen.questions and (colour or not has_coloured_figure(one)):
            new.append(one)
            if not seen.tells(one) and not any(shared_content(one, other) for other in near):
                return one
        if new and again >= OTHER_ANSWERS:
            return min(new, key=lambda one: _rank_overlap(one, seen, near))
    raise SamplingError(
        f"{template.file}: would stand in the paper again, and has no other numbers: "
        "ask for fewer questions, or let other templates take the place"
    )


def _rank_overlap(
    one: Variant, seen: _SeenContent, near: Sequence[Variant]
) -> tuple[bool, bool, bool]:
    """Return the sort key of a variant: the one with the least overlap comes first.

    Three booleans, the gravest first: it tells something of its own paper; the paper beside it
    has the same question; it shares an answer with that question. False sorts before True.
    """
    again = any(one.identity == other.identity for other in near)
    return seen.tells(one), again, any(shared_content(one, other) for other in near)


def shared_content(one: Variant, other: Variant) -> set[str]:
    """Return what two questions share: numbers that both ask, or that they are the same."""
    same = {one.identity} & {other.identity}
    return (_collect_answer_numbers(one) & _collect_answer_numbers(other)) | same


def _collect_notable_answers(one: Variant) -> set[str]:
    """Return the numbers that are asked for, small integers aside.

    Those occur everywhere and give nothing away.
    """
    return {
        leading_digits(v)
        for v in _iter_asked_values(one)
        if abs(to_float(v)) >= COUNTED or to_float(v) % 1
    }


def _round_as_printed(one: Variant) -> set[str]:
    """Return the decimals that are asked for, as keys print them: 11.14 is 11.1."""
    rounded = (f"{abs(to_float(v)):.{DIGITS}g}" for v in _iter_asked_values(one))
    return {n for n in rounded if "." in n and _count_significant_digits(n) == DIGITS}


def _collect_answer_numbers(one: Variant) -> set[str]:
    """Return all numbers that are asked for."""
    return set(map(leading_digits, _iter_asked_values(one)))


def _iter_asked_values(one: Variant) -> Iterator[Value]:
    """Yield the values that a variant asks for, in shown units."""
    for part in one.template.rules.part:
        yield from (one.shown_values[name] for name in asked_quantities(part.answer))


def _collect_stated_numbers(one: Variant) -> set[str]:
    """Return the numbers that a question states, as far as they have digits enough."""
    return {
        text
        for text in map(leading_digits, one.shown.values())
        if _count_significant_digits(text) >= DIGITS
    }


_NUMBER = re.compile(r"(?<![\w./])\d+\.\d+(?![\w.]*\d)")


def _list_written_numbers(template: Template) -> frozenset[str]:
    """Return the decimals in the prose of a question, which stand in every variant of it."""
    found: set[str] = set()
    for text in template.texts.values():
        for blocks in (text.stem, *(text.sections.get(name, ()) for name in template.labels)):
            pieces = [one.text for one in leaves(blocks) if isinstance(one, PlainText)]
            found |= {
                leading_digits(parse_written_number(n)) for n in _NUMBER.findall(" ".join(pieces))
            }
    return frozenset(text for text in found if _count_significant_digits(text) >= DIGITS)


def _count_significant_digits(text: str) -> int:
    """Return the number of digits without zeros at the ends."""
    return len(text.partition("e")[0].replace(".", "").strip("0"))


def with_siblings(drawn: Sequence[Variant]) -> Iterator[Variant]:
    """Yield each variant with what the other questions of its paper ask."""
    formulas = [frozenset(_iter_asked_formulas(one)) for one in drawn]
    numbers = [
        frozenset(
            n for n in _collect_notable_answers(one) if _count_significant_digits(n) >= DIGITS
        )
        for one in drawn
    ]
    for place, one in enumerate(drawn):
        others = [other for other in range(len(drawn)) if other != place]
        asked = SiblingContent(
            frozenset().union(*(formulas[other] for other in others)),
            frozenset().union(*(numbers[other] for other in others)),
        )
        yield replace(one, elsewhere=asked)


def _iter_asked_formulas(one: Variant) -> Iterator[CanonicalForm]:
    """Yield the canonical forms of all formulas that lead to its answers."""
    for index in range(len(one.template.rules.part)):
        yield from asked_formulas(one, index)


def asked_formulas(drawn: Variant, index: int) -> Mapping[CanonicalForm, str]:
    """Return the canonical forms that lead to an answer, and how each is written.

    The steps, each also with the steps before it put in, and the formula that is asked for.
    """
    found = _build_step_formulas(sampler_for(drawn.template), index)
    if authored_answer(drawn, index)["kind"] == "expression":
        spec: expression.ExpressionSpec = ask_part(drawn, index).spec
        formula = parse_authored(spec.value, tuple(spec.symbols))
        return found | dict.fromkeys(canonical_equation("", formula), spec.value)
    return found


@lru_cache(maxsize=4096)
def _build_step_formulas(plan: Sampler, index: int) -> dict[CanonicalForm, str]:
    """Return the forms of the steps, the same for every variant of a template."""
    found: dict[CanonicalForm, str] = {}
    inner: dict[str, Expr] = {}
    for step in plan.parts[index].steps:
        inner[step.name] = substitute(step.expr, inner)
        for expr in (step.expr, inner[step.name]):
            found |= dict.fromkeys(
                canonical_equation(step.name, expr), f"{step.name} = {format_tree(expr)}"
            )
    return found
