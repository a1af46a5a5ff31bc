"""What stands on covers and on lists of a room, and what does not."""

from __future__ import annotations

import math
import re
import shutil
import subprocess

import pytest
from made import made, run

from quizgen.classes.exam_details import read_exam_details
from quizgen.core.errors import ClassError

ABOUT = """
course = "Bildverarbeitung I"
date = 2027-02-12
room = "HS 9"
examiner = "Prof. Ö. Beispiel"
signature = true
[title]
en = "Exam: light"
bn = "পরীক্ষা: আলো"
[rules]
en = ["Phones are off.", "#hash $x$ \\\\ *bold*"]
"""
ROSTER = "id,name,lang,extra,group,seat\n7,Ada,en,25%,HS1,3\n8,Ben,both,,HS1,4\n9,Cem,en,,,\n"

pytestmark = pytest.mark.skipif(not shutil.which("pdftotext"), reason="reads PDF with poppler")


def text(path, *options):
    done = subprocess.run(["pdftotext", "-layout", *options, path, "-"], capture_output=True, check=True)  # fmt: skip
    return re.sub(r" +", " ", done.stdout.decode())


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    root = tmp_path_factory.mktemp("class")
    there = made(root, [("7", "Ada", "en")])
    (root / "about.toml").write_text(ABOUT, "utf-8")
    (root / "all.csv").write_text(ROSTER, "utf-8")
    wished = ("--out", there, "--about", root / "about.toml", "--jobs", 1)
    assert run("class", "make", root / "all.csv", *wished) == 0
    assert run("class", "lists", there) == 0
    return there


def test_the_cover_names_course_date_room_seat_examiner_and_rules(folder):
    cover = text(folder / "papers" / "7.pdf", "-l", "1")
    for line in ("Exam: light", "Course Bildverarbeitung I", "Date 2027-02-12", "Room HS1", "Seat 3",
                 "Examiner Prof. Ö. Beispiel", "Phones are off.", r"#hash $x$ \ *bold*", "Signature"):  # fmt: skip
        assert line in cover
    assert "Room HS 9" in text(folder / "papers" / "9.pdf", "-l", "1")
    assert "Course" not in text(folder / "solutions" / "7.pdf", "-l", "1")


def test_more_time_shows_on_no_paper_and_on_no_list_that_neighbours_read(folder):
    minutes = re.findall(r"\d+ min", text(folder / "papers" / "7.pdf"))
    whole = int(minutes[0].split()[0])
    watched = text(folder / "lists" / "more-time.pdf")
    assert f"HS1 3 7 Ada 25% {whole} + {math.ceil(whole / 4)}" in watched
    assert "Ben" not in watched
    assert minutes == re.findall(r"\d+ min", text(folder / "papers" / "9.pdf"))
    for name in ("attendance.pdf", "seats.pdf"):
        assert "25%" not in text(folder / "lists" / name)


def test_lists_name_rooms_and_seats(folder):
    attendance = text(folder / "lists" / "attendance.pdf")
    assert attendance.index("Room HS 9") < attendance.index("9 Cem") < attendance.index("Room HS1")
    assert "3 7 Ada" in attendance
    seats = text(folder / "lists" / "seats.pdf")
    assert "7 HS1 3" in seats
    assert "Ada" not in seats


def test_another_cover_makes_papers_again_with_the_same_questions(folder, tmp_path, capsys):
    copy = shutil.copytree(folder, tmp_path / "class")
    keys = (copy / "keys.jsonl").read_text("utf-8")
    about = copy / "exam.toml"
    about.write_text(about.read_text("utf-8").replace("2027-02-12", "2027-02-19"), "utf-8")
    assert run("class", "make", copy / "roster.csv", "--out", copy, "--jobs", 1) == 0
    assert "3 papers made, 0 kept" in capsys.readouterr().out
    assert "Date 2027-02-19" in text(copy / "papers" / "7.pdf", "-l", "1")
    strip = re.compile(r'"stamp":"\w+"')
    assert strip.sub("", (copy / "keys.jsonl").read_text("utf-8")) == strip.sub("", keys)


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("curse = 1", "curse"),
        ("course = 3", "course"),
        ('rules = "x"', "rules"),
        (f'course = "{"x" * 501}"', "course: longer than 500"),
        ('keep_until = "soon"', "keep_until"),
        ("course = ", "TOML"),
    ],
)
def test_what_cannot_stand_there_is_named_with_its_key(tmp_path, written, said):
    path = tmp_path / "exam.toml"
    path.write_text(written, "utf-8")
    with pytest.raises(ClassError, match=said):
        read_exam_details(path)
