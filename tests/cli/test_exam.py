"""The command as a user meets it: files, codes, and mistakes that cost one clear line."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from inside import run

ROOT = Path(__file__).parents[2]


def cold(*arguments: str, cwd: Path) -> subprocess.CompletedProcess:
    return subprocess.run(
        [sys.executable, "-m", "quizgen", *arguments], capture_output=True, text=True, cwd=cwd,
        check=False,
    )  # fmt: skip


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paper")
    result = cold("exam", "--seed", "4", "--blueprint", "trial", "--lang", "both", "--out", "exam",
                  cwd=folder)  # fmt: skip
    assert result.returncode == 0, result.stderr
    return folder, result


FILES = {"exam.html", "exam.pdf", "solutions.html", "solutions.pdf", "key.json", "answers.toml"}


def test_everything_is_written_and_the_next_step_told(made):
    folder, result = made
    assert {p.name for p in (folder / "exam").iterdir()} == FILES
    assert "quizgen check" in result.stdout
    assert re.search(r"Code: trial-4-both-[0-9a-f]{6}", result.stdout)


def test_the_code_rebuilds_the_same_bytes(made):
    """Here, what another process made."""
    folder, result = made
    code = re.search(r"Code: (\S+)", result.stdout)[1]
    again = run("exam", "--code", code, "--out", "again", cwd=folder)
    assert again.returncode == 0, again.stderr
    for name in FILES:
        assert (folder / "again" / name).read_bytes() == (folder / "exam" / name).read_bytes()


def filled(form: Path) -> bytes:
    form.write_text(form.read_text().replace('"2" = ""', '"2" = "6,67"', 1))
    return form.read_bytes()


TRIAL = ("exam", "--blueprint", "trial", "--format", "html", "--seed")


def test_no_network_is_asked_for(tmp_path, monkeypatch):
    def refuse(*_arguments):
        raise AssertionError("a network was asked for")

    for owner, name in ((socket.socket, "connect"), (socket, "getaddrinfo")):
        monkeypatch.setattr(owner, name, refuse)
    assert run(*TRIAL, "4", "--out", "exam", cwd=tmp_path).returncode == 0
    form = tmp_path / "exam" / "answers.toml"
    filled(form)
    result = run("check", "exam/key.json", "exam/answers.toml", cwd=tmp_path)
    assert result.returncode == 0, result.stderr


def test_a_paper_has_a_folder_of_its_own_named_by_its_code(tmp_path):
    codes = []
    for seed in "45":
        result = run(*TRIAL, seed, cwd=tmp_path)
        codes.append(re.search(r"Code: (\S+)", result.stdout)[1])
    assert sorted(path.name for path in (tmp_path / "exam").iterdir()) == sorted(codes)
    for code in codes:
        assert code in (tmp_path / "exam" / code / "key.json").read_text()


def test_a_filled_form_is_kept_beside_its_own_paper(tmp_path):
    run(*TRIAL, "4", "--out", "o", cwd=tmp_path)
    kept = filled(tmp_path / "o" / "answers.toml")
    assert b"6,67" in kept
    result = run(*TRIAL, "4", "--out", "o", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "left as it is" in result.stdout
    assert (tmp_path / "o" / "answers.toml").read_bytes() == kept


@pytest.mark.parametrize("other", ["4", "5"])
def test_notes_in_a_form_are_kept_or_the_run_refused(tmp_path, other):
    run(*TRIAL, "4", "--out", "o", cwd=tmp_path)
    form = tmp_path / "o" / "answers.toml"
    form.write_text(form.read_text() + "# 3 is the one with the lens: look it up\n")
    kept = {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()}
    result = run(*TRIAL, other, "--out", "o", cwd=tmp_path)
    assert result.returncode == (0 if other == "4" else 2)
    assert (
        "left as it is" if other == "4" else "nothing was written"
    ) in result.stdout + result.stderr
    assert {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()} == kept


def test_a_form_for_spreadsheets_is_written_kept_and_marked(tmp_path):
    made = run(*TRIAL, "4", "--out", "o", "--form", "csv", cwd=tmp_path)
    assert "o/answers.csv" in made.stdout
    assert not (tmp_path / "o" / "answers.toml").exists()
    form = tmp_path / "o" / "answers.csv"
    text = form.read_text("utf-8-sig")
    row = next(line for line in text.splitlines() if line.startswith("1"))
    form.write_text(text.replace(row, f"{row}B"), "utf-8")
    kept = form.read_bytes()
    assert "left as it is" in run(*TRIAL, "4", "--out", "o", "--form", "csv", cwd=tmp_path).stdout
    assert run(*TRIAL, "5", "--out", "o", cwd=tmp_path).returncode == 2
    assert form.read_bytes() == kept
    checked = run("check", "o/key.json", "o/answers.csv", "--json", cwd=tmp_path)
    assert json.loads(checked.stdout)["parts"][0]["typed"] == "B"


def test_a_time_that_the_bank_cannot_fill_is_told(tmp_path):
    short = run("exam", "--topic", "optics", "--minutes", "20", "--seed", "1", "--format", "html",
                cwd=tmp_path)  # fmt: skip
    assert "You asked for" not in short.stdout
    long = run("exam", "--topic", "optics", "--minutes", "500", "--seed", "1", "--format", "html",
               cwd=tmp_path)  # fmt: skip
    assert "You asked for 500 min: topic optics has no more questions" in long.stdout
    assert long.stderr == short.stderr == ""


@pytest.mark.parametrize("name", ["answers.toml", "answers.json", "rahim.toml"])
def test_a_filled_form_is_never_separated_from_its_key(tmp_path, name):
    run(*TRIAL, "4", "--out", "o", cwd=tmp_path)
    code = json.loads((tmp_path / "o" / "key.json").read_text())["code"]
    form = tmp_path / "o" / name
    if name.endswith("json"):
        form.write_text(json.dumps({"code": code, "answers": {"2": "6,67"}}))
    else:
        form.write_bytes((tmp_path / "o" / "answers.toml").read_bytes())
        filled(form)
    before = {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()}
    result = run(*TRIAL, "5", "--out", "o", cwd=tmp_path)
    assert result.returncode == 2
    assert f"holds answers to {code}; nothing was written" in result.stderr
    assert {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()} == before


def test_a_key_whose_answers_may_still_come_is_never_replaced(tmp_path):
    run(*TRIAL, "4", "--out", "o", cwd=tmp_path)
    before = {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()}
    result = run(*TRIAL, "5", "--out", "o", cwd=tmp_path)
    assert result.returncode == 2
    assert "whose answers may still come; nothing was written" in result.stderr
    assert {path.name: path.read_bytes() for path in (tmp_path / "o").iterdir()} == before
    assert run(*TRIAL, "4", "--out", "o", cwd=tmp_path).returncode == 0


def test_a_form_that_cannot_be_read_is_never_overwritten(tmp_path):
    (tmp_path / "o").mkdir()
    form = tmp_path / "o" / "answers.toml"
    form.write_text("half [ broken")
    result = run(*TRIAL, "6", "--out", "o", cwd=tmp_path)
    assert result.returncode == 2
    assert "may hold answers" in result.stderr
    assert form.read_text() == "half [ broken"


def test_the_printed_answers_get_full_marks(made):
    from quizgen.kinds.grade import show_key

    folder, _ = made
    key = json.loads((folder / "exam" / "key.json").read_text())
    answers = {
        part["id"]: show_key(part["spec"], "en")
        for question in key["questions"]
        for part in question["parts"]
    }
    (folder / "typed.json").write_text(json.dumps({"answers": answers}))
    result = run("check", "exam/key.json", "typed.json", "--json", cwd=folder)
    assert result.returncode == 0, result.stderr


MISTAKES = [
    (["exam", "--blueprint", "nothing"], "no blueprint 'nothing'"),
    (["exam", "--format", "docx"], "allowed: html, pdf"),
    (["exam", "--code", "nonsense"], "not a paper's code"),
    (["exam", "--lang", "fr"], "fr"),
    (["exam", "--bank", "missing"], "no such folder, and no bank of this name"),
    (["exam", "--code", "trial-4-en-000000"], "other templates"),
    (["exam", "--code", "trial-4-en-000000", "--seed", "3"], "already fixes"),
    (["exam", "--code", "trial-4-en-000000", "--topic", "optics"], "already fixes"),
    (["exam", "--blueprint", "trial", "--topic", "optics"], "leave --topic"),
    (["preview", "Z99"], "unknown template"),
    (["preview", "optics/thin-lens-limits"], "did you mean thin-lens-limits?"),
    (["frobnicate"], "no command 'frobnicate' (there are exam, check, practice"),
    (["exam", "--seed", "abc"], "'abc' is not a valid whole number"),
    (["lint", "--only", "thin-lens-limit"], "did you mean thin-lens-limits"),
    (["preview", "xyz"], "quizgen templates lists them"),
    (["simulate", "nowhere"], "no scene 'nowhere' (there are fisheye, flat"),
    (["simulate", "my-scene.toml"], "my-scene.toml: No such file"),
]


@pytest.mark.parametrize(("arguments", "message"), MISTAKES, ids=lambda v: str(v)[:40])
def test_mistakes_cost_one_line_and_exit_code_two(tmp_path, arguments, message):
    result = run(*arguments, cwd=tmp_path)
    assert result.returncode == 2
    assert message in result.stderr
    assert "Traceback" not in result.stderr
    assert not list(tmp_path.iterdir())


def test_the_exit_code_reaches_the_shell(tmp_path):
    result = cold(*MISTAKES[0][0], cwd=tmp_path)
    assert (result.returncode, len(result.stderr.splitlines())) == (2, 1)
    assert MISTAKES[0][1] in result.stderr


def test_malformed_templates_are_located(tmp_path):
    folder = tmp_path / "bank" / "templates" / "x" / "bad"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text('topic = "x"\ntier = "A"\nparts = 3\n')
    result = run("lint", "bank", cwd=tmp_path)
    assert result.returncode == 1
    assert "template.toml" in result.stderr
    assert "allowed" in result.stderr


def test_a_missing_translation_is_named(tmp_path):
    folder = tmp_path / "bank" / "templates" / "x" / "half"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(
        'topic = "x"\ntier = "A"\n[[part]]\nanswer = { kind = "tf", true = true }\n'
    )
    (folder / "en.md").write_text("# T\nIs it so?\n")
    (tmp_path / "bank" / "templates" / "bank.toml").write_text('languages = ["en", "bn"]\n')
    result = run("lint", "bank", cwd=tmp_path)
    assert result.returncode == 1
    assert "no bn.md" in result.stderr
    result = run("preview", "half", "--bank", "bank", "--lang", "bn", cwd=tmp_path)
    assert result.returncode == 2
    assert "not written in 'bn'" in result.stderr


def test_a_folder_that_cannot_be_written_leaves_nothing(tmp_path):
    (tmp_path / "taken").write_text("a file, not a folder")
    result = run("exam", "--blueprint", "trial", "--format", "html", "--out", "taken/sub",
                 cwd=tmp_path)  # fmt: skip
    assert result.returncode == 2
    assert "Traceback" not in result.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["taken"]


def test_a_full_disk_leaves_nothing_half_written(tmp_path, monkeypatch):
    from quizgen.core import files
    from quizgen.core.errors import RenderError

    (tmp_path / "a.txt").write_bytes(b"old")
    written = []

    def full(path, data):
        if written:
            raise OSError(28, "No space left on device", str(path))
        written.append(path)
        path.write_bytes(data)

    monkeypatch.setattr(files, "_write_synced", full)
    with pytest.raises(RenderError, match="No space left"):
        files.write_all(tmp_path, {"a.txt": b"new", "b.txt": b"new"})
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == {"a.txt": b"old"}


INTERRUPTED = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
import quizgen.{module} as module
def stopped(*arguments, **options):
    signal.raise_signal(signal.SIGINT)
    raise AssertionError("went on")
module.{function} = stopped
from quizgen.cli.main import main
main(["exam", "--seed", "1", "--blueprint", "trial", "--format", "html", "--out", "o"])
"""
"""A run that is interrupted at a certain place."""


@pytest.mark.parametrize(
    ("module", "function"),
    [
        ("paper.paper", "compose_variant"),
        ("render", "render_paper"),
        ("core.files", "_write_synced"),
    ],
    ids=["composing", "rendering", "writing"],
)
def test_an_interrupted_run_leaves_nothing(tmp_path, module, function):
    code = INTERRUPTED.format(module=module, function=function)
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True,
                          text=True, check=False)  # fmt: skip
    assert done.returncode == 130
    assert done.stderr.splitlines()[-1] == "quizgen: interrupted"
    assert "Traceback" not in done.stderr
    assert not [path for path in tmp_path.rglob("*") if path.is_file()]


def written(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.slow
def test_many_papers_are_the_same_whatever_the_number_of_processes(tmp_path):
    few = ("--blueprint", "trial", "--seed", "4", "--count", "3", "--format", "html")
    for jobs in ("1", "2"):
        assert run("exam", *few, "--jobs", jobs, "--out", jobs, cwd=tmp_path).returncode == 0
    assert written(tmp_path / "1") == written(tmp_path / "2")
    folders = sorted(path.name for path in (tmp_path / "1").iterdir())
    assert [name.split("-")[:3] for name in folders] == [["trial", seed, "en"] for seed in "456"]
    assert {name.split("/")[1] for name in written(tmp_path / "1")} == FILES - {
        "exam.pdf", "solutions.pdf",
    }  # fmt: skip
    run("exam", "--code", folders[1], "--format", "html", "--out", "alone", cwd=tmp_path)
    alone = {f"{folders[1]}/{name}": data for name, data in written(tmp_path / "alone").items()}
    assert alone.items() <= written(tmp_path / "1").items()


def test_of_many_papers_filled_in_forms_stay(tmp_path):
    many = ("exam", "--topic", "eye", "--minutes", "5", "--seed", "4", "--count", "2", "--format",
            "html", "--jobs", "1", "--out", "papers")  # fmt: skip
    run(*many, cwd=tmp_path)
    form = min((tmp_path / "papers").rglob("answers.toml"))
    form.write_text(form.read_text().replace('"1" = ""', '"1" = "mine"').replace(
        '"1a" = ""', '"1a" = "mine"'))  # fmt: skip
    before = form.read_text()
    assert "mine" in before
    again = run(*many, cwd=tmp_path)
    assert (again.returncode, form.read_text()) == (0, before)


@pytest.mark.parametrize("words", [("--code", "mock-1-en-000000"), ("--reference",),
                                   ("--seed", "1000000000")])  # fmt: skip
def test_what_many_papers_cannot_have_in_common_is_refused(tmp_path, words):
    done = run("exam", "--count", "2", *words, cwd=tmp_path)
    assert done.returncode == 2
    assert "--count" in done.stderr
    assert list(tmp_path.iterdir()) == []


HEEDS = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background it is ignored
from quizgen.cli.main import main
main()
"""


@pytest.mark.slow
def test_interrupted_while_it_makes_many_papers_leaves_whole_ones(tmp_path):
    """Of each paper all files, or none: no half of one and nothing besides."""
    process = subprocess.Popen(
        [sys.executable, "-c", HEEDS, "exam", "--blueprint", "trial", "--seed", "1", "--count", "60",
         "--format", "html", "--jobs", "2", "--out", "papers"],
        cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    deadline = time.monotonic() + 60
    while len(list((tmp_path / "papers").glob("trial*"))) < 3 and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    assert process.wait(60) == 130
    papers = [path for path in (tmp_path / "papers").iterdir() if not path.name.startswith(".")]
    assert 3 <= len(papers) < 60
    for paper in papers:
        assert {path.name for path in paper.iterdir()} == FILES - {"exam.pdf", "solutions.pdf"}
