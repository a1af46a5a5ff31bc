"""What was responded is marked as what is typed into a form."""

from __future__ import annotations

import msgspec
import pytest

from quizgen.lms.attempts import QuizAttempt, Response
from quizgen.lms.grading import grade_attempts
from quizgen.lms.manifest import (
    ExportManifest,
    ManifestItem,
    ManifestQuestion,
    ResponseField,
    ResponseShape,
)

NOWHERE = {"kind": "expression", "value": "sqrt(-1-x)", "symbols": {"x": "positive"}}
"""A key without a value anywhere on its domain, which cannot be sampled."""
QUESTION = {"number": "1", "template": "t", "parts": [{"id": "1", "points": "2", "spec": NOWHERE}]}


@pytest.mark.parametrize(("settle", "marks", "note"), [(False, 0, "undecided"), (True, 2, "")])
def test_an_undecided_formula_is_settled_if_that_is_allowed(monkeypatch, settle, marks, note):
    monkeypatch.setattr("quizgen.kinds.expression.decide_by_sympy", lambda *_: True)
    question = msgspec.Raw(msgspec.json.encode(QUESTION))
    entries = [ManifestQuestion("abcd-2345", "q", [ResponseField("written", "1")])]
    keys = ExportManifest(
        [ManifestItem("q", "s", "en", question, {"1": ResponseShape("line")}, entries)]
    )
    attempt = QuizAttempt("", "", "", "", (Response("1", "abcd-2345", "sqrt(-x-1) + 0"),))
    (found,) = grade_attempts(keys, [attempt], settle=settle)
    (part,) = found.result.parts
    assert (part.marks, part.verdict.note) == (marks, note)
