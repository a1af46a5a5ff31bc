"""What makes a drawing right: one module for each way to read a drawing.

In: what was drawn and what was wanted, in one field. Out: which share of a feature is there. Must
never know: what the drawing is of, how credit is given. A new way to read a drawing is a module
with a subclass of ``Feature`` and its name in ``AnyFeature``.
"""

from __future__ import annotations

from quizgen.grading.drawing.curve import CurveFeature
from quizgen.grading.drawing.empty import EmptyFeature
from quizgen.grading.drawing.height import HeightFeature
from quizgen.grading.drawing.line import LineFeature
from quizgen.grading.drawing.loop import LoopFeature
from quizgen.grading.drawing.moved import MovedFeature
from quizgen.grading.drawing.point import PointFeature

AnyFeature = (
    LineFeature
    | CurveFeature
    | HeightFeature
    | LoopFeature
    | MovedFeature
    | PointFeature
    | EmptyFeature
)
"""Every way to read a drawing."""
