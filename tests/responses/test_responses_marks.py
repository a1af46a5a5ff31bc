"""What was responded is marked as what is typed into a form."""

from __future__ import annotations

import msgspec
import pytest

from quizgen.responses.attempts import Attempt, Response
from quizgen.responses.keys import Asked, Entry, Kept, Keys, Shape
from quizgen.responses.marks import marked

NOWHERE = {"kind": "expression", "value": "sqrt(-1-x)", "symbols": {"x": "positive"}}
"""A key without a value anywhere on its domain, which cannot be sampled."""
QUESTION = {"number": "1", "template": "t", "parts": [{"id": "1", "points": "2", "spec": NOWHERE}]}


@pytest.mark.parametrize(("settle", "marks", "note"), [(False, 0, "undecided"), (True, 2, "")])
def test_an_undecided_formula_is_settled_if_that_is_allowed(monkeypatch, settle, marks, note):
    monkeypatch.setattr("quizgen.kinds.expression.settle_equal", lambda *_: True)
    question = msgspec.Raw(msgspec.json.encode(QUESTION))
    entries = [Entry("abcd-2345", "q", [Asked("written", "1")])]
    keys = Keys([Kept("q", "s", "en", question, {"1": Shape("line")}, entries)])
    attempt = Attempt("", "", "", "", (Response("1", "abcd-2345", "sqrt(-x-1) + 0"),))
    (found,) = marked(keys, [attempt], settle=settle)
    (part,) = found.result.parts
    assert (part.marks, part.verdict.note) == (marks, note)
