"""What stands in ``template.toml``, as types: what to draw, what to keep, what is asked."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal

import msgspec

from quizgen.bank.levels import DerivedLevel
from quizgen.maths.numbers import parse_written_number

PART_LABELS = "abcdefghij"
"""Labels of the parts of a question; a sole part has none."""
Scalar = int | float | str
Source = Scalar | tuple[Scalar | tuple[Scalar, ...], ...]
"""What a figure's parameter is made of: a number, a formula or a phrase, a list or a table."""


class DrawRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """How one quantity is drawn.

    Exactly one of ``pick`` (a list), ``range`` (first, last, step), ``words`` (names of phrases
    in the language files), ``is`` (a formula over quantities drawn before), ``values`` (a list
    as it stands), ``normal`` (mean, standard deviation), ``sample`` (some of these values, none
    twice), ``permutation`` (all of them in another order), ``table`` (a column of a file beside
    the template) and ``of`` (a table of values by key, a list or a file, looked up ``at`` a
    phrase or a place counted from 1) is given. With ``by`` (a formula counting from 0) a phrase
    is not drawn but follows from numbers.
    """

    unit: str = ""
    pick: tuple[Scalar, ...] = ()
    range: tuple[Scalar, ...] = ()
    skip: tuple[Scalar, ...] = ()
    words: tuple[str, ...] = ()
    by: str = ""
    formula: str = msgspec.field(name="is", default="")
    values: tuple[Scalar, ...] = ()
    normal: tuple[Scalar, ...] = ()
    sample: tuple[Scalar, ...] = ()
    permutation: tuple[Scalar, ...] = ()
    size: int | str | None = None
    decimals: int | None = None
    table: str = ""
    column: str = ""
    take: int | None = None
    of: str | dict[str, Scalar] = ""
    at: str = ""


WAYS = ("pick", "range", "words", "formula", "values", "normal", "sample", "permutation",
        "table", "of")  # fmt: skip
"""How a quantity can be drawn: exactly one of them."""
LISTED = frozenset({"values", "normal", "sample", "permutation", "table"})
"""Ways that give a list."""


def get_draw_way(rule: DrawRule) -> str:
    """Return which way a quantity is drawn in; empty if the rule names none, or several."""
    ways = [way for way in WAYS if getattr(rule, way)]
    return ways[0] if len(ways) == 1 else ""


class DataRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A quantity that ``data.py`` gives: its unit, and the decimals it is rounded to."""

    unit: str = ""
    decimals: int | None = None


class KeepRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Which values of a solved quantity are kept, in the unit it is shown in."""

    min: Scalar | None = None
    max: Scalar | None = None
    multiple: Scalar | None = None
    decimals: int | None = None
    denominator: int | None = None
    skip: tuple[Scalar, ...] = ()


class FigureRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The figure and the formulas of its parameters.

    Without a ``name`` it is the ``figure.py`` beside the template. ``reads`` are drawn quantities
    whose numbers stand in it, in a quiz too: levels may ask for steps that begin with them, as with
    numbers of the text.
    """

    name: str = ""
    values: dict[str, Source] = {}
    quiz: bool = True
    reads: tuple[str, ...] = ()


class ExampleRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """An answer that ``check.py`` must judge, and the points that it earns."""

    answer: str
    points: Scalar


class PartRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One sub-question: its marks and its answer."""

    answer: dict[str, Any]
    points: Scalar = 1
    show: tuple[str, ...] | None = None
    scheme: dict[str, Scalar] = {}
    example: tuple[ExampleRule, ...] = ()


class ClaimRule(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A statement of a pool: what makes it true, and where that is to be found."""

    true: bool | str
    source: str = ""


class Rules(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The whole of ``template.toml``."""

    topic: str
    tier: Literal["A", "B", "C", "D"]
    part: tuple[PartRule, ...]
    version: int = 1
    formerly: str = ""
    minutes: int | None = None
    solver: str = ""
    covers: tuple[str, ...] = ()
    verbs: dict[str, str] = {}
    draw: dict[str, DrawRule] = {}
    data: dict[str, DataRule] = {}
    files: dict[str, tuple[str, ...]] = {}
    claims: dict[str, bool | str | ClaimRule] = {}
    keep: dict[str, KeepRule] = {}
    where: tuple[str, ...] = ()
    may_vanish: tuple[str, ...] = ()
    drop: tuple[str, ...] = ()
    figure: FigureRule | None = None
    reference: dict[str, Scalar] | None = None
    pool: int | None = None
    apart: tuple[str, ...] = ()
    beyond: bool = False
    precision: tuple[str, ...] = ()
    levels: tuple[DerivedLevel, ...] = ("guided", "transfer")
    ignore: tuple[str, ...] = ()


def get_claim(rules: Rules, name: str) -> ClaimRule:
    """Return a claim of the pool; a truth or a condition alone is one without a source."""
    claim = rules.claims[name]
    return claim if isinstance(claim, ClaimRule) else ClaimRule(claim)


def part_points(rules: Rules) -> dict[str, float]:
    """Return what each part is worth, by its label; the label of a sole part is empty."""
    labels = PART_LABELS if len(rules.part) > 1 else ("",)
    return {
        label: float(parse_written_number(part.points))
        for label, part in zip(labels, rules.part, strict=False)
    }


def total_points(rules: Rules) -> Fraction:
    """Return the marks of all parts of a template."""
    return sum((parse_written_number(part.points) for part in rules.part), Fraction(0))
