"""Whole papers that a scanner reads: fields stand where the keys say, and answers come back."""

from __future__ import annotations

import json
import shutil
from fractions import Fraction

import cv2
import numpy as np
import pikepdf
import pytest
from made import run
from paper_and_pen import PER_MM, Pen, fill_sheet, rasterise, save_scan, scan, spoil
from test_scan import clear_pen, read_answers, read_marks

from quizgen.classes import generation
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.sheet_codes import find_sheet_page

PLAN = """
[title]
en = "Paper"
[[slot]]
templates = ["rods-cones-and-peaks", "exposure-equivalence", "complete-table-of-mixing", "sketch-barrel-or-pincushion", "weak-perspective-scale-error"]
count = 5
"""
pytestmark = pytest.mark.skipif(not shutil.which("pdftoppm"), reason="rasterises with poppler")


@pytest.fixture(scope="module")
def made_class(tmp_path_factory):
    """A class whose papers are scanned, that nobody changes: tests copy it."""
    root = tmp_path_factory.mktemp("class")
    (root / "plan.toml").write_text(PLAN, "utf-8")
    (root / "roster.csv").write_text("id,name,lang\n7,Ada,en\n8,Ben,bn\n", "utf-8")
    wished = ("--blueprint", root / "plan.toml", "--out", root / "class", "--jobs", 1)
    with pytest.MonkeyPatch.context() as same:
        same.setattr(generation, "new_secret", lambda: "5" * 32)
        assert run("class", "make", root / "roster.csv", *wished, "--scan") == 0
    return root / "class"


@pytest.fixture(scope="module")
def lines(made_class):
    found = map(json.loads, (made_class / "keys.jsonl").read_text("utf-8").splitlines())
    return {line["id"]: line for line in found}


@pytest.fixture(scope="module")
def blanks(made_class):
    """The printed pages of each student."""
    return {path.stem: rasterise(path) for path in sorted((made_class / "papers").iterdir())}


def kinds_of(line: dict) -> dict[str, str]:
    return {p["id"]: p["spec"]["kind"] for q in line["key"]["questions"] for p in q["parts"]}


def test_every_part_has_fields_and_every_page_its_marks_and_code(lines, blanks, made_class):
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50))
    for student, line in lines.items():
        sheet, pages = line["sheet"], blanks[student]
        assert (sheet["version"], sheet["pages"]) == (2, len(pages))
        answered = {one["part"] for one in sheet["fields"] if one["kind"] in {"box", "line"}}
        assert answered == kinds_of(line).keys()
        assert {one["part"] for one in sheet["fields"] if one["kind"] == "points"} <= answered
        for number, picture in enumerate(pages, 1):
            page = np.asarray(picture)
            corners, ids, _ = detector.detectMarkers(page)
            assert sorted(ids.ravel()) == [0, 1, 2, 3]
            for mark, own in zip(ids.ravel(), corners, strict=True):
                x, y, side = sheet["marks"][mark]
                middle = np.array([x + side / 2, y + side / 2]) * PER_MM
                assert np.abs(own[0].mean(axis=0) - middle).max() < 1.5
            x, y, side = (value * PER_MM for value in sheet["code"])
            cut = page[: round(y + side + 4), round(x) - 15 : round(x + side) + 15]
            large = cv2.resize(cut, None, fx=4, fy=4, interpolation=cv2.INTER_CUBIC)
            text = cv2.QRCodeDetectorAruco().detectAndDecode(large)[0]
            head, found = find_sheet_page(ClassFolder(made_class), text)
            assert (head.id, found) == (student, number)


def test_fields_stand_where_they_are_printed_and_nothing_is_printed_into_them(lines, blanks):
    count = 0
    for student, line in lines.items():
        for field in line["sheet"]["fields"]:
            page = np.asarray(blanks[student][field["page"] - 1])
            x, y, w, h = (field[name] * PER_MM for name in "xywh")
            assert min(x, y) > 0
            assert x + w < page.shape[1]
            assert y + h < page.shape[0]
            if field["kind"] == "box":
                count += 1
                inner = page[round(y + 4) : round(y + h - 4), round(x + 4) : round(x + w - 4)]
                assert inner.min() > 200, field
                middle = round(x + w / 2), round(y + h / 2)
                edges = (
                    page[round(y) - 1 : round(y) + 4, middle[0]],
                    page[round(y + h) - 4 : round(y + h) + 1, middle[0]],
                    page[middle[1], round(x) - 1 : round(x) + 4],
                    page[middle[1], round(x + w) - 4 : round(x + w) + 1],
                )
                assert max(edge.min() for edge in edges) < 150, field
    assert count >= 8


def test_a_paper_comes_back_as_the_answers_that_were_meant(made_class, lines, blanks, tmp_path):
    folder, line = shutil.copytree(made_class, tmp_path / "class"), lines["8"]
    pages, pen = [page.copy() for page in blanks["8"]], clear_pen(1)
    meant, _ = fill_sheet(pages, line["sheet"]["fields"], kinds_of(line), pen, usual=True)
    for page, how in enumerate(("skew", "phone", "150")[: len(pages)]):
        seen = scan(spoil(pages[page], "punch", pen.random), how, pen.random)
        save_scan(seen, tmp_path / f"{page}", how, upside_down=page == 2)
    assert run("class", "scan", folder, *sorted(tmp_path.glob("*.jpg")), "--jobs", 1) == 0
    answers = read_answers(folder)
    for (student, part), answer in answers.items():
        assert answer == ("see paper" if meant[part] is None else meant[part]), part
        crop = folder / "scans" / lines[student]["code"] / f"{part}.png"
        assert crop.exists() == (meant[part] is None)
    assert {*answers.values()} > {"", "see paper"}
    assert run("class", "mark", folder) == 0
    marks = read_marks(folder)
    assert {key for key, mark in marks.items() if mark is None} == {
        key for key, answer in answers.items() if answer == "see paper"
    }
    check_marked_pages(folder, line, marks)


def check_marked_pages(folder, line: dict, marks: dict) -> None:
    """In the student's own copy, points stand in their boxes: full in green, none in red."""
    assert run("class", "inspect", folder, line["id"]) == 0
    with pikepdf.open(folder / "results" / "inspection" / f"{line['id']}.pdf") as whole:
        shown = [
            pikepdf.PdfImage(picture).as_pil_image()
            for page in whole.pages
            for picture in page.get_images().values()
        ]
    wide = [np.asarray(one.convert("RGB"), int) for one in shown if one.size == (840, 1188)]
    assert len(wide) == line["sheet"]["pages"]
    seen = set()
    for field in (one for one in line["sheet"]["fields"] if one["kind"] == "points"):
        x, y, w, h = (round(4 * field[name]) for name in "xywh")
        red, green, _ = wide[field["page"] - 1][y : y + h, x : x + w].reshape(-1, 3).T
        mark = marks[line["id"], field["part"]]
        if mark is not None and field["part"] in marks_of_whole_or_none(line, marks):
            seen.add(bool(mark))
            most = (green - red if mark else red - green).max()
            assert most > 50, (field, mark)
    assert seen, "something was marked"


def marks_of_whole_or_none(line: dict, marks: dict) -> set[str]:
    """The parts that earned all of their points, or none."""
    worth = {
        p["id"]: float(Fraction(p["points"])) for q in line["key"]["questions"] for p in q["parts"]
    }
    return {part for part, points in worth.items() if marks[line["id"], part] in {0.0, points}}


def test_working_without_an_answer_is_asked_and_a_number_proposed(
    made_class, lines, blanks, tmp_path
):
    folder = shutil.copytree(made_class, tmp_path / "class")
    fields = lines["7"]["sheet"]["fields"]
    pairs = [one for one in fields if one.get("option") and one.get("is_number")]
    room = next(one for one in fields if one["kind"] == "room" and one["page"] != pairs[0]["page"])
    page, first = (blanks["7"][one["page"] - 1].copy() for one in (room, pairs[0]))
    Pen(3).write(page, room | {"h": 8.0, "x": room["x"] + 20}, "57-3")
    for one, sign in zip(pairs, "3124", strict=True):
        clear_pen(4).write_in_cells(first, one, sign, 1)
    for name, picture in (("a", page), ("b", first)):
        save_scan(picture, tmp_path / name, "200")
    run("class", "scan", folder, tmp_path / "a.jpg", tmp_path / "b.jpg", "--jobs", 1)
    report = json.loads((folder / "scans" / "report.json").read_text("utf-8"))["students"]["7"]
    asked = {
        part for part, one in report["parts"].items() if one.get("why", "") not in {"", "missing"}
    }
    assert asked == {room["part"], pairs[0]["part"]}
    proposed = ", ".join(f"{one['option']}:{sign}" for one, sign in zip(pairs, "3124", strict=True))
    assert report["parts"][pairs[0]["part"]]["proposal"] == proposed
    assert f'data-proposal="{proposed}"' in (folder / "scans" / "scans.html").read_text("utf-8")


def test_small_numbers_have_a_slot_for_a_power_of_ten_and_are_proposed_with_it(
    made_class, lines, blanks, tmp_path
):
    """Student 8 asks for 1/2450 and 1/2550, student 7 for 1/192 and 1/208."""
    slots = {
        student: [one["part"] for one in line["sheet"]["fields"] if one.get("option") == "^"]
        for student, line in lines.items()
    }
    assert slots == {"7": [], "8": ["2a", "2a", "2b"]}
    folder = shutil.copytree(made_class, tmp_path / "class")
    fields = [one for one in lines["8"]["sheet"]["fields"] if one["part"] in slots["8"]]
    fields = [one for one in fields if one.get("is_number")]
    page = blanks["8"][0].copy()
    for one, text in zip(fields, ("4.08", "-4", "4.08", "-4", "4", ""), strict=True):
        clear_pen(4).write_in_cells(page, one, text, round(one["w"] / 4))
    save_scan(page, tmp_path / "a", "200")
    run("class", "scan", folder, tmp_path / "a.jpg", "--jobs", 1)
    report = json.loads((folder / "scans" / "report.json").read_text("utf-8"))["students"]["8"]
    said = {part: report["parts"][part]["proposal"] for part in ("2a", "2b")}
    assert said == {"2a": "4.08·10^-4; 4.08·10^-4", "2b": "4"}
    (tmp_path / "in.csv").write_text(f"id,part,answer\n8,2a,{said['2a']}\n", "utf-8")
    run("class", "scan", folder, tmp_path / "in.csv")
    run("class", "mark", folder)
    assert read_marks(folder)["8", "2a"] > 0, "one of both is right"


def test_papers_are_either_scanned_themselves_or_have_sheets(made_class, tmp_path, capsys):
    folder, roster = shutil.copytree(made_class, tmp_path / "class"), made_class / "roster.csv"
    before = {path.name: path.read_bytes() for path in (folder / "papers").iterdir()}
    assert run("class", "make", roster, "--out", folder, "--sheet") == 2
    assert "its papers are read whole; they need no sheets" in capsys.readouterr().err
    assert run("class", "make", roster, "--out", folder, "--sheet", "--scan") == 2
    assert run("class", "make", roster, "--out", folder) == 0
    assert "0 papers made, 2 kept" in capsys.readouterr().out
    (folder / "papers" / "7.pdf").unlink()
    assert run("class", "make", roster, "--out", folder) == 0
    assert {path.name: path.read_bytes() for path in (folder / "papers").iterdir()} == before
    plain = tmp_path / "plain"
    wished = ("--blueprint", made_class.parent / "plan.toml", "--out", plain, "--jobs", 1)
    assert run("class", "make", roster, *wished) == 0
    assert run("class", "make", roster, "--out", plain, "--scan") == 2
    assert "has papers" in capsys.readouterr().err
