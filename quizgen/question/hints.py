"""Sentences on how to type an answer that several kinds share: its unit and its rounding."""

from __future__ import annotations

from typing import TypeVar

from quizgen.bank.prose import Inline
from quizgen.locale import word
from quizgen.marking.specs import Measured
from quizgen.maths.constants import exact_value
from quizgen.maths.notation import people
from quizgen.maths.numbers import to_float
from quizgen.maths.units import shown
from quizgen.question.specs import Numbers, texts_of

T = TypeVar("T", bound=str | tuple[Inline, ...])


def given(*sentences: T) -> tuple[T, ...]:
    """The sentences that are not empty."""
    return tuple(sentence for sentence in sentences if sentence)


def unit(text: str, lang: str) -> str:
    """The unit that an answer is meant in, if it has one."""
    return word(lang, "ask.unit", unit=shown(text)) if text else ""


def rounding(spec: Measured, key: Numbers, lang: str) -> str:
    """How exactly an answer must be given, if that was stated."""
    rule, number = spec.stated or ("", "")
    if rule == "decimals":
        name = f"ask.decimals_{number}" if number in {0, 1} else "ask.decimals"
        return word(lang, name, n=number)
    if rule == "sigfigs":
        return word(lang, "ask.sigfigs", n=number)
    if rule == "exact":
        return word(lang, "ask.whole" if _whole(spec, key) else "ask.exact")
    if rule == "rel":
        return word(lang, "ask.rel", percent=_percent(str(number)))
    return word(lang, "ask.abs", abs=people.number(str(number))) if rule == "abs" else ""


def _percent(share: str) -> str:
    return people.number(f"{to_float(exact_value(share) * 100):g}")


def _whole(spec: Measured, key: Numbers) -> bool:
    """Whether key and mistakes are all whole numbers, so that no one thinks of fractions."""
    answers = [key, *spec.traps.values()]
    return not any("/" in text for answer in answers for text in texts_of(answer))
