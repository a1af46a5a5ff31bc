"""An exam in Chromium: nothing that was typed may be lost."""

from __future__ import annotations

import re

import pytest
from keys import Keys
from playwright.sync_api import expect
from sqlalchemy import update

from quizgen.store import Store
from quizgen.store.schema import SITTING

pytestmark = pytest.mark.browser

SAVED = "All answers are saved."
AWAY = re.compile("does not answer")


@pytest.fixture
def exam(opened, served):
    def begun(*, clock: bool = False, paper: str = "trial", **how):
        page = opened(**how)
        page.goto(served.address + "/exam")
        page.get_by_label("Paper", exact=True).select_option(paper)
        if not clock:
            page.get_by_text("More", exact=True).click()
            page.get_by_label("with the clock running").uncheck()
        page.get_by_role("button", name="Begin the exam").click()
        expect(page.locator("#exam")).to_be_visible()
        page.wait_for_load_state()  # then its script has run
        return page

    return begun


def boxes(page):
    """The first field of each part that is typed."""
    return page.locator("#exam fieldset[data-part] input[id$='-0'][type=text]")


def shown(field):
    """A field, once its question is the one on the screen."""
    field.evaluate("field => { location.hash = field.closest('.question').id; }")
    expect(field).to_be_visible()
    return field


def hand_in(page):
    """Ask to hand in, and say so again where it is asked whether that is meant."""
    page.get_by_role("button", name="Hand in").click()
    expect(page.get_by_text("After that nothing can be changed any more.")).to_be_visible()
    page.get_by_role("button", name="Hand in").click()


def forgive(opened):
    """What browsers say of a server that is dead or out of reach."""
    dead = re.compile("ERR_(CONNECTION|SOCKET|CONTENT_LENGTH|EMPTY|INTERNET)|Failed to fetch")
    opened.wrong[:] = [one for one in opened.wrong if not dead.search(one)]


def typed(page, number: int, text: str):
    shown(boxes(page).nth(number)).fill(text)
    expect(page.locator("#kept")).to_have_text(SAVED)


def test_a_reload_and_the_way_back_keep_what_was_typed(exam, served):
    page = exam(paper="mock")
    typed(page, 0, "12.5")
    shown(page.locator("#exam input[type=radio]").first).check()
    page.reload()
    expect(boxes(page).first).to_have_value("12.5")
    expect(page.locator("#exam input[type=radio]").first).to_be_checked()
    shown(boxes(page).first).fill("13")
    page.goto(served.address + "/")
    page.go_back()
    expect(boxes(page).first).to_have_value("13")


def test_what_is_saved_while_the_next_page_is_on_its_way_stands_in_it(exam):
    page = exam(paper="mock")
    read_before = page.context.request.get(page.url)
    chosen = page.locator("#exam input[type=radio]").first
    shown(chosen).check()
    kept = page.locator(f"[name={chosen.get_attribute('name').replace('a-', 'on-')}]")
    saved = f'["{chosen.get_attribute("value")}"]'
    expect(kept).to_have_value(saved)  # the server has it
    page.route(page.url, lambda route: route.fulfill(response=read_before))
    page.reload()
    expect(chosen).to_be_checked()
    expect(kept).to_have_value(saved)
    page.unroute_all()


def test_what_another_tab_saved_later_is_not_written_over(exam):
    page = exam()
    typed(page, 0, "12.5")
    other = page.context.new_page()
    other.goto(page.url)
    typed(other, 0, "7")
    page.reload()
    expect(boxes(page).first).to_have_value("7")


def test_what_is_typed_before_the_script_runs_is_saved(exam):
    page, late = exam(), []
    page.route("**/static/app.js", lambda route: late.append(route))  # noqa: PLW0108 (Playwright marks what it is given)
    with page.expect_request("**/static/app.js"):
        page.reload(wait_until="commit")
    boxes(page).first.fill("8.25")
    late[0].continue_()
    expect(page.locator("#kept")).to_have_text(SAVED)
    page.unroute_all()
    page.reload()
    expect(boxes(page).first).to_have_value("8.25")


def test_a_second_click_begins_no_second_exam(opened, served):
    page = opened()
    page.goto(served.address + "/exam")
    before = page.locator("main li").count()
    button = page.get_by_role("button", name="Begin the exam")
    button.evaluate("button => { button.click(); setTimeout(() => button.click(), 200); }")
    expect(page.locator("#exam")).to_be_visible()
    page.goto(served.address + "/exam")
    expect(page.locator("main li")).to_have_count(before + 1)


def test_enter_keeps_and_changes_nothing_else(exam):
    page = exam()
    shown(boxes(page).first).fill("7")
    shown(boxes(page).first).press("Enter")
    expect(page.locator("#kept")).to_have_text(SAVED)
    expect(boxes(page).first).to_be_focused()
    expect(page.locator(".flagged")).to_have_count(0)


def test_nothing_is_said_to_be_saved_while_it_waits(exam):
    page = exam()
    typed(page, 0, "12.5")
    said = boxes(page).first.evaluate("""field => {
        field.value = "13";
        field.dispatchEvent(new Event("input", { bubbles: true }));
        return document.getElementById("kept").textContent;
    }""")
    assert said == ""
    expect(page.locator("#kept")).to_have_text(SAVED)
    page.reload()
    expect(boxes(page).first).to_have_value("13")


def test_a_page_that_was_open_before_loses_nothing_of_another(exam):
    one = exam()
    two = one.context.new_page()
    two.goto(one.url)
    typed(one, 0, "111")
    typed(two, 1, "222")
    hand_in(two)
    expect(two.locator("h1")).to_be_visible()
    expect(two.locator(".typed", has_text="111")).to_have_count(1)
    expect(two.locator(".typed", has_text="222")).to_have_count(1)


def test_what_is_typed_while_the_server_is_dead_arrives_when_it_is_back(exam, served, opened):
    page = exam()
    typed(page, 0, "1.5")
    served.kill()
    shown(boxes(page).nth(1)).fill("2.5")
    expect(page.locator("#kept")).to_have_text(AWAY)
    page.get_by_role("button", name="Hand in").click()
    expect(boxes(page).nth(1)).to_have_value("2.5")
    served.start()
    expect(page.locator("#kept")).to_have_text(SAVED, timeout=60_000)
    page.reload()
    expect(boxes(page).first).to_have_value("1.5")
    expect(boxes(page).nth(1)).to_have_value("2.5")
    forgive(opened)


def test_what_is_typed_without_a_network_arrives_when_it_is_back(exam, opened):
    page = exam()
    page.context.set_offline(True)
    shown(boxes(page).first).fill("4.5")
    expect(page.locator("#kept")).to_have_text(AWAY)
    page.context.set_offline(False)
    expect(page.locator("#kept")).to_have_text(SAVED)
    page.reload()
    expect(boxes(page).first).to_have_value("4.5")
    forgive(opened)


def test_a_browser_that_ends_while_the_server_is_dead_still_sends_it_later(exam, served, opened):
    page = exam()
    at = page.url
    served.kill()
    shown(boxes(page).first).fill("3.5")
    expect(page.locator("#kept")).to_have_text(AWAY)
    page.close()
    served.start()
    again = page.context.new_page()
    again.goto(at)
    expect(boxes(again).first).to_have_value("3.5")
    expect(again.locator("#kept")).to_have_text(SAVED)
    forgive(opened)


def end_in(page, served, seconds: float):
    """Let an exam end soon, and show it anew."""
    ends = page.evaluate("Date.now() / 1000") + seconds
    this = SITTING.c.id == page.url.partition("#")[0].rsplit("/", 1)[1]
    store = Store(served.database)
    with store.database.writing() as connection:
        connection.execute(update(SITTING).where(this).values(limit=ends - SITTING.c.begun))
    store.close()
    page.reload()


def test_the_clock_counts_to_zero_and_hands_the_paper_in(exam, served):
    page = exam(clock=True)
    expect(page.locator(".clock")).to_have_text(re.compile(r"^\d+ min left$"))
    typed(page, 0, "42")
    page.context.add_init_script(
        """addEventListener("DOMContentLoaded", () => {
            const clock = document.querySelector(".clock");
            if (clock) { new MutationObserver(() => {
                sessionStorage.told = (sessionStorage.told || "") + clock.textContent + ";";
            }).observe(clock, {childList: true}); }
        })"""
    )
    end_in(page, served, 3.5)
    expect(page.get_by_text(re.compile("Your answer: .*42"))).to_be_visible()
    expect(page.get_by_text("The time was over")).to_be_visible()
    expect(page.locator("#exam")).to_have_count(0)
    told = [one for one in page.evaluate("sessionStorage.told").split(";") if one]
    assert told[-1] == "0 s left"
    assert {"3 s left", "2 s left", "1 s left"} & set(told)


def test_a_question_to_come_back_to_is_marked_without_leaving_the_place(exam):
    page = exam()
    button = shown(page.locator("[data-flag]").nth(1))
    button.click()
    expect(button).to_have_attribute("aria-pressed", "true")
    expect(page.locator("a.flagged")).to_have_accessible_name(re.compile("flagged"))
    page.reload()
    expect(page.locator("a.flagged")).to_have_text(re.compile("2"))


def test_by_keys_alone_to_the_marks(opened):
    page = opened()
    keys = Keys(page)
    keys.to("Mock exam")
    page.keyboard.press("Enter")
    keys.on(page.get_by_label("Paper", exact=True))
    page.keyboard.type("Mock")
    keys.to("Begin the exam")
    page.keyboard.press("Enter")
    expect(page.locator("#exam")).to_be_visible()
    keys.on(shown(boxes(page).first))
    page.keyboard.type("12.5")
    keys.on(shown(page.locator("#exam input[type=radio]").first))
    page.keyboard.press("Space")
    expect(page.locator("#exam input[type=radio]").first).to_be_checked()
    page.keyboard.press("ArrowDown")
    expect(page.locator("#exam input[type=radio]").nth(1)).to_be_checked()
    keys.to("Come back to this")
    page.keyboard.press("Enter")
    expect(page.locator("a.flagged")).to_have_count(1)
    keys.to("Hand in")
    page.keyboard.press("Enter")
    expect(page.get_by_text("After that nothing can be changed any more.")).to_be_visible()
    keys.to("Hand in")
    page.keyboard.press("Enter")
    expect(page.locator(".typed", has_text="12.5")).to_have_count(1)


UNDER_THE_BAR = """() => document.activeElement.closest("section.question")
    && document.activeElement.getBoundingClientRect().top < document.querySelector(".bar").getBoundingClientRect().bottom"""


def test_what_has_the_focus_is_not_under_the_bar(exam):
    page = exam(viewport={"width": 390, "height": 700})
    page.get_by_role("button", name="Hand in").focus()
    for _ in range(25):
        page.keyboard.press("Shift+Tab")
        assert not page.evaluate(UNDER_THE_BAR)


def test_without_scripts_an_exam_is_sat_by_forms(exam):
    page = exam(java_script_enabled=False)
    boxes(page).first.fill("9.75")
    boxes(page).first.press("Enter")
    expect(boxes(page).first).to_have_value("9.75")
    page.get_by_role("button", name="Come back to this").first.click()
    expect(page.locator("a.flagged")).to_have_count(1)
    hand_in(page)
    expect(page.locator(".typed").first).to_contain_text("9.75")
