"""The exam as it lies on the desk: cover, room to work in, boxes."""

from __future__ import annotations

import io
import re
from collections import Counter

import numpy as np
import pikepdf
import pytest
import typst
from PIL import Image
from sweep import sample

from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper, single_question_paper
from quizgen.render import html, pdf, render_paper
from quizgen.render.answer_fields import count_columns
from quizgen.render.layouts import count_working_rows
from quizgen.render.scanned_paper import render_scanned_paper
from quizgen.render.text import format_question
from quizgen.render.typst_document import _load_font_collection, compile_pdf


@pytest.fixture(scope="module")
def mock(bank):
    return build_paper(bank, load_blueprint("mock"), 3, "en")


@pytest.fixture(scope="module")
def trial(bank):
    return build_paper(bank, load_blueprint("trial"), 3, "bn")


@pytest.fixture(scope="module")
def body(mock):
    source = pdf.typst_sources(mock, "exam")["main.typ"].decode()
    return source.partition("#show: paper.with")[2]


def test_there_is_room_only_where_something_is_computed_and_more_for_more_steps(mock):
    rows = [
        (len(solved.lines), count_working_rows(part, solved), part.field.control.form)
        for item in mock.items
        for part, solved in zip(item.questions[0].parts, item.keys[0].solution.parts, strict=True)
    ]
    assert {room for steps, room, form in rows if not steps or form != "line"} == {0}
    typed = [(steps, room) for steps, room, form in rows if steps and form == "line"]
    assert max(room for steps, room in typed if steps == 1) < max(room for _, room in typed) <= 8


def test_a_scanned_number_has_a_cell_for_each_sign_of_three_figures(bank):
    """``-0.745``, a coordinate of that question, has six; a cell is 4 mm wide."""
    template = bank.template("radial-point-off-axis")
    paper = single_question_paper(template, 3, "en", figures=False)
    _, places = render_scanned_paper(paper, "A:{}".format)
    widths = [field.w for field in places.fields if field.is_number]
    assert len(widths) == 3
    assert min(widths) // 4 >= 6


def test_the_cover_has_aids_points_minutes_and_a_table(mock, body):
    cover = body.partition("#question(")[0]
    assert "pocket calculator" in cover
    assert f'"100 points, {mock.minutes} min' in cover
    assert '[#"100";]' in cover or "[100]" in cover
    rows = re.findall(r"\(\[(\d+)\], \[", cover.partition("#overview(")[2])
    assert rows == [item.number for item in mock.items]
    assert "Reached" in cover


def test_a_table_that_runs_over_the_cover_settles(mock):
    source = pdf.typst_sources(mock, "exam")
    body = source["main.typ"].replace(b"#overview", b"#v(15cm)\n#overview", 1)
    with pikepdf.open(io.BytesIO(compile_pdf({**source, "main.typ": body}))) as made:
        pages = len(made.pages)
    with pikepdf.open(io.BytesIO(compile_pdf(source))) as usual:
        assert pages == len(usual.pages) + 1


def test_each_calculation_has_room_and_each_statement_two_boxes(mock, body):
    fields = [part.field.control for item in mock.items for part in item.questions[0].parts]
    calls = Counter(re.findall(r"#(room|more|truth)[\[(]", body))
    reckoned = sum(
        count_working_rows(part, solved) > 0
        for item in mock.items
        for part, solved in zip(item.questions[0].parts, item.keys[0].solution.parts, strict=True)
    )
    assert reckoned > 10
    assert calls["room"] == calls["more"] == reckoned
    assert calls["truth"] == sum(control.form == "truth" for control in fields)


def test_papers_of_a_language_share_their_rules_and_read_sentences_out_of_strings(bank, mock):
    """What Typst has laid out for one of them it need not lay out for another."""
    other = build_paper(bank, load_blueprint("mock"), 4, "en")
    kinds = [(mock, "exam"), (mock, "solutions"), (other, "exam")]
    files = [pdf.typst_sources(paper, kind) for paper, kind in kinds]
    texts = [file["main.typ"].decode() for file in files]
    assert len({re.search(r"^#show: .*$", text, re.MULTILINE)[0] for text in texts}) == 1
    assert mock.code in texts[0]
    assert mock.code not in texts[0].partition("#show: ")[2].partition("\n")[0]
    assert files[0]["paper.typ"] == files[2]["paper.typ"]
    assert '#spoken("en")[#passage(' in texts[0]
    assert not re.search(r'^#spoken\("en"\)\[#"', texts[1], re.MULTILINE)


def test_a_trial_has_a_box_to_sketch_in(trial):
    source = pdf.typst_sources(trial, "exam")["main.typ"].decode()
    (part,) = [
        part.field.id
        for item in trial.items
        for part in item.questions[0].parts
        if part.field.control.board
    ]
    assert source.count(f'#image("figure-{part}.svg"') == 1
    page = html.render_paper_html(trial, "exam").decode()
    assert page.count('<path data-part="given"') >= 1
    assert '<path data-part="wanted"' not in page
    assert (
        html.render_paper_html(trial, "solutions").decode().count('<path data-part="wanted"') >= 1
    )


def test_the_page_says_how_to_type_and_printed_how_to_write(browser, mock, tmp_path):
    file = tmp_path / "exam.html"
    file.write_bytes(html.render_paper_html(mock, "exam"))
    page = browser.new_page()
    page.goto(file.as_uri())
    seen = {}
    for medium in ("screen", "print"):
        page.emulate_media(media=medium)
        seen[medium] = [page.locator(f"p.{name}").is_visible() for name in ("typing", "writing")]
        seen[medium].append(page.locator(".squares").first.is_visible())
    page.close()
    assert seen == {"screen": [True, False, False], "print": [False, True, True]}


def white_below(paper, kind):
    """What share of each page is white at its end, the cover and the last page aside."""
    pages = typst.compile(
        pdf.typst_sources(paper, kind), format="png", ppi=24, font_paths=_load_font_collection()
    )
    for page in pages[kind == "exam" : -1]:
        grey = np.asarray(Image.open(io.BytesIO(page)).convert("L"))
        mm = len(grey) / 297
        text = grey[round(20 * mm) : round((297 - 22) * mm)]
        yield 1 - (np.flatnonzero((text < 245).any(axis=1))[-1] + 1) / len(text)


@pytest.mark.parametrize(
    ("kind", "seed", "lang", "most"),
    [("exam", 1, "en", 0.5), ("exam", 2, "bn", 0.5), ("solutions", 0, "en", 0.33)],
)
def test_no_page_ends_far_from_its_foot(bank, kind, seed, lang, most):
    paper = build_paper(bank, load_blueprint("mock"), seed, lang)
    assert max(white_below(paper, kind)) <= most


def count_pages(paper, kind="exam"):
    with pikepdf.open(io.BytesIO(render_paper(paper, kind, "pdf"))) as made:
        return len(made.pages)


def test_a_trial_has_three_pages(trial):
    assert count_pages(trial) <= 3


LONG = (5, 51)
"""Seeds of mocks that have 13 and 12 pages with the usual room to work in."""


@pytest.mark.slow
@pytest.mark.parametrize("lang", sample(["bn", "en"], 1))
def test_no_mock_has_more_than_eleven_pages_and_no_trial_more_than_three(bank, lang):
    mock, trial = load_blueprint("mock"), load_blueprint("trial")
    for seed in (*LONG, *range(1, 4)):
        assert count_pages(build_paper(bank, mock, seed, lang)) <= 11
        assert count_pages(build_paper(bank, trial, seed, lang)) <= 3
    paper = build_paper(bank, mock, LONG[0], lang)
    assert render_scanned_paper(paper, lambda page: f"{page:020}")[1].pages <= 11


def test_nothing_on_paper_is_said_as_it_is_typed(mock, body):
    """Rounding and lists are said by the boxes; semicolons and names with signs are for keys."""
    for typed in ("semicolon", "A2 B1", "(…; …)", "x,y", "= ..."):
        assert typed not in body
    boxes = [part.field.box for item in mock.items for part in item.questions[0].parts]
    assert {box.unit for box in boxes if box} - {""}
    assert "decimals" in body


def test_questions_with_figures_hold_together_and_others_break_between_parts(mock, body):
    texts = re.split(r"^#question\(", body, flags=re.MULTILINE)[1:]
    for item, text in zip(mock.items, texts, strict=True):
        calls = re.findall(r"^#part\(.*?hold: (\w+), less: 0.0mm", text, re.MULTILINE)
        held = [call == "true" for call in calls]
        drawn = any(part.field.drawing for part in item.questions[0].parts)
        if item.questions[0].figure or drawn:
            assert all(held[:-1])
        elif len(held) > 1 and "#room" not in text and "#space" not in text:
            assert not any(held)


def test_short_options_stand_in_columns():
    assert [count_columns(*of) for of in ((8, 5), (20, 4), (42, 3), (43, 3), (94, 2))] == [
        5, 2, 2, 2, 1,
    ]  # fmt: skip


def test_an_answer_told_in_words_alone_begins_with_them(bank):
    paper = single_question_paper(
        bank.template("define-image-pixel-channel"), 3, "en", figures=False
    )
    said = re.findall(
        r"<strong>Answer:</strong>\s*(\S+)", html.render_paper_html(paper, "solutions").decode()
    )
    assert said[1:] == ["A", "A", "false"], "a model answer, and a truth value"
    typst_text = pdf.typst_sources(paper, "solutions")["main.typ"].decode()
    assert r"#strong(\"Answer:\"); #\" - \"" not in typst_text


def test_solutions_say_what_the_numbers_beside_steps_are(bank):
    paper = single_question_paper(bank.template("point-to-image-plane"), 1, "en", figures=False)
    page = html.render_paper_html(paper, "solutions").decode()
    (number,) = re.findall(r"A number such as (F\d\d) next to a step", page)
    assert page.count(number) > 1


def test_of_a_drawn_mistake_only_the_sentence_is_told(bank):
    """Its points would be three lines of numbers, and no picture of it."""
    paper = single_question_paper(bank.template("draw-image-through-a-pinhole"), 1, "en")
    said = "The image stands upright."
    assert f"<li>{said}" in html.render_paper_html(paper, "solutions").decode()
    typst_text = pdf.typst_sources(paper, "solutions")["main.typ"].decode()
    assert f'#slip("", false, [], [#passage("#\\"{said}' in typst_text
    assert f"! upright: {said}" in format_question(paper.items[0])
