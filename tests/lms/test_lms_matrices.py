"""A matrix is a field for each of its entries, and what stands in them is read as its rows."""

from __future__ import annotations

from pathlib import Path

import pytest

from quizgen.bank.bank import Bank
from quizgen.lms.attempts import QuizAttempt, Response
from quizgen.lms.grading import grade_attempts
from quizgen.lms.interactions import NumericInteraction
from quizgen.lms.items import CourseQuestion, items_from_templates
from quizgen.lms.manifest import ExportManifest
from quizgen.lms.manifest_writer import manifest_entry, manifest_question
from quizgen.lms.qti.dialect import QTI3
from quizgen.lms.qti.item import write_item

STRANGERS = Path(__file__).parents[2] / "examples" / "strangers"


@pytest.fixture(scope="module")
def item():
    (found,) = items_from_templates(Bank(STRANGERS, trusted=True), ["matrix-product"], 1, 1, ["en"])
    return found


def keys(item):
    (_, fields), _ = item.parts
    return [one.key.value for one in fields if isinstance(one, NumericInteraction)]


def test_each_entry_has_a_field_with_its_key_and_mistakes(item):
    entries = item.key.specs[0].entries
    assert keys(item) == [float(text) for row in entries for text in row]
    page = write_item(item, QTI3).decode()
    assert page.count("<qti-text-entry-interaction") == 5  # four entries, the determinant
    assert "qti-extended-text-interaction" not in page


def test_rows_are_put_together_again(item):
    question = manifest_question(CourseQuestion(item, "", item.parts), embedded=True)
    manifest = ExportManifest([manifest_entry(item, [question])])
    for change, marks in ((0, 1), (1, 0.75)):
        a, b, c, d = keys(item)
        given = "; ".join(f"part {n}: {v}" for n, v in enumerate((a, b, c, d + change, ""), 1))
        attempt = QuizAttempt("", "", "", "", (Response("1", question.mark, given),))
        (found,) = grade_attempts(manifest, [attempt])
        first = found.result.parts[0]
        assert first.verdict.credit == marks, first.typed
