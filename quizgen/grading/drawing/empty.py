"""Parts of the field in which nothing may be drawn."""

from __future__ import annotations

from quizgen.grading.drawing.curve import FINE
from quizgen.grading.drawing.fitting import resample
from quizgen.grading.drawing.sheet import DrawingComparison, Feature, to_floats
from quizgen.maths.constants import Scalar


class EmptyFeature(Feature, frozen=True):
    """Nothing is drawn in ``box``: from and to along x, from and to along y."""

    box: list[Scalar]

    def validate(self, sheet: DrawingComparison, /) -> None:
        """Check the box, and that the wanted lines leave it empty.

        Raises
        ------
        ValueError
            If one of them cannot serve.
        """
        if len(self.box) != len(sheet.scale.view):
            raise ValueError("box: from and to along x, from and to along y")

    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Return no: an empty field says nothing of a drawing."""
        del sheet
        return False

    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Return whether no stroke enters the box."""
        del name
        left, right, low, high = to_floats(self.box)
        (x_0, y_0), (x_1, y_1) = sheet.scale.line([(left, low), (right, high)])
        return not any(
            x_0 <= x <= x_1 and y_0 <= y <= y_1
            for stroke in sheet.strokes
            for x, y in resample(stroke, FINE)
        )
