"""What people decided: ``rulings.csv``, a line for each decision, only ever added to.

Later lines count. ``item`` is a part of a template (``a-question/b``), which all papers
of a class share whatever their numbers.

========== ============================== ==========================================
what       of                             and
========== ============================== ==========================================
decide     a group of equal answers       its points; none: nobody has decided after all
second     the same, by a second marker   the points that this one would give
accept     an answer, or ``trap:NAME``    its points, all if left out; never fewer than without
points     an item of one student         its points, whatever stands there, or nothing
tolerance  an item                        ``rel=0.05``, ``abs=0.1``, ``decimals=2``, ``sigfigs=3``
drop       an item                        counts for nobody whom it would not help; ``always``
give       an item                        all the points for everybody who had it
restore    an item                        undoes these five; decisions on its answers stay
use        a file of one student          its answers count, where others differ
========== ============================== ==========================================

With a student's id in ``student`` a line is about that student alone.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from fractions import Fraction
from itertools import zip_longest
from pathlib import Path

import msgspec

from quizgen.classes.lock import lock_folder
from quizgen.core.errors import ClassError, FormulaError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.spreadsheets import iter_spreadsheet_rows
from quizgen.core.untrusted import format_csv, read_bytes, unescape_csv_formula
from quizgen.locale.word_patterns import WordPattern
from quizgen.maths.numbers import parse_written_number
from quizgen.paper.grading import QUARTERS

FILE = "rulings.csv"
DECIDE, SECOND, ACCEPT, POINTS, TOLERANCE, DROP, GIVE, RESTORE, USE = WHAT = (
    "decide", "second", "accept", "points", "tolerance", "drop", "give", "restore", "use"
)  # fmt: skip
ALWAYS = "always"
"""Value of a ``drop`` that counts for those, too, who reached a larger share of the item's points
than of the others."""
TRAP = "trap:"
"""Before the name of a known mistake, in place of an answer."""
OF_ONE = frozenset({POINTS, USE})
"""What is about one student."""
LONGEST = 10_000
"""Characters of a cell."""
_ON_PAPER = WordPattern(r"\W*(?:«see»\s+(?:«see-which»\s+)?«see-where»|«see-there»)")
"""Words of whoever copies answers from paper."""
_ENDS = " .,;:!?।"
_TOLERANCE = re.compile(r"(decimals|sigfigs)\s*=\s*(\d{1,2})|(rel|abs)\s*=\s*(\d+(?:[./]\d+)?)")


class Ruling(msgspec.Struct, frozen=True):
    """What a person decided: a line of ``rulings.csv``.

    Parameters
    ----------
    what : str
        One of ``WHAT``.
    item : str
    answer : str
        As it was typed, or the name of a mistake.
    value : str
        Points, or a tolerance.
    student : str
        The id of the one whom it is about; empty for all.
    who, when, comment : str
    group : str
        The group of equal answers, as the queue names it.
    lines : str
        Ids of the rubric's lines that the points are made of, separated by blanks.
    step : str
        What was decided at once bears one name, by which it is undone.
    because : str
        Why it stands here, if nobody gave these points to this answer: a line of the rubric was
        changed, a step was undone, two markers settled what they differed in.
    """

    what: str
    item: str
    answer: str = ""
    value: str = ""
    student: str = ""
    who: str = ""
    when: str = ""
    comment: str = ""
    group: str = ""
    lines: str = ""
    step: str = ""
    because: str = ""

    @property
    def points(self) -> Fraction | None:
        """Return the points of the ruling; None if it names none."""
        return parse_written_number(self.value) if self.value else None

    @property
    def is_revoked(self) -> bool:
        """Whether the ruling takes an earlier decision back."""
        return self.what == DECIDE and not self.value

    @property
    def describe(self) -> str:
        """Return the kind of ruling and its author, for the history of a mark."""
        told = f"{self.what} ({self.who})" if self.who else self.what
        return f"{told}, {self.because}" if self.because else told

    def check(self) -> None:
        """Raise ``ClassError`` naming the column if the ruling cannot be applied.

        Raises
        ------
        ClassError
            Naming the column.
        """
        if self.what not in WHAT:
            raise ClassError(f"what: {self.what[:40]!r} (there are {', '.join(WHAT)})")
        if not self.item:
            raise ClassError("item: missing")
        if self.what in OF_ONE and not self.student:
            raise ClassError(f"student: missing ({self.what} is about one)")
        if self.answer and self.what not in {DECIDE, SECOND, ACCEPT}:
            raise ClassError(f"answer: {self.what} is about none (accept and decide are)")
        self._check_value()

    def _check_value(self) -> None:
        """Raise ``ClassError`` unless the value is what this kind of ruling takes."""
        if self.what == TOLERANCE:
            if not _TOLERANCE.fullmatch(self.value):
                raise ClassError(f"value: {self.value[:40]!r} (rel=0.05, abs=0.1, decimals=2, ...)")
        elif self.what in {DECIDE, SECOND, ACCEPT, POINTS}:
            self._check_points()
        elif self.value and (self.what, self.value) != (DROP, ALWAYS):
            raise ClassError(
                f"value: {self.what} takes none (points --student ID --value P gives some of them)"
            )

    def _check_points(self) -> None:
        """Raise ``ClassError`` unless there is an answer, and points in quarters if any."""
        if self.what != POINTS and not (self.answer or self.group):
            raise ClassError("answer: missing")
        if self.what == POINTS and not self.value:
            raise ClassError("value: missing (how many points)")
        try:
            points = self.points
        except FormulaError as error:
            raise ClassError(f"value: {error}") from None
        if points is not None and (points < 0 or points * QUARTERS % 1):
            raise ClassError(f"value: {self.value[:40]!r} (points, in quarters)")

    def check_worth(self, worth: float) -> None:
        """Raise ``ClassError`` if the ruling gives more points than its item is worth.

        Raises
        ------
        ClassError
            If there are more.
        """
        points = None if self.what == TOLERANCE else self.what != DROP and self.points
        if points and points > Fraction(worth):
            raise ClassError(f"value: {float(points):g} points of {worth:g}")

    def tolerance(self) -> dict[str, int | str]:
        """Return the tolerance as keys of a specification, such as ``{"rel": "0.05"}``."""
        found = _TOLERANCE.fullmatch(self.value)
        if found is None:
            return {}
        return {found[1]: int(found[2])} if found[1] else {found[3]: found[4]}


COLUMNS = ("when", "who", "what", "item", "answer", "value", "student", "comment", "group",
           "lines", "step", "because")  # fmt: skip
_HEAD = ",".join(COLUMNS).encode()


def read_rulings(folder: Path) -> list[Ruling]:
    """Return all rulings of a class, in order.

    Raises
    ------
    ClassError
        Naming file, line and column.
    """
    path = folder / FILE
    rows = read_filled_rows(path, {"what", "item"})
    return [_parse_ruling(cells, f"{path}: line {at}") for at, cells in rows]


def read_filled_rows(path: Path, needed: set[str]) -> list[tuple[int, dict[str, str]]]:
    """Return line number and cells by column of each row; none if there is no file.

    Parameters
    ----------
    path : pathlib.Path
    needed : set of str
        Columns without which it says nothing.

    Raises
    ------
    ClassError
        Naming the file and the line or the column.
    """
    if not path.exists():
        return []
    rows = [*iter_spreadsheet_rows(path, ClassError)]
    head = [cell.strip().lower() for cell in rows[0][1]] if rows else []
    if missing := needed - {*head}:
        raise ClassError(f"{path}: the first row names no column {min(missing)!r}")
    return [
        (at, dict(zip_longest(head, map(unescape_csv_formula, row[: len(head)]), fillvalue="")))
        for at, row in rows[1:]
    ]


def _parse_ruling(cells: Mapping[str, str], where: str) -> Ruling:
    """Return the ruling of a row; ``ClassError`` located by ``where`` if it cannot be applied."""
    known = {name: cells.get(name, "").strip()[:LONGEST] for name in COLUMNS}
    found = Ruling(**known)
    try:
        found.check()
    except ClassError as error:
        raise ClassError(f"{where}: {error}") from None
    return found


def append_rulings(folder: Path, rulings: Iterable[Ruling]) -> list[Ruling]:
    """Append rulings with the current time, under the folder's lock; return them as written.

    Raises
    ------
    ClassError
        If one of them says nothing that can be done, or another command writes there.
    """
    with lock_folder(folder):
        return note_rulings(folder, rulings)


def note_rulings(folder: Path, rulings: Iterable[Ruling]) -> list[Ruling]:
    """Append rulings as ``append_rulings`` does, where the caller holds the lock."""
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
    added = [msgspec.structs.replace(one, when=one.when or now) for one in rulings]
    for one in added:
        one.check()
    path = folder / FILE
    before = read_bytes(path, ClassError) if path.exists() else format_csv([COLUMNS]).encode()
    end = b"" if before.endswith(b"\n") else b"\n"  # somebody has edited it
    if not before.startswith(_HEAD):  # a spreadsheet has saved it with other signs or columns
        before, end = _format_rulings(read_rulings(folder), COLUMNS), b""
    write_all(folder, {FILE: before + end + _format_rulings(added)}, PRIVATE)
    return added


def _format_rulings(rulings: Iterable[Ruling], *above: Iterable[str]) -> bytes:
    """Return rulings as lines of ``rulings.csv``; ``above`` are rows that stand before them."""
    rows = [[getattr(one, name) for name in COLUMNS] for one in rulings]
    return format_csv([*above, *rows]).encode()


def fold_answer(answer: str, *, words: bool) -> str:
    """Return the answer in the form that equal answers share.

    Parameters
    ----------
    answer : str
    words : bool
        Whether it is a sentence, in which case capitals and the sign at the end do not matter.
    """
    text = " ".join(unicodedata.normalize("NFKC", answer).split())
    return text.casefold().strip(_ENDS) if words else text


def is_on_paper(answer: str) -> bool:
    """Return whether an answer only says that the real one stands on the student's paper."""
    return _ON_PAPER.match(unicodedata.normalize("NFKC", answer).casefold()) is not None


def answer_group(item: str, key: str, answer: str, *, words: bool) -> str:
    """Return the name of a group of equal answers: ``g`` and ten hexadecimal digits.

    One item may have other keys on other papers, so ``key`` (the right answer as text) parts
    groups, too. With ``words`` the answer is a sentence, compared as in ``fold_answer``.
    """
    whole = "\0".join((item, key, fold_answer(answer, words=words)))
    return f"g{hashlib.sha256(whole.encode()).hexdigest()[:10]}"


def blank_group(item: str, student: str) -> str:
    """Return the name of what one student left blank in the form, but may have put on paper."""
    return answer_group(item, f"\0{student}", "", words=False)


def latest_rulings(rulings: Iterable[Ruling], what: str) -> dict[str, Ruling]:
    """Return the last ruling of a kind for each group, without those taken back."""
    last = {one.group: one for one in rulings if one.what == what and one.group}
    return {group: one for group, one in last.items() if one.value}


def find_files_in_use(rulings: Iterable[Ruling]) -> dict[str, str]:
    """Return the file whose answers shall count, of each student of whom somebody said so."""
    return {one.student: one.item for one in rulings if one.what == USE}


class RulingBook:
    """All rulings but those of a second marker and those on files, indexed by item.

    Parameters
    ----------
    rulings : iterable of Ruling
        In order.
    """

    def __init__(self, rulings: Iterable[Ruling]) -> None:
        self.items: dict[str, list[Ruling]] = {}
        for one in rulings:
            if one.what not in {SECOND, USE}:
                self.items.setdefault(one.item, []).append(one)

    def rulings_for(self, item: str, student: str) -> list[Ruling]:
        """Return the rulings in force for an item and a student, the last one last."""
        found: list[Ruling] = []
        for one in self.items.get(item, ()):
            if one.student not in {"", student}:
                continue
            if one.what == RESTORE:
                found = [kept for kept in found if kept.what == DECIDE]
            else:
                found.append(one)
        return found

    def find_drop(self, item: str, student: str) -> Ruling | None:
        """Return the ruling that drops an item for a student; None if it counts."""
        whole = [one for one in self.rulings_for(item, student) if one.what in {DROP, GIVE, POINTS}]
        return whole[-1] if whole and whole[-1].what == DROP else None
