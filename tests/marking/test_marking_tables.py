"""Every row of the marking tables, in both languages."""

from __future__ import annotations

import pytest
from answer_tables import PAGE, Row, page, rows

from quizgen.marking.kinds import KINDS
from quizgen.marking.mark import mark

ROWS = list(rows())


def test_there_are_at_least_six_hundred_rows_and_every_kind():
    assert len(ROWS) >= 600
    assert {row.spec["kind"] for row in ROWS} == set(KINDS)


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_row(row: Row):
    verdict = mark(row.spec, row.typed, decimal=row.decimal)
    assert verdict.verdict == row.verdict, verdict
    if row.note is not None:
        assert verdict.note == row.note
    if row.credit is not None:
        assert float(verdict.credit) == row.credit
    if row.verdict == "correct":
        assert verdict.credit == 1
    elif row.verdict != "partial":
        assert verdict.credit == 0
    else:
        assert 0 < verdict.credit <= 1
    if row.verdict in {"unreadable", "ambiguous"}:
        assert verdict.message


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_bangla_gives_the_same_verdict_in_other_words(row: Row):
    english = mark(row.spec, row.typed, decimal=row.decimal)
    bangla = mark(row.spec, row.typed, decimal=row.decimal, lang="bn")
    assert (english.verdict, english.note, english.read_as) == (
        bangla.verdict,
        bangla.note,
        bangla.read_as,
    )
    assert bool(english.message) == bool(bangla.message)
    if english.message:
        assert english.message != bangla.message


def test_documentation_prints_these_tables():
    assert page() == PAGE.read_text("utf-8"), "run python tests/marking/answer_tables.py"
