"""Kind ``multi``: any number of options is right."""

from __future__ import annotations

from quizgen.bank.variant import Variant
from quizgen.grading.kinds.choice import Spec
from quizgen.grading.mark import show_key as printed
from quizgen.locale import translate
from quizgen.question.contract import Built, Control
from quizgen.question.kinds.choice import offered


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The options in a drawn order."""
    return offered(drawn, index, Control("many", lines=0))


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """All right options are to be chosen."""
    return (translate(lang, "ask.multi"),)


__all__ = ["build", "hints", "printed"]
