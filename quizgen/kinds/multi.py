"""Kind ``multi``: any number of options is right; graded as ``choice``."""

from __future__ import annotations

from quizgen.kinds.choice import AuthoredChoice, ChoiceSpec, ask_options
from quizgen.kinds.contract import AnswerKind, AskedPart, InputControl, PartContext
from quizgen.kinds.work import count_listed
from quizgen.locale import translate


class AuthoredMulti(AuthoredChoice, tag="multi", frozen=True):
    """Any number of several options."""

    negative: bool = True


def ask(part: PartContext) -> AskedPart[ChoiceSpec]:
    """Return the options in a drawn order; any number of them is right."""
    return ask_options(part, InputControl("many", lines=0))


def say_rule(spec: ChoiceSpec, lang: str) -> tuple[str, ...]:
    """Return that all right options are wanted, and what a wrong one costs."""
    return (translate(lang, "ask.multi_cancels" if spec.negative else "ask.multi"),)


KIND = AnswerKind(AuthoredMulti, ChoiceSpec, ask, say_rule, paper_hints=say_rule, verb="tick",
                  work=count_listed("tick", "options"))  # fmt: skip
