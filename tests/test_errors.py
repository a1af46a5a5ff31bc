"""Every error a caller may see is named where the docstring says, and one that lists choices."""

from __future__ import annotations

import pytest

from quizgen.camera.setup.scene import SceneError
from quizgen.core import errors
from quizgen.core.errors import (
    BankError,
    FormulaError,
    InvalidChoiceError,
    QuizgenError,
    require_one_of,
)
from quizgen.maths.notation.lexer import FormulaReadError
from quizgen.numerics.domain import DomainError
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import build_paper
from quizgen.question.compose import compose_question
from quizgen.render import load_renderer, render_paper

KEY = {"format": "quizgen-key/2", "questions": []}


def test_the_tree_in_the_docstring_holds_every_error_of_the_module():
    tree = errors.__doc__ or ""
    for name, value in vars(errors).items():
        if isinstance(value, type) and issubclass(value, Exception):
            assert name in tree, name


@pytest.mark.parametrize("error", [SceneError, FormulaReadError, DomainError])
def test_the_errors_that_stand_elsewhere_are_named_with_their_place(error):
    tree = errors.__doc__ or ""
    assert f"``{error.__name__}`` in" in tree or f"``{error.__name__}`` in ``" in tree
    assert error.__module__.removeprefix("quizgen.") in tree
    assert issubclass(error, ValueError if error is DomainError else QuizgenError)
    assert issubclass(FormulaReadError, FormulaError)


def test_one_of_gives_the_value_or_says_what_is_allowed():
    assert require_one_of("colour", "red", ("red", "blue")) == "red"
    for wrong in ("green", "", 3, None, ["red"]):
        with pytest.raises(InvalidChoiceError, match=r"colour: .* \(allowed: red, blue\)"):
            require_one_of("colour", wrong, ("red", "blue"))


@pytest.fixture(scope="module")
def paper(bank):
    return build_paper(bank, load_blueprint("optics.10"), 1, figures=False)


@pytest.mark.parametrize("output", ["docx", "", 3, "HTML"])
def test_an_unknown_format_is_named(paper, output):
    with pytest.raises(InvalidChoiceError, match=r"format: .* \(allowed: html, pdf\)"):
        render_paper(paper, "exam", output)
    with pytest.raises(InvalidChoiceError):
        load_renderer(output)


def test_an_unknown_kind_of_file_is_named(paper):
    with pytest.raises(InvalidChoiceError, match=r"kind: 'key' \(allowed: exam, solutions\)"):
        render_paper(paper, "key", "html")


def test_marking_names_a_wrong_language_and_decimal_sign():
    assert grade_paper(KEY, {}).points == 0
    with pytest.raises(InvalidChoiceError, match=r"language: 'fr' \(allowed: en, bn, de\)"):
        grade_paper(KEY, {}, "fr")
    with pytest.raises(InvalidChoiceError, match=r"decimal: 'dot' \(allowed: auto, point, comma\)"):
        grade_paper(KEY, {}, decimal="dot")


@pytest.mark.parametrize("lang", ["fr", 7, None, ["en"]])
def test_a_question_in_an_unknown_language_is_an_error_with_those_it_is_written_in(bank, lang):
    template = bank.template("point-to-image-plane")
    with pytest.raises(BankError, match=r"not written in .* \(only in en, bn\)"):
        compose_question(template, 0, lang, figures=False)
