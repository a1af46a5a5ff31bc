"""Item analysis and the effect of draws, on classes whose figures are known beforehand."""

from __future__ import annotations

import random

import pytest

from quizgen.classes.grading import GradedClassPart, StudentMarks
from quizgen.classes.item_analysis import analyse_class
from quizgen.classes.key_index import PaperOutline
from quizgen.classes.variant_difficulty import VariantDifficulty, parse_identity


def part(item, marks, *, points=1.0, status="", note="", chosen=()):
    said = status or ("correct" if marks == points else "wrong")
    return GradedClassPart(item, item, "x", said, points, marks, note, chosen=chosen)


OUTLINE = PaperOutline({}, {"c/a": ("one", "two", "three")})


def test_figures_of_items():
    """Four students, by hand: c/a has shares 1 1 0 0, d has 1 0.5 0 (and one undecided)."""
    rows = [
        [part("c/a", 1.0, chosen=("one",)), part("d", 2.0, points=2.0)],
        [
            part("c/a", 1.0, chosen=("one",)),
            part("d", 1.0, points=2.0, status="partial", note="unit"),
        ],
        [
            part("c/a", 0.0, chosen=("two",), note="trap:x"),
            part("d", 0.0, points=2.0, note="trap:y"),
        ],
        [part("c/a", 0.0, status="blank"), part("d", None, points=2.0, status="open")],
    ]
    found = analyse_class(
        (StudentMarks(f"s{n}", tuple(row), minutes=float(n)), OUTLINE) for n, row in enumerate(rows)
    )
    first, second = found.items
    assert (found.students, found.points, found.totals) == (4, 3.0, (3.0, 2.0, 0.0, 0.0))
    assert found.minutes == (0.0, 1.0, 2.0, 3.0)
    assert (first.difficulty, first.blank, first.undecided, first.students) == (0.5, 1, 0, 4)
    assert (second.difficulty, second.blank, second.undecided, second.students) == (0.5, 0, 1, 3)
    # c/a 1 1 0 0 against d 2 1 0 0: 1.5/sqrt(1*2.75) by hand
    assert first.discrimination == pytest.approx(0.904534, abs=1e-6)
    assert first.options == (("three", 4, 0), ("two", 4, 1), ("one", 4, 2))
    assert first.never == ["three"]
    assert [(m.note, m.students) for m in second.mistakes] == [("trap:y", 1), ("unit", 1)]


def test_what_was_dropped_counts_nowhere():
    rows = [
        [part("c", float(n % 2)), part("d", 0.0, points=0.0, status="dropped")] for n in range(4)
    ]
    found = analyse_class(
        (StudentMarks(f"s{n}", tuple(row)), PaperOutline({}, {})) for n, row in enumerate(rows)
    )
    assert found.questions == 1
    assert [item.difficulty for item in found.items] == [0.5, None]


def test_alpha_is_over_whole_questions():
    """Parts of one question that are always alike do not make a test more reliable."""
    rows = [
        [part("a/a", s), part("a/b", s), part("b", t)]
        for s, t in ((1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0))
    ]
    found = analyse_class(
        (StudentMarks(f"s{n}", tuple(row)), PaperOutline({}, {})) for n, row in enumerate(rows)
    )
    assert found.questions == 2
    assert found.alpha == pytest.approx(0.0, abs=1e-12)


def test_the_values_of_a_draw():
    whole = "a-question(f=6, p_x=-12, N_1=28/5, pattern=grbg, part=one+two, claims=half)/guided"
    assert parse_identity(whole) == [
        ("f", "6"),
        ("p_x", "-12"),
        ("N_1", "28/5"),
        ("pattern", "grbg"),
        ("part", "one+two"),
        ("claims", "half"),
    ]
    assert parse_identity("plain") == []


def simulated(harder: bool) -> VariantDifficulty:
    """Two hundred students; a wide f is hard if wished, and grbg is hard if wished."""
    chance, draws = random.Random(3), VariantDifficulty()
    for _ in range(200):
        f, pattern, z = (
            chance.randrange(1, 40),
            chance.choice(["rggb", "grbg"]),
            chance.randrange(3),
        )
        p = 0.8 - (0.015 * f + 0.2 * (pattern == "grbg") if harder else 0)
        draws.add("q", f"q(f={f}, z={z}, pattern={pattern})", float(chance.random() < p))
    return draws


def test_a_draw_that_is_harder_is_found():
    first, second, third = simulated(harder=True).find_effects()
    assert {first.quantity, second.quantity} == {"f", "pattern"}
    assert max(first.corrected, second.corrected) < 0.05 < third.corrected
    trend = next(one for one in (first, second) if one.quantity == "f")
    assert trend.trend < -0.2
    assert trend.levels[0].share > trend.levels[-1].share
    groups = next(one for one in (first, second) if one.quantity == "pattern")
    assert {level.name for level in groups.levels} == {"rggb", "grbg"}
    assert sum(level.students for level in groups.levels) == 200


def test_where_chance_alone_decides_nothing_is_found():
    assert all(effect.corrected > 0.05 for effect in simulated(harder=False).find_effects())


def test_too_few_students_are_not_compared():
    draws = VariantDifficulty()
    for n in range(8):
        draws.add("q", f"q(f={n % 2})", float(n % 2))
    assert draws.find_effects() == []
