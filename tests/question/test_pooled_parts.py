"""Parts that take some of a pool: what is asked, what is said to a wrong answer, what is printed."""

from __future__ import annotations

import pytest

from quizgen.bank.bank import Bank
from quizgen.kinds.grade import grade_answer
from quizgen.question.compose import compose_question
from quizgen.question.interpolation import inlines_to_text

RULES = """
topic = "light"
tier = "A"
[draw]
opening = { pick = [0, 1] }
at_1 = { words = ["noisy", "clean"], by = "opening" }
at_2 = { words = ["clean", "noisy"], by = "opening" }
[claims]
wider = { true = "opening = 1", source = "Newton 1704" }
[[part]]
answer = { kind = "tf", from = "claims" }
[[part]]
answer = { kind = "gap", take = 1, gaps = ["day", "night"], among = ["600"] }
[[part]]
answer = { kind = "match", in_order = true, pairs = { one = "at_1", two = "at_2" } }
[[part]]
answer = { kind = "choice", in_order = true, options = { first = "opening = 0", second = "opening = 1" } }
"""
PROSE = """# Eyes
A stem.
## a
True? **{{ claim }}** Say so.
## b
Fill in.
## c
Match.
## d
Which?
## claims
- wider: The hole got wider.
## gaps
- day: 555 | five five five
- night: 507
## options
- day: By day the peak lies at ____ nm.
- night: By night the peak lies at ____ nm.
- one: picture 1
- two: picture 2
- noisy: noise
- clean: no noise
- first: picture 1
- second: picture 2
## reasons
- wider [opening = 1]: It was opened.
- wider: It was {{ turn }}, whatever else.
- day: Day is green.
- day = night: You took the night.
- day = 600: That is red.
- night: Night is blue-green.
- night = day: You took the day.
## why
In general.
- c: Look at {{ at_1 }}.
- d [opening = 1]: Second, for opening.
- d: First, for closing.
## check
It was {{ turn }}.
## words
- turn [opening = 0]: closed
- turn [opening = 1]: opened
- noisy: grains
- clean: flatness
"""


@pytest.fixture
def asked(tmp_path):
    folder = tmp_path / "templates" / "light" / "eyes"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(RULES, "utf-8")
    (folder / "en.md").write_text(PROSE, "utf-8")
    template = Bank(tmp_path).template("eyes")
    return [compose_question(template, seed, "en", figures=False) for seed in range(20)]


def opening(key):
    return int(key.draw.shown["opening"].p)


def words_of(blocks):
    return [inlines_to_text(block.children) for block in blocks]


def test_the_claim_stands_where_its_blank_is(asked):
    assert words_of(asked[0][0].parts[0].body) == ["True? The hole got wider. Say so."]


def test_the_reason_of_a_claim_fits_the_draw_and_names_its_source(asked):
    said = {0: "It was closed, whatever else. [Newton 1704]", 1: "It was opened. [Newton 1704]"}
    for _, key in asked:
        right = ("false", "true")[opening(key)]
        other = ("true", "false")[opening(key)]
        assert grade_answer(key.specs[0], other).message == said[opening(key)]
        assert grade_answer(key.specs[0], right).message == ""
        assert inlines_to_text(key.solution.parts[0].options[0]) == said[opening(key)]
    assert {opening(key) for _, key in asked} == {0, 1}


def test_a_gap_of_a_pool_brings_its_sentence(asked):
    seen = set()
    for question, key in asked:
        body = question.parts[1].body
        (sentence,) = (inlines_to_text(item[0].children) for item in body[1].items)
        seen.add(sentence)
        assert key.specs[1].accept == [["555", "five five five"] if "day" in sentence else ["507"]]
    assert seen == {"By day the peak lies at ____ nm.", "By night the peak lies at ____ nm."}


def test_a_wrong_word_gets_its_own_reason_else_that_of_the_gap(asked):
    keys = {key.specs[1].accept[0][0]: key for _, key in asked}
    day, night = (keys[word].specs[1] for word in ("555", "507"))
    assert grade_answer(day, "507").message.endswith("You took the night.")
    assert grade_answer(day, "600").message.endswith("That is red.")
    assert grade_answer(day, "blue").message.endswith("Day is green.")
    assert grade_answer(night, "five five five").message.endswith("You took the day.")
    assert grade_answer(night, "600").message.endswith("Night is blue-green.")
    solved = keys["555"].solution.parts[1]
    assert [inlines_to_text(text) for text in solved.options] == ["Day is green."]
    told = [(wrong.value, inlines_to_text(wrong.sentence)) for wrong in solved.reasons]
    assert told == [("(1) 507", "You took the night."), ("(1) 600", "That is red.")]


def test_a_matching_may_follow_from_the_draw_and_keep_its_order(asked):
    for question, key in asked:
        field = question.parts[2].field
        assert [(mark, inlines_to_text(text)) for mark, text in field.options] == [
            ("A", "picture 1"), ("B", "picture 2")
        ]  # fmt: skip
        targets = {inlines_to_text(text): mark for mark, text in field.targets}
        noisy, clean = targets["noise"], targets["no noise"]
        right = {"A": noisy, "B": clean} if opening(key) == 0 else {"A": clean, "B": noisy}
        assert key.specs[2].pairs == right


def test_options_in_order_are_never_shuffled(asked):
    for question, key in asked:
        shown = [inlines_to_text(text) for _, text in question.parts[3].field.options]
        assert shown == ["picture 1", "picture 2"]
        assert key.specs[3].correct == [1 + opening(key)]


def test_an_explanation_by_label_stands_under_its_part(asked):
    for _, key in asked:
        whys = [inlines_to_text(part.why) for part in key.solution.parts]
        last = ("First, for closing.", "Second, for opening.")[opening(key)]
        first = ("Look at grains.", "Look at flatness.")[opening(key)]
        assert whys == ["", "", first, last]
        assert words_of(key.solution.why) == ["In general."]


def test_a_phrase_by_condition_may_stand_in_the_check(asked):
    for _, key in asked:
        turn = ("closed", "opened")[opening(key)]
        assert words_of(key.solution.check) == [f"It was {turn}."]
