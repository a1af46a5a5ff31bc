"""Kind ``multi``: any number of options is right."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.choice import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.kinds.choice import offered


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The options in a drawn order."""
    return offered(drawn, index, Control("many", lines=0))


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """All right options are to be chosen."""
    return (word(lang, "ask.multi"),)


__all__ = ["build", "hints", "printed"]
