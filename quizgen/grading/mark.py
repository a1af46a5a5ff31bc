"""Checking typed answers: ``mark`` for one answer, ``quizgen.paper.grading`` for whole papers.

A spec is a plain table with ``kind``; ``docs/answers.md`` documents every kind and field. What a
student types never raises: it becomes a ``Verdict``. Neither SymPy nor NumPy is imported.
"""

from __future__ import annotations

from collections.abc import Mapping

from quizgen.core.errors import KeyFileError, require_one_of
from quizgen.grading.contract import Kind
from quizgen.grading.diagnosis.numeric_slips import find_common_slip
from quizgen.grading.feedback import feedback_sentence
from quizgen.grading.kinds import KINDS
from quizgen.grading.options import DECIMALS, GradingOptions, QuestionContext
from quizgen.grading.spec import SpecTable, WordSpec, decode_spec
from quizgen.grading.verdict import Verdict, ambiguous, attach_message, unreadable
from quizgen.locale import list_languages
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.precision import working_precision

TWO_READINGS = frozenset({"comma-twice", "two-readings"})
"""Reasons for asking back that are not the learner's slip: the text can be read in two ways."""

NAMING = frozenset({"cells", "coordinate"})
"""Notes that only name what is wrong."""


def load_spec(spec: SpecTable, *, proven: bool = False) -> Kind:
    """Read and validate a spec table.

    Parameters
    ----------
    spec : mapping
    proven : bool
        Whether it has been validated before.

    Raises
    ------
    KeyFileError
        Naming the field that is wrong.
    """
    name = spec.get("kind")
    if not isinstance(name, str) or name not in KINDS:
        raise KeyFileError(f"spec.kind: unknown kind {name!r}; known: {', '.join(KINDS)}")
    return decode_spec(KINDS[name], spec, proven=proven)


@working_precision()
def mark(
    spec: SpecTable | Kind,
    typed: str,
    *,
    lang: str = "en",
    decimal: str = "auto",
    context: QuestionContext | None = None,
    settle: bool = False,
) -> Verdict:
    """Mark one typed answer.

    Parameters
    ----------
    spec : mapping or Kind
        The answer's spec: ``{"kind": "number", "value": "20/3", "decimals": 3}``, or its struct.
    typed : str
        What the student typed.
    lang : str
        Language of the message.
    decimal : str
        The student's decimal sign: ``auto``, ``point`` or ``comma``.
    context : Context, optional
        The question around, for diagnosis and errors carried forward.
    settle : bool
        Allow a few seconds of SymPy, in its own process, for a formula that stays undecided.

    Raises
    ------
    KeyFileError
        If the spec is wrong (never because of what was typed).
    ChoiceError
        If there is no such language or decimal sign.
    TypeError
        If what was typed is no text.
    """
    _check_arguments(typed, lang, decimal)
    kind = load_spec(spec) if isinstance(spec, Mapping) else spec
    return explain_verdict(
        kind, judge_answer(kind, typed, GradingOptions(lang, decimal, context, settle)), lang
    )


def _check_arguments(typed: object, lang: str, decimal: str) -> None:
    if not isinstance(typed, str):
        raise TypeError(f"typed: text is expected, not {type(typed).__name__}")
    require_one_of("language", lang, list_languages())
    require_one_of("decimal", decimal, DECIMALS)


def judge_answer(spec: Kind, typed: str, options: GradingOptions) -> Verdict:
    """Return the language-free verdict of one answer."""
    try:
        with spec.known_units().activate():
            return spec.judge(typed, options)
    except FormulaReadError as error:
        return read_error_verdict(error)


def read_error_verdict(error: FormulaReadError) -> Verdict:
    """The verdict on an answer that could not be read."""
    note = error.code
    if error.code == "unknown-unit" and error.expected:
        note = "unknown-unit-case"
    asked = ambiguous if note in TWO_READINGS else unreadable
    return asked(note, column=error.column or 1, found=error.found, expected=error.expected)


def explain_verdict(spec: Kind, verdict: Verdict, lang: str) -> Verdict:
    """Put the verdict's note into words of a language."""
    if not (verdict.note or verdict.cells or verdict.fields):
        return verdict
    cells = tuple(explain_verdict(spec, cell, lang) for cell in verdict.cells)
    return attach_message(verdict, _compose_feedback(spec, verdict, lang), cells)


def _compose_feedback(spec: Kind, verdict: Verdict, lang: str) -> str:
    name = verdict.note.removeprefix("trap:")
    if name == verdict.note:
        said = feedback_sentence(lang, verdict.note, verdict.fields) if name else ""
        return " ".join(
            filter(
                None,
                (
                    said,
                    _format_common_cell_feedback(verdict, lang),
                    _list_choice_reasons(spec, verdict, lang),
                ),
            )
        )
    return spec.notes.get(lang, {}).get(name) or feedback_sentence(lang, "trap", verdict.fields)


def _list_choice_reasons(spec: Kind, verdict: Verdict, lang: str) -> str:
    """Why what was chosen is wrong, as the question's author says it."""
    known = spec.why.get(lang) if isinstance(spec, WordSpec) else None
    chosen = verdict.fields.get("because", ())
    if not known or not isinstance(chosen, tuple):
        return ""
    return " ".join(dict.fromkeys(known[label] for label in chosen if label in known))


def _format_common_cell_feedback(verdict: Verdict, lang: str) -> str:
    """What all wrong cells have in common, behind the names of the wrong ones."""
    if verdict.note not in NAMING:
        return ""
    missed = [cell for cell in verdict.cells if cell.credit < 1]
    if len({cell.note for cell in missed}) != 1:
        return ""
    note, fields = find_common_slip(missed)
    return "" if note.startswith("trap:") else feedback_sentence(lang, note, fields)


@working_precision()
def show_key(spec: SpecTable | Kind, lang: str = "en") -> str:
    """Return the key of a spec as it is printed, and as it can be typed back.

    Raises
    ------
    KeyFileError
        If the spec is wrong.
    """
    kind = load_spec(spec) if isinstance(spec, Mapping) else spec
    with kind.known_units().activate():
        return kind.show_in(lang)


__all__ = [
    "GradingOptions",
    "QuestionContext",
    "Verdict",
    "explain_verdict",
    "judge_answer",
    "load_spec",
    "mark",
    "show_key",
]
