"""Kind ``code``: what a program prints."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.bank.prose import Code
from quizgen.locale import word
from quizgen.marking.kinds.code import Spec
from quizgen.marking.mark import show
from quizgen.question.contract import Built, Control
from quizgen.question.filling import in_program
from quizgen.question.shown import Shown
from quizgen.question.specs import answer_of, mistaken, notes, specification


def build(drawn: Draw, index: int) -> Built[Spec]:
    """Printed output and wrong outputs, with the drawn values in place."""
    answer = answer_of(drawn, index)

    def put(text: object) -> str:
        return in_program(str(text), drawn, drawn.shown_values)

    output = put(answer["output"])
    wrong = {trap: put(text) for trap, text in answer.get("traps", {}).items()}
    usable = {trap: text for trap, text in wrong.items() if text != output}
    spec = specification(
        Spec, drawn, index, output=output, traps=usable, notes=notes(drawn, usable)
    )
    return Built(spec, Control("lines", lines=3), mistakes=mistaken(spec, "output"))


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """Exactly as printed."""
    return (word(lang, "ask.code"),)


def printed(spec: Spec, lang: str) -> Shown:
    """The output as it stands in a terminal."""
    return (Code(show(spec, lang)),)
