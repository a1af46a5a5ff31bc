"""What an authored answer may name: a table of keys for each kind, as it stands in a template.

Formulas are not read here, and sentences stand elsewhere: these are the shapes alone.
"""

from __future__ import annotations

from typing import Any, ClassVar, Literal, TypeAlias, get_args

import msgspec

from quizgen.bank.most import MOST_OPTIONS
from quizgen.maths.constants import Scalar
from quizgen.maths.tolerance import Tolerance

Condition: TypeAlias = bool | str
Formulas: TypeAlias = tuple[Scalar, Scalar]
Domain: TypeAlias = Literal["real", "positive"] | tuple[Scalar, Scalar]


class Answer(msgspec.Struct, kw_only=True, frozen=True, forbid_unknown_fields=True,
             tag_field="kind"):  # fmt: skip
    """The key of every kind: the quantities that are asked."""

    of: str | tuple[str, ...] | dict[str, str] = ()


class Measured(Tolerance, kw_only=True, frozen=True, tag_field="kind"):
    """The same, and how near an answer must be."""

    of: str | tuple[str, ...] | dict[str, str] = ()
    accept: tuple[Scalar, Scalar] | None = None  # type: ignore[assignment]


class Numeric(Measured, kw_only=True, frozen=True):
    """What is computed: one quantity at least, and as many as its kind has."""

    of: str | tuple[str, ...] | dict[str, str]
    least: ClassVar[int] = 1
    most: ClassVar[int] = 1


class Number(Numeric, tag="number", frozen=True):
    """A number without a unit, a share, a count."""

    form: Literal["", "fraction", "lowest", "decimal"] = ""
    percent: bool = False
    unit: str = ""
    notation: Literal["", "f-number"] = ""
    counts: str | tuple[str, ...] = ()


class Quantity(Numeric, tag="quantity", frozen=True):
    """A number with its unit."""

    unit: str = ""
    bare: bool = False


class Angle(Numeric, tag="angle", frozen=True):
    """An angle in degrees."""

    period: Scalar = 360


class Point(Numeric, tag="point", frozen=True):
    """Coordinates."""

    least, most = 2, MOST_OPTIONS
    names: tuple[str, ...] = ()
    unit: str = ""
    counts: str | tuple[str, ...] = ()
    up_to_scale: bool = False


class Set(Numeric, tag="set", frozen=True):
    """Numbers in any order."""

    most = MOST_OPTIONS
    unit: str = ""


class Table(Numeric, tag="table", frozen=True):
    """Numbers by their labels."""

    least, most = 2, MOST_OPTIONS
    counts: dict[str, str | tuple[str, ...]] = msgspec.field(default_factory=dict)
    cells: dict[str, dict[str, bool | Scalar]] = msgspec.field(default_factory=dict)


class Interval(Measured, kw_only=True, tag="interval", frozen=True):
    """From one number to another."""

    value: str
    traps: dict[str, str] = msgspec.field(default_factory=dict)


class Expression(Answer, kw_only=True, tag="expression", frozen=True):
    """A formula."""

    value: str
    symbols: dict[str, Domain]
    traps: dict[str, str] = {}


class Pooled(Answer, frozen=True):
    """What may be asked in part, a different one in every draw."""

    take: int = 0


class Choice(Pooled, kw_only=True, tag="choice", frozen=True):
    """One of several options."""

    options: dict[str, Condition]
    right: tuple[int, int] | None = None
    in_order: bool = False


class Multi(Choice, tag="multi", frozen=True):
    """Any number of several options."""

    negative: bool = True


class Truth(Answer, tag="tf", frozen=True):
    """A statement that is true or false."""

    true: Condition = True
    claim: str = ""
    source: Literal["claims"] | None = msgspec.field(name="from", default=None)


class Match(Pooled, kw_only=True, tag="match", frozen=True):
    """What belongs together."""

    pairs: dict[str, str]
    distractors: tuple[str, ...] = ()
    extra: int | None = None
    in_order: bool = False
    reuse: bool = False


class Order(Pooled, kw_only=True, tag="order", frozen=True):
    """Steps in their order."""

    steps: tuple[str, ...]
    before: tuple[tuple[str, str], ...] = ()
    distractors: tuple[str, ...] = ()
    extra: int | None = None
    traps: dict[str, tuple[str, ...]] = {}


class Gap(Pooled, kw_only=True, tag="gap", frozen=True):
    """Words that are missing in a text."""

    gaps: tuple[str, ...]
    among: tuple[str, ...] = ()


class Witness(Answer, kw_only=True, tag="witness", frozen=True):
    """Any values that meet a condition."""

    predicate: str
    symbols: dict[str, Domain] | tuple[str, ...]
    where: tuple[str, ...] = ()
    let: dict[str, str] = {}
    example: dict[str, Scalar] = {}


class Code(Answer, kw_only=True, tag="code", frozen=True):
    """What a program prints."""

    output: str
    also: tuple[str, ...] = ()
    traps: dict[str, str] = {}


class Text(Answer, kw_only=True, tag="text", frozen=True):
    """A sentence or two."""

    points: tuple[str, ...]
    needed: int | None = None


class Curve(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A curved line: formulas in ``t``, which runs from the first to the last of ``t``."""

    x: Scalar
    y: Scalar
    t: Formulas


Line: TypeAlias = Curve | list[Formulas]
"""A line: formulas of its points, or a curve."""


class Sketch(Answer, kw_only=True, tag="sketch", frozen=True):
    """Lines to draw in a field with axes."""

    view: tuple[Scalar, Scalar, Scalar, Scalar]
    grid: Formulas
    lines: dict[str, Line]
    features: dict[str, dict[str, Any]]
    tall: Scalar = 0
    cuts: list[Scalar] = []
    given: dict[str, Line] = {}
    bars: bool = False
    marks: dict[str, Formulas] = {}
    axes: tuple[str, str] = ("", "")
    traps: dict[str, dict[str, Scalar]] = {}


AnyAnswer: TypeAlias = (
    Number | Quantity | Angle | Point | Set | Table | Interval | Expression | Choice | Multi
    | Truth | Match | Order | Gap | Witness | Code | Text | Sketch
)  # fmt: skip
ANSWERS: dict[str, type[Answer | Measured]] = {
    str(shape.__struct_config__.tag): shape for shape in get_args(AnyAnswer)
}
"""Kind to what its answer may name."""
