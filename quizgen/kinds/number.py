"""Kind ``number``: a plain number, with decimals, significant figures, form or percent asked."""

from __future__ import annotations

import re
from typing import ClassVar, Literal

import msgspec
from flint import fmpq
from msgspec.structs import replace

from quizgen.grading.diagnosis.carry_forward import diagnosis_for
from quizgen.grading.judge import show_spec
from quizgen.grading.judging.numeric import NumberTarget, best_verdict, judge_readings, judge_value
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading import bases
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.count_nouns import (
    check_count_nouns,
    count_noun_name,
    count_noun_unit,
    drop_count_noun,
    drop_count_nouns,
)
from quizgen.grading.reading.equalities import EqualitySide, read_sides
from quizgen.grading.reading.factor_words import read_factor
from quizgen.grading.reading.labels import drop_name
from quizgen.grading.reading.normalise import normalise_typed
from quizgen.grading.reading.numbers import (
    Readings,
    ReadNumber,
    as_percent,
    map_readings,
    percent_to_fraction,
    read_number,
    read_plain_number,
    scale_number,
)
from quizgen.grading.reading.quantities import TypedQuantity
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.spoken_values import read_share
from quizgen.grading.reading.units import TypedUnit, listed_unit
from quizgen.grading.rounding import format_key
from quizgen.grading.spec import ScalarSpec, is_large_count, is_whole_number
from quizgen.grading.verdict import HALF, Verdict, attach_values, partial, unreadable, wrong
from quizgen.kinds import quantity
from quizgen.kinds.asking import (
    accept_within_tolerance,
    ask_numeric,
    numeric_hints,
    precision_on_paper,
    show_exact_first,
    unit_hint,
)
from quizgen.kinds.contract import AnswerKind, AskedPart, AuthoredNumeric, PartContext
from quizgen.locale import translate
from quizgen.locale.word_patterns import WordPattern
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.notation import FormulaReadError, pretty
from quizgen.maths.units import format_unit, get_unit
from quizgen.maths.values import Value


class AuthoredNumber(AuthoredNumeric, tag="number", frozen=True):
    """A number without a unit, a share, a count."""

    form: Literal["", "fraction", "lowest", "decimal"] = ""
    percent: bool = False
    unit: str = ""
    notation: Literal["", "f-number"] = ""
    base: int = bases.TEN
    counts: str | tuple[str, ...] = ()


class NumberSpec(ScalarSpec, kw_only=True, frozen=True):
    """Number: ``value``; ``form`` = fraction, lowest, decimal; ``percent``; ``notation``.

    With ``percent`` the value is the fraction, tolerances and ``accept`` are in percent, and
    ``4.55 %``, ``4.55`` and ``0.0455`` are read alike. ``notation = "f-number"`` reads ``1:8``
    as 8. With ``unit`` (printed beside the field) the unit may be typed or left out. ``counts``
    are a unit or words for what is counted, which may be typed, too. A whole number of another
    ``base`` (2 to 16) is typed and printed in its digits.
    """

    written_as: ClassVar[AnswerForm] = "number"

    form: Literal["", "fraction", "lowest", "decimal"] = ""
    percent: bool = False
    unit: str = ""
    notation: Literal["", "f-number"] = ""
    base: int = bases.TEN
    counts: list[str] = msgspec.field(default_factory=list)

    def validate(self) -> None:
        """Check tolerance, value and traps."""
        super().validate()
        get_unit(self.unit)
        check_count_nouns(self.counts)
        if not 2 <= self.base <= bases.MOST:
            raise ValueError(f"base must be 2 to {bases.MOST}")
        if self.base != bases.TEN and not is_whole_number(parse_exact(self.value)):
            raise ValueError("base needs a whole number")

    @property
    def is_whole(self) -> bool:
        """Whether a whole number of things is counted."""
        return bool(self.counts) and is_large_count(parse_exact(self.value))

    def value_unit(self) -> str:
        """Return the unit printed next to the field; a percentage stands for a plain fraction."""
        return "1" if self.percent else self.unit

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on a typed number; of equal ones that were chained the best.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        if self.base != bases.TEN:
            return self._judge_in_base(typed, options)
        if self.unit:
            return _with_unit(self, typed, options)
        plain = read_plain_number(typed, options.decimal)
        if plain is not None:
            return _judge_all_readings(self, plain, options)
        source = _read_source(self, typed)
        try:
            sides = _read(self, source, options)
        except FormulaReadError:
            factor = self._read_spoken_share(typed)
            if not factor:
                raise
            sides = _read(self, SourceText.of(factor), options)
        verdict = best_verdict(_judge_side(self, side, source, options) for side in sides)
        if verdict.credit or not {*self.counts} & MILLIONS or not _MILLION.search(typed):
            return verdict
        last = re.split("[=≈]", typed)[-1]
        said = self.judge(_MILLION.sub("", last), options)  # 50 million for 50 Mpx
        return said if said.credit else verdict

    def _judge_in_base(self, typed: str, options: GradingOptions) -> Verdict:
        """Return the verdict on a number in another base; half for the right one in base ten.

        Raises
        ------
        FormulaReadError
            If a sign is no digit of the base.
        """
        try:
            number = bases.read_in_base(typed, self.base)
        except FormulaReadError:
            plain = typed.strip(" .")
            if plain.isdecimal() and int(plain) == parse_exact(self.value):
                return partial(HALF, plain, "base-asked", asked=self.base)
            raise
        return _judge_as(self, number, number.value, options)

    def _read_spoken_share(self, typed: str) -> str:
        """Return a factor or share in words, ``one fifth``, ``1 in 5``; else empty."""
        if self.counts:
            return ""
        share = read_share(typed) if 0 < parse_exact(self.value) < 1 else ""
        before, _, last = typed.rpartition("=")
        factor = share or read_factor(last)
        if before and factor.startswith("1/"):  # (8/4)^2 = 4 times less
            return ""
        return "" if self.percent and "/" not in factor else factor

    @property
    def printed_unit(self) -> str:
        """The unit that is printed beside the field on paper."""
        return "%" if self.percent else self.unit

    def show(self) -> str:
        """Return the key as printed and as it can be typed back."""
        if self.base != bases.TEN and is_whole_number(parse_exact(self.value)):
            return bases.format_in_base(int(parse_exact(self.value).p), self.base)
        if self.exact and not self.percent and not is_number(self.value):
            return f"{pretty.format_constant(str(self.value))} {format_unit(self.unit)}".rstrip()
        value = parse_exact(self.value) * (100 if self.percent else 1)
        unit_text = "%" if self.percent else format_unit(self.unit)
        return f"{pretty.format_number(format_key(self, value, self.form))} {unit_text}".rstrip()


_NUMBER = re.compile(r"[-+]?[\d./eE+-]+")


def is_number(value: Scalar) -> bool:
    """Whether a key is written in digits, and not as a formula such as ``3*sqrt(3)/2``."""
    return _NUMBER.fullmatch(str(value)) is not None


def _with_unit(spec: NumberSpec, typed: str, options: GradingOptions) -> Verdict:
    """Return the verdict on a number as on a quantity whose unit need not be typed."""
    fields = {n: getattr(spec, n) for n in quantity.QuantitySpec.__struct_fields__ if n != "bare"}
    return quantity.QuantitySpec(**fields, bare=True).judge(typed, options)


def _judge_all_readings(spec: NumberSpec, readings: Readings, options: GradingOptions) -> Verdict:
    """Return the verdict on a number that may have two readings."""
    return judge_readings(
        readings, lambda n: _judge(spec, n, options), spec.decimals, whole=spec.is_whole
    )


def _judge(spec: NumberSpec, number: ReadNumber, options: GradingOptions) -> Verdict:
    """Return the verdict on one reading, as a percentage where one is asked or typed."""
    if spec.percent:
        return _judge_percent(spec, number, options)
    if number.percent:
        return _judge_share(spec, number, options)
    first = _judge_as(spec, number, number.value, options)
    if "%" not in spec.counts or first.credit:
        return first
    share = _judge_as(spec, number, number.value * 100, options)
    return share if share.credit else first


def _judge_share(spec: NumberSpec, number: ReadNumber, options: GradingOptions) -> Verdict:
    """Return the verdict on ``5 %`` as 0.05, or as 5 where the question asks for percent.

    Where it asks for neither and 5 is right, it is asked back.
    """
    share = percent_to_fraction(number)
    verdict = _judge_as(spec, share, share.value, options)
    plain = replace(number, percent=False)
    if "%" in spec.counts:
        return _judge_as(spec, plain, plain.value, options)
    counted = spec.counts and abs(parse_exact(spec.value)) >= 1
    if counted or (not verdict.credit and _judge_as(spec, plain, plain.value, options).credit):
        return unreadable("percent-not-asked", number.read_as)
    return verdict


def _judge_percent(spec: NumberSpec, number: ReadNumber, options: GradingOptions) -> Verdict:
    """Return the verdict on a bare number as percent, or as the fraction if only that is right."""
    first = _judge_as(spec, number, number.value, options)
    if number.percent or first.credit:
        return first
    second = _judge_as(spec, number, number.value * 100, options)
    trapped = second.note.startswith("trap:") and not first.note.startswith("trap:")
    return second if second.credit or trapped else first


def _judge_as(
    spec: NumberSpec, number: ReadNumber, value: Value, options: GradingOptions
) -> Verdict:
    """Return the verdict on a value in the unit of the key, or in percent.

    ``number`` is how it was written.
    """
    scale = 100 if spec.percent else 1
    asked = NumberTarget(
        spec,
        parse_exact(spec.value) * scale,
        spec.trap_values(scale),
        spec.form,
        diagnosis_for(spec, number, fmpq(1, scale), options),
        ratio=not (spec.percent or spec.counts),
    )
    verdict = judge_value(asked, number, value)
    return attach_values(verdict, value / scale)


MILLIONS = frozenset({"Mpx", "MB", "Mbit"})
_MILLION = WordPattern(r"(?<=\d) ?(?:«million»|M)(?!\w)", re.IGNORECASE)
_TIMES = WordPattern(r" ?-? ?(?<![^\W\d_])(?:«times-behind»|[xX*])$", re.IGNORECASE)
_PER_HUNDRED = WordPattern(r"^«percent-before» (.+)$")
_REMARK = re.compile(r"(?<![\d.,*/^+-])(-?\d[\d.,/]*) \((?:[=≈] ?)?([^()]*\d[^()]*)\)$")
_LENS = re.compile(r"[fFƒ] ?/? ?(?=\d)|1 ?: ?(?=\d)")
_RATIO = re.compile(r"(?<=\d) ?: ?(?=\d)")


def _read(spec: NumberSpec, source: SourceText, options: GradingOptions) -> list[EqualitySide]:
    """Return a typed number; several sides if equal things are chained.

    Raises
    ------
    FormulaReadError
        If it cannot be read.
    """
    source = drop_count_nouns(drop_count_noun(source, spec.counts), spec.counts)
    if found := _with_remark(source, options):
        return found
    try:
        return [EqualitySide(TypedQuantity(source, None), read_number(source, options.decimal))]
    except FormulaReadError as error:
        found = [] if error.code == "two-readings" else _sides(source, options)
        if not found:
            raise
    return found


def _with_remark(source: SourceText, options: GradingOptions) -> list[EqualitySide]:
    """Return both sides of ``6.67 (20/3)`` where they are one number; none otherwise.

    Then it is no product, but a number and a remark on it.
    """
    if not _REMARK.search(source.text):
        return []
    try:
        return _sides(source.substitute(_REMARK, lambda m: f"{m[1]} = {m[2]}"), options)
    except FormulaReadError:
        return []


def _sides(source: SourceText, options: GradingOptions) -> list[EqualitySide]:
    """Return the sides of what is no plain number; none if they cannot be read either.

    Raises
    ------
    FormulaReadError
        If they have two readings.
    """
    try:
        bare = source.substitute(_TIMES, lambda _m: "").substitute(
            _PER_HUNDRED, lambda m: f"{m[1]} %"
        )
        return read_sides(bare, options.decimal)
    except FormulaReadError as error:
        if error.code in {"two-readings", "sides-differ"}:
            raise
        return []


def _judge_side(
    spec: NumberSpec, side: EqualitySide, source: SourceText, options: GradingOptions
) -> Verdict:
    """Return the verdict on one side; its unit may be what is counted, or percent as a word.

    Raises
    ------
    FormulaReadError
        If it has a unit, and the question asks for none.
    """
    typed = side.quantity.unit
    if typed is None:
        return _judge_all_readings(spec, side.readings, options)
    if not typed.dimension:
        times = typed.factor * 100  # 200 ‰ is 20 %
        return _judge_all_readings(
            spec, map_readings(side.readings, lambda n: _as_share(n, typed, times)), options
        )
    if not spec.counts:
        raise FormulaReadError("unit-not-asked", source.column(0), typed.text)
    unit_counted = listed_unit(count_noun_unit(spec.counts))
    if typed.dimension != unit_counted.dimension:
        return _other_thing(spec, side.readings, typed, options)
    factor = typed.factor / unit_counted.factor
    return _judge_all_readings(
        spec, map_readings(side.readings, lambda n: _scale_to_unit(n, typed, factor)), options
    )


def _as_share(number: ReadNumber, typed: TypedUnit, times: Value) -> ReadNumber:
    """Return a number of percent, permille or ppm as one of percent."""
    if times == 1:
        return as_percent(number)
    read_as = f"{number.read_as} {format_unit(typed.text)}"
    return replace(scale_number(number, times), read_as=read_as, percent=True)


def _scale_to_unit(number: ReadNumber, typed: TypedUnit, factor: Value) -> ReadNumber:
    """Return the number in the unit that is counted, with the typed unit in its echo."""
    read_as = f"{number.read_as} {format_unit(typed.text)}"
    return replace(scale_number(number, factor), read_as=read_as)


def _other_thing(
    spec: NumberSpec, readings: Readings, typed: TypedUnit, options: GradingOptions
) -> Verdict:
    """Return the wrong verdict on a number of something else than what is counted."""
    right = _judge_all_readings(spec, readings, options).credit
    fields = {"given": format_unit(typed.text), "asked": count_noun_name(spec.counts, options.lang)}
    read_as = f"{readings.main.read_as} {fields['given']}"
    return wrong(read_as, "unit-wrong" if right else "unit-clash", **fields)


def _read_source(spec: NumberSpec, typed: str) -> SourceText:
    """Return what was typed without the name before it, with its colons as they are meant.

    ``f/2.8`` and, where it cannot be a ratio, ``1:2.8`` are the f-number 2.8; any other colon
    between numbers is a division.
    """
    source = drop_name(normalise_typed(typed))
    match = _LENS.match(source.text)
    ratio = match is not None and match[0].startswith("1") and spec.notation != "f-number"
    if match is None or (ratio and not re.search(r"[.,]\d", source.text)):
        return source.substitute(_RATIO, lambda _m: "/")
    return source.slice(match.end())


def ask(part: PartContext) -> AskedPart[NumberSpec]:
    """Return one number, and the number that each mistake gives."""
    return ask_numeric(NumberSpec, part)


def input_hints(spec: NumberSpec, lang: str) -> tuple[str, ...]:
    """Return the sentences on percent, unit and rounding; of another base only that it is."""
    if spec.base != bases.TEN:
        return (translate(lang, "ask.base", base=str(spec.base)),)
    percent = translate(lang, "ask.percent") if spec.percent else ""
    return numeric_hints(spec, lang, percent, unit_hint(spec.unit, lang))


def paper_hints(spec: NumberSpec, lang: str) -> tuple[str, ...]:
    """Return the base of the digits, else how exactly the number must be given."""
    return input_hints(spec, lang) if spec.base != bases.TEN else precision_on_paper(spec, lang)


def explain_key(spec: NumberSpec, lang: str) -> str:
    """Return the key with the exact value first, unless a percentage or another base is asked."""
    plain = spec.percent or spec.base != bases.TEN
    return show_spec(spec, lang) if plain else show_exact_first(spec, lang)


KIND = AnswerKind(
    AuthoredNumber,
    NumberSpec,
    ask,
    input_hints,
    explain_key,
    paper_hints,
    accept_within_tolerance,
)
