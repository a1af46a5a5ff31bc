"""Data that an author's ``data.py`` draws: numbers, lists, tables and text, made exact.

The file stands next to the template and runs only in a trusted bank, as solvers do.
"""

from __future__ import annotations

import numbers
from collections.abc import Iterator, Mapping
from decimal import Decimal
from types import ModuleType
from typing import TYPE_CHECKING, Any

import msgspec
from flint import fmpq

from quizgen.bank.drawn_lists import (
    MOST_VALUES,
    RationalList,
    is_number,
    number_texts,
    round_float,
)
from quizgen.bank.frozen_random import FrozenGenerator
from quizgen.bank.rules import DataRule
from quizgen.bank.solvers import author_error_context
from quizgen.core.errors import BankError
from quizgen.maths.numbers import to_rational
from quizgen.maths.values import NumberList

if TYPE_CHECKING:
    from pathlib import Path

MOST_SHOWN = 6
"""Decimals that a float may have without being taken for one that nobody rounded."""
LONGEST_TEXT = 2000


class DrawnData(msgspec.Struct, frozen=True):
    """What one run of ``data.py`` gave, by name."""

    numbers: dict[str, fmpq]
    lists: dict[str, RationalList]
    texts: dict[str, str]


def draw_data(
    module: ModuleType, file: Path, rules: Mapping[str, DataRule], key: str
) -> DrawnData | None:
    """Return what ``data.py`` draws; None if it asks for another try.

    Parameters
    ----------
    module : module
        With ``draw(rng)``.
    file : pathlib.Path
        Where it stands, for errors.
    rules : mapping of str to DataRule
        What ``[data]`` says is drawn.
    key : str
        What the numbers are a function of.

    Raises
    ------
    BankError
        Naming file and line, if it fails or gives something else.
    """
    run = getattr(module, "draw", None)
    if not callable(run):
        raise BankError("there is no draw(rng) in it", rule="QG137", file=file)
    with author_error_context(file):
        given = run(FrozenGenerator(key))
    if given is None:
        return None
    line = getattr(getattr(run, "__code__", None), "co_firstlineno", 0)
    try:
        return _convert_data(given, rules)
    except BankError as error:
        error.file, error.line = file, line
        raise


def _convert_data(given: object, rules: Mapping[str, DataRule]) -> DrawnData:
    """Return what ``draw(rng)`` gave as exact values, sorted into numbers, lists and texts.

    Raises ``BankError`` if it is no dict, or if its names are not those that ``[data]`` lists.
    """
    if not isinstance(given, Mapping):
        raise BankError("draw(rng) gives no dict", rule="QG133")
    found = DrawnData({}, {}, {})
    for name, value in _iter_flat(given):
        if name not in rules:
            raise BankError(f"draw(rng) gives {name!r}, which [data] does not list", rule="QG123")
        _add_value(found, name, value, rules[name])
    texts = {name.partition("[")[0] for name in found.texts}
    lacking = sorted({*rules} - {*found.numbers, *found.lists, *texts})
    if lacking:
        raise BankError(f"draw(rng) does not give {lacking}, listed in [data]", rule="QG123")
    return found


def _iter_flat(given: Mapping[Any, Any]) -> Iterator[tuple[str, Any]]:
    """Yield each quantity; a table is its columns, which are of one length."""
    for name, value in given.items():
        if not isinstance(value, Mapping):
            yield str(name), _to_plain(value)
            continue
        columns = {str(head): _to_plain(column) for head, column in value.items()}
        lengths = {len(c) if isinstance(c, list | tuple) else -1 for c in columns.values()}
        if len(lengths) != 1 or -1 in lengths:
            what = f"the columns of table {name!r} are no lists of one length"
            raise BankError(what, rule="QG133")
        yield from columns.items()


def _to_plain(value: Any) -> Any:
    """Return NumPy's arrays and numbers as Python's own."""
    return value.tolist() if hasattr(value, "tolist") else value


def _add_value(found: DrawnData, name: str, value: Any, rule: DataRule) -> None:
    """Add one value of ``draw(rng)``, exact, to the numbers, the lists or the texts.

    A text that reads as a number is one. Raises ``BankError`` for a list or a text that is too
    long.
    """
    if isinstance(value, list | tuple):
        if not 1 <= len(value) <= MOST_VALUES:
            what = f"{name}: a list of {len(value)} values (allowed: 1 to {MOST_VALUES})"
            raise BankError(what, rule="QG133")
        if all(isinstance(one, str) and not is_number(one) for one in map(_to_plain, value)):
            found.texts.update(number_texts(name, value))
            return
        found.lists[name] = NumberList(_convert_number(name, _to_plain(one), rule) for one in value)
    elif isinstance(value, str) and not is_number(value):
        if len(value) > LONGEST_TEXT:
            raise BankError(f"{name}: a text of more than {LONGEST_TEXT} letters", rule="QG133")
        found.texts[name] = value
    else:
        found.numbers[name] = _convert_number(name, value, rule)


def _convert_number(name: str, value: Any, rule: DataRule) -> fmpq:
    """Return the exact rational that is shown."""
    if isinstance(value, bool) or not isinstance(value, numbers.Number | str | Decimal):
        raise BankError(f"{name}: {value!r} is no number", rule="QG133")
    try:
        exact = to_rational(repr(value) if isinstance(value, float) else str(value))
    except ValueError as error:
        raise BankError(f"{name}: {value!r} is no number", rule="QG133") from error
    if rule.decimals is not None:
        return round_float(exact, rule.decimals)
    if isinstance(value, float) and round_float(exact, MOST_SHOWN) != exact:
        what = (
            f"{name}: {value!r} is not rounded: round it in draw(rng), or state "
            f"[data] {name} = {{ decimals = 1 }}"
        )
        raise BankError(what, rule="QG133")
    return exact
