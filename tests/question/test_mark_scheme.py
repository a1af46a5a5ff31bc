"""Points for the steps of a solution: authored, else dealt out; what a marker accepts besides."""

from __future__ import annotations

from fractions import Fraction

import pytest
from msgspec.structs import replace

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.core.errors import BankError
from quizgen.kinds import KINDS
from quizgen.kinds.grade import grade_answer
from quizgen.kinds.number import NumberSpec
from quizgen.kinds.quantity import QuantitySpec
from quizgen.kinds.rubric import share_of_marks
from quizgen.question.compose import compose_question
from quizgen.question.mark_scheme import mark_steps, rescale_criteria

SOLVER = """from sympy import symbols

from quizgen.maths.model import Model, Step

a, b, s, p = symbols("a b s p")
MODEL = Model(given={a: "m", b: "m"}, steps=(Step(s, a + b, "m"), Step(p, s * b, "m^2")))
"""
TEMPLATE = """topic = "lengths"
tier = "A"
solver = "sides"
[draw]
a = { range = [2, 4, 1], unit = "m" }
b = { range = [5, 9, 1], unit = "m" }
[[part]]
points = 3
answer = { kind = "quantity", of = "p", unit = "m^2" }
"""
WORDS = """# Sides
A side is {{ a }}, another {{ b }}.

## a
How large is $p$?

## steps
- s: Both together.
- p: Their product.

## check
Metres times metres.
"""


def compose(root, scheme=""):
    folder = root / "templates" / "lengths" / "sides"
    folder.mkdir(parents=True)
    (root / "solvers").mkdir()
    (root / "solvers" / "sides.py").write_text(SOLVER)
    (folder / "template.toml").write_text(TEMPLATE.replace("answer =", f"{scheme}\nanswer ="))
    (folder / "en.md").write_text(WORDS)
    return compose_question(Bank(root, trusted=True).template("sides"), 1, "en")


def points(made, worth, *, has_unit=True):
    part = made[1].solution.parts[0]
    marked = mark_steps(part, Fraction(worth), has_unit=has_unit)
    return [[float(side.points) for side in line] for line in marked]


def test_formula_numbers_value_and_unit_earn_quarters_and_the_result_comes_first(tmp_path):
    made = compose(tmp_path)
    assert points(made, 3) == [[0.5, 0.25, 0.5], [0.5, 0.25, 1.0]]
    assert points(made, "1/2") == [[0.25, 0, 0], [0, 0, 0.25]]
    assert points(made, 3, has_unit=False) == [[0.5, 0.5, 0.5], [0.5, 0.5, 0.5]]
    assert sum(map(sum, points(made, "1/3"))) == pytest.approx(1 / 3)


def test_an_author_gives_points_to_steps_and_a_paper_may_give_more_of_them(tmp_path):
    made = compose(tmp_path, "scheme = { s = 1, p = 2 }")
    assert points(made, 3) == [[0.5, 0.25, 0.25], [0.5, 0.5, 1.0]]
    assert list(map(sum, points(made, 6))) == [2, 4]
    assert list(map(sum, points(made, 2))) == [0.75, 1.25]


@pytest.mark.parametrize(
    ("scheme", "code", "said"),
    [
        ("{ s = 1, p = 1 }", "QG260", "the steps earn 2 points, and the part 3"),
        ("{ s = 4, p = -1 }", "QG260", "the steps earn 3 points, and the part 3"),
        ("{ s = 1, q = 2 }", "QG116", "no steps of its solution: ['q']"),
    ],
)
def test_a_scheme_that_does_not_fit_is_shown_where_it_stands(tmp_path, scheme, code, said):
    with pytest.raises(BankError, match="scheme") as caught:
        compose(tmp_path, f"scheme = {scheme}")
    assert (caught.value.rule, caught.value.place) == (code, ("part", 0, "scheme"))
    assert said in str(caught.value)


NUMBERS = [
    (QuantitySpec(kind="quantity", value="15/4", unit="mm"), "3.732 to 3.768 mm", "3.731"),
    (
        QuantitySpec(kind="quantity", value="1968/325", unit="mW", rel="1/10"),
        "5.5 to 6.6 mW",
        "5.4",
    ),
    (NumberSpec(kind="number", value="1/8", percent=True, abs="1/2"), "12.0 to 13.0 %", "11.9"),
    (NumberSpec(kind="number", value="2/3", decimals=2), "0.657 to 0.676", "0.65"),
]


@pytest.mark.parametrize(("spec", "said", "beyond"), NUMBERS)
def test_what_a_marker_accepts_is_what_is_graded_as_right(spec, said, beyond):
    assert KINDS[spec.kind].accepted(spec, "en") == said
    low, _, high, *unit = said.split()
    for text in (low, high):
        assert grade_answer(spec, " ".join([text, *unit])).verdict == "correct"
    assert grade_answer(spec, " ".join([beyond, *unit])).verdict != "correct"


def test_of_an_exact_fraction_a_marker_hears_that_a_decimal_is_as_good():
    said = [
        KINDS["number"].accepted(NumberSpec(kind="number", value=value, exact=True), "en")
        for value in ("1/3", "440")
    ]
    assert said == ["the same value as a fraction or as a decimal", ""]


def test_a_paper_says_how_exactly_where_three_figures_are_not_what_is_asked():
    rules = [{"sigfigs": 2}, {"sigfigs": 3}, {"decimals": 1}, {"exact": True}, {"rel": "1/1000"},
             {"abs": "0.5"}, {}]  # fmt: skip
    specs = [NumberSpec(kind="number", value="7/3", **rule) for rule in rules]
    assert [KINDS["number"].paper_hints(one, "en") for one in specs] == [
        ("2 significant figures",), (), ("1 decimal",), ("exact",), ("±\u00a00.1 %",), ("±\u00a00.5",), (),
    ]  # fmt: skip


def test_reasons_worth_more_than_their_part_give_no_more_than_all_of_it():
    two = {"cone": Fraction(1), "area": Fraction(1)}
    half = {"cone": Fraction(1, 2)}
    assert [share_of_marks(one, two, Fraction(1)) for one in (two, half)] == [1, Fraction(1, 2)]


def test_a_value_read_off_a_plot_is_no_fraction_and_an_exposure_time_is_one():
    """Ten per cent are accepted of the first; cameras write the second so."""
    lamp = QuantitySpec(kind="quantity", value="1968/325", unit="mW", rel="12/100")
    assert KINDS["quantity"].explain_key(lamp, "en") == "6.06 mW"
    time = QuantitySpec(kind="quantity", value="1/400", unit="s")
    assert KINDS["quantity"].explain_key(time, "en") == "1/400 s"
    assert grade_answer(time, "1/400 s").verdict == "correct"
    third = NumberSpec(kind="number", value="1/3")
    assert KINDS["number"].explain_key(third, "en") == "1/3 ≈ 0.333"
    exact = NumberSpec(kind="number", value="1968/325", exact=True)
    assert KINDS["number"].explain_key(exact, "en") == "1968/325"


def test_criteria_add_up_to_what_a_paper_gives_the_part():
    drawn = builtin_bank().template("weak-perspective-when")
    solved = compose_question(drawn, 1, "en")[1].solution.parts[0]
    assert [row.points for row in solved.scheme] == [1, 1, 1]
    rescaled = [row.points for row in rescale_criteria(solved, Fraction(4)).scheme]
    assert sum(rescaled) == 4
    assert all(one % Fraction(1, 4) == 0 for one in rescaled)
    best = rescale_criteria(replace(solved, most=Fraction(2)), Fraction(3))
    assert [row.points for row in best.scheme] == [Fraction(3, 2)] * 3
    assert best.most == 3
