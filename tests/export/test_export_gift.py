"""GIFT read by its documents: comments, category, name, text and an answer between braces."""

from __future__ import annotations

import re

import pytest

from quizgen.export.gift import by_hand, write

SIGN = re.compile(r"\\(.)")


def plain(text: str) -> str:
    return SIGN.sub(lambda sign: "\n" if sign[1] == "n" else sign[1], text)


def bare(text: str) -> str:
    """The same length without escaped signs: what is left of them is grammar."""
    return SIGN.sub("..", text)


def read(items) -> dict[str, tuple[str, str, str]]:
    """Text, answer and general feedback of each question by its id, escaped."""
    found = {}
    for block in write(items).decode().strip().split("\n\n"):
        if block.startswith("$CATEGORY: "):
            assert re.fullmatch(r"\$CATEGORY: \$course\$/top/quizgen/(en|bn)/[\w/-]+", block)
            continue
        comment, rest = block.split("\n")
        name = re.match(r"// \[id:(\S+)\] \[tag:", comment)[1]
        grammar = bare(rest)
        _, title, _ = grammar.split("::")
        start, end = grammar.index("{"), grammar.index("}")
        assert end == len(grammar) - 1
        assert grammar.count("{") == grammar.count("}") == 1
        text = rest[len(title) + 4 : start]
        assert text.startswith("[html]")
        answer, _, told = rest[start + 1 : end].rpartition("####")
        assert name not in found
        found[name] = text.removeprefix("[html]"), answer, told
    return found


@pytest.fixture(scope="module")
def questions(items):
    return read(items)


def test_every_part_is_a_question_with_its_solution(items, questions):
    parts = [f"{i.id}.{p.label}" if p.label else i.id for i in items for p, _ in i.parts]
    assert sorted(parts) == sorted(questions)
    for text, _, told in questions.values():
        assert "<p>" in plain(text)
        assert "<strong>" in plain(told)


def test_what_a_person_marks_is_named_and_has_no_answer(items, questions):
    named = sum(1 for item in items for _ in by_hand(item))
    assert named == sum(not answer for _, answer, _ in questions.values()) > 5


def test_numbers_stand_with_point_and_tolerance(questions):
    seen = 0
    for _, answer, _ in questions.values():
        if not answer.startswith("#"):
            continue
        seen += 1
        rows = re.findall(r"=(%0%)?(-?[\d.e+-]+):([\d.e+-]+)(?:#|\s|$)", bare(answer))
        assert len(rows) == bare(answer).count("=")
        assert rows[0][0] == ""
    assert seen > 10


def test_a_number_says_how_it_is_to_be_typed(questions):
    text, answer, _ = questions["luminous-flux-over-bands.1.en"]
    assert "Type the number alone" in plain(text)
    assert answer.startswith("#=")


def test_a_choice_has_its_letters_and_one_right_option(reference):
    ((text, answer, _),) = read([reference("imread-missing-file")]).values()
    assert (bare(answer).count("="), bare(answer).count("~")) == (1, 5)
    assert re.findall(r"[~=]([A-F])\.", answer) == list("ABCDEF")
    assert "<pre><code>import cv2\n" in plain(text)


def test_an_own_bank_may_hold_signs_of_the_grammar(awkward):
    test_every_part_is_a_question_with_its_solution(awkward, read(awkward))
