"""Every row of the marking tables, in both languages."""

from __future__ import annotations

from answer_tables import Row, rows
from sweep import together

from quizgen.kinds import KINDS
from quizgen.kinds.grade import grade_answer

ROWS = list(rows())


def test_there_are_at_least_six_hundred_rows_and_every_kind():
    assert len(ROWS) >= 600
    judged_by_programs = {"checked", "program"}
    assert {row.spec["kind"] for row in ROWS} == set(KINDS) - judged_by_programs


def of_kind(kind: str) -> list[Row]:
    return [row for row in ROWS if row.spec["kind"] == kind]


def wrong(row: Row) -> str:
    """What is wrong with a row's verdict; empty if nothing is."""
    verdict = grade_answer(row.spec, row.typed, decimal=row.decimal)
    credit = float(verdict.credit)
    fits = {"correct": credit == 1, "partial": 0 < credit <= 1}.get(row.verdict, credit == 0)
    asks = row.verdict in {"asked", "unreadable", "ambiguous"}
    given = "asked" if row.verdict == "asked" and not verdict.is_graded else verdict.verdict
    right = (
        given == row.verdict
        and row.note in {None, verdict.note}
        and row.credit in {None, credit}
        and fits
        and (verdict.message or not asks)
    )
    return "" if right else f"{row}: {verdict}"


@together("kind", KINDS)
def test_rows_of_a_kind(kind: str):
    assert list(filter(None, map(wrong, of_kind(kind)))) == []


def differs(row: Row) -> bool:
    """Whether Bangla changes more than the words, or leaves them as they are."""
    english = grade_answer(row.spec, row.typed, decimal=row.decimal)
    bangla = grade_answer(row.spec, row.typed, decimal=row.decimal, lang="bn")
    told = [(one.verdict, one.note, one.read_as, bool(one.message)) for one in (english, bangla)]
    return told[0] != told[1] or bool(english.message and english.message == bangla.message)


@together("kind", KINDS)
def test_bangla_gives_the_same_verdicts_in_other_words(kind: str):
    assert list(map(str, filter(differs, of_kind(kind)))) == []
