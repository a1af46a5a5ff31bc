"""The formula sheet in the browser."""

from __future__ import annotations

import html
import re
from typing import get_args

import pytest

from quizgen.bank.formulas import MovingName, templates_by_formula
from quizgen.question.formula_sheet import compose_sheet
from quizgen.render import render_sheet


def shown(page: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]*>", " ", page).split()))


def article(page: str, name: str) -> str:
    return re.search(rf'<article class="formula" id="{name}".*?</article>', page, re.DOTALL)[0]


def test_every_formula_of_the_chapter_is_there_in_both_languages(client, token):
    pages = {}
    for lang in ("en", "bn"):
        client.post("/settings", data={"token": token, "lang": lang, "back": "/formulas"})
        pages[lang] = client.get("/formulas").text
        ids = re.findall(r'<article class="formula" id="(F\d\d)"', pages[lang])
        assert sorted(ids) == [f"F{i:02}" for i in range(1, 47)]
    client.post("/settings", data={"token": token, "lang": "en", "back": "/"})
    pixels = article(pages["en"], "F08")
    assert "From pixel pitch to the focal length in pixels" in shown(pixels)
    assert "d x : pixel pitch in m" in shown(pixels)
    assert re.search('<math aria-label="m sub x equals', pixels), pixels
    assert re.search("[\u0980-\u09ff]", article(pages["bn"], "F08"))


def test_a_formula_is_practised_from_the_sheet(client, token, app, bank):
    page = article(client.get("/formulas").text, "F08")
    assert 'name="formula" value="F08"' in page
    begun = client.post("/practice", data={"token": token, "formula": "F08"})
    assert begun.url.path.startswith("/q/")
    store = app.state.site.store
    asked = store.latest(store.learner().id, 1)[0].template
    assert asked in templates_by_formula(bank)["F08"], "which one, the plan decides"


def test_the_sheet_to_print_is_a_pdf_of_the_same_title(client):
    answer = client.get("/formulas.pdf")
    assert answer.headers["content-type"] == "application/pdf"
    assert answer.content.startswith(b"%PDF-")


def test_a_worked_solution_leads_to_its_formulas(client, token, begin):
    at = begin("point-to-image-plane")
    page = client.post(f"{at}/1", data={"token": token, "do": "solution", "a": ["", ""]}).text
    cited = set(re.findall(r'class="cite" href="/formulas#(F\d\d)"', page))
    assert cited
    formulas = client.get("/formulas").text
    assert all(f'id="{name}"' in formulas for name in cited)


def test_its_style_is_that_of_the_sheet_as_a_file(client, bank):
    answer = client.get("/static/sheet.css")
    assert answer.headers["content-type"].startswith("text/css")
    assert answer.text in render_sheet(compose_sheet(bank, "en"), "html").decode()
    assert '<link rel="stylesheet" href="/static/sheet.css">' in client.get("/formulas").text


def test_figures_that_move_are_folded_and_post_nothing(client):
    folds = re.findall(
        '<details class="moving">.*?</details>', client.get("/formulas").text, re.DOTALL
    )
    shown = {re.search(r'data-figure="([\w-]+)"', fold)[1] for fold in folds}
    assert shown == set(get_args(MovingName))
    assert not [fold for fold in folds if "style=" in fold or " open" in fold or ' name="' in fold]


@pytest.mark.browser
def test_the_page_of_formulas_on_a_phone(opened, served):
    page = opened(viewport={"width": 390, "height": 800})
    page.goto(f"{served.address}/formulas#F08")
    page.locator("#F08 button").first.click()
    page.wait_for_url("**/q/*")
