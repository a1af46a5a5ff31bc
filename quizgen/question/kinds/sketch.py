"""Kind ``sketch``: lines to draw in a field with axes; a trap is a wrong quantity in them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from quizgen.bank.answers import Curve, Formulas, Line, Sketch
from quizgen.bank.markdown import InlineCode
from quizgen.bank.variant import Variant
from quizgen.core.decoding import convert
from quizgen.figures import DrawingField
from quizgen.grading.drawing.sheet import Feature
from quizgen.grading.drawing.strokes import format_strokes
from quizgen.grading.kinds.sketch import Spec
from quizgen.grading.mark import show_key
from quizgen.maths.constants import Scalar
from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import CompiledFormula, compile_expr, float64_system
from quizgen.maths.numbers import to_float
from quizgen.question.contract import Built, Control
from quizgen.question.inlines import TextOrInlines, translate_inlines
from quizgen.question.specs import (
    authored_answer,
    misconception_notes,
    mistaken,
    reasons,
    specification,
)

SAMPLES = 8
"""Pieces of a curve."""
DIGITS = 4, 4
"""Decimals of a point, as shares of what is typed they are far finer than any hand."""
COMMON = {"reads", *Feature.__struct_fields__}
"""Keys of every feature: no formulas."""

Point = tuple[float, float]


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The wanted lines and those of each mistake, and the field that they are drawn in."""
    answer = convert(authored_answer(drawn, index), Sketch)
    right = _Place({name: to_float(value) for name, value in drawn.shown_values.items()})
    traps = {
        trap: _typed(right.but(changed).lines(answer.lines))
        for trap, changed in answer.traps.items()
    }
    features = {name: _feature(right, one) for name, one in answer.features.items()}
    lines, tall = right.lines(answer.lines), right.number(answer.tall)
    spec = specification(
        Spec,
        drawn,
        index,
        view=[right.number(limit) for limit in answer.view],
        tall=tall,
        cuts=[right.number(place) for place in answer.cuts],
        lines=_typed(lines),
        features=features,
        traps=traps,
        notes=misconception_notes(drawn, traps) if traps else {},
        why=reasons(drawn, [(name, name) for name in features]),
    )
    board = DrawingField(
        view=spec.field,
        grid=right.point(answer.grid),
        tall=tall,
        given=tuple(map(tuple, right.lines(answer.given).values())),
        bars=answer.bars,
        marks=tuple((label, right.point(at)) for label, at in answer.marks.items()),
        axes=answer.axes,
    )
    return Built(
        spec,
        Control("lines", lines=4, board=board),
        right=tuple(("points", name) for name in features),
        drawn=tuple(map(tuple, lines.values())),
        mistakes=mistaken(spec, "lines"),
    )


class _Place:
    """Formulas of a template over the values of a draw."""

    def __init__(self, values: Mapping[str, float]) -> None:
        self._values = values

    def but(self, changed: Mapping[str, Scalar]) -> _Place:
        """The same with wrong values in place of some."""
        return _Place({**self._values, **{name: self.number(to) for name, to in changed.items()}})

    def number(self, formula: Scalar) -> float:
        """The value of a formula."""
        return self._compiled(formula)(0.0)

    def point(self, formulas: Formulas) -> Point:
        """The values of two."""
        return self.number(formulas[0]), self.number(formulas[1])

    def filled(self, value: Scalar | list[Scalar]) -> float | list[float]:
        """The value of a formula or of several; what is true or false stays so."""
        if isinstance(value, bool):
            return value
        return [*map(self.number, value)] if isinstance(value, list) else self.number(value)

    def lines(self, authored: Mapping[str, Line]) -> dict[str, list[Point]]:
        """Lines by their names."""
        return {name: self._line(line) for name, line in authored.items()}

    def _line(self, line: Line) -> list[Point]:
        if not isinstance(line, Curve):
            return [_rounded(*self.point(point)) for point in line]
        x, y = self._compiled(line.x), self._compiled(line.y)
        first, last = self.point(line.t)
        steps = [first + (last - first) * i / SAMPLES for i in range(SAMPLES + 1)]
        return [_rounded(x(t), y(t)) for t in steps]

    def _compiled(self, formula: Scalar) -> Callable[[float], float]:
        compiled = _formula(str(formula), (*self._values, "t"))
        return lambda t: float(compiled({**self._values, "t": t}))


@lru_cache(maxsize=512)
def _formula(text: str, symbols: tuple[str, ...]) -> CompiledFormula:
    """A formula of a template over its symbols, the same for all of its draws."""
    return compile_expr(parse_formula(text, symbols=symbols), float64_system())


def _typed(lines: Mapping[str, list[Point]]) -> dict[str, str]:
    return {name: format_strokes([line], DIGITS) for name, line in lines.items()}


def _rounded(x: float, y: float) -> Point:
    return round(x, DIGITS[0]) + 0.0, round(y, DIGITS[1]) + 0.0


def _feature(place: _Place, authored: Mapping[str, Any]) -> dict[str, Any]:
    """A feature with numbers in place of formulas, whichever keys its way to read has."""
    return {key: value if key in COMMON else place.filled(value) for key, value in authored.items()}


def hints(_spec: Spec, lang: str) -> tuple[TextOrInlines, ...]:
    """Draw, or write points."""
    return (translate_inlines(lang, "ask.sketch", example=(InlineCode("0,0 1,0.4 2,0; 0,1 2,1"),)),)


def printed(spec: Spec, lang: str) -> TextOrInlines:
    """The wanted lines as they are typed."""
    return (InlineCode(show_key(spec, lang)),)
