"""What a person has to decide, equal and similar answers together, so that one decision does.

Answers are equal when they are the same but for blanks and, in sentences, capitals. Sentences are
similar, and one decision may settle them, when they differ only by slips in spelling and by words
that say nothing: never by a number, a negation or an opposite. What is nearest stands next. Nothing
here gives points: criteria that were recognised are a suggestion.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from pathlib import Path

import msgspec

from quizgen.classes.agreement import is_settlement
from quizgen.classes.grading import StudentMarks, item_name, stands_alone
from quizgen.classes.judged_answers import PASSING, JudgedAnswers, compute_judging_digest
from quizgen.classes.rulings import (
    DECIDE,
    SECOND,
    Ruling,
    fold_answer,
    latest_rulings,
    read_filled_rows,
)
from quizgen.core.cache import compute_digest
from quizgen.core.errors import ClassError, FormulaError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import format_csv
from quizgen.grading.judge import explain_verdict, judge_answer
from quizgen.grading.judging.spelling import (
    allowed_typos,
    fold_word,
    is_another_word,
    typo_distance,
)
from quizgen.grading.options import GradingOptions
from quizgen.kinds.rubric import RubricSpec, Status
from quizgen.maths.numbers import parse_written_number
from quizgen.paper.answer_key import AnswerKey, KeyPart
from quizgen.paper.grading import round_to_quarters

FILE = "decisions.csv"
EXAMPLES = 4
"""Examples of a criterion that stand beside it."""
SIMILAR = 85
"""Of 100, how alike the letters of two sentences are at least, before their words are compared."""
MOST_CHAINED = 2000
"""Groups of one item that are put beside the nearest."""
COLUMNS = ("item", "number", "together", "answer", "students", "key", "seen", "suggestion",
           "worth", "points", "second", "comment", "who", "group")  # fmt: skip
"""``number`` is the part as one of the papers prints it, ``points`` is for the one who marks,
``second`` for a second marker, where there is one."""

_WORD = re.compile(r"[^\s.,;:!?()\"'।/-]+")
_FILLERS = frozenset(
    ("a", "an", "the", "is", "are", "was", "were", "it", "its", "this", "that", "and", "so", "also")
)


@dataclass(frozen=True)
class AnswerGroupMember:
    """A group of equal answers to one item, with one student's as its example.

    Parameters
    ----------
    group : str
        Its name, by which rulings know it.
    item : str
    typed : str
        As one of them typed it.
    student : str
        The id of that one.
    part : str
        Its name on the paper of that one.
    worth : float
        The points that can be had.
    students : int
        How many.
    marks : float or None
        What has been decided.
    """

    group: str
    item: str
    typed: str
    student: str
    part: str
    worth: float
    students: int = 1
    marks: float | None = None


@dataclass(frozen=True)
class CriterionCase:
    """A criterion that a sentence is marked by, and what is suggested of it.

    Parameters
    ----------
    name : str
    points : Fraction
    idea : str
    accept, refuse : tuple of str
        Examples of what counts and what does not.
    halves : bool
        Whether half its points may be given.
    status : Status
    quote : str
        The clause that the suggestion goes by.
    """

    name: str
    points: Fraction
    idea: str
    accept: tuple[str, ...]
    refuse: tuple[str, ...]
    halves: bool
    status: Status
    quote: str


@dataclass(frozen=True)
class DecisionCase:
    """A group of equal answers with what helps a person to decide.

    Parameters
    ----------
    answer : AnswerGroupMember
    key : str
        The right answer.
    seen : str
        Criteria that were recognised, or why it was asked back.
    suggestion : Fraction or None
        Points that the criteria recognised would give.
    criteria : tuple of CriterionCase
        What sentences are marked by; empty for other answers.
    spots : tuple of (int, int)
        Where in the answer stands what the suggestion goes by.
    alone : bool
        Whether the same words of another student may mean another answer.
    """

    answer: AnswerGroupMember
    key: str
    seen: str
    suggestion: Fraction | None = None
    criteria: tuple[CriterionCase, ...] = ()
    spots: tuple[tuple[int, int], ...] = ()
    alone: bool = False

    @property
    def sentence(self) -> bool:
        """Whether sentences are asked for."""
        return bool(self.criteria)


def undecided_answers(
    marked: Iterable[StudentMarks], *, decided: bool = False
) -> list[AnswerGroupMember]:
    """Return the groups of equal answers that await a decision, by item, the largest first.

    Parameters
    ----------
    marked : iterable of StudentMarks
    decided : bool
        Those that somebody has decided on instead, for a second marker.
    """
    found: dict[str, AnswerGroupMember] = {}
    for one in marked:
        for part in one.parts:
            if not part.group or part.needs_decision == decided or not part.points:
                continue
            before = found.get(part.group)
            found[part.group] = (
                replace(before, students=before.students + 1)
                if before
                else AnswerGroupMember(part.group, part.item, part.typed, one.student, part.id,
                            part.points, 1, part.marks)
            )  # fmt: skip
    return sorted(found.values(), key=lambda one: (one.item, -one.students, one.typed))


def decision_cases(
    answers: Iterable[AnswerGroupMember],
    key_of: Callable[[str], AnswerKey],
    lang: str,
    known: JudgedAnswers | None = None,
) -> list[DecisionCase]:
    """Return each group of answers with the key and what helps to decide, in the same order.

    Parameters
    ----------
    answers : iterable of AnswerGroupMember
    key_of : callable
        The key of a student's paper.
    lang : str
        Of what is said about them.
    known : JudgedAnswers, optional
        What was said of them before, and to keep it in.
    """
    asked = list(answers)

    @lru_cache(maxsize=1)
    def parts(student: str) -> dict[str, KeyPart]:
        """Return the parts of a student's key by item; one student is read at a time."""
        return {
            item_name(one, part): part for one in key_of(student).questions for part in one.parts
        }

    by_student = sorted(range(len(asked)), key=lambda at: asked[at].student)
    found = {}
    for at in by_student:
        answer = asked[at]
        part = parts(answer.student)[answer.item]
        found[at] = (
            _recall_review_case(answer, part, lang, known)
            if known
            else _build_review_case(answer, part, lang)[0]
        )
    return [found[at] for at in range(len(asked))]


def prepare_cases(
    key: AnswerKey, marked: StudentMarks, lang: str, done: set[str]
) -> Iterator[tuple[str, DecisionCase]]:
    """Yield what helps to decide on the answers of one student, with names to keep it under.

    Names in ``done`` are left out, and noted there. Processes that mark prepare it beside the
    marks; ``decision_cases`` then finds it.
    """
    parts = {item_name(one, part): part for one in key.questions for part in one.parts}
    for answer in undecided_answers([marked]):
        name = _name_case(answer, parts[answer.item], lang)
        if name in done:
            continue
        done.add(name)
        case, note = _build_review_case(answer, parts[answer.item], lang)
        if note not in PASSING:
            yield name, case


def _name_case(answer: AnswerGroupMember, part: KeyPart, lang: str) -> str:
    """Return the name of a case: all that it follows from."""
    said = msgspec.json.encode((lang, part, answer.item, answer.typed, answer.worth))
    return compute_digest(compute_judging_digest(), b"case", said)


def _recall_review_case(
    answer: AnswerGroupMember, part: KeyPart, lang: str, known: JudgedAnswers
) -> DecisionCase:
    """Return the case of an answer, as it was built before if nothing has changed."""
    name = _name_case(answer, part, lang)
    case = known.get(name, DecisionCase)
    if case is not None:
        return replace(case, answer=answer)
    case, note = _build_review_case(answer, part, lang)
    if note not in PASSING:
        known.keep(name, case)
    return case


def _build_review_case(
    answer: AnswerGroupMember, part: KeyPart, lang: str
) -> tuple[DecisionCase, str]:
    """Return an answer with its key, the criteria recognised, and the points they suggest.

    Beside it stands the note of the verdict, if it was judged once more.
    """
    spec = part.parse_spec(proven=True)
    alone = stands_alone(part.spec["kind"], answer.typed)
    if not isinstance(spec, RubricSpec):
        judged = judge_answer(spec, answer.typed, GradingOptions(lang))
        verdict = explain_verdict(spec, judged, lang)
        share = verdict.fields.get("share")  # of a derivation whose reasons a person reads
        worth = share * Fraction(answer.worth) if isinstance(share, Fraction) else None
        suggested = None if worth is None else round_to_quarters(worth)
        shown = spec.show_in(lang)
        return DecisionCase(answer, shown, verdict.message, suggested, alone=alone), judged.note
    made, ideas = spec.suggest(answer.typed), spec.list_ideas(lang)
    scale = Fraction(answer.worth) / parse_written_number(spec.full)
    criteria = tuple(
        CriterionCase(
            found.name,
            one.worth * scale,
            ideas.get(found.name, found.name),
            tuple(one.accept[:EXAMPLES]),
            tuple(one.refuse[:EXAMPLES]),
            bool(one.half),
            found.status,
            found.quote,
        )
        for found, one in zip(made.findings, spec.criteria.values(), strict=True)
    )
    suggested = round_to_quarters(made.points * scale)
    shown = "; ".join(f"{one.name}: {one.status}" for one in made.findings)
    key = spec.show_in(lang)
    return DecisionCase(answer, key, shown, suggested, criteria, made.spots, alone), ""


def group_cases(found: Iterable[DecisionCase]) -> list[list[DecisionCase]]:
    """Return cases that one decision may settle together, in the order to be read.

    Large groups first, then always the most similar one.
    """
    groups: dict[tuple[object, ...], dict[str, list[DecisionCase]]] = {}
    for case in found:
        words = _extract_comparable_words(case)
        whose = case.answer.group if case.alone else ""
        about = (case.answer.item, case.key, case.seen if case.sentence else "", whose)
        leaders = groups.setdefault(about, {})
        leaders.setdefault(
            _find_group_leader(words, leaders.keys()) if case.sentence else words, []
        ).append(case)
    items: dict[str, list[list[DecisionCase]]] = {}
    for (item, *_), leaders in groups.items():
        items.setdefault(str(item), []).extend(leaders.values())
    return [group for _, own in sorted(items.items()) for group in _order_by_similarity(own)]


def _extract_comparable_words(case: DecisionCase) -> str:
    """Return what is compared of an answer: of a sentence its words without fillers."""
    text = fold_answer(case.answer.typed, words=case.sentence)
    if not case.sentence:
        return text
    return " ".join(word for word in _WORD.findall(text) if word not in _FILLERS)


def _find_group_leader(words: str, leaders: Iterable[str]) -> str:
    """Return the group's first answer that ``words`` resemble; ``words`` if there is none."""
    from rapidfuzz import fuzz, process

    near = process.extract(words, leaders, scorer=fuzz.ratio, score_cutoff=SIMILAR, limit=5)
    return next((other for other, *_ in near if _is_misspelt_sentence(words, other)), words)


def _is_misspelt_sentence(one: str, other: str) -> bool:
    """Return whether two sentences differ by misspellings alone, word by word."""
    pairs = list(zip(one.split(), other.split(), strict=False))
    same_length = len(one.split()) == len(other.split())
    return same_length and all(a == b or _is_misspelling(a, b) for a, b in pairs)


def _is_misspelling(one: str, other: str) -> bool:
    """Return whether one word is the other misspelt, and not another word."""
    most = min(allowed_typos(fold_word(one)), allowed_typos(fold_word(other)))
    return typo_distance(fold_word(one), fold_word(other), most) <= most and not is_another_word(
        one, other, ()
    )


def _order_by_similarity(groups: list[list[DecisionCase]]) -> list[list[DecisionCase]]:
    """Return an item's groups: the largest first, then always the most similar to the last."""
    from rapidfuzz import fuzz, process

    left = sorted(groups, key=lambda group: -_count_students(group))
    if len(left) > MOST_CHAINED:
        return left
    texts = dict(enumerate(_extract_comparable_words(group[0]) for group in left))
    order = [0]
    while len(order) < len(left):
        text = texts.pop(order[-1])
        order.append(process.extractOne(text, texts, scorer=fuzz.token_sort_ratio)[2])
    return [left[at] for at in order]


def _count_students(group: Iterable[DecisionCase]) -> int:
    """Return the number of students in a group."""
    return sum(case.answer.students for case in group)


def write_queue(
    folder: Path, groups: Iterable[list[DecisionCase]], kept: Mapping[str, str]
) -> Path:
    """Write the undecided answers to ``decisions.csv`` for a spreadsheet; return its path.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    groups : iterable of list of DecisionCase
    kept : mapping of str to str
        Comments that stand there already, by group.
    """
    rows = (
        _format_table_row(case, number, kept)
        for number, group in enumerate(groups, 1)
        for case in group
    )
    text = format_csv([COLUMNS, *rows])
    return write_all(folder, {FILE: text.encode("utf-8-sig")}, PRIVATE)[0]


def _format_table_row(case: DecisionCase, number: int, kept: Mapping[str, str]) -> list[str]:
    """Return the cells of a case, in the order of ``COLUMNS``."""
    answer = case.answer
    suggested = "" if case.suggestion is None else f"{float(case.suggestion):g}"
    return [answer.item, answer.part, str(number), answer.typed, str(answer.students), case.key,
            case.seen, suggested, f"{answer.worth:g}", "", "", kept.get(answer.group, ""), "",
            answer.group]  # fmt: skip


def read_queue(folder: Path) -> tuple[list[Ruling], dict[str, str]]:
    """Return the decisions filled in as rulings, and the comments on open groups, by group.

    Points in the first row of what stands together hold for its rows that are empty.

    Raises
    ------
    ClassError
        Naming file, line and column.
    """
    path = folder / FILE
    tables = read_filled_rows(path, {"item", "together", "points", "group"})
    found = [
        one for column in ("points", "second") for one in _iter_filled_rulings(tables, column, path)
    ]
    settled = {one.group for one in found}
    kept = {c["group"]: c.get("comment", "") for _, c in tables if c["group"] not in settled}
    return found, kept


def _iter_filled_rulings(
    tables: Iterable[tuple[int, Mapping[str, str]]], column: str, path: Path
) -> Iterator[Ruling]:
    """Yield the rulings filled in one column: ``points`` or ``second``.

    An empty row takes the points of the first row with the same number in ``together``.
    """
    first: dict[str, Mapping[str, str]] = {}
    for at, cells in tables:
        said = cells if cells.get(column, "").strip() else first.get(cells["together"], cells)
        first.setdefault(cells["together"], cells)
        points = said.get(column, "").strip().replace(",", ".")
        if not points or points == "-":
            continue
        what = DECIDE if column == "points" else SECOND
        made = Ruling(
            what,
            cells["item"],
            cells.get("answer", ""),
            points,
            who=said.get("who", ""),
            comment=said.get("comment", ""),
            group=cells["group"],
        )
        try:
            made.check()
            check_points(made, cells.get("worth", ""))
        except (ClassError, FormulaError) as error:
            raise ClassError(f"{path}: line {at}: {column}: {error}") from None
        yield made


def check_points(ruling: Ruling, worth: str) -> None:
    """Raise ``ClassError`` if a ruling gives more points than the part is worth.

    Raises
    ------
    ClassError
        If there are more.
    """
    points = ruling.points
    if points is not None and worth and points > parse_written_number(worth):
        raise ClassError(f"{float(points):g} points of {worth}")


@dataclass(frozen=True)
class Agreement:
    """How far two markers agree.

    Parameters
    ----------
    answers : int
        Groups of answers that both have marked.
    kappa : float or None
        Cohen's, unweighted, over points.
    apart : tuple of (Ruling, Ruling)
        Where they differ.
    """

    answers: int
    kappa: float | None
    apart: tuple[tuple[Ruling, Ruling], ...]


def marker_agreement(rulings: Sequence[Ruling]) -> Agreement:
    """Return the agreement of first and second marker, by their last ruling on each group."""
    first = latest_rulings((one for one in rulings if not is_settlement(one)), DECIDE)
    second = latest_rulings(rulings, SECOND)
    both = [(one, second[group]) for group, one in first.items() if group in second]
    said = [(a.points, b.points) for a, b in both]
    apart = tuple(pair for pair, (a, b) in zip(both, said, strict=True) if a != b)
    return Agreement(len(both), cohens_kappa(said), apart)


def cohens_kappa(pairs: Sequence[tuple[Hashable, Hashable]]) -> float | None:
    """Return Cohen's kappa of two markers, -1 to 1; None if it is not determined.

    Parameters
    ----------
    pairs : sequence
        What each of them said of one answer.
    """
    if not pairs:
        return None
    agreed = sum(a == b for a, b in pairs) / len(pairs)
    one, other = Counter(a for a, _ in pairs), Counter(b for _, b in pairs)
    by_chance = sum(count * other[said] for said, count in one.items()) / len(pairs) ** 2
    return None if by_chance == 1 else (agreed - by_chance) / (1 - by_chance)
