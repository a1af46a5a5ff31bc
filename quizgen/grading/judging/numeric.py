"""Judging one number against a key: value, then traps, then precision and form."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import msgspec
from flint import fmpq
from msgspec.structs import replace

from quizgen.grading.diagnosis.carry_forward import NumberDiagnosis
from quizgen.grading.diagnosis.numeric_slips import agrees_within_half_percent, find_generic_slip
from quizgen.grading.reading.literals import Ambiguity
from quizgen.grading.reading.numbers import Readings, ReadNumber
from quizgen.grading.rounding import round_ball_half_away
from quizgen.grading.spec import matches_misconception
from quizgen.grading.verdict import (
    CORRECT,
    FULL,
    HALF,
    Verdict,
    ambiguous,
    correct,
    partial,
    wrong,
)
from quizgen.maths.numbers import decimal_exponent
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.values import Value

NumberJudge = Callable[[ReadNumber], Verdict]


def judge_readings(
    readings: Readings,
    judge: NumberJudge,
    places_asked: int | None = None,
    *,
    whole: bool = False,
) -> Verdict:
    """Return the verdict on a number that may have two readings.

    It is ``ambiguous``, and asked back, when the readings would be marked differently. The decimal
    reading of the learner's own decimal sign may count when it is right; a reading with thousands
    groups counts only when the learner declared the other sign, or where no decimal can be meant.

    Parameters
    ----------
    readings : Readings
    judge : callable
        From one reading to its verdict.
    places_asked : int, optional
        Decimals that the question asks for: with three, ``1.234`` is meant as a decimal.
    whole : bool
        Whether things are counted that have no fractions (bytes, pixels).
    """
    verdict = judge(readings.main)
    if readings.other is None or readings.doubt is None:
        return verdict
    if readings.doubt.native and (places_asked == 3 or verdict.credit):
        return verdict
    other = judge(readings.other)
    if whole and are_groups_meant(verdict, other):
        return other
    return choose_reading(
        verdict, other, readings.doubt, (readings.main.read_as, readings.other.read_as)
    )


def are_groups_meant(decimal: Verdict, groups: Verdict) -> bool:
    """Whether a number of things that have no fractions was typed with thousands groups.

    Only where that reading says more: it earns something, or is a known mistake and the decimal
    one is none. ``2.667`` for 24 pixels is a mistake and not 2667.
    """
    traps = [one.note.startswith("trap:") for one in (decimal, groups)]
    return bool(groups.credit) or traps == [False, True]


def best_verdict(verdicts: Iterable[Verdict]) -> Verdict:
    """Return the verdict with most credit; of equal ones the last.

    Students end a line with the form they believe in (``x = 20/3 = 6.67``), so of equal verdicts
    the last one counts: its note is about what they meant to hand in.

    Raises
    ------
    ValueError
        If there is none.
    """
    *before, chosen = verdicts
    for verdict in reversed(before):
        chosen = verdict if verdict.credit > chosen.credit else chosen
    return chosen


def choose_reading(
    first: Verdict, second: Verdict, doubt: Ambiguity, echoes: tuple[str, str]
) -> Verdict:
    """Return the verdict of one of two readings, or an ``ambiguous`` one that asks back.

    Parameters
    ----------
    first, second : Verdict
        Of the decimal reading, and of that with thousands groups.
    doubt : Ambiguity
        Why there are two.
    echoes : (str, str)
        Both readings as they are shown to the learner.
    """
    if doubt.group_wins and not first.credit:
        return second
    if not (first.credit or second.credit):
        return first
    first_echo, second_echo = echoes
    return ambiguous(
        "two-readings", " | ".join(echoes), first=first_echo, second=second_echo, mark=doubt.mark
    )


class NumberTarget(msgspec.Struct, frozen=True):
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
    hints : NumberDiagnosis, optional
        The question around: errors carried forward, slips in its chain.
    ratio : bool
        Whether it is a plain ratio, which can be upside down.
    """

    spec: Tolerance
    key: Value
    traps: Sequence[tuple[str, Value]] = ()
    form: str = ""
    hints: NumberDiagnosis | None = None
    ratio: bool = False


def judge_value(
    asked: NumberTarget, number: ReadNumber, value: Value, read_as: str = ""
) -> Verdict:
    """Return the verdict on a value that stands in the key's unit.

    The order matters: what is right comes before a known mistake, an error carried forward before
    a misconception, and a guess at a slip last. Of a mistake that is the same number once both are
    rounded as typed nothing can be known: then the key was rounded too far.

    Parameters
    ----------
    asked : NumberTarget
    number : ReadNumber
        How it was written: its form, decimals and significant figures.
    value : Value
        What is judged, in the unit of ``asked.key``.
    read_as : str
        What to echo; that of ``number`` if empty.
    """
    read_as = read_as or number.read_as
    if asked.spec.accepts(value, asked.key) or _is_near_printed(
        asked.spec, number, value, asked.key
    ):
        verdict = _judge_number_form(asked.spec, number, asked.form, read_as)
        return _forgive_closing_zeros(asked, number, value, verdict)
    if is_integer_written_as_decimal(asked.spec, number, value, asked.key):
        return correct(read_as, "whole-number")
    carried = asked.hints.carried_forward(value) if asked.hints else None
    if carried is not None:
        return replace(carried, read_as=read_as)
    trap = matching_misconception(asked.spec, number, value, asked.traps, asked.key)
    coarse = _judge_coarse_rounding(asked.spec, number, value, asked.key, read_as)
    if trap and not (coarse and coarse.credit and value != dict(asked.traps)[trap]):
        return wrong(read_as, f"trap:{trap}")
    return coarse or _diagnose_wrong_value(asked, number, value, read_as)


def _forgive_closing_zeros(
    asked: NumberTarget, number: ReadNumber, value: Value, verdict: Verdict
) -> Verdict:
    """Return full points, with the same remark, where only noughts at the end are missing.

    0.149 is 0.1490, rounded to four figures; a strict tolerance asks for the nought.
    """
    figures = asked.spec.sigfigs
    if verdict.note != "figures-asked" or figures is None or asked.spec.strict:
        return verdict
    rounded = round_ball_half_away(asked.key, figures - 1 - decimal_exponent(asked.key))
    is_decimal = number.form in {"decimal", "scientific"}
    same = is_decimal and bool(value == rounded)
    return replace(verdict, verdict=CORRECT, credit=FULL) if same else verdict


def _is_near_printed(spec: Tolerance, number: ReadNumber, value: Value, key: Value) -> bool:
    """Whether a value is one unit of the last asked decimal from the key as it is printed.

    22.6199 is printed as 22.6: then 22.5 is as near to it as 22.7.
    """
    if spec.decimals is None or spec.within != 1 or number.places != spec.decimals:
        return False
    printed = round_ball_half_away(key, spec.decimals)
    return bool(abs(value - printed) * 10**spec.decimals <= 1)


def _diagnose_wrong_value(
    asked: NumberTarget, number: ReadNumber, value: Value, read_as: str
) -> Verdict:
    """Return a wrong or half right verdict whose note names the slip, if one explains the value."""
    if value != 0 and agrees_within_half_percent(-value, asked.key):
        return wrong(read_as, "sign")
    diagnosed = asked.hints.find_slip(value) if asked.hints else None
    if diagnosed is not None:
        return replace(diagnosed, read_as=read_as)
    operators = asked.hints.operators() if asked.hints else frozenset[str]()
    note, fields = find_generic_slip(
        number, value, asked.key, ratio=asked.ratio, operators=operators
    )
    return wrong(read_as, note, **fields)


def is_integer_written_as_decimal(
    spec: Tolerance, number: ReadNumber, value: Value, key: Value
) -> bool:
    """Return whether an exact whole number was given as a decimal within 0.01 of it."""
    if not spec.exact or number.form != "decimal" or not isinstance(key, fmpq):
        return False
    return bool(key.q == 1 and key != 0 and abs(value - key) <= fmpq(1, 100))


def matching_misconception(
    spec: Tolerance,
    number: ReadNumber,
    value: Value,
    traps: Iterable[tuple[str, Value]],
    key: Value,
) -> str:
    """Return the name of the nearest known mistake that gives the value, or an empty text.

    A mistake that leaves the key as it is (in one cell of a table) explains nothing.
    """
    hits = [
        (abs(value - trap), name)
        for name, trap in traps
        if matches_misconception(spec, number, value, trap) and not spec.is_within(trap, key)
    ]
    if not hits:
        return ""
    nearest = hits[0]
    for hit in hits[1:]:
        if hit[0] < nearest[0]:
            nearest = hit
    return nearest[1]


def _judge_number_form(spec: Tolerance, number: ReadNumber, form: str, read_as: str) -> Verdict:
    """Return the verdict on a right value: half the credit in another form than was asked."""
    if form in {"fraction", "lowest"} and number.form not in {"fraction", "mixed", "integer"}:
        return partial(HALF, read_as, "form-fraction")
    if form == "lowest" and not number.lowest:
        return partial(HALF, read_as, "form-lowest")
    if form == "decimal" and number.form in {"fraction", "mixed", "expression"}:
        return partial(HALF, read_as, "form-decimal")
    return _judge_precision(spec, number, read_as)


def _judge_precision(spec: Tolerance, number: ReadNumber, read_as: str) -> Verdict:
    """Return the verdict on a right value in a right form: half the credit for other decimals.

    Decimals count only under a strict tolerance, and not for fractions.
    """
    if spec.sigfigs is not None:
        return _judge_significant_figures(spec, number, spec.sigfigs, read_as)
    plain = number.form in {"decimal", "integer"}
    if spec.strict and plain and spec.decimals not in {None, number.places}:
        return partial(HALF, read_as, "decimals-asked", asked=spec.decimals)
    return correct(read_as)


def _judge_significant_figures(
    spec: Tolerance, number: ReadNumber, asked: int, read_as: str
) -> Verdict:
    """Return the verdict on a right value by its significant figures.

    Zeros at the end of a whole number may count or not, so figures are a range: too few even if
    they all count costs half, and so does a doubtful number under a strict tolerance.
    """
    least, most = number.figures
    if most < asked:
        return partial(HALF, read_as, "figures-asked", asked=asked, given=most)
    if spec.strict and (least, most) != (asked, asked):
        return partial(HALF, read_as, "figures-unclear", asked=asked)
    return correct(read_as, "more-digits" if 99 > least > asked else "")


def _judge_coarse_rounding(
    spec: Tolerance, number: ReadNumber, value: Value, key: Value, read_as: str
) -> Verdict | None:
    """Return the verdict on a key rounded rightly but not as far as asked; None if it is not.

    Two figures are at least half; one says too little, and is no mistake of method.
    """
    if number.form not in {"decimal", "integer", "scientific"} or value == 0 or key == 0:
        return None
    figures = _count_right_figures(number, value, key)
    if figures < LEAST_FIGURES and not (figures and agrees_within_half_percent(value, key)):
        one = figures and not spec.exact
        return wrong(read_as, "rounded-to-one") if one else None
    if spec.exact:
        rounded = number.form == "decimal" and not (isinstance(key, fmpq) and key.q == 1)
        return partial(HALF, read_as, "exact-wanted") if rounded else None
    place = abs(value / number.value) * fmpq(10) ** (decimal_exponent(number.value) - figures + 1)
    return _ask_for_more_digits(spec, figures, place, read_as)


def _ask_for_more_digits(
    spec: Tolerance, figures: int, place: Value, read_as: str
) -> Verdict | None:
    """Return half for a rounding coarser than what was asked; None if it is not."""
    if spec.decimals is not None:
        note = "decimals-asked" if spec.decimals else "rounded-far"
        coarser = place * 10**spec.decimals > 1
        return partial(HALF, read_as, note, asked=spec.decimals) if coarser else None
    if spec.sigfigs is None:
        return partial(HALF, read_as, "rounded-far")
    fields = {"asked": spec.sigfigs, "given": figures}
    return partial(HALF, read_as, "figures-asked", **fields) if figures < spec.sigfigs else None


LEAST_FIGURES = 2
"""Significant figures that show a value to be the key, rounded."""


def _count_right_figures(number: ReadNumber, value: Value, key: Value) -> int:
    """Return the most figures the spelling can mean to which the key is rounded."""
    least, most = number.figures
    leading = decimal_exponent(number.value)
    scale = abs(value / number.value)
    for figures in range(most, least - 1, -1):
        place = scale * fmpq(10) ** (leading - figures + 1)
        if abs(value - key) * 2 <= place:
            return figures
    return 0
