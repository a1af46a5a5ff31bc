"""Marking a whole paper: every part, errors carried forward, marks and total."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from fractions import Fraction
from typing import Any, NamedTuple

import msgspec
from msgspec import structs

from quizgen.core.errors import require_one_of
from quizgen.grading.diagnosis.carry_forward import judge_carried_form
from quizgen.grading.judge import explain_verdict, judge_answer, read_error_verdict
from quizgen.grading.options import DECIMALS, GradingOptions
from quizgen.grading.spec import AnySpec
from quizgen.grading.verdict import Verdict
from quizgen.locale import list_languages
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.numbers import to_float
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import Expr
from quizgen.paper.answer_key import AnswerKey, KeyPart, KeyQuestion, parse_answer_key

QUARTERS = 4
"""Parts of a point that marks are given in."""


class PartResult(msgspec.Struct, frozen=True):
    """One part of a marked paper.

    ``marks`` is None where a person has to decide (free text); an answer that could not be read
    gets no marks yet and is counted in ``PaperResult.asked_back``.
    """

    id: str
    number: str
    template: str
    typed: str
    points: Fraction
    verdict: Verdict
    marks: Fraction | None
    kind: str = ""

    @property
    def is_blank(self) -> bool:
        """Return whether nothing was typed."""
        return not self.typed.strip()

    @property
    def status(self) -> str:
        """Return ``blank``, ``open`` (to be marked by a person) or the name of the verdict."""
        if self.is_blank:
            return "blank"
        return "open" if self.marks is None else self.verdict.verdict

    @property
    def word(self) -> str:
        """Return the key of the word that the status is shown by."""
        return self.verdict.word if self.status == self.verdict.verdict else self.status

    def as_json(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "id": self.id,
            "question": self.number,
            "template": self.template,
            "typed": self.typed,
            "status": self.status,
            "points": float(self.points),
            "marks": None if self.marks is None else float(self.marks),
            **self.verdict.as_json(),
        }


class PaperResult(msgspec.Struct, frozen=True):
    """A marked paper."""

    code: str
    parts: tuple[PartResult, ...]
    unknown: tuple[str, ...] = ()

    @property
    def marks(self) -> Fraction:
        """Return the marks so far; parts that a person has to mark count as nothing yet."""
        return sum((part.marks or Fraction(0) for part in self.parts), Fraction(0))

    @property
    def points(self) -> Fraction:
        """Return the marks that can be had."""
        return sum((part.points for part in self.parts), Fraction(0))

    @property
    def asked_back(self) -> int:
        """Return the number of answers that could not be read as meant."""
        return sum(part.status in {"unreadable", "ambiguous"} for part in self.parts)

    @property
    def to_decide(self) -> int:
        """Return the number of free texts that a person has to mark."""
        return sum(part.status == "open" for part in self.parts)

    def as_json(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "code": self.code,
            "marks": float(self.marks),
            "points": float(self.points),
            "asked_back": self.asked_back,
            "to_decide": self.to_decide,
            "unknown_parts": list(self.unknown),
            "parts": [part.as_json() for part in self.parts],
        }


def grade_paper(
    key: AnswerKey | Mapping[str, Any],
    answers: Mapping[str, str],
    lang: str = "en",
    *,
    decimal: str = "auto",
    settle: bool = False,
) -> PaperResult:
    """Return the result of a paper: every part with its verdict and marks.

    Parameters
    ----------
    key : AnswerKey or mapping
        The contents of ``key.json``.
    answers : mapping of str to str
        Part to typed text.
    lang : str
        Language of the messages.
    decimal : str
        The student's decimal sign: ``auto``, ``point`` or ``comma``.
    settle : bool
        Allow a few seconds of SymPy for each formula that sampling leaves undecided.

    Raises
    ------
    InvalidChoiceError
        If there is no such language or decimal sign.
    KeyFileError
        If the key is wrong (never because of what was typed).
    """
    found = key if isinstance(key, AnswerKey) else parse_answer_key(key)
    options = GradingOptions(
        require_one_of("language", lang, list_languages()),
        require_one_of("decimal", decimal, DECIMALS),
        settle=settle,
    )
    parts = [
        part for question in found.questions for part in _grade_question(question, answers, options)
    ]
    known = {part.id for part in parts}
    unknown = tuple(name for name, text in answers.items() if name not in known and text.strip())
    return PaperResult(found.code, tuple(parts), unknown)


def _grade_question(
    question: KeyQuestion, answers: Mapping[str, str], options: GradingOptions
) -> list[PartResult]:
    """Return the results of one question's parts in order; a missing answer counts as blank."""
    marker = QuestionGrader(question, options)
    return [marker.grade_part(part, answers.get(part.id, "")) for part in question.parts]


class OwnValue(NamedTuple):
    """A value of a learner: the number, and how many base units its unit has."""

    value: float
    factor: float


class QuestionGrader:
    """Marks the parts of one question in order, remembering the student's own values.

    Parameters
    ----------
    question : KeyQuestion
        The question's key.
    options : GradingOptions
        How to read, and the language of the messages.
    proven : bool
        Whether the key is known to be as it was written.
    """

    def __init__(
        self, question: KeyQuestion, options: GradingOptions, *, proven: bool = False
    ) -> None:
        """Start a question without earlier values.

        ``proven`` keys are known to be as they were written, and are not checked again.
        """
        self.question, self.proven = question, proven
        self.options = options
        self.earlier: dict[str, Any] = {}
        self.forms: dict[str, Expr] = {}

    def judge_part(self, part: KeyPart, typed: str, decimal: str = "") -> PartResult:
        """Return the result of one part without sentences; graded again, it replaces its values.

        ``decimal`` is the sign to read by, if it is not the one of the options.
        """
        spec = part.parse_spec(proven=self.proven)
        verdict = self._judge_in_question(part, spec, typed, decimal or self.options.decimal)
        return _build_part_result(self.question, part, typed, verdict)

    def own_values(self, part: KeyPart, verdict: Verdict) -> dict[str, OwnValue]:
        """Return the values that a verdict on a part read, by quantity of the question."""
        spec = part.parse_spec(proven=self.proven)
        units = self.question.chain.units() if self.question.chain is not None else {}
        rows = zip(spec.quantities(), verdict.values, spec.value_units(), strict=False)
        return {
            name: OwnValue(
                to_float(value), to_float(spec.known_units().factor(unit or units.get(name, "")))
            )
            for name, value, unit in rows
            if value is not None
        }

    def explain_part(self, part: KeyPart, verdict: Verdict, *, reveal: bool = True) -> Verdict:
        """Return the verdict on a part with its sentences, for the person who is shown it.

        Without ``reveal`` no reason is said that tells the right answer.
        """
        spec = part.parse_spec(proven=self.proven)
        return explain_verdict(spec, verdict, self.options.lang, reveal=reveal)

    def grade_part(self, part: KeyPart, typed: str) -> PartResult:
        """Return the result of one part, its verdict explained."""
        found = self.judge_part(part, typed)
        return structs.replace(found, verdict=self.explain_part(part, found.verdict))

    @working_precision()
    def _judge_in_question(self, part: KeyPart, spec: AnySpec, typed: str, decimal: str) -> Verdict:
        """Return the verdict on one part, with earlier values of the same student in mind."""
        options = structs.replace(self.options, points=part.points_exact(), decimal=decimal)
        verdict = _judge_with_context(self.question, spec, typed, options, self.earlier, self.forms)
        if self.question.chain is not None:
            _remember_own_values(self.question, spec, verdict, self.earlier)
            self._remember_own_form(spec, typed, options, verdict)
        return verdict

    def _remember_own_form(
        self, spec: AnySpec, typed: str, options: GradingOptions, verdict: Verdict
    ) -> None:
        """Keep a wrong formula, matrix, ... for the parts that follow; forget one put right."""
        for name in spec.quantities() if verdict.is_graded else ():
            self.forms.pop(name, None)
            with suppress(FormulaReadError):
                form = None if verdict.credit == 1 else spec.read_form(typed, options)
                if form is not None:
                    self.forms[name] = form

    def ask_back(self, part: KeyPart, typed: str, why: FormulaReadError) -> PartResult:
        """Return the result of a part whose answer did not arrive as it was given.

        It counts as one that could not be read.
        """
        verdict = self.explain_part(part, read_error_verdict(why))
        return _build_part_result(self.question, part, typed, verdict)


def _judge_with_context(
    question: KeyQuestion,
    spec: AnySpec,
    typed: str,
    options: GradingOptions,
    earlier: dict[str, Any],
    forms: Mapping[str, Expr],
) -> Verdict:
    """Return the verdict on an answer, first without the question around it.

    Only what is wrong is judged again with the student's earlier values: a right answer needs no
    error carried forward, and most answers are right.
    """
    verdict = judge_answer(spec, typed, options)
    if question.chain is None or not spec.quantities() or not typed.strip():
        return verdict
    if not verdict.is_graded or verdict.verdict == "correct":
        return verdict
    context = question.chain.context(earlier, forms)
    again = judge_answer(spec, typed, structs.replace(options, context=context))
    carried = None if again.credit == 1 else judge_carried_form(spec, typed, options, context)
    return carried or again


def _remember_own_values(
    question: KeyQuestion, spec: AnySpec, verdict: Verdict, earlier: dict[str, Any]
) -> None:
    """Add the student's own values, in base units, to ``earlier`` for the parts that follow."""
    if question.chain is None or len(spec.quantities()) != len(verdict.values):
        return
    units = question.chain.units()
    triples = zip(spec.quantities(), verdict.values, spec.value_units(), strict=True)
    for name, value, unit in triples:
        if value is not None and name in units:
            earlier[name] = value * spec.known_units().factor(unit or units[name])


def _build_part_result(
    question: KeyQuestion, part: KeyPart, typed: str, verdict: Verdict
) -> PartResult:
    """Return the result of a part; marks are in quarters, and None where a person must mark it."""
    worth = part.points_exact()
    marks: Fraction | None = round_to_quarters(verdict.credit * worth)
    if verdict.needs_self_marking:
        marks = None
    number, template, kind = question.number, question.template, part.spec["kind"]
    return PartResult(part.id, number, template, typed, worth, verdict, marks, kind)


def round_to_quarters(marks: Fraction) -> Fraction:
    """Return marks rounded to the nearest quarter of a point, halves up."""
    above, below = marks.numerator, marks.denominator
    return Fraction((2 * QUARTERS * above + below) // (2 * below), QUARTERS)
