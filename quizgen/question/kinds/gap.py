"""Kind ``gap``: words are to be filled in."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.gap import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.specs import answer_of, specification, synonyms


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The words of every gap, of all languages."""
    gaps = answer_of(drawn, index)["gaps"]
    accept = [synonyms(drawn, drawn.words.get(name, name)) for name in gaps]
    return Built(specification(Spec, drawn, index, accept=accept), Control("gaps"))


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """How words are typed."""
    return (word(lang, "ask.gap"),)


__all__ = ["build", "hints", "printed"]
