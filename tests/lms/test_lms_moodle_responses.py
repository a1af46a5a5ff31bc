"""A quiz as Moodle played it: the files are its own report "Responses", made by Moodle 5.0dev.

Ada and, at the second try, Cem gave what Moodle itself calls the right response. What Ben gave, and
what it is worth, was worked out by hand.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from quizgen.core.errors import KeyFileError
from quizgen.lms.attempt_report import question_statistics
from quizgen.lms.grading import grade_attempts
from quizgen.lms.manifest import read_manifest
from quizgen.lms.response_files import read_attempts

HERE = Path(__file__).parent / "moodle"
BEN = {
    "1": ("1", "pairs"),
    "2": ("3.75", "trap:root-early"),
    "3": ("0", "trap:width-first"),
    "4a": ("0", "options-extra"),
    "4b": ("0", "wrong"),
    "4c": ("1", "correct"),
    "5a": ("0", "trap:backwards"),
    "5b": ("0", "blank"),
    "6": ("3", "correct"),  # 2,0 and 1,0 with decimal commas, which Moodle read as 20 and 10
    "7": ("0", "wrong"),
    "8b": ("0", "wrong"),
    "9a": ("4", "correct"),  # an essay for Moodle
    "10": ("0", "trap:modulo-255"),  # in Bangla digits
    "11a": ("1.5", "pairs"),
    "11b": ("0", "wrong"),
}


@pytest.fixture(scope="module")
def keys():
    return read_manifest(HERE / "quiz.keys.jsonl")


@pytest.fixture(scope="module", params=["responses.csv", "responses.json"])
def found(request, keys):
    return responses(keys, HERE / request.param)


def responses(keys, path) -> list:
    lost = []
    found = list(grade_attempts(keys, read_attempts([path], keys.found, lost.append), "en"))
    if lost:
        raise KeyFileError(*lost)
    return found


def word(part) -> str:
    return "blank" if part.is_blank else part.verdict.note or part.verdict.verdict


def test_who_it_was(found):
    people = [(one.attempt.name, one.attempt.id, one.attempt.email, one.number) for one in found]
    assert people == [
        ("Dana Sen", "78", "dana@example.org", 1),
        ("Ada Lovelace", "1815", "ada@example.org", 1),
        ("Ben =1+1", "0042", "ben@example.org", 1),
        ("Cem Öz", "77", "cem@example.org", 1),
        ("Cem Öz", "77", "cem@example.org", 2),
    ]
    assert found[0].attempt.responses == ()


def test_what_moodle_calls_right_is_right(found):
    for one in (found[1], found[4]):
        wrong = [part.id for part in one.result.parts if part.marks != part.points]
        assert wrong == ["9a"], "the essay was left out"
        assert (one.result.marks, one.result.points) == (27, 31)


def test_wrong_answers_are_marked_and_named(found):
    got = {part.id: (f"{float(part.marks):g}", word(part)) for part in found[2].result.parts}
    assert got == BEN


def test_what_cannot_be_told_apart_is_asked_back(found):
    """Two steps at one place, and a number that reads like another field."""
    parts = {part.id: part for part in found[3].result.parts}
    assert found[3].result.asked_back == 2
    assert parts["5a"].verdict.message == "Two steps were given the same place: “1, 1, 2, 3”"
    assert parts["10"].status == "ambiguous"
    assert {parts[name].status for name in ("1", "4b", "6", "11b")} == {"blank"}


def test_questions_over_all_attempts(found):
    rows = {one.number: one for one in question_statistics(found[1:])}
    assert [*rows] == [str(number) for number in range(1, 12)]
    assert (rows["6"].count, rows["6"].share) == (4, 0.75)
    assert rows["5"].notes == [("trap:backwards", 1), ("place-twice", 1)]
    # Marks 1, 0, 0, 1 of question 7; of the others 26, 14.25, 0, 26: 18.875 / sqrt(457.797).
    assert rows["7"].correlation == pytest.approx(0.8822, abs=1e-4)


def table() -> str:
    return (HERE / "responses.csv").read_text(encoding="utf-8-sig")


def of(text, keys, tmp_path, encoding="utf-8-sig"):
    path = tmp_path / "r.csv"
    path.write_text(text, encoding=encoding)
    return responses(keys, path)


def marks(found):
    return [(one.attempt.name, one.result.marks) for one in found]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize(
    "words",
    [
        ("Frage", "Antwort", "Nachname", "Vorname"),
        ("প্রশ্ন", "উত্তর", "শেষ নাম", "প্রথম নাম"),
        ("Question", "Réponse", "Nom de famille", "Prénom"),
    ],
)
def test_columns_in_any_language(keys, tmp_path, found, encoding, words):
    head, _, rest = table().partition("\n")
    for english, word in zip(("Question", "Response", "Last name", "First name"), words,
                             strict=True):  # fmt: skip
        head = head.replace(english, word)
    rest = rest.replace('"part 1: ', '"Teil 1: ').replace("; part ", "; Teil ")
    assert marks(of(f"{head}\n{rest}", keys, tmp_path, encoding)) == marks(found)


def test_right_answers_are_never_taken_for_responses(keys, tmp_path):
    with pytest.raises(KeyFileError, match="tick 'response'"):
        of(re.sub(r"Response (\d)", r"Right answer \1", table(), count=11), keys, tmp_path)


def test_a_table_without_the_texts_says_what_to_tick(keys, tmp_path):
    with pytest.raises(KeyFileError, match="tick 'question text'"):
        of(re.sub(r"\[\w{4}-\w{4}\]", "", table()), keys, tmp_path)


def test_a_typed_mark_makes_no_question_of_a_response(keys, tmp_path, found):
    typed = table().replace('"(4, 72, 3) 4"', '"(4, 72, 3) 4 [s9af-km9k]"')
    assert [one.result.marks for one in of(typed, keys, tmp_path)] == [
        one.result.marks for one in found
    ]


def test_a_question_that_is_not_ours_is_named(keys, tmp_path):
    found = of(table().replace("[3b69-zzfs]", ""), keys, tmp_path)
    assert found[1].foreign == ("3",)
    assert found[1].result.points == 29


def test_options_that_are_not_there_are_not_wrong(keys, tmp_path):
    found = of(table().replace("part 2: A. away from the cross", "part 2: A. sideways"), keys,
               tmp_path)  # fmt: skip
    part = next(part for part in found[1].result.parts if part.id == "4b")
    assert (part.status, part.verdict.message) == (
        "unreadable",
        "None of the options says this: “A. sideways”",
    )


def test_a_key_of_another_version_is_no_key(tmp_path, keys):
    """A question whose text or key has changed has another mark."""
    lines = (HERE / "quiz.keys.jsonl").read_text(encoding="utf-8").splitlines()
    table = json.loads(lines[1])
    path = tmp_path / "x.keys.jsonl"
    path.write_text("\n".join([lines[0], json.dumps({**table, "question": {}})]), encoding="utf-8")
    with pytest.raises(KeyFileError, match=table["id"]):
        responses(read_manifest(path), HERE / "responses.csv")
