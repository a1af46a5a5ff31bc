"""What the specifications of all kinds share: their common fields, and writing them as tables."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, Self, TypeVar

import msgspec
from flint import fmpq

from quizgen.core.decoding import convert
from quizgen.core.errors import FormulaError, KeyFileError
from quizgen.grading.diagnosis.numeric_slips import CLOSE
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.labels import AskedNames
from quizgen.grading.reading.numbers import ReadNumber
from quizgen.grading.reading.units import listed_unit
from quizgen.grading.verdict import Verdict
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.tree import Expr
from quizgen.maths.units import UnitRegistry, build_unit_registry
from quizgen.maths.values import Value

MisconceptionNotes = dict[str, dict[str, str]]
"""Language to sentences by trap name."""


SpecTable = Mapping[str, object]
"""A specification as a key stores it."""

WIDEST = fmpq(1, 20)
"""Share of a mistake's value beyond which a number is no longer called by its name."""

SpecType = TypeVar("SpecType", bound="WordSpec | NumericSpec")


class SpecBase:
    """What judging needs of a specification, whichever kind it is of.

    A kind's ``Spec`` is a struct whose fields are what a key stores; see ``WordSpec`` and
    ``NumericSpec``.
    """

    __slots__ = ()
    of: list[str] | dict[str, str]
    written_as: ClassVar[AnswerForm] = "verbatim"
    """What an answer is made of, which says what may be dropped around it."""
    may_be_range: ClassVar[bool] = False
    """Whether ``from 5 to 10`` can be two of its values: cells of a table, no coordinates."""

    def quantities(self) -> list[str]:
        """Return the names of the chain's quantities, in the order of the values."""
        return list(self.of.values()) if isinstance(self.of, dict) else self.of

    def value_names(self) -> AskedNames:
        """Return names that values may be labelled with, in the order of the values."""
        return []

    def value_units(self) -> list[str]:
        """Return the unit of each value; empty for the one that the chain shows."""
        return [""] * len(self.of)

    def known_units(self) -> UnitRegistry:
        """Return the units that may be typed: those listed, and those of the question's bank."""
        return build_unit_registry()

    @property
    def printed_unit(self) -> str:
        """The unit that is printed beside the field on paper; empty if there is none."""
        return ""

    def read_form(self, _typed: str, _options: GradingOptions, /) -> Expr | None:
        """Return what was typed as a form of the solver, to be carried forward; None by default.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        return None

    def replace_key(self, _form: Expr, /) -> Self | None:
        """Return the same specification with another form as its key; None by default."""
        return None

    @abstractmethod
    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on what was typed; each kind has its own way.

        Raises
        ------
        FormulaReadError
            If it cannot be read: it is asked back.
        """

    @abstractmethod
    def show(self) -> str:
        """Return the key as it is printed, and as it can be typed back."""

    def show_in(self, _lang: str, /) -> str:
        """Return the key as it is printed; most kinds have one notation for all languages."""
        return self.show()


class WordSpec(SpecBase, msgspec.Struct, kw_only=True, frozen=True, omit_defaults=True,
             forbid_unknown_fields=True):  # fmt: skip
    """Fields of every kind, and all there are of the kinds whose key is made of words.

    ``traps`` maps a mistake's name to the wrong answer it gives (in the shape and unit of the key,
    which each kind states), ``notes`` a language to sentences by mistake, ``why`` a language to
    the reason by option, pair or step, ``of`` names the chain's quantities that the answer
    consists of.
    """

    kind: str
    traps: Mapping[str, object] = msgspec.field(default_factory=dict)
    notes: MisconceptionNotes = {}
    why: MisconceptionNotes = {}
    of: list[str] | dict[str, str] = []

    def validate(self) -> None:
        """Check what types cannot express.

        Raises
        ------
        FormulaError
            If a value cannot be read.
        ValueError
            If fields contradict each other.
        """

    def tells(self, _label: str, _reason: str, /) -> bool:
        """Return whether the reason for what was chosen wrongly says what is right."""
        return False


class NumericSpec(SpecBase, Tolerance, kw_only=True, frozen=True):
    """Fields of every kind whose key is made of numbers: those of all, and the tolerance.

    ``define`` are the units of the question's bank, each as ``bank.toml`` defines it; ``worth``
    maps a mistake's name to the share of the points that it still earns.
    """

    kind: str
    traps: Mapping[str, Scalar | list[Scalar] | dict[str, Scalar]] = msgspec.field(
        default_factory=dict
    )
    notes: MisconceptionNotes = msgspec.field(default_factory=dict)
    of: list[str] | dict[str, str] = msgspec.field(default_factory=list)
    define: tuple[str, ...] = ()
    worth: dict[str, Scalar] = msgspec.field(default_factory=dict)

    def known_units(self) -> UnitRegistry:
        """Return the units that may be typed: those listed, and those of the question's bank."""
        return build_unit_registry(self.define)


class ScalarSpec(NumericSpec, kw_only=True, frozen=True):
    """One number: ``value``; a trap may give several.

    ``bound`` says whether the most or the least is asked, so that an answer may say so, too.
    """

    value: Scalar
    bound: Literal["", "most", "least"] = ""
    traps: dict[str, Scalar | list[Scalar]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check tolerance, value and traps; errors as ``WordSpec.validate``."""
        super().validate()
        parse_exact(self.value)
        self.trap_values()

    @property
    def is_whole(self) -> bool:
        """Whether things are counted that have no fractions, so that no decimal can be meant."""
        return False

    def value_unit(self) -> str:
        """Return the unit that the value is judged in; empty for the one that the chain shows."""
        return ""

    def value_units(self) -> list[str]:
        """Return the unit of the one value."""
        return [self.value_unit()] * len(self.of)

    def trap_values(self, scale: int = 1) -> list[tuple[str, Value]]:
        """Return every mistake's name with each value it can give, times a scale."""
        return [
            (name, parse_exact(item) * scale)
            for name, value in self.traps.items()
            for item in (value if isinstance(value, list) else [value])
        ]


class VectorSpec(NumericSpec, kw_only=True, frozen=True):
    """Several numbers: ``values``; ``unit`` of all; each trap gives as many."""

    values: list[Scalar]
    unit: str = ""
    traps: dict[str, list[Scalar]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check tolerance, values, unit and traps; errors as ``WordSpec.validate``."""
        super().validate()
        listed_unit(self.unit)
        for value in (*self.values, *(item for trap in self.traps.values() for item in trap)):
            parse_exact(value)

    def value_units(self) -> list[str]:
        """Return the one unit, for each value."""
        return [self.unit] * len(self.of)

    def keys(self) -> list[Value]:
        """Return the values, exactly."""
        return [parse_exact(value) for value in self.values]


AnySpec = WordSpec | NumericSpec

COUNTED = frozenset({"B", "bit", "px"})
"""Units of what is counted one by one."""


def is_whole_number(value: Value) -> bool:
    """Whether a value is exactly a whole number."""
    return isinstance(value, fmpq) and value.q == 1


LEAST_GROUPED = 1000


def is_large_count(value: Value) -> bool:
    """Whether a number of things is whole, or so large that nobody writes its fractions.

    An expected number of pixels need not be whole; ``54,000`` of them are no 54.
    """
    return is_whole_number(value) or bool(abs(value) >= LEAST_GROUPED)


def matches_target(spec: Tolerance, number: ReadNumber, value: Value, target: Value) -> bool:
    """Return whether a value is the target within the tolerance, or rounded as written.

    ``number`` is how the value was written: half a unit of its last decimal is allowed too, up to
    half a percent of the target.
    """
    if spec.is_within(value, target):
        return True
    distance = abs(value - target)
    rounded = number.places and distance * 2 * 10**number.places <= 1
    return bool(rounded and distance <= CLOSE * abs(target))


def matches_misconception(spec: Tolerance, number: ReadNumber, value: Value, trap: Value) -> bool:
    """Return whether a value is what a mistake gives, with a tolerance of the mistake's own.

    The key's tolerance may be far wider than a small mistake, and would then call any small
    number by its name; so the distance counts relative to the mistake, or to the decimals written.
    """
    if not matches_target(spec, number, value, trap):
        return False
    distance = abs(value - trap)
    if distance * 2 * 10**number.places <= 1:
        return True
    width, share = spec.half_width(trap), CLOSE * abs(trap)
    return bool(distance <= max(share, min(width, WIDEST * abs(trap))))


def all_match_misconception(
    spec: Tolerance, numbers: Sequence[ReadNumber], traps: Sequence[Value]
) -> bool:
    """Return whether each number is what a mistake gives for it."""
    pairs = zip(numbers, traps, strict=True)
    return all(matches_misconception(spec, number, number.value, trap) for number, trap in pairs)


def all_match_target(
    spec: Tolerance, numbers: Sequence[ReadNumber], targets: Sequence[Value]
) -> bool:
    """Return whether each number is its target, within the tolerance or rounded as written."""
    pairs = zip(numbers, targets, strict=True)
    return all(matches_target(spec, number, number.value, target) for number, target in pairs)


def decode_spec(shape: type[SpecType], table: SpecTable, *, proven: bool = False) -> SpecType:
    """Return the specification that a plain table holds.

    Parameters
    ----------
    shape : type
        The struct of its kind.
    table : mapping
        As a key stores it.
    proven : bool
        Whether it is certainly as it was written, so that only its types need to be checked.

    Raises
    ------
    KeyFileError
        Naming the field that is wrong.
    """
    try:
        spec = convert(table, shape)
        if not proven:
            with spec.known_units().activate():
                spec.validate()
    except (msgspec.ValidationError, FormulaError, ValueError, TypeError) as error:
        raise KeyFileError(f"spec ({table['kind']}): {error}") from None
    return spec
