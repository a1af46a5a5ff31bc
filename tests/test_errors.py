"""Every error a caller may see is named where the docstring says, and one that lists choices."""

from __future__ import annotations

import pytest

from quizgen import errors
from quizgen.arrays.domain import DomainError
from quizgen.camera.scene import SceneError
from quizgen.errors import BankError, ChoiceError, FormulaError, QuizgenError, one_of
from quizgen.maths.notation.lexer import ReadError
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.marking import mark_paper
from quizgen.paper.paper import build
from quizgen.question.compose import compose
from quizgen.render import render_paper, renderer

KEY = {"format": "quizgen-key/2", "questions": []}


def test_the_tree_in_the_docstring_holds_every_error_of_the_module():
    tree = errors.__doc__ or ""
    for name, value in vars(errors).items():
        if isinstance(value, type) and issubclass(value, Exception):
            assert name in tree, name


@pytest.mark.parametrize("error", [SceneError, ReadError, DomainError])
def test_the_errors_that_stand_elsewhere_are_named_with_their_place(error):
    tree = errors.__doc__ or ""
    assert f"``{error.__name__}`` in" in tree or f"``{error.__name__}`` in ``" in tree
    assert error.__module__.removeprefix("quizgen.") in tree
    assert issubclass(error, ValueError if error is DomainError else QuizgenError)
    assert issubclass(ReadError, FormulaError)


def test_one_of_gives_the_value_or_says_what_is_allowed():
    assert one_of("colour", "red", ("red", "blue")) == "red"
    for wrong in ("green", "", 3, None, ["red"]):
        with pytest.raises(ChoiceError, match=r"colour: .* \(allowed: red, blue\)"):
            one_of("colour", wrong, ("red", "blue"))


@pytest.fixture(scope="module")
def paper(bank):
    return build(bank, load_blueprint("optics.10"), 1, figures=False)


@pytest.mark.parametrize("output", ["docx", "", 3, "HTML"])
def test_an_unknown_format_is_named(paper, output):
    with pytest.raises(ChoiceError, match=r"format: .* \(allowed: html, pdf\)"):
        render_paper(paper, "exam", output)
    with pytest.raises(ChoiceError):
        renderer(output)


def test_an_unknown_kind_of_file_is_named(paper):
    with pytest.raises(ChoiceError, match=r"kind: 'key' \(allowed: exam, solutions\)"):
        render_paper(paper, "key", "html")


def test_marking_names_a_wrong_language_and_decimal_sign():
    assert mark_paper(KEY, {}).points == 0
    with pytest.raises(ChoiceError, match=r"language: 'fr' \(allowed: en, bn, de\)"):
        mark_paper(KEY, {}, "fr")
    with pytest.raises(ChoiceError, match=r"decimal: 'dot' \(allowed: auto, point, comma\)"):
        mark_paper(KEY, {}, decimal="dot")


@pytest.mark.parametrize("lang", ["fr", 7, None, ["en"]])
def test_a_question_in_an_unknown_language_is_an_error_with_those_it_is_written_in(bank, lang):
    template = bank.template("point-to-image-plane")
    with pytest.raises(BankError, match=r"not written in .* \(only in en, bn\)"):
        compose(template, 0, lang, figures=False)
