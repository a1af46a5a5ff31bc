"""What a template's rules may hold: numbers that can be read, names, shapes and sizes of lists.

Types alone let through what nobody means (no points, a step of 0, a range of a billion values) or
what would stop a later stage without saying where. Here each such field is one located line.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

import msgspec

from quizgen.bank.drawn_lists import (
    MOST_DECIMALS,
    find_list_problems,
    is_list_rule,
    is_number,
)
from quizgen.bank.rules import LISTED, DrawRule, KeepRule, PartRule, Rules, Source
from quizgen.core.complaints import complaint_of, written_place
from quizgen.core.decoding import convert
from quizgen.core.diagnostics import CODES, can_be_ignored
from quizgen.core.errors import BankError, FormulaError
from quizgen.core.positions import Place
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

_FILE = re.compile(r"[A-Za-z0-9_-]{1,60}\.csv")
LARGEST = 10**100
"""Largest size of an authored number, and of its inverse."""

FieldProblems = Iterator[tuple[Place, str, str]]
"""Where the field stands, the code of what is wrong in it, and the same in words."""


def parse_authored_number(text: Scalar) -> Fraction:
    """Return an authored number, exact.

    Raises
    ------
    ValueError
        If it cannot be read or is larger or smaller than anyone could mean: 10^1000000 would
        fill the memory before any check of a unit or a range sees it.
    """
    value = parse_written_number(text)
    if value and not 1 <= abs(value) * LARGEST <= LARGEST**2:
        raise FormulaError(f"{text!r} is too large or too small")
    return value


def find_problems(rules: Rules) -> FieldProblems:
    """Yield every field of the rules that holds what it cannot."""
    yield from _check_names(rules)
    yield from _check_figure_reads(rules)
    yield from _check_sizes(rules)
    yield from _check_ignored_codes(rules)
    yield from _check_claims(rules)
    for name, rule in rules.draw.items():
        yield from _prefix_places(("draw", name), _check_draw_rule(rule))
    yield from _check_data(rules)
    for name, keep in rules.keep.items():
        yield from _prefix_places(("keep", name), _check_keep_rule(keep))
    for name, value in (rules.reference or {}).items():
        if not rules.draw.get(name) or not rules.draw[name].words:
            yield from _check_numbers_readable(("reference", name), (value,))
    for item in rules.verbs:
        if item not in rules.covers:
            yield ("verbs", item), "QG230", f"{item!r} is not in covers"
    for index, part in enumerate(rules.part):
        yield from _prefix_places(("part", index, "answer"), _check_answer(part.answer))
        yield from _check_between(("part", index, "points"), part.points, MOST_POINTS)
        yield from _prefix_places(("part", index), _check_scheme(part))


def _check_scheme(part: PartRule) -> FieldProblems:
    """Yield points of steps that do not add up to those of their part."""
    if not part.scheme:
        return
    try:
        found = sum(map(parse_written_number, part.scheme.values()), Fraction(0))
        worth = parse_written_number(part.points)
    except ValueError as error:
        yield ("scheme",), "QG260", str(error)
        return
    if found != worth or any(parse_written_number(one) <= 0 for one in part.scheme.values()):
        yield ("scheme",), "QG260", f"the steps earn {found} points, and the part {worth}"


def _prefix_places(place: Place, found: FieldProblems) -> FieldProblems:
    """Yield problems of a table with the table's own place put before theirs."""
    return (((*place, *field), code, what) for field, code, what in found)


def _check_names(rules: Rules) -> FieldProblems:
    """Yield names that cannot be file names; a solver may have folders in front.

    This is also what stops ``../`` in a path. An empty optional name is passed as ``-``, which
    is allowed.
    """
    figure = rules.figure.name if rules.figure else ""
    folders = rules.solver.split("/") if rules.solver else ()
    places: list[tuple[Place, str]] = [(("topic",), rules.topic)]
    places += [(("formerly",), rules.formerly or "-"), (("figure", "name"), figure or "-")]
    places += [(("solver",), folder) for folder in folders]
    places += [(("apart",), name) for name in rules.apart]
    places += [(("covers",), name) for name in rules.covers]
    for place, name in places:
        if not is_identifier(name):
            yield place, "QG108", f"{name!r} is no name (allowed: {NAMES})"


def _check_figure_reads(rules: Rules) -> FieldProblems:
    """Yield names listed under ``reads`` that cannot be read in the figure."""
    place = ("figure", "reads")
    if rules.figure is None or not rules.figure.reads:
        return
    if not rules.figure.quiz:
        yield place, "QG117", "nothing is read in a figure with quiz = false"
    for name in rules.figure.reads:
        if name not in rules.draw or rules.draw[name].words or is_list_rule(rules.draw[name]):
            yield place, "QG117", f"{name!r} is no drawn number (write it under [draw])"


def _check_ignored_codes(rules: Rules) -> FieldProblems:
    """Yield codes that do not exist, and those that cannot be ignored because they stop a paper."""
    for index, code in enumerate(rules.ignore):
        if code not in CODES:
            yield ("ignore", index), "QG119", f"there is no code {code!r}"
        elif not can_be_ignored(code):
            yield ("ignore", index), "QG119", f"{code} cannot be ignored: it stops a paper"


def _check_sizes(rules: Rules) -> FieldProblems:
    """Yield counts and sizes beyond what any question needs; they bound time and memory."""
    if not 1 <= len(rules.part) <= MOST_PARTS:
        yield ("part",), "QG110", f"1 to {MOST_PARTS} tables [[part]] are needed"
    whole = (
        ("minutes", rules.minutes, MOST_MINUTES),
        ("version", rules.version, 10**6),
        ("pool", rules.pool, LARGEST),
    )
    for field, value, most in whole:
        if value is not None and not 1 <= value <= most:
            said = "10^100" if most == LARGEST else most
            yield (field,), "QG109", f"{value} is not between 1 and {said}"
    for field, several in (("draw", rules.draw), ("keep", rules.keep), ("where", rules.where)):
        if len(several) > MOST_FORMULAS:
            yield (field,), "QG110", f"more than {MOST_FORMULAS} entries"
    for name, source in (rules.figure.values if rules.figure else {}).items():
        if _count_entries(source) > MOST_CHOICES:
            yield ("figure", "values", name), "QG110", f"more than {MOST_CHOICES} entries"


def _count_entries(source: Source) -> int:
    """Return how many values nested lists hold in all."""
    return sum(map(_count_entries, source)) if isinstance(source, tuple) else 1


def _check_draw_rule(rule: DrawRule) -> FieldProblems:
    """Yield what is wrong with one draw rule: too many entries, unreadable numbers, its range."""
    yield from (((field,), code, what) for field, code, what in find_list_problems(rule))
    for field in ("pick", "range", "skip", "words", "values", "sample", "permutation", "of"):
        if len(getattr(rule, field)) > MOST_CHOICES:
            yield (field,), "QG110", f"more than {MOST_CHOICES} entries"
    fields = ("pick", "range", "skip", "values", "sample", "permutation")
    listed = {field: getattr(rule, field) for field in fields}
    wrong = [
        one
        for field, cells in listed.items()
        if field not in LISTED or any(map(is_number, cells))  # else it is a list of texts
        for one in _check_numbers_readable((field,), cells)
    ]
    yield from wrong
    if rule.range and not wrong:
        yield from _check_range(*rule.range)


def _check_data(rules: Rules) -> FieldProblems:
    """Yield what is wrong in what ``[data]`` and ``[files]`` say of quantities."""
    if len(rules.data) > MOST_FORMULAS:
        yield ("data",), "QG110", f"more than {MOST_FORMULAS} entries"
    for name, rule in rules.data.items():
        if name in rules.draw:
            yield ("data", name), "QG118", f"{name!r} stands under [draw], too"
        if not 0 <= (rule.decimals or 0) <= MOST_DECIMALS:
            yield ("data", name, "decimals"), "QG109", f"must be 0 to {MOST_DECIMALS}"
    for file, names in rules.files.items():
        if not _FILE.fullmatch(file) or not names:
            what = f"{file!r} is no file of letters, digits, - and _ that ends in .csv"
            yield ("files", file), "QG108", what
        for name in names:
            if name not in rules.data and name not in rules.draw:
                yield ("files", file), "QG116", f"{name!r} is not drawn"


def _check_range(*span: Scalar) -> FieldProblems:
    """Yield what is wrong with ``[first, last, step]``.

    It is counted and not listed: a range of a tiny step would otherwise fill the memory.
    """
    place = ("range",)
    if len(span) != len(("first", "last", "step")):
        yield place, "QG111", "is [first, last, step]"
        return
    first, last, step = map(parse_authored_number, span)
    if step == 0 or (last - first) / step < 0:
        yield place, "QG111", "the step does not lead from the first to the last value"
    elif (last - first) / step >= MOST_CHOICES:
        yield place, "QG110", f"more than {MOST_CHOICES} values"


def _check_keep_rule(rule: KeepRule) -> FieldProblems:
    """Yield what is wrong with the limits of one keep rule."""
    for field in ("min", "max", "multiple"):
        yield from _check_numbers_readable(
            (field,), [v for v in (getattr(rule, field),) if v is not None]
        )
    yield from _check_numbers_readable(("skip",), rule.skip)
    if (
        rule.multiple is not None
        and not list(_check_numbers_readable((), [rule.multiple]))
        and not parse_authored_number(rule.multiple)
    ):
        yield ("multiple",), "QG109", "of 0 is only 0"
    if not 0 <= (rule.decimals or 0) <= MOST_DIGITS:
        yield ("decimals",), "QG109", f"must be 0 to {MOST_DIGITS}"
    if rule.denominator is not None and rule.denominator < 1:
        yield ("denominator",), "QG109", "must be 1 or more"


def _check_numbers_readable(place: Place, values: Iterable[Scalar]) -> FieldProblems:
    """Yield the numbers that ``parse_authored_number`` refuses."""
    for value in values:
        try:
            parse_authored_number(value)
        except ValueError as error:
            yield place, "QG109", str(error)


def _check_between(place: Place, value: Scalar, most: int) -> FieldProblems:
    """Yield a number that is not above 0 and at most ``most``, or cannot be read."""
    wrong = list(_check_numbers_readable(place, (value,)))
    yield from wrong
    if not wrong and not 0 < parse_authored_number(value) <= most:
        yield place, "QG109", f"{value} is not more than 0 and at most {most}"


def find_malformed_answers(rules: Rules) -> Iterator[BankError]:
    """Yield answers of no kind, and those with keys or types that their kind does not have.

    They come first: ``find_problems`` converts answers and relies on their shape.
    """
    for index, part in enumerate(rules.part):
        kind, place = part.answer.get("kind", ""), ("part", index, "answer")
        said = written_place(place)
        if "kind" not in part.answer:
            yield BankError(f"{said}: the key 'kind' is missing", rule="QG105", place=place)
        elif not isinstance(kind, str) or kind not in KINDS:
            what = f"part {index + 1}: unknown kind {kind!r} (allowed: {', '.join(sorted(KINDS))})"
            yield BankError(what, rule="QG107", place=(*place, "kind"))
        else:
            try:
                convert(part.answer, KINDS[kind].authored)
            except msgspec.ValidationError as error:
                yield complaint_of(error, KINDS[kind].authored, part.answer, place)


def _check_answer(table: Mapping[str, object]) -> FieldProblems:
    """Yield the problems that the answer's own kind finds in it."""
    yield from convert(table, KINDS[str(table["kind"])].authored).find_problems()


def _check_claims(rules: Rules) -> FieldProblems:
    """Yield what is wrong with the pool of claims: too few, too many, or used by no part."""
    taking = [part.answer for part in rules.part if "from" in part.answer]
    if len(taking) > len(rules.claims):
        yield ("claims",), "QG115", f"{len(rules.claims)} are too few for {len(taking)} parts"
    if rules.claims and not taking:
        yield ("claims",), "QG115", 'no part has from = "claims"'
    if len(rules.claims) > MOST_FORMULAS:
        yield ("claims",), "QG110", f"more than {MOST_FORMULAS} entries"
