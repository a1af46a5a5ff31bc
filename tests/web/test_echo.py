"""How what is typed is shown again."""

from __future__ import annotations

import re

import pytest
from sweep import together

from quizgen.web.live_preview import _typeset_values


def plain(page: str) -> str:
    """What a page shows, a fraction as [a|b]."""
    page = re.sub("<mfrac><mn>([^<]*)</mn><mn>([^<]*)</mn></mfrac>", r"[\1|\2]", page)
    return re.sub("<[^>]*>", "", page)


@together(
    ("read", "shown"),
    [
        ("20/3 mm", "[20|3] ≈ 6.667 mm"),
        ("−20/3", "−[20|3] ≈ −6.667"),
        ("2/5", "[2|5] = 0.4"),
        ("6.667 mm", "6.667 mm"),
        ("3 um", "3 µm"),
        ("30 deg", "30°"),
        ("(2/3; 0.5)", "([2|3] ≈ 0.6667; 0.5)"),
        ("(12; 13) px", "(12; 13) px"),
        ("{1; 2}", "{1; 2}"),
        ("V = 1/2; S = 3", "V = [1|2] = 0.5; S = 3"),
        ("1/0", "[1|0]"),
        ("9" * 5000 + "/7", None),
        ("<b>; 2", "&lt;b&gt;; 2"),
    ],
)
def test_values_are_typeset_with_their_units(read, shown):
    page = str(_typeset_values(read, "en"))
    if shown is not None:
        assert plain(page) == shown


@pytest.mark.parametrize(
    ("read", "shown"),
    [
        ("(2/3; 0.5)", "[2|3] ≈ 0.6667; 0.5"),
        ("(12; 13) px", "12 px; 13 px"),
        ("(1; 2; 3) um", "1 µm; 2 µm; 3 µm"),
        ("V = 1/2; S = 3", "V = [1|2] = 0.5; S = 3"),
    ],
)
def test_values_of_boxes_are_read_back_one_by_one(read, shown):
    assert plain(str(_typeset_values(read, "en", boxes=True))) == shown


def test_an_empty_box_does_not_change_how_the_others_are_read():
    for filled, shown in (((True, False), "1.5 px"), ((False, True), "0 px")):
        read = _typeset_values("(1.5; 0) px", "en", boxes=True, filled=filled)
        assert plain(str(read)) == shown


@pytest.mark.parametrize(
    ("read", "shown"),
    [
        ("20/3 mm", "[20|3] ≈ 6,667 mm"),
        ("6.667 mm", "6,667 mm"),
        ("(2/5; 0.5)", "([2|5] = 0,4; 0,5)"),
        ("0.5*x", "0,5⁢x"),
    ],
)
def test_a_german_page_reads_back_with_a_comma(read, shown):
    assert plain(str(_typeset_values(read, "de"))) == shown
