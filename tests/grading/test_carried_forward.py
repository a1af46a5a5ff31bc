"""Marks for the method where an answer follows from an own wrong earlier one, by any right way."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import quizgen
from quizgen.grading.verdict import Verdict

TABLE = Path(__file__).with_name("carried_forward.toml")
NOT_CARRIED = {("rgb-to-cmyk", "b", "C = 0.5; M = 0; Y = 0.125; K = 0.2")}
"""An own value that makes a later one 0 may have made the question trivial."""


ANSWERED = Path(__file__).parent / "answered_bank"
"""Questions that have changed since the answers were written."""


def follow(
    template: str, own: dict[str, str], later: dict[str, str], bank: quizgen.Bank | None = None
) -> Iterator[Verdict]:
    """Grade the answers to later parts in order, each in the light of all before it."""
    question, earlier = (bank or quizgen.builtin_bank()).template(template), dict(own)
    for part, typed in later.items():
        yield quizgen.mark_part(question, typed, part=part, earlier=earlier)
        earlier[part] = typed


@pytest.mark.parametrize(
    ("template", "own", "later"),
    [
        # z' = m z, and not only z' = f (1 + m)
        ("magnification-and-object-distance", {"a": "0.2"}, {"b": "135 mm"}),
        # N_b from the own N_a; this was said to be another mistake
        ("normalise-from-offset-range", {"a": "0.6"}, {"b": "147.4"}),
        # the clamp leaves an own value inside the range as it is
        ("normalise-and-clamp", {"a": "0.4"}, {"b": "0.4"}),
        # 8 times the light is 3 stops and an eighth of the time
        ("diameter-stops-and-exposure-time", {"b": "8"}, {"c": "3", "d": "1/64 s"}),
        # 2 m behind for 1 m before is a ratio of 2, and no rule of thumb
        ("depth-of-field-split", {"b": "d_n = 1 m; d_f = 2 m"}, {"c": "2"}),
        # read off wrongly, then used rightly
        ("undistort-by-iteration", {"b": "0.3"}, {"c": "(0.24; -0.18)"}),
    ],
)
def test_any_right_way_from_an_own_value_gets_its_marks(template, own, later):
    assert [(v.note, v.credit) for v in follow(template, own, later)] == [
        ("carried-forward", 1)
    ] * len(later)


def test_a_wrong_way_from_an_own_value_gets_none():
    """The own magnification is multiplied by the focal length in place of the distance."""
    (verdict,) = follow("magnification-and-object-distance", {"a": "0.2"}, {"b": "15 mm"})
    assert verdict.credit == 0


@pytest.mark.slow
def test_follow_ups_of_every_template_get_their_marks():
    refused, met = set(), 0
    answered = quizgen.Bank(ANSWERED, trusted=True)
    for question in tomllib.loads(TABLE.read_text("utf-8"))["question"]:
        bank = answered if question.get("bank") == "answered" else None
        for own, later in question["rows"]:
            graded = zip(later.items(), follow(question["template"], own, later, bank), strict=True)
            met += len(later)
            refused |= {(question["template"], *row) for row, found in graded if found.credit < 1}
    assert met == 190
    assert refused == NOT_CARRIED
