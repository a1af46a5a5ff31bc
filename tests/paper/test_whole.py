"""Papers that hold as a whole what their blueprint asks for: sums by hand, neighbours, errors."""

from __future__ import annotations

from itertools import combinations, product

import pytest
from shelf import Shelf
from sweep import draws, together

from quizgen.core.errors import BlueprintError
from quizgen.kinds.contract import asked_quantities
from quizgen.paper.blueprint import Blueprint, SlotRule, load_blueprint
from quizgen.paper.constraints import paper_minutes
from quizgen.paper.paper import build_paper
from quizgen.paper.selection import select_templates


def plan(*slots, **demands):
    return Blueprint({"en": "x"}, tuple(SlotRule(templates=tuple(s)) for s in slots), **demands)


@pytest.mark.parametrize(("minutes", "whole"), [(100, 110), (10, 11), (109, 120), (3, 4), (0, 0)])
def test_a_paper_takes_a_tenth_more_than_its_questions(minutes, whole):
    assert paper_minutes(minutes) == whole


def test_the_total_is_met_by_every_seed_and_every_way_comes_up():
    """Of the 27 ways through three places of 1, 2 or 3.5 points, 6 make 6.5: 1, 2, 3.5 in turn."""
    shelf = Shelf(**{f"{s}{n}": {"points": p} for s in "abc" for n, p in enumerate((1, 2, 3.5))})
    slots = [[f"{s}{n}" for n in range(3)] for s in "abc"]
    worth = {one.name: one.points for one in shelf.candidates()}
    fitting = {way for way in product(*slots) if sum(worth[name] for name in way) == 6.5}
    assert len(fitting) == 6
    found = {tuple(select_templates(shelf, plan(*slots, total=6.5), seed)) for seed in range(80)}
    assert found == fitting


def test_minutes_figures_kinds_and_photographs_are_met_together():
    shelf = Shelf(
        a={"minutes": 10}, b={"minutes": 20, "figure": "noise"},
        c={"minutes": 10, "figure": "pinhole"}, d={"minutes": 10, "figure": "noise"}, e={},
        f={"minutes": 30, "figure": "gaussian"},
    )  # fmt: skip
    slots = [("a", "b"), ("c", "d"), ("e", "f")]
    asked = {"minutes": (30, 40), "figures": 2}
    found = {tuple(select_templates(shelf, plan(*slots, **asked), seed)) for seed in range(40)}
    assert found == {("b", "c", "e"), ("b", "d", "e")}, "22 + 11 + 5.5; with f it takes 55 or more"
    assert select_templates(shelf, plan(*slots, **asked, figure_kinds=2), 0) == ["b", "c", "e"]
    assert select_templates(shelf, plan(*slots, **asked, photographs=2), 0) == ["b", "d", "e"]


def test_neighbours_that_tell_an_answer_stay_apart_and_none_comes_twice():
    shelf = Shelf(a={"apart": ("c",)}, b={}, c={}, d={})
    slots = [("a", "b"), ("c", "d"), ("a", "b")]
    found = {tuple(select_templates(shelf, plan(*slots, total=15), seed)) for seed in range(40)}
    assert found == {("a", "d", "b"), ("b", "d", "a")}


def test_the_points_of_a_slot_make_a_question_no_shorter():
    """Eight minutes and four, whatever they are worth: 12, and a tenth."""
    shelf = Shelf(long={"points": 8, "minutes": 8}, short={"points": 4, "minutes": 4})
    slot = SlotRule(templates=("long", "short"), points=2)
    asked = Blueprint({"en": "x"}, (slot, SlotRule(templates=("long",))), minutes=(13, 14))
    assert select_templates(shelf, asked, 1) == ["short", "long"]


def test_who_is_past_the_syllabus_must_be_listed():
    shelf = Shelf(a={"beyond": True}, b={})
    assert {
        select_templates(shelf, Blueprint({"en": "x"}, (SlotRule(),)), s)[0] for s in range(20)
    } == {"b"}
    assert {select_templates(shelf, plan(("a", "b")), s)[0] for s in range(20)} == {"a", "b"}


@together(
    ("demands", "said"),
    [
        ({"total": 100}, "total = 100 cannot be met: the slots together can make 3 to 7"),
        ({"total": 4}, "total = 4 cannot be met"),
        ({"minutes": (60, 70)}, r"minutes = \[60, 70\] cannot be met: .* 11 to 11"),
        ({"figures": 2}, "figures = 2 cannot be met: the slots together can make 0 to 1"),
        ({"photographs": 1}, "photographs = 1 cannot be met: the slots together can make 0 to 0"),
        ({"figure_kinds": 2}, "figure_kinds = 2 cannot be met: there are 1"),
        ({"total": 7, "figures": 1}, "no choice of templates .* meets total, figures"),
    ],
)
def test_a_demand_that_cannot_be_met_is_told(demands, said):
    shelf = Shelf(a={"points": 1, "figure": "pinhole"}, b={"points": 5}, c={"points": 2})
    with pytest.raises(BlueprintError, match=said):
        select_templates(shelf, plan(("a", "b"), ("c",), **demands), 1)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("total = 0", "total must be positive"),
        ("minutes = [20, 10]", r"minutes must be 1 to 9999, or \[least, most\]"),
        ("minutes = [1, 2, 3]", "minutes"),
        ("figures = -1", "figures must be 0 to 200"),
    ],
)
def test_a_demand_that_nobody_means_is_located(tmp_path, line, said):
    file = tmp_path / "week.toml"
    file.write_text(f'{line}\n[title]\nen = "x"\n[[slot]]\n')
    with pytest.raises(BlueprintError, match=said) as caught:
        load_blueprint(str(file))
    assert str(caught.value).startswith(str(file))


def asked(draw):
    """Numbers a question asks, to four digits, whole ones below ten aside."""
    names = [n for part in draw.template.rules.part for n in asked_quantities(part.answer)]
    values = [abs(float(draw.shown_values[name])) for name in names]
    return {f"{value:.4g}" for value in values if value >= 10 or value % 1}


@pytest.mark.parametrize(
    "seeds", [range(3), pytest.param(range(3, draws(20, full=200)), marks=pytest.mark.slow)]
)
def test_no_two_questions_of_a_mock_have_the_same_answer_by_accident(bank, seeds):
    """A redraw helps: without it, 122 of 300 mocks ask some number twice."""
    for seed in seeds:
        paper = build_paper(bank, load_blueprint("mock"), seed, figures=False)
        numbers = [asked(item.keys[0].draw) for item in paper.items]
        assert not any(one & other for one, other in combinations(numbers, 2)), seed
