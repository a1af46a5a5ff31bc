"""A quiz that Moodle played, as a class: the files are its own (``tests/lms/moodle``).

What Ben gave, and what it is worth, was worked out by hand there.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path

import pytest
from made import run

from quizgen.classes import analysis_page
from quizgen.classes.variant_difficulty import ValueGroup, VariantEffect
from quizgen.figures.alt_text import strip_mathtext

HERE = Path(__file__).parents[1] / "lms" / "moodle"
KEYS = HERE / "quiz.keys.jsonl"
BEN = [1, 3.75, 0, 0, 0, 1, 0, 0, 3, 0, 0, 4, 0, 1.5, 0]
"""Marks of 1, 2, 3, 4a, 4b, 4c, 5a, 5b, 6, 7, 8b, 9a, 10, 11a and 11b."""


def table(path: Path) -> dict[str, dict[str, str]]:
    with path.open(encoding="utf-8-sig", newline="") as stream:
        return {row["id"]: row for row in csv.DictReader(stream)}


@pytest.fixture(scope="module", params=["responses.csv", "responses.json"])
def taken(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("quiz") / "quiz"
    assert run("class", "take", KEYS, HERE / request.param, "--out", folder) == 0
    assert run("class", "mark", folder) == 0
    assert run("class", "grade", folder, "--reports", "html") == 0
    return folder


def test_marks_are_those_of_the_quiz(taken):
    rows = table(taken / "results/grades.csv")
    assert {one: row["points"] for one, row in rows.items()} == {
        "78": "", "1815": "27", "0042": "14.25", "77": "27",
    }  # fmt: skip
    assert {row["of"] for one, row in rows.items() if one != "78"} == {"31"}
    assert rows["78"]["remark"] == "no answers"
    items = [*rows["0042"]][[*rows["0042"]].index("remark") + 1 :]
    worth = {part: marks for part, marks in zip(items, BEN, strict=False) if "/" not in part}
    assert {part: float(rows["0042"][part]) for part in worth} == worth
    assert sum(float(rows["0042"][part]) for part in items) == sum(BEN)


def test_a_quiz_is_decided_regraded_and_analysed_like_a_class(taken, capsys):
    item = next(one for one in table(taken / "results/grades.csv")["0042"] if one.endswith("/a"))
    assert run("class", "rule", taken, "give", item, "--who", "AM") == 0
    assert run("class", "mark", taken) == 0
    assert f"({item}): " in capsys.readouterr().out
    assert run("class", "rule", taken, "restore", item, "--who", "AM") == 0
    assert run("class", "mark", taken) == 0
    assert run("class", "analyse", taken) == 0
    assert (taken / "results/reports/0042.html").exists()


@pytest.mark.parametrize(
    ("lang", "said"),
    [("en", "Options never chosen"), ("bn", "যে অপশন কেউ বাছেনি"), ("de", "Nie gewählte Antworten")],
)
def test_the_analysis_speaks_the_language_that_is_asked_for(taken, lang, said):
    assert run("class", "analyse", taken, "--lang", lang) == 0
    page = (taken / "results/analysis.html").read_text("utf-8")
    assert f'<html lang="{lang}">' in page
    assert f"<th>{said}</th>" in page
    assert (page.count("@font-face") > 1) == (lang == "bn")
    page = re.sub(r"<svg.*?</svg>", "", page, flags=re.DOTALL)
    # 27, 14.25 and 27 points: 22.75 each, 7.36 apart
    assert [said in page for said in ("22,8", "7,4")] == [lang == "de"] * 2
    assert [said in page for said in ("22.8", "7.4")] == [lang != "de"] * 2
    numbers = " ".join(re.findall(r'<td class="number[^>]*>(.*?)</td>', page))
    assert set(re.findall(r"\d([.,])\d", numbers)) == {"," if lang == "de" else "."}


@pytest.mark.parametrize(("lang", "sign"), [("en", "."), ("bn", "."), ("de", ",")])
def test_the_plots_have_the_decimal_sign_of_the_language(lang, sign):
    effect = VariantEffect(
        "t", "q", (ValueGroup("0.5", 9, 0.25, 0.1), ValueGroup("1.5", 9, 0.5, 0.1)), 0.01
    )
    items = analysis_page.plot_items([("1", 0.4, 0.3), ("2", 0.8, 0.1)], lang, "Items.")
    for figure in (items, analysis_page.plot_effect(effect, lang, "An effect.")):
        labels = " ".join(strip_mathtext(label.text) for label in figure.labels)
        assert set(re.findall(r"\d([.,])\d", labels)) == {sign}
    missed_by_the_best = analysis_page.plot_items([("1", 0.4, -0.3)], lang, "Items.")
    assert any(label.text.startswith("${−") for label in missed_by_the_best.labels)


def test_a_later_report_adds_people_and_changes_nobodys_answers(tmp_path, capsys):
    lines = (HERE / "responses.csv").read_text("utf-8-sig").splitlines(keepends=True)
    first, later = tmp_path / "first.csv", tmp_path / "later.csv"
    first.write_text("".join(lines[:3]), "utf-8")
    lines[2] = lines[2].replace("4. It returns 20.0.", "3. It stops with an IndexError.")
    later.write_text("".join(lines), "utf-8")
    folder = tmp_path / "quiz"
    assert run("class", "take", KEYS, first, "--out", folder) == 0
    before = {path.name: path.read_bytes() for path in (folder / "answers").iterdir()}
    assert [*before] == ["1815.json"]
    assert run("class", "take", KEYS, later, "--out", folder) == 0
    said = capsys.readouterr().out
    assert "Ada Lovelace: has other answers there than in this report; those there stay" in said
    assert "Cem Öz: 2 attempts, the last one counts" in said
    after = {path.name: path.read_bytes() for path in (folder / "answers").iterdir()}
    assert len(after) == 3
    assert before.items() <= after.items()
    assert run("class", "make", folder / "roster.csv", "--out", folder) == 2
    assert "has no papers" in capsys.readouterr().err


def test_what_is_asked_back_in_the_quiz_waits_for_a_decision(tmp_path):
    """Of Cem's first attempt two answers cannot be read, and nothing else is worth anything."""
    lines = (HERE / "responses.csv").read_text("utf-8-sig").splitlines(keepends=True)
    (tmp_path / "cem.csv").write_text("".join([lines[0], lines[4]]), "utf-8")
    assert run("class", "take", KEYS, tmp_path / "cem.csv", "--out", tmp_path / "quiz") == 0
    assert run("class", "mark", tmp_path / "quiz") == 0
    assert run("class", "grade", tmp_path / "quiz", "--reports", "none") == 0
    row = table(tmp_path / "quiz/results/grades.csv")["77"]
    assert (row["points"], row["of"], row["undecided"]) == ("0", "31", "2")


def test_a_class_with_papers_takes_no_quiz(tmp_path, capsys):
    (tmp_path / "notes.txt").touch()
    assert run("class", "take", KEYS, HERE / "responses.csv", "--out", tmp_path) == 2
    assert "something else than a class" in capsys.readouterr().err
