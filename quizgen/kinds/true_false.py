"""Kind ``tf``: a statement is true or false; graded as ``choice``."""

from __future__ import annotations

from typing import Literal

import msgspec

from quizgen.kinds.asking import append_source, hint, make_spec
from quizgen.kinds.choice import ChoiceSpec
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    Condition,
    InputControl,
    PartContext,
)
from quizgen.kinds.work import count_once


class AuthoredTrueFalse(AuthoredAnswer, tag="tf", frozen=True):
    """A statement that is true or false."""

    true: Condition = True
    claim: str = ""
    source: Literal["claims"] | None = msgspec.field(name="from", default=None)


def selected_statement(part: PartContext) -> tuple[str, Condition, str]:
    """Return the statement's name, when it is true, and its source.

    It is the part's own statement, or one of the pool.
    """
    if "from" in part.answer:
        return part.claim()
    claim = part.answer.get("claim", "")
    return part.words.get(claim, claim), part.answer["true"], ""


def ask(part: PartContext) -> AskedPart[ChoiceSpec]:
    """Return true first, then false; the statement's one reason explains either."""
    name, condition, source = selected_statement(part)
    told = part.with_reason([("A", name), ("B", name)])
    spec = make_spec(
        ChoiceSpec,
        part,
        options=["true", "false"],
        correct=[1 if part.condition_holds(condition) else 2],
        why=append_source(part.reasons(told), source),
    )
    return AskedPart(
        spec,
        InputControl("truth"),
        statements=(("claims", name),) if "from" in part.answer else (),
        right=(("reasons", name),) if told else (),
        source=source,
    )


KIND = AnswerKind(
    AuthoredTrueFalse, ChoiceSpec, ask, hint("ask.tf"), verb="tick", work=count_once("tick")
)
