"""One broken template stops itself alone: it is named once, and all the others are asked."""

from __future__ import annotations

import contextlib
import pickle
from pathlib import Path

import pytest
from click.testing import CliRunner

from quizgen.bank.bank import Bank
from quizgen.cli.main import main, root_group
from quizgen.core.errors import QuizgenError
from quizgen.lint.broken_templates import leave_out_broken

FIGURE = """
SIZE, PARAMETERS = (100, 60), {}
def draw(fig, values, *, quiz):
    fig.scetch()
def alt(values, lang, *, quiz):
    return "A line."
"""
BROKEN = {
    "solvers/example/some_solver.py": "some_solver.py:12: NameError: name 'q' is not defined",
    "templates/example/some-gap/template.toml": "some-gap/template.toml:9: not valid TOML",
    "templates/example/some-claims/en.md": "some-claims/en.md:2: section 'clams' is unknown",
    "templates/example/some-choice/figure.py": "some-choice/figure.py:4: AttributeError",
}
SOUND = {"some-match", "some-order", "travel-time"}


def run(*arguments: str | Path, **more):
    return CliRunner().invoke(root_group, [*map(str, arguments)], catch_exceptions=False, **more)


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    root = tmp_path_factory.mktemp("broken") / "mine"
    run("new", "bank", root)
    for kind in ("solver", "gap", "claims", "choice", "match", "order"):
        run("new", "template", f"example/some-{kind}", f"--{kind}", "--bank", root)
    here = root / "templates/example"
    solver = root / "solvers/example/some_solver.py"
    solver.write_text(solver.read_text("utf-8").replace("Step(c, a / b", "Step(c, a / q"), "utf-8")
    with (here / "some-gap/template.toml").open("a") as file:
        file.write("x =\n")
    (here / "some-claims/en.md").write_text("# Units\n## clams\n", "utf-8")
    (here / "some-choice/figure.py").write_text(FIGURE, "utf-8")
    with (here / "some-choice/template.toml").open("a") as file:
        file.write("[figure]\nquiz = true\n")
    return root


@pytest.fixture
def shared(root, tmp_path, monkeypatch):
    for home in ("XDG_CACHE_HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME"):
        monkeypatch.setenv(home, str(tmp_path / home))
    monkeypatch.chdir(tmp_path)
    return ("--bank", root, "--trust")


def assert_each_is_named_once(said: str) -> None:
    for place in BROKEN.values():
        assert said.count(place) == 1, said


@pytest.mark.parametrize(
    ("command", "counted"),
    [
        (("exam", "--topic", "example", "--seed", "1", "--format", "html"), "3 questions"),
        (("export", "moodle", "--variants", "1", "--out", "some.xml"), "questions: 3"),
        (("cards", "--format", "tsv"), "3 cards"),
    ],
    ids=lambda one: one[0] if isinstance(one, tuple) else "",
)
def test_the_others_are_asked(shared, command, counted):
    done = run(*command, *shared)
    assert done.exit_code == 0, done.output
    assert counted in done.output
    assert_each_is_named_once(done.stderr)


def test_the_others_are_practised(shared):
    done = run("practice", "--count", 6, "--seed", 1, *shared, input="!\n" * 6)
    assert_each_is_named_once(done.stderr)
    asked = [line for line in done.stdout.splitlines() if line.startswith("Question ")]
    assert len(asked) == 6
    assert {line.partition(": ")[2] for line in asked} == {
        "Some match", "Some order", "Travel time"}  # fmt: skip


def test_the_others_are_served(shared, monkeypatch):
    served = []
    monkeypatch.setattr(
        "quizgen.web.server.run_server", lambda settings, *_a, **_k: served.append(settings)
    )
    done = run("serve", "--database", "sqlite:///here.db", *shared)
    assert_each_is_named_once(done.stderr)
    assert set(served[0].bank.template_paths) == SOUND
    # An author's page reads the folder again, and shows what is wrong with each.
    assert len(served[0].bank.reload()) == len(SOUND) + len(BROKEN)


def test_the_others_are_listed_and_examined(shared):
    listed = run("templates", *shared)
    assert listed.exit_code == 0
    assert set(SOUND) <= {line.split("\t")[0] for line in listed.stdout.splitlines()}
    assert BROKEN["templates/example/some-gap/template.toml"] in listed.stderr
    examined = run("lint", "--seeds", "5", *shared)
    assert examined.exit_code == 1
    for file in BROKEN:
        assert Path(file).name in examined.stderr


def test_what_names_a_broken_one_says_what_is_wrong(shared, tmp_path):
    (tmp_path / "plan.toml").write_text('title.en = "T"\n[[slot]]\ntemplates = ["some-solver"]\n')
    for command in (("exam", "--blueprint", "plan.toml"), ("preview", "some-solver")):
        with pytest.raises(QuizgenError, match=r"some_solver\.py:12: NameError"):
            run(*command, *shared)


def test_other_processes_leave_out_the_same(root):
    sound, broken = leave_out_broken(Bank(root, trusted=True))
    copy = pickle.loads(pickle.dumps(sound))
    assert set(copy.template_paths) == set(sound.template_paths) == SOUND
    assert {name: str(error) for name, error in copy.left_out.items()} == {
        name: str(error) for name, error in broken.items()
    }


def test_python_that_may_not_run_breaks_nothing(root):
    sound, _ = leave_out_broken(Bank(root, trusted=False))
    assert "travel-time" in sound.template_paths


@pytest.mark.parametrize(
    "command",
    [("preview", "travel-time"), ("exam", "--out", "out"), ("templates",)],
    ids=lambda command: command[0],
)
def test_an_error_is_told_in_the_language_of_the_bank(command, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    german = tmp_path / "meine"
    run("new", "bank", german, "--lang", "de")
    rules = german / "templates/example/travel-time/template.toml"
    rules.write_text(rules.read_text("utf-8").replace("s = { range", "s = { rnge"), "utf-8")
    with contextlib.suppress(SystemExit):
        main([*command, "--bank", str(german), "--trust"])
    said = " ".join(capsys.readouterr().err.split())
    assert "template.toml:9: Diesen Schlüssel gibt es nicht" in said
    assert "unknown key 'rnge'; did you mean 'range'?" in said, "what the place is, is kept"
