"""Which templates a paper holds, and how many papers there are: counted by hand."""

from __future__ import annotations

import hashlib
from itertools import combinations

import pytest
from shelf import Shelf
from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.core.errors import BlueprintError
from quizgen.paper.blueprint import Blueprint, SlotRule, load_blueprint
from quizgen.paper.selection import count_papers, select_templates, slot_points


def timed(topic, minutes=0):
    return Blueprint({"en": "x"}, (), topic=topic, budget=minutes)


def plan(*slots):
    return Blueprint({"en": "x"}, slots, name="x")


def test_the_place_and_the_seed_rank_the_templates():
    shelf = Shelf({name: {} for name in "abcdef"})
    for seed in range(5):
        found = select_templates(shelf, plan(SlotRule(count=1)), seed)
        ranks = {n: hashlib.sha256(f"choose/{seed}/1/0/{n}".encode()).digest() for n in "abcdef"}
        assert found == [min(ranks, key=ranks.get)]


def test_every_template_is_used_before_one_returns():
    shelf = Shelf({name: {} for name in "abc"})
    found = select_templates(shelf, plan(SlotRule(count=7)), 3)
    assert sorted(found[:3]) == sorted(found[3:6]) == list("abc")


def test_a_template_never_stands_beside_one_that_gives_it_away():
    shelf = Shelf({"a": {"apart": ("b",)}, "b": {}, "c": {}})
    for seed in range(20):
        assert set(select_templates(shelf, plan(SlotRule(count=2)), seed)) != {"a", "b"}
        assert (
            len(set(select_templates(shelf, plan(SlotRule(templates=("a", "b"), count=2)), seed)))
            == 1
        )


def test_a_slot_keeps_to_tier_topic_and_list():
    shelf = Shelf({"a": {"tier": "B"}, "b": {"topic": "noise"}, "c": {}, "d": {}})
    assert select_templates(shelf, plan(SlotRule(tier="B")), 0) == ["a"]
    assert select_templates(shelf, plan(SlotRule(topic="noise")), 0) == ["b"]
    assert select_templates(shelf, plan(SlotRule(templates=("d",))), 0) == ["d"]
    with pytest.raises(BlueprintError, match="slot 2: no template has tier C and topic any"):
        select_templates(shelf, plan(SlotRule(), SlotRule(tier="C")), 0)


def test_a_time_is_filled_and_never_exceeded():
    shelf = Shelf({f"{t}{n}": {"tier": t, "minutes": 7} for t in "AB" for n in range(4)})
    found = select_templates(shelf, timed("optics", 31), 1)
    assert [name[0] for name in found] == ["A", "A", "B", "B"]
    assert len(set(found)) == 4
    assert len(select_templates(shelf, timed("optics", 30), 1)) == 3, "four take 28 min and a tenth"
    assert len(select_templates(shelf, timed("all"), 1)) == 8
    with pytest.raises(BlueprintError, match="fits the time"):
        select_templates(shelf, timed("optics", 6), 1)


@together(
    ("pools", "count"), [((3,), 1), ((3,), 2), ((3, 4), 1), ((3, 4), 2), ((2, 3, 4), 2),
                         ((2, 3), 3), ((3, 3), 5), ((1, 1, 5), 3)],
)  # fmt: skip
def test_papers_are_counted_as_sets_of_questions(pools, count):
    """Every set of distinct questions in which the templates are used as evenly as can be."""
    questions = [(name, n) for name, pool in enumerate(pools) for n in range(pool)]
    least, most = count // len(pools), -(-count // len(pools))
    even = [
        chosen for chosen in combinations(questions, count)
        if all(least <= sum(n == name for n, _ in chosen) <= most for name in range(len(pools)))
    ]  # fmt: skip
    shelf = Shelf({f"t{n}": {"pool": pool} for n, pool in enumerate(pools)})
    assert count_papers(shelf, plan(SlotRule(count=count))) == len(even)


def test_slots_multiply_and_a_template_without_numbers_is_one_question():
    shelf = Shelf(
        {"a": {"pool": 6, "tier": "A"}, "b": {"tier": "B"}, "c": {"pool": 5, "tier": "C"}}
    )
    slots = [SlotRule(tier=tier) for tier in "ABC"]
    assert count_papers(shelf, plan(*slots)) == 30
    assert count_papers(shelf, plan(slots[1])) == 1
    assert count_papers(shelf, timed("optics")) == 0


def test_the_marks_of_slots_go_to_their_questions():
    found = slot_points(plan(SlotRule(count=2, points=4), SlotRule(), SlotRule(points=1.5)))
    assert [next(found) for _ in range(5)] == [4, 4, None, 1.5, None]


@pytest.mark.parametrize(
    ("slot", "said"),
    [
        ('templates = ["nothing-of-it"]', "unknown template 'nothing-of-it'"),
        ('topic = "optics"\ntier = "A"\ntemplates = ["rgb-to-hsv"]', "no template has tier A"),
    ],
)
def test_a_slot_that_cannot_be_filled_is_located(tmp_path, slot, said):
    file = tmp_path / "week.toml"
    file.write_text(f'[title]\nen = "x"\n[[slot]]\ntier = "B"\n[[slot]]\n{slot}\n')
    with pytest.raises(BlueprintError) as caught:
        select_templates(builtin_bank(), load_blueprint(str(file)), 1)
    assert str(caught.value).startswith(f"{file}: slot 2: {said}")


@pytest.mark.parametrize(
    ("table", "slots"),
    [({"image": {"pool": 9}, "limits": {"pool": 1}, "source": {"pool": 9}},
      (SlotRule(count=2), SlotRule(templates=("image", "limits")))),
     ({"disc": {"pool": 9, "apart": ("limits",)}, "limits": {"pool": 1}}, (SlotRule(count=2),))],
    ids=["used before", "the other gives it away"],
)  # fmt: skip
def test_a_question_without_numbers_stands_in_a_paper_once(table, slots):
    for seed in range(60):
        assert select_templates(Shelf(table), plan(*slots), seed).count("limits") <= 1
