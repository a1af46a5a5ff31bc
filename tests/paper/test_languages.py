"""A language is a folder: papers, keys, forms and commands take one up without any Python."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from small_bank import ONE, copied, fresh

from quizgen import locale
from quizgen.locale import list_language_choices, list_languages, resolve_language_choice
from quizgen.paper.answer_form import read_filled_form, write_blank_form
from quizgen.paper.answer_key import read_answer_key, write_answer_key
from quizgen.paper.blueprint import topic_blueprint
from quizgen.paper.code import parse_code
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import build_paper, rebuild_paper
from quizgen.render import KINDS, RENDERERS, render_paper

SHIPPED = Path(locale.__file__).parent


def grown(root: Path) -> Path:
    """A folder with one more language, Pig Latin; its words are the English ones, marked."""
    folder = root / "locale" / "pig"
    shutil.copytree(SHIPPED / "en", folder)
    (folder / "language.toml").write_text(
        'name = "Igpay"\nenglish = "Pig"\norder = 9\nscript = "Latn"\n'
    )
    words = (folder / "interface.toml").read_text("utf-8")
    (folder / "interface.toml").write_text(words.replace('"Mock exam"', '"Ockmay examay"'), "utf-8")
    return folder.parent


@pytest.fixture
def pig(tmp_path, monkeypatch):
    """A bank that is written in three languages, one of which lies outside the package."""
    folder = copied(tmp_path)
    text = (folder / "en.md").read_text("utf-8")
    (folder / "pig.md").write_text(text.replace("A pinhole camera", "A inholepay"), "utf-8")
    monkeypatch.setattr(locale, "PLACES", [*locale.PLACES, grown(tmp_path)])
    return tmp_path


def test_a_language_is_found_and_can_be_chosen(pig):
    assert list_languages() == ("en", "bn", "de", "pig")
    assert list_language_choices() == ("en", "bn", "de", "pig", "both")
    assert resolve_language_choice("pig", ("en",)) == ("pig",)
    assert resolve_language_choice("both", fresh(pig).languages) == ("en", "bn", "pig")
    assert topic_blueprint(fresh(pig), "projection").title["pig"].startswith("Ockmay examay")


@pytest.mark.parametrize("choice", ["pig", "both"])
def test_a_paper_is_made_printed_kept_and_marked_in_it(pig, tmp_path, choice):
    paper = build_paper(fresh(pig), ONE, 3, choice)
    assert parse_code(paper.code).choice == choice
    assert rebuild_paper(fresh(pig), paper.code, ONE).code == paper.code
    printed = {name: render_paper(paper, kind, name) for name in RENDERERS for kind in KINDS}
    assert "A inholepay" in printed["html"].decode()
    assert printed["pdf"].startswith(b"%PDF")
    key, form = tmp_path / "key.json", tmp_path / "answers.toml"
    key.write_bytes(write_answer_key(paper))
    form.write_bytes(write_blank_form(paper))
    assert json.loads(key.read_text())["langs"] == list(paper.langs)
    assert tomllib.loads(form.read_text())["student"]["lang"] == paper.langs[0]
    result = grade_paper(read_answer_key(key), {"1": "((("}, "pig")
    assert result.parts[0].verdict.message == grade_paper(
        read_answer_key(key), {"1": "((("}, "en"
    ).parts[0].verdict.message  # fmt: skip
    assert read_filled_form(form).is_blank


COMMAND = """
import sys
from pathlib import Path
from quizgen import locale
locale.PLACES.append(Path(sys.argv[1]))
from quizgen.cli.main import main
for arguments in (
    ["preview", "point-to-image-plane"],
    ["practice", "--count", "1", "--fresh"],
    ["exam", "--topic", "projection", "--format", "html", "--out", "exam"],
):
    main([*arguments, *sys.argv[2:]])
    sys.stdin = open("typed")
    print("\f")
"""


@pytest.mark.slow
def test_commands_offer_it(pig, tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    bank = ["--lang", "pig", "--bank", str(pig), "--trust"]
    (tmp_path / "typed").write_text("!\n" * 9)
    done = subprocess.run([sys.executable, "-c", COMMAND, str(pig / "locale"), *bank], text=True,
                          capture_output=True, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
    preview, practice, _, _ = done.stdout.split("\f")
    page = (tmp_path / "exam" / "exam.html").read_text("utf-8")
    assert [text for text in (preview, practice, page) if "A inholepay" not in text] == []


def test_without_its_folder_it_is_refused(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "quizgen", "exam", "--lang", "pig"],
        capture_output=True, text=True, check=False, cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 2
    assert "'pig' (allowed: en, bn, both)" in done.stderr
