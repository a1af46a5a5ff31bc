"""The answer sheet as a scanner sees it: OpenCV finds marks, codes and boxes where the keys say."""

from __future__ import annotations

import json
import shutil
import subprocess

import cv2
import numpy as np
import pikepdf
import pytest
from made import run

from quizgen.classes import generation
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.sheet_codes import find_sheet_page, format_sheet_code
from quizgen.core.errors import ClassError
from quizgen.render.answer_sheet import MARKS

PLAN = """
[title]
en = "Sheet"
[[slot]]
templates = ["rods-cones-and-peaks", "normalise-from-8-bit-range", "exposure-equivalence", "blur-and-light-factors"]
count = 4
[[slot]]
templates = ["bands-of-imaging-methods", "why-pinhole-model", "photo-to-histogram-a"]
count = 2
"""
DPI = 150
PER_MM = DPI / 25.4

pytestmark = pytest.mark.skipif(not shutil.which("pdftoppm"), reason="rasterises with poppler")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    root = tmp_path_factory.mktemp("class")
    (root / "plan.toml").write_text(PLAN.replace(', "photo-to-histogram-a"', ""), "utf-8")
    (root / "roster.csv").write_text("id,name\n7,Ada\n8,Ben\n", "utf-8")
    wished = ("--blueprint", root / "plan.toml", "--out", root / "class", "--sheet", "--jobs", 1)
    with pytest.MonkeyPatch.context() as same:
        same.setattr(generation, "new_secret", lambda: "5" * 32)
        assert run("class", "make", root / "roster.csv", *wished) == 0
    return root / "class"


@pytest.fixture(scope="module")
def scanned(folder):
    """Each page of both sheets in grey, with what the keys say of it."""
    found = []
    for line in map(json.loads, (folder / "keys.jsonl").read_text("utf-8").splitlines()):
        stem = folder.parent / f"scan-{line['id']}"
        pdf = folder / "sheets" / f"{line['id']}.pdf"
        subprocess.run(["pdftoppm", "-r", str(DPI), "-gray", "-png", pdf, stem], check=True, capture_output=True)  # fmt: skip
        pages = sorted(folder.parent.glob(f"{stem.name}-*.png"))
        assert len(pages) == line["sheet"]["pages"]
        for number, path in enumerate(pages, 1):
            found.append((line, number, cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)))
    return found


def test_the_marks_are_those_of_the_dictionary():
    table = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    for number, rows in enumerate(MARKS):
        inner = cv2.aruco.generateImageMarker(table, number, 6)[1:-1, 1:-1]
        assert [[int(bit) for bit in row] for row in rows] == (inner // 255).tolist()


def test_every_mark_is_found_in_its_corner(scanned):
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50))
    for line, _, image in scanned:
        corners, ids, _ = detector.detectMarkers(image)
        assert sorted(ids.ravel()) == [0, 1, 2, 3]
        for mark, own in zip(ids.ravel(), corners, strict=True):
            x, y, side = line["sheet"]["marks"][mark]
            middle = np.array([x + side / 2, y + side / 2]) * PER_MM
            assert np.abs(own[0].mean(axis=0) - middle).max() < 1.5


def test_the_code_of_each_page_leads_to_its_student_and_page(scanned, folder, capsys):
    for line, page, image in scanned:
        x, y, side = (round(value * PER_MM) for value in line["sheet"]["code"])
        cut = image[y - 20 : y + side + 20, x - 20 : x + side + 20]
        tries = (
            reader().detectAndDecode(cv2.resize(cut, None, fx=scale, fy=scale))[0]
            for reader in (cv2.QRCodeDetectorAruco, cv2.QRCodeDetector)
            for scale in (2, 3, 4)
        )
        text = next(filter(None, tries), "")
        head, number = find_sheet_page(ClassFolder(folder), text)
        assert (head.id, number) == (line["id"], page)
    assert run("class", "code", folder, text) == 0
    assert f"8, page {page}" in capsys.readouterr().out


@pytest.mark.parametrize("change", [
    lambda code: code[:-1] + ("0" if code[-1] != "0" else "1"), lambda code: code.replace(":1:", ":2:"),
    lambda code: code.replace("Q1", "Q2"), lambda _: "Q1:", lambda _: "https://example.org/:",
])  # fmt: skip
def test_a_code_that_was_not_signed_is_refused(scanned, folder, change):
    line = scanned[0][0]
    code = format_sheet_code(ClassFolder(folder).settings.secret, line["code"], 1, 1)
    assert find_sheet_page(ClassFolder(folder), code)[1] == 1
    with pytest.raises(ClassError, match="no page of this class"):
        find_sheet_page(ClassFolder(folder), change(code))


def test_boxes_are_black_frames_around_nothing_and_lines_are_free_to_write_on(scanned):
    count = 0
    for line, page, image in scanned:
        for field in (one for one in line["sheet"]["fields"] if one["page"] == page):
            x, y, w, h = (field[name] * PER_MM for name in "xywh")
            inner = image[round(y + 4) : round(y + h - 4), round(x + 4) : round(x + w - 4)]
            if field.get("is_number"):  # lines between its cells stand at the bottom alone
                inner = inner[: -round(2.6 * PER_MM)]
            assert inner.min() > 200, field
            if field["kind"] == "box":
                count += 1
                edges = (image[round(y) - 1 : round(y) + 3, round(x + 8)], image[round(y + 8), round(x) - 1 : round(x) + 3])  # fmt: skip
                assert max(edge.min() for edge in edges) < 110, field
            else:
                below = image[round(y + h) - 2 : round(y + h) + 3, round(x + w / 2)]
                assert below.min() < 200, field
    assert count > 20


def test_every_part_has_its_fields_and_every_option_its_box(scanned):
    for line, page, _ in scanned:
        if page > 1:
            continue
        fields = line["sheet"]["fields"]
        for part in (part for one in line["key"]["questions"] for part in one["parts"]):
            own = [one for one in fields if one["part"] == part["id"]]
            options = [one["option"] for one in own if one["kind"] == "box"]
            kind, spec = part["spec"]["kind"], part["spec"]
            if kind == "tf":
                assert options == ["true", "false"]
            elif kind in {"choice", "multi"}:
                assert options == list("ABCDEFGH"[: len(spec["options"])])
            else:
                assert own


def test_no_two_fields_touch(scanned):
    for line, page, _ in scanned:
        fields = [one for one in line["sheet"]["fields"] if one["page"] == page]
        for at, one in enumerate(fields):
            for other in fields[at + 1 :]:
                apart = (
                    one["x"] + one["w"] < other["x"] or other["x"] + other["w"] < one["x"]
                    or one["y"] + one["h"] < other["y"] or other["y"] + other["h"] < one["y"]
                )  # fmt: skip
                assert apart, (one, other)


def test_who_comes_late_gets_a_sheet_too(folder, tmp_path):
    copy = shutil.copytree(folder, tmp_path / "class")
    roster = copy / "roster.csv"
    roster.write_text(roster.read_text("utf-8-sig") + "9,Cem,,,,,\n", "utf-8")
    assert run("class", "make", roster, "--out", copy, "--jobs", 1, "--one-file") == 0
    with pikepdf.open(copy / "print.pdf") as whole:
        counts = [
            len(pikepdf.open(path).pages)
            for path in [*(copy / "papers").iterdir(), *(copy / "sheets").iterdir()]
        ]
        assert len(whole.pages) == sum(count + count % 2 for count in counts)
    assert sorted(path.stem for path in (copy / "sheets").iterdir()) == ["7", "8", "9"]
