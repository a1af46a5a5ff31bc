"""Questions of other subjects: clean, and right by NumPy, mpmath and SymPy's other methods."""

from __future__ import annotations

from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy
from click.testing import CliRunner
from sweep import together

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.cli.main import root_group
from quizgen.kinds.grade import grade_answer
from quizgen.lint.template_checks import lint_template
from quizgen.maths.numbers import to_float
from quizgen.question.part_context import ask_part

ROOT = Path(__file__).parent.parent.parent / "examples" / "strangers"
BANK = Bank(ROOT, trusted=True)


@together("name", BANK.template_paths)
def test_every_template_is_clean(name):
    assert not lint_template(BANK.template(name), 40, BANK.languages).problems


@pytest.mark.slow
@together("name", BANK.template_paths)
def test_every_template_is_clean_in_many_draws(name):
    assert not lint_template(BANK.template(name), 300, BANK.languages).problems


def drawn(name: str, seed: int):
    variant = draw_variant(BANK.template(name), seed)
    return variant, {key: to_float(value) for key, value in variant.shown.items()}


@pytest.mark.parametrize("seed", range(5))
def test_a_derivative_is_what_differences_say(seed):
    variant, v = drawn("derivative-of-a-polynomial", seed)
    numeric = mpmath.diff(lambda x: v["a"] * x**3 + v["b"] * x**2 + v["c"] * x, v["s"])
    assert to_float(variant.values["D"]) == pytest.approx(float(numeric))
    typed = f"{v['c']:g} + 2*({v['b']:g})*x + 3*({v['a']:g})*x^2".replace("+ -", "- ")
    assert grade_answer(ask_part(variant, 0).spec, typed).verdict == "correct"


@pytest.mark.parametrize("seed", range(5))
def test_an_antiderivative_may_have_any_constant(seed):
    variant, v = drawn("antiderivative", seed)
    x = sympy.Symbol("x")
    found = sympy.integrate(sympy.expand((x - int(v["a"])) ** int(v["n"])), x)
    typed = str(found).replace("**", "^")
    assert grade_answer(ask_part(variant, 0).spec, f"{typed} + 7").verdict == "correct"
    assert grade_answer(ask_part(variant, 0).spec, f"{typed} + x").verdict == "wrong"


@pytest.mark.parametrize("seed", range(5))
def test_a_matrix_product_is_numpys(seed):
    variant, v = drawn("matrix-product", seed)
    first = np.array([[v["a"], v["b"]], [v["c"], v["d"]]])
    product = first @ np.array([[v["p"], 1], [0, v["q"]]])
    typed = "; ".join(", ".join(f"{entry:g}" for entry in row) for row in product)
    assert grade_answer(ask_part(variant, 0).spec, f"[{typed}]").verdict == "correct"
    assert to_float(variant.values["Delta"]) == pytest.approx(np.linalg.det(first))


@pytest.mark.parametrize("seed", range(5))
def test_a_product_of_complex_numbers_is_pythons(seed):
    variant, v = drawn("complex-product", seed)
    product = complex(v["a"], v["b"]) * complex(v["c"], v["d"])
    typed = f"{product.real:g} + {product.imag:g}i".replace("+ -", "- ")
    assert grade_answer(ask_part(variant, 0).spec, typed).verdict == "correct"


@pytest.mark.parametrize("seed", range(5))
def test_an_inequality_holds_inside_and_not_outside(seed):
    variant, v = drawn("absolute-inequality", seed)
    low, high = v["a"] - v["b"], v["a"] + v["b"]
    spec = ask_part(variant, 0).spec
    assert grade_answer(spec, f"x <= {low:g} or x >= {high:g}").verdict == "correct"
    assert grade_answer(spec, f"x < {low:g} or x > {high:g}").note == "trap:open"


@pytest.mark.parametrize("seed", range(5))
def test_the_quantile_of_student_cuts_off_a_fortieth(seed):
    variant, v = drawn("confidence-interval", seed)
    t, free = to_float(variant.values["t"]), v["n"] - 1
    # Student's distribution by the incomplete beta function (DLMF 8.17)
    tail = mpmath.betainc(free / 2, 0.5, 0, free / (free + t * t), regularized=True) / 2
    assert float(tail) == pytest.approx(0.025)
    assert to_float(variant.values["U"]) == pytest.approx(v["m"] + t * np.sqrt(v["v"] / v["n"]))


@pytest.mark.parametrize("seed", range(5))
def test_a_sample_is_described_as_numpy_does(seed):
    variant = draw_variant(BANK.template("median-and-quartiles"), seed)
    values = [to_float(value) for value in variant.lists["x"]]
    shown = {name: to_float(variant.shown_values[name]) for name in "meq"}
    assert shown["m"] == pytest.approx(np.mean(values))
    assert shown["e"] == np.median(values)
    assert shown["q"] == np.quantile(values, 0.75)


@pytest.mark.parametrize("seed", range(5))
def test_units_and_rates_by_hand(seed):
    variant, v = drawn("power-of-a-resistor", seed)
    assert to_float(variant.shown_values["P"]) == pytest.approx(v["U"] * v["I"])
    assert to_float(variant.shown_values["R"]) == pytest.approx(v["U"] / v["I"] * 1000)
    variant, v = drawn("phase-of-a-low-pass", seed)
    phase = -np.degrees(np.arctan(v["f"] * 1000 / v["f_c"]))
    assert to_float(variant.shown_values["phi"]) == pytest.approx(phase)
    variant, v = drawn("price-abroad", seed)
    rate = {"USD": 1.09, "GBP": 0.86, "CHF": 0.95}[variant.words["c"]]
    assert to_float(variant.values["K"]) == pytest.approx(v["n"] * v["p"] * rate)


def test_all_of_them_make_a_paper_and_an_export(tmp_path):
    run, bank = CliRunner().invoke, ("--bank", str(ROOT), "--trust")
    for topic in BANK.topics:
        out = tmp_path / topic
        made = run(root_group, ["exam", *bank, "--topic", topic, "--seed", "3", "--out", str(out)])
        assert made.exit_code == 0, made.output
        assert {"exam.html", "exam.pdf", "key.json"} <= {path.name for path in out.iterdir()}
    roster, folder = tmp_path / "roster.csv", tmp_path / "class"
    roster.write_text("id,name\n1815,Ada\n42,Ben\n", "utf-8")
    made = run(root_group, ["class", "make", str(roster), *bank, "--blueprint", "statistics.11",
                            "--out", str(folder), "--jobs", "1"])  # fmt: skip
    assert made.exit_code == 0, made.output
    first, second = sorted(path.read_text("utf-8") for path in folder.glob("data/*/*-sample.csv"))
    assert first.splitlines()[0] == second.splitlines()[0] == "x / g"
    assert first != second, "each student has numbers of their own"
    for form in ("moodle", "qti3"):
        done = run(root_group, ["export", form, *bank, "--topic", "statistics", "--seed", "3",
                                "--out", str(tmp_path / form)])  # fmt: skip
        assert done.exit_code == 0, done.output
