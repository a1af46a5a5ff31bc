"""The public interface can be seen: by editors, by help(), by type checkers."""

from __future__ import annotations

import ast
import pydoc
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from sweep import together

import quizgen

ROOT = Path(__file__).parent.parent


def declared() -> dict[str, str]:
    """Names that ``quizgen/__init__.py`` shows to type checkers, with their modules."""
    tree = ast.parse((ROOT / "quizgen" / "__init__.py").read_text(encoding="utf-8"))
    block = next(node for node in tree.body if isinstance(node, ast.If))
    imports = [node for node in block.body if isinstance(node, ast.ImportFrom)]
    return {alias.name: node.module for node in imports for alias in node.names}


def test_what_runs_is_what_type_checkers_see():
    assert declared() == {name: f"quizgen.{home}" for name, home in quizgen.HOMES.items()}


@together("name", quizgen.HOMES)
def test_a_public_name_is_called_so_at_home_and_documented(name):
    value = getattr(quizgen, name)
    assert value.__name__ == name
    assert value.__doc__


def test_help_and_completion_list_every_name():
    shown = pydoc.plain(pydoc.render_doc(quizgen))
    assert dir(quizgen) == sorted(quizgen.__all__)
    assert not [name for name in quizgen.HOMES if name not in shown]
    assert version("quizgen") in shown


def test_the_version_is_the_installed_one():
    assert quizgen.__version__ == version("quizgen")


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="nonsense"):
        quizgen.nonsense  # noqa: B018


def test_importing_it_loads_nothing_heavy():
    code = "import sys, quizgen; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert not {"numpy", "sympy", "matplotlib", "flint", "msgspec"} & set(loaded.stdout.split())


@pytest.mark.slow
def test_a_type_checker_accepts_right_calls_and_refuses_wrong_ones():
    command = [sys.executable, "-m", "mypy", "--strict", "tests/typing/api.py"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 0, done.stdout


@pytest.fixture(scope="module")
def asked():
    template = quizgen.builtin_bank().template("point-to-pixel")
    return quizgen.compose_question(template, seed="reference")


def test_values_show_themselves_in_one_short_line(asked):
    question, key = asked
    verdict = quizgen.grade_answer(key.specs[0], "(440; 160)")
    paper = quizgen.build_paper(
        quizgen.builtin_bank(), quizgen.load_blueprint("trial"), 5, figures=False
    )
    assert repr(question) == f"<Question 1 of point-to-pixel (en): {question.title}>"
    assert repr(verdict) == "<Verdict correct, read as (440; 160) px>"
    assert repr(paper) == f"<Paper {paper.code}: 5 questions, 10 points>"
    for value in (question, key, verdict, paper, key.draw, question.figure):
        assert "\n" not in repr(value)
        assert len(repr(value)) < 300
    assert "440" not in repr(question)


def parsed(text: str):
    import html5lib

    return html5lib.HTMLParser(strict=True).parseFragment(text)


def test_notebooks_show_question_figure_and_verdict_as_html(asked):
    question, key = asked
    shown = question._repr_html_()
    parsed(shown)
    assert question.title in shown
    assert "<math" in shown
    assert "<svg" in shown
    assert "440" not in shown
    assert question.figure._repr_html_().startswith("<svg")
    verdict = quizgen.grade_answer(key.specs[0], "<b>5</b>")
    assert "<b>" not in verdict._repr_html_()
    parsed(verdict._repr_html_())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"lang": "fr"}, "language: 'fr' .allowed: en, bn"),
        ({"decimal": "dot"}, "decimal: 'dot' .allowed: auto, point, comma"),
        ({"typed": 3}, "text is expected, not int"),
    ],
)
def test_wrong_arguments_of_marking_are_named(asked, change, message):
    with pytest.raises((ValueError, TypeError), match=message):
        quizgen.grade_answer(asked[1].specs[0], **{"typed": "1", **change})


def test_the_changelog_begins_with_this_version_on_one_page():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    heading, body = text.partition("\n## ")[2].split("\n", 1)
    assert heading == quizgen.__version__
    assert len(body.partition("\n## ")[0].split()) <= 1500
