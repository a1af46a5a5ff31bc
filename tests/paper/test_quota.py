"""Papers with quotas: sums by hand, papers that differ, and what cannot hold, each in its place."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from itertools import combinations

import pytest
from msgspec.structs import replace
from shelf import Shelf
from sweep import draws, together

from quizgen.core.errors import BlueprintError
from quizgen.kinds import KINDS
from quizgen.paper import quota
from quizgen.paper.blueprint import Blueprint, SlotRule, load_blueprint
from quizgen.paper.paper import build_paper
from quizgen.paper.quota import ROUND
from quizgen.paper.selection import select_instead, select_templates
from quizgen.render.text import blocks_to_plain_text

WRITTEN = {"write", "derive", "sketch", "program"}


def plan(*slots, **demands):
    return Blueprint({"en": "x"}, tuple(SlotRule(templates=tuple(s)) for s in slots), **demands)


def worth(**points):
    """A candidate's row: verb to points."""
    verbs = tuple((verb, Fraction(str(one))) for verb, one in points.items())
    return {"points": sum(one for _, one in verbs), "parts": verbs}


SHELF = Shelf(
    w=worth(write=3), x=worth(write=1, tick=2), t=worth(tick=3), n=worth(compute=3),
    s=worth(sketch=3), u=worth(tick=3),
)  # fmt: skip


def test_points_of_parts_count_for_what_they_ask():
    """Of w, x, t at two places each: two points of writing at least, three of ticks at most."""
    asked = plan("wxt", "nu", quota={"verb": {"write": (1, 3), "tick": (0, 3)}})
    found = {tuple(select_templates(SHELF, asked, seed)) for seed in range(60)}
    assert found == {("w", "n"), ("w", "u"), ("x", "n")}


def test_verbs_that_stand_together_are_added():
    asked = plan("wt", "sn", quota={"verb": {"write + sketch": (3, 3)}})
    assert {tuple(select_templates(SHELF, asked, seed)) for seed in range(60)} == {
        ("w", "n"), ("t", "s"),
    }  # fmt: skip


def test_tiers_topics_and_sums_are_demands_like_any():
    shelf = Shelf(a={"tier": "B", "topic": "eye"}, b={}, c={"topic": "eye"}, d={"minutes": 9})
    asked = plan("ab", "cd", total=10, minutes=(11, 11), quota={"topic": {"eye": (5, 5)}})
    assert {tuple(select_templates(shelf, asked, seed)) for seed in range(60)} == {("b", "c")}
    tier = plan("ab", "cd", quota={"tier": {"A": (10, 10)}})
    assert {select_templates(shelf, tier, seed)[0] for seed in range(60)} == {"b"}


def test_neighbours_share_no_more_than_is_allowed_and_use_every_template():
    shelf = Shelf({f"{s}{n}": {} for s in "abcdef" for n in range(5)})
    asked = plan(*([f"{s}{n}" for n in range(5)] for s in "abcdef"), shared=2,
                 quota={"tier": {"A": (0, 99)}})  # fmt: skip
    papers = [set(select_templates(shelf, asked, seed)) for seed in range(20)]
    assert max(len(one & other) for one, other in combinations(papers, 2)) == 2
    used = Counter(name for paper in papers for name in paper)
    assert len(used) == 30
    assert max(used.values()) <= 4 * min(used.values())


def test_a_round_is_kept_and_only_what_follows_is_chosen(empty_cache, monkeypatch):
    """A paper late in its round is found again without those before it; of other demands, not."""
    shelf = Shelf({f"{s}{n}": {} for s in "abcd" for n in range(4)})
    asked = plan(*([f"{s}{n}" for n in range(4)] for s in "abcd"), shared=2,
                 quota={"tier": {"A": (0, 99)}})  # fmt: skip
    papers = [select_templates(shelf, asked, seed) for seed in range(40, 0, -1)][::-1]
    assert len(list((empty_cache / "rounds").iterdir())) == 1
    quota._open_round.cache_clear()
    monkeypatch.setattr(quota._Round, "_make_paper", lambda _: pytest.fail("chosen again"))
    assert [select_templates(shelf, asked, seed) for seed in range(30, 41)] == papers[29:]
    with pytest.raises(pytest.fail.Exception):
        select_templates(shelf, replace(asked, shared=1), 30)


def test_what_tells_an_answer_gives_way_and_the_same_seed_gives_the_same():
    shelf = Shelf(a={"apart": ("c",)}, b={}, c={}, d={})
    asked = plan("ab", "cd", "ab", quota={"tier": {"A": (15, 15)}})
    found = {tuple(select_templates(shelf, asked, seed)) for seed in range(40)}
    assert found == {("a", "d", "b"), ("b", "d", "a")}
    assert select_templates(shelf, asked, "a0f3") == select_templates(shelf, asked, "a0f3")


def test_another_question_keeps_the_quota():
    asked = plan("wxt", "nu", shared=0, quota={"verb": {"tick": (0, 3)}})
    for seed in range(10):
        assert select_instead(SHELF, asked, ["w", "n"], 0, seed)[1] == "n"


def test_another_question_of_a_topic_has_the_points_of_the_one_it_replaces():
    shelf = Shelf(a={}, b={}, c={"points": 3}, d={"topic": "colour"})
    asked = Blueprint({"en": "x"}, (), topic="optics")
    assert select_instead(shelf, asked, ["a", "c"], 0, 1) == ["b", "c"]
    with pytest.raises(BlueprintError, match="nothing else"):
        select_instead(shelf, asked, ["a", "c"], 1, 1)


@together(
    ("quota", "said"),
    [
        ({"verb": {"tick": (0, 2)}}, "quota.verb.tick cannot be met: .* 3 to 6"),
        ({"verb": {"tick": (6, 6), "compute": (3, 3)}}, "quota.verb.* was missed by .* of"),
        ({"topic": {"cooking": (1, 9)}}, "quota.topic.cooking cannot be met: .* 0 to 0"),
    ],
)
def test_a_quota_out_of_reach_is_told(quota, said):
    with pytest.raises(BlueprintError, match=said):
        select_templates(SHELF, plan("tu", "nu", quota=quota), 1)


@pytest.mark.parametrize(
    ("lines", "slot", "said", "line"),
    [
        ("[quota.verb]\nexplain = [1, 2]", "", "QG320 .*'explain' .allowed: write, derive", 4),
        ("[quota.verbs]\ntick = [1, 2]", "", "QG320 quota.verbs is unknown", 3),
        ("[quota.verb]\ntick = [5, 2]", "", r"QG321 .*\[5, 2\] is not \[least, most\]", 4),
        ("total = 9\n[quota.verb]\ntick = [0, 2]", "points = 4", "QG322 total = 9 .* give 4", 3),
        ("total = 9\n[quota.tier]\nA = [5, 9]\nB = [5, 9]", "", "QG322 quota.tier asks for 10", 4),
        ("shared = 3", "", "QG322 shared must be 0 or more, in a blueprint with", 3),
    ],
)
def test_what_cannot_hold_is_refused_where_it_stands(tmp_path, lines, slot, said, line):
    file = tmp_path / "week.toml"
    file.write_text(f'title.en = "x"\n\n{lines}\n[[slot]]\n{slot}\n')
    code, _, words = said.partition(" ")
    with pytest.raises(BlueprintError, match=words) as caught:
        load_blueprint(str(file))
    assert str(caught.value).startswith(f"{file}:{line}:")
    assert caught.value.rule == code


def sums(paper):
    """Points of a paper by what its parts ask for."""
    found = Counter()
    for item in paper.items:
        for part, spec in zip(item.questions[0].parts, item.keys[0].specs, strict=True):
            found[KINDS[spec.kind].verb] += part.points
    return found


@pytest.mark.parametrize(
    "seeds", [range(1, 4), pytest.param(range(4, draws(20, full=61)), marks=pytest.mark.slow)]
)
def test_a_mock_has_its_points_minutes_and_verbs(bank, seeds):
    """As printed: the points of every part, and the minutes of the cover."""
    for seed in seeds:
        paper = build_paper(bank, load_blueprint("mock"), seed, figures=False)
        found = sums(paper)
        assert found.total() == paper.points == 100
        assert 110 <= paper.minutes <= 120
        assert sum(found[verb] for verb in WRITTEN) >= 45
        assert 24 <= found["write"] <= 32
        assert found["tick"] <= 30
        derived = [item.points for item in paper.items
                   if any(spec.kind == "derivation" for spec in item.keys[0].specs)]  # fmt: skip
        assert 18 <= sum(derived) <= 30
        assert all(part.points % Fraction(1, 4) == 0 for item in paper.items
                   for part in item.questions[0].parts)  # fmt: skip


def test_neighbouring_mocks_share_four_of_twenty_three(bank):
    mock = load_blueprint("mock")
    papers = [set(select_templates(bank, mock, seed)) for seed in range(20)]
    assert {len(paper) for paper in papers} == {23}
    assert max(len(one & other) for one, other in combinations(papers, 2)) <= 4


@pytest.mark.slow
def test_over_two_hundred_mocks_every_template_comes_and_none_crowds_out(bank):
    mock = load_blueprint("mock")
    papers = [select_templates(bank, mock, seed) for seed in range(ROUND)]
    shared = Counter(len({*one} & {*other}) for one, other in combinations(papers, 2))
    assert max(shared) <= 5
    assert shared[5] <= 0.002 * shared.total()
    used = Counter(name for paper in papers for name in paper)
    inside = {one.name for one in bank.candidates() if not one.beyond}
    assert set(used) == inside, "each template inside the notes has a slot"
    share = used.total() / len(inside)
    assert min(used.values()) >= 3
    assert max(used.values()) <= 4 * share
    topics = [{bank.rules(name).topic for name in paper} for paper in papers]
    sections = [{"image", "normalisation"}, {"colour", "eye"}, {"optics", "aperture"},
                {"projection", "distortion", "camera"}, {"sensor", "noise"}, {"code"}]  # fmt: skip
    assert all(one & part for one in topics for part in sections)


@pytest.mark.parametrize(
    "seeds", [range(3), pytest.param(range(3, draws(20, full=40)), marks=pytest.mark.slow)]
)
def test_a_trial_has_the_shapes_of_the_real_one(bank, seeds):
    trial, found = load_blueprint("trial"), set()
    for seed in seeds:
        paper = build_paper(bank, trial, seed, figures=False)
        shapes = [KINDS[item.keys[0].specs[0].kind].verb for item in paper.items]
        assert shapes == ["tick", "tick", "write", "sketch", "compute"]
        assert [item.points for item in paper.items] == [Fraction(3, 2), Fraction(3, 2), 2, 2, 3]
        assert paper.minutes == 11
        found.add(tuple(item.keys[0].template for item in paper.items))
    assert len(found) > 1


@pytest.mark.parametrize(
    "seeds", [range(1, 3), pytest.param(range(3, draws(6, full=20)), marks=pytest.mark.slow)]
)
def test_a_paper_turned_round_is_not_ticked(bank, seeds):
    turned = load_blueprint("mock")
    for seed in seeds:
        for level, most in (("transfer", 35), ("guided", 100)):
            paper = build_paper(bank, replace(turned, level=level), seed, figures=False)
            assert sums(paper)["tick"] <= most


def count_words(question):
    parts = (question.stem, *(part.body for part in question.parts))
    return sum(len(line.split()) for blocks in parts for line in blocks_to_plain_text(blocks))


def count_done(question, specs):
    """Formulas to weigh, half of them in the mean, and values to write down."""
    ticked = [spec.kind == "choice" for spec in specs]
    weighed = sum(len(part.field.options) for part, is_one in zip(
        question.parts, ticked, strict=True) if is_one) / 2  # fmt: skip
    return weighed, sum(not part.field.options for part in question.parts)


@pytest.mark.parametrize("seed", [2, pytest.param(7, marks=pytest.mark.slow)])
def test_a_guided_paper_takes_as_long_as_what_is_added_to_the_exam(bank, seed):
    """By the table of docs/papers.md: a word read, a line ticked, a cell filled."""
    mock = load_blueprint("mock")
    usual = build_paper(bank, mock, seed, figures=False)
    guided = build_paper(bank, replace(mock, level="guided"), seed, figures=False)
    added = 0.0
    for before, after in zip(usual.items, guided.items, strict=True):
        old, new = before.questions[0], after.questions[0]
        if len(old.parts) == len(new.parts):
            continue
        ticks, cells = (now - then for now, then in zip(
            count_done(new, after.keys[0].specs), count_done(old, before.keys[0].specs),
            strict=True))  # fmt: skip
        added += (count_words(new) - count_words(old)) / 150 + 0.35 * ticks + 0.25 * max(cells, 0)
    assert guided.minutes == pytest.approx(usual.minutes + 1.1 * added, abs=4)
