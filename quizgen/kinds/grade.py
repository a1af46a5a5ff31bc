"""Grading typed answers: ``grade_answer`` for one, ``quizgen.paper.grading`` for whole papers.

A spec is a plain table with ``kind``; ``docs/answers.md`` documents every kind and field. What a
student types never raises: it becomes a ``Verdict``. Neither SymPy nor NumPy is imported.
"""

from __future__ import annotations

from collections.abc import Mapping

from quizgen.core.errors import KeyFileError, require_one_of
from quizgen.grading.judge import explain_verdict, judge_answer, show_spec
from quizgen.grading.options import DECIMALS, GradingOptions, QuestionContext
from quizgen.grading.spec import AnySpec, SpecTable, decode_spec
from quizgen.grading.verdict import Verdict
from quizgen.kinds import KINDS
from quizgen.locale import list_languages
from quizgen.maths.precision import working_precision


def load_spec(spec: SpecTable, *, proven: bool = False) -> AnySpec:
    """Return the spec that a table holds, validated.

    Parameters
    ----------
    spec : mapping
        As a key stores it, with its ``kind``.
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
    return decode_spec(KINDS[name].spec, spec, proven=proven)


@working_precision()
def grade_answer(
    spec: SpecTable | AnySpec,
    typed: str,
    *,
    lang: str = "en",
    decimal: str = "auto",
    context: QuestionContext | None = None,
    settle: bool = False,
) -> Verdict:
    """Return the verdict on one typed answer, in words of a language.

    Parameters
    ----------
    spec : mapping or AnySpec
        The answer's spec: ``{"kind": "number", "value": "20/3", "decimals": 3}``, or its struct.
    typed : str
        What the student typed.
    lang : str
        Language of the message.
    decimal : str
        The student's decimal sign: ``auto``, ``point`` or ``comma``.
    context : QuestionContext, optional
        The question around, for diagnosis and errors carried forward.
    settle : bool
        Allow a few seconds of SymPy, in its own process, for a formula that stays undecided.

    Raises
    ------
    KeyFileError
        If the spec is wrong (never because of what was typed).
    InvalidChoiceError
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
    """Check what a caller passed.

    Raises
    ------
    TypeError
        If what was typed is no text.
    InvalidChoiceError
        If there is no such language or decimal sign.
    """
    if not isinstance(typed, str):
        raise TypeError(f"typed: text is expected, not {type(typed).__name__}")
    require_one_of("language", lang, list_languages())
    require_one_of("decimal", decimal, DECIMALS)


def show_key(spec: SpecTable | AnySpec, lang: str = "en") -> str:
    """Return the key of a spec as it is printed, and as it can be typed back.

    Raises
    ------
    KeyFileError
        If the spec is wrong.
    """
    return show_spec(load_spec(spec) if isinstance(spec, Mapping) else spec, lang)
