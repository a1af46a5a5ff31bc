"""Moodle XML read as Moodle's documents describe it, without a line of what wrote it."""

from __future__ import annotations

import base64
import re
from collections import Counter
from fractions import Fraction
from math import isclose
from xml.etree import ElementTree as ET

import pytest
from cloze import fields

from quizgen.lms.interactions import (
    ChoiceInteraction,
    MatchInteraction,
    NumericInteraction,
    OrderInteraction,
    TextEntryInteraction,
    needs_manual_grading,
)
from quizgen.lms.items import items_from_blueprint, items_from_templates
from quizgen.lms.markup import formula_dialect, to_course_html
from quizgen.lms.moodle import write_moodle
from quizgen.paper.blueprint import load_blueprint

PERCENTAGES = {
    100, 90, 83.33333, 80, 75, 70, 66.66667, 60, 50, 40, 33.33333, 30, 25, 20, 16.66667, 14.28571,
    12.5, 11.11111, 10, 5, 0,
}  # fmt: skip
NUMBER = re.compile(r"-?\d+(\.\d+)?(e[-+]?\d+)?")


@pytest.fixture(scope="module")
def questions(items):
    return read(items)


def read(items):
    root = ET.fromstring(write_moodle(items))
    return {
        one.findtext("idnumber"): one
        for one in root.iter("question")
        if one.get("type") != "category"
    }


def shares(question):
    yield from (
        float(one.get("fraction")) for one in question.iter("answer") if one.get("fraction")
    )
    for field in fields(question.findtext("questiontext/text")):
        yield from (one.percent for one in field.alternatives)


def keys(question):
    """Every number that an answer is compared with, and how far it may be."""
    if question.get("type") == "numerical":
        for one in question.iter("answer"):
            yield one.findtext("text"), one.findtext("tolerance")
    for field in fields(question.findtext("questiontext/text")):
        if field.kind == "NUMERICAL":
            yield from (one.typed.split(":") for one in field.alternatives)


def expected(item) -> set[str]:
    """The names of the questions that an item becomes."""
    written = [part.label for part, asks in item.parts if needs_manual_grading(asks)]
    essays = {f"{item.id}.{label}" if label else item.id for label in written}
    return essays if len(written) == len(item.parts) else {item.id, *essays}


def test_every_part_is_there(items, questions):
    assert set().union(*map(expected, items)) == {*questions}
    kinds = Counter(one.get("type") for one in questions.values())
    assert {"cloze", "essay", "numerical", "multichoice", "matching"} <= {*kinds}


def test_percentages_are_of_the_list_and_each_question_can_be_right(questions):
    for name, one in questions.items():
        found = list(shares(one)) if one.get("type") != "ordering" else []
        assert {abs(share) for share in found} <= PERCENTAGES, name
        if one.get("type") in {"numerical", "shortanswer", "truefalse"}:
            assert 100 in found, name


def test_numbers_have_a_point_and_a_tolerance(questions):
    found = [pair for one in questions.values() for pair in keys(one)]
    assert len(found) > 100
    assert [text for pair in found for text in pair if not NUMBER.fullmatch(text)] == []


def test_fields_of_a_text_are_what_is_asked(items, questions):
    for item in items:
        question = questions.get(item.id)
        if question is None or question.get("type") != "cloze":
            continue
        found = fields(question.findtext("questiontext/text"))
        asked = [ask for _, asks in item.parts for ask in asks if not needs_manual_grading([ask])]
        assert len(found) == sum(map(wide, asked)), item.id
        places = iter(found)
        for ask in asked:
            compare(ask, [next(places) for _ in range(wide(ask))], item.lang)


def wide(ask) -> int:
    match ask:
        case MatchInteraction():
            return len(ask.stems)
        case OrderInteraction():
            return len(ask.steps)
    return 1


def compare(ask, found, lang):
    """Whether the fields say what the ask does, feedback to the letter."""
    rows = found[0].alternatives
    match ask:
        case NumericInteraction():
            assert [row.typed for row in rows] == [f"{r.value!r}:{r.width!r}" for r in ask.ranges]
            assert [row.percent == 100 for row in rows] == [r.right for r in ask.ranges]
            assert [row.said for row in rows] == [
                str(to_course_html(r.feedback, lang)) for r in ask.ranges
            ]
        case ChoiceInteraction():
            marks = [row.typed.split(".")[0] for row in rows if row.percent > 0]
            assert marks == [option.letter for option in ask.right]
            assert rows[0].typed.endswith(str(to_course_html(ask.options[0].words, lang)))
        case TextEntryInteraction():
            right = [row.typed.replace("\\*", "*") for row in rows if row.percent == 100]
            assert right == list(ask.right)
        case MatchInteraction():
            right = [next(r.typed for r in f.alternatives if r.percent == 100) for f in found]
            assert right == [ask.right[mark] for mark, _ in ask.stems]


def test_weights_are_the_marks_of_the_parts(items, questions):
    for item in items:
        question = questions.get(item.id)
        if question is None or question.get("type") != "cloze":
            continue
        weights = [field.weight for field in fields(question.findtext("questiontext/text"))]
        points = [part.points for part, asks in item.parts if not needs_manual_grading(asks)]
        total = sum(points, Fraction(0))
        assert isclose(float(question.findtext("defaultgrade")), total, rel_tol=1e-6)
        start = 0
        for points_of, (_, asks) in zip(
            points, [row for row in item.parts if not needs_manual_grading(row[1])], strict=True
        ):
            count = sum(map(wide, asks))
            assert Fraction(sum(weights[start : start + count]), sum(weights)) == points_of / total
            start += count


def test_pictures_come_with_their_words(questions):
    seen = 0
    for name, one in questions.items():
        for place in ("questiontext", "generalfeedback"):
            shown = re.findall(
                r'<img src="@@PLUGINFILE@@/(\S+)" alt="([^"]{20,})"', one.findtext(f"{place}/text")
            )
            files = {file.get("name"): file.text for file in one.iter("file")}
            assert one.findtext(f"{place}/text").count("<img") == len(shown), name
            for file, _ in shown:
                assert base64.b64decode(files[file]).startswith(b"<svg"), name
            seen += len(shown)
    assert seen > 5


def test_braces_tildes_quotes_and_stars_survive(items):
    """Texts with every sign of the grammar, through the reader."""
    from quizgen.lms.moodle import _escape_cloze

    awkward = "{1:NUMERICAL:=3} ~ # \\ % = & &amp; \"quoted\" 'it' }"
    (read_back,) = fields(
        f"{{1:MULTICHOICE_V:%100%{_escape_cloze(awkward)}#{_escape_cloze(awkward)}~%0%no}}"
    )
    assert read_back.alternatives[0].typed == read_back.alternatives[0].said == awkward


def test_fields_are_where_a_text_says_so_and_nowhere_else(awkward):
    """Whatever the words of an own bank are."""
    found = read(awkward)
    test_fields_of_a_text_are_what_is_asked(awkward, found)
    test_weights_are_the_marks_of_the_parts(awkward, found)
    texts = [
        one.findtext("questiontext/text") for one in found.values() if one.get("type") == "cloze"
    ]
    assert sum("&#123;1:NUMERICAL:" in text for text in texts) > 0
    assert [text for text in texts if "{" in re.sub(r"\{\d+:[A-Z_]+:[^{}]*\}", "", text)] == []


def test_nothing_is_left_of_our_own_pages(questions):
    """Words hidden by our style would be seen twice."""
    for one in questions.values():
        page = "".join(one.itertext())
        assert not re.search(r"<[^>]* (class|aria-hidden|tabindex)=", page)
        assert "&lt;math" not in page


def test_a_mistake_is_told_once_with_the_answer_that_makes_it(reference):
    (one,) = read([reference("point-to-image-plane-fractions")]).values()
    said = "forgot to divide by the depth"
    assert said in one.findtext("questiontext/text")
    assert said not in one.findtext("generalfeedback/text")


def test_what_a_person_marks_is_kept_apart_with_its_own_solution(bank):
    """A quiz that draws from a category draws one or the other, so they are not in the same one."""
    item = next(items_from_templates(bank, ["recognise-and-sketch-distortion"], 0, 1, ["en"]))
    kept, found = "", {}
    for one in ET.fromstring(write_moodle([item])).iter("question"):
        if one.get("type") == "category":
            kept = one.findtext("category/text").rpartition("quizgen/")[2]
        else:
            found[kept] = one
    assert {name: one.get("type") for name, one in found.items()} == {
        "en/recognise-and-sketch-distortion": "cloze",
        "en/recognise-and-sketch-distortion-b": "essay",
    }
    told = [one.findtext("generalfeedback/text") for one in found.values()]
    assert [("(a)" in text, "(b)" in text) for text in told] == [(True, False), (False, True)]


def test_one_reason_for_all_targets_is_said_once(bank):
    """In the worked solution; reasons that differ by target stand with each."""
    (item,) = items_from_templates(bank, ["uses-of-colour-spaces"], 1, 1, ["en"])
    (one,) = read([item]).values()
    reason = "A press lays cyan, magenta, yellow and black ink on paper"
    text, told = one.findtext("questiontext/text"), one.findtext("generalfeedback/text")
    assert (text.count(reason), told.count(reason)) == (0, 1)
    assert "MULTICHOICE" in {row.kind for row in fields(text)}


def test_formulas_for_a_filter(reference):
    r"""``f X / Z`` as TeX between ``\(`` and ``\)``; its braces stand in fields as entities."""
    item = reference("point-to-image-plane-fractions")
    with formula_dialect("tex"):
        (one,) = read([item]).values()
    page = "".join(one.itertext())
    assert "<math" not in page
    assert r"\[p'_{x} = \frac{f p_{x} }{p_{z} }" in one.findtext("generalfeedback/text")
    (said,) = [row.said for row in fields(one.findtext("questiontext/text"))[0].alternatives
               if row.typed.startswith("20.0:")]  # fmt: skip
    assert said == r"You multiplied by \(f\) but forgot to divide by the depth \(p_{z}\)."


def test_a_question_of_one_number(reference):
    """Names, marks and what to type, as the reference question of the notes has them."""
    (one,) = read([reference("point-to-image-plane-fractions")]).values()
    text = one.findtext("questiontext/text")
    x, y = fields(text)
    assert text.startswith('<div lang="en"><p>')
    assert text.endswith("</p></div>")
    assert "Type the number alone" in text
    assert (x.weight, y.weight) == (3, 3)
    assert x.alternatives[0].typed.startswith("6.66666")
    (said,) = [row.said for row in x.alternatives if row.typed.startswith("20.0:")]
    assert "forgot to divide by the depth" in said
    assert "<h3>" in one.findtext("generalfeedback/text")


def test_variants_of_a_paper_share_slots(bank):
    plan = load_blueprint("trial", bank)
    made = list(items_from_blueprint(bank, plan, 5, 2, ["en"]))
    slots = Counter(item.slot for item in made)
    assert {*slots.values()} <= {1, 2}
    assert len({item.id for item in made}) == len(made)
    assert write_moodle(made) == write_moodle(items_from_blueprint(bank, plan, 5, 2, ["en"]))


@pytest.mark.slow
def test_the_whole_bank(everything):
    found = read(everything)
    test_percentages_are_of_the_list_and_each_question_can_be_right(found)
    test_numbers_have_a_point_and_a_tolerance(found)
    test_fields_of_a_text_are_what_is_asked(everything, found)
    test_weights_are_the_marks_of_the_parts(everything, found)
    test_nothing_is_left_of_our_own_pages(found)


NUMBERS = (
    "power-for-equal-brightness", "gaussian-density-values", "gaussian-peak-and-tail-shares",
    "blur-disc-diameter", "thin-lens-image-distance", "image-height-and-fill-distance",
    "point-to-image-plane", "diameter-stops-and-exposure-time", "flat-field-correction-output",
    "opencv-add-and-subtract", "opencv-hue-shift", "opencv-stored-hue",
    "salt-and-pepper-thresholds", "uint8-difference", "uint8-hue-shift",
)  # fmt: skip
"""Fifteen questions of numbers, seven of them with a figure, as the paper has that R/exams was
measured with: 38 MB for a hundred variants."""


def test_a_paper_is_as_small_as_it_may_be(bank):
    """Less than a comparable paper has from R/exams, though its labels need no font."""
    made = list(items_from_templates(bank, NUMBERS, 0, 3, ["en"]))
    assert sum(item.question.figure is not None for item in made) == 7 * 3
    assert len(write_moodle(made)) / 3 <= 0.9 * 380_000
