"""Grades attempts: each response as it would have been typed, judged part by part."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from msgspec import structs

from quizgen.grading.options import GradingOptions
from quizgen.kinds.contract import InputBox, InputControl
from quizgen.lms.attempts import QuizAttempt, Response
from quizgen.lms.manifest import ExportManifest, ManifestItem, ManifestQuestion, ResponseShape
from quizgen.lms.moodle_summaries import FieldValues, parse_summary
from quizgen.lms.qti.results import qti_field_values
from quizgen.maths.notation import FormulaReadError
from quizgen.paper.grading import PaperResult, PartResult, QuestionGrader
from quizgen.practice.input_fields import join_fields

Typed = str | FormulaReadError


@dataclass(frozen=True, slots=True)
class GradedAttempt:
    """An attempt with its marks.

    Parameters
    ----------
    attempt : QuizAttempt
    number : int
        Which attempt of that person it is, from 1.
    result : PaperResult
    questions : mapping
        Number in the quiz to the id of the question.
    foreign : tuple of str
        Numbers of questions that are not in the manifest.
    """

    attempt: QuizAttempt
    number: int
    result: PaperResult
    questions: Mapping[str, str]
    foreign: tuple[str, ...]


def grade_attempts(
    manifest: ExportManifest,
    attempts: Iterable[QuizAttempt],
    lang: str | None = None,
    *,
    settle: bool = False,
) -> Iterator[GradedAttempt]:
    """Yield attempts with their marks, one after another.

    Parameters
    ----------
    manifest : ExportManifest
    attempts : iterable of QuizAttempt
    lang : str, optional
        Of the feedback; else that of each question.
    settle : bool
        As of ``quizgen.paper.grading.mark_paper``.

    Raises
    ------
    KeyFileError
        If a key is wrong (never because of a response).
    """
    seen = Counter[tuple[str, str]]()
    for attempt in attempts:
        seen[attempt.person_key] += 1
        yield _grade_attempt(
            manifest, attempt, seen[attempt.person_key], GradingOptions(lang or "", settle=settle)
        )


def _grade_attempt(
    manifest: ExportManifest, attempt: QuizAttempt, number: int, options: GradingOptions
) -> GradedAttempt:
    """Return an attempt with its marks; ``number`` counts that person's attempts from 1."""
    found = sort_responses(manifest, attempt)
    parts = [part for one in found.items for part in _grade_parts(one, options)]
    places = [*found.places]
    parts.sort(key=lambda part: places.index(part.number))
    return GradedAttempt(
        attempt, number, PaperResult("", tuple(parts)), found.places, found.foreign
    )


@dataclass(frozen=True, slots=True)
class SortedResponses:
    """The responses of an attempt, item by item.

    Parameters
    ----------
    items : tuple of (ManifestItem, mapping)
        An item, and by part its number in the quiz and what would have been typed.
    places : mapping
        Number in the quiz to the id of the question.
    foreign : tuple of str
        Numbers of questions that are not in the manifest.
    """

    items: tuple[tuple[ManifestItem, Mapping[str, tuple[str, Typed]]], ...]
    places: Mapping[str, str]
    foreign: tuple[str, ...]


def sort_responses(manifest: ExportManifest, attempt: QuizAttempt) -> SortedResponses:
    """Return the responses by item: a system may have asked its parts as several questions."""
    found: dict[str, tuple[ManifestItem, dict[str, tuple[str, Typed]]]] = {}
    places: dict[str, str] = {}
    foreign: list[str] = []
    for one in attempt.responses:
        if one.question not in manifest.found:
            foreign.append(one.number or one.question)
            continue
        item, question = manifest.found[one.question]
        place = item.slot if item.slot not in places else question.id
        response = replace(one, number=one.number or place)
        typed = found.setdefault(item.id, (item, {}))[1]
        for name, text in _typed_by_part(item, question, response).items():
            typed[name] = (response.number, text)
        places[response.number] = question.id
    return SortedResponses(tuple(found.values()), places, tuple(foreign))


def _grade_parts(
    responses: tuple[ManifestItem, Mapping[str, tuple[str, Typed]]], options: GradingOptions
) -> Iterator[PartResult]:
    """Yield the graded parts of an item; a system may have asked them as several questions."""
    item, typed = responses
    marker = QuestionGrader(item.key, structs.replace(options, lang=options.lang or item.lang))
    for part in item.key.parts:
        if part.id in typed:
            number, text = typed[part.id]
            done = (
                marker.ask_back(part, text.found, text)
                if isinstance(text, FormulaReadError)
                else marker.grade_part(part, text)
            )
            label = part.id.removeprefix(item.key.number)
            between = "" if number[-1:].isdigit() or not label else "."
            yield structs.replace(done, id=f"{number}{between}{label}", number=number)


def _typed_by_part(
    item: ManifestItem, question: ManifestQuestion, response: Response
) -> dict[str, Typed]:
    """Return what would have been typed in one line for each part of a response."""
    found: dict[str, list[FieldValues | FormulaReadError]] = {}
    stems: dict[str, list[str]] = {}
    given = response.given
    if isinstance(given, str):
        responses = parse_summary(question, given)
    else:
        responses = qti_field_values(question, given)
    for field, values in zip(question.asks, responses, strict=True):
        found.setdefault(field.part, []).append(values)
        stems[field.part] = list(field.options)
    return {
        part: _typed_line(item.shapes[part], values, stems[part]) for part, values in found.items()
    }


def _typed_line(
    shape: ResponseShape, values: list[FieldValues | FormulaReadError], stems: list[str]
) -> Typed:
    """Return a part's fields joined to one line, or the error of the first unreadable one."""
    filled: list[str] = []
    for one in values:
        if isinstance(one, FormulaReadError):
            return one
        filled += one if len(values) == 1 else one or [""]
    if shape.rows and len(filled) > 1 and len(filled) % shape.rows == 0 and any(filled):
        width = len(filled) // shape.rows
        return "; ".join(", ".join(filled[at : at + width]) for at in range(0, len(filled), width))
    control = InputControl(shape.form, boxes=tuple(map(InputBox, shape.names)), named=shape.named)
    return join_fields(control, filled, stems)
