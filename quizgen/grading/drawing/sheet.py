"""A drawing and what was wanted, both in shares of the width of their field."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeVar, cast

import msgspec

from quizgen.grading.drawing.strokes import FieldBounds, FieldPoint, StrokePoints
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import parse_written_number

T = TypeVar("T")


class FieldScale(msgspec.Struct, frozen=True):
    """From the numbers on the axes to shares of the width.

    Parameters
    ----------
    view : View
        What the field shows.
    tall : float
        Its height over its width where both axes do not have one scale, else 0.
    """

    view: FieldBounds
    tall: float

    def point(self, point: FieldPoint) -> FieldPoint:
        """A point of the field."""
        left, right, low, high = self.view
        x, y = point
        wide = right - left
        return (x - left) / wide, (y - low) * (self.tall / (high - low) if self.tall else 1 / wide)

    def line(self, line: StrokePoints) -> list[FieldPoint]:
        """A line in it."""
        return [self.point(point) for point in line]


@dataclass(frozen=True, slots=True)
class DrawingComparison:
    """One drawing beside the lines that were wanted.

    Parameters
    ----------
    scale : Scale
    strokes : sequence of strokes
        What was drawn.
    wanted : mapping of str to stroke
        Lines by name.
    others : sequence of mappings
        The same lines with a known mistake, or with another one.
    """

    scale: FieldScale
    strokes: Sequence[StrokePoints]
    wanted: Mapping[str, StrokePoints]
    others: Sequence[Mapping[str, StrokePoints]] = ()
    _read: dict[object, object] = field(default_factory=dict, repr=False, compare=False)

    def compute_once(self, read: Callable[[DrawingComparison], T]) -> T:
        """What is read off the sheet, worked out for the first feature that asks."""
        if read not in self._read:
            self._read[read] = read(self)
        return cast("T", self._read[read])


def _name_in_files(class_name: str) -> str:
    """Word that stands for a feature in templates and keys: ``LineFeature`` is ``line``."""
    return class_name.removesuffix("Feature").lower()


class Feature(msgspec.Struct, kw_only=True, frozen=True, omit_defaults=True,
              forbid_unknown_fields=True, tag_field="reads", tag=_name_in_files):  # fmt: skip
    """Something that makes a drawing right.

    ``of`` names the lines that have it; ``worth`` weighs it among the others.
    """

    of: list[str]
    worth: int = 1

    def validate(self, sheet: DrawingComparison, /) -> None:
        """Check what types cannot say, also of the wanted lines, so that nothing drawn raises."""

    @abstractmethod
    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Whether there is anything to judge it by."""

    @abstractmethod
    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Whether a line has it."""

    def satisfied_share(self, sheet: DrawingComparison) -> Fraction:
        """Which share of its lines has it."""
        return Fraction(sum(self.holds_for(name, sheet) for name in self.of), len(self.of))


def to_floats(scalars: Sequence[Scalar]) -> list[float]:
    """What a key stores, as floats."""
    try:
        return [float(parse_written_number(one)) for one in scalars]
    except OverflowError:
        raise ValueError("a number is beyond all floats") from None
