"""Marking in the open: what every marker of a class sees, decides, takes back and settles.

Answers are read once for each run of marking; who has decided what is read from ``rulings.csv``
whenever that file has changed. Nothing is ever taken out of it: what is undone is a further line.
"""

from __future__ import annotations

import secrets
import statistics
import time
from collections import Counter
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from threading import Lock
from typing import NamedTuple

import msgspec

from quizgen.classes.agreement import SETTLED, is_settlement
from quizgen.classes.class_folder import ClassFolder, PrintedHead
from quizgen.classes.exam_details import FILE as EXAM
from quizgen.classes.exam_details import read_exam_details
from quizgen.classes.grading import GradedClassPart, StudentMarks, Submission, grade_submission
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.judged_answers import JudgedAnswers
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import lock_folder
from quizgen.classes.manual_grading import (
    AnswerGroupMember,
    DecisionCase,
    decision_cases,
    group_cases,
    undecided_answers,
)
from quizgen.classes.markers import ItemMarkers
from quizgen.classes.rubrics import (
    ItemRubric,
    RubricLine,
    default_rubric,
    read_rubric,
    split_lines,
    write_points,
    write_rubric,
)
from quizgen.classes.rulings import (
    DECIDE,
    FILE,
    SECOND,
    Ruling,
    RulingBook,
    blank_group,
    is_on_paper,
    latest_rulings,
    note_rulings,
    read_rulings,
)
from quizgen.classes.scanning.scan_folder import (
    REPORT,
    SCANS,
    TYPED,
    ScanFolder,
    find_crop,
    read_proposals,
)
from quizgen.core.errors import ClassError
from quizgen.locale import BOTH, FIRST

UNDONE, RUBRIC = "undone", "rubric"
"""Begin the reasons of decisions that restore an earlier one, or follow a line of the rubric."""
WRITTEN = frozenset({"rubric", "sketch", "derivation"})
"""Kinds whose answer may stand on paper alone, however blank the form is."""
PATIENCE = 20.0
"""Seconds that a marker waits for another command."""
SHORT = 40
"""Characters of a line's text in the reason of a decision."""
CLAIM = 120.0
"""Seconds for which an answer that one marker looks at is not the next one of another."""
PAUSE, RECENT, FEWEST = 180.0, 30, 3
"""Longest time between two decisions that is no pause, in seconds; how many, and how few, tell the
pace."""


class TakenError(ClassError):
    """Another marker decided meanwhile; ``ruling`` is what counts."""

    def __init__(self, ruling: Ruling) -> None:
        super().__init__(f"{ruling.who}: {ruling.value}")
        self.ruling = ruling


@dataclass(frozen=True)
class AnswerCard:
    """Answers that one decision may settle.

    Parameters
    ----------
    item : str
    cases : tuple of DecisionCase
        Each of equal answers.
    """

    item: str
    cases: tuple[DecisionCase, ...]

    @property
    def name(self) -> str:
        """Return the name of its first group, by which pages know it."""
        return self.cases[0].answer.group

    @property
    def groups(self) -> tuple[str, ...]:
        """Return the names of all its groups."""
        return tuple(case.answer.group for case in self.cases)

    @property
    def worth(self) -> Fraction:
        """Return the points that can be had."""
        return Fraction(self.cases[0].answer.worth)

    @property
    def students(self) -> int:
        """Return of how many students it is."""
        return sum(case.answer.students for case in self.cases)

    def is_decided(self, done: Container[str]) -> bool:
        """Return whether every group of it has been decided."""
        return all(group in done for group in self.groups)


class WrittenAnswer(NamedTuple):
    """Where one student answered: the id, and the part as that paper prints it."""

    student: str
    part: str


class AnswerIndex:
    """All answers of a class that people mark, as they were when the class was last marked.

    Parameters
    ----------
    folder : pathlib.Path
    """

    def __init__(self, folder: Path) -> None:
        self.folder = ClassFolder(folder)
        self.keys = KeyIndex(self.folder)
        lang = self.folder.settings.lang
        self.lang = FIRST if lang == BOTH else lang
        exam = read_exam_details(folder / EXAM)
        self.pseudonyms = exam is not None and exam.pseudonyms
        self.students: dict[str, list[WrittenAnswer]] = {}
        """Group to those who answered so."""
        self.numbers: dict[str, str] = {}
        """Item to the part as one of the papers prints it."""
        self.items: dict[str, list[AnswerCard]] = {}
        self.worth: dict[str, Fraction] = {}
        """Group to the points that can be had."""
        found = self._collect(list(GradingHistory(folder).current()))
        known = JudgedAnswers(folder, self.folder.settings.secret)
        for cases in group_cases(decision_cases(found, self.keys.key, self.lang, known)):
            card = AnswerCard(cases[0].answer.item, tuple(cases))
            self.items.setdefault(card.item, []).append(card)
            self.worth |= dict.fromkeys(card.groups, card.worth)
        self.items = dict(sorted(self.items.items(), key=lambda one: self._order(one[0])))
        self.on_paper = {
            self.students[case.answer.group][0]: case.answer.group
            for cards in self.items.values() for card in cards for case in card.cases
            if self.is_to_be_read(case)
        }  # fmt: skip
        """What nobody has typed and a picture shows, to the group."""
        self.proposals = read_proposals(folder)
        """What may stand there, by student and part."""
        self._names = {one.id: one.name for one in self.folder.students()}

    def _order(self, item: str) -> tuple[int, str]:
        """Return the place of an item in the order of the paper."""
        number = self.numbers[item]
        digits = number[: len(number) - len(number.lstrip("0123456789"))]
        return int(digits or 0), number

    def _collect(self, marked: Sequence[StudentMarks]) -> list[AnswerGroupMember]:
        """Return the answers that people mark, each group once; note whose they are."""
        found = {one.group: one for decided in (False, True)
                 for one in undecided_answers(marked, decided=decided)}  # fmt: skip
        for one in marked:
            for part in one.parts:
                if part.group in found:
                    here = WrittenAnswer(one.student, part.id)
                    self.students.setdefault(part.group, []).append(here)
                    self.numbers.setdefault(part.item, part.id)
        on_paper = self._find_written(marked)
        return [*(replace(one, students=len(self.students[group])) for group, one in found.items()),
                *on_paper]  # fmt: skip

    def _find_written(self, marked: Sequence[StudentMarks]) -> list[AnswerGroupMember]:
        """Return parts that were left blank in the form, while there is a picture of them."""
        found = []
        for one in marked:
            blank = [part for part in one.parts if not part.typed.strip() and part.points]
            shown = {part.id for part in blank if self.crop(one.student, part.id)}
            if not shown:
                continue
            kinds = {part.id: part.spec["kind"] for question in self.keys.key(one.student).questions
                     for part in question.parts}  # fmt: skip
            for part in blank:
                if part.id in shown and kinds[part.id] in WRITTEN:
                    group = blank_group(part.item, one.student)
                    self.students[group] = [WrittenAnswer(one.student, part.id)]
                    self.numbers.setdefault(part.item, part.id)
                    found.append(AnswerGroupMember(group, part.item, "", one.student, part.id,
                                                   part.points))  # fmt: skip
        return found

    def is_to_be_read(self, case: DecisionCase) -> bool:
        """Return whether an answer stands on a picture, and nobody had typed it."""
        typed = case.answer.typed
        return (not typed.strip() or is_on_paper(typed)) and self.crop(
            *self.students[case.answer.group][0]
        ) is not None

    def judge(self, whose: WrittenAnswer, typed: str) -> GradedClassPart:
        """Return what an answer of a student would earn, if it is all that was typed."""
        key = self.keys.key(whose.student)
        made = grade_submission(
            key, Submission(whose.student, {whose.part: typed}, key.langs[0]), RulingBook([])
        )
        return next(part for part in made.parts if part.id == whose.part)

    def head(self, student: str) -> PrintedHead:
        """Return what was printed for a student."""
        return self.keys.places[student][0]

    def crop(self, student: str, part: str) -> Path | None:
        """Return the picture of a student's part; None if there is none."""
        return find_crop(self.folder.path, self.head(student), part)

    def describe(self, student: str) -> str:
        """Return how markers see a student: by the code alone where names are to stay hidden."""
        name = self._names.get(student, "")
        return self.head(student).code if self.pseudonyms else f"{name} ({student})".lstrip()

    def find(self, item: str, group: str) -> int | None:
        """Return the place of the card of an item that holds a group; None if none does."""
        places = (place for place, card in enumerate(self.items.get(item, ()))
                  if group in card.groups)  # fmt: skip
        return next(places, None)


@dataclass(frozen=True)
class MarkingState:
    """Who has decided what: of each group the last ruling of the first and of a second marker.

    ``typed`` is what people typed beside pictures, by student and part.
    """

    rulings: tuple[Ruling, ...]
    first: Mapping[str, Ruling]
    second: Mapping[str, Ruling]
    typed: Mapping[tuple[str, str], str]

    def list_decisions(self, *, second: bool) -> Mapping[str, Ruling]:
        """Return the decisions of one of the two rounds."""
        return self.second if second else self.first

    def pace(self, who: str) -> float | None:
        """Return the seconds that a marker takes for a decision; None before there are a few."""
        times = [datetime.fromisoformat(one.when).timestamp()
                 for one in {r.step: r for r in self.rulings if _is_own_step(r, who)}.values()
                 if one.when]  # fmt: skip
        gaps = [b - a for a, b in pairwise(times) if 0 <= b - a < PAUSE]
        return statistics.fmean(gaps[-RECENT:]) if len(gaps) >= FEWEST else None


def _is_own_step(ruling: Ruling, who: str) -> bool:
    """Return whether a ruling is a decision that a marker made on an answer, and can take back."""
    made = not ruling.because or is_settlement(ruling)
    return bool(ruling.step) and ruling.who == who and made and RUBRIC not in ruling.because


@dataclass(frozen=True)
class LineChange:
    """What a change of the rubric does: the rubric after it, and the decisions that follow.

    Parameters
    ----------
    rubric : ItemRubric
    moved : tuple of (Ruling, Ruling)
        Each decision before and after.
    """

    rubric: ItemRubric
    moved: tuple[tuple[Ruling, Ruling], ...]


class MarkingDesk:
    """What all markers of a class share while the server runs.

    Parameters
    ----------
    folder : pathlib.Path
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._lock = Lock()
        self._index: tuple[object, AnswerIndex] | None = None
        self._state: tuple[object, MarkingState] | None = None
        self._claims: dict[tuple[bool, str], tuple[str, float]] = {}

    def index(self) -> AnswerIndex:
        """Return the answers; read anew after the class was marked again."""
        runs = GradingHistory(self.folder).runs()
        files = (*runs[-1:], self.folder / EXAM, self.folder / SCANS / REPORT)
        stamp = [_stamp(path) for path in files]
        with self._lock:
            if self._index is None or self._index[0] != stamp:
                self._index = stamp, AnswerIndex(self.folder)
            return self._index[1]

    def state(self) -> MarkingState:
        """Return who has decided what; read anew after somebody has."""
        stamp = _stamp(self.folder / FILE), _stamp(self.folder / SCANS / TYPED)
        with self._lock:
            if self._state is None or self._state[0] != stamp:
                rulings = tuple(read_rulings(self.folder))
                self._state = (
                    stamp,
                    MarkingState(
                        rulings,
                        latest_rulings(rulings, DECIDE),
                        latest_rulings(rulings, SECOND),
                        ScanFolder(ClassFolder(self.folder)).read_typed(),
                    ),
                )
            return self._state[1]

    def list_typed(self) -> dict[str, str]:
        """Return what was typed beside pictures since the class was marked, by the group."""
        typed, places = self.state().typed, self.index().on_paper
        return {group: typed[whose] for whose, group in places.items()
                if whose in typed and not is_on_paper(typed[whose])}  # fmt: skip

    def list_done(self, *, second: bool) -> frozenset[str]:
        """Return the groups that have been decided, or typed to be judged."""
        return frozenset({*self.state().list_decisions(second=second), *self.list_typed()})

    def type_answer(self, item: str, group: str, typed: str, who: str) -> GradedClassPart:
        """Take what somebody reads on a picture as the answer; return what it will earn.

        It counts once the class is marked again. ``see paper`` takes back what was typed.

        Raises
        ------
        ClassError
            If the answer is not to be read, or another command writes there.
        """
        index = self.index()
        place = index.find(item, group)
        whose = index.students[group][0] if place is not None else None
        if whose is None or index.on_paper.get(whose) != group:
            raise ClassError(f"{item}: nothing is to be read there")
        judged = index.judge(whose, typed)
        with lock_folder(self.folder, PATIENCE):
            ScanFolder(index.folder).take_typed((*whose, typed), who)
        return judged

    def rubric(self, item: str) -> ItemRubric:
        """Return the rubric of an item."""
        return read_rubric(self.folder, item) or self.untouched_rubric(item)

    def untouched_rubric(self, item: str) -> ItemRubric:
        """Return the rubric of an item as it is before anybody changes it."""
        return default_rubric(item, self.index().items[item][0].cases[0])

    def list_moved(self, step: str) -> list[tuple[Ruling, Ruling]]:
        """Return what a change of the rubric did: each decision before and after it."""
        rulings, found = self.state().rulings, []
        for place, one in enumerate(rulings):
            if one.step == step:
                same = (
                    r
                    for r in reversed(rulings[:place])
                    if (r.what, r.group) == (one.what, one.group)
                )
                found.append((next(same, one), one))
        return found

    def claim(self, card: AnswerCard, who: str, *, second: bool) -> None:
        """Note that a marker looks at a card, so that it is nobody else's next one."""
        self._claims[second, card.name] = who, time.monotonic()

    def is_free(self, card: AnswerCard, who: str, *, second: bool) -> bool:
        """Return whether no other marker looks at a card."""
        other, since = self._claims.get((second, card.name), (who, 0.0))
        return other == who or time.monotonic() - since > CLAIM

    def find_next(
        self, item: str, who: str, markers: ItemMarkers, *, second: bool, after: int = -1
    ) -> int | None:
        """Return the place of the next undecided card of an item; None if there is none.

        Of the own share first, from ``after`` on and then from the beginning; where all of it is
        done, that of others; last of all what another marker looks at. A second marker never gets
        what they decided themselves.
        """
        cards, state = self.index().items.get(item, []), self.state()
        done = self.list_done(second=second)
        order = [*range(after + 1, len(cards)), *range(after + 1)]
        still_open = [
            place for place in order
            if not cards[place].is_decided(done)
            and not (second and _is_decided_by(cards[place], who, state.first))
        ]  # fmt: skip

        def is_later(place: int) -> tuple[bool, bool]:
            """Return whether another marker looks at a card, and whether it is another's share."""
            own = second or markers.owns(who, place, len(cards))
            return not self.is_free(cards[place], who, second=second), not own

        return min(still_open, key=is_later, default=None)

    def decide(self, made: Sequence[Ruling], seen: Mapping[str, str]) -> str:
        """Write what a marker decided at once; return the step.

        Parameters
        ----------
        made : sequence of Ruling
        seen : mapping of str to str
            The step that stood at each group when the marker looked at it.

        Raises
        ------
        TakenError
            If somebody else decided meanwhile; nothing is written then.
        ClassError
            If a ruling cannot be, or another command writes there.
        """
        step = secrets.token_hex(4)
        with lock_folder(self.folder, PATIENCE):
            state = self.state()
            for one in made:
                now = state.list_decisions(second=one.what == SECOND).get(one.group)
                if now is not None and now.who != one.who and now.step != seen.get(one.group, ""):
                    raise TakenError(now)
            note_rulings(self.folder, (msgspec.structs.replace(one, step=step) for one in made))
        return step

    def undo(self, who: str) -> Ruling | None:
        """Take the last decision of a marker back that is not taken back yet; return one of it.

        What others have decided on the same answers since then stays. None if there is nothing.
        """
        with lock_folder(self.folder, PATIENCE):
            rulings = self.state().rulings
            for step in reversed(_list_open_steps(rulings, who)):
                made = [*_iter_restored(rulings, step, who, self._add_up)]
                if made:
                    return note_rulings(self.folder, made)[0]
        return None

    def _add_up(self, ruling: Ruling) -> str:
        """Return the points of a decision by the rubric as it is now."""
        ticked = split_lines(ruling.lines)
        if not ticked:
            return ruling.value
        worth = self.index().worth.get(ruling.group)
        total = self.rubric(ruling.item).add_up(ticked, worth or Fraction(0))
        return ruling.value if worth is None else write_points(total)

    def plan_line(self, item: str, line: RubricLine, who: str) -> LineChange:
        """Return what a changed or added line of the rubric would do; nothing is written.

        Raises
        ------
        ClassError
            If the line cannot be.
        """
        before, step = self.rubric(item), secrets.token_hex(4)
        after, state = before.replace(line, who, step), self.state()
        old = before.find(line.id)
        shown = (
            f"{old.points if old and not old.gone else '–'} → {'–' if line.gone else line.points}"
        )
        why = f"{RUBRIC}: {line.text[:SHORT]}: {shown} ({who})"
        moved = []
        for one in (*state.first.values(), *state.second.values()):
            ticked = split_lines(one.lines)
            if one.item != item or line.id not in ticked or one.group not in self.index().worth:
                continue
            value = write_points(after.add_up(ticked, self.index().worth[one.group]))
            own = one.comment.removeprefix(before.remark(ticked)).removeprefix("; ")
            comment = "; ".join(filter(None, (after.remark(ticked), own)))
            if (value, comment) != (one.value, one.comment):
                because = f"{SETTLED}, {why}" if is_settlement(one) else why
                changed = msgspec.structs.replace(
                    one, value=value, comment=comment, when="", step=step, because=because
                )
                moved.append((one, changed))
        return LineChange(after, tuple(moved))

    def change_line(self, item: str, line: RubricLine, who: str) -> LineChange:
        """Change or add a line of the rubric, and all that was decided with it.

        Raises
        ------
        ClassError
            If the line cannot be, or another command writes there.
        """
        with lock_folder(self.folder, PATIENCE):
            plan = self.plan_line(item, line, who)
            if plan.moved:  # first: a rubric without them would be noticed by nobody
                note_rulings(self.folder, [after for _, after in plan.moved])
            write_rubric(self.folder, plan.rubric)
        return plan

    def count_by_marker(self) -> Counter[str]:
        """Return how many students' answers each first marker has decided."""
        students, found = self.index().students, Counter[str]()
        for group, one in self.state().first.items():
            found[one.who] += len(students.get(group, ()))
        return +found


def _is_decided_by(card: AnswerCard, who: str, first: Mapping[str, Ruling]) -> bool:
    """Return whether a marker decided any of a card as the first one."""
    return any(group in first and first[group].who == who for group in card.groups)


def _list_open_steps(rulings: Iterable[Ruling], who: str) -> list[str]:
    """Return the decisions of a marker that are not taken back, the last one last."""
    found = dict[str, None]()
    for one in rulings:
        if one.because.startswith(UNDONE):
            found.pop(one.because.split()[1], None)
        elif _is_own_step(one, who):
            found[one.step] = None
    return [*found]


def _iter_restored(
    rulings: Sequence[Ruling], step: str, who: str, add_up: Callable[[Ruling], str]
) -> Iterable[Ruling]:
    """Yield what stands for each decision of a step once it is taken back.

    Groups that somebody else has decided since then are left out.
    """
    back = secrets.token_hex(4)
    places = [place for place, one in enumerate(rulings) if one.step == step]
    for made in (rulings[place] for place in places):
        same = [(place, one) for place, one in enumerate(rulings)
                if (one.what, one.group) == (made.what, made.group)]  # fmt: skip
        if same[-1][1].who != who:
            continue
        before = [one for place, one in same if place < places[0]]
        nothing = msgspec.structs.replace(made, value="", comment="", lines="")
        earlier = before[-1] if before and before[-1].value else nothing
        yield msgspec.structs.replace(
            earlier, value=add_up(earlier), when="", step=back, because=f"{UNDONE} {step}"
        )


def _stamp(path: Path) -> tuple[int, int] | None:
    """Return time and size of a file; None if it is not there."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size
