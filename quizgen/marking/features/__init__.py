"""What makes a drawing right: one module for each way to read a drawing.

In: what was drawn and what was wanted, in one field. Out: which share of a feature is there. Must
never know: what the drawing is of, how credit is given. A new way to read a drawing is a module
with a subclass of ``Feature`` and its name in ``AnyFeature``.
"""

from __future__ import annotations

from quizgen.marking.features.curve import Curve
from quizgen.marking.features.line import Line
from quizgen.marking.features.moved import Moved

AnyFeature = Line | Curve | Moved
"""Every way to read a drawing."""
