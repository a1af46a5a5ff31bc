"""Why an answer could not be read, said of the field in which that stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from quizgen.marking.messages import say
from quizgen.marking.verdict import Verdict
from quizgen.practice.boxes import filled, located
from quizgen.web.made import Html, MadeField
from quizgen.web.views import said

WHOLE = frozenset(
    {"item-count", "empty-item", "too-long", "used-twice", "values-missing", "words-around"}
)
"""Reasons that are about all values together."""


@dataclass(frozen=True)
class Unread:
    """Why an answer could not be read.

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


def unread(field: MadeField, values: Sequence[str], verdict: Verdict, lang: str) -> Unread:
    """Why what stands in the fields could not be read.

    Parameters
    ----------
    field : MadeField
    values : sequence of str
        What stands in its fields.
    verdict : Verdict
        Of the line that they were joined to.
    lang : str
    """
    control = field.control
    if not filled(control, values, field.marks):
        empty = tuple(place for place, value in enumerate(values) if not value.strip())
        return Unread(said(lang, "answer.half"), empty)
    column = verdict.fields.get("column")
    if len(control.boxes) < 2 or not isinstance(column, int) or verdict.note in WHOLE:
        return Unread(verdict.message, tuple(range(len(values))))
    place, inside = located(control, values, column)
    name = field.names[place] or f"{said(lang, 'answer.value')} {place + 1}"
    message = say(lang, verdict.note, {**verdict.fields, "column": inside})
    return Unread(message, (place,), name)
