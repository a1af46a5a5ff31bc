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
    """The change from numbers on the axes to shares of the width of the field.

    Parameters
    ----------
    view : FieldBounds
        What the field shows.
    tall : float
        Its height over its width where both axes do not have one scale, else 0.
    """

    view: FieldBounds
    tall: float

    def point(self, point: FieldPoint) -> FieldPoint:
        """Return a point in shares of the width, from the lower left corner."""
        left, right, low, high = self.view
        x, y = point
        wide = right - left
        return (x - left) / wide, (y - low) * (self.tall / (high - low) if self.tall else 1 / wide)

    def line(self, line: StrokePoints) -> list[FieldPoint]:
        """Return a line in shares of the width."""
        return [self.point(point) for point in line]


@dataclass(frozen=True, slots=True)
class DrawingComparison:
    """One drawing next to the lines that were wanted.

    Parameters
    ----------
    scale : FieldScale
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
        """Return what a function reads off the sheet, computed for the first caller only."""
        if read not in self._read:
            self._read[read] = read(self)
        return cast("T", self._read[read])


def _name_in_files(class_name: str) -> str:
    """Return the word for a feature in templates and keys: ``LineFeature`` is ``line``."""
    return class_name.removesuffix("Feature").lower()


class Feature(msgspec.Struct, kw_only=True, frozen=True, omit_defaults=True,
              forbid_unknown_fields=True, tag_field="reads", tag=_name_in_files):  # fmt: skip
    """Something that makes a drawing right.

    ``of`` names the lines that have it; ``worth`` weighs it among the others.
    """

    of: list[str]
    worth: int = 1

    def validate(self, sheet: DrawingComparison, /) -> None:
        """Check what types cannot, also of the wanted lines, so that no drawing raises.

        Raises
        ------
        ValueError
            If the feature can never be judged.
        """

    @abstractmethod
    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Return whether anything was drawn that it can be judged by."""

    @abstractmethod
    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Return whether the drawn line of a name has the feature."""

    def satisfied_share(self, sheet: DrawingComparison) -> Fraction:
        """Return which share of its lines has the feature, 0 to 1."""
        return Fraction(sum(self.holds_for(name, sheet) for name in self.of), len(self.of))


def to_floats(scalars: Sequence[Scalar]) -> list[float]:
    """Return numbers of a key as floats.

    Raises
    ------
    ValueError
        If one is beyond all floats.
    """
    try:
        return [float(parse_written_number(one)) for one in scalars]
    except OverflowError:
        raise ValueError("a number is beyond all floats") from None
