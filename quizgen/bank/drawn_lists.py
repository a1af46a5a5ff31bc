"""Lists that ``[draw]`` draws without Python, and values looked up in tables."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeAlias

import msgspec
from flint import fmpq

from quizgen.bank.frozen_random import FrozenGenerator
from quizgen.bank.rules import LISTED, DrawRule, Rules, Scalar, get_draw_way
from quizgen.core.errors import BankError, FormulaError
from quizgen.core.untrusted import parse_csv, parse_json, read_text
from quizgen.maths.number_systems import CompiledFormula
from quizgen.maths.numbers import count_decimals, to_float, to_fraction, to_rational

MOST_VALUES = 1000
"""Most values of a drawn list."""
MOST_DECIMALS = 12

RationalList: TypeAlias = tuple[fmpq, ...]
TextList: TypeAlias = tuple[str, ...]


class TableFile(msgspec.Struct, frozen=True):
    """A table next to a template: its columns by name, as text."""

    name: str
    columns: dict[str, tuple[str, ...]]

    @property
    def height(self) -> int:
        """How many rows it has."""
        return len(next(iter(self.columns.values()), ()))

    def get_column(self, name: str) -> tuple[str, ...]:
        """Return a column.

        Raises
        ------
        BankError
            If there is none of this name.
        """
        if name not in self.columns:
            what = f"{self.name} has no column {name!r} (there are {', '.join(self.columns)})"
            raise BankError(what, rule="QG116")
        return self.columns[name]


def is_table_file(name: str) -> bool:
    """Whether a text names a file with a table: ``rates.csv`` or ``rates.json``."""
    return Path(name).suffix in {".csv", ".json"}


def list_table_files(rules: Rules) -> Iterator[str]:
    """Yield the names of the files that ``[draw]`` reads."""
    for rule in rules.draw.values():
        for name in (rule.table, rule.of):
            if isinstance(name, str) and is_table_file(name):
                yield name


def read_table_file(folder: Path, name: str) -> TableFile:
    """Return a template's table: CSV with a head row, or JSON, by columns or by rows.

    Raises
    ------
    BankError
        If there is none, it cannot be read, or its columns differ in length.
    """
    if not is_table_file(name) or Path(name).name != name or name.startswith("."):
        raise BankError(f"{name!r} is no .csv or .json beside the template", rule="QG108")
    file = folder / name
    text = read_text(file, BankError)
    columns = _parse_csv_columns(text, file) if file.suffix == ".csv" else _parse_json(text, file)
    if len({len(column) for column in columns.values()}) != 1:
        raise BankError("the columns differ in length", rule="QG110", file=file)
    return TableFile(name, {head: tuple(map(str, cells)) for head, cells in columns.items()})


def _parse_csv_columns(text: str, file: Path) -> dict[str, Any]:
    """Return the columns of a CSV table by the names in its first row.

    Raises ``BankError`` if it is empty, or if a row has more or fewer cells than the first.
    """
    rows = [cells for _, cells in parse_csv(text, file, BankError) if any(cells)]
    if not rows:
        raise BankError("the table is empty", rule="QG110", file=file)
    head, *body = rows
    if any(len(cells) != len(head) for cells in body):
        raise BankError(f"a row has not {len(head)} cells", rule="QG110", file=file)
    return {name.strip(): [row[place].strip() for row in body] for place, name in enumerate(head)}


def _parse_json(text: str, file: Path) -> dict[str, Any]:
    """Return the columns of a JSON table by name, whichever of three shapes it has.

    These are columns by name, a list of rows, and one value for each key, which becomes the columns
    ``key`` and ``value``. Raises ``BankError`` for anything else.
    """
    found = parse_json(text, file, BankError)
    if isinstance(found, list) and found and all(isinstance(row, dict) for row in found):
        found = {name: [row.get(name, "") for row in found] for name in found[0]}
    if not isinstance(found, dict) or not found:
        what = "is neither columns by name nor a list of rows"
        raise BankError(what, rule="QG111", file=file)
    if all(isinstance(cell, str | int | float) for cell in found.values()):
        return {"key": [*found], "value": [*found.values()]}
    if not all(isinstance(column, list) for column in found.values()):
        raise BankError("a column is no list", rule="QG111", file=file)
    return found


def round_float(value: float | fmpq, decimals: int) -> fmpq:
    """Return a float rounded to decimals, half away from zero, as the exact rational it then is."""
    exact = to_fraction(value) if isinstance(value, fmpq) else Fraction(value)
    scale = 10**decimals
    whole = (abs(exact) * scale + Fraction(1, 2)).__floor__()
    return fmpq(-whole if exact < 0 else whole, scale)


def list_rule_formulas(rule: DrawRule, rules: Rules) -> list[str]:
    """Return the formulas that a rule is made of, over quantities drawn before."""
    found = [rule.formula or rule.by, *map(str, rule.normal)]
    found += [rule.size] if isinstance(rule.size, str) else []
    by_phrase = rule.at in rules.draw and bool(rules.draw[rule.at].words)
    if rule.of:
        found += [] if by_phrase else [rule.at]
        found += [rule.of] if isinstance(rule.of, str) and not is_table_file(rule.of) else []
    return [formula for formula in found if formula]


class ListPlan(msgspec.Struct, frozen=True):
    """How one list is drawn."""

    name: str
    rule: DrawRule
    pool: RationalList | TextList
    formulas: dict[str, CompiledFormula]

    def draw(self, stem: str, attempt: int, env: Mapping[str, Any]) -> RationalList | TextList:
        """Return the values of one try: numbers, or texts if that is what there are.

        Raises
        ------
        BankError
            If more values are wanted than there are.
        """
        rule = self.rule
        if rule.values:
            return self.pool
        if rule.table:
            return self._take_rows(stem, attempt)
        rng = FrozenGenerator(f"{stem}/{self.name}/{attempt}")
        if rule.normal:
            mean, spread = (to_float(self.formulas[str(text)](env)) for text in rule.normal)
            if not spread >= 0:
                raise BankError("the standard deviation is negative", rule="QG120")
            drawn = rng.normal(mean, spread, self._count(env))
            return tuple(round_float(float(value), rule.decimals or 0) for value in drawn)
        order = [int(place) for place in rng.permutation(len(self.pool))]
        count = self._count(env) if rule.sample else len(order)
        if count > len(order):
            raise BankError(f"a sample of {count} out of {len(order)} values", rule="QG110")
        return tuple([self.pool[place] for place in order[:count]])

    def _count(self, env: Mapping[str, Any]) -> int:
        """Return how many values the list has, a number or a formula of values drawn before.

        Raises ``BankError`` unless that is a whole number from 1 to ``MOST_VALUES``.
        """
        size = self.rule.size
        value = fmpq(size) if isinstance(size, int) else self.formulas[str(size)](env)
        if not isinstance(value, fmpq) or value.q != 1 or not 1 <= value <= MOST_VALUES:
            raise BankError(f"size is no whole number from 1 to {MOST_VALUES}", rule="QG109")
        return int(value.p)

    def _take_rows(self, stem: str, attempt: int) -> RationalList | TextList:
        """Return rows of a file, the same for each of its columns that takes as many, in order."""
        take = self.rule.take
        if take is None or take >= len(self.pool):
            return self.pool
        key = f"{stem}/{self.rule.table}/{take}/{attempt}"
        ranked = sorted(
            range(len(self.pool)), key=lambda row: hashlib.sha256(f"{key}/{row}".encode()).digest()
        )
        return tuple([self.pool[row] for row in sorted(ranked[:take])])


def plan_list(
    name: str, rule: DrawRule, folder: Path, compile_formula: Callable[[str], CompiledFormula]
) -> ListPlan:
    """Return how the list of a rule is drawn; its file is read once.

    Raises
    ------
    BankError
        If its file or a value cannot be read.
    """
    cells: tuple[Scalar, ...] = rule.values or rule.sample or rule.permutation
    if rule.table:
        table = read_table_file(folder, rule.table)
        cells = table.get_column(rule.column or name)
        if rule.take is not None and rule.take > table.height:
            what = f"take is {rule.take}, and {rule.table} has {table.height} rows"
            raise BankError(what, rule="QG110")
    formulas = [*map(str, rule.normal), *([rule.size] if isinstance(rule.size, str) else [])]
    pool = _parse_cells(cells)
    return ListPlan(name, rule, pool, {text: compile_formula(text) for text in formulas})


def is_number(cell: Scalar) -> bool:
    """Whether a cell of a table or a list reads as a rational number."""
    try:
        to_rational(str(cell))
    except FormulaError:
        return False
    return True


def number_texts(name: str, texts: Iterable[str]) -> dict[str, str]:
    """Return a list of texts as the phrases ``name[1]``, ``name[2]``, ..., as words name them."""
    return {f"{name}[{place}]": str(text) for place, text in enumerate(texts, 1)}


def _parse_cells(cells: Iterable[Scalar]) -> RationalList | TextList:
    """Return cells as exact numbers; as texts if none is a number.

    Raises ``BankError`` for numbers and texts in one list: one of them is a slip.
    """
    written = tuple(cells)
    if written and not any(map(is_number, written)):
        return tuple(map(str, written))
    return tuple(map(_parse_cell, written))


def _parse_cell(cell: Scalar) -> fmpq:
    """Return the number in a cell, exactly; ``BankError`` if it is none."""
    try:
        return to_rational(str(cell))
    except FormulaError as error:
        raise BankError(str(error), rule="QG109") from None


class LookupPlan(msgspec.Struct, frozen=True):
    """How a value is looked up, by a drawn phrase or by a number."""

    rule: DrawRule
    table: dict[str, fmpq | str]
    place: CompiledFormula | None

    def look_up(self, env: Mapping[str, Any], words: Mapping[str, str]) -> fmpq | str:
        """Return the value, a number or a text.

        Raises
        ------
        BankError
            If there is none of this key.
        """
        if self.place is None or self.rule.at in words:
            key = words[self.rule.at]
        else:
            place = self.place(env)
            if not isinstance(place, fmpq):
                raise BankError("at is no rational number", rule="QG120")
            key = str(place)
        if not self.table:
            listed = f"{self.rule.of}[{key}]"
            return words[listed] if listed in words else self._pick_from_list(key, env)
        if key not in self.table:
            raise BankError(f"of has no value for {key!r}", rule="QG120")
        return self.table[key]

    def _pick_from_list(self, key: str, env: Mapping[str, Any]) -> fmpq:
        """Return the value at a place of a drawn list, the first of which is 1.

        Raises ``BankError`` if there is no such place.
        """
        listed = env.get(str(self.rule.of))
        if not isinstance(listed, tuple) or not key.isdecimal() or not 1 <= int(key) <= len(listed):
            what = f"{self.rule.of} has no place {key} (the first is 1)"
            raise BankError(what, rule="QG120")
        value: fmpq = listed[int(key) - 1]
        return value


def plan_lookup(
    name: str, rule: DrawRule, rules: Rules, folder: Path,
    compile_formula: Callable[[str], CompiledFormula],
) -> LookupPlan:  # fmt: skip
    """Return how a rule's value is looked up; its file is read once.

    Raises
    ------
    BankError
        If its file or a value cannot be read, or ``at`` is missing.
    """
    if not rule.at:
        raise BankError("of needs at: a drawn phrase, or a place counted from 1", rule="QG118")
    by_phrase = rule.at in rules.draw and bool(rules.draw[rule.at].words)
    place = None if by_phrase else compile_formula(rule.at)
    if isinstance(rule.of, dict):
        pairs: dict[str, Scalar] = rule.of
    elif is_table_file(rule.of):
        table = read_table_file(folder, rule.of)
        keys = next(iter(table.columns.values()))
        column = rule.column or (name if name in table.columns else [*table.columns][-1])
        pairs = dict(zip(keys, table.get_column(column), strict=True))
    else:
        pairs = {}
    return LookupPlan(rule, dict(zip(pairs, _parse_cells(pairs.values()), strict=True)), place)


def find_list_problems(rule: DrawRule) -> Iterator[tuple[str, str, str]]:
    """Yield fields of a rule that do not fit each other: field, code, and what is wrong."""
    way = get_draw_way(rule)
    if way == "normal":
        if len(rule.normal) != len(("mean", "spread")):
            yield "normal", "QG111", "is [mean, standard deviation]"
        if rule.decimals is None:
            yield "decimals", "QG118", "normal needs decimals, to which its values are rounded"
    if way in {"normal", "sample"} and rule.size is None:
        yield "size", "QG118", f"{way} needs size: how many values"
    if isinstance(rule.size, int) and not 1 <= rule.size <= MOST_VALUES:
        yield "size", "QG109", f"must be 1 to {MOST_VALUES}"
    if way == "sample" and isinstance(rule.size, int) and rule.size > len(rule.sample):
        yield "size", "QG110", f"a sample of {rule.size} out of {len(rule.sample)} values"
    if rule.take is not None and (way != "table" or rule.take < 1):
        yield "take", "QG118", "belongs to table, and is 1 or more"
    if rule.decimals is not None and not 0 <= rule.decimals <= MOST_DECIMALS:
        yield "decimals", "QG109", f"must be 0 to {MOST_DECIMALS}"


def is_list_rule(rule: DrawRule) -> bool:
    """Whether a rule draws a list."""
    return get_draw_way(rule) in LISTED


def count_common_decimals(values: RationalList) -> int | None:
    """Return how many decimals show every value exactly; None if one has no short form."""
    counts = [count_decimals(value) for value in values]
    return None if None in counts else max((c for c in counts if c is not None), default=0)
