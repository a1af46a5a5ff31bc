"""The page keeps what is typed: over a reload, going back and a crash; and says who typed it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from quizgen.cli.check import check
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper
from quizgen.render import KINDS, render_paper

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def folder(bank, tmp_path_factory):
    made = tmp_path_factory.mktemp("keeping")
    paper = build_paper(bank, load_blueprint("mock"), 12, "en", figures=False)
    for kind in KINDS:
        (made / f"{kind}.html").write_bytes(render_paper(paper, kind, "html"))
    (made / "key.json").write_bytes(write_answer_key(paper))
    return made


@pytest.fixture
def context(browser):
    with_storage = browser.new_context()
    yield with_storage
    with_storage.close()


def opened(context, folder):
    page = context.new_page()
    page.goto((folder / "exam.html").as_uri())
    return page


def fill_everything(page) -> dict:
    """Fill every kind of field there is; what the page then holds."""
    page.locator("#student-name").fill("আয়েশা")
    page.locator("#student-matriculation").fill("0815")
    for field in page.locator("form input[type=text]:not([data-student])").all():
        field.fill("6,67")
    for name in ("radio", "checkbox"):
        for field in page.locator(f"form input[type={name}]").all()[:3]:
            field.check()
    for field in page.locator("form select").all():
        field.select_option(index=1)
    return held(page)


HELD = """() => Object.fromEntries([...document.querySelectorAll("form input, form select")]
  .map(f => [f.id, /radio|checkbox/.test(f.type) ? f.checked : f.value]))"""


def held(page) -> dict:
    return page.evaluate(HELD)


def test_reload_back_and_a_crash_lose_nothing(context, folder):
    page = opened(context, folder)
    before = fill_everything(page)
    assert {"৬", "6,67", True} & {*before.values()}
    page.on("dialog", lambda dialog: dialog.accept())
    page.reload()
    assert held(page) == before
    page.goto((folder / "solutions.html").as_uri())
    page.go_back()
    assert held(page) == before
    page.close(run_before_unload=False)
    assert held(opened(context, folder)) == before


def test_another_paper_starts_empty(context, folder, bank):
    page = opened(context, folder)
    fill_everything(page)
    other = folder / "other.html"
    paper = build_paper(bank, load_blueprint("mock"), 13, "en", figures=False)
    other.write_bytes(render_paper(paper, "exam", "html"))
    page.on("dialog", lambda dialog: dialog.accept())
    page.goto(other.as_uri())
    assert not any(held(page).values())


def test_leaving_asks_only_while_something_is_unsaved(context, folder):
    page = opened(context, folder)
    asked = []
    page.on("dialog", lambda dialog: (asked.append(dialog.type), dialog.accept()))
    page.locator("#student-name").click()
    page.reload()
    assert asked == []
    page.locator("#student-name").fill("Ada")
    page.reload()
    assert asked == ["beforeunload"]
    with page.expect_download():
        page.locator("#save").click()
    assert "key.json" in page.locator("#saved").text_content()
    page.reload()
    assert asked == ["beforeunload"]


def test_what_is_saved_names_the_student_and_can_be_checked(context, folder, tmp_path):
    page = opened(context, folder)
    fill_everything(page)
    with page.expect_download() as download:
        page.locator("#save").click()
    form = tmp_path / download.value.suggested_filename
    assert form.name == "answers.json"
    download.value.save_as(form)
    saved = json.loads(form.read_text(encoding="utf-8"))
    assert saved["student"]["name"] == "আয়েশা"
    assert saved["student"]["matriculation"] == "0815"
    assert not {"name", "student-name", ""} & {*saved["answers"]}
    done = CliRunner().invoke(check, [str(folder / "key.json"), str(form), "--json"])
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["unknown_parts"] == []


def test_a_page_without_storage_still_saves(browser, folder):
    context = browser.new_context()
    context.add_init_script(
        "Object.defineProperty(window, 'localStorage', { get() { throw new Error('no'); } })"
    )
    page = opened(context, folder)
    page.locator("#student-name").fill("Ada")
    with page.expect_download() as download:
        page.locator("#save").click()
    saved = json.loads(Path(download.value.path()).read_text(encoding="utf-8"))
    context.close()
    assert saved["student"]["name"] == "Ada"


def test_a_blank_form_prints_lines_to_write_on(context, folder):
    page = opened(context, folder)
    page.emulate_media(media="print")
    look = page.evaluate("""() => [...document.querySelectorAll("form input[type=text], form select")]
      .map(f => { const s = getComputedStyle(f); return [s.borderTopWidth, s.borderBottomWidth, s.appearance,
        f.selectedOptions ? f.selectedOptions[0].textContent : f.value]; })""")
    assert look
    assert {tuple(one) for one in look} == {("0px", "1px", "none", "")}
    heights = page.evaluate("""() => [...document.querySelectorAll("input[style]:not(.typing)")]
      .map(f => f.getBoundingClientRect().height)""")
    assert heights
    assert min(heights) > 40
    assert not page.locator(".save").is_visible()


def test_the_page_says_at_its_start_what_paper_it_is_of(folder):
    key = json.loads((folder / "key.json").read_text(encoding="utf-8"))
    head = (folder / "exam.html").read_bytes()[:4096].decode()
    assert re.search(r'data-paper="([0-9a-f]{16})"', head)[1] == key["paper"]


def test_what_is_drawn_in_the_page_is_kept_as_its_text(bank, context, tmp_path, barriers):
    paper = build_paper(bank, load_blueprint("trial"), 3, "en", figures=False)
    (tmp_path / "exam.html").write_bytes(render_paper(paper, "exam", "html"))
    page = opened(context, tmp_path)
    svg, field = page.locator("svg.strokes"), page.locator("input.typing")
    svg.scroll_into_view_if_needed()
    box = svg.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 3, box["y"] + box["height"] / 3)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2, steps=5)
    page.mouse.up()
    svg.focus()
    for key in ("Enter", "Shift+ArrowRight", "Enter", "Escape"):
        page.keyboard.press(key)
    text = field.input_value()
    assert re.fullmatch(r"-0\.\d+,0\.\d+ \S+; 0,0 0\.5,0", text)
    page.reload()
    assert field.input_value() == text
    assert svg.locator("polyline").count() == 2
    assert not barriers(page)
    page.get_by_role("button", name="Undo").click()
    assert field.input_value() == text.split(";")[0]
