"""Kind ``sketch``: lines that are drawn in a field with axes, judged by what makes them right."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise

import msgspec

from quizgen.grading.drawing import AnyFeature
from quizgen.grading.drawing.sheet import DrawingComparison, FieldScale, to_floats
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
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, verdict_by_share
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import MINUS

SHOWN = 5
"""Points of a line beyond which every second one is printed."""

Lines = dict[str, str]
"""Name to a line as it is typed."""


class Spec(WordSpec, kw_only=True, frozen=True):
    """Sketch: ``view`` = from and to along x and y; wanted ``lines`` as points; ``features``.

    ``tall`` is the height of the field over its width where both axes do not have one scale;
    ``cuts`` are places along x where one line ends and another begins, so that strokes are cut
    there. A trap gives all lines as they are with the mistake.
    """

    view: tuple[Scalar, Scalar, Scalar, Scalar]
    lines: Lines
    features: dict[str, AnyFeature]
    tall: Scalar = 0
    cuts: list[Scalar] = msgspec.field(default_factory=list)
    traps: dict[str, Lines] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Lines need two ends and room in the field, features known lines."""
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
        for sheet in self._sheets([]):
            for one in self.features.values():
                one.validate(sheet)

    @property
    def field(self) -> FieldBounds:
        """What the field shows."""
        left, right, low, high = to_floats(self.view)
        return left, right, low, high

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Judge drawn lines by the features of the wanted ones."""
        strokes = read_strokes(typed, self.field)
        line = self.scale.line
        drawn = [line(piece) for stroke in strokes for piece in self._cut(stroke)]
        sheet, *mistaken = self._sheets(drawn)
        note, shares = "sketch", self._shares(sheet)
        if not any(one.is_judgeable(sheet) for one in self.features.values()):
            note = "sketch-elsewhere"
        elif any(share < 1 for share in shares.values()):
            note = self._trap(shares, mistaken) or note
        worth = {name: one.worth for name, one in self.features.items()}
        credit = sum((worth[name] * share for name, share in shares.items()), Fraction(0))
        missed = tuple(name for name, share in shares.items() if share < 1)
        return verdict_by_share(
            credit / sum(worth.values()),
            safe_echo(self._told(strokes), 80),
            note,
            right=len(shares) - len(missed),
            of=len(shares),
            because=missed,
        )

    @property
    def digits(self) -> tuple[int, int]:
        """Decimals along x and along y that show a three hundredth of the field."""
        left, right, low, high = self.field
        return _decimals(right - left), _decimals(high - low)

    def show(self) -> str:
        """The wanted lines, curved ones by a few of their points."""
        return self._told([_few(parse_key_line(line)) for line in self.lines.values()])

    def _told(self, lines: Sequence[Sequence[FieldPoint]]) -> str:
        """Lines as people write them, and as they can be typed."""
        return format_strokes(lines, self.digits).replace("-", MINUS)

    @property
    def scale(self) -> FieldScale:
        """From the numbers on the axes to shares of the width."""
        return FieldScale(self.field, to_floats([self.tall])[0])

    def _cut(self, stroke: StrokePoints) -> list[list[FieldPoint]]:
        """A stroke in pieces between the upright lines at which it is cut."""
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

    def _sheets(self, drawn: Sequence[StrokePoints]) -> list[DrawingComparison]:
        """What was drawn beside the wanted lines, and beside those of each mistake."""
        scale = self.scale
        ways = [{name: scale.line(parse_key_line(line)) for name, line in lines.items()}
                for lines in (self.lines, *self.traps.values())]  # fmt: skip
        return [
            DrawingComparison(scale, drawn, way, [*ways[:place], *ways[place + 1 :]])
            for place, way in enumerate(ways)
        ]

    def _shares(self, sheet: DrawingComparison) -> dict[str, Fraction]:
        return {name: one.satisfied_share(sheet) for name, one in self.features.items()}

    def _trap(self, shares: Mapping[str, Fraction], mistaken: Sequence[DrawingComparison]) -> str:
        """The known mistake that explains most of what is missed."""
        missed = [name for name, share in shares.items() if share < 1]
        found, most = "", 0
        for trap, sheet in zip(self.traps, mistaken, strict=True):
            explained = sum(self.features[name].satisfied_share(sheet) == 1 for name in missed)
            if explained > most:
                found, most = trap, explained
            if most == len(missed):
                break
        return f"trap:{found}" if found else ""


def _decimals(extent: float) -> int:
    return max(0, 2 - math.floor(math.log10(extent)))


def _few(line: list[FieldPoint]) -> list[FieldPoint]:
    return [*line[:-1:2], line[-1]] if len(line) > SHOWN else line
