"""What a template's rules may hold: numbers that can be read, names, shapes and sizes of lists.

Types alone let through what nobody means (no points, a step of 0, a range of a billion values) or
what would stop a later stage without saying where. Here each such field is one located line.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

import msgspec

from quizgen.bank.complaints import explain_validation_error
from quizgen.bank.rules import DrawRule, KeepRule, Rules, Source
from quizgen.core.decoding import convert
from quizgen.core.errors import FormulaError
from quizgen.core.untrusted import NAMES, is_identifier
from quizgen.kinds import KINDS
from quizgen.kinds.contract import (
    MOST_CHOICES,
    MOST_FORMULAS,
    MOST_MINUTES,
    MOST_PARTS,
    MOST_POINTS,
)
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import parse_written_number
from quizgen.maths.tolerance import MOST_DIGITS

LARGEST = 10**100
"""Largest size of an authored number, and of its inverse."""

FieldProblems = Iterator[tuple[str, str]]
"""Field and what is wrong in it."""


def parse_authored_number(text: Scalar) -> Fraction:
    """An authored number.

    Raises
    ------
    ValueError
        If it cannot be read or is larger or smaller than anyone could mean.
    """
    value = parse_written_number(text)
    if value and not 1 <= abs(value) * LARGEST <= LARGEST**2:
        raise FormulaError(f"{text!r} is too large or too small")
    return value


def find_problems(rules: Rules) -> FieldProblems:
    """Every field of the rules that holds what it cannot."""
    yield from _check_names(rules)
    yield from _check_figure_reads(rules)
    yield from _check_sizes(rules)
    yield from _check_claims(rules)
    for name, rule in rules.draw.items():
        yield from ((f"draw.{name}.{field}", what) for field, what in _check_draw_rule(rule))
    for name, keep in rules.keep.items():
        yield from ((f"keep.{name}.{field}", what) for field, what in _check_keep_rule(keep))
    for name, value in (rules.reference or {}).items():
        if not rules.draw.get(name) or not rules.draw[name].words:
            yield from _check_numbers_readable(f"reference.{name}", (value,))
    for place, part in enumerate(rules.part, 1):
        yield from ((f"part {place}: {field}", what) for field, what in _check_answer(part.answer))
        yield from _out_of(f"part {place}: points", part.points, MOST_POINTS)


def _check_names(rules: Rules) -> FieldProblems:
    figure = rules.figure.name if rules.figure else ""
    single = {"topic": rules.topic, "formerly": rules.formerly or "-", "figure.name": figure or "-"}
    listed = {"apart": rules.apart, "covers": rules.covers}
    folders = rules.solver.split("/") if rules.solver else ()
    pairs = [*single.items(), *(("solver", folder) for folder in folders)]
    pairs += [(field, name) for field, names in listed.items() for name in names]
    for field, name in pairs:
        if not is_identifier(name):
            yield field, f"{name!r} is no name (allowed: {NAMES})"


def _check_figure_reads(rules: Rules) -> FieldProblems:
    """What is said to be read in the figure, and cannot be."""
    if rules.figure is None or not rules.figure.reads:
        return
    if not rules.figure.quiz:
        yield "figure.reads", "nothing is read in a figure with quiz = false"
    for name in rules.figure.reads:
        if name not in rules.draw or rules.draw[name].words:
            yield "figure.reads", f"{name!r} is no drawn number (write it under [draw])"


def _check_sizes(rules: Rules) -> FieldProblems:
    if not 1 <= len(rules.part) <= MOST_PARTS:
        yield "part", f"1 to {MOST_PARTS} tables [[part]] are needed"
    whole = (
        ("minutes", rules.minutes, MOST_MINUTES),
        ("version", rules.version, 10**6),
        ("pool", rules.pool, LARGEST),
    )
    for field, value, most in whole:
        if value is not None and not 1 <= value <= most:
            yield field, f"{value} is not between 1 and {'10^100' if most == LARGEST else most}"
    for field, several in (("draw", rules.draw), ("keep", rules.keep), ("where", rules.where)):
        if len(several) > MOST_FORMULAS:
            yield field, f"more than {MOST_FORMULAS} entries"
    for name, source in (rules.figure.values if rules.figure else {}).items():
        if _count_entries(source) > MOST_CHOICES:
            yield f"figure.values.{name}", f"more than {MOST_CHOICES} entries"


def _count_entries(source: Source) -> int:
    return sum(map(_count_entries, source)) if isinstance(source, tuple) else 1


def _check_draw_rule(rule: DrawRule) -> FieldProblems:
    for field in ("pick", "range", "skip", "words"):
        if len(getattr(rule, field)) > MOST_CHOICES:
            yield field, f"more than {MOST_CHOICES} entries"
    wrong = [
        (f, what)
        for f in ("pick", "range", "skip")
        for f, what in _check_numbers_readable(f, getattr(rule, f))
    ]
    yield from wrong
    if rule.range and not wrong:
        yield from _check_range(*rule.range)


def _check_range(*span: Scalar) -> FieldProblems:
    if len(span) != len(("first", "last", "step")):
        yield "range", "is [first, last, step]"
        return
    first, last, step = map(parse_authored_number, span)
    if step == 0 or (last - first) / step < 0:
        yield "range", "the step does not lead from the first to the last value"
    elif (last - first) / step >= MOST_CHOICES:
        yield "range", f"more than {MOST_CHOICES} values"


def _check_keep_rule(rule: KeepRule) -> FieldProblems:
    for field in ("min", "max", "multiple"):
        yield from _check_numbers_readable(
            field, [v for v in (getattr(rule, field),) if v is not None]
        )
    yield from _check_numbers_readable("skip", rule.skip)
    if (
        rule.multiple is not None
        and not list(_check_numbers_readable("", [rule.multiple]))
        and not parse_authored_number(rule.multiple)
    ):
        yield "multiple", "of 0 is only 0"
    if not 0 <= (rule.decimals or 0) <= MOST_DIGITS:
        yield "decimals", f"must be 0 to {MOST_DIGITS}"
    if rule.denominator is not None and rule.denominator < 1:
        yield "denominator", "must be 1 or more"


def _check_numbers_readable(field: str, values: Iterable[Scalar]) -> FieldProblems:
    for value in values:
        try:
            parse_authored_number(value)
        except ValueError as error:
            yield field, str(error)


def _out_of(field: str, value: Scalar, most: int) -> FieldProblems:
    wrong = list(_check_numbers_readable(field, (value,)))
    yield from wrong
    if not wrong and not 0 < parse_authored_number(value) <= most:
        yield field, f"{value} is not more than 0 and at most {most}"


def find_malformed_answers(rules: Rules) -> FieldProblems:
    """Answers of no kind, and with keys or types of values that their kind does not have."""
    for place, part in enumerate(rules.part, 1):
        kind = part.answer.get("kind", "")
        if "kind" not in part.answer:
            yield f"part {place}: answer", "the key 'kind' is missing"
        elif not isinstance(kind, str) or kind not in KINDS:
            yield f"part {place}", f"unknown kind {kind!r} (allowed: {', '.join(sorted(KINDS))})"
        else:
            try:
                convert(part.answer, KINDS[kind].authored)
            except msgspec.ValidationError as error:
                yield f"part {place}: answer", explain_validation_error(error, KINDS[kind].authored)


def _check_answer(table: Mapping[str, object]) -> FieldProblems:
    yield from convert(table, KINDS[str(table["kind"])].authored).find_problems()


def _check_claims(rules: Rules) -> FieldProblems:
    taking = [part.answer for part in rules.part if "from" in part.answer]
    if len(taking) > len(rules.claims):
        yield "claims", f"{len(rules.claims)} are too few for {len(taking)} parts"
    if rules.claims and not taking:
        yield "claims", 'no part has from = "claims"'
    if len(rules.claims) > MOST_FORMULAS:
        yield "claims", f"more than {MOST_FORMULAS} entries"
