"""The readings that an answer asked back has, each as something to choose with one click or key.

No reading is marked as right: whoever chooses one is graded by it.
"""

from __future__ import annotations

import msgspec

from quizgen.grading.verdict import Verdict

SIGNS = {".": "point", ",": "comma"}
"""A decimal mark and the name of the sign that it is."""


class OfferedReading(msgspec.Struct, frozen=True):
    """One reading: what it is shown as, and what choosing it changes.

    Parameters
    ----------
    label : str
    typed : str
        The answer that stands for it; empty if the answer stays as it is.
    decimal : str
        The decimal sign that the learner thereby declares: ``point`` or ``comma``.
    """

    label: str
    typed: str = ""
    decimal: str = ""


def list_offered_readings(verdict: Verdict) -> tuple[OfferedReading, ...]:
    """Return the readings of an answer that was asked back; none if it has no such list."""
    fields = verdict.fields
    if verdict.note == "several-answers":
        return _offer_texts(fields.get("numbers"))
    if verdict.note != "two-readings":
        return ()
    mark = str(fields.get("mark", ""))
    if mark not in SIGNS:
        return () if fields.get("found") else _offer_texts(fields.get("expected"))
    other = next(sign for sign in SIGNS if sign != mark)
    return (
        OfferedReading(str(fields["first"]), decimal=SIGNS[mark]),
        OfferedReading(str(fields["second"]), decimal=SIGNS[other]),
    )


def _offer_texts(texts: object) -> tuple[OfferedReading, ...]:
    """Return whole answers as readings."""
    known = texts if isinstance(texts, tuple | list) else ()
    return tuple(OfferedReading(text, text) for text in map(str, known))


def choose_offered_reading(
    readings: tuple[OfferedReading, ...], typed: str
) -> OfferedReading | None:
    """Return the reading that was typed as it is shown, or by its number from 1; else None."""
    named = [one for one in readings if one.label == typed]
    by_number = {str(number): one for number, one in enumerate(readings, 1)}
    return named[0] if named else by_number.get(typed)
