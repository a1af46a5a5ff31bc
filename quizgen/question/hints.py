"""What a learner is told about how to type an answer, derived from how it is marked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from quizgen.locale import word
from quizgen.maths.constants import exact_value
from quizgen.maths.numbers import to_float
from quizgen.maths.tolerance import tolerance_of
from quizgen.maths.units import shown


def hints(answer: Mapping[str, Any], spec: Mapping[str, Any], lang: str) -> tuple[str, ...]:
    """Sentences about form, unit and rounding of one answer field.

    Parameters
    ----------
    answer : mapping
        The part's ``answer`` table as authored.
    spec : mapping
        The specification built for this draw.
    lang : str
    """
    kind = str(spec["kind"])
    found = [_shape(kind, spec, lang), _unit(kind, answer, lang), _rounding(spec, lang)]
    return tuple(text for text in found if text)


def _shape(kind: str, spec: Mapping[str, Any], lang: str) -> str:
    if kind in {"number", "quantity", "angle"}:
        return word(lang, "ask.percent") if spec.get("percent") else ""
    if kind == "point":
        three = len(spec["values"]) > len("ab")
        return word(lang, "ask.point3" if three else "ask.point")
    if kind == "table":
        units = spec.get("units", {})
        names = [f"{n} ({shown(units[n])})" if n in units else n for n in spec["values"]]
        return word(lang, "ask.table", names=", ".join(names))
    if kind == "witness":
        return word(lang, "ask.witness", names="; ".join(f"{n} = ..." for n in spec["symbols"]))
    if kind == "order" and not spec.get("distractors"):
        return word(lang, "ask.order_all")
    return word(lang, f"ask.{kind}")


def _unit(kind: str, answer: Mapping[str, Any], lang: str) -> str:
    text = str(answer.get("unit", ""))
    if kind == "angle":
        return word(lang, "ask.degrees")
    if kind == "quantity":
        return word(lang, "ask.quantity", unit=shown(text))
    return word(lang, "ask.unit", unit=shown(text)) if text and kind in {"number", "point"} else ""


def _rounding(spec: Mapping[str, Any], lang: str) -> str:
    rule, number = tolerance_of(spec).stated or ("", "")
    if rule == "decimals":
        name = f"ask.decimals_{number}" if number in {0, 1} else "ask.decimals"
        return word(lang, name, n=number)
    if rule == "sigfigs":
        return word(lang, "ask.sigfigs", n=number)
    if rule == "exact":
        return word(lang, "ask.whole" if _whole(spec) else "ask.exact")
    if rule == "rel":
        return word(lang, "ask.rel", percent=f"{to_float(exact_value(number) * 100):g}")
    return word(lang, "ask.abs", abs=number) if rule == "abs" else ""


def _whole(spec: Mapping[str, Any]) -> bool:
    """Whether key and mistakes are all whole numbers, so that no one thinks of fractions."""
    return "/" not in str([spec.get("value"), spec.get("values"), spec.get("traps")])
