"""Strangers' questions of cells, checks and texts: right by NumPy, by insertion, by truth tables."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.kinds.grade import grade_answer
from quizgen.maths.numbers import to_float
from quizgen.question.compose import compose_variant
from quizgen.question.part_context import ask_part
from quizgen.question.solution import inlines_to_plain

BANK = Bank(Path(__file__).parent.parent.parent / "examples" / "strangers", trusted=True)


def draw(name: str, seed: int):
    return draw_variant(BANK.template(name), seed)


def grade(variant, typed: str, part: int = 0):
    return grade_answer(ask_part(variant, part).spec, typed)


@pytest.mark.parametrize("seed", range(6))
def test_quartiles_and_shape_are_what_numpy_says(seed):
    one = draw("shape-of-a-sample", seed)
    x = np.array([to_float(value) for value in one.lists["x"]])
    quartiles = np.quantile(x, [0.25, 0.5, 0.75])
    for part, value in enumerate(quartiles, 3):
        assert grade(one, f"{value:.4f}", part).verdict == "correct"
        near = value + 0.9 * np.ptp(x) / 50
        assert grade(one, f"{near:.4f}", part).verdict == "correct"
        assert grade(one, f"{value + 0.1 * np.ptp(x):.4f}", part).verdict == "wrong"
    fence = 1.5 * (quartiles[2] - quartiles[0])
    outside = (x > quartiles[2] + fence).any() or (x < quartiles[0] - fence).any()
    assert grade(one, "B" if outside else "A", 2).verdict == "correct"


@pytest.mark.parametrize(
    ("typed", "credit"),
    [
        ("y = C1 + C2 sin({w}x) + C3 cos({w} x)", 1),
        ("a + b e^(0) + c sin({w}x)", 0.5),
        ("C1 + C2 cos({w}x + 1) + C3 cos({w}x - 1)", 1),
        ("C1 + C2 sin({w}x)", 0.5),
        ("sin({w}x)", 0),
        ("C1 + C2 x", 0),
        ("C1 + C2 e^({w}x) + C3 e^(-{w}x)", 0),
    ],
)
def test_a_general_solution_is_judged_by_insertion_and_independence(typed, credit):
    one = draw("general-solution", 2)
    w = int(one.shown["w"])
    assert float(grade(one, typed.format(w=w)).credit) == credit
    assert one.shown["c"] == w**2


@pytest.mark.parametrize("seed", range(3))
def test_any_function_with_the_properties_is_right(seed):
    one = draw("three-properties", seed)
    b, m = int(one.shown["b"]), int(one.shown["m"])
    assert grade(one, f"{b} + ({m})*x^3/3").verdict == "correct"
    assert grade(one, f"{b - 1} + 1*cos(0) + ({m})*x^2/2").verdict == "correct"
    kink = grade(one, f"{b} + abs(x)")
    assert kink.note == "trap:stationary"
    assert float(grade(one, f"{b} + ({m}) x").credit) == pytest.approx(2 / 3)
    assert grade(one, "smooth").verdict == "unreadable"


@pytest.mark.parametrize("seed", range(4))
def test_any_expression_of_the_truth_table_is_right(seed):
    one = draw("expression-of-a-table", seed)
    rows = [int(value) for value in one.lists["value"]]
    signs = [[f"¬{n}" if not (7 - place) >> (2 - i) & 1 else n for i, n in enumerate("pqr")]
             for place in range(8)]  # fmt: skip
    terms = ["(" + "∧".join(row) + ")" for row, value in zip(signs, rows, strict=True) if value]
    assert grade(one, " ∨ ".join(terms)).verdict == "correct"
    assert grade(one, " || ".join(t.replace("∧", "&").replace("¬", "!") for t in terms)).credit == 1
    assert grade(one, f"not ({' ∨ '.join(terms)})").note == "trap:negated"
    assert grade(one, " ∨ ".join(terms[1:]) or "p ∧ ¬p").note == "trap:one-row"
    for nonsense in ("p and", "p q", "(p", "p)", "pp", "import os", "p and or q"):
        assert grade(one, nonsense).verdict == "unreadable"


@pytest.mark.parametrize("seed", range(5))
def test_the_state_on_the_map_has_its_own_code(seed):
    one = draw("capital-of-a-region", seed)
    file = BANK.folder_of("capital-of-a-region") / "regions.csv"
    rows = dict(line.split(",")[:2] for line in file.read_text("utf-8").splitlines()[1:])
    states = one.text_list("state")
    here = states[int(one.shown["k"]) - 1]
    assert grade(one, rows[here], 1).verdict == "correct"
    assert grade(one, "ABCD"[int(one.shown["k"]) - 1]).verdict == "correct"
    other = rows[states[int(one.shown["k"]) % 4]]
    assert grade(one, other, 1).verdict == "wrong"


@pytest.mark.parametrize(
    ("name", "hint", "why"),
    [
        ("power-of-a-resistor", "Voltage times current: P.", "Voltage times current: {} mW."),
        ("antiderivative", "The power rises by one and divides: F.", ""),
    ],
)
def test_a_hint_names_what_the_solution_says(name, hint, why):
    one = draw(name, 3)
    solved = compose_variant(one, "en")[1].solution
    step = solved.parts[0].lines[-1]
    assert inlines_to_plain(step.hints[0].why) == hint
    if why:
        power = one.shown["U"] * one.shown["I"]
        assert inlines_to_plain(step.why) == why.format(power)
    assert inlines_to_plain(step.why) != hint
