"""Judging by a specification, whichever kind it is of: the verdict, its sentence, the key in print.

What a student types never raises: it becomes a ``Verdict``. Neither SymPy nor NumPy is imported.
"""

from __future__ import annotations

from quizgen.grading.diagnosis.numeric_slips import find_common_slip
from quizgen.grading.feedback import feedback_sentence
from quizgen.grading.options import GradingOptions
from quizgen.grading.spec import AnySpec, WordSpec
from quizgen.grading.verdict import Verdict, ambiguous, attach_message, unreadable
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.precision import working_precision

TWO_READINGS = frozenset({"comma-twice", "two-readings"})
"""Reasons for asking back that are not the learner's slip: the text can be read in two ways."""

NAMING = frozenset({"cells", "coordinate"})
"""Notes that only name what is wrong."""


def judge_answer(spec: AnySpec, typed: str, options: GradingOptions) -> Verdict:
    """Return the verdict on one typed answer, in no language yet.

    It never raises for what was typed: an answer that cannot be read gets an ``unreadable`` or
    ``ambiguous`` verdict, which costs nothing.
    """
    try:
        with spec.known_units().activate():
            return spec.judge(typed, options)
    except FormulaReadError as error:
        return read_error_verdict(error)


def read_error_verdict(error: FormulaReadError) -> Verdict:
    """Return the verdict on an answer that could not be read: asked back, with its place."""
    note = error.code
    if error.code == "unknown-unit" and error.expected:
        note = "unknown-unit-case"
    asked = ambiguous if note in TWO_READINGS else unreadable
    return asked(note, column=error.column or 1, found=error.found, expected=error.expected)


def explain_verdict(spec: AnySpec, verdict: Verdict, lang: str) -> Verdict:
    """Return the verdict with its sentence, and those of its cells, in a language.

    A verdict that has nothing to explain is returned as it is.
    """
    if not (verdict.note or verdict.cells or verdict.fields):
        return verdict
    cells = tuple(explain_verdict(spec, cell, lang) for cell in verdict.cells)
    return attach_message(verdict, _build_sentence(spec, verdict, lang), cells)


def _build_sentence(spec: AnySpec, verdict: Verdict, lang: str) -> str:
    """Return the sentence for a verdict's note.

    For a misconception it is the author's own sentence, if there is one.
    """
    name = verdict.note.removeprefix("trap:")
    if name == verdict.note:
        said = feedback_sentence(lang, verdict.note, verdict.fields) if name else ""
        return " ".join(
            filter(
                None,
                (
                    said,
                    _find_common_reason(verdict, lang),
                    _join_author_reasons(spec, verdict, lang),
                ),
            )
        )
    return spec.notes.get(lang, {}).get(name) or feedback_sentence(lang, "trap", verdict.fields)


def _join_author_reasons(spec: AnySpec, verdict: Verdict, lang: str) -> str:
    """Return why what was chosen is wrong, in the author's words; empty if there are none."""
    known = spec.why.get(lang) if isinstance(spec, WordSpec) else None
    chosen = verdict.fields.get("because", ())
    if not known or not isinstance(chosen, tuple):
        return ""
    return " ".join(dict.fromkeys(known[label] for label in chosen if label in known))


def _find_common_reason(verdict: Verdict, lang: str) -> str:
    """Return the sentence for the slip that all wrong cells share; empty if there is none.

    A misconception's own sentence is not for cells: it speaks of the answer.
    """
    if verdict.note not in NAMING:
        return ""
    missed = [cell for cell in verdict.cells if cell.credit < 1]
    if len({cell.note for cell in missed}) != 1:
        return ""
    note, fields = find_common_slip(missed)
    return "" if note.startswith("trap:") else feedback_sentence(lang, note, fields)


@working_precision()
def show_spec(spec: AnySpec, lang: str = "en") -> str:
    """Return the key of a specification as it is printed, and as it can be typed back."""
    with spec.known_units().activate():
        return spec.show_in(lang)
