"""Kind ``number``: a plain number, with decimals, significant figures, form or percent asked."""

from __future__ import annotations

import re
from typing import Any, Literal

from flint import fmpq

from quizgen.marking.diagnosis.context import hints_for
from quizgen.marking.judging.number import Asked, judge_value, resolve
from quizgen.marking.options import Options
from quizgen.marking.reading.quantities import split_quantity
from quizgen.marking.reading.rewrites import Source, normalise
from quizgen.marking.reading.scalars import (
    Number,
    ReadError,
    Readings,
    quick,
    read_source,
)
from quizgen.marking.rounding import exact_or_figures, rounded, with_figures
from quizgen.marking.specs import Measured
from quizgen.marking.verdict import Verdict, unreadable, with_values
from quizgen.maths.constants import Scalar, exact_value
from quizgen.maths.units import shown as shown_unit
from quizgen.maths.units import unit


class Spec(Measured, kw_only=True):
    """Number: ``value``; ``form`` = fraction, lowest, decimal; ``percent``; ``notation``.

    With ``percent`` the value is the fraction, tolerances and ``accept`` are in percent, and
    ``4.55 %``, ``4.55`` and ``0.0455`` are read alike. ``notation = "f-number"`` reads ``1:8``
    as 8. With ``unit`` (printed beside the field) the unit may be typed or left out.
    """

    value: Scalar
    form: Literal["", "fraction", "lowest", "decimal"] = ""
    percent: bool = False
    unit: str = ""
    notation: Literal["", "f-number"] = ""

    def validate(self) -> None:
        """Check tolerance, value and traps."""
        super().validate()
        exact_value(self.value)
        unit(self.unit)
        for trap in self.traps.values():
            for item in trap if isinstance(trap, list) else [trap]:
                exact_value(item)


def check(spec: Spec, typed: str, options: Options) -> Verdict:
    """Judge a typed number."""
    if spec.unit:
        return _with_unit(spec, typed, options)
    readings = quick(typed, options.decimal) or _read(spec, typed, options)
    return resolve(readings, lambda n: _judge(spec, n, options), spec.decimals)


def _with_unit(spec: Spec, typed: str, options: Options) -> Verdict:
    """Judge as a quantity whose unit need not be typed."""
    from quizgen.marking.kinds import quantity

    fields = {
        name: getattr(spec, name) for name in quantity.Spec.__struct_fields__ if name != "bare"
    }
    return quantity.check(quantity.Spec(**fields, bare=True), typed, options)


def _judge(spec: Spec, number: Number, options: Options) -> Verdict:
    if spec.percent:
        return _judge_percent(spec, number, options)
    if number.percent:
        return unreadable("percent-not-asked", number.read_as)
    return _judge_as(spec, number, number.value, options)


def _judge_percent(spec: Spec, number: Number, options: Options) -> Verdict:
    """Read a bare number as percent, or as the fraction if only that is right."""
    first = _judge_as(spec, number, number.value, options)
    if number.percent or first.credit:
        return first
    second = _judge_as(spec, number, number.value * 100, options)
    trapped = second.note.startswith("trap:") and not first.note.startswith("trap:")
    return second if second.credit or trapped else first


def _judge_as(spec: Spec, number: Number, value: Any, options: Options) -> Verdict:
    scale = 100 if spec.percent else 1
    asked = Asked(
        spec,
        exact_value(spec.value) * scale,
        trap_values(spec, scale),
        spec.form,
        hints_for(spec, number, fmpq(1, scale), options),
    )
    verdict = judge_value(asked, number, value)
    return with_values(verdict, value / scale)


def trap_values(spec: Measured, scale: Any = 1) -> list[tuple[str, Any]]:
    """Every trap's name with each value it can give."""
    return [
        (name, exact_value(item) * scale)
        for name, value in spec.traps.items()
        for item in (value if isinstance(value, list) else [value])
    ]


_LENS = re.compile(r"[fFƒ] ?/? ?(?=\d)|1 ?: ?(?=\d)")
_RATIO = re.compile(r"(?<=\d) ?: ?(?=\d)")
_NAMED = re.compile(r"[^\W\d_][^\W_]*'*(?:_[^\W_]+'*)* ?(?:=|≈|:|:=) ?")


def _read(spec: Spec, typed: str, options: Options) -> Readings:
    source = _without_lens(spec, without_name(normalise(typed)))
    try:
        return read_source(source, options.decimal)
    except ReadError:
        _refuse_unit(source)
        raise


def _refuse_unit(source: Source) -> None:
    """Say so when the only trouble is a unit that nobody asked for."""
    try:
        quantity = split_quantity(source)
    except ReadError:
        return
    if quantity.unit is not None:
        raise ReadError("unit-not-asked", source.column(0), quantity.unit.text)


def without_name(source: Source) -> Source:
    """Drop a leading ``u =``."""
    match = _NAMED.match(source.text)
    return source.cut(match.end()) if match and match.end() < len(source.text) else source


def _without_lens(spec: Spec, source: Source) -> Source:
    """Read ``f/2.8`` and, where it cannot be a ratio, ``1:2.8`` as the f-number 2.8.

    Any other colon between numbers is a division.
    """
    match = _LENS.match(source.text)
    ratio = match is not None and match[0].startswith("1") and spec.notation != "f-number"
    if match is None or (ratio and not re.search(r"[.,]\d", source.text)):
        return source.sub(_RATIO, lambda _m: "/")
    return source.cut(match.end())


def show(spec: Spec, lang: str) -> str:  # noqa: ARG001 - one notation in all languages
    """Return the key as printed and as it can be typed back."""
    value = exact_value(spec.value) * (100 if spec.percent else 1)
    unit_text = "%" if spec.percent else shown_unit(spec.unit)
    return f"{shown(spec, value, spec.form)} {unit_text}".rstrip()


def shown(spec: Measured, value: Any, form: str = "") -> str:
    """Write a key value as far as its tolerance asks."""
    if form in {"fraction", "lowest"} and isinstance(value, fmpq):
        return str(value)
    if spec.decimals is not None:
        return rounded(value, spec.decimals)
    if spec.sigfigs is not None:
        return with_figures(value, spec.sigfigs)
    if spec.exact and isinstance(value, fmpq):
        decimal = _terminates(value) and value.q != 1
        return exact_or_figures(value, 12) if decimal else str(value)
    return _for_tolerance(spec, value)


def _terminates(value: fmpq) -> bool:
    rest = int(value.q)
    for prime in (2, 5):
        while rest % prime == 0:
            rest //= prime
    return rest == 1


def _for_tolerance(spec: Measured, value: Any) -> str:
    """Write enough figures that rounding takes at most a tenth of the tolerance."""
    width = spec.half_width(value)
    figures = 4
    while figures < 30 and value != 0:
        text = exact_or_figures(value, figures)
        if not abs(exact_value(text) - value) * 10 > width:
            return text
        figures += 1
    return exact_or_figures(value, figures)
