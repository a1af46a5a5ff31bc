"""Judging one number against a key: value, then traps, then precision and form."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import msgspec
from flint import fmpq
from msgspec.structs import replace

from quizgen.marking.diagnosis.context import Hints
from quizgen.marking.diagnosis.slips import close, slip
from quizgen.marking.reading.literals import Doubt
from quizgen.marking.reading.scalars import Number, Readings
from quizgen.marking.specs import mistaken
from quizgen.marking.verdict import HALF, Verdict, ambiguous, correct, partial, wrong
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.values import Value

Judge = Callable[[Number], Verdict]


def resolve(readings: Readings, judge: Judge, places_asked: int | None = None) -> Verdict:
    """Judge a number that may have two readings; ask back when they would be marked differently.

    The decimal reading of the learner's own decimal sign may count when it is right; a reading
    with thousands groups counts only when the learner declared the other sign.
    """
    verdict = judge(readings.main)
    if readings.other is None or readings.doubt is None:
        return verdict
    if readings.doubt.native and (places_asked == 3 or verdict.credit):
        return verdict
    other = judge(readings.other)
    return settle(verdict, other, readings.doubt, (readings.main.read_as, readings.other.read_as))


def best(verdicts: Iterable[Verdict]) -> Verdict:
    """The best verdict of equal things that were chained; of equals the last."""
    *before, chosen = verdicts
    for verdict in reversed(before):
        chosen = verdict if verdict.credit > chosen.credit else chosen
    return chosen


def settle(first: Verdict, second: Verdict, doubt: Doubt, echoes: tuple[str, str]) -> Verdict:
    """Choose between the verdicts of two readings, or ask back."""
    if doubt.group_wins and not first.credit:
        return second
    if not (first.credit or second.credit):
        return first
    return ambiguous("two-readings", " | ".join(echoes), first=echoes[0], second=echoes[1])


class Asked(msgspec.Struct, frozen=True):
    """What one number is judged by.

    Parameters
    ----------
    spec : Tolerance
        Tolerance and precision asked.
    key : flint.fmpq or flint.arb
        The key, in the unit of the judged values.
    traps : sequence of (str, value)
        Known mistakes and what they give.
    form : str
        ``fraction``, ``lowest``, ``decimal`` or empty.
    hints : Hints, optional
        The question around: errors carried forward, slips in its chain.
    ratio : bool
        Whether it is a plain ratio, which can be upside down.
    """

    spec: Tolerance
    key: Value
    traps: Sequence[tuple[str, Value]] = ()
    form: str = ""
    hints: Hints | None = None
    ratio: bool = False


def judge_value(asked: Asked, number: Number, value: Value, read_as: str = "") -> Verdict:
    """Judge a value that stands in the key's unit; ``number`` says how it was written."""
    read_as = read_as or number.read_as
    if asked.spec.accepts(value, asked.key):
        return _form(asked.spec, number, asked.form, read_as)
    if whole_enough(asked.spec, number, value, asked.key):
        return correct(read_as, "whole-number")
    carried = asked.hints.carried(value) if asked.hints else None
    if carried is not None:
        return replace(carried, read_as=read_as)
    trap = trapped(asked.spec, number, value, asked.traps)
    if trap:
        return wrong(read_as, f"trap:{trap}")
    return _coarse(asked.spec, number, value, asked.key, read_as) or _slipped(
        asked, number, value, read_as
    )


def _slipped(asked: Asked, number: Number, value: Value, read_as: str) -> Verdict:
    if value != 0 and close(-value, asked.key):
        return wrong(read_as, "sign")
    diagnosed = asked.hints.slip(value) if asked.hints else None
    if diagnosed is not None:
        return replace(diagnosed, read_as=read_as)
    note, fields = slip(number, value, asked.key, ratio=asked.ratio)
    return wrong(read_as, note, **fields)


def whole_enough(spec: Tolerance, number: Number, value: Value, key: Value) -> bool:
    """Whether an exact whole number was given as a decimal within 0.01 of it."""
    if not spec.exact or number.form != "decimal" or not isinstance(key, fmpq):
        return False
    return bool(key.q == 1 and key != 0 and abs(value - key) <= fmpq(1, 100))


def trapped(
    spec: Tolerance, number: Number, value: Value, traps: Iterable[tuple[str, Value]]
) -> str:
    """Name of the nearest known mistake that gives the value, or an empty text."""
    hits = [
        (abs(value - trap), name) for name, trap in traps if mistaken(spec, number, value, trap)
    ]
    if not hits:
        return ""
    nearest = hits[0]
    for hit in hits[1:]:
        if hit[0] < nearest[0]:
            nearest = hit
    return nearest[1]


def _form(spec: Tolerance, number: Number, form: str, read_as: str) -> Verdict:
    if form in {"fraction", "lowest"} and number.form not in {"fraction", "mixed", "integer"}:
        return partial(HALF, read_as, "form-fraction")
    if form == "lowest" and not number.lowest:
        return partial(HALF, read_as, "form-lowest")
    if form == "decimal" and number.form in {"fraction", "mixed", "expression"}:
        return partial(HALF, read_as, "form-decimal")
    return _precision(spec, number, read_as)


def _precision(spec: Tolerance, number: Number, read_as: str) -> Verdict:
    if spec.sigfigs is not None:
        return _figures(spec, number, spec.sigfigs, read_as)
    plain = number.form in {"decimal", "integer"}
    if spec.strict and plain and spec.decimals not in {None, number.places}:
        return partial(HALF, read_as, "decimals-asked", asked=spec.decimals)
    return correct(read_as)


def _figures(spec: Tolerance, number: Number, asked: int, read_as: str) -> Verdict:
    least, most = number.figures
    if most < asked:
        return partial(HALF, read_as, "figures-asked", asked=asked, given=most)
    if spec.strict and (least, most) != (asked, asked):
        return partial(HALF, read_as, "figures-unclear", asked=asked)
    return correct(read_as, "more-digits" if 99 > least > asked else "")


def _coarse(
    spec: Tolerance, number: Number, value: Value, key: Value, read_as: str
) -> Verdict | None:
    """Right value with too few digits: rounded correctly, but not as far as asked."""
    if not number.places or number.figures[1] < 2 or number.form != "decimal":
        return None
    if abs(value - key) * 2 * 10**number.places > 1:
        return None
    if spec.exact:
        return wrong(read_as, "exact-wanted")
    if spec.decimals is not None and number.places < spec.decimals:
        return partial(HALF, read_as, "decimals-asked", asked=spec.decimals)
    if spec.sigfigs is not None and number.figures[1] < spec.sigfigs:
        return partial(HALF, read_as, "figures-asked", asked=spec.sigfigs, given=number.figures[1])
    return None
