"""Marking an answer to one part of a template, as a paper would: for authors and programs."""

from __future__ import annotations

from collections.abc import Mapping

from quizgen.bank.rules import PART_LABELS
from quizgen.bank.template import Template
from quizgen.core.errors import require_one_of
from quizgen.grading.options import DECIMALS, GradingOptions
from quizgen.grading.verdict import Verdict
from quizgen.locale import list_languages
from quizgen.paper.answer_key import make_key_question
from quizgen.paper.grading import QuestionGrader
from quizgen.paper.paper import single_question_paper


def mark_part(  # noqa: PLR0913 - which part, and how it is read, by name
    template: Template,
    typed: str,
    *,
    part: str = "a",
    seed: str | int = 1,
    earlier: Mapping[str, str] | None = None,
    lang: str = "en",
    decimal: str = "auto",
) -> Verdict:
    """Return the verdict on an answer to one part of a template, with its chain of steps.

    Unlike ``grade_answer`` it knows the question around the part: slips in its steps are named,
    and errors are carried forward from earlier answers.

    Parameters
    ----------
    template : Template
    typed : str
        The answer to the part.
    part : str
        Its letter, from ``a``.
    seed : str or int
        The seed of the question, as ``quizgen preview`` takes it.
    earlier : mapping of str to str, optional
        Answers to earlier parts, by their letters.
    lang : str
        Language of the message.
    decimal : str
        The student's decimal sign: ``auto``, ``point`` or ``comma``.

    Raises
    ------
    InvalidChoiceError
        If there is no such part, language or decimal sign.
    BankError, SamplingError
        If the template is wrong.

    Examples
    --------
    >>> import quizgen
    >>> template = quizgen.builtin_bank().template("point-to-image-plane")
    >>> quizgen.mark_part(template, "y = 6; x = -2").verdict
    'correct'
    """
    options = GradingOptions(
        require_one_of("language", lang, list_languages()),
        require_one_of("decimal", decimal, DECIMALS),
    )
    paper = single_question_paper(template, seed, lang, figures=False)
    keyed = make_key_question(paper.items[0])
    letters = list(PART_LABELS[: len(keyed.parts)])
    asked = dict(zip(letters, keyed.parts, strict=True))
    grader = QuestionGrader(keyed, options)
    wanted = require_one_of("part", part, letters)
    for letter, text in (earlier or {}).items():
        grader.judge_part(asked[require_one_of("part", letter, letters)], text)
    return grader.grade_part(asked[wanted], typed).verdict
