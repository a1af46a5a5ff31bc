"""The page as a person meets it: by axe, on a phone, in the dark, with the slider moved by keys."""

from __future__ import annotations

import math
import re

import pytest
from sweep import sample

from quizgen.locale import list_languages
from quizgen.tradeoff.page import write_page

RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
SIDEWAYS = """() => [...document.querySelectorAll('.wide')].filter(
  box => box.checkVisibility() && box.scrollWidth > box.clientWidth).map(box => box.innerText)"""
HEIGHT = "document.documentElement.scrollHeight"
WIDTH = "document.documentElement.scrollWidth"


@pytest.fixture(scope="module")
def page_file(report, tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    write_page(report, folder, "quizgen tradeoff")
    return folder / "tradeoff.html"


@pytest.fixture
def opened(browser, page_file):
    def page(width, height=800, scheme="light"):
        made = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
        made.goto(page_file.as_uri())
        return made

    return page


@pytest.mark.parametrize(("width", "scheme"), sample([(390, "light"), (1280, "dark")], 1))
def test_axe_finds_no_violation(opened, barriers, width, scheme):
    page = opened(width, scheme=scheme)
    for lang in list_languages():
        page.check(f"#{lang}")
        assert barriers(page) == []
    page.close()


@pytest.mark.parametrize(("width", "height", "screens"), [(1280, 800, 3), (390, 844, 6)])
def test_it_fills_few_screens_and_none_sideways(opened, width, height, screens):
    page = opened(width, height)
    for lang in list_languages():
        page.check(f"#{lang}")
        assert page.evaluate(HEIGHT) <= screens * height
        assert page.evaluate(WIDTH) <= width
        assert page.evaluate(SIDEWAYS) == []
    page.close()


def test_the_slider_moves_by_keys_and_digits_vanish(opened):
    page = opened(390)
    box = page.locator(".en .sweep")
    box.locator("select").select_option(label="Pixels beyond k sigma")
    slider, seen = box.locator("input"), {}
    slider.focus()
    for key in ("Home", *["ArrowRight"] * 42):
        page.keyboard.press(key)
        k = float(re.fullmatch(r"k = ([\d.]+)", box.locator("output").inner_text())[1])
        printed = box.locator("tr").nth(1)
        seen[k] = len(printed.locator("b").inner_text()) if printed.locator("b").count() else 0
        exact = box.locator("tr").nth(0).locator("td").inner_text().replace("·10", "e")
        # k is shown in three figures
        assert float(exact.translate(RAISED)) == pytest.approx(
            math.erfc(k / math.sqrt(2)), rel=0.006 * k * k + 0.05
        )
    assert seen[min(seen)] > 15
    assert seen[max(seen)] < 5
    assert max(seen) > 7.9
    assert slider.get_attribute("aria-valuetext").endswith(", No exam goes this far.")
    page.close()


def test_each_of_eight_formulas_can_be_chosen(opened):
    page = opened(1280)
    box = page.locator(".en .sweep")
    titles = box.locator("option").all_inner_texts()
    assert len(titles) == 8
    lessons = set()
    for title in titles:
        box.locator("select").select_option(label=title)
        lessons.add(box.locator(".lesson").inner_text())
        assert box.locator(".printed").inner_text() != box.locator(".stable").inner_text()
    assert len(lessons) == 8
    page.close()


def test_no_number_is_written_as_programs_write_it(opened):
    page = opened(1280)
    said = page.evaluate("document.body.innerText")
    assert re.findall(r".{20}\d[eE][-+]?\d.{20}", said) == []
    page.close()
