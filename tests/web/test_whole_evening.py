"""The whole evening of a student in one go: by keys alone or by finger, in Chromium and Firefox."""

from __future__ import annotations

import re
from functools import partial

import html5lib
import pytest
from keys import Keys
from needed import find_chromium, installed
from playwright.sync_api import expect
from served import Served
from sweep import sample

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EVENINGS = [
    ("chromium", 390, "bn", "dark"),
    ("chromium", 1280, "en", "light"),
    ("firefox", 900, "bn", "dark"),
    ("firefox", 390, "en", "dark"),
    ("firefox", 1280, "en", "light"),
]
"""Browser, width of the window, language to begin in, scheme: each pair of the last three once."""
WORDS = 140
"""To read, at most, from the first page to the first verdict; the question is any of the bank."""
COUNT = "element => (element.innerText.match(/\\p{L}{2,}/gu) ?? []).length"
"""Words of an element; letters and numbers of formulas are none."""


class Student:
    """Somebody at a page: with a keyboard alone on wide screens, with fingers on a phone."""

    def __init__(self, page, address: str, *, keyboard: bool) -> None:
        self.page, self.address, self.keyboard = page, address, keyboard
        self.keys = Keys(page)

    def press(self, target) -> None:
        """Press a button or follow a link."""
        if self.keyboard:
            self._reach(target)
            self.page.keyboard.press("Enter")
        else:
            target.click()

    def choose(self, target) -> None:
        """Tick something."""
        if self.keyboard:
            target.focus()  # Tab reaches one of a group, arrows the others
            self.page.keyboard.press("Space")
        else:
            target.locator("xpath=..").click()

    def write(self, field, text: str) -> None:
        """Type into a field."""
        if self.keyboard:
            self._reach(field)
            self.page.keyboard.type(text)
        else:
            field.fill(text)

    def _reach(self, target) -> None:
        """Go on by Tab, from where the page's skip link leads to."""
        target.evaluate("element => element.closest('main')?.focus()")
        self.keys.on(target)

    def go(self, path: str) -> None:
        """Open a page whose link was looked at elsewhere."""
        self.page.goto(self.address + path)

    def count_words(self) -> int:
        """Return how many words the page has below its head."""
        return self.page.locator("main").evaluate(COUNT)


@pytest.fixture(params=sample(EVENINGS, 2), ids=lambda one: "-".join(map(str, one)))
def evening(request, database, tmp_path, driver):
    """A server for one learner and their phone; a student with a browser before its first page."""
    kind, width, lang, scheme = request.param
    if kind == "firefox":
        from firefox import firefox

        browser_of = firefox(installed("Firefox", "firefox-esr", "firefox"), tmp_path, scheme)
    else:
        browser_of = chromium()
    server = Served(database(), "--phone")
    try:
        with browser_of(driver) as browser:
            how = {"viewport": {"width": width, "height": 844 if width < 500 else 800}}
            if kind == "chromium":
                how |= {"has_touch": width < 500, "bypass_csp": True, "color_scheme": scheme}
            context = browser.new_context(**how)
            context.set_default_timeout(60_000)
            expect.set_options(timeout=60_000)
            page = context.new_page()
            page.goto(server.entrance)
            yield Student(page, server.address, keyboard=width > 500), browser, server, lang, scheme
    finally:
        server.kill()


def chromium():
    """What opens Chromium."""
    return lambda driver: driver.chromium.launch(
        executable_path=find_chromium(), args=["--no-sandbox"]
    )


def press_and_swap(student, button) -> None:
    """Press a button of a part; wait until the part has been put in place anew."""
    student.page.wait_for_load_state()  # then the scripts have run
    old = button.element_handle()
    student.press(button)
    student.page.wait_for_function("button => !button.isConnected", arg=old)


def give_up(student) -> None:
    """Take every help, up to the solution of all parts."""
    page = student.page
    while True:
        for _ in range(40):
            buttons = page.locator("section.part [name=do]")
            solution = buttons.and_(page.locator("[value^=solution]"))
            helps = solution if solution.count() else buttons.and_(page.locator("[value^=hint]"))
            if not helps.count():
                break
            press_and_swap(student, helps.first)
        onward = page.locator("section.part .dock a.main")
        if not onward.count():
            return
        before = page.url
        student.press(onward)
        expect(page).not_to_have_url(before)


def look(student, barriers) -> None:
    """Nothing on the page keeps anybody out, and it is valid."""
    assert barriers(student.page) == []
    page = student.page.request.get(student.page.url).text()
    html5lib.HTMLParser(strict=True).parse(page)


def practise_a_block(student, look) -> None:
    """Two taps and an answer, then every help there is; the end of the block, a mistake again."""
    page = student.page
    look()
    words = page.locator(".start-page").evaluate(COUNT)
    expect(page.locator("[name=days][value='1']")).to_be_checked()
    student.choose(page.locator("[name=minutes][value='15']"))
    student.press(page.locator(".start-card .main"))
    expect(page).to_have_url(re.compile("/q/"))
    assert words + student.count_words() <= WORDS
    look()
    size = page.locator("#segments li").count()
    for number in range(size):
        expect(page.locator("#segments .hollow")).to_have_count(number)
        give_up(student)
        before = page.url
        student.press(page.locator(".dock form .main"))
        expect(page).not_to_have_url(before)
    expect(page).to_have_url(re.compile("/block/"))
    look()
    student.press(page.locator(".rows button").first)
    expect(page).to_have_url(re.compile("/q/"))


def look_into_figures(student, look) -> None:
    """A question found by its section: the wrong value is drawn; then the figure moves."""
    page = student.page
    student.go("/questions?q=4.1")
    student.press(page.locator("button[value=point-to-image-plane]"))
    figure = page.locator("#figure").inner_html()
    for box in page.locator("section.part .box input").all():
        student.write(box, "-77")
    press_and_swap(student, page.locator("section.part .dock .main"))
    expect(page.locator("section.part .verdict")).to_be_visible()
    expect(page.locator("#figure")).not_to_have_js_property("innerHTML", figure)
    assert "learned" in page.locator("#figure").inner_html()
    expect(page.locator("#said")).not_to_be_empty()
    look()
    give_up(student)
    student.press(page.locator(".moving summary"))
    page.locator("moving-figure[data-ready]").wait_for()
    values = page.locator(".moving-values")
    shown = values.inner_text()
    slider = page.locator(".moving input[type=range]").first
    slider.focus()
    ends = slider.evaluate("slider => slider.value === slider.max")  # some numbers stand there
    for _ in range(5):
        page.keyboard.press("ArrowLeft" if ends else "ArrowRight")
    expect(values).not_to_have_js_property("innerText", shown)


def show(field) -> None:
    """Turn to the question of an exam that a field is in."""
    field.evaluate("field => { location.hash = field.closest('.question').id; }")
    expect(field).to_be_visible()


def sit_the_trial_exam(student, server, look) -> None:
    """The server dies in it, and nothing is lost; results by time; what cost points again."""
    page = student.page
    student.go("/exam")
    look()
    student.press(page.locator("form.card .main"))
    expect(page.locator("#exam")).to_be_visible()
    page.wait_for_load_state()
    kept, questions = page.locator("#kept"), page.locator("a[data-question]").count()
    first, typed = page.locator("#exam fieldset[data-part] input[type=text]").all()[:2]
    show(first)
    student.write(first, "7")
    expect(kept).not_to_be_empty()
    saved = kept.inner_text()
    server.kill()
    show(typed)
    student.write(typed, "12.5")
    expect(kept).not_to_have_text(saved)
    server.start()
    expect(kept).to_have_text(saved, timeout=60_000)
    page.reload()
    expect(typed).to_have_value("12.5")
    student.press(page.locator("#exam button[value=end]"))
    expect(page).to_have_url(re.compile("hand-in"))
    look()
    student.press(page.locator("button[value=hand-in]"))
    expect(page.locator(".tally tbody tr")).to_have_count(questions)
    assert page.locator(".tally .quiet").count() == questions, "the time of each"
    expect(page.locator(".lost").first).to_be_visible()
    look()
    student.press(page.locator("button[name=repair]"))
    expect(page).to_have_url(re.compile("/q/"))


def go_on_with_a_phone(student, browser, look) -> None:
    """The code lets a phone in as the same learner; the other language keeps the question."""
    page, question = student.page, student.page.url
    lang = page.locator("html").get_attribute("lang")
    student.go("/phone")
    student.press(page.locator("main form[action='/phone'] button"))
    scanned = page.locator("p.typed").inner_text()
    look()
    phone = browser.new_context(viewport={"width": 390, "height": 844}).new_page()
    phone.goto(re.sub("https?://[^/]*", student.address, scanned))
    phone.goto(question)
    expect(phone.locator("section.part")).to_be_visible()
    other = "en" if lang == "bn" else "bn"
    phone.locator(f".languages button[value={other}]").click()
    expect(phone.locator("html")).to_have_attribute("lang", other)
    expect(phone).to_have_url(question)
    assert not phone.evaluate("document.documentElement.scrollWidth > innerWidth")


def test_the_whole_evening(evening, barriers):
    student, browser, server, lang, scheme = evening
    page = student.page
    dark = page.evaluate("matchMedia('(prefers-color-scheme: dark)').matches")
    assert dark == (scheme == "dark")
    if lang == "bn":
        student.press(page.locator(".languages button[value=bn]"))
    expect(page.locator("html")).to_have_attribute("lang", lang)
    check = partial(look, student, barriers)
    practise_a_block(student, check)
    look_into_figures(student, check)
    sit_the_trial_exam(student, server, check)
    go_on_with_a_phone(student, browser, check)
