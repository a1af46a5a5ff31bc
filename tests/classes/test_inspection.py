"""Marked papers are shown: what stands there, what is objected, and what becomes of it."""

from __future__ import annotations

import csv
import io

import pikepdf
import pytest
from made import made, run
from PIL import Image

from quizgen.classes.class_folder import ClassFolder
from quizgen.core.untrusted import unescape_csv_formula

ROWS = [("101", "Ada", "en"), ("102", "Ben", "bn"), ("103", "Cem", "en")]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    root = tmp_path_factory.mktemp("class")
    there = made(root, ROWS)
    (root / "in.csv").write_text(f"id,1a,3b\n101,{'9' * 60},=1\n102,6,x\n", "utf-8")
    assert run("class", "mark", there, root / "in.csv") == 0
    return there


def test_an_objection_waits_until_it_is_replied_to(folder, capsys):
    assert run("class", "object", folder, "101", "Q3b", "=it is on the back") == 0
    assert run("class", "object", folder, "102", "1 a", "why?") == 0
    capsys.readouterr()
    assert run("class", "object", folder) == 0
    assert capsys.readouterr().out == (
        "2 objections without a reply:\n101 3b: =it is on the back\n102 1a: why?\n"
    )
    assert run("class", "object", folder, "101", "3b", "half a point more", "--reply") == 0
    capsys.readouterr()
    assert run("class", "object", folder) == 0
    assert "101" not in capsys.readouterr().out
    text = (folder / "objections.csv").read_text("utf-8")
    rows = list(csv.DictReader(io.StringIO(text)))
    assert "\n=" not in text.replace(",", "\n")
    assert [(unescape_csv_formula(row["objection"]), row["reply"]) for row in rows] == [
        ("=it is on the back", ""), ("why?", ""), ("", "half a point more"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("101", "9z", "so"), "has no part '9z'"),
        (("999", "1a", "so"), "nobody of this class"),
        (("101", "1a", "so", "--reply"), "has said nothing about 1a"),
        (("101", "1a", " "), "nothing is said"),
        (("101",), "belong together"),
    ],
)
def test_an_objection_to_nothing_is_refused(folder, capsys, words, said):
    assert run("class", "object", folder, *words) == 2
    assert said in capsys.readouterr().err


def test_each_student_looks_at_marks_and_solutions_in_one_file(folder, capsys):
    assert run("class", "object", folder, "101", "1a", "too strict") == 0
    assert run("class", "inspect", folder) == 0
    made = sorted(path.name for path in (folder / "results" / "inspection").iterdir())
    assert made == ["101.pdf", "102.pdf"]
    assert run("class", "grade", folder) == 0
    page = (folder / "results" / "reports" / "101.html").read_text("utf-8")
    assert "Objection: too strict" in page
    assert "too strict" not in (folder / "results" / "reports" / "102.html").read_text("utf-8")
    with (
        pikepdf.open(folder / "results" / "inspection" / "101.pdf") as whole,
        pikepdf.open(folder / "solutions" / "101.pdf") as solved,
    ):
        assert len(whole.pages) > len(solved.pages)
    capsys.readouterr()
    assert run("class", "inspect", folder, "103") == 2
    assert "103: nothing has been marked" in capsys.readouterr().err


def test_items_stand_in_a_table_by_their_printed_numbers(folder):
    assert run("class", "analyse", folder) == 0
    text = (folder / "results" / "items.csv").read_text("utf-8-sig")
    rows = list(csv.DictReader(io.StringIO(text)))
    assert [row["number"] for row in rows][:3] == ["1a", "1b", "2a"]
    assert rows[0]["item"] == "normalise-from-8-bit-range/a"
    assert {row["students"] for row in rows if row["undecided"] == "0"} == {"2"}


def test_marks_stand_on_the_picture_of_what_is_on_paper(folder, capsys):
    heads = ClassFolder(folder).heads()
    scans = folder / "scans" / heads["101"].code
    scans.mkdir(parents=True)
    Image.effect_noise((600, 150), 90).save(scans / "3b.png")
    assert run("class", "inspect", folder, "101") == 0
    pdf = folder / "results" / "inspection" / "101.pdf"
    with pikepdf.open(pdf) as opened:
        pictures = [image for page in opened.pages for image in page.get_images().values()]
        assert (600, 150) in [(int(one.Width), int(one.Height)) for one in pictures]
    (scans / "3b.png").write_bytes(b"no picture")
    assert run("class", "inspect", folder, "101") == 2
    assert "3b.png: is no picture" in capsys.readouterr().err
