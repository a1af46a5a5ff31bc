"""Kind ``sketch``: lines that are drawn in a field with axes, judged by what makes them right."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import msgspec

from quizgen.marking.echo import safe
from quizgen.marking.judging.drawing import Fit, Frame, fit, fitted, resampled
from quizgen.marking.options import Options
from quizgen.marking.reading.strokes import Point, View, read_line, read_strokes, written
from quizgen.marking.specs import Worded
from quizgen.marking.verdict import Verdict, shared
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import MINUS
from quizgen.maths.numbers import written as written_number

FLAT, MOST_BENT = 0.03, 0.25
"""Rise over length below which a line is straight, and that of a bow at most."""
ROUGH = 0.03
"""How far from a smooth curve a hand may draw, as a share of the length."""
NEAR = 0.045
"""How far from its place a line may run, as a share of the width of the field."""
COVERED = 0.55
"""Share of a wanted line that has to be there."""
CLEARLY = 0.06
"""Share of a circle's radius by which an end has to lie inside or outside."""
SHOWN = 5
"""Points of a curved line that are printed."""

Lines = dict[str, str]
"""Name to a line as it is typed."""


class Feature(msgspec.Struct, kw_only=True, frozen=True, omit_defaults=True,
              forbid_unknown_fields=True):  # fmt: skip
    """Something that makes a drawing right: all that is said here, of each line.

    ``of`` names the lines; ``worth`` weighs it among the others. ``bend``: straight, or bent to
    the same side as the wanted line. ``on``: it lies on the wanted line, whose ends it need not
    reach. ``circle``: centre and radius; both ends are inside or outside as those of the wanted
    line.
    """

    of: list[str]
    worth: int = 1
    bend: bool = False
    on: bool = False
    circle: tuple[Scalar, Scalar, Scalar] | None = None


class Spec(Worded, kw_only=True, frozen=True):
    """Sketch: ``view`` = from and to along x and y; wanted ``lines`` as points; ``features``.

    ``tall`` is the height of the field over its width where both axes do not have one scale. A
    trap gives all lines as they are with the mistake.
    """

    view: tuple[Scalar, Scalar, Scalar, Scalar]
    lines: Lines
    features: dict[str, Feature]
    tall: Scalar = 0
    traps: dict[str, Lines] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Lines need two ends and room in the field, features known lines."""
        left, right, low, high = self.field
        if not (left < right and low < high):
            raise ValueError("view: from must be below to")
        if not self.features or any(one.worth < 1 for one in self.features.values()):
            raise ValueError("there must be features, each worth something")
        for lines in (self.lines, *self.traps.values()):
            if {*lines} != {*self.lines}:
                raise ValueError("every mistake has the lines that the key has")
            self._wishes(lines)
        for one in self.features.values():
            if not one.of or not {*one.of} <= {*self.lines}:
                raise ValueError("features: of names lines")
            _numbers(one.circle or ())

    @property
    def field(self) -> View:
        """What the field shows."""
        left, right, low, high = _numbers(self.view)
        return left, right, low, high

    def judge(self, typed: str, _options: Options, /) -> Verdict:
        """Judge drawn lines by the features of the wanted ones."""
        strokes = read_strokes(typed, self.field)
        drawn = [self._placed(stroke) for stroke in strokes]
        shares = self._shares(drawn, self.lines)
        note = "sketch"
        if shares is None:
            note, shares = "sketch-elsewhere", dict.fromkeys(self.features, Fraction(0))
        elif any(share < 1 for share in shares.values()):
            note = self._trap(drawn) or note
        worth = {name: one.worth for name, one in self.features.items()}
        credit = sum((worth[name] * share for name, share in shares.items()), Fraction(0))
        missed = tuple(name for name, share in shares.items() if share < 1)
        return shared(
            credit / sum(worth.values()),
            safe(self._told(strokes), 80),
            note,
            right=len(shares) - len(missed),
            of=len(shares),
            because=missed,
        )

    @property
    def digits(self) -> int:
        """Decimals that show a three hundredth of the field."""
        left, right, *_ = self.field
        return max(0, 2 - math.floor(math.log10(right - left)))

    def show(self) -> str:
        """The wanted lines, curved ones by a few of their points."""
        return self._told([_few(read_line(line)) for line in self.lines.values()])

    def _told(self, lines: Sequence[Sequence[Point]]) -> str:
        """Lines as people write them, and as they can be typed."""
        return written(lines, self.digits).replace("-", MINUS)

    def _placed(self, line: Sequence[Point]) -> list[Point]:
        """Points in shares of the width of the field."""
        left, right, low, high = self.field
        (tall,) = _numbers([self.tall])
        wide = right - left
        scale = tall / (high - low) if tall else 1 / wide
        return [((x - left) / wide, (y - low) * scale) for x, y in line]

    def _shares(self, drawn: list[list[Point]], wanted: Lines) -> dict[str, Fraction] | None:
        """Which share of its lines has each feature; none if no line lies where one is wanted."""
        wishes = self._wishes(wanted)
        fits = fitted(drawn, {name: wish.line for name, wish in wishes.items()})
        if not fits:
            return None
        return {
            name: Fraction(
                sum(self._has(one, wishes[line], fits.get(line)) for line in one.of), len(one.of)
            )
            for name, one in self.features.items()
        }

    def _wishes(self, lines: Lines) -> dict[str, _Wish]:
        return {name: _Wish.of(self._placed(read_line(line))) for name, line in lines.items()}

    def _has(self, feature: Feature, wish: _Wish, drawn: Fit | None) -> bool:
        if drawn is None or drawn.half < COVERED * wish.fit.half or drawn.rough > ROUGH:
            return False
        return (
            (not feature.bend or _bends_alike(drawn.bow, wish.fit.bow))
            and (not feature.on or wish.covers(drawn))
            and (feature.circle is None or self._sides(feature.circle, wish, drawn))
        )

    def _sides(self, circle: tuple[Scalar, ...], wish: _Wish, drawn: Fit) -> bool:
        x, y, radius = _numbers(circle)
        (centre, rim) = self._placed([(x, y), (x + radius, y)])
        limit = math.dist(centre, rim)
        return all(
            (math.dist(end, centre) / limit - 1) * (1 if math.dist(goal, centre) > limit else -1)
            >= CLEARLY
            for end, goal in zip(drawn.ends, (wish.line[0], wish.line[-1]), strict=True)
        )

    def _trap(self, drawn: list[list[Point]]) -> str:
        """The known mistake of which all features are there."""
        for name, lines in self.traps.items():
            shares = self._shares(drawn, lines)
            if shares is not None and all(share == 1 for share in shares.values()):
                return f"trap:{name}"
        return ""


class _Wish(msgspec.Struct, frozen=True):
    """A wanted line with its own fit."""

    line: list[Point]
    frame: Frame
    fit: Fit

    @classmethod
    def of(cls, line: list[Point]) -> _Wish:
        if len(line) < 2 or line[0] == line[-1]:
            raise ValueError("a line has two ends, apart from each other")
        frame = Frame.of(line)
        own = fit(resampled(line, frame.length / 40), frame)
        if own is None:
            raise ValueError("a line is too short for its field")
        return cls(line, frame, own)

    def covers(self, drawn: Fit) -> bool:
        """Whether a drawn line lies on the wanted one as far as both run."""
        first = max(drawn.middle - drawn.half, self.fit.middle - self.fit.half)
        last = min(drawn.middle + drawn.half, self.fit.middle + self.fit.half)
        places = (first, (first + last) / 2, last)
        return all(abs(drawn.off(place) - self.fit.off(place)) <= NEAR for place in places)


def _numbers(scalars: Sequence[Scalar]) -> list[float]:
    return [float(written_number(one)) for one in scalars]


def _bends_alike(bow: float, wanted: float) -> bool:
    if abs(wanted) < FLAT:
        return abs(bow) < FLAT
    return FLAT <= math.copysign(bow, bow * wanted) <= MOST_BENT


def _few(line: list[Point]) -> list[Point]:
    step = max(1, (len(line) - 1) // (SHOWN - 1))
    return [*line[:-1:step], line[-1]]
