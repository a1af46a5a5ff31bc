"""Kind ``interval``: ``]0,1]``, ``(0; 1]`` and ``0 < x <= 1`` are the same interval."""

from __future__ import annotations

import re
from fractions import Fraction

import msgspec

from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.labels import NAME
from quizgen.grading.reading.literals import with_decimal_points
from quizgen.grading.reading.normalise import normalise_typed
from quizgen.grading.reading.numbers import read_number
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.rounding import format_exact_or_figures
from quizgen.grading.spec import NumericSpec
from quizgen.grading.verdict import HALF, Verdict, correct, partial, wrong
from quizgen.kinds.asking import make_spec, misconception_specs, nonempty, rounding_hint
from quizgen.kinds.contract import AnswerKind, AskedPart, AuthoredMeasured, PartContext
from quizgen.locale import translate
from quizgen.maths.notation import FormulaReadError, pretty
from quizgen.maths.values import Value


class AuthoredInterval(AuthoredMeasured, kw_only=True, tag="interval", frozen=True):
    """From one number to another."""

    value: str
    traps: dict[str, str] = msgspec.field(default_factory=dict)


class IntervalSpec(NumericSpec, kw_only=True, frozen=True):
    """Interval: ``value`` such as ``]0,1]`` or ``(0, inf)``."""

    value: str

    def validate(self) -> None:
        """Check tolerance and the key's own notation; errors as ``WordSpec.validate``."""
        super().validate()
        read_interval(self.value, "point")

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on a typed interval: bounds first, then brackets.

        One wrong bracket costs half, two cost three quarters.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        interval, read_as = read_interval(typed, options.decimal)
        key, _ = read_interval(self.value, "point")
        low = _same(self, interval.low, key.low)
        high = _same(self, interval.high, key.high)
        if not (low and high):
            note = "bound-left" if high else "bound-right" if low else "bounds"
            return wrong(read_as, note)
        left = interval.closed_low == key.closed_low
        right = interval.closed_high == key.closed_high
        if left and right:
            return correct(read_as)
        note = "bracket-right" if left else "bracket-left" if right else "brackets"
        return partial(HALF if left or right else Fraction(1, 4), read_as, note)

    def show(self) -> str:
        """Return the key as printed and as it can be typed back."""
        return read_interval(self.value, "point")[1]


class IntervalValue(msgspec.Struct, frozen=True):
    """Bounds (None for infinity) and whether they belong to it."""

    low: Value | None
    high: Value | None
    closed_low: bool
    closed_high: bool


_INFINITE = re.compile(r"([-+]?) ?(?:∞|inf(?:inity)?|infty|oo|unendlich|অসীম)", re.IGNORECASE)
_NAMED = re.compile(rf"{NAME} ?(?:∈|in(?= )) ?|{NAME} ?[=:] ?(?=[\[\](])")
_WRAPPED = re.compile(r"[(\[{] ?[\[\](][^\[\](){}]+[\])\[] ?[)\]}]|\{[^{}]*\}")
_BRACKETED = re.compile(r"([\[\](]) ?(.+?) ?([\])\[])")
_CHAIN = re.compile(
    r"(?:(?P<low>[^<>≤≥=]+?) ?(?P<left><=?|≤) ?)?(?P<name>(?!inf\b|oo\b)[^\W\d_]\w*) ?"
    r"(?:(?P<right><=?|≤|>=?|≥) ?(?P<high>[^<>≤≥=]+))?"
)


def read_interval(typed: str, decimal: str) -> tuple[IntervalValue, str]:
    """Return a typed interval, and its echo.

    Raises
    ------
    FormulaReadError
        If it is none.
    """
    source = normalise_typed(typed)
    match = _NAMED.match(source.text)
    if match:
        source = source.slice(match.end())
    source = _inside(source)
    bracketed = _BRACKETED.fullmatch(source.text)
    interval = _brackets(source, bracketed, decimal) if bracketed else _chain(source, decimal)
    if interval.low is not None and interval.high is not None and interval.low > interval.high:
        raise FormulaReadError("bounds-order", 1, source.text)
    return interval, _echo(interval)


def _inside(source: SourceText) -> SourceText:
    """Return an interval with its own brackets without others around it."""
    while _WRAPPED.fullmatch(source.text):
        source = source.slice(1, len(source.text) - 1).strip()
    return source


def _brackets(source: SourceText, match: re.Match[str], decimal: str) -> IntervalValue:
    """Return the interval of two bounds in brackets.

    Raises
    ------
    FormulaReadError
        If they are not two, or commas separate and mark decimals at once.
    """
    inside = source.slice(match.start(2), match.end(2))
    strong = list(re.finditer(r" ?[;|] ?", inside.text))
    cuts = strong or list(re.finditer(r" ?, ?", inside.text))
    if len(cuts) != 1:
        code = "comma-twice" if cuts and not strong else "item-count"
        raise FormulaReadError(code, source.column(0), str(len(cuts) + 1), ["2"])
    low = _parse_bound(inside.slice(0, cuts[0].start()), decimal, "-")
    high = _parse_bound(inside.slice(cuts[0].end()), decimal, "+")
    closed_low = match[1] == "[" and low is not None
    return IntervalValue(low, high, closed_low, match[3] == "]" and high is not None)


def _chain(source: SourceText, decimal: str) -> IntervalValue:
    """Return the interval of a chain of relations: ``0 < x <= 1``, ``x > 2``.

    Raises
    ------
    FormulaReadError
        If it is none, or its relations point both ways.
    """
    match = _CHAIN.fullmatch(source.text)
    if match is None or not (match["low"] or match["high"]):
        raise FormulaReadError("interval-expected", source.column(0), source.text)
    low = high = None
    closed_low = closed_high = False
    if match["low"]:
        low = _parse_bound(source.slice(match.start("low"), match.end("low")), decimal, "-")
        closed_low = match["left"] in {"<=", "≤"} and low is not None
    if match["high"]:
        side = "+" if match["right"][0] in "<≤" else "-"
        bound = _parse_bound(source.slice(match.start("high"), match.end("high")), decimal, side)
        closed = match["right"] in {"<=", "≤", ">=", "≥"} and bound is not None
        if match["right"][0] in "<≤":
            high, closed_high = bound, closed
        elif low is None:
            low, closed_low = bound, closed
        else:
            raise FormulaReadError("bounds-order", source.column(match.start("right")), source.text)
    return IntervalValue(low, high, closed_low, closed_high)


def _parse_bound(source: SourceText, decimal: str, side: str) -> Value | None:
    """Return a bound; None is the infinity of its side, ``-`` or ``+``.

    Raises
    ------
    FormulaReadError
        If it is the infinity of the other side, or no number.
    """
    source = source.strip()
    infinite = _INFINITE.fullmatch(source.text)
    if infinite is not None:
        if (infinite[1] or "+") != side:
            raise FormulaReadError("bounds-order", source.column(0), source.text)
        return None
    if with_decimal_points(source, decimal)[2] and decimal == "auto":
        raise FormulaReadError("two-readings", source.column(0), source.text)
    return read_number(source, decimal).main.value


def _echo(interval: IntervalValue) -> str:
    """Return an interval with outward brackets for bounds that do not belong to it."""
    low = "-∞" if interval.low is None else format_exact_or_figures(interval.low, 12)
    high = "∞" if interval.high is None else format_exact_or_figures(interval.high, 12)
    low, high = pretty.format_number(low), pretty.format_number(high)
    return (
        f"{'[' if interval.closed_low else ']'}{low}; {high}{']' if interval.closed_high else '['}"
    )


def _same(spec: IntervalSpec, value: Value | None, key: Value | None) -> bool:
    """Return whether a bound is the key's, within the tolerance or both infinite."""
    if value is None or key is None:
        return value is None and key is None
    return spec.accepts(value, key)


def ask(part: PartContext) -> AskedPart[IntervalSpec]:
    """Return the interval as it is written."""
    spec = make_spec(IntervalSpec, part)
    return AskedPart(spec, mistakes=misconception_specs(spec, "value"))


def input_hints(spec: IntervalSpec, lang: str) -> tuple[str, ...]:
    """Return the sentences on how an interval is typed, and on rounding."""
    return nonempty(translate(lang, "ask.interval"), rounding_hint(spec, spec.value, lang))


KIND = AnswerKind(AuthoredInterval, IntervalSpec, ask, input_hints)
