"""The key of one question, member by member, and the bytes it is written as."""

from __future__ import annotations

import json
from fractions import Fraction

import msgspec
import pytest
from flint import fmpq
from small_bank import NAME, ONE

from quizgen.core.errors import KeyFileError
from quizgen.paper.answer_key import (
    AnswerKey,
    make_answer_key,
    parse_answer_key,
    read_answer_key,
    write_answer_key,
)
from quizgen.paper.paper import build_paper


@pytest.fixture(scope="module")
def paper(bank):
    plan = msgspec.structs.replace(ONE, title={"en": "One", "bn": "এক"})
    return build_paper(bank, plan, 7, "both", figures=False)


def test_the_head_of_a_key(paper):
    key = make_answer_key(paper)
    assert (key.format, key.code, key.langs) == ("quizgen-key/2", paper.code, ("en", "bn"))
    assert key.title == {"en": "One", "bn": "এক"}


def test_the_key_of_one_question(paper):
    """Seed 7 draws f = 3 and the point (-12, -8, 6): its image is at (-6, -4)."""
    question = make_answer_key(paper).questions[0]
    assert (question.number, question.points, question.template) == ("1", "3", NAME)
    assert (question.topic, question.tier) == ("projection", "A")
    assert question.identity == f"{NAME}(f=3, p_x=-12, p_y=-8, p_z=6)"
    assert question.title == {
        "en": "Perspective projection of a point",
        "bn": "একটা বিন্দুর perspective projection",
    }
    (part,) = question.parts
    assert (part.id, part.points, part.points_exact()) == ("1", "3", Fraction(3))
    assert (part.spec["kind"], part.spec["values"]) == ("point", ["-6", "-4"])
    assert question.chain.steps == [("p'_x", "f*p_x/p_z", ""), ("p'_y", "f*p_y/p_z", "")]
    assert {name: given.value for name, given in question.chain.given.items()} == {
        "f": "3", "p_x": "-12", "p_y": "-8", "p_z": "6"}  # fmt: skip


def test_the_chain_of_a_key_computes_with_its_units():
    key = parse_answer_key(TABLE)
    context = key.questions[0].chain.context({"h": fmpq(7, 2000)})
    assert context.given == {"f": fmpq(1, 20), "X": fmpq(30), "Z": fmpq(600)}
    assert context.solved_values["h"] == fmpq(1, 400)
    assert context.earlier == {"h": fmpq(7, 2000)}
    assert context.chain.given == {"f": "mm", "X": "m", "Z": ""}
    assert key.questions[0].chain.units() == {"f": "mm", "X": "m", "Z": "", "h": "mm"}


def test_the_file_is_readable_json_in_the_order_of_the_paper(paper):
    data = write_answer_key(paper)
    table = json.loads(data)
    assert data.decode().startswith('{\n "format": "quizgen-key/2",\n "questions": [')
    assert data.endswith(b"}\n")
    assert "একটা বিন্দুর".encode() in data
    assert list(table["questions"][0])[:2] == ["number", "parts"]


def test_a_key_is_read_as_it_was_written(paper, tmp_path):
    path = tmp_path / "key.json"
    path.write_bytes(write_answer_key(paper))
    assert read_answer_key(path) == make_answer_key(paper)


CHAIN = {
    "given": {"f": {"value": "1/20", "unit": "mm"}, "X": {"value": "30", "unit": "m"},
              "Z": {"value": "600"}},
    "steps": [["h", "f*X/Z", "mm"]],
}  # fmt: skip
TABLE = {
    "format": "quizgen-key/2",
    "questions": [
        {
            "number": "1",
            "chain": CHAIN,
            "parts": [{"id": "1", "points": "3", "spec": {"kind": "number", "value": "1"}}],
        }
    ],
}


def test_what_a_key_need_not_say():
    assert parse_answer_key(TABLE) == AnswerKey("quizgen-key/2", parse_answer_key(TABLE).questions)
    assert (parse_answer_key(TABLE).code, parse_answer_key(TABLE).langs) == ("", ("en",))


@pytest.mark.parametrize(
    ("points", "said"),
    [("three", r"mine: part '1': points: 'three' is no number"),
     ("1/0", r"mine: part '1': points: '1/0' divides by zero"),
     (3, r"mine: .*\$\.questions\[0\]\.parts\[0\]\.points")],
)  # fmt: skip
def test_points_that_are_no_number_are_located(points, said):
    part = {"id": "1", "points": points, "spec": {}}
    table = {**TABLE, "questions": [{"number": "1", "parts": [part]}]}
    with pytest.raises(KeyFileError, match=said):
        parse_answer_key(table, "mine")


def test_a_unit_that_nobody_knows_is_located():
    chain = {**CHAIN, "steps": [["h", "f*X/Z", "florp"]]}
    table = {**TABLE, "questions": [{**TABLE["questions"][0], "chain": chain}]}
    with pytest.raises(KeyFileError, match=r"^mine: question '1': chain: .*florp"):
        parse_answer_key(table, "mine")


@pytest.mark.parametrize("found", [None, "quizgen-key/3"])
def test_another_format_is_named(found):
    with pytest.raises(KeyFileError, match=rf"^key: format is {found!r}, not 'quizgen-key/2'$"):
        parse_answer_key({**TABLE, "format": found})


def test_a_wrong_file_is_named(tmp_path):
    path = tmp_path / "mine.json"
    path.write_text('{"format": "x"}')
    with pytest.raises(KeyFileError, match=r"mine\.json: format is 'x'"):
        read_answer_key(path)


def test_a_key_that_lost_its_order_is_refused():
    with pytest.raises(KeyFileError, match=r"^mine: from an earlier version, .* order"):
        parse_answer_key({**TABLE, "format": "quizgen-key/1"}, "mine")
