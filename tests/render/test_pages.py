"""Pages as a person meets them: in Chromium, by axe, in the dark, on a phone, without a network."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from sweep import sample

from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper
from quizgen.render import KINDS, render_paper

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module", params=sample(["trial", "mock"], 1))
def pages(bank, request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    paper = build_paper(bank, load_blueprint(request.param), 11, "both")
    for kind in KINDS:
        (folder / f"{kind}.html").write_bytes(render_paper(paper, kind, "html"))
    return folder, paper


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_violation(browser, pages, kind, scheme, barriers):
    page = browser.new_page(color_scheme=scheme)
    page.goto((pages[0] / f"{kind}.html").as_uri())
    found = barriers(page)
    page.close()
    assert found == []


def test_nothing_is_fetched(browser, pages):
    page = browser.new_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto((pages[0] / "exam.html").as_uri())
    page.close()
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_phone_needs_no_sideways_scrolling(browser, pages, kind):
    page = browser.new_page(viewport={"width": 360, "height": 740})
    page.goto((pages[0] / f"{kind}.html").as_uri())
    width = page.evaluate("document.documentElement.scrollWidth")
    page.close()
    assert width <= 360


def test_readable_without_javascript(browser, pages):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto((pages[0] / "exam.html").as_uri())
    assert page.locator("section.question").count() == len(pages[1].items)
    assert not page.locator("#save").is_visible()
    context.close()


def test_save_answers_downloads_what_was_typed(browser, pages):
    folder, paper = pages
    page = browser.new_page()
    page.goto((folder / "exam.html").as_uri())
    first = page.locator("input[type=text]:not([data-student])").first
    name = first.get_attribute("name")
    first.fill("৬,৬৭ mm")
    with page.expect_download() as download:
        page.locator("#save").click()
    saved = json.loads(Path(download.value.path()).read_text(encoding="utf-8"))
    page.close()
    assert download.value.suggested_filename == "answers.json"
    assert saved["code"] == paper.code
    assert saved["answers"] == {name: "৬,৬৭ mm"}


def test_every_field_has_a_label_and_every_passage_its_language(browser, pages):
    page = browser.new_page()
    page.goto((pages[0] / "exam.html").as_uri())
    unlabelled = page.evaluate(
        "[...document.querySelectorAll('input, select')].filter(f => !f.labels.length).length"
    )
    bangla = page.evaluate(
        """[...document.querySelectorAll('body *')].filter(e => [...e.childNodes].some(n =>
            n.nodeType === 3 && /[\\u0980-\\u09ff]/.test(n.data)) && !e.closest('[lang=bn]')
            && e.tagName !== 'SCRIPT').map(e => e.outerHTML.slice(0, 120))"""
    )
    page.close()
    assert unlabelled == 0
    assert bangla == []


def test_the_fonts_are_embedded_and_used(browser, pages):
    page = browser.new_page()
    page.goto((pages[0] / "exam.html").as_uri())
    page.evaluate("document.fonts.ready.then(() => true)")
    loaded = set(
        page.evaluate("[...document.fonts].filter(f => f.status === 'loaded').map(f => f.family)")
    )
    page.close()
    assert {name.strip('"') for name in loaded} == {"QuizText", "QuizMaths", "QuizBangla"}
