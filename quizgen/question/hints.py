"""Sentences on how to type an answer that several kinds share: its unit and its rounding."""

from __future__ import annotations

from typing import TypeVar

from quizgen.bank.markdown import Inline
from quizgen.grading.spec import NumericSpec
from quizgen.locale import translate
from quizgen.maths.constants import parse_exact
from quizgen.maths.notation import pretty
from quizgen.maths.numbers import to_float
from quizgen.maths.units import format_unit
from quizgen.question.specs import Numbers, texts_of

T = TypeVar("T", bound=str | tuple[Inline, ...])


def given(*sentences: T) -> tuple[T, ...]:
    """The sentences that are not empty."""
    return tuple(sentence for sentence in sentences if sentence)


def unit(text: str, lang: str) -> str:
    """The unit that an answer is meant in, if it has one."""
    return translate(lang, "ask.unit", unit=format_unit(text)) if text else ""


def rounding(spec: NumericSpec, key: Numbers, lang: str) -> str:
    """How exactly an answer must be given, if that was stated."""
    rule, number = spec.stated or ("", "")
    if rule == "decimals":
        name = f"ask.decimals_{number}" if number in {0, 1} else "ask.decimals"
        return translate(lang, name, n=number)
    if rule == "sigfigs":
        return translate(lang, "ask.sigfigs", n=number)
    if rule == "exact":
        return translate(lang, "ask.whole" if _is_all_integers(spec, key) else "ask.exact")
    if rule == "rel":
        return translate(lang, "ask.rel", percent=_format_percent(str(number)))
    return (
        translate(lang, "ask.abs", abs=pretty.format_number(str(number))) if rule == "abs" else ""
    )


def _format_percent(share: str) -> str:
    return pretty.format_number(f"{to_float(parse_exact(share) * 100):g}")


def _is_all_integers(spec: NumericSpec, key: Numbers) -> bool:
    """Whether key and mistakes are all whole numbers, so that no one thinks of fractions."""
    answers = [key, *spec.traps.values()]
    return not any("/" in text for answer in answers for text in texts_of(answer))
