"""Signing in as a person meets it: by keys, without scripts, by axe, on a phone."""

from __future__ import annotations

import re

import html5lib
import pytest
from people import PASSWORD
from playwright.sync_api import expect
from served import Served

pytestmark = pytest.mark.browser

NAME = "রহিম <b>& Söhne</b> عبد الرحمن " + "W" * 25


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """A server for several people."""
    server = Served(tmp_path_factory.mktemp("served") / "learning.sqlite3", "--host", "0.0.0.0")
    yield server
    server.kill()


def fill_in(page, *texts: str) -> None:
    """Type into the fields of a form from its first one on, then send it, all by keys."""
    page.locator("main input:not([type=hidden])").first.focus()
    for text in texts:
        page.keyboard.type(text)
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")


def faults(page, barriers) -> list:
    """What is wrong with a page in both languages, each in one of the themes."""
    found, address = [], page.url
    for lang, scheme in (("en", "light"), ("bn", "dark")):
        with page.expect_navigation():
            page.locator(f".languages button[lang={lang}]").click()
        expect(page.locator("html")).to_have_attribute("lang", lang)
        html5lib.HTMLParser(strict=True).parse(page.request.get(page.url).text())
        page.emulate_media(color_scheme=scheme)
        found += [(address, lang, scheme, one) for one in barriers(page)]
    with page.expect_navigation():
        page.locator(".languages button[lang=en]").click()
    return found


def test_from_an_invitation_to_signing_in_by_keys_on_every_page(opened, served, barriers):
    phone = {"viewport": {"width": 390, "height": 800}, "bypass_csp": True}
    page = opened(**phone)
    wrong = faults(page, barriers)
    fill_in(page, "Farida", PASSWORD, PASSWORD)
    expect(page.locator(".me")).to_have_text("Farida")
    page.goto(f"{served.address}/people")
    page.get_by_role("button", name="Make a link").press("Enter")
    link = page.locator("input.link").input_value()
    other = opened(java_script_enabled=False, **phone)
    other.goto(re.sub("http://[^/]*", served.address, link))
    other.fill("#name", NAME)
    other.fill("#password", PASSWORD)
    other.fill("#again", PASSWORD)
    other.get_by_role("button", name="Begin").click()
    expect(other.locator(".me")).to_have_text(NAME)
    for path in ("/people", "/people/2", "/account", "/"):
        page.goto(served.address + path)
        wrong += faults(page, barriers)
    page.goto(f"{served.address}/people")
    expect(page.get_by_role("link", name=NAME)).to_be_visible()
    page.goto(f"{served.address}/account")
    page.get_by_role("button", name="Sign out").press("Enter")
    page.wait_for_url("**/sign-in")
    wrong += faults(page, barriers)
    fill_in(page, "farida", PASSWORD)
    expect(page.locator(".me")).to_have_text("Farida")
    assert wrong == []
    opened.wrong[:] = [one for one in opened.wrong if "(Gone)" not in one]  # the link was used
