"""The rubric of an item: lines with points and a comment that markers tick, a file for each item.

An item has the criteria of its key as lines until somebody changes one; from then on its rubric is
``rubrics/<item>.json``, written whole, with what was changed before. What has been ticked stands in
``rulings.csv``: when a line changes, everything that was decided with it is decided again, with the
new points, as further lines there.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from datetime import UTC, datetime
from fractions import Fraction
from pathlib import Path
from urllib.parse import quote

import msgspec

from quizgen.classes.manual_grading import DecisionCase
from quizgen.core.decoding import decode_json
from quizgen.core.errors import ClassError, FormulaError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import read_bytes
from quizgen.maths.numbers import parse_written_number
from quizgen.paper.grading import round_to_quarters

FOLDER = "rubrics"
HALF = "/half"
"""End of the id of a line that is half of another one; of the two, the larger counts."""
LONGEST, MOST, MOST_POINTS = 300, 40, 100
"""Characters of a line's text and comment; lines of an item; points of a line."""
EIGHTHS = 8
"""Of points that have a short decimal: halves of quarters do."""


class RubricLine(msgspec.Struct, frozen=True, omit_defaults=True):
    """A line that markers tick.

    Parameters
    ----------
    id : str
        By which decisions know it; without blanks.
    text : str
        What is to be found in the answer.
    points : str
        Below nothing where something false is said; what they add up to is rounded to quarters.
    comment : str
        What the student reads.
    gone : bool
        Whether it was taken off: then it counts nothing.
    """

    id: str
    text: str
    points: str
    comment: str = ""
    gone: bool = False

    @property
    def worth(self) -> Fraction:
        """Return the points as an exact number; none of a line that is gone."""
        return Fraction(0) if self.gone else parse_points(self.points)

    @property
    def remark(self) -> str:
        """Return what the student reads."""
        return "" if self.gone else self.comment

    def check(self) -> None:
        """Raise ``ClassError`` if the line cannot be: no text, too long, no points.

        Raises
        ------
        ClassError
            Naming what is wrong.
        """
        if not self.text.strip() or max(len(self.text), len(self.comment)) > LONGEST:
            raise ClassError(f"text: 1 to {LONGEST} characters")
        try:
            points = parse_points(self.points)
        except FormulaError as error:
            raise ClassError(f"points: {error}") from None
        if abs(points) > MOST_POINTS:
            raise ClassError(f"points: {self.points[:40]!r}")


class RubricChange(msgspec.Struct, frozen=True, omit_defaults=True):
    """A line as it was before somebody changed it; None before it was added."""

    when: str
    who: str
    line: str
    before: RubricLine | None = None
    step: str = ""


class ItemRubric(msgspec.Struct, frozen=True):
    """The rubric of an item, as its file holds it.

    Parameters
    ----------
    item : str
    lines : tuple of RubricLine
    history : tuple of RubricChange
        The last one last.
    """

    item: str
    lines: tuple[RubricLine, ...]
    history: tuple[RubricChange, ...] = ()

    @property
    def current_lines(self) -> list[RubricLine]:
        """Return the lines that can be ticked."""
        return [one for one in self.lines if not one.gone]

    def find(self, line: str) -> RubricLine | None:
        """Return a line by its id; None if there is none."""
        return next((one for one in self.lines if one.id == line), None)

    def add_up(self, ticked: Collection[str], worth: Fraction) -> Fraction:
        """Return the points of ticked lines: at least none, at most those of the part."""
        best: dict[str, Fraction] = {}
        for one in self.lines:
            if one.id in ticked:
                name = one.id.removesuffix(HALF)
                best[name] = max(best.get(name, one.worth), one.worth)
        return round_to_quarters(max(Fraction(0), min(sum(best.values(), Fraction(0)), worth)))

    def remark(self, ticked: Collection[str]) -> str:
        """Return what students read of ticked lines."""
        return "; ".join(one.remark for one in self.lines if one.id in ticked and one.remark)

    def replace(self, line: RubricLine, who: str, step: str) -> ItemRubric:
        """Return the rubric with a line added or in place of the one with its id.

        Raises
        ------
        ClassError
            If the line cannot be, or there are too many.
        """
        line.check()
        before = self.find(line.id)
        if before is None and len(self.lines) >= MOST:
            raise ClassError(f"an item has at most {MOST} lines")
        now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
        lines = [line if one.id == line.id else one for one in self.lines]
        return ItemRubric(
            self.item,
            tuple(lines if before else [*lines, line]),
            (*self.history, RubricChange(now, who, line.id, before, step)),
        )


def parse_points(text: str) -> Fraction:
    """Return points as a person types them: with a comma, or a minus sign of either kind.

    Raises
    ------
    FormulaError
        If it is no number.
    """
    plain = text.strip().replace(",", ".").replace("\u2212", "-").lstrip("+")
    return parse_written_number(plain)


def write_points(points: Fraction) -> str:
    """Return points as the files of a class write them, such as ``0.5``."""
    return f"{float(points):g}" if points * EIGHTHS % 1 == 0 else str(points)


def default_rubric(item: str, case: DecisionCase) -> ItemRubric:
    """Return the lines of an item that nobody has changed: the criteria of its key, else all."""
    lines = [
        RubricLine(name, one.idea, write_points(points))
        for one in case.criteria
        for name, points in (
            (one.name, one.points),
            *([(one.name + HALF, one.points / 2)] if one.halves else []),
        )
    ]
    return ItemRubric(
        item, tuple(lines) or (RubricLine("all", "✓", write_points(Fraction(case.answer.worth))),)
    )


def read_rubric(folder: Path, item: str) -> ItemRubric | None:
    """Return the rubric of an item that somebody has changed; None if nobody has.

    Raises
    ------
    ClassError
        Naming the file.
    """
    path = folder / FOLDER / _build_file_name(item)
    if not path.exists():
        return None
    try:
        found = decode_json(read_bytes(path, ClassError), ItemRubric)
        for one in found.lines:
            one.check()
    except (msgspec.DecodeError, ClassError) as error:
        raise ClassError(f"{path}: {error}", rule="QG650") from None
    return found


def write_rubric(folder: Path, rubric: ItemRubric) -> None:
    """Write the rubric of an item; the caller holds the folder's lock."""
    data = msgspec.json.format(msgspec.json.encode(rubric), indent=1) + b"\n"
    write_all(folder / FOLDER, {_build_file_name(rubric.item): data}, PRIVATE)


def _build_file_name(item: str) -> str:
    """Return the name of an item's file: its slash cannot stand there."""
    return f"{quote(item, safe='')}.json"


def word_line(line: RubricLine, untouched: ItemRubric, case: DecisionCase) -> str:
    """Return the text of a line beside an answer.

    As long as nobody has worded it anew it is that of the answer's own key, for papers may ask for
    opposites.
    """
    plain = untouched.find(line.id)
    if plain is None or plain.text != line.text:
        return line.text
    own = {one.name: one.idea for one in case.criteria}
    return own.get(line.id.removesuffix(HALF), line.text)


def list_suggested_lines(case: DecisionCase, rubric: ItemRubric) -> frozenset[str]:
    """Return the lines that were recognised in an answer, as far as the rubric still has them."""
    ends = {"found": "", "follows": "", "half": HALF}
    found = (one.name + ends[one.status] for one in case.criteria if one.status in ends)
    return frozenset(found) & {one.id for one in rubric.current_lines}


def split_lines(text: str) -> frozenset[str]:
    """Return the ids in the column ``lines`` of a ruling."""
    return frozenset(text.split())


def join_lines(ids: Iterable[str], rubric: ItemRubric) -> str:
    """Return ids for the column ``lines`` of a ruling, in the order of the rubric."""
    ticked: Sequence[str] = tuple(ids)
    return " ".join(one.id for one in rubric.lines if one.id in ticked)
