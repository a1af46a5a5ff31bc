"""The page as a person meets it: by axe, on a phone, in the dark, with the slider moved by keys."""

from __future__ import annotations

import itertools
import json
import math
import re
from dataclasses import replace

import pytest

from quizgen.locale import languages
from quizgen.tradeoff.knobs import KNOBS
from quizgen.tradeoff.measure import QUICK
from quizgen.tradeoff.page import write
from quizgen.tradeoff.product import measure_product
from quizgen.tradeoff.report import measure
from quizgen.tradeoff.solving import ARITHMETICS

BOXES = """() => [...document.querySelectorAll('svg')].filter(svg => svg.checkVisibility()).map(
  svg => [...svg.querySelectorAll('text')].map(text => {
    const box = text.getBoundingClientRect();
    return [text.textContent, box.x, box.y + 0.2 * box.height, box.x + box.width,
            box.y + 0.8 * box.height];  // a line is higher than its letters
  }))"""


@pytest.fixture(scope="module")
def page_file(tmp_path_factory):
    report = measure(["gaussian-tail", "thin-lens", "inverse-distortion", "hue"], quick=True)
    crowded = [knob for knob in KNOBS if knob.key in {"photons", "iterations", "camera"}]
    knobs = tuple((knob.key, tuple(knob.measure(QUICK))) for knob in crowded)
    product = measure_product(0, 1, lambda _: None)
    folder = tmp_path_factory.mktemp("page")
    write(replace(report, knobs=knobs, product=product), folder, "quizgen tradeoff")
    return folder / "tradeoff.html"


@pytest.fixture
def opened(browser, page_file):
    def page(width, scheme="light"):
        made = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
        made.goto(page_file.as_uri())
        return made

    return page


def test_the_whole_product_is_exported_too(page_file):
    rows = (page_file.parent / "product.csv").read_text("utf-8").splitlines()
    assert rows[0].startswith("arithmetic,drawing_ms,solving_ms")
    assert [row.split(",")[0] for row in rows[1:]] == list(ARITHMETICS)
    assert json.loads((page_file.parent / "counted.json").read_text("utf-8"))["drawn"] == 10_000
    assert (page_file.parent / "photons.svg").exists()


@pytest.mark.parametrize(("width", "scheme"), [(400, "light"), (900, "dark")])
def test_axe_finds_no_violation(opened, barriers, width, scheme):
    page = opened(width, scheme)
    for lang in languages():
        page.check(f"#{lang}")
        assert barriers(page) == []
    page.close()


@pytest.mark.parametrize("width", [400, 900, 1400])
def test_no_label_of_a_plot_covers_another_one(opened, width):
    page = opened(width)
    for lang in languages():
        page.check(f"#{lang}")
        plots = page.evaluate(BOXES)
        assert len(plots) == 2 + 1 + 4 * 3 + 2 + 2
        for (one, *a), (other, *b) in itertools.chain.from_iterable(
            itertools.combinations(boxes, 2) for boxes in plots
        ):
            across = min(a[2], b[2]) - max(a[0], b[0])
            along = min(a[3], b[3]) - max(a[1], b[1])
            assert across < 1 or along < 1, (lang, one, other)
    page.close()


OUTSIDE = """() => [...document.querySelectorAll('svg')].filter(svg => svg.checkVisibility()).flatMap(
  svg => { const whole = svg.getBoundingClientRect();
    return [...svg.querySelectorAll('text')].filter(text => { const box = text.getBoundingClientRect();
      return box.left < whole.left || box.right > whole.right || box.top < whole.top
        || box.bottom > whole.bottom }).map(text => text.textContent) })"""
SIDEWAYS = """() => [...document.querySelectorAll('.wide')].filter(
  box => box.checkVisibility() && box.scrollWidth > box.clientWidth).map(box => box.innerText)"""


@pytest.mark.parametrize("width", [400, 900])
def test_nothing_is_cut_off(opened, width):
    """A plot shows no label beyond its edge, and on a phone no table has to be pushed aside."""
    page = opened(width)
    for lang in languages():
        page.check(f"#{lang}")
        assert page.evaluate(OUTSIDE) == []
        assert page.evaluate(SIDEWAYS) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.close()


PROSE = """() => { const body = document.body.cloneNode(true);
  body.querySelectorAll('script, style, code, [translate=no]').forEach(node => node.remove());
  return body.textContent
    + [...body.querySelectorAll('[data-places]')].map(node => node.dataset.places).join() }"""


def test_no_number_is_written_as_programs_write_it(opened):
    page = opened(900)
    said = page.evaluate(PROSE)
    assert "N = 10⁶" in said
    assert said.count("10\u202f000") >= 2 * len(languages())
    assert re.findall(r".{40}\d[eE][-+]?\d.{20}", said) == []
    assert re.findall(r"[a-z]\.(?=[A-Z][a-z])", said) == []  # a sentence without a space after it
    page.close()


def test_letters_on_a_phone_are_not_smaller_than_nine_pixels(opened):
    page = opened(400)
    shown = page.evaluate(
        "() => { const svg = document.querySelector('svg');"
        "return 11 * svg.getBoundingClientRect().width / svg.viewBox.baseVal.width }"
    )
    assert shown >= 9
    page.close()


def test_the_slider_moves_by_keys_and_digits_vanish(opened):
    page = opened(400)
    box = page.locator("#gaussian-tail-en .sweep")
    slider = box.locator("input")
    slider.focus()
    seen = {}
    for key in ("Home", *["ArrowRight"] * 20):
        page.keyboard.press(key)
        k = float(re.fullmatch(r"k = ([\d.]+)", box.locator("output").inner_text())[1])
        float64 = box.locator("tr").nth(1)
        seen[k] = len(float64.locator("b").inner_text()) if float64.locator("b").count() else 0
        exact = box.locator("tr").nth(0).locator("td").inner_text().replace("·10", "e")
        number = exact.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
        assert float(number) == pytest.approx(math.erfc(k / math.sqrt(2)), rel=2e-4 * k * k)
    assert min(seen) == 1
    assert max(seen) == 12
    assert seen[1] > 15
    assert all(right == 0 for k, right in seen.items() if k > 8.5)
    assert slider.get_attribute("aria-valuetext") == "k = 12: float64 as printed has 0 right digits"
    page.close()
