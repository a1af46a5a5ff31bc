"""The formula sheet as page and PDF: whole, valid, tagged, readable on a phone, few pages."""

from __future__ import annotations

import io

import html5lib
import pikepdf
import pytest
from sweep import sample

from quizgen.question.formula_sheet import compose_sheet
from quizgen.render import SHEET_FORMATS, render_sheet

INVENTORY = [f"F{n:02}" for n in range(1, 47)]
NAMESPACE = "{http://www.w3.org/1999/xhtml}"
PAGES = {"en": 2, "bn": 2, "both": 3}


@pytest.fixture(scope="module", params=list(PAGES))
def choice(request):
    return request.param


@pytest.fixture(scope="module")
def made(bank, choice):
    found = compose_sheet(bank, choice)
    return found, {output: render_sheet(found, output) for output in SHEET_FORMATS}


def count(found):
    return sum(len(line.lines) for group in found.groups for line in group.lines)


def test_the_page_is_valid_and_every_formula_has_an_anchor(made):
    page = html5lib.HTMLParser(strict=True).parse(made[1]["html"].decode())
    articles = page.findall(f".//{NAMESPACE}article")
    assert sorted(article.get("id") for article in articles) == INVENTORY
    ids = [node.get("id") for node in page.iter() if node.get("id")]
    assert len(ids) == len(set(ids))
    links = [node.get("href") for node in page.iter(f"{NAMESPACE}a")]
    assert {link.removeprefix("#") for link in links} == set(ids)
    assert not [link for link in links if not link.startswith("#")]


def test_every_line_is_typeset_on_the_page(made):
    assert made[1]["html"].decode().count('<div class="line"') == count(made[0])


def formulas_of(node, found):
    if isinstance(node, pikepdf.Array):
        for item in node:
            formulas_of(item, found)
    elif isinstance(node, pikepdf.Dictionary):
        if str(node.get("/S", "")) == "/Formula":
            found.append(str(node.get("/Alt", "")).strip())
        if "/K" in node:
            formulas_of(node.K, found)
    return found


def test_the_pdf_is_tagged_and_reads_every_formula_aloud(made):
    pdf = pikepdf.open(io.BytesIO(made[1]["pdf"]))
    assert pdf.Root.MarkInfo.Marked
    assert str(pdf.Root.Lang).startswith(made[0].langs[0])
    spoken = formulas_of(pdf.Root.StructTreeRoot.K, [])
    assert len(spoken) >= count(made[0])
    assert all(spoken)


def test_the_pdf_is_short_enough_to_be_printed(made, choice):
    assert len(pikepdf.open(io.BytesIO(made[1]["pdf"])).pages) == PAGES[choice]


def test_the_same_sheet_is_the_same_bytes(bank):
    again = [
        render_sheet(compose_sheet(bank, "bn", ["eye"]), name)
        for name in SHEET_FORMATS
        for _ in range(2)
    ]
    assert again[0] == again[1]
    assert again[2] == again[3]


@pytest.fixture(scope="module")
def address(bank, tmp_path_factory):
    path = tmp_path_factory.mktemp("sheet") / "formulas.html"
    path.write_bytes(render_sheet(compose_sheet(bank, "both"), "html"))
    return path.as_uri()


@pytest.mark.browser
@pytest.mark.slow  # by default the page of formulas of the server, which is made of the same
@pytest.mark.parametrize("scheme", sample(["light", "dark"], 1))
def test_axe_finds_no_violation(browser, address, scheme, barriers):
    page = browser.new_page(color_scheme=scheme)
    page.goto(address)
    found = barriers(page)
    page.close()
    assert found == []


@pytest.mark.browser
def test_a_phone_needs_no_sideways_scrolling_and_nothing_is_fetched(browser, address):
    page = browser.new_page(viewport={"width": 360, "height": 740})
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(f"{address}#F05")
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert page.locator("#F05").is_visible()
    page.close()
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
