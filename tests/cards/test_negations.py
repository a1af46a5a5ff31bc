"""Conditions that are negated as a whole stand on cards, too."""

from __future__ import annotations

from quizgen import typeset
from quizgen.cards.markup import equations_to_mathjax
from quizgen.maths.notation import parse_formula


def test_a_negated_condition_is_one_formula():
    node = typeset.lay_out(parse_formula("not (a < b and b < c)"))
    shown = equations_to_mathjax(node)
    assert shown.count(r"\(") == shown.count(r"\)") == 1
    assert "not" in shown
