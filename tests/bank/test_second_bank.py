"""A bank of another subject works with nothing but templates, and better with ``bank.toml``."""

from __future__ import annotations

import ast
import re
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


SUBJECT = {"arrays", "camera", "tradeoff"}
"""What pictures are made with: an effect or a formula may be called as a topic or a figure is."""
OTHERWISE = {"code", "camera", "colour", "image", "projection"}
"""An answer kind, a command's word, a spelling, an element of SVG, and a parameter of matplotlib."""


def test_the_engine_names_no_topic_and_no_title():
    about = builtin_bank().metadata
    titles = {text for topic in about.topics.values() for text in topic.values()}
    named = {*about.topics, *titles, *about.title.values()} - OTHERWISE - {"Code", "কোড"}
    for path in PACKAGE.rglob("*"):
        if path.relative_to(PACKAGE).parts[0] in SUBJECT | {"builtin"}:
            continue
        if path.suffix == ".py":
            assert not _texts(path) & named, path
        elif path.suffix == ".toml":
            text = path.read_text(encoding="utf-8")
            assert not [name for name in named if f'"{name}"' in text], path


def _chapter() -> set[str]:
    """Names of the built-in bank's templates, present and former, and of its solvers."""
    bank = builtin_bank()
    solvers = {path.relative_to(bank.root / "solvers").with_suffix("").as_posix()
               for path in (bank.root / "solvers").rglob("[a-z]*.py")}  # fmt: skip
    return {
        *bank.template_paths,
        *(bank.rules(name).formerly for name in bank.template_paths),
        *solvers,
    } - {""}


EXAMPLE = {"point-to-image-plane"}
"""The question that the examples of the Python interface ask."""


SCENES = {"pinhole", "defocus"}
"""A scene and an effect of the camera's own page, which a figure and a solver are called as well."""


def _texts(path: Path) -> set[object]:
    """Texts, numbers and the like of a program."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}


def test_the_engine_names_no_template_no_solver_and_no_figure():
    """A name of a single word (``noise``) may stand in a sentence, but is no text of a program."""
    figures = builtin_bank().figures
    word = re.compile(r"[\w/-]+")
    named = {name for name in {*_chapter(), *figures} - EXAMPLE if re.search("[-_/]", name)}
    single = {name.rpartition("/")[2] for name in {*_chapter(), *figures}} - SCENES
    for path in PACKAGE.rglob("*"):
        if path.relative_to(PACKAGE).parts[0] in SUBJECT | {"builtin"}:
            continue
        if path.suffix in {".py", ".toml", ".j2", ".js"}:
            assert not {*word.findall(path.read_text("utf-8"))} & named, path
        if path.suffix == ".py":
            assert not _texts(path) & single, path
