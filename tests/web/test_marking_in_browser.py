"""Two markers work through the sentences of a class, each in a browser, by keys alone."""

from __future__ import annotations

import csv
import json
import random
import sys
from pathlib import Path

import pytest
from served import Served
from sweep import draws

from quizgen.classes.agreement import agreement_by_item
from quizgen.classes.rulings import DECIDE, SECOND, latest_rulings, read_rulings

sys.path.insert(0, str(Path(__file__).parents[1] / "classes"))
from made import run

BLUEPRINT = """
[title]
en = "Sentences"
[[slot]]
templates = ["ccd-and-cmos-artefacts"]
[[slot]]
templates = ["blur-and-light-factors"]
"""
ITEMS = ("blur-and-light-factors/b", "ccd-and-cmos-artefacts/a", "ccd-and-cmos-artefacts/b")
SENTENCES = (
    "The cone of rays is wider, so the circle of confusion is larger",
    "Because more light comes in",
    "The charges are shifted row by row and the sun spills over",
    "rolling shutter, each row is read after the other",
    "I do not know",
)


def make_class(root: Path, students: int) -> Path:
    """A marked class in which everybody wrote three sentences, some the same as others."""
    (root / "three.toml").write_text(BLUEPRINT, "utf-8")
    with (root / "roster.csv").open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream).writerows(
            [("id", "name"), *((4000 + n, f"Student {n}") for n in range(students))]
        )
    found = root / "class"
    wished = ("--blueprint", root / "three.toml", "--out", found, "--jobs", 1)
    assert run("class", "make", root / "roster.csv", *wished) == 0
    chance = random.Random(7)
    (found / "answers").mkdir()
    for line in (found / "keys.jsonl").read_text("utf-8").splitlines():
        about = json.loads(line)
        answers = {part["id"]: f"{chance.choice(SENTENCES)} {chance.choice(['', '', str(about['id'])])}"
                   for question in about["key"]["questions"] for part in question["parts"]
                   if part["spec"]["kind"] == "rubric"}  # fmt: skip
        (found / "answers" / f"{about['id']}.json").write_text(
            json.dumps({"code": about["code"], "answers": answers}), "utf-8"
        )
    assert run("class", "mark", found) == 0
    return found


def enter(browser, server, name: str):
    """A page on which a marker has said the own name."""
    context = browser.new_context(viewport={"width": 1280, "height": 500})
    context.set_default_timeout(20_000)
    page = context.new_page()
    page.wrong = []
    page.on("console", lambda said: page.wrong.append(said.text))
    page.goto(server.entrance)
    page.goto(f"{server.address}/marking")
    page.fill("[name=who]", name)
    page.press("[name=who]", "Enter")
    page.wait_for_load_state()
    return page


def begin(page, address: str) -> None:
    """Open a card, and remember in the page that it is still the same page."""
    page.goto(address)
    page.wait_for_selector("#decide")
    page.evaluate("window.stays = true; scrollTo(0, 60)")


def press(page, *keys: str) -> None:
    """Press keys of which the last one leads to another card; nothing is loaded anew, nothing jumps."""
    before = page.url
    for key in keys:
        page.keyboard.press(key)
    page.wait_for_function("url => location.href !== url", arg=before)
    if page.query_selector("#decide"):
        assert page.evaluate("[window.stays, scrollY]") == [True, 60]


@pytest.mark.parametrize("students", [draws(6, full=300)])
def test_two_markers_work_through_all_sentences_by_keys(browser, barriers, tmp_path, students):
    folder = make_class(tmp_path, students)
    server = Served(f"sqlite:///{tmp_path / 'l.sqlite3'}", "--class", str(folder), "--workers", "1")
    try:
        one, two = enter(browser, server, "AM"), enter(browser, server, "BN")
        mark_all(one, two, server.address)
        first = latest_rulings(read_rulings(folder), DECIDE)
        whose = [sorted(r.item for r in first.values() if r.who == name) for name in ("AM", "BN")]
        assert all({*items} == {*ITEMS} for items in whose)
        for page in (
            "",
            f"/answer?item={ITEMS[0]}&card={next(g for g, r in first.items() if r.item == ITEMS[0])}",
            f"/list?item={ITEMS[0]}",
        ):
            two.goto(f"{server.address}/marking{page}")
            assert barriers(two) == []
        undo_and_go_on(one, server.address, folder)
        mark_blindly(two, server.address, folder)
        change_rubric(one, server.address, folder)
        one.goto(f"{server.address}/marking")
        one.get_by_role("button", name="Mark the class again").click(timeout=120_000)
        one.get_by_text("The class was marked again").wait_for(timeout=120_000)
        assert one.wrong + two.wrong == []
    finally:
        server.kill()
    assert run("class", "mark", folder) == 0
    assert len((folder / "decisions.csv").read_text("utf-8").splitlines()) == 1  # all is decided


def mark_all(one, two, address: str) -> None:
    """Two markers take turns, each in the own half of every item, until there is nothing left."""
    for item in ITEMS:
        one.goto(f"{address}/marking")
        form = one.locator("form[action='/marking/markers']").filter(
            has=one.locator(f"[value='{item}']")
        )
        form.evaluate("form => { form.closest('details').open = true; }")
        form.locator("[name=first]").fill("AM, BN")
        form.get_by_role("button").click()
        begin(one, f"{address}/marking/answer?item={item}")
        begin(two, f"{address}/marking/answer?item={item}")
        ways = (("0", "1", "Enter"), ("A", "Enter"), ("0", "Enter"))
        for turn in range(2000):
            open_ = [page for page in (one, two) if "/marking/answer" in page.url]
            if not open_:
                break
            page = open_[turn % len(open_)]
            press(page, *ways[turn % len(ways)])
            if "note=taken" in page.url:  # the other one was at the last card, too, and was quicker
                page.goto(f"{address}/marking")


def undo_and_go_on(page, address: str, folder: Path) -> None:
    """Take the last two decisions on an item back, one after the other, and make them again."""
    own = [ruling for ruling in read_rulings(folder) if ruling.who == "AM"]
    steps = [*dict.fromkeys(ruling.step for ruling in own)][-2:]
    assert {ruling.item for ruling in own if ruling.step in steps} == {ITEMS[2]}
    begin(page, f"{address}/marking/answer?item={ITEMS[2]}&card={own[-1].group}")
    for step in reversed(steps):
        press(page, "Z")
        group = next(ruling.group for ruling in own if ruling.step == step)
        page.locator(f"#in-{group}").wait_for(state="attached")
    taken_back = {ruling.group for ruling in own if ruling.step in steps}
    assert not taken_back & latest_rulings(read_rulings(folder), DECIDE).keys()
    for _ in steps:
        press(page, "1", "Enter")
    assert taken_back <= latest_rulings(read_rulings(folder), DECIDE).keys()


def mark_blindly(page, address: str, folder: Path) -> None:
    """A second marker sees no ticks and no points of the first, and differs in some."""
    begin(page, f"{address}/marking/answer?item={ITEMS[0]}&second=1")
    while "/marking/answer" in page.url:
        assert page.locator("[name=line]:checked").count() == 0
        press(page, "1", "Enter")
    found = agreement_by_item(read_rulings(folder))[ITEMS[0]]
    assert found.answers == len(latest_rulings(read_rulings(folder), SECOND))
    page.goto(f"{address}/marking")
    shown = page.get_by_text("Groups marked by two").text_content()
    assert shown.startswith(f"Groups marked by two: {found.answers};")
    if not found.apart:
        return
    page.get_by_role("link", name="with different points").click()
    page.locator("[name=take][value=second]").first.check(force=True)
    page.get_by_role("button", name="These points count").first.click()
    page.wait_for_load_state()
    assert len(agreement_by_item(read_rulings(folder))[ITEMS[0]].apart) == len(found.apart) - 1


def change_rubric(page, address: str, folder: Path) -> None:
    """A line that is worth less moves every mark that was made with it, and says whose."""
    item, line = ITEMS[1], "shift"
    before = [r for r in latest_rulings(read_rulings(folder), DECIDE).values()
              if r.item == item and line in r.lines.split()]  # fmt: skip
    assert before
    begin(page, f"{address}/marking/answer?item={item}&card={before[0].group}")
    page.locator(".rubric-edit > summary").click()
    page.locator(".line-form [name=points]").first.fill("0,5")
    page.locator(".line-form button").first.click()
    page.get_by_text("This would move points").wait_for()
    page.get_by_role("button", name="Change them all").click()
    page.get_by_text("Points that moved:").wait_for()
    assert page.evaluate("window.stays") is True
    after = latest_rulings(read_rulings(folder), DECIDE)
    assert [float(after[r.group].value) for r in before] == [float(r.value) - 0.5 for r in before]
    assert all(after[r.group].because.endswith("(AM)") for r in before)
