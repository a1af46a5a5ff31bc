"""Marking attempts: what was responded as it would have been typed, judged part by part."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from msgspec import structs

from quizgen.grading.options import GradingOptions
from quizgen.kinds.contract import InputBox, InputControl
from quizgen.maths.notation import FormulaReadError
from quizgen.paper.grading import PaperResult, PartResult, QuestionGrader
from quizgen.practice.input_fields import join_fields
from quizgen.responses.attempts import Attempt, Response
from quizgen.responses.keys import Entry, Kept, Keys, Shape
from quizgen.responses.qti import variables
from quizgen.responses.summaries import Values, fields

Typed = str | FormulaReadError


@dataclass(frozen=True, slots=True)
class Marked:
    """An attempt with its marks.

    Parameters
    ----------
    attempt : Attempt
    number : int
        Which attempt of that person it is, from 1.
    result : PaperResult
    questions : mapping
        The id of the question that stood at each number of the quiz.
    foreign : tuple of str
        Numbers of questions that are not in the keys.
    """

    attempt: Attempt
    number: int
    result: PaperResult
    questions: Mapping[str, str]
    foreign: tuple[str, ...]


def marked(
    keys: Keys, attempts: Iterable[Attempt], lang: str | None = None, *, settle: bool = False
) -> Iterator[Marked]:
    """Mark attempts one after another.

    Parameters
    ----------
    keys : Keys
    attempts : iterable of Attempt
    lang : str, optional
        Language of the remarks; else that of each question.
    settle : bool
        As of ``quizgen.paper.grading.mark_paper``.

    Raises
    ------
    KeyFileError
        If a key is wrong (never because of what was responded).
    """
    seen = Counter[tuple[str, str]]()
    for attempt in attempts:
        seen[attempt.who] += 1
        yield _marked(keys, attempt, seen[attempt.who], GradingOptions(lang or "", settle=settle))


def _marked(keys: Keys, attempt: Attempt, number: int, options: GradingOptions) -> Marked:
    found = given(keys, attempt)
    parts = [part for one in found.questions for part in _parts(one, options)]
    places = [*found.places]
    parts.sort(key=lambda part: places.index(part.number))
    return Marked(attempt, number, PaperResult("", tuple(parts)), found.places, found.foreign)


@dataclass(frozen=True, slots=True)
class Given:
    """What an attempt holds, question by question.

    Parameters
    ----------
    questions : tuple of (Kept, mapping)
        A question, and by part the number where it stood and what would have been typed.
    places : mapping
        The id of the question that stood at each number of the quiz.
    foreign : tuple of str
        Numbers of questions that are not in the keys.
    """

    questions: tuple[tuple[Kept, Mapping[str, tuple[str, Typed]]], ...]
    places: Mapping[str, str]
    foreign: tuple[str, ...]


def given(keys: Keys, attempt: Attempt) -> Given:
    """Sort what was responded by the questions that it is about, of which some were asked apart."""
    known: dict[str, tuple[Kept, dict[str, tuple[str, Typed]]]] = {}
    places: dict[str, str] = {}
    foreign: list[str] = []
    for one in attempt.responses:
        if one.question not in keys.found:
            foreign.append(one.number or one.question)
            continue
        kept, entry = keys.found[one.question]
        place = kept.slot if kept.slot not in places else entry.id
        response = replace(one, number=one.number or place)
        typed = known.setdefault(kept.id, (kept, {}))[1]
        for name, text in _typed(kept, entry, response).items():
            typed[name] = (response.number, text)
        places[response.number] = entry.id
    return Given(tuple(known.values()), places, tuple(foreign))


def _parts(
    question: tuple[Kept, Mapping[str, tuple[str, Typed]]], options: GradingOptions
) -> Iterator[PartResult]:
    """The parts of one question, which a system may have asked as several."""
    kept, typed = question
    marker = QuestionGrader(kept.key, structs.replace(options, lang=options.lang or kept.lang))
    for part in kept.key.parts:
        if part.id in typed:
            number, text = typed[part.id]
            done = (
                marker.ask_back(part, text.found, text)
                if isinstance(text, FormulaReadError)
                else marker.grade_part(part, text)
            )
            label = part.id.removeprefix(kept.key.number)
            between = "" if number[-1:].isdigit() or not label else "."
            yield structs.replace(done, id=f"{number}{between}{label}", number=number)


def _typed(kept: Kept, entry: Entry, response: Response) -> dict[str, Typed]:
    """Part to what it was answered with, in one line."""
    found: dict[str, list[Values | FormulaReadError]] = {}
    stems: dict[str, list[str]] = {}
    given = response.given
    read = fields(entry, given) if isinstance(given, str) else variables(entry, given)
    for ask, values in zip(entry.asks, read, strict=True):
        found.setdefault(ask.part, []).append(values)
        stems[ask.part] = list(ask.options)
    return {part: _line(kept.shapes[part], values, stems[part]) for part, values in found.items()}


def _line(shape: Shape, values: list[Values | FormulaReadError], stems: list[str]) -> Typed:
    filled: list[str] = []
    for one in values:
        if isinstance(one, FormulaReadError):
            return one
        filled += one if len(values) == 1 else one or [""]
    control = InputControl(shape.form, boxes=tuple(map(InputBox, shape.names)), named=shape.named)
    return join_fields(control, filled, stems)
