"""Kind ``sketch``: lines that are drawn in a field with axes, judged by what makes them right."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import Any, TypeAlias

import msgspec

from quizgen.core.decoding import convert
from quizgen.grading.drawing import AnyFeature
from quizgen.grading.drawing.point import PointFeature
from quizgen.grading.drawing.sheet import DrawingComparison, Feature, FieldScale, to_floats
from quizgen.grading.drawing.strokes import (
    FieldBounds,
    FieldPoint,
    StrokePoints,
    format_strokes,
    parse_key_line,
    read_strokes,
)
from quizgen.grading.echo import safe_echo
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.lists import read_list
from quizgen.grading.reading.numbers import read_number
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, verdict_by_share
from quizgen.kinds.asking import explain_as_code, hint, make_spec, misconception_specs
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    DrawingField,
    Formulas,
    InputControl,
    PartContext,
)
from quizgen.kinds.work import Work
from quizgen.maths.constants import Scalar
from quizgen.maths.notation import FormulaReadError, parse_formula
from quizgen.maths.number_systems import CompiledFormula, compile_expr, float64_system
from quizgen.maths.numbers import MINUS, to_float

SHOWN = 7
"""Points of a line beyond which every second one is printed: a curve bends less between them."""

SketchLines = dict[str, str]
"""Name to a line as it is typed."""


SAMPLES = 8
"""Pieces of a curve."""
DIGITS = 4, 4
"""Decimals of a point, as shares of what is typed they are far finer than any hand."""
COMMON = {"reads", *Feature.__struct_fields__}
"""Keys of every feature: no formulas."""


MARKS_ACROSS = 300
"""Half the width of a typed point as a mark, of the width of the field: one in so many."""


class ParametricCurve(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A curved line: formulas in ``t``, which runs from the first to the last of ``t``."""

    x: Scalar
    y: Scalar
    t: Formulas


AuthoredLine: TypeAlias = ParametricCurve | list[Formulas]
"""A line: formulas of its points, or a curve."""


class AuthoredSketch(AuthoredAnswer, kw_only=True, tag="sketch", frozen=True):
    """Lines to draw in a field with axes."""

    view: tuple[Scalar, Scalar, Scalar, Scalar]
    grid: Formulas
    lines: dict[str, AuthoredLine]
    features: dict[str, dict[str, Any]]
    tall: Scalar = 0
    cuts: list[Scalar] = msgspec.field(default_factory=list)
    given: dict[str, AuthoredLine] = msgspec.field(default_factory=dict)
    bars: bool = False
    marks: dict[str, Formulas] = msgspec.field(default_factory=dict)
    axes: tuple[str, str] = ("", "")
    traps: dict[str, dict[str, Scalar]] = msgspec.field(default_factory=dict)


class SketchSpec(WordSpec, kw_only=True, frozen=True):
    """Sketch: ``view`` = from and to along x and y; wanted ``lines`` as points; ``features``.

    ``tall`` is the height of the field over its width where both axes do not have one scale;
    ``cuts`` are places along x where one line ends and another begins, so that strokes are cut
    there. A trap gives all lines as they are with the mistake.
    """

    view: tuple[Scalar, Scalar, Scalar, Scalar]
    lines: SketchLines
    features: dict[str, AnyFeature]
    tall: Scalar = 0
    cuts: list[Scalar] = msgspec.field(default_factory=list)
    traps: dict[str, SketchLines] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check that lines have two ends and room in the field, and features name lines.

        Raises
        ------
        ValueError
            If not, or if a feature cannot be judged.
        """
        left, right, low, high = self.field
        if not (left < right and low < high):
            raise ValueError("view: from must be below to")
        if not self.features or any(one.worth < 1 for one in self.features.values()):
            raise ValueError("there must be features, each worth something")
        if any({*lines} != {*self.lines} for lines in self.traps.values()):
            raise ValueError("every mistake has the lines that the key has")
        to_floats([self.tall, *self.cuts])
        if any(not one.of or not {*one.of} <= {*self.lines} for one in self.features.values()):
            raise ValueError("features: of names lines")
        for sheet in self._build_comparisons([]):
            for one in self.features.values():
                one.validate(sheet)

    @property
    def field(self) -> FieldBounds:
        """What the field shows."""
        left, right, low, high = to_floats(self.view)
        return left, right, low, high

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on drawn lines by the features of the wanted ones, weighed by worth.

        Raises
        ------
        FormulaReadError
            If no lines can be read.
        """
        strokes = self._read_strokes(typed, options)
        line = self.scale.line
        drawn = [line(piece) for stroke in strokes for piece in self._cut_stroke(stroke)]
        sheet, *mistaken = self._build_comparisons(drawn)
        note, shares = "sketch", self._compute_shares(sheet)
        if any(share < 1 for share in shares.values()):
            is_near = any(one.is_judgeable(sheet) for one in self.features.values())
            usual = note if is_near else "sketch-elsewhere"
            note = self._find_misconception_note(shares, mistaken) or usual
        worth = {name: one.worth for name, one in self.features.items()}
        credit = sum((worth[name] * share for name, share in shares.items()), Fraction(0))
        missed = tuple(name for name, share in shares.items() if share < 1)
        return verdict_by_share(
            credit / sum(worth.values()),
            safe_echo(self._format_lines(strokes), 80),
            note,
            right=len(shares) - len(missed),
            of=len(shares),
            because=missed,
        )

    def _read_strokes(self, typed: str, options: GradingOptions) -> list[list[FieldPoint]]:
        """Return drawn or typed lines; a point alone is a small mark where only points are asked.

        Raises
        ------
        FormulaReadError
            If no lines can be read.
        """
        try:
            return read_strokes(typed, self.field)
        except FormulaReadError:
            only_points = all(isinstance(one, PointFeature) for one in self.features.values())
            mark = self._write_lone_point(typed, options) if only_points else ""
            if not mark:
                raise
        return read_strokes(mark, self.field)

    def _write_lone_point(self, typed: str, options: GradingOptions) -> str:
        """Return a typed point as a small mark, ``S = (6/3; 9/3) = (2; 3)``; empty if it is none.

        Of equal points the last one counts.
        """
        named = re.fullmatch(r"\s*x ?[=:] ?(.+?)[,;]? +y ?[=:] ?(.+)", typed)
        text = "; ".join(named.groups()) if named else re.split(r"[=≈]", typed)[-1]
        text = text.replace("|", ";")
        try:
            items, _ = read_list(text, len(("x", "y")), options.decimal)
            x, y = (float(read_number(item, options.decimal).main.value) for item in items)
        except FormulaReadError:
            return ""
        left, right, low, high = self.field
        across, up = (right - left) / MARKS_ACROSS, (high - low) / MARKS_ACROSS
        return f"{x - across:.9f},{y - up:.9f} {x + across:.9f},{y + up:.9f}"

    @property
    def digits(self) -> tuple[int, int]:
        """Decimals along x and along y that show a three hundredth of the field."""
        left, right, low, high = self.field
        return _count_decimals(right - left), _count_decimals(high - low)

    def show(self) -> str:
        """Return the wanted lines, curved ones by a few of their points."""
        return self._format_lines(
            [_thin_line(parse_key_line(line)) for line in self.lines.values()]
        )

    def _format_lines(self, lines: Sequence[Sequence[FieldPoint]]) -> str:
        """Return lines as people write them, and as they can be typed."""
        return format_strokes(lines, self.digits).replace("-", MINUS)

    @property
    def scale(self) -> FieldScale:
        """The change from numbers on the axes to shares of the width."""
        return FieldScale(self.field, to_floats([self.tall])[0])

    def _cut_stroke(self, stroke: StrokePoints) -> list[list[FieldPoint]]:
        """Return a stroke in pieces between the upright lines at which it is cut."""
        found = [[stroke[0]]]
        for (x, y), (to_x, to_y) in pairwise(stroke):
            places = [
                place for place in to_floats(self.cuts) if min(x, to_x) < place <= max(x, to_x)
            ]
            for place in sorted(places, reverse=to_x < x):
                at = (place, y + (to_y - y) * (place - x) / (to_x - x))
                found[-1].append(at)
                found.append([at])
            found[-1].append((to_x, to_y))
        return [piece for piece in found if len({*piece}) > 1]

    def _build_comparisons(self, drawn: Sequence[StrokePoints]) -> list[DrawingComparison]:
        """Return what was drawn next to the wanted lines, then next to those of each mistake."""
        scale = self.scale
        ways = [{name: scale.line(parse_key_line(line)) for name, line in lines.items()}
                for lines in (self.lines, *self.traps.values())]  # fmt: skip
        return [
            DrawingComparison(scale, drawn, way, [*ways[:place], *ways[place + 1 :]])
            for place, way in enumerate(ways)
        ]

    def _compute_shares(self, sheet: DrawingComparison) -> dict[str, Fraction]:
        """Return the share, 0 to 1, in which each feature is satisfied, by its name."""
        return {name: one.satisfied_share(sheet) for name, one in self.features.items()}

    def _find_misconception_note(
        self, shares: Mapping[str, Fraction], mistaken: Sequence[DrawingComparison]
    ) -> str:
        """Return the note of the mistake that explains most of what is missed, or empty."""
        missed = [name for name, share in shares.items() if share < 1]
        found, most = "", 0
        for trap, sheet in zip(self.traps, mistaken, strict=True):
            explained = sum(self.features[name].satisfied_share(sheet) == 1 for name in missed)
            if explained > most:
                found, most = trap, explained
            if most == len(missed):
                break
        return f"trap:{found}" if found else ""


def _count_decimals(extent: float) -> int:
    """Return the decimals that show a three hundredth of an extent."""
    return max(0, 2 - math.floor(math.log10(extent)))


def _thin_line(line: list[FieldPoint]) -> list[FieldPoint]:
    """Return every second point of a long line, and its last."""
    return [*line[:-1:2], line[-1]] if len(line) > SHOWN else line


def ask(part: PartContext) -> AskedPart[SketchSpec]:
    """Return the wanted lines and those of each mistake, and the field that they are drawn in.

    Raises
    ------
    BankError
        If the authored answer is not complete.
    """
    answer = convert(part.answer, AuthoredSketch)
    curves = [*answer.lines.values(), *answer.given.values()]
    if "t" in part.shown_values and any(isinstance(one, ParametricCurve) for one in curves):
        raise part.error("'t' is drawn, and the parameter of a curve as well", "QG125")
    right = _TemplateFormulas({name: to_float(value) for name, value in part.shown_values.items()})
    traps = {
        trap: _format_typed_lines(right.with_changes(changed).lines(answer.lines))
        for trap, changed in answer.traps.items()
    }
    features = {name: _fill_feature(right, one) for name, one in answer.features.items()}
    lines, tall = right.lines(answer.lines), right.number(answer.tall)
    spec = make_spec(
        SketchSpec,
        part,
        view=[right.number(limit) for limit in answer.view],
        tall=tall,
        cuts=[right.number(place) for place in answer.cuts],
        lines=_format_typed_lines(lines),
        features=features,
        traps=traps,
        notes=part.misconception_notes(traps) if traps else {},
        why=part.reasons([(name, name) for name in features]),
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
    return AskedPart(
        spec,
        InputControl("lines", lines=4, board=board),
        right=tuple(("points", name) for name in features),
        shares=_list_shares(features.values()),
        drawn=tuple(map(tuple, lines.values())),
        mistakes=misconception_specs(spec, "lines"),
    )


def _list_shares(features: Iterable[Mapping[str, Any]]) -> tuple[Fraction, ...]:
    """Return what share of the points each feature earns."""
    weights = [Fraction(feature.get("worth", 1)) for feature in features]
    return tuple(weight / sum(weights) for weight in weights)


class _TemplateFormulas:
    """Formulas of a template over the values of a variant."""

    def __init__(self, values: Mapping[str, float]) -> None:
        """Store the values by name, in the units they are shown in."""
        self._values = values

    def with_changes(self, changed: Mapping[str, Scalar]) -> _TemplateFormulas:
        """Return these formulas over values some of which are changed."""
        return _TemplateFormulas(
            {**self._values, **{name: self.number(to) for name, to in changed.items()}}
        )

    def number(self, formula: Scalar) -> float:
        """Return the value of a formula."""
        return self._compile_formula(formula)(self._values.get("t", 0.0))

    def point(self, formulas: Formulas) -> FieldPoint:
        """Return the values of two formulas."""
        return self.number(formulas[0]), self.number(formulas[1])

    def fill_value(self, value: Scalar | list[Scalar]) -> float | list[float]:
        """Return the value of a formula or of several; a bool stays one."""
        if isinstance(value, bool):
            return value
        return [*map(self.number, value)] if isinstance(value, list) else self.number(value)

    def lines(self, authored: Mapping[str, AuthoredLine]) -> dict[str, list[FieldPoint]]:
        """Return the points of authored lines by their names."""
        return {name: self._build_line(line) for name, line in authored.items()}

    def _build_line(self, line: AuthoredLine) -> list[FieldPoint]:
        """Return the points of one line; of a curve the ends of ``SAMPLES`` pieces."""
        if not isinstance(line, ParametricCurve):
            return [_round_point(*self.point(point)) for point in line]
        x, y = self._compile_formula(line.x), self._compile_formula(line.y)
        first, last = self.point(line.t)
        steps = [first + (last - first) * i / SAMPLES for i in range(SAMPLES + 1)]
        return [_round_point(x(t), y(t)) for t in steps]

    def _compile_formula(self, formula: Scalar) -> Callable[[float], float]:
        """Return a formula as a function of the curve's parameter ``t``."""
        compiled = _compile_template_formula(str(formula), tuple({**self._values, "t": 0}))
        return lambda t: float(compiled({**self._values, "t": t}))


@lru_cache(maxsize=512)
def _compile_template_formula(text: str, symbols: tuple[str, ...]) -> CompiledFormula:
    """Return a formula over its symbols, compiled once for all variants of a template."""
    return compile_expr(parse_formula(text, symbols=symbols), float64_system())


def _format_typed_lines(lines: Mapping[str, list[FieldPoint]]) -> dict[str, str]:
    """Return lines as they are typed, by their names."""
    return {name: format_strokes([line], DIGITS) for name, line in lines.items()}


def _round_point(x: float, y: float) -> FieldPoint:
    """Return a point with ``DIGITS`` decimals and without a minus sign at 0."""
    return round(x, DIGITS[0]) + 0.0, round(y, DIGITS[1]) + 0.0


def _fill_feature(place: _TemplateFormulas, authored: Mapping[str, Any]) -> dict[str, Any]:
    """Return a feature with numbers in place of formulas, whichever fields it has."""
    return {
        key: value if key in COMMON else place.fill_value(value) for key, value in authored.items()
    }


HOW_TO_TYPE = hint("ask.sketch", example="0,0 1,0.4 2,0; 0,1 2,1")


def count_strokes(answer: Mapping[str, Any], _points: Fraction, _words: int) -> Work:
    """Return what has to be right about the lines, and half as much for drawing each."""
    return {"feature drawn": len(answer["features"]) + Fraction(len(answer["lines"]), 2)}


KIND = AnswerKind(
    AuthoredSketch, SketchSpec, ask, HOW_TO_TYPE, explain_as_code, verb="sketch", work=count_strokes
)
