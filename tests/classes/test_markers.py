"""How far two markers agree, item by item; what a rubric adds up to; who marks which share."""

from __future__ import annotations

from fractions import Fraction

import pytest

from quizgen.classes.agreement import agreement_by_item, weighted_kappa
from quizgen.classes.markers import ItemMarkers, split_names
from quizgen.classes.rubrics import ItemRubric, RubricLine, read_rubric, write_rubric
from quizgen.classes.rulings import Ruling
from quizgen.core.errors import ClassError

RUBRIC = ItemRubric("a/b", (
    RubricLine("cone", "the cone", "1"), RubricLine("cone/half", "the cone", "0.5"),
    RubricLine("disc", "the disc", "0.5", "Right: the disc."), RubricLine("hole", "a larger hole", "-0.5"),
    RubricLine("old", "was taken off", "1", "never read", gone=True),
))  # fmt: skip


def decided(what: str, group: str, value: str, because: str = "") -> Ruling:
    return Ruling(what, "a/b", "x", value, who=what, group=group, because=because)


def test_weighted_kappa_as_computed_by_hand():
    """Quadratic weights over 0, 1, 2 points; rows are the first marker, columns the second.

    5 1 0
    1 3 1
    0 1 4     n = 16; rows and columns sum to 6, 5, 5.
    Seen: 4 pairs differ by 1, so the sum of squares is 4. By chance: differing by 1 are
    (6*5 + 5*6 + 5*5 + 5*5)/16 = 110/16, by 2 (6*5 + 5*6)/16 = 60/16, with weight 4: 350/16.
    Kappa = 1 - 4 * 16/350 = 143/175.
    """
    table = [[5, 1, 0], [1, 3, 1], [0, 1, 4]]
    pairs = [(Fraction(row), Fraction(column)) for row in range(3) for column in range(3)
             for _ in range(table[row][column])]  # fmt: skip
    assert weighted_kappa(pairs) == Fraction(143, 175)


@pytest.mark.parametrize(("pairs", "kappa"), [
    ([], None), ([(1, 1)] * 5, None), ([(0, 0), (1, 1)], 1), ([(0, 1), (1, 0)], -1),
])  # fmt: skip
def test_kappa_where_nothing_or_all_is_known(pairs, kappa):
    assert weighted_kappa([(Fraction(a), Fraction(b)) for a, b in pairs]) == kappa


def test_what_was_settled_does_not_count_as_agreement():
    both = [decided("decide", "g1", "1"), decided("second", "g1", "0"),
            decided("decide", "g2", "0"), decided("second", "g2", "0")]  # fmt: skip
    before = agreement_by_item(both)["a/b"]
    after = agreement_by_item([*both, decided("decide", "g1", "0", "settled: 1, 0")])["a/b"]
    # squares: 1 seen; by chance 1/2*1*1: of (1, 0) with (0, 0) two of four pairs differ, so kappa 0
    assert (before.answers, before.kappa, len(before.apart)) == (2, 0, 1)
    assert (after.answers, after.kappa, len(after.apart)) == (2, 0, 0)


@pytest.mark.parametrize(("ticked", "points", "read"), [
    ("", 0, ""), ("cone", 1, ""), ("cone/half", Fraction(1, 2), ""),
    ("cone cone/half", 1, ""),  # a whole one and its half: the larger counts
    ("cone disc", Fraction(3, 2), "Right: the disc."),
    ("cone disc old", Fraction(3, 2), "Right: the disc."),
    ("hole", 0, ""), ("disc hole", 0, "Right: the disc."),  # never below nothing
])  # fmt: skip
def test_ticked_lines_make_the_points_and_what_the_student_reads(ticked, points, read):
    lines = {*ticked.split()}
    assert (RUBRIC.add_up(lines, Fraction(2)), RUBRIC.remark(lines)) == (points, read)


def test_a_part_is_worth_no_more_than_it_is():
    assert RUBRIC.add_up({"cone", "disc"}, Fraction(1)) == 1


def test_a_rubric_comes_back_from_its_file_with_what_was_changed(tmp_path):
    changed = RUBRIC.replace(RubricLine("disc", "the disc", "0.25"), "AM", "s1")
    write_rubric(tmp_path, changed)
    assert read_rubric(tmp_path, "a/b") == changed
    assert changed.history[-1].before == RUBRIC.find("disc")
    assert read_rubric(tmp_path, "a/c") is None
    (tmp_path / "rubrics" / "a%2Fb.json").write_text('{"item": "a/b", "lines": [{"id": 3}]}')
    with pytest.raises(ClassError, match=r"a%2Fb\.json"):
        read_rubric(tmp_path, "a/b")


@pytest.mark.parametrize("line", [
    RubricLine("x", "", "1"), RubricLine("x", "t", "many"), RubricLine("x", "t" * 301, "1"),
    RubricLine("x", "t", "1000"),
])  # fmt: skip
def test_a_line_that_cannot_be_is_refused(line):
    with pytest.raises(ClassError):
        RUBRIC.replace(line, "AM", "s1")


def test_first_markers_share_the_answers_in_equal_stretches():
    markers = ItemMarkers(split_names("AM, BN,, AM ,CK"), ("DL",))
    owners = [[name for name in ("am", "BN", "CK", "DL") if markers.owns(name, place, 9)]
              for place in range(9)]  # fmt: skip
    assert owners == [["am"]] * 3 + [["BN"]] * 3 + [["CK"]] * 3
    assert [markers.is_second(name) for name in ("AM", "dl")] == [False, True]
    assert ItemMarkers().owns("anybody", 4, 9)
