"""A bank of another subject works with nothing but templates, and better with ``bank.toml``."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.cli.main import root_group
from quizgen.core.errors import BankError
from quizgen.paper.blueprint import load_blueprint

PACKAGE = Path(__file__).parent.parent.parent / "quizgen"
TEMPLATE = """
topic = "algebra"
tier = "A"
covers = ["A01"]

[draw]
a = { pick = [2, 3, 4, 5, 6, 7] }

[[part]]
answer = { kind = "tf", true = "a > 4" }
"""
PROSE = """# A comparison
Let $a$ = {{ a }}.

**Is $a > 4$?**

## why
Compare the two numbers.
"""


@pytest.fixture
def root(tmp_path):
    folder = tmp_path / "bank" / "templates" / "algebra" / "compare"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(TEMPLATE)
    (folder / "en.md").write_text(PROSE)
    return tmp_path / "bank"


def run(root, *arguments):
    result = CliRunner().invoke(
        root_group, [arguments[0], "--bank", str(root), *arguments[1:]], catch_exceptions=False
    )
    assert result.exit_code == 0, result.output
    return result.output


def test_exam_cards_and_coverage_work_without_bank_toml(root, tmp_path):
    out = str(tmp_path / "paper")
    run(root, "exam", "--topic", "algebra", "--seed", "1", "--out", out)
    page = (tmp_path / "paper" / "exam.html").read_text(encoding="utf-8")
    assert "Mock exam: Algebra" in page
    assert "1 question" in run(root, "cards", "--out", str(tmp_path / "cards"))
    run(root, "templates", "--coverage")


def test_what_a_bank_is_about_follows_from_its_folder(root):
    bank = Bank(root)
    assert bank.topics == ("algebra",)
    assert bank.topic_title("algebra", "en") == "Algebra"
    assert bank.title("en") == "Bank"
    assert bank.languages == ("en",)
    assert bank.blueprints == bank.cards == {}
    assert bank.curriculum.inventory == {}


def test_bank_toml_names_topics_and_holds_blueprints(root, tmp_path):
    templates = root / "templates"
    (templates / "bank.toml").write_text(
        'name = "school"\ntitle.en = "School maths"\ntopics.algebra.en = "Letters for numbers"\n'
    )
    (templates / "curriculum.toml").write_text('[groups]\nskills = ["A01..A03"]\n')
    (templates / "blueprints").mkdir()
    (templates / "blueprints" / "week1.toml").write_text('title.en = "Week 1"\n[[slot]]\n')
    bank = Bank(root)
    assert load_blueprint("algebra", bank).title["en"] == "Mock exam: Letters for numbers"
    assert load_blueprint("all", bank).title["en"] == "Mock exam: School maths"
    assert load_blueprint("week1", bank).title == {"en": "Week 1"}
    assert list(bank.template_paths) == ["compare"]
    run(root, "exam", "--blueprint", "week1", "--seed", "1", "--out", str(tmp_path / "paper"))
    told = run(root, "templates", "--coverage")
    assert "skills" in told
    assert "A02" in told


@pytest.mark.parametrize(
    ("text", "said"),
    [("title = 3\n", "title"), ("topics = [\n", "not valid TOML"), ("subject = 1\n", "subject")],
)
def test_a_bad_bank_toml_is_located(root, text, said):
    (root / "templates" / "bank.toml").write_text(text)
    with pytest.raises(BankError, match=r"bank\.toml.*" + said):
        assert Bank(root).metadata


def test_the_topics_of_the_built_in_bank_are_those_of_its_templates():
    bank = builtin_bank()
    assert {bank.rules(name).topic for name in bank.template_paths} == set(bank.topics)
