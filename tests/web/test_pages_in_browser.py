"""Every page as a person meets it: by axe, in both languages and themes, on a phone, enlarged."""

from __future__ import annotations

import re
from collections import Counter

import html5lib
import pytest
from playwright.sync_api import expect

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
        for path in ("/", "/exam", "/progress", "/formulas", "/camera", "/tradeoff", "/nowhere")
    ]
    for template in QUESTIONS:
        fresh = post(page, "/practice", template=template)
        shown = post(page, "/practice", template=template)
        page.goto(shown)
        for part in page.locator("section.part").all():
            name = part.get_attribute("id").removeprefix("part-")
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


@pytest.mark.parametrize("lang", ["en", "bn"])
def test_every_page_is_valid_and_open_to_everybody(opened, served, addresses, lang, barriers):
    page = opened(viewport={"width": 390, "height": 800}, bypass_csp=True)
    post(page, "/settings", lang=lang, back="/")
    faults = []
    for address in addresses:
        page.emulate_media(color_scheme="light")
        page.goto(address)
        expect(page.locator("html")).to_have_attribute("lang", lang)
        tree = html5lib.HTMLParser(strict=True).parse(page.request.get(address).text())
        ids = [node.get("id") for node in tree.iter() if node.get("id")]
        faults += [(address, "twice", one) for one, count in Counter(ids).items() if count > 1]
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme=scheme)
            faults += [(address, scheme, *one) for one in barriers(page)]
    post(page, "/settings", lang="en", back="/")
    assert faults == []
    assert [one for one in opened.wrong if "(Not Found)" not in one] == []
    opened.wrong.clear()


def test_results_are_printed_whole_and_without_buttons(opened, addresses):
    page = opened()
    page.goto(addresses[-1])
    inside = page.locator("details:not([open]) > :not(summary)").first
    expect(inside).not_to_be_visible()
    page.emulate_media(media="print")
    expect(inside).to_be_visible()
    expect(page.locator("button").locator("visible=true")).to_have_count(0)
    expect(page.locator("header")).not_to_be_visible()
