"""``quizgen sheet``: files appear where they are asked for, mistakes are one line."""

from __future__ import annotations

import pytest
from inside import run


def test_both_formats_are_written_and_counted(tmp_path):
    done = run("sheet", "--lang", "both", "--topic", "Distortion", "--out", "s", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert {path.name for path in (tmp_path / "s").iterdir()} == {"formulas.html", "formulas.pdf"}
    assert done.stdout.splitlines()[-1] == "3 formulas in 1 topic"
    assert (tmp_path / "s" / "formulas.pdf").read_bytes().startswith(b"%PDF-")


def test_a_format_and_several_topics_can_be_chosen(tmp_path):
    options = ["--topic", "রঙ,eye", "--format", "HTML", "--lang", "bn"]
    done = run("sheet", *options, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in (tmp_path / "sheet").iterdir()] == ["formulas.html"]
    assert done.stdout.splitlines()[-1] == "9 formulas in 2 topics"


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--format", "docx"], "'docx' (allowed: html, pdf)"),
        (["--topic", "optic"], "'optic' (allowed: projection, normalisation"),
        (["--topic", "camera"], "no formulas of the topic camera here"),
        (["--bank", "empty"], "empty: no formulas here (they stand in templates/cards/formulas.to"),
        (["--bank", "broken"], ": entry 'K1'"),
        (["--format", ""], "no format"),
    ],
)
def test_a_mistake_is_one_line_and_nothing_is_written(tmp_path, options, told):
    (tmp_path / "empty" / "templates").mkdir(parents=True)
    cards = tmp_path / "broken" / "templates" / "cards"
    cards.mkdir(parents=True)
    (cards / "formulas.toml").write_text('[[entry]]\nid = "K1"\n', "utf-8")
    done = run("sheet", *options, cwd=tmp_path)
    assert done.returncode == 2
    assert told in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "sheet").exists()
