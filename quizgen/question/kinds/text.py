"""Kind ``text``: a few sentences that name the key points."""

from __future__ import annotations

from quizgen.bank.variant import Variant
from quizgen.grading.kinds.text import Spec
from quizgen.locale import translate
from quizgen.question.contract import Built, Control
from quizgen.question.specs import accepted_words, authored_answer, specification


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The key points; a model sentence tells each."""
    points = authored_answer(drawn, index)["points"]
    spec = specification(
        Spec, drawn, index, points={name: accepted_words(drawn, name) for name in points}
    )
    right = tuple(("points", name) for name in points)
    return Built(spec, Control("lines", lines=4), right=right)


FEW = 2
"""Key points that one or two sentences can hold."""


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """In own words, as short as the key points allow."""
    count = len(spec.points)
    return (
        translate(lang, "ask.text")
        if count <= FEW
        else translate(lang, "ask.text_many").format(n=count),
    )


def printed(_spec: Spec, _lang: str) -> str:
    """Nothing: the model sentences tell the answer."""
    return ""
