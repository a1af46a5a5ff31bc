"""What stands on a picture is typed on the marking page: judged with the own key, kept, undone."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil

import pytest
from PIL import Image
from starlette.testclient import TestClient
from test_marking_page import ADDRESS, Browser, made, run

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.scanning.scan_folder import ScanFolder
from quizgen.web.app import create_app
from quizgen.web.settings import ServerSettings

ITEM = "blur-and-light-factors/a"


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    """Two students whose part 3a stands on a picture."""
    found = made(tmp_path_factory.mktemp("class"), [("1", "Ada", "en"), ("2", "Bob", "en")])
    rows = ["id,part,answer"]
    for line in map(json.loads, (found / "keys.jsonl").read_text("utf-8").splitlines()):
        place = found / "scans" / line["code"]
        place.mkdir(parents=True)
        Image.new("L", (60, 20), 255).save(place / "3a.png")
        rows.append(f"{line['id']},3a,see paper")
    (found / "answers").mkdir()
    (found / "answers" / "scan.csv").write_text("\n".join(rows) + "\n", "utf-8")
    assert run("class", "mark", found) == 0
    return found


@pytest.fixture
def folder(scanned, tmp_path):
    return shutil.copytree(scanned, tmp_path / "class")


@pytest.fixture
def marker(folder, tmp_path):
    settings = ServerSettings(f"sqlite:///{tmp_path / 'l.sqlite3'}", workers=1, classroom=folder)
    app = create_app(settings)
    with TestClient(app, ADDRESS):
        yield Browser(app, "AM")


def last_marks(folder) -> dict[str, tuple[str, float | None]]:
    """What was typed in 3a, and its marks, by student."""
    path = max((folder / "marks").glob("*.jsonl"))
    return {
        one["student"]: next((p["typed"], p["marks"]) for p in one["parts"] if p["id"] == "3a")
        for one in map(json.loads, path.read_text("utf-8").splitlines())
    }


def test_an_answer_is_typed_beside_its_picture_and_counts_when_marked_again(marker, folder):
    lines = map(json.loads, (folder / "keys.jsonl").read_text("utf-8").splitlines())
    right = {line["id"]: line["key"]["questions"][2]["parts"][0]["spec"]["value"] for line in lines}
    assert last_marks(folder) == {"1": ("see paper", None), "2": ("see paper", None)}
    page = marker.get(f"/marking/answer?item={ITEM}")
    assert 'class="crop"' in page
    group = re.search(r'id="read-(g\w+)"', page)[1]
    code = re.search(r"<bdi>(G-[\w-]+)</bdi>", page)[1]
    whose = next(who for who in "12" if ClassFolder(folder).find_by_code(code).head.id == who)
    other = {"1": "2", "2": "1"}[whose]
    following = marker.post("typed", item=ITEM, group=group, typed=right[whose]).text
    assert f"Taken as typed: 3a: {right[whose]} → 1" in following
    second = re.search(r'id="read-(g\w+)"', following)[1]
    assert second != group, "the next picture"
    assert "All answers here" in marker.post("typed", item=ITEM, group=second, typed="17").text
    rows = [*csv.reader(io.StringIO((folder / "scans" / "typed.csv").read_text("utf-8-sig")))]
    assert [row[:4] for row in rows[1:]] == [
        [whose, "3a", right[whose], "AM"],
        [other, "3a", "17", "AM"],
    ]
    marker.post("mark")
    assert last_marks(folder) == {whose: (right[whose], 1.0), other: ("17", 0.0)}


def test_what_was_typed_is_taken_back_and_nothing_is_lost(marker, folder):
    page = marker.get(f"/marking/answer?item={ITEM}")
    group = re.search(r'id="read-(g\w+)"', page)[1]
    marker.post("typed", item=ITEM, group=group, typed="5")
    assert 'value="5"' in marker.get(f"/marking/answer?item={ITEM}&card={group}")
    assert "Taken back." in marker.post("typed", item=ITEM, group=group, back="1").text
    assert group in marker.get(f"/marking/answer?item={ITEM}"), "it is open again"
    rows = (folder / "scans" / "typed.csv").read_text("utf-8-sig").splitlines()[1:]
    assert [row.split(",")[2] for row in rows] == ["5", "see paper"]
    marker.post("mark")
    assert {mark for _, mark in last_marks(folder).values()} == {None}
    assert marker.post("typed", item=ITEM, group="g0123456789", typed="5").status_code == 404
    assert {*ScanFolder(ClassFolder(folder)).read_typed().values()} == {"see paper"}
