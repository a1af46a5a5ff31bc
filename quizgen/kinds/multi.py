"""Kind ``multi``: any number of options is right; graded as ``choice``."""

from __future__ import annotations

from quizgen.kinds.asking import hint, say_on_paper
from quizgen.kinds.choice import AuthoredChoice, ChoiceSpec, ask_options
from quizgen.kinds.contract import AnswerKind, AskedPart, InputControl, PartContext
from quizgen.kinds.work import count_listed


class AuthoredMulti(AuthoredChoice, tag="multi", frozen=True):
    """Any number of several options."""

    negative: bool = True


def ask(part: PartContext) -> AskedPart[ChoiceSpec]:
    """Return the options in a drawn order; any number of them is right."""
    return ask_options(part, InputControl("many", lines=0))


KIND = AnswerKind(AuthoredMulti, ChoiceSpec, ask, hint("ask.multi"),
                  paper_hints=say_on_paper("ask.multi"), verb="tick",
                  work=count_listed("tick", "options"))  # fmt: skip
