"""Tables of questions on narrow screens: whole words, and nothing wider than the screen."""

from __future__ import annotations

import pytest

from quizgen.bank.bank import builtin_bank
from quizgen.paper.paper import single_question_paper
from quizgen.render import render_paper
from quizgen.typeset.prose import TableBlock

BROKEN = """[...document.querySelectorAll("th, td")].flatMap(cell => {
  const range = document.createRange(), broken = [];
  for (const text of [...cell.childNodes].filter(node => node.nodeType === Node.TEXT_NODE))
    for (const word of text.data.matchAll(/\\S+/g)) {
      range.setStart(text, word.index);
      range.setEnd(text, word.index + word[0].length);
      if (range.getClientRects().length > 1) broken.push(word[0]);
    }
  return broken;
})"""
WITH_TABLES = [
    name for name in builtin_bank().template_paths
    if any(isinstance(block, TableBlock) for block in builtin_bank().template(name).texts["bn"].stem)
]  # fmt: skip


def test_there_are_some():
    assert len(WITH_TABLES) >= 4


@pytest.mark.parametrize("lang", ["en", "bn"])
@pytest.mark.parametrize("name", WITH_TABLES)
def test_words_stay_whole(browser, tmp_path, name, lang):
    page_file = tmp_path / "exam.html"
    page_file.write_bytes(
        render_paper(single_question_paper(builtin_bank().template(name), 0, lang), "exam", "html")
    )
    page = browser.new_page(viewport={"width": 360, "height": 800})
    page.goto(page_file.as_uri())
    assert page.evaluate(BROKEN) == []
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    page.close()


@pytest.mark.parametrize("lang", ["en", "bn"])
def test_what_is_wider_than_the_screen_scrolls_by_itself(browser, tmp_path, lang):
    page_file = tmp_path / "exam.html"
    paper = single_question_paper(builtin_bank().template("infrared-leak"), 0, lang)
    page_file.write_bytes(render_paper(paper, "exam", "html"))
    page = browser.new_page(viewport={"width": 280, "height": 800})
    page.goto(page_file.as_uri())
    table = page.locator(".scroll")
    assert table.evaluate("box => box.scrollWidth > box.clientWidth")
    assert page.evaluate(BROKEN) == []
    assert page.evaluate("document.documentElement.scrollWidth") == 280
    table.focus()
    assert table.evaluate("box => box === document.activeElement")
    page.close()
