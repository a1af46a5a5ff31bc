"""Kind ``code``: what a program prints."""

from __future__ import annotations

from quizgen.bank.markdown import InlineCode
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.code import Spec
from quizgen.grading.mark import show_key
from quizgen.locale import translate
from quizgen.question.contract import Built, Control
from quizgen.question.inlines import TextOrInlines
from quizgen.question.interpolation import fill_program
from quizgen.question.specs import authored_answer, misconception_notes, mistaken, specification


def build(drawn: Variant, index: int) -> Built[Spec]:
    """Printed output and wrong outputs, with the drawn values in place."""
    answer = authored_answer(drawn, index)

    def put(text: object) -> str:
        return fill_program(str(text), drawn, drawn.shown_values)

    output = put(answer["output"])
    wrong = {trap: put(text) for trap, text in answer.get("traps", {}).items()}
    usable = {trap: text for trap, text in wrong.items() if text != output}
    spec = specification(
        Spec, drawn, index, output=output, traps=usable, notes=misconception_notes(drawn, usable)
    )
    return Built(spec, Control("lines", lines=3), mistakes=mistaken(spec, "output"))


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """Exactly as printed."""
    return (translate(lang, "ask.code"),)


def printed(spec: Spec, lang: str) -> TextOrInlines:
    """The output as it stands in a terminal."""
    return (InlineCode(show_key(spec, lang)),)
