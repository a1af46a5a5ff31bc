"""Kind ``interval``: ``]0,1]``, ``(0; 1]`` and ``0 < x <= 1`` are the same interval."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import ClassVar, Literal

import msgspec

from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.labels import NAME
from quizgen.grading.reading.literals import with_decimal_points
from quizgen.grading.reading.normalise import normalise_typed
from quizgen.grading.reading.numbers import read_number
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.written_intervals import write_interval
from quizgen.grading.rounding import format_exact_or_figures, format_key
from quizgen.grading.spec import NumericSpec
from quizgen.grading.verdict import HALF, Verdict, correct, partial, verdict_by_share, wrong
from quizgen.kinds.asking import (
    make_spec,
    misconception_specs,
    nonempty,
    rounding_hint,
    rule_on_paper,
)
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredMeasured,
    FieldProblem,
    PartContext,
)
from quizgen.kinds.forms import format_plain, require_form
from quizgen.locale import translate
from quizgen.locale.word_patterns import WordPattern
from quizgen.maths.notation import FormulaReadError, pretty
from quizgen.maths.numbers import is_short_decimal
from quizgen.maths.tree import Call, Expr, Num
from quizgen.maths.values import Value


class AuthoredInterval(AuthoredMeasured, kw_only=True, tag="interval", frozen=True):
    """From one number to another, or several such: as written here, or a set of the solver."""

    of: str = ""
    brackets: Literal["", "any"] = ""
    value: str = ""
    traps: dict[str, str] = msgspec.field(default_factory=dict)

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield a problem unless there is an interval, and one alone."""
        yield from super().find_problems()
        if bool(self.of) == bool(self.value):
            yield (("of",) if self.of else ()), "QG112", "give either value or of"


class IntervalSpec(NumericSpec, kw_only=True, frozen=True):
    """Interval: ``value`` such as ``]0,1]``, ``(0, inf)`` or ``(-inf, -2] or [5, inf)``."""

    written_as: ClassVar[AnswerForm] = "formula"

    value: str
    brackets: Literal["", "any"] = ""

    def validate(self) -> None:
        """Check tolerance and the key's own notation; errors as ``WordSpec.validate``."""
        super().validate()
        for text in (self.value, *map(str, self.traps.values())):
            read_union(text, "point")

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on a typed interval: bounds first, then brackets.

        One wrong bracket costs half, two cost three quarters, also where the mistake has a name.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        typed = typed.strip(" $")
        if self.brackets:
            typed = _RANGE.sub(r"[\1; \2]", typed) if _RANGE.fullmatch(typed) else typed
        pieces, read_as = read_union(typed, options.decimal)
        keys, _ = read_union(self.value, "point")
        for name, text in self.traps.items():
            if self._is_same_union(pieces, read_union(str(text), "point")[0]):
                share = self._judge_union(pieces, keys, read_as).credit
                note = f"trap:{name}"
                return partial(share, read_as, note) if 0 < share < 1 else wrong(read_as, note)
        return self._judge_union(pieces, keys, read_as)

    def _judge_union(
        self, pieces: list[IntervalValue], keys: list[IntervalValue], read_as: str
    ) -> Verdict:
        """Return the verdict on a union of intervals, whatever mistakes are known."""
        if len(pieces) == len(keys) == 1:
            return self._judge_single(pieces[0], keys[0], read_as)
        if self._is_same_union(pieces, keys):
            return correct(read_as)
        if len(pieces) != len(keys):
            right = [
                key for key in keys if any(self._is_same_union([one], [key]) for one in pieces)
            ]
            share = Fraction(len(right), len(keys)) if len(right) == len(pieces) else Fraction(0)
            return verdict_by_share(share, read_as, "interval-count", right=len(pieces))
        bounds = all(self._has_same_bounds(*pair) for pair in zip(pieces, keys, strict=True))
        return partial(HALF, read_as, "union-brackets") if bounds else wrong(read_as, "bounds")

    def _is_same_union(self, pieces: list[IntervalValue], keys: list[IntervalValue]) -> bool:
        """Return whether a union has the key's pieces, with their bounds and brackets."""
        return len(pieces) == len(keys) and all(
            self._has_same_bounds(piece, key)
            and (
                bool(self.brackets)
                or (piece.closed_low, piece.closed_high) == (key.closed_low, key.closed_high)
            )
            for piece, key in zip(pieces, keys, strict=True)
        )

    def _has_same_bounds(self, interval: IntervalValue, key: IntervalValue) -> bool:
        """Return whether both bounds are the key's, whatever the brackets."""
        return _is_same_bound(self, interval.low, key.low) and _is_same_bound(
            self, interval.high, key.high
        )

    def _judge_single(self, interval: IntervalValue, key: IntervalValue, read_as: str) -> Verdict:
        """Return the verdict on one interval: wrong bounds are wrong, brackets cost points.

        One wrong bracket leaves half of the points, two leave a quarter.
        """
        low = _is_same_bound(self, interval.low, key.low)
        high = _is_same_bound(self, interval.high, key.high)
        if not (low and high):
            note = "bound-left" if high else "bound-right" if low else "bounds"
            return wrong(read_as, note)
        if self.brackets:
            return correct(read_as)
        left = interval.closed_low == key.closed_low
        right = interval.closed_high == key.closed_high
        if left and right:
            return correct(read_as)
        note = "bracket-right" if left else "bracket-left" if right else "brackets"
        return partial(HALF if left or right else Fraction(1, 4), read_as, note)

    def replace_key(self, form: Expr, /) -> IntervalSpec:
        """Return the specification with another union as its key, and without mistakes."""
        return msgspec.structs.replace(self, value=_write_union(form), traps={})

    def show(self) -> str:
        """Return the key as printed and as it can be typed back, as far as is asked."""
        pieces, written = read_union(self.value, "point")
        return " ∪ ".join(_echo(piece, self._show_bound) for piece in pieces) or written

    def _show_bound(self, value: Value) -> str:
        """Return a bound with the decimals or figures asked; one that needs fewer as it is."""
        asked = self.decimals is not None or self.sigfigs is not None
        if asked and not is_short_decimal(value):
            return format_key(self, value)
        return _show_figures(value)


class IntervalValue(msgspec.Struct, frozen=True):
    """Bounds (None for infinity) and whether they belong to it."""

    low: Value | None
    high: Value | None
    closed_low: bool
    closed_high: bool


_RANGE = re.compile(r"([-+−]?\d+(?:[.,]\d+)?) ?[-–—] ?(\d+(?:[.,]\d+)?)")
"""An interval without brackets, where nobody asks whether its bounds belong to it."""
_INFINITE = WordPattern(r"([-+]?) ?(?:∞|inf(?:inity)?|infty|oo|«wordings.infinity»)", re.IGNORECASE)
_NAMED = re.compile(rf"{NAME} ?(?:∈|in(?= )) ?|{NAME} ?[=:] ?(?=[\[\](])")
_WRAPPED = re.compile(r"[(\[{] ?[\[\](][^\[\](){}]+[\])\[] ?[)\]}]|\{[^{}]*\}")
_BRACKETED = re.compile(r"([\[\](]) ?(.+?) ?([\])\[])")
_CHAIN = re.compile(
    r"(?:(?P<low>[^<>≤≥=]+?) ?(?P<left><=?|≤) ?)?(?P<name>(?!inf\b|oo\b)[^\W\d_]\w*) ?"
    r"(?:(?P<right><=?|≤|>=?|≥) ?(?P<high>[^<>≤≥=]+))?"
)


# Without the blanks around it: those would be tried from each of many blanks in a row.
_JOINED = WordPattern(
    r"(?<=[\])\[}]) ?«and» ?(?=[\[\](])|∪|\\cup\b|(?<!\w)(?:«or»|union|[Uu])(?!\w)|∨"
)
_CONCLUDED = WordPattern(r"^.*[<>≤≥=].*[,;]? «so» ([\[(\]].+)$", re.IGNORECASE)
"""What is concluded from inequalities: ``x + 1 < 3, so (-inf; 2)``."""
_EMPTY = frozenset({"{}", "∅", "{ }", "empty", "leer"})
EMPTY = "{}"
"""How a union of no intervals is written."""


def read_union(typed: str, decimal: str) -> tuple[list[IntervalValue], str]:
    """Read an interval, or several that are joined, from left to right, and echo them.

    Raises
    ------
    FormulaReadError
        If one of them is none.
    """
    if typed.strip() in _EMPTY:
        return [], EMPTY
    typed = _CONCLUDED.sub(r"\1", typed.strip())
    inside = write_interval(re.sub(r"^\s*(?:L|S|D)\s*=\s*", "", typed))
    read = [read_interval(piece, decimal) for piece in _JOINED.split(inside.strip())]
    read.sort(key=lambda pair: (pair[0].low is not None, pair[0].low or 0))
    return [interval for interval, _ in read], " ∪ ".join(echo for _, echo in read)


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


def _show_figures(value: Value) -> str:
    """Return a bound as it was read."""
    return format_exact_or_figures(value, 12)


def _echo(interval: IntervalValue, show: Callable[[Value], str] = _show_figures) -> str:
    """Return an interval with outward brackets for bounds that do not belong to it."""
    low = "-∞" if interval.low is None else show(interval.low)
    high = "∞" if interval.high is None else show(interval.high)
    low, high = pretty.format_number(low), pretty.format_number(high)
    return (
        f"{'[' if interval.closed_low else ']'}{low}; {high}{']' if interval.closed_high else '['}"
    )


def _is_same_bound(spec: IntervalSpec, value: Value | None, key: Value | None) -> bool:
    """Return whether a bound is the key's, within the tolerance or both infinite."""
    if value is None or key is None:
        return value is None and key is None
    return spec.accepts(value, key)


def ask(part: PartContext) -> AskedPart[IntervalSpec]:
    """Return the interval as it is written."""
    given: dict[str, object] = {}
    if part.answer.get("of"):
        traps = {name: _format_union(part, f) for name, f in part.misconception_forms().items()}
        notes = part.misconception_notes(traps) if traps else {}
        value = _format_union(part, part.answer_form())
        given = {"value": value, "traps": traps, "notes": notes}
    spec = make_spec(IntervalSpec, part, **given)
    return AskedPart(spec, mistakes=misconception_specs(spec, "value"))


def _format_union(part: PartContext, form: Expr) -> str:
    """Return a union, or the points of a finite set, as the text of a key."""
    return _write_union(require_form(part, form, "union", "set"))


def _write_union(union: Expr) -> str:
    """Return a union or a finite set as the text of a key."""
    if not isinstance(union, Call):
        return EMPTY
    if union.op == "set":
        return " or ".join(f"[{point}; {point}]" for point in map(format_plain, union.args))
    return " or ".join(map(_format_piece, union.args)) or EMPTY


def _format_piece(piece: Expr) -> str:
    """Return one interval of a union as the text of a key, ``[0; 1[``."""
    if not isinstance(piece, Call):
        raise TypeError(piece)
    low, high, *sides = piece.args
    left, right = (isinstance(side, Num) and side.value != 0 for side in sides)
    start, end = "[" if left else "]", "]" if right else "["
    return f"{start}{format_plain(low)}; {format_plain(high)}{end}"


def input_hints(spec: IntervalSpec, lang: str) -> tuple[str, ...]:
    """Return the sentences on how an interval is typed, and on rounding."""
    return nonempty(translate(lang, "ask.interval"), rounding_hint(spec, spec.value, lang))


def paper_hints(spec: IntervalSpec, lang: str) -> tuple[str, ...]:
    """Return how an interval is written, and how exactly."""
    return nonempty(translate(lang, "on_paper.interval"), rule_on_paper(spec, lang))


KIND = AnswerKind(AuthoredInterval, IntervalSpec, ask, input_hints, paper_hints=paper_hints)
