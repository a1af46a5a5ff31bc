"""From points to grades: the scale of a class, ``scale.toml``, or the usual German one."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path
from typing import Literal

import msgspec

from quizgen.core.decoding import convert
from quizgen.core.errors import ClassError, FormulaError
from quizgen.core.untrusted import parse_toml, read_text
from quizgen.maths.numbers import parse_written_number

FILE = "scale.toml"
GERMAN = ("1.0", "1.3", "1.7", "2.0", "2.3", "2.7", "3.0", "3.3", "3.7", "4.0")
FAILED = "5.0"

Share = str | int


class BonusRule(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How points that were earned before the exam count.

    Parameters
    ----------
    most : str or int
        Points that count at most.
    needs_pass : bool
        They count only for those who pass without them.
    """

    most: Share = 100
    needs_pass: bool = True


class GradeScale(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How grades follow from points.

    Parameters
    ----------
    passed : str or int
        Percent of the points with which one passes, and gets the last of ``grades``.
    best : str or int
        Percent with which one gets the first of them; the others lie evenly between.
    round_to : str or int
        Points are rounded to a multiple of this; 0 leaves them as they are.
    rounding : str
        ``up``, ``nearest`` (halves up) or ``down``.
    grades : tuple of str
        From the best to the last one that passes.
    fail : str
        The grade below.
    steps : mapping of str to str or int
        Percent for a grade, where they do not lie evenly.
    bonus : BonusRule
        What is added of a student's ``bonus`` in the roster.
    """

    passed: Share = 50
    best: Share = 95
    round_to: Share = 0
    rounding: Literal["up", "nearest", "down"] = "nearest"
    grades: tuple[str, ...] = GERMAN
    fail: str = FAILED
    steps: dict[str, Share] = {}
    bonus: BonusRule = BonusRule()

    def grade_bounds(self) -> list[tuple[str, Fraction]]:
        """Return each grade with the least share of the points (0 to 1) for it, best first."""
        low, high = parse_written_number(self.passed), parse_written_number(self.best)
        gaps = max(len(self.grades) - 1, 1)
        even = [high - (high - low) * place / gaps for place in range(len(self.grades))]
        own = (self.steps.get(grade) for grade in self.grades)
        return [
            (grade, (parse_written_number(said) if said is not None else at) / 100)
            for grade, at, said in zip(self.grades, even, own, strict=True)
        ]

    def check(self) -> None:
        """Raise ``ClassError`` for values that have the right type and make no scale.

        Raises
        ------
        ClassError
            Naming the key.
        """
        if not self.grades:
            raise ClassError("grades: none")
        if unknown := {*self.steps} - {*self.grades}:
            raise ClassError(f"steps: {min(unknown)!r} is none of the grades")
        shares = [share for _, share in self.grade_bounds()]
        if shares != sorted(shares, reverse=True) or not 0 <= shares[-1] <= shares[0] <= 1:
            raise ClassError("passed, best, steps: percent, each less than the one before")
        if parse_written_number(self.round_to) < 0:
            raise ClassError("round_to: less than 0")
        if parse_written_number(self.bonus.most) < 0:
            raise ClassError("bonus.most: less than 0")

    def round_points(self, marks: Fraction) -> Fraction:
        """Return the points rounded as the scale says, exactly."""
        unit = parse_written_number(self.round_to)
        if not unit:
            return marks
        count = marks / unit
        whole = {"up": math.ceil, "down": math.floor}.get(self.rounding)
        return (whole(count) if whole else math.floor(count + Fraction(1, 2))) * unit

    def grade(self, marks: Fraction, points: Fraction) -> str:
        """Return the grade for ``marks`` of at most ``points``."""
        counted = self.round_points(marks)
        return next((g for g, share in self.grade_bounds() if counted >= share * points), self.fail)

    def count_bonus(self, bonus: Fraction, marks: Fraction, points: Fraction) -> Fraction:
        """Return how many points of a student's bonus count: never beyond the points there are.

        Parameters
        ----------
        bonus : Fraction
            Earned before the exam.
        marks, points : Fraction
            Reached in the exam, and the most that can be.
        """
        if self.bonus.needs_pass and not self.passes(self.grade(marks, points)):
            return Fraction(0)
        room = max(points - self.round_points(marks), Fraction(0))
        return min(bonus, parse_written_number(self.bonus.most), room)

    def grade_with_bonus(self, bonus: Fraction, marks: Fraction, points: Fraction) -> str:
        """Return the grade for the points of the exam and those that count of the bonus."""
        return self.grade(marks + self.count_bonus(bonus, marks, points), points)

    def passes(self, grade: str) -> bool:
        """Return whether a grade passes."""
        return grade in self.grades


def read_grade_scale(folder: Path) -> GradeScale:
    """Return the scale in the class's ``scale.toml``, else the usual German one.

    Raises
    ------
    ClassError
        Naming file and key.
    """
    path = folder / FILE
    if not path.exists():
        return GradeScale()
    table = parse_toml(read_text(path, ClassError), path, ClassError, parse_float=str)
    try:
        found = convert(table, GradeScale)
        found.check()
    except (msgspec.ValidationError, ClassError, FormulaError) as error:
        raise ClassError(f"{path}: {error}") from None
    return found
