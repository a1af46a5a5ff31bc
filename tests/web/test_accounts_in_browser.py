"""Signing in as a person meets it: by keys, without scripts, by axe, on a phone."""

from __future__ import annotations

import re

import html5lib
import pytest
from people import PASSWORD
from playwright.sync_api import expect
from served import Served

from quizgen.store import Store
from quizgen.web.auth import INVITED

pytestmark = pytest.mark.browser

POINT = "point-to-image-plane"
NAME = "রহিম <b>& Söhne</b> عبد الرحمن " + "W" * 25


@pytest.fixture(scope="module")
def served(database):
    """A server for several people."""
    server = Served(database(), "--host", "0.0.0.0", "--workers", "1")
    yield server
    server.kill()


def fill_in(page, *texts: str) -> None:
    """Type into the fields of a form from its first one on, then send it, all by keys."""
    page.locator("main input:not([type=hidden])").first.focus()
    for text in texts:
        page.keyboard.type(text)
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")


def invited(page, served, other, name: str) -> None:
    """Make a link in one browser, and an account with it in another."""
    page.goto(f"{served.address}/people")
    page.get_by_role("button", name="Make a link").press("Enter")
    link = page.locator("input.link").input_value()
    other.goto(re.sub("http://[^/]*", served.address, link))
    for field, text in (("#name", name), ("#password", PASSWORD), ("#again", PASSWORD)):
        other.fill(field, text)
    other.get_by_role("button", name="Begin").click()


def faults(page, barriers) -> list:
    """What is wrong with a page in both languages, each in one of the themes."""
    found, address = [], page.url
    for lang, scheme in (("en", "light"), ("bn", "dark")):
        if page.locator("html").get_attribute("lang") != lang:
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
    other = opened(java_script_enabled=False, **phone)
    invited(page, served, other, NAME)
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


@pytest.fixture
def signed_in(opened, served):
    """Browsers on phones, in each of which somebody new has signed in."""

    def one(name: str):
        store = Store(served.database)
        key = store.accounts.invite(manages=False)
        store.close()
        page = opened(viewport={"width": 390, "height": 800}, color_scheme="dark", bypass_csp=True)
        page.goto(f"{served.address}{INVITED}?key={key}")
        fill_in(page, name, PASSWORD, PASSWORD)
        expect(page.locator(".me")).to_have_text(name)
        return page

    yield one
    opened.wrong[:] = [one for one in opened.wrong if "(Gone)" not in one]  # the printed link


@pytest.fixture
def walked(served, barriers):
    """Opens a page, or takes the one that is open; nothing may keep anybody out of it."""

    def to(page, path: str = "") -> None:
        if path:
            page.goto(served.address + path)
        expect(page.locator(".me, body.play").first).to_be_visible()
        assert barriers(page) == [], page.url

    return to


def test_who_has_signed_in_practises_and_sits_an_exam(signed_in, walked, served):
    page = signed_in("Nasreen")
    for path in ("/", "/camera", "/formulas"):
        walked(page, path)
    page.goto(f"{page.url}#F05")
    page.locator("#F05 button[name=formula]").click()
    expect(page.locator("section.part")).to_be_visible()
    sent = {"token": page.locator("[name=token]").first.input_value(), "template": POINT}
    page.goto(page.request.post(served.address + "/practice", form=sent).url)
    walked(page)
    for field in page.locator("section.part input[type=text]").all():
        field.fill("77")
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".verdict")).to_be_visible()
    page.get_by_role("button", name="Solution").click()
    expect(page.locator(".result")).to_be_visible()
    walked(page)
    walked(page, "/exam")
    page.get_by_label("Paper", exact=True).select_option("trial")
    page.get_by_role("button", name="Begin the exam").click()
    expect(page.locator("#exam")).to_be_visible()
    walked(page)
    field = page.locator("#exam fieldset[data-part] input[type=text]").first
    field.evaluate("field => { location.hash = field.closest('.question').id; }")
    field.fill("123")
    expect(page.locator("#kept")).to_have_text("All answers are saved.")
    page.get_by_role("button", name="Hand in").click()
    expect(page.get_by_text("After that nothing can be changed any more.")).to_be_visible()
    walked(page)
    page.get_by_role("button", name="Hand in").click()
    expect(page.locator(".typed", has_text="123")).to_be_visible()
    walked(page)
    with page.expect_download() as saved:
        page.get_by_role("link", name="Your mistakes as flashcards").click()
    assert saved.value.path().read_bytes()[:2] == b"PK"
    walked(page, "/progress")


def test_what_one_saves_another_takes_in_and_nobody_sees_it_before(
    signed_in, served, walked, tmp_path
):
    one, other = signed_in("Rokeya"), signed_in("Selina")
    with one.expect_navigation():
        one.get_by_role("button", name="Start").click()
    at = re.match("[^?#]*", one.url)[0]
    token = one.locator("[name=token]").first.input_value()
    links = [link.get_attribute("href") for link in one.locator(".parts a").all()]
    for name in [link.partition("part=")[2] for link in links]:
        one.request.post(f"{at}/{name}", form={"token": token, "do": "solution"})
    walked(one, "/progress")
    expect(one.get_by_text("Not seen yet")).to_be_visible()
    asked = re.compile(r"^[1-9]\d*\D\d+$")  # 2/17
    expect(one.get_by_role("cell", name=asked).first).to_be_visible()
    with one.expect_download() as saved:
        one.get_by_role("link", name="Save everything as a file").click()
    saved.value.save_as(tmp_path / "all.json")
    other.goto(served.address + "/progress")
    expect(other.get_by_role("cell", name=asked)).to_have_count(0)
    other.get_by_label("Add what such a file holds").set_input_files(tmp_path / "all.json")
    other.get_by_role("button", name="Add", exact=True).click()
    expect(other.get_by_text("Questions and exams added: 1.")).to_be_visible()
    expect(other.get_by_role("cell", name=asked).first).to_be_visible()
    walked(other)
