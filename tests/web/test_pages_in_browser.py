"""Every page as a person meets it: by axe, in both languages and themes, on a phone, enlarged."""

from __future__ import annotations

import io
import re
from collections import Counter

import html5lib
import pytest
from keys import Keys
from PIL import Image
from playwright.sync_api import expect
from sweep import IS_FULL

pytestmark = pytest.mark.browser

QUESTIONS = (
    "point-to-image-plane",  # boxes
    "add-noise-to-uint8-order",  # an order
    "mixing-kind-and-primaries",  # gaps
    "best-pinhole-diameter",  # true or false, sentences
)


def post(page, path: str, **sent: str) -> str:
    token = page.locator("[name=token]").first.input_value()
    address = re.match("https?://[^/]*", page.url)[0]
    return page.request.post(address + path, form={"token": token, **sent}).url


@pytest.fixture(scope="module")
def addresses(browser, served):
    """Every kind of page, a question in each state."""
    context = browser.new_context()
    page = context.new_page()
    page.goto(served.entrance)
    found = [
        served.address + path
        for path in (
            "/",
            "/questions",
            "/exam",
            "/progress",
            "/formulas",
            "/camera",
            "/tradeoff",
            "/nowhere",
        )
    ]
    for template in QUESTIONS:
        fresh = post(page, "/practice", template=template)
        shown = post(page, "/practice", template=template)
        page.goto(shown)
        links = [link.get_attribute("href") for link in page.locator(".parts a").all()]
        for name in [link.partition("part=")[2] for link in links]:
            post(page, shown.removeprefix(served.address) + f"/{name}", do="solution")
        found += [fresh, shown]
    asked = post(page, "/practice", template=QUESTIONS[0])
    post(page, asked.removeprefix(served.address) + "/1", a="?")
    sitting = post(page, "/exam", blueprint="trial", clock="1")
    resting = post(page, "/exam", blueprint="trial", pauses="1")
    post(page, resting.removeprefix(served.address), do="rest")
    handed = post(page, "/exam", blueprint="trial")
    post(page, handed.removeprefix(served.address), do="hand-in")
    context.close()
    return [*found, asked, sitting, f"{sitting}/hand-in", resting, handed]


SCHEMES = {"en": "light", "bn": "dark"}
"""Each language is seen in one; of two pages one in each, where not all are asked for."""


@pytest.mark.parametrize(("first", "lang"), [*enumerate(SCHEMES)])
def test_every_page_is_valid_and_open_to_everybody(
    opened, served, addresses, first, lang, barriers
):
    phone = {"width": 390, "height": 800}
    page = opened(viewport=phone, color_scheme=SCHEMES[lang], bypass_csp=True)
    post(page, "/settings", lang=lang, back="/")
    faults = []
    for address in addresses if IS_FULL else addresses[first::2]:
        page.goto(address)
        expect(page.locator("html")).to_have_attribute("lang", lang)
        tree = html5lib.HTMLParser(strict=True).parse(page.request.get(address).text())
        ids = [node.get("id") for node in tree.iter() if node.get("id")]
        faults += [(address, "twice", one) for one, count in Counter(ids).items() if count > 1]
        faults += [(address, *one) for one in barriers(page)]
    post(page, "/settings", lang="en", back="/")
    assert faults == []
    assert [one for one in opened.wrong if "(Not Found)" not in one] == []
    opened.wrong.clear()


def test_text_of_twice_the_size_needs_no_scrolling_sideways(opened, addresses):
    page = opened(viewport={"width": 800, "height": 900}, bypass_csp=True)
    wide = []
    for address in addresses:
        page.goto(address)
        page.add_style_tag(content="html { font-size: 200% }")
        if page.evaluate("document.documentElement.scrollWidth > innerWidth"):
            wide.append(address)
    assert wide == []
    opened.wrong.clear()  # of the page that is not there


@pytest.fixture
def sitting(addresses):
    return next(one for one in addresses if one.endswith("/hand-in")).removesuffix("/hand-in")


def test_what_is_answered_shows_where_colours_are_forced(opened, sitting):
    page = opened(forced_colors="active")
    page.goto(sitting)
    link = page.locator("a[data-question]").first
    colour = "element => getComputedStyle(element).backgroundColor"
    before = link.evaluate(colour)
    link.evaluate("element => element.classList.add('answered')")
    assert link.evaluate(colour) != before


def test_nothing_moves_for_who_wants_no_motion(opened, served):
    page = opened(reduced_motion="reduce")
    at = post(page, "/practice", template=QUESTIONS[0])
    post(page, at.removeprefix(served.address) + "/1", a="?")
    moving = "element => getComputedStyle(element).animationName"
    page.goto(at)
    assert page.locator(".verdict").evaluate(moving) == "none"
    page.emulate_media(reduced_motion="no-preference")
    assert page.locator(".verdict").evaluate(moving) == "come"


def edges(scroller) -> tuple[bool, bool]:
    """Whether the left and the right edge of an empty element show a shadow."""
    with Image.open(io.BytesIO(scroller.screenshot())) as picture:
        grey, middle = picture.convert("L"), picture.height // 2
        usual = grey.getpixel((grey.width // 2, middle))
        ends = (grey.getpixel((x, middle)) for x in (3, grey.width - 4))
        return tuple(abs(end - usual) > 30 for end in ends)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_what_is_wider_than_a_phone_says_so_and_is_scrolled_by_keys(opened, addresses, scheme):
    phone = {"width": 390, "height": 800}
    page = opened(viewport=phone, color_scheme=scheme, bypass_csp=True)
    page.goto(next(one for one in addresses if "/q/" in one))
    wide = page.locator(".stem")
    inside = "element.innerHTML = '<div style=\"height: 3rem; width: WIDE\"></div>'"
    wide.evaluate("element => " + inside.replace("WIDE", "100%"))
    assert edges(wide) == (False, False)
    wide.evaluate("element => " + inside.replace("WIDE", "100rem"))
    assert edges(wide) == (False, True)
    page.locator("header a").last.focus()
    Keys(page).on(wide)
    page.keyboard.press("ArrowRight")
    page.wait_for_timeout(300)
    assert wide.evaluate("element => element.scrollLeft") > 0
    wide.evaluate("element => { element.blur(); element.scrollLeft = 600; }")
    assert edges(wide) == (True, True)
    wide.evaluate("element => { element.scrollLeft = 1e5; }")
    assert edges(wide) == (True, False)


def test_everything_is_saved_as_a_file_and_taken_in_again(opened, served, tmp_path):
    page = opened()
    page.goto(served.address + "/progress")
    with page.expect_download() as saved:
        page.get_by_role("link", name="Save everything as a file").click()
    file = tmp_path / saved.value.suggested_filename
    saved.value.save_as(file)
    assert '"format":"quizgen learning"' in file.read_text("utf-8")
    page.get_by_label("Add what such a file holds").set_input_files(file)
    page.get_by_role("button", name="Add", exact=True).click()
    expect(page.get_by_text("Questions and exams added: 0.")).to_be_visible()
    page.get_by_label("Add what such a file holds").set_input_files(__file__)
    page.get_by_role("button", name="Add", exact=True).click()
    expect(page.get_by_role("alert")).to_contain_text("nothing has changed")
    assert all("400" in one for one in opened.wrong)
    opened.wrong.clear()


def test_mistakes_are_saved_for_anki(opened, addresses):
    page = opened()
    page.goto(addresses[-1])
    with page.expect_download() as saved:
        page.get_by_role("link", name="Your mistakes as flashcards").click()
    assert saved.value.suggested_filename == "quizgen-mistakes.apkg"
    assert saved.value.path().read_bytes()[:2] == b"PK"


def test_results_are_printed_whole_and_without_buttons(opened, addresses):
    page = opened()
    page.goto(addresses[-1])
    inside = page.locator("details:not([open]) > :not(summary)").first
    expect(inside).not_to_be_visible()
    page.emulate_media(media="print")
    expect(inside).to_be_visible()
    expect(page.locator("button").locator("visible=true")).to_have_count(0)
    expect(page.locator("header")).not_to_be_visible()
