"""The numbers of a paper's questions: none stands twice, and none tells another's answer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

import msgspec

from quizgen.bank.draw import Draw, Elsewhere, digits, draw
from quizgen.bank.folder import Bank
from quizgen.bank.plan import Plan, plan_of
from quizgen.bank.template import Template
from quizgen.bank.traps import answer_names
from quizgen.errors import DrawError
from quizgen.marking.kinds import expression
from quizgen.marking.reading.formulas import author
from quizgen.maths.alike import Form, equation
from quizgen.maths.notation import to_text
from quizgen.maths.numbers import to_float
from quizgen.maths.tree import Expr, substitute
from quizgen.maths.values import Value
from quizgen.question.compose import identity
from quizgen.question.kinds import build
from quizgen.question.picture import coloured
from quizgen.question.specs import answer_of

REDRAWS = 50
"""Tries to avoid the same numbers twice in one paper."""
OTHER_ANSWERS = 30
"""Tries to avoid an answer that the paper asks, or states, somewhere else."""
COUNTED = 10
"""Whole numbers below are asked in many questions, and tell nothing."""
DIGITS = 3
"""Digits of a number that is not in another question by chance."""


class _Seen(msgspec.Struct):
    """What the questions so far ask and state."""

    questions: set[str] = msgspec.field(default_factory=set)
    asked: set[str] = msgspec.field(default_factory=set)
    given: set[str] = msgspec.field(default_factory=set)

    def add(self, one: Draw) -> None:
        self.questions.add(identity(one))
        self.asked |= _asked(one)
        self.given |= _given(one)

    def tells(self, one: Draw) -> bool:
        """Whether a draw asks what is asked or stated already, or states what is asked."""
        asked = _asked(one)
        return bool(asked & self.asked or asked & self.given or self.asked & _given(one))


def draws(
    bank: Bank, names: Sequence[str], seed: str, beside: Sequence[Sequence[Draw]] = (),
    *, colour: bool = True,
) -> Iterator[Draw]:  # fmt: skip
    """Draw the questions of a paper in order.

    Parameters
    ----------
    bank : Bank
    names : sequence of str
        The templates.
    seed : str
    beside : sequence of sequences of Draw
        Other papers of the same templates, with which no question is to share what it asks.
    colour : bool
        Whether a figure may need colour to be read.

    Raises
    ------
    DrawError
        If a question would stand in the paper again and has no other numbers.
    """
    seen = _Seen()
    for place, name in enumerate(names, 1):
        near = [paper[place - 1] for paper in beside]
        one = _other(bank.template(name), seed, place, seen, near, colour=colour)
        seen.add(one)
        yield one


def _other(
    template: Template, seed: str, place: int, seen: _Seen, near: Sequence[Draw], *, colour: bool
) -> Draw:
    """The first draw that is new and tells nothing; if there is none, the one that tells least."""
    new: list[Draw] = []
    for again in range(REDRAWS):
        one = draw(template, seed, f"{place}.{again}" if again else place)
        if identity(one) not in seen.questions and (colour or not coloured(one)):
            new.append(one)
            if not seen.tells(one) and not any(shared(one, other) for other in near):
                return one
        if new and again >= OTHER_ANSWERS:
            return min(new, key=lambda one: _told(one, seen, near))
    raise DrawError(
        f"{template.file}: would stand in the paper again, and has no other numbers: "
        "ask for fewer questions, or let other templates take the place"
    )


def _told(one: Draw, seen: _Seen, near: Sequence[Draw]) -> tuple[bool, bool, bool]:
    """What of a draw tells something: its own paper, the same question beside it, its answer."""
    again = any(identity(one) == identity(other) for other in near)
    return seen.tells(one), again, any(shared(one, other) for other in near)


def shared(one: Draw, other: Draw) -> set[str]:
    """What two questions have in common: numbers that both ask, or that they are the same."""
    same = {identity(one)} & {identity(other)}
    return (_answers(one) & _answers(other)) | same


def _asked(one: Draw) -> set[str]:
    """Numbers that are asked for, small whole ones aside."""
    return {digits(v) for v in _values(one) if abs(to_float(v)) >= COUNTED or to_float(v) % 1}


def _answers(one: Draw) -> set[str]:
    """Numbers that are asked for."""
    return set(map(digits, _values(one)))


def _values(one: Draw) -> Iterator[Value]:
    for part in one.template.rules.part:
        yield from (one.shown_values[name] for name in answer_names(part.answer))


def _given(one: Draw) -> set[str]:
    """Numbers that a question states, as far as they have digits enough."""
    return {text for text in map(digits, one.shown.values()) if _significant(text) >= DIGITS}


def _significant(text: str) -> int:
    """Digits without zeros at the ends."""
    return len(text.partition("e")[0].replace(".", "").strip("0"))


def aware(drawn: Sequence[Draw]) -> Iterator[Draw]:
    """Each draw with what the other questions of its paper ask."""
    formulas = [frozenset(_formulas(one)) for one in drawn]
    numbers = [frozenset(n for n in _asked(one) if _significant(n) >= DIGITS) for one in drawn]
    for place, one in enumerate(drawn):
        others = [other for other in range(len(drawn)) if other != place]
        asked = Elsewhere(
            frozenset().union(*(formulas[other] for other in others)),
            frozenset().union(*(numbers[other] for other in others)),
        )
        yield replace(one, elsewhere=asked)


def _formulas(one: Draw) -> Iterator[Form]:
    for index in range(len(one.template.rules.part)):
        yield from asked_formulas(one, index)


def asked_formulas(drawn: Draw, index: int) -> Mapping[Form, str]:
    """Forms of the steps to an answer, each also with the steps before it put in, and the key."""
    found = _formulas_of_steps(plan_of(drawn.template), index)
    if answer_of(drawn, index)["kind"] == "expression":
        spec: expression.Spec = build(drawn, index).spec
        formula = author(spec.value, tuple(spec.symbols))
        return found | dict.fromkeys(equation("", formula), spec.value)
    return found


@lru_cache(maxsize=4096)
def _formulas_of_steps(plan: Plan, index: int) -> dict[Form, str]:
    """Those that are the same in every draw."""
    found: dict[Form, str] = {}
    inner: dict[str, Expr] = {}
    for step in plan.parts[index].steps:
        inner[step.name] = substitute(step.expr, inner)
        for expr in (step.expr, inner[step.name]):
            found |= dict.fromkeys(equation(step.name, expr), f"{step.name} = {to_text(expr)}")
    return found
