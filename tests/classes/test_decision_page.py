"""The page on which an examiner decides: groups, one decision for all that is ticked, a second marker."""

from __future__ import annotations

import csv
import json
import re
import shutil

import pytest
from made import made, run
from starlette.testclient import TestClient

from quizgen.classes.rulings import Ruling, append_rulings, read_rulings
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings

ADDRESS = "http://127.0.0.1:8000"
ITEM = "blur-and-light-factors/b"
SENTENCES = {
    "1": "The cone of rays is wider <b>now</b>",
    "2": "the cone of rays is wider <b>now</b>.",
    "3": "the cone of rays is not wider",
}


@pytest.fixture(scope="module")
def marked(tmp_path_factory):
    """Three students, of whom two say the same and one the contrary; two right answers to the rest."""
    found = made(
        tmp_path_factory.mktemp("class"), [("1", "A", "en"), ("2", "B", "en"), ("3", "C", "bn")]
    )
    (found / "answers").mkdir()
    for line in (found / "keys.jsonl").read_text("utf-8").splitlines():
        about = json.loads(line)
        form = {"code": about["code"], "answers": {"3b": SENTENCES[about["id"]]}}
        (found / "answers" / f"{about['id']}.json").write_text(json.dumps(form), "utf-8")
    assert run("class", "mark", found) == 0
    return found


@pytest.fixture
def folder(marked, tmp_path):
    """The class as it is before anybody decides."""
    return shutil.copytree(marked, tmp_path / "class")


@pytest.fixture
def asked(folder, tmp_path):
    """A browser on the page, and the token of its forms."""
    settings = ServerSettings(f"sqlite:///{tmp_path / 'l.sqlite3'}", workers=1, classroom=folder)
    app = create_app(settings)
    with TestClient(app, ADDRESS) as client:
        client.get(f"/enter?key={app.state.site.settings.token}")
        yield client, csrf_token(client.cookies[COOKIE])


def groups(page: str) -> list[list[str]]:
    """The names of the answers of each group on the page."""
    forms = re.findall(r'action="/class/decide".*?</form>', page, re.DOTALL)
    return [re.findall(r'type="checkbox" name="group" value="(g\w+)"', form) for form in forms]


def test_equal_answers_are_one_group_and_the_contrary_is_another(asked):
    client, _ = asked
    page = client.get("/class").text
    assert [len(group) for group in groups(page)] == [1, 1]
    assert "2 ×" in page
    assert "&lt;b&gt;now&lt;/b&gt;" in page
    assert "<b>now" not in page
    assert "<mark>cone</mark>" in page
    assert "Recognised: “The cone of rays is wider" in page
    assert "Says the contrary: “the cone of rays is not wider”" in page
    ticked = re.findall(r'name="mark" value="([\d.]+:\w+)" id="[\w-]+"( checked)?', page)
    assert [mark for mark in ticked if mark[1]] == [("0.5:cone", " checked")]
    assert len(ticked) == 4  # two criteria in each of two groups


@pytest.mark.parametrize(("marks", "typed", "value", "comment"), [
    (["0.5:cone"], "", "0.5", "cone"),
    (["0.5:cone", "0.5:distances"], "", "1", "cone + distances"),
    (["0.5:cone", "9:cheat"], "", "1", "cone + cheat"),  # never more than the part is worth
    ([], "", "0", ""),
    (["0.5:cone"], "0.25", "0.25", ""),
    (["x:cone"], "", "0", ""),
])  # fmt: skip
def test_ticked_criteria_make_the_points(asked, folder, marks, typed, value, comment):
    client, token = asked
    form = {"token": token, "item": ITEM, "worth": "1", "criteria": "1", "mark": marks}
    client.post("/class/decide", data={**form, "group": ["g1"], "answer-g1": "a", "points": typed})
    (ruling,) = read_rulings(folder)
    assert (ruling.value, ruling.comment) == (value, comment)


def test_what_was_taken_back_is_asked_again(asked, folder):
    client, _ = asked
    before = groups(client.get("/class").text)
    decided = Ruling("decide", ITEM, value="0.5", group=before[0][0])
    append_rulings(folder, [decided])
    assert groups(client.get("/class").text) == before[1:]
    append_rulings(folder, [Ruling("decide", decided.item, group=decided.group)])
    assert groups(client.get("/class").text) == before


def test_one_decision_settles_a_group_and_marking_counts_it(asked, folder):
    client, token = asked
    first = groups(client.get("/class").text)[0]
    form = {
        "token": token,
        "item": ITEM,
        "worth": "1",
        "who": "AM",
        "group": first,
        "comment": "good",
    }
    for points in ("1.3", "2", "", "-1", "half"):
        page = client.post("/class/decide", data={**form, "points": points}).text
        assert "Not written down: Points are given in quarters, from 0 to 1." in page
    page = client.post("/class/decide", data={**form, "group": [], "points": "1"}).text
    assert "Not written down: Tick at least one answer." in page
    assert not (folder / "rulings.csv").exists()
    page = client.post("/class/decide", data={**form, "points": "0,75"}).text
    assert len(groups(page)) == 1
    assert (
        "Marks that changed: 2"
        in client.post("/class/mark", data={"token": token, "who": "AM"}).text
    )
    assert run("class", "grade", folder, "--reports", "none") == 0
    with (folder / "results" / "grades.csv").open(encoding="utf-8-sig", newline="") as stream:
        marks = {row["id"]: row[ITEM] for row in csv.DictReader(stream)}
    assert marks == {"1": "0.75", "2": "0.75", "3": ""}


def test_why_nothing_was_written_down_is_said_in_the_language_of_the_page(asked):
    client, token = asked
    first = groups(client.get("/class").text)[0]
    client.post("/settings", data={"token": token, "lang": "bn", "back": "/class"})
    form = {"token": token, "item": ITEM, "worth": "1", "group": first, "points": "2"}
    page = client.post("/class/decide", data=form).text
    assert "লেখা হয়নি: নম্বর 0 থেকে 1-এর মধ্যে দিতে হবে" in page


def test_a_second_marker_does_not_see_the_first_and_changes_no_mark(asked, folder):
    client, token = asked
    first = groups(client.get("/class").text)[0][0]
    append_rulings(folder, [Ruling("decide", ITEM, SENTENCES["1"], "0.75", group=first)])
    assert run("class", "mark", folder) == 0
    page = client.get("/class?second=1").text
    assert [len(group) for group in groups(page)] == [1]
    assert "0.75" not in page.replace('step="0.25"', "")
    form = {
        "token": token,
        "item": ITEM,
        "worth": "1",
        "who": "BN",
        "second": "1",
        "points": "0.5",
    }
    page = client.post("/class/decide", data={**form, "group": groups(page)[0]}).text
    assert "different points: 1" in page
    assert groups(page) == []
    assert (
        "Marks that changed: 0"
        in client.post("/class/mark", data={"token": token, "who": "AM"}).text
    )


def test_there_is_no_such_page_without_a_class_and_no_form_without_its_token(asked):
    client, _ = asked
    assert client.post("/class/decide", data={"group": "g1", "points": "1"}).status_code == 403
    assert "/class" in client.get("/").text


def test_others_never_reach_it(folder, capsys):
    assert run("serve", "--class", folder, "--host", "0.0.0.0", "--no-open") == 2
    assert "on this machine alone" in capsys.readouterr().err
