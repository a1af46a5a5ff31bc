"""Judging right on the edge: ties, zeros, ambiguous digits, undecided comparisons, few points."""

from __future__ import annotations

from fractions import Fraction

import flint
import pytest
from flint import arb, fmpq
from sweep import together

from quizgen.core.errors import UndecidedError
from quizgen.grading.diagnosis.carry_forward import recompute_from_earlier
from quizgen.grading.judging.sampled_equality import compare_by_sampling, sample_points
from quizgen.grading.options import QuestionContext
from quizgen.kinds.grade import grade_answer
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import compile_expr, exact_system


@together(
    ("value", "typed", "note"),
    [
        ("1.25", "1.3", "decimals-asked"),
        ("1.25", "1.2", "decimals-asked"),
        ("1.2501", "1.2", ""),
        ("-1.25", "-1.3", "decimals-asked"),
        ("1.35", "1.3", "decimals-asked"),
        ("1.3501", "1.3", ""),
    ],
)
def test_a_tie_rounded_either_way_has_too_few_digits_only(value, typed, note):
    """A key of 1.25 stands exactly halfway between 1.2 and 1.3; 1.2501 does not."""
    verdict = grade_answer({"kind": "number", "value": value, "decimals": 4}, typed)
    assert (verdict.note, verdict.credit) == (note, Fraction(1, 2) if note else 0)


def test_a_tie_in_too_few_figures_counts_either_way():
    spec = {"kind": "number", "value": "12.25", "sigfigs": 5}
    assert [grade_answer(spec, typed).note for typed in ("12.2", "12.3", "12.1")] == [
        "figures-asked", "figures-asked", ""]  # fmt: skip


@pytest.mark.parametrize(
    ("typed", "verdict"), [("12.5 %", "correct"), ("12.50 %", "partial"), ("13.5 %", "wrong")]
)
def test_a_percentage_has_two_decimals_more_as_a_share(typed, verdict):
    """12.5 % is 0.125: three decimals, as asked."""
    spec = {"kind": "number", "value": "1/8", "decimals": 3, "strict": True}
    assert grade_answer(spec, typed).verdict == verdict


@pytest.mark.parametrize(
    ("typed", "meant"),
    [("20/3 = 6.667", "6.667"), ("6.667 = 20/3", "20/3"), ("20/3 = 6.667 = 6.67", "6.67")],
)
def test_of_equal_things_that_are_all_right_the_last_is_what_was_meant(typed, meant):
    verdict = grade_answer({"kind": "number", "value": "20/3", "rel": "0.001"}, typed)
    assert (verdict.verdict, verdict.read_as) == ("correct", meant)


@pytest.mark.parametrize(
    ("values", "typed"),
    [
        (["6", "0", "2"], "(3; 0; 1)"),
        (["0", "580", "-2"], "(0; -290; 1)"),
        (["1000", "1000", "0.1"], "(100; 100; 0.01)"),
        (["840", "580", "2"], "(420; 290; 1.0005)"),
    ],
)
def test_homogeneous_coordinates_are_compared_by_their_largest(values, typed):
    """A coordinate of zero cannot be scaled to, and a small one carries a larger error."""
    spec = {"kind": "point", "values": values, "up_to_scale": True, "rel": "0.001"}
    assert grade_answer(spec, typed).verdict == "correct"


def chain() -> Chain:
    """u = a + b, then v = 10 u + 3."""
    steps = (ChainStep("u", parse_formula("a + b")), ChainStep("v", parse_formula("10*u + 3")))
    return Chain({"a": "", "b": ""}, steps)


GIVEN = {"a": fmpq(2), "b": fmpq(3)}


@pytest.mark.parametrize(
    ("own", "carried"),
    [
        (fmpq(7), [fmpq(73)]),
        (fmpq(0), []),
        (fmpq(5), []),
        (fmpq(-3, 10), []),
    ],
    ids=["7 gives 73", "zero gives nothing", "the right 5", "a result of zero"],
)
def test_an_error_is_carried_forward_unless_it_is_zero(own, carried):
    """With u = 7 the next step is 10*7 + 3 = 73; the right one is 53."""
    assert recompute_from_earlier(QuestionContext(chain(), GIVEN, {"u": own}), "v") == carried


def test_a_typed_zero_earns_nothing_for_what_follows():
    spec = {"kind": "number", "value": "53", "exact": True, "of": ["v"]}
    after_seven = grade_answer(spec, "73", context=QuestionContext(chain(), GIVEN, {"u": fmpq(7)}))
    assert (after_seven.note, after_seven.credit) == ("carried-forward", 1)
    after_zero = grade_answer(spec, "3", context=QuestionContext(chain(), GIVEN, {"u": fmpq(0)}))
    assert (after_zero.verdict, after_zero.credit) == ("wrong", 0)


AMBIGUOUS = [
    ("123456", "123.456", "ambiguous", "two-readings"),
    ("123456", "123,456", "ambiguous", "two-readings"),
    ("123.456", "123.456", "correct", ""),
    ("123456", "0.456", "wrong", None),
    ("1234567", "1234.567", "wrong", None),
]


@pytest.mark.parametrize(("key", "typed", "verdict", "note"), AMBIGUOUS)
def test_three_digits_after_one_mark_are_asked_back_when_only_thousands_are_right(
    key, typed, verdict, note
):
    found = grade_answer({"kind": "number", "value": key, "exact": True}, typed)
    assert found.verdict == verdict
    assert note is None or found.note == note


def test_a_quantity_is_asked_back_like_a_number():
    spec = {"kind": "quantity", "value": "123456", "unit": "mm", "exact": True}
    assert grade_answer(spec, "123.456 mm").note == "two-readings"
    assert grade_answer(spec, "123.4560 mm").verdict == "wrong"


@pytest.mark.parametrize(
    ("decimal", "verdict"), [("auto", "ambiguous"), ("comma", "correct"), ("point", "wrong")]
)
def test_the_declared_sign_settles_what_a_point_means(decimal, verdict):
    """Whoever writes decimals with a point has written a decimal; with a comma, thousands."""
    spec = {"kind": "number", "value": "123456", "exact": True}
    assert grade_answer(spec, "123.456", decimal=decimal).verdict == verdict


ZERO = arb(0, 1e-20)
"""A ball around zero: it may be less than zero, or not."""


@pytest.mark.parametrize("relation", ["a < 0", "a > 0", "a <= 0", "a >= 0", "a = 0"])
def test_a_comparison_that_cannot_be_certified_is_not_false(relation):
    with pytest.raises(UndecidedError):
        compile_expr(parse_formula(relation), exact_system())({"a": ZERO})


def test_an_example_that_cannot_be_decided_is_asked_back():
    """The square of 1 + √2 is 3 + 2√2, but a ball around its root never excludes other values."""
    spec = {"kind": "witness", "predicate": "sqrt(3 + 2*sqrt(x)) > 1 + sqrt(x)", "symbols": ["x"]}
    assert grade_answer(spec, "2").note == "undecided"
    assert grade_answer(spec, "1").verdict == "correct"
    assert grade_answer(spec, "9").verdict == "wrong"


def test_sides_that_are_the_same_formula_are_decided():
    """No ball tells them apart: the sine of a whole number of pi is 0, and so is a power of 0."""
    spec = {"kind": "witness", "predicate": "sin(pi*sqrt(x)) < 0", "symbols": ["x"]}
    assert grade_answer(spec, "1").note == "predicate"
    powers = "(x + y)^(1/2.2) != x^(1/2.2) + y^(1/2.2)"
    spec = {"kind": "witness", "predicate": powers, "symbols": ["x", "y"]}
    assert grade_answer(spec, "0; 0.5").note == "predicate"
    assert grade_answer(spec, "0.5; 0.5").verdict == "correct"


def test_a_rational_multiple_of_pi_is_decided():
    spec = {"kind": "witness", "predicate": "sin(pi*x) < 0", "symbols": ["x"]}
    assert grade_answer(spec, "1").note == "predicate"
    assert grade_answer(spec, "3/2").verdict == "correct"


def nearly(points: int) -> str:
    """A formula that is x at so many of the points that are looked at, and nowhere else."""

    roots = [point["x"] for point in sample_points({"x": "positive"})[:points]]
    factors = "*".join(f"(x - {root.p}/{root.q})" for root in roots)
    return f"x + {factors}" if factors else "x + 1"


@together("points", range(8))
def test_formulas_that_agree_at_fewer_than_eight_points_differ(points):
    found = compare_by_sampling(
        parse_formula("x"), parse_formula(nearly(points)), {"x": "positive"}
    )
    assert found.equal is False


def test_equal_formulas_are_looked_at_in_eight_points():
    found = compare_by_sampling(
        parse_formula("exp(x)^2"), parse_formula("exp(2*x)"), {"x": "positive"}
    )
    assert (found.equal, found.points, found.ground) == (True, 8, "sampled")


def test_ambient_precision_is_left_as_it_was():
    before = flint.ctx.prec
    grade_answer({"kind": "number", "value": "sqrt(2)"}, "√2")
    assert flint.ctx.prec == before


KINDS_OF_NOISE = ["noise", "blur", "glare"]
BY_HAND = {
    "A": "measure the light",
    "B": "set the aperture",
    "C": "take the picture",
}


@together(
    ("spec", "typed", "verdict", "read_as"),
    [
        ({"kind": "multi", "options": KINDS_OF_NOISE, "correct": [1, 2, 3]}, "all of them", "correct", "A, B, C"),
        ({"kind": "choice", "options": KINDS_OF_NOISE, "correct": [2]}, "the second", "correct", "B"),
        ({"kind": "order", "steps": ["A", "B", "C"], "words": BY_HAND},
         "measure the light, set the aperture, take the picture", "correct", "A B C"),
        ({"kind": "order", "steps": ["A", "B", "C"], "words": BY_HAND},
         "take the picture, set the aperture, measure the light", "wrong", "C B A"),
        ({"kind": "expression", "value": "1234*x", "symbols": {"x": "real"}}, "1,234 x", "ambiguous", "1.234·x | 1234·x"),
        ({"kind": "expression", "value": "x*(sin(x)+1)", "symbols": {"x": "real"}, "form": "factored"},
         "x*(sin(x)+1)", "correct", "x·(sin(x) + 1)"),
    ],
)  # fmt: skip
def test_what_words_choose_and_what_signs_leave_open(spec, typed, verdict, read_as):
    found = grade_answer(spec, typed)
    assert (found.verdict, found.read_as) == (verdict, read_as)


EFFECTS = [
    "the picture becomes darker and sharper", "it gets coloured fringes from refraction",
    "the depth of field grows", "the depth of field shrinks", "it shows barrel distortion",
]  # fmt: skip


@together(
    ("typed", "read_as"),
    [
        ("more depth of field", "C"),
        ("Schärfentiefe nimmt ab, wird kleiner", "D"),
        ("dof kome", "D"),
        ("farbige Säume durch Brechung", "B"),
        ("ব্যারেল distortion", "E"),
        ("not B, not C, so A", "A"),
        ("C no sorry D", "D"),
        ("first thought C but stopping down is the other way, so D", "D"),
        ("the picture does not become darker and sharper", ""),
        ("the picture becomes brighter and sharper", ""),
        ("the depth of field", ""),
        ("E, so coloured fringes from refraction", ""),
        ("C, not sure", ""),
        ("no coloured fringes", ""),
    ],
)
def test_an_option_in_own_words_is_read_and_a_doubtful_one_is_asked_back(typed, read_as):
    found = grade_answer({"kind": "choice", "options": EFFECTS, "correct": [2]}, typed)
    assert (found.read_as if found.is_graded else "") == read_as


SETTINGS = {
    "pairs": {"A": "2", "B": "3", "C": "1"},
    "words": {
        "A": "the angle of view", "B": "the motion blur", "C": "the depth of field",
        "1": "rises", "2": "stays as it is", "3": "falls",
    },
}  # fmt: skip


@together(
    ("typed", "verdict"),
    [
        ("angle of view same, motion blur smaller, depth of field larger", "correct"),
        ("Bildwinkel gleich, Bewegungsunschärfe sinkt, Schärfentiefe steigt", "correct"),
        ("angle stays (2), blur falls (3), depth grows (1)", "correct"),
        ("first one 2, second one 3, third one 1", "correct"),
        ("A2 B1 no B3 C1", "correct"),
        ("A=2 blur, B=1 depth, C=3", "partial"),
        ("angle of view stays, motion blur stays, depth of field or so", "unreadable"),
    ],
)
def test_pairs_in_own_words_are_bound_by_their_numbers(typed, verdict):
    assert grade_answer({"kind": "match", **SETTINGS}, typed).verdict == verdict


@together(
    ("typed", "verdict"),
    [
        ("less of it", "correct"),
        ("a smaller fill factor", "correct"),
        ("smaller, since the electronics need room", "correct"),
        ("not larger but smaller", "correct"),
        ("smaller or larger", "unreadable"),
        ("not smaller", "unreadable"),
        ("larger", "wrong"),
    ],
)
def test_a_gap_takes_a_term_said_otherwise_and_no_denial_of_it(typed, verdict):
    spec = {"kind": "gap", "accept": [["smaller", "small"]], "among": ["larger", "large"]}
    assert grade_answer(spec, typed).verdict == verdict


def test_gaps_are_named_in_any_order():
    spec = {"kind": "gap", "accept": [["4"], ["2"], ["3"]], "names": [["V", "S", "H"]]}
    assert grade_answer(spec, "H in 3, V in 4, S in 2").read_as == "4; 2; 3"
    assert not grade_answer(spec, "H in 3, V in 4, V in 2").is_graded
