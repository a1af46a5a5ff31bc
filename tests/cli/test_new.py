"""From nothing to a sound question: what ``new`` writes, and what editors check it by."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.scaffold import KINDS
from quizgen.cli.main import main, root_group
from quizgen.lint.item_quality import review_template


def run(*arguments: str | Path):
    return CliRunner().invoke(root_group, [*map(str, arguments)], catch_exceptions=False)


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    root = tmp_path_factory.mktemp("new") / "mine"
    assert run("new", "bank", root).exit_code == 0
    for kind in KINDS:
        made = run("new", "template", f"example/some-{kind}", f"--{kind}", "--bank", root)
        assert made.exit_code == 0, made.output
    return root


def test_what_is_written_is_sound_and_teaches(root):
    done = run("lint", "--bank", root, "--trust", "--seeds", "60")
    assert done.exit_code == 0, done.output
    for template in Bank(root, trusted=True):
        found = [one for one in review_template(template, 200) if one.level == "error"]
        assert not found, template.id


@pytest.mark.parametrize(
    ("lang", "own"), [("de", ("der ", "die ", "das ")), ("bn", ("ে", "র"))], ids=["de", "bn"]
)
def test_what_is_written_in_another_language_is_in_that_language(tmp_path, lang, own):
    here = tmp_path / "mine"
    assert run("new", "bank", here, "--lang", lang).exit_code == 0
    for kind in KINDS:
        made = run("new", "template", f"example/some-{kind}", f"--{kind}", "--bank", here)
        assert made.exit_code == 0, made.output
    done = run("lint", "--bank", here, "--trust", "--seeds", "20", "--jobs", "1")
    assert done.exit_code == 0, done.output
    assert "Example" not in (here / "templates/bank.toml").read_text("utf-8")
    pages = [path.read_text("utf-8") for path in here.rglob("*.md")]
    assert len(pages) == len(KINDS) + 1
    for page in pages:
        prose = page.partition("\n")[2].lower()
        assert any(word in prose for word in own)
        assert not {"the", "you", "is", "of", "are"} & set(re.findall(r"[a-z]+", prose))
    made = run(
        "exam",
        "--seed",
        "1",
        "--format",
        "html",
        "--bank",
        here,
        "--trust",
        "--out",
        tmp_path / "p",
    )
    assert made.exit_code == 0, made.output


def test_what_is_written_can_be_printed_and_carded(root, tmp_path):
    shared = ("--bank", root, "--trust", "--out", tmp_path)
    assert run("exam", "--topic", "example", "--format", "html", *shared).exit_code == 0
    assert "Some solver" in (tmp_path / "exam.html").read_text("utf-8")
    assert run("cards", "--format", "tsv", *shared).exit_code == 0


def test_a_paper_of_all_there_is_needs_no_blueprint(root, tmp_path):
    shared = ("--bank", root, "--trust", "--out")
    made = run("exam", "--seed", "1", "--format", "html", *shared, tmp_path / "paper")
    assert made.exit_code == 0, made.output
    assert "Code: all.90-1-en-" in made.output
    assert f"{len(KINDS) + 1} questions" in made.output
    (tmp_path / "roster.csv").write_text("id,name\n1,Ada\n", "utf-8")
    made = run("class", "make", tmp_path / "roster.csv", *shared, tmp_path / "class")
    assert made.exit_code == 0, made.output
    made = run("export", "moodle", "--variants", "1", *shared, tmp_path / "some.xml")
    assert made.exit_code == 0, made.output
    assert f"slots: {len(KINDS) + 1}" in made.output


@pytest.mark.parametrize("answer", ['kind = "set", of = ["t", "v"]', 'kind = "interval", value = "[0, 1)"',
                                    'kind = "table", of = ["t", "v"]', 'kind = "point", of = ["t", "s"]'])  # fmt: skip
def test_what_is_computed_may_be_asked_in_other_kinds(tmp_path, answer):
    assert run("new", "bank", tmp_path / "mine").exit_code == 0
    file = tmp_path / "mine/templates/example/travel-time/template.toml"
    asked = 'kind = "quantity", of = "t", unit = "s"'
    assert asked in file.read_text("utf-8")
    file.write_text(file.read_text("utf-8").replace(asked, answer), "utf-8")
    shared = ("--bank", tmp_path / "mine", "--trust")
    done = run("lint", *shared, "--seeds", "20")
    assert done.exit_code == 0, done.output
    made = run("exam", "--format", "html", *shared, "--out", tmp_path / "paper")
    assert made.exit_code == 0, made.output


def test_without_a_kind_something_is_computed(root, tmp_path):
    assert run("new", "bank", tmp_path / "other").exit_code == 0
    made = run("new", "template", "example/some-solver", "--bank", tmp_path / "other")
    assert made.exit_code == 0, made.output
    written = [
        sorted(
            path.read_text("utf-8")
            for path in bank.rglob("example/some-solver/*")
            if path.is_file()
        )
        for bank in (root, tmp_path / "other")
    ]
    assert written[0]
    assert written[0] == written[1]


@pytest.mark.parametrize("name", ["mechanics", "My-Physics.2"])
def test_a_package_says_where_its_bank_is(tmp_path, name):
    made = run("new", "bank", tmp_path / name, "--package")
    assert made.exit_code == 0, made.output
    table = tomllib.loads((tmp_path / name / "pyproject.toml").read_text("utf-8"))
    ((entry, module),) = table["project"]["entry-points"]["quizgen.banks"].items()
    assert module == f"bank_of_{entry}"
    assert module.isidentifier()
    bank = Bank(tmp_path / name / module)
    assert bank.name == name
    assert f"--bank {tmp_path / name / module}" in made.output
    about = tmp_path / name / table["tool"]["hatch"]["version"]["path"]
    pattern = table["tool"]["hatch"]["version"]["pattern"]
    found = re.search(pattern, about.read_text("utf-8"), re.MULTILINE)
    assert found["version"] == bank.metadata.version


def test_nothing_is_overwritten(root, capsys):
    before = {path: path.read_bytes() for path in root.rglob("*.*")}
    for again in (["bank", str(root)], ["template", "example/some-gap", "--bank", str(root)]):
        with pytest.raises(SystemExit) as stopped:
            main(["new", *again])
        assert stopped.value.code == 2
        assert "already" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in before} == before


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("physics/x", "write it under [topics] first"),
        ("example", "'example' has no topic before it"),
        ("../x", "'..' is no name"),
    ],
)
def test_a_place_that_cannot_be_is_refused(root, capsys, place, said):
    with pytest.raises(SystemExit):
        main(["new", "template", place, "--bank", str(root)])
    assert said in capsys.readouterr().err


def test_editors_complete_every_key_and_refuse_others():
    table = json.loads(run("schema", "template").output)
    rules = table["$defs"]["Rules"]
    assert {"topic", "tier", "part"} == set(rules["required"])
    assert rules["additionalProperties"] is False
    assert {"pick", "range", "is"} <= set(table["$defs"]["DrawRule"]["properties"])
    about = json.loads(run("schema", "bank").output)
    assert {"units", "topics", "requires"} <= set(about["$defs"]["About"]["properties"])


def test_a_preview_for_learners_holds_no_answer():
    name = "thin-lens-image-distance"
    whole, quiz = (run("preview", name, "--seed", "3", *more).output for more in ((), ("--quiz",)))
    assert "Answer:" in whole
    assert "Answer:" not in quiz
    assert builtin_bank().template(name).texts["en"].title in quiz
    assert "The image distance z′ is asked for." in quiz
