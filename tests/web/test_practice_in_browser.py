"""Practice in Chromium: by mouse, by keyboard, without scripts."""

from __future__ import annotations

import re

import pytest
from fingers import Screen, between
from keys import Keys
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

BUTTON = "button"
POINT = "point-to-image-plane"


@pytest.fixture
def practised(opened, served):
    """Begins a certain question."""

    def begun(template: str = POINT, **how):
        page = opened(**how)
        token = page.locator("[name=token]").first.input_value()
        sent = {"token": token, "template": template}
        answer = page.request.post(served.address + "/practice", form=sent)
        page.goto(answer.url)
        return page

    return begun


def test_from_the_first_visit_to_a_verdict_in_two_clicks(opened):
    page = opened()
    with page.expect_navigation():
        page.get_by_role(BUTTON, name="Start").click()
    part = page.locator("section.part").first
    fields = part.locator("input:not([type=hidden]), textarea, select")
    if fields.first.get_attribute("type") in {"radio", "checkbox"}:
        fields.first.check()
    elif fields.first.evaluate("field => field.tagName") == "SELECT":
        fields.first.select_option(index=1)
    else:
        for field in fields.all():
            field.fill("1")
    part.get_by_role(BUTTON, name="Check").click()
    expect(part.locator(".verdict")).to_be_visible()


def test_wrong_hint_language_right_and_a_variant(practised):
    page = practised()
    x, y = page.locator("input[type=text]").all()
    x.fill("123")
    y.fill("456")
    y.press("Enter")
    expect(page.locator(".verdict.wrong")).to_contain_text("Tries left: 2")
    expect(page.locator("#said")).to_contain_text("Not right.")
    expect(y).to_be_focused()
    page.get_by_role(BUTTON, name="Hint").click()
    expect(page.locator(".hints li")).to_have_count(1)
    expect(page.get_by_role(BUTTON, name="Formula")).to_be_focused()
    page.get_by_role(BUTTON, name="বাংলা").click()
    expect(page.locator("html")).to_have_attribute("lang", "bn")
    expect(page.locator("input[type=text]").first).to_have_value("123")
    expect(page.locator(".hints li")).to_have_count(1)
    with page.expect_navigation():
        page.get_by_role(BUTTON, name="English").click()
    before = page.locator(".stem").inner_text()
    page.get_by_role(BUTTON, name="Solution").click()
    expect(page.locator(".result")).to_be_visible()
    expect(page.get_by_role(BUTTON, name="Next question")).to_be_focused()
    page.get_by_text("More", exact=True).click()
    page.get_by_role(BUTTON, name="with new numbers").click()
    expect(page.locator(".verdict")).to_have_count(0)
    assert page.locator(".stem").inner_text() != before


def test_what_is_not_sent_yet_outlives_another_language_and_a_reload(practised):
    page = practised()
    x, y = page.locator("input[type=text]").all()
    x.fill("2/3")
    y.fill("-4")
    page.get_by_role(BUTTON, name="বাংলা").click()
    expect(page.locator("html")).to_have_attribute("lang", "bn")
    expect(x).to_have_value("2/3")
    expect(y).to_have_value("-4")
    page.get_by_role(BUTTON, name="English").click()
    expect(page.locator("html")).to_have_attribute("lang", "en")
    page.reload()
    expect(y).to_have_value("-4")
    y.press("Enter")
    expect(page.locator(".verdict")).to_be_visible()
    y.fill("77")
    page.get_by_role(BUTTON, name="Solution").click()
    expect(page.locator(".result")).to_be_visible()
    page.reload()
    expect(y).to_have_value("77")
    page.get_by_text("More", exact=True).click()
    page.get_by_role(BUTTON, name="Once more").click()
    expect(page.locator(".result")).to_have_count(0)
    expect(x).to_have_value("")


def test_chosen_options_and_an_order_outlive_a_reload(practised):
    page = practised("lens-aberrations-causes-remedies")
    page.locator(".chip").nth(1).click()
    page.reload()
    expect(page.locator("section.part select").first).to_have_value("2")
    expect(page.locator(".slot.filled")).to_have_count(1)
    page = practised("stopping-down-or-opening-effects")
    page.locator("section.part input[type=radio]").nth(1).check()
    page.reload()
    expect(page.locator("section.part input[type=radio]").nth(1)).to_be_checked()
    page = practised(ORDER)
    page.locator("[data-mark]").nth(1).focus()
    page.keyboard.press("Enter")
    before = chosen(page)
    assert before[0]
    page.reload()
    expect(page.locator("[data-order] select").first).to_have_value(before[0])
    expect(page.locator("[data-mark]").first).to_have_attribute("data-mark", before[0])


def test_working_it_through_goes_from_part_to_part(practised):
    page = practised()
    page.get_by_text("More", exact=True).click()
    with page.expect_navigation():
        page.get_by_role(BUTTON, name="step by step").click()
    expect(page.locator("section.part")).to_have_count(1)
    first = page.locator("section.part").get_attribute("id")
    while page.locator("[value=solution]").count() == 0:
        help_so_far = page.locator(".hints li").count()
        page.locator("[value=hint]").click()
        expect(page.locator(".hints li")).to_have_count(help_so_far + 1)
    page.locator("[value=solution]").click()
    expect(page.locator(".dock a.main")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.locator("section.part")).not_to_have_id(first)


def test_what_is_typed_is_read_back(practised):
    page = practised()
    x, y = page.locator("input[type=text]").all()
    read = page.locator(".read")
    x.fill("2/3")
    y.fill("0,5")
    expect(read).to_contain_text("Read as")
    expect(read.locator("mfrac")).to_have_count(1)
    for half in ("-", "2."):
        with page.expect_response(re.compile("/read$")):
            y.fill(half)
        expect(read).to_be_empty()


def test_what_cannot_be_read_is_asked_back_at_its_field(practised):
    page = practised()
    x, y = page.locator("input[type=text]").all()
    x.fill("1")
    y.fill("?")
    y.press("Enter")
    expect(page.locator(".verdict.asked")).to_be_visible()
    expect(y).to_have_attribute("aria-invalid", "true")
    expect(y).to_have_accessible_description(re.compile("could not be read"))


def test_a_verdict_is_announced_once(practised):
    page = practised()
    page.evaluate(
        """window.told = []; new MutationObserver(() => window.told.push(
            document.getElementById("said").textContent.trim()
        )).observe(document.getElementById("said"), {childList: true, characterData: true, subtree: true})"""
    )
    for number in ("1", "2"):
        for field in page.locator("input[type=text]").all():
            field.fill(number)
        page.locator("input[type=text]").first.press("Enter")
        expect(page.locator("input[type=text]").first).to_have_value(number)
        expect(page.locator(".verdict")).to_contain_text(f"Tries left: {3 - int(number)}")
    told = [one for one in page.evaluate("window.told") if one]
    assert len(told) == 2, told
    live = page.evaluate(
        "[...document.querySelectorAll('[aria-live], [role=status], [role=alert]')]"
        ".filter(e => /Not right/.test(e.textContent)).length"
    )
    assert live == 1


def test_the_same_without_scripts(practised):
    page = practised(java_script_enabled=False)
    for field in page.locator("input[type=text]").all():
        field.fill("77")
    page.locator("input[type=text]").first.press("Enter")
    expect(page.locator(".verdict.wrong")).to_be_visible()
    page.get_by_role(BUTTON, name="Hint").click()
    expect(page.locator(".hints li")).to_have_count(1)
    page.get_by_role(BUTTON, name="Solution").click()
    expect(page.locator(".result")).to_be_visible()
    page.get_by_text("More", exact=True).click()
    page.get_by_role(BUTTON, name="with new numbers").click()
    expect(page.locator(".verdict")).to_have_count(0)


def test_by_keys_alone(opened):
    page = opened()
    page.keyboard.press("Tab")
    expect(page.locator(".skip")).to_be_focused()
    if page.get_by_text("Choose a question yourself").count():  # the first visit
        Keys(page).to("Choose a question yourself")
        page.keyboard.press("Enter")
    Keys(page).on(page.get_by_role(BUTTON, name="§4.1 Perspective projection"))
    page.keyboard.press("Enter")
    expect(page.locator("section.part").first).to_be_visible()
    Keys(page).on(page.locator(".parts a, .more summary").last)
    page.keyboard.press("Escape")
    expect(page.locator(".now")).to_be_visible()


def test_keys_choose_check_and_go_on(practised):
    page = practised("stopping-down-or-opening-effects")
    inputs = page.locator("section.part input[type=radio]")
    expect(inputs.first).to_be_focused()
    page.keyboard.press("2")
    expect(inputs.nth(1)).to_be_checked()
    page.keyboard.press("Enter")
    expect(page.locator(".verdict")).to_be_visible()
    while page.locator(".dock a.main").count() == 0:
        page.keyboard.press("s")
        page.wait_for_timeout(200)
    page.keyboard.press("Enter")
    expect(page.locator(".parts [aria-current]")).to_have_text("b")


def test_pairs_are_made_by_chips(practised):
    page = practised("lens-aberrations-causes-remedies")
    slots, chips = page.locator(".slot"), page.locator(".chip")
    chips.nth(0).click()
    chips.nth(2).drag_to(slots.nth(2))
    slots.nth(1).click()
    chips.nth(1).press("Enter")
    values = [one.input_value() for one in page.locator("section.part select").all()]
    assert values[:3] == ["1", "2", "3"]
    slots.nth(0).click()
    assert page.locator("section.part select").first.input_value() == "", "a tap empties it"


ORDER = "add-noise-to-uint8-order"


def chosen(page):
    return [
        place.input_value() for place in page.locator("[data-order]").first.locator("select").all()
    ]


def test_steps_are_put_in_order_by_dragging_and_by_keys(practised):
    page = practised(ORDER)
    steps = page.locator("[data-order]").first.locator("[data-mark]")
    first, second, third = (steps.nth(i).get_attribute("data-mark") for i in range(3))
    steps.nth(0).drag_to(steps.nth(1))
    assert chosen(page)[:2] == [first, ""]
    page.locator(f"[data-mark={third}]").first.focus()
    page.keyboard.press("Enter")
    assert chosen(page)[:3] == [first, third, ""]
    page.keyboard.press("ArrowUp")
    assert chosen(page)[:3] == [third, first, ""]
    expect(page.locator("#said")).to_have_text(f"{third}: 1.")
    expect(page.locator(f"[data-mark={third}]").first).to_be_focused()
    page.locator(f"[data-mark={second}]").first.drag_to(
        steps.nth(0), target_position={"x": 20, "y": 2}
    )
    assert chosen(page)[:3] == [second, third, first]
    page.locator(f"[data-mark={second}]").first.focus()
    page.keyboard.press("Delete")
    assert chosen(page)[:3] == [third, first, ""]
    page.locator(f"[data-mark={second}]").first.focus()
    page.keyboard.press("Enter")
    assert steps.nth(2).get_attribute("data-mark") == second
    page.get_by_role(BUTTON, name="Check").first.click()
    expect(page.locator(".verdict")).to_be_visible()
    assert chosen(page)[:3] == [third, first, second]
    assert steps.nth(0).get_attribute("data-mark") == third, "the order is drawn again"


def middle(locator, down: float = 0.5) -> tuple[float, float]:
    box = locator.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] * down


@pytest.mark.parametrize("hand", ["finger", "two fingers", "pen"])
def test_steps_are_put_in_order_by_a_finger_or_a_pen(practised, hand):
    page = practised(ORDER, viewport={"width": 390, "height": 800}, has_touch=True)
    steps = page.locator("[data-order]").first.locator("[data-mark]")
    first, third = (steps.nth(i).get_attribute("data-mark") for i in (0, 2))
    steps.first.evaluate("step => step.scrollIntoView({block: 'center'})")
    screen, before = Screen(page), page.evaluate("scrollY")
    for number, mark in enumerate((third, first)):
        grip = page.locator(f"[data-mark={mark}] .grip").first
        box = grip.bounding_box()
        assert min(box["width"], box["height"]) >= 24, "large enough for a finger"
        way = between(middle(grip), middle(steps.first, 0.1))
        if hand == "pen":
            screen.pen(way)
        else:
            screen.finger(way, beside=(380, 20) if hand == "two fingers" else None)
        expect(page.locator("[data-order] select").nth(number)).not_to_have_value("")
    assert chosen(page)[:3] == [first, third, ""]
    assert page.evaluate("scrollY") == before, "the page stays where it is"


def test_a_finger_beside_the_grip_scrolls_the_page(practised):
    page = practised(ORDER, viewport={"width": 390, "height": 500}, has_touch=True)
    step = page.locator("[data-order] [data-mark]").first
    step.evaluate("step => step.scrollIntoView({block: 'center'})")
    before = page.evaluate("scrollY")
    box = step.bounding_box()
    x, y = box["x"] + box["width"] - 20, box["y"] + box["height"] / 2
    Screen(page).finger(between((x, y), (x, y - 200)))
    page.wait_for_timeout(300)
    assert page.evaluate("scrollY") > before
    assert not any(chosen(page))


def test_what_is_matched_is_named_in_its_list(practised):
    page = practised("lens-aberrations-causes-remedies")
    options = page.locator("section.part select").first.locator("option").all_inner_texts()
    told = page.locator("section.part").first.locator(".targets li").all_inner_texts()
    assert [one.partition(". ")[2].strip() for one in options[1:]] == [one.strip() for one in told]


@pytest.mark.slow
def test_keys_write_a_formula_that_is_typeset_below(practised, barriers):
    page = practised("photon-snr-formula-and-model")
    field, keys = page.locator("section.part input[type=text]"), page.locator(".keys button")
    assert [key.get_attribute("data-put") for key in keys.all()][:2] == ["N", "(|)/()"]
    keys.and_(page.get_by_label("square root")).click()
    expect(field).to_be_focused()
    keys.first.click()
    expect(field).to_have_value("sqrt(N)")
    field.select_text()
    page.get_by_role(BUTTON, name="fraction").press("Enter")
    page.keyboard.type("2")
    expect(field).to_have_value("(sqrt(N))/(2)")
    expect(page.locator(".read mfrac msqrt")).to_be_visible()
    assert barriers(page) == []


@pytest.mark.slow
def test_keys_write_a_formula_in_firefox_too(driver, served, tmp_path):
    from firefox import firefox
    from needed import installed

    program = installed("Firefox", "firefox-esr", "firefox")
    with firefox(program, tmp_path, "light")(driver) as browser:
        page = browser.new_page()
        page.goto(served.entrance)
        sent = {"token": page.locator("[name=token]").first.input_value(),
                "template": "photon-snr-formula-and-model"}  # fmt: skip
        page.goto(page.request.post(served.address + "/practice", form=sent).url)
        page.get_by_label("square root").click()
        page.locator(".keys button").first.click()
        expect(page.locator("section.part input[type=text]")).to_have_value("sqrt(N)")
        expect(page.locator(".read msqrt")).to_be_visible()


def test_boxes_are_labelled_by_what_they_ask(practised):
    page = practised("hsv-edit-from-pictures")
    labels = page.locator(".box label").all_text_contents()
    assert [one.split() for one in labels] == [["(1)", "V"], ["(2)", "S"], ["(3)", "H"]]


def test_gaps_are_filled_in_their_sentences(practised, barriers):
    page = practised("mixing-kind-and-primaries")
    gaps = page.locator(".gaps li input")
    expect(gaps).to_have_count(4)
    expect(page.locator(".stage")).not_to_contain_text("____")
    for gap in gaps.all():
        gap.fill("violet")
    page.get_by_role(BUTTON, name="Check").click()
    expect(page.locator(".verdict.wrong")).to_contain_text("1, 2, 3, 4")
    expect(gaps.first).to_have_value("violet")
    assert barriers(page) == []


def test_a_derivation_is_read_line_by_line_as_it_is_written(practised):
    """By keyboard alone: Enter ends a line, Tab the last; what is said moves no focus."""
    page = practised("derive-perspective-projection")
    field = page.locator("textarea[data-rows]").first
    read = page.locator(".read li")
    field.focus()
    page.keyboard.type("0 = 1\n")
    expect(read).to_have_count(1)
    expect(read.first).to_have_class("wrong")
    expect(field).to_be_focused()
    page.keyboard.type("1 = 1")
    expect(read).to_have_count(1)
    page.keyboard.press("Tab")
    expect(read).to_have_count(2)
    expect(read.nth(1)).to_have_class("correct")
    expect(page.locator(".verdict")).to_have_count(0)
    page.get_by_role(BUTTON, name="Check").click()
    expect(page.locator(".verdict .judged li")).to_have_count(2)
    expect(read).to_have_count(0)
