"""The marking page: the rubric as buttons, undo, shares, blind second marking, what is settled."""

from __future__ import annotations

import csv
import json
import re
import shutil
import sys
from pathlib import Path

import pytest
from people import ADDRESS as NETWORK
from people import Somebody
from PIL import Image
from starlette.testclient import TestClient

from quizgen.classes.agreement import agreement_by_item
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.markers import read_markers
from quizgen.classes.rubrics import read_rubric
from quizgen.classes.rulings import (
    DECIDE,
    SECOND,
    Ruling,
    append_rulings,
    latest_rulings,
    read_rulings,
)
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings

sys.path.insert(0, str(Path(__file__).parents[1] / "classes"))
from made import made, run

ADDRESS = "http://127.0.0.1:8000"
ITEM = "blur-and-light-factors/b"
PAGE = f"/marking/answer?item={ITEM}"
SENTENCES = {
    "1": "The cone of rays is wider <b>now</b>",
    "2": "the cone of rays is wider <b>now</b>.",
    "3": "the cone of rays is not wider",
    "4": "",
}


@pytest.fixture(scope="module")
def marked(tmp_path_factory):
    """Four students: two say the same, one the contrary, one nothing."""
    names = [("1", "Ada", "en"), ("2", "Bob", "en"), ("3", "Cem", "bn"), ("4", "Dee", "en")]
    found = made(tmp_path_factory.mktemp("class"), names)
    (found / "answers").mkdir()
    for line in (found / "keys.jsonl").read_text("utf-8").splitlines():
        about = json.loads(line)
        form = {"code": about["code"], "answers": {"3b": SENTENCES[about["id"]], "3a": "1"}}
        (found / "answers" / f"{about['id']}.json").write_text(json.dumps(form), "utf-8")
    assert run("class", "mark", found) == 0
    return found


@pytest.fixture
def folder(marked, tmp_path):
    """The class as it is before anybody decides."""
    return shutil.copytree(marked, tmp_path / "class")


class Browser:
    """A browser on the marking pages, as one of several at a server for one person."""

    def __init__(self, app, name: str) -> None:
        self.client = TestClient(app, ADDRESS)
        self.client.get(f"/enter?key={app.state.site.settings.token}")
        self.post("name", who=name)

    def post(self, page: str, **sent):
        token = csrf_token(self.client.cookies[COOKIE])
        return self.client.post(f"/marking/{page}", data={"token": token, "item": ITEM, **sent})

    def get(self, address: str) -> str:
        return self.client.get(address).text

    def decide(self, groups, lines=(), **more) -> str:
        sent = {"card": groups[0], "group": groups, "line": [*lines], **more}
        return self.post("decide", **sent).text


@pytest.fixture
def app(folder, tmp_path):
    settings = ServerSettings(f"sqlite:///{tmp_path / 'l.sqlite3'}", workers=1, classroom=folder)
    found = create_app(settings)
    with TestClient(found, ADDRESS):
        yield found


@pytest.fixture
def first(app):
    return Browser(app, "AM")


@pytest.fixture
def second(app):
    return Browser(app, "BN")


def groups(page: str) -> list[str]:
    """The names of the groups of answers on a card."""
    return re.findall(r'name="group" value="(g\w+)"', page)


def ticked(page: str) -> list[str]:
    return re.findall(r'name="line" value="([\w/-]+)" data-points="[^"]*" checked', page)


def values(folder, what=DECIDE) -> dict[str, str]:
    """What counts of each group."""
    return {group: one.value for group, one in latest_rulings(read_rulings(folder), what).items()}


def test_a_card_shows_the_question_of_this_paper_and_what_was_recognised(first, marked):
    page = first.get(PAGE)
    assert len(groups(page)) == 1
    assert "2 ×" in page
    assert "&lt;b&gt;now&lt;/b&gt;" in page
    assert "<b>now" not in page
    assert "<mark>cone</mark>" in page
    assert ticked(page) == ["cone"]
    stem = page.partition('<div class="stem">')[2].partition("</div>")[0]
    (key,) = (json.loads(line)["key"] for line in (marked / "keys.jsonl").read_text("utf-8").splitlines()
              if json.loads(line)["code"] in page)  # fmt: skip
    given = next(q for q in key["questions"] if q["template"] == ITEM.partition("/")[0])["chain"][
        "given"
    ]
    numbers = {one["value"] for one in given.values() if one["value"].isdigit()}
    assert numbers
    assert all(number in stem for number in numbers)  # those of this student's paper


@pytest.mark.parametrize(("lines", "typed", "value"), [
    (["cone"], "", "0.5"), (["cone", "distances"], "", "1"), (["cone", "cheat"], "", "0.5"), ([], "", "0"),
    (["cone"], "0,25", "0.25"),
])  # fmt: skip
def test_ticked_lines_or_typed_points_are_written_down(first, folder, lines, typed, value):
    card = groups(first.get(PAGE))
    first.decide(card, lines, points=typed, remark="Look again.")
    (ruling,) = read_rulings(folder)
    assert (ruling.value, ruling.who, ruling.comment) == (value, "AM", "Look again.")
    assert ruling.lines == ("" if typed else " ".join(x for x in lines if x != "cheat"))


@pytest.mark.parametrize("points", ["1.3", "2", "-1", "half"])
def test_points_that_cannot_be_are_refused(first, folder, points):
    assert "points are given in quarters" in first.decide(groups(first.get(PAGE)), points=points)
    assert not (folder / "rulings.csv").exists()


def test_an_answer_must_be_ticked_and_the_next_undecided_one_follows(first):
    card = groups(first.get(PAGE))
    assert "tick at least one answer" in first.post("decide", card=card[0]).text
    following = first.decide(card, ["cone"])
    assert groups(following) != card
    assert "1 of 2 groups decided" in following
    assert "All answers here are decided" in first.decide(groups(following))


def test_decisions_become_marks(first, folder):
    first.decide(groups(first.get(PAGE)), points="0.75", remark="good")
    assert "Marks that changed: 2" in first.post("mark").text
    assert run("class", "grade", folder, "--reports", "none") == 0
    with (folder / "results" / "grades.csv").open(encoding="utf-8-sig", newline="") as stream:
        marks = {row["id"]: row[ITEM] for row in csv.DictReader(stream)}
    assert marks == {"1": "0.75", "2": "0.75", "3": "", "4": "0"}


def test_every_decision_is_undone_one_after_the_other(first, folder):
    one = groups(first.get(PAGE))
    two = groups(first.decide(one, ["cone"]))
    first.decide(two)
    first.decide(one, ["cone", "distances"])  # decided anew
    assert values(folder) == {one[0]: "1", two[0]: "0"}
    states = []
    for _ in range(3):
        assert "Taken back." in first.post("undo").text
        states.append(values(folder))
    assert states == [{one[0]: "0.5", two[0]: "0"}, {one[0]: "0.5"}, {}]
    assert "nothing of yours to take back" in first.post("undo", card=one[0]).text
    assert [line.what for line in read_rulings(folder)] == [DECIDE] * 6  # nothing is erased


def test_nobody_undoes_or_overwrites_unseen_what_another_marker_decided(first, second, folder):
    card = groups(first.get(PAGE))
    second.decide(card, ["cone"])
    assert "another marker has decided this meanwhile. BN: 0.5" in first.decide(card, points="0")
    assert "nothing of yours" in first.post("undo").text
    assert values(folder) == {card[0]: "0.5"}
    step = read_rulings(folder)[-1].step
    first.decide(card, points="0", **{f"seen-{card[0]}": step})  # who has seen it may change it
    assert values(folder) == {card[0]: "0"}


def change(browser, line="cone", points="0.25", **more):
    sent = {
        "line": line,
        "text": "The cone",
        "points": points,
        "comment": "The cone: right.",
        **more,
    }
    return browser.post("line", **sent).text


def test_a_changed_line_moves_all_marks_made_with_it_and_says_whose(first, second, folder):
    one = groups(first.get(PAGE))
    other = groups(first.decide(one, ["cone", "distances"], remark="Good."))
    first.decide(other, ["distances"])
    seen = change(first)
    assert "This would move points" in seen
    assert values(folder)[one[0]] == "1"  # nothing counts yet
    done = change(second, sure="1")
    assert "The rubric was changed. Points that moved:" in done
    moved = done.partition('class="moved">')[2].partition("</ul>")[0]
    assert "1 → 0.75" in moved
    assert [name in moved for name in ("Ada", "Bob", "Cem")] == [True, True, False]
    last = read_rulings(folder)[-1]
    assert (last.value, last.who, last.comment) == ("0.75", "AM", "The cone: right.; Good.")
    assert last.because == "rubric: The cone: 0.5 → 0.25 (BN)"
    assert values(folder)[other[0]] == "0.5"
    (mark,) = [
        p for m in mark_again(first, folder) if m.student == "1" for p in m.parts if p.item == ITEM
    ]
    assert (mark.marks, mark.by) == (0.75, "decide (AM), rubric: The cone: 0.5 → 0.25 (BN)")
    change(second, points="0.5", comment="", sure="1")  # taken back
    assert values(folder)[one[0]] == "1"
    assert read_rulings(folder)[-1].comment == "Good."
    assert [entry.who for entry in read_rubric(folder, ITEM).history] == ["BN", "BN"]
    first.decide(one, ["distances"])
    change(second, sure="1")
    first.post("undo")
    assert values(folder)[one[0]] == "0.75"  # by the rubric as it is now


def mark_again(browser, folder):
    browser.post("mark")
    return [*GradingHistory(folder).current()]


def test_a_line_is_added_ticked_and_taken_off_again(first, folder):
    card = groups(first.get(PAGE))
    page = first.post("line", text="Says brightness", points="−0,25", comment="Not that.").text
    (line,) = (one for one in read_rubric(folder, ITEM).lines if one.text == "Says brightness")
    assert f'value="{line.id}"' in page
    first.decide(card, ["cone", line.id])
    assert (values(folder), read_rulings(folder)[-1].comment) == ({card[0]: "0.25"}, "Not that.")
    change(first, line.id, gone="1", sure="1")
    assert (values(folder), read_rulings(folder)[-1].comment) == ({card[0]: "0.5"}, "")
    assert "a line needs a text" in first.post("line", text="", points="1").text
    first.post("undo")  # what was decided before the line went
    assert values(folder) == {}


def test_a_second_marker_sees_nothing_of_the_first_and_moves_no_mark(first, second, folder):
    card = groups(first.get(PAGE))
    first.decide(card, ["cone", "distances"], remark="secret remark")
    page = second.get(f"{PAGE}&card={card[0]}&second=1")
    assert ticked(page) == []
    assert "secret remark" not in page
    assert "AM" not in page
    assert (
        "1 →"
        not in second.post(
            "line", line="cone", text="c", points="0.25", card=card[0], second="1"
        ).text
    )
    second.decide(card, ["cone"], second="1")
    assert (values(folder), values(folder, SECOND)) == ({card[0]: "1"}, {card[0]: "0.5"})
    assert f"card={card[0]}" not in str(first.client.get(f"{PAGE}&second=1").url)
    assert groups(first.get(f"{PAGE}&second=1")) != card  # nobody is the own second marker


def test_what_markers_differ_in_is_settled_and_kappa_stays(first, second, folder):
    card = groups(first.get(PAGE))
    first.decide(card, ["cone", "distances"])
    second.decide(card, ["cone"], second="1")
    assert "Settle 1 with different points" in first.get("/marking")
    page = first.get(f"/marking/apart?item={ITEM}")
    assert "AM: 1" in page
    assert "BN: 0.5" in page
    page = first.post("settle", group=card[0], take="second").text
    assert "differ in nothing that is still to be settled" in page
    last = read_rulings(folder)[-1]
    assert (last.value, last.lines, last.because) == ("0.5", "cone", "settled: AM 1, BN 0.5")
    found = agreement_by_item(read_rulings(folder))[ITEM]
    assert (found.answers, found.kappa, found.apart) == (1, 0, ())
    first.post("undo")
    assert values(folder) == {card[0]: "1"}


def test_markers_share_an_item_and_who_is_second_never_sees_the_first_round(first, second, folder):
    one, two = groups(first.get(PAGE)), None
    first.post("markers", first="AM, BN", second="CK")
    assert read_markers(folder).of(ITEM).first == ("AM", "BN")
    two = groups(second.get(PAGE))
    assert one != two
    assert groups(first.get(PAGE)) == one
    other = Browser(first.client.app, "CK")
    assert "second time" in other.get(f"{PAGE}&card={one[0]}")
    other.decide(one, ["cone"])  # whatever the form says
    assert (values(folder), values(folder, SECOND)) == ({}, {one[0]: "0.5"})


def test_pictures_are_shown_from_the_scans_alone(first, folder):
    codes = {json.loads(line)["id"]: json.loads(line)["code"]
             for line in (folder / "keys.jsonl").read_text("utf-8").splitlines()}  # fmt: skip
    scans = folder / "scans" / codes["4"]
    scans.mkdir(parents=True)
    Image.new("L", (80, 20), 255).save(scans / "3b.png")
    (scans / "1a.png").symlink_to(folder / "class.toml")
    parts = {"3b": {"answer": None, "why": "written", "proposal": "-2.5"}}
    report = json.dumps({"students": {"4": {"parts": parts}}})
    (folder / "scans" / "report.json").write_text(report)  # the last written: all is there
    page = first.get(PAGE + "&card=" + find_blank(first))
    assert 'name="typed" value="-2.5" class="proposed"' in page
    assert "A proposal: compare it with the picture" in page
    assert f'src="/marking/crop/{codes["4"]}/3b"' in page
    assert "(nothing typed)" in page
    client = first.client
    assert client.get(f"/marking/crop/{codes['4']}/3b").headers["content-type"] == "image/png"
    for address in (f"{codes['4']}/1a", f"{codes['1']}/3b", f"{codes['4']}/..%2F..%2Fclass", "..%2F..%2F/3b",
                    f"{codes['4']}/%2e%2e"):  # fmt: skip
        assert client.get(f"/marking/crop/{address}").status_code == 404
    first.decide(groups(page), ["cone"])
    assert {m.student: m.marks for m in mark_again(first, folder)}["4"] == 0.5


def find_blank(browser) -> str:
    """The card of who typed nothing."""
    rows = re.findall(r'card=(g\w+)"><bdi>([^<]*)', browser.get(f"/marking/list?item={ITEM}"))
    return next(card for card, text in rows if text == "(nothing typed)")


def test_names_are_hidden_where_the_class_wishes_so(first, folder):
    assert "Ada (1)" in first.get(PAGE)
    (folder / "exam.toml").write_text("pseudonyms = true\n")
    page = first.get(PAGE)
    assert "Ada" not in page
    assert re.search(r"G-\w{4}-\w{4}-\w{4}-\w{4}", page)


def test_the_page_speaks_the_language_of_the_browser(first):
    token = csrf_token(first.client.cookies[COOKIE])
    first.client.post("/settings", data={"token": token, "lang": "bn", "back": "/marking"})
    assert "খাতা দেখা" in first.get("/marking")
    page = first.decide(groups(first.get(PAGE)), points="2")
    assert "লেখা হয়নি" in page


def test_what_is_not_there_and_what_comes_without_its_token(first):
    assert first.client.get("/marking/answer?item=nothing/a").status_code == 404
    assert first.client.post("/marking/decide", data={"item": ITEM}).status_code == 403
    assert first.post("decide", card="gnone").status_code == 404


def test_who_signs_in_marks_under_that_name_or_learns_of_no_class(folder, tmp_path, monkeypatch):
    monkeypatch.setattr("quizgen.web.accounts.hash_password", fast_hash)
    settings = ServerSettings(
        f"sqlite:///{tmp_path / 'many.sqlite3'}", host="0.0.0.0", workers=1, classroom=folder
    )
    app = create_app(settings)
    with TestClient(app, NETWORK):
        accounts = app.state.site.store.accounts
        farida, rahim = Somebody(app), Somebody(app)
        farida.join(f"/invited?key={accounts.invite(manages=True)}", "Farida")
        rahim.join(f"/invited?key={accounts.invite()}", "Rahim")
        assert rahim.get("/marking").status_code == 404
        assert "/marking" not in rahim.get("/").text
        farida.get("/marking")
        farida.post("/marking/markers", item=ITEM, first="rahim")
        assert "/marking" in rahim.get("/").text
        card = groups(rahim.get(PAGE).text)
        rahim.post("/marking/name", who="Farida")  # a name is that of the account
        rahim.post("/marking/decide", item=ITEM, card=card[0], group=card[0], line="cone")
        assert rahim.post("/marking/markers", item=ITEM, first="x").status_code == 403
    assert read_rulings(folder)[-1].who == "Rahim"


async def fast_hash(password: str) -> str:
    """A hash that costs nothing: how long the real one takes is Argon2's own matter."""
    import argon2

    return argon2.PasswordHasher(time_cost=1, memory_cost=8, parallelism=1).hash(password)


def test_what_was_taken_back_by_hand_is_asked_again(first, folder):
    card = groups(first.get(PAGE))
    append_rulings(folder, [Ruling(DECIDE, ITEM, value="0.5", group=card[0])])
    assert groups(first.get(PAGE)) != card
    append_rulings(folder, [Ruling(DECIDE, ITEM, group=card[0])])
    assert groups(first.get(PAGE)) == card


def test_a_damaged_file_is_named_on_the_page(first, folder):
    (folder / "markers.json").write_text("{")
    assert "markers.json" in first.get("/marking")
    (folder / "markers.json").unlink()
    assert "1 point" in first.get("/marking")


def test_a_phone_of_the_network_never_reaches_it(folder, capsys):
    assert run("serve", "--class", folder, "--phone", "--no-open") == 2
    assert "nobody signs in" in capsys.readouterr().err
