"""Why an answer could not be read, said of the field in which that stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from quizgen.grading.feedback import feedback_sentence
from quizgen.grading.verdict import Verdict
from quizgen.practice.input_fields import is_complete, locate_in_fields
from quizgen.web.question_view import FieldView, Html
from quizgen.web.views import translate_page

WHOLE = frozenset(
    {"item-count", "empty-item", "too-long", "used-twice", "values-missing", "words-around"}
)
"""Reasons that are about all values together."""


@dataclass(frozen=True)
class ReadErrorView:
    """Why an answer could not be read, and in which fields.

    Parameters
    ----------
    message : str
    places : tuple of int
        The fields to look at, counted from 0.
    name : str
        Name of the field, typeset, where it is one of several.
    """

    message: str
    places: tuple[int, ...]
    name: Html = ""


def explain_read_error(
    field: FieldView, values: Sequence[str], verdict: Verdict, lang: str
) -> ReadErrorView:
    """Return why the fields of a part could not be read, and which to look at.

    Parameters
    ----------
    field : FieldView
    values : sequence of str
        What stands in its fields.
    verdict : Verdict
        Of the line that they were joined to.
    lang : str
    """
    control = field.control
    if not is_complete(control, values, field.marks):
        empty = tuple(place for place, value in enumerate(values) if not value.strip())
        return ReadErrorView(translate_page(lang, "answer.half"), empty)
    column = verdict.fields.get("column")
    if len(control.boxes) < 2 or not isinstance(column, int) or verdict.note in WHOLE:
        return ReadErrorView(verdict.message, tuple(range(len(values))))
    place, inside = locate_in_fields(control, values, column)
    name = field.names[place] or f"{translate_page(lang, 'answer.value')} {place + 1}"
    message = feedback_sentence(lang, verdict.note, {**verdict.fields, "column": inside})
    return ReadErrorView(message, (place,), name)
