"""Questions whose steps are any SymPy: drawn, linted, printed, typed back, marked."""

from __future__ import annotations

import math

import pytest
import scipy.integrate
import scipy.stats
import sympy
from flint import fmpq
from symbolic_bank import SOLVERS, write_bank

from quizgen.bank.bank import Bank
from quizgen.bank.solvers import load_chain
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError
from quizgen.kinds.grade import grade_answer
from quizgen.lint.template_checks import lint_template
from quizgen.maths.model import Model, Step
from quizgen.maths.notation import format_tree
from quizgen.maths.number_systems import evaluate
from quizgen.maths.numbers import to_float
from quizgen.question.part_context import ask_part

SEEDS = 12


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    return Bank(write_bank(tmp_path_factory.mktemp("symbolic") / "bank"), trusted=True)


def test_what_follows_from_a_wrong_formula_is_its_mistake_too():
    x, a, c, slope = sympy.symbols("x a c D")
    f, df = sympy.Function("f")(x), sympy.Function("df")(x)
    chain = Model(
        given={a: "", c: ""},
        free=("x",),
        steps=(
            Step(f, sympy.sin(a * x)),
            Step(df, sympy.diff(f, x)),
            Step("ddf", sympy.diff(df, x)),
            Step(slope, df.subs(x, c)),
        ),
        traps={"inner": Step(df, sympy.cos(a * x))},
    ).chain()
    given = {"a": fmpq(3), "c": fmpq(1, 2)}
    solved = chain.solve(given)
    wrong = chain.solve_with_misconception("inner", solved)
    assert to_float(solved["D"]) == pytest.approx(3 * math.cos(1.5))
    assert to_float(wrong["D"]) == pytest.approx(math.cos(1.5))
    assert [step.name for step in chain.form_traps["inner"]] == ["df", "ddf"]
    assert chain.required_forms(chain.steps) == ["f", "df"]
    assert chain.required_forms(chain.steps, {"df"}) == []


@pytest.mark.parametrize("name", SOLVERS)
def test_lint_finds_nothing(bank, name):
    report = lint_template(bank.template(name), SEEDS)
    assert [str(problem) for problem in report.problems] == []


def asked(bank, name, part=0, seed=3):
    drawn = draw_variant(bank.template(name), seed)
    return drawn, ask_part(drawn, part).spec


def note(spec, typed):
    verdict = grade_answer(spec, typed)
    return verdict.verdict, verdict.note


def test_a_derivative_is_that_of_sympy_and_may_be_written_otherwise(bank):
    drawn, spec = asked(bank, "derivative")
    a, b, x = int(drawn.shown["a"]), int(drawn.shown["b"]), sympy.Symbol("x")
    key = sympy.diff(a * x**3 * sympy.exp(b * x), x)
    assert grade_answer(spec, str(sympy.factor(key))).verdict == "correct"
    assert note(spec, f"{3 * a}*x^2*exp({b}*x)") == ("wrong", "trap:first")


def test_a_number_may_come_from_a_formula(bank):
    drawn, _ = asked(bank, "derivative")
    a, b, c = (int(drawn.shown[name]) for name in "abc")
    x = sympy.Symbol("x")
    key = sympy.diff(a * x**3 * sympy.exp(b * x), x).subs(x, c)
    assert to_float(drawn.values["D"]) == pytest.approx(float(key), rel=1e-12)


@pytest.mark.parametrize("tail", ["", " + C", " + 7", " - C"])
def test_an_antiderivative_is_right_up_to_a_constant(bank, tail):
    drawn, spec = asked(bank, "antiderivative")
    a, b = (int(drawn.shown[name]) for name in "ab")
    assert note(spec, f"{a}/3*x^3 + {b}*sin(x){tail}") == ("correct", "")
    assert note(spec, f"{a}/3*x^3 - {b}*sin(x){tail}") == ("wrong", "trap:sign")


def test_a_product_must_be_factored(bank):
    drawn, spec = asked(bank, "factors")
    p, q = (int(drawn.shown[name]) for name in "pq")
    assert note(spec, f"(x + {q})(x - {p})") == ("correct", "")
    assert note(spec, f"x^2 + {q - p}x - {p * q}")[1] == "form-factored"
    assert note(spec, f"(x - {q})(x + {p})") == ("wrong", "trap:signs")


def test_a_matrix_is_judged_by_entry(bank):
    drawn, spec = asked(bank, "matrix")
    a, b, c = (int(drawn.shown[name]) for name in "abc")
    product = (sympy.Matrix([[a, b], [1, c]]) * sympy.Matrix([[2, 0], [a, 1]])).tolist()
    (p, q), (r, s) = product
    for typed in (f"[{p}, {q}; {r}, {s}]", f"{p} {q}\n{r} {s}", f"[[{p},{q}],[{r},{s}]]",
                  rf"\begin{{pmatrix}}{p}&{q}\\{r}&{s}\end{{pmatrix}}"):  # fmt: skip
        assert note(spec, typed) == ("correct", ""), typed
    assert note(spec, f"[{p}, {r}; {q}, {s}]") == ("wrong", "transposed")
    assert note(spec, f"[{p}, {q}; {r}, {s + 1}]")[1] == "matrix-row"
    assert note(spec, f"[{p}, {q}]")[1] == "matrix-size"
    assert note(spec, f"[{p}, {q}; {r}]") == ("unreadable", "matrix-expected")


def test_a_determinant_and_an_inverse_are_computed_from_the_matrix(bank):
    drawn, spec = asked(bank, "matrix", part=2)
    a, b, c = (int(drawn.shown[name]) for name in "abc")
    matrix = sympy.Matrix([[a, b], [1, c]])
    assert drawn.values["d"] == int(matrix.det())
    rows = matrix.inv().tolist()
    assert note(spec, "; ".join(", ".join(map(str, row)) for row in rows))[0] == "correct"
    rounded = "; ".join(", ".join(f"{float(x):.3f}" for x in row) for row in rows)
    assert note(spec, rounded)[0] == "correct"
    assert note(spec, rounded.replace(".", ".1", 1))[0] == "partial"


def test_a_multiple_of_a_vector_counts_if_asked(bank):
    drawn, spec = asked(bank, "matrix", part=3)
    v = [int(drawn.shown[name]) for name in "abc"]
    assert note(spec, f"({'; '.join(str(-3 * x) for x in v)})") == ("correct", "")
    assert note(spec, "(0; 0; 0)")[0] == "wrong"
    assert note(spec, f"({v[0]}; {v[1]}; {v[2] + 1})")[0] == "wrong"


def test_a_union_may_be_typed_as_conditions(bank):
    drawn, spec = asked(bank, "solutions")
    p, q = (int(drawn.shown[name]) for name in "pq")
    for typed in (f"x <= -{p} or x > {q}", f"(-inf, -{p}] ∪ ({q}, inf)", f"]{q}; ∞[ U ]-∞; -{p}]"):
        assert note(spec, typed) == ("correct", ""), typed
    assert note(spec, f"x <= -{p} or x >= {q}") == ("partial", "trap:closed")
    assert note(spec, f"x <= -{p}")[1] == "interval-count"
    assert note(spec, f"x < -{p} or x > {q}")[1] == "union-brackets"


def test_an_equation_is_right_up_to_a_factor(bank):
    drawn, spec = asked(bank, "solutions", part=3)
    p, q = (int(drawn.shown[name]) for name in "pq")
    assert note(spec, f"2*(x - {p})^2 + 2*y^2 - {2 * q * q} = 0") == ("correct", "")
    assert note(spec, f"(x - {p})^2 + y^2 = {q}") == ("wrong", "trap:radius")
    assert note(spec, f"(x + {p})^2 + y^2 = {q * q}")[0] == "wrong"
    assert note(spec, f"x^2 + y^2 + {p}") == ("unreadable", "equation-expected")


def test_a_complex_number_has_the_form_asked(bank):
    drawn, spec = asked(bank, "complex")
    a, b = (int(drawn.shown[name]) for name in "ab")
    real, imaginary = a * a - b * b, 2 * a * b
    assert note(spec, f"{real} + {imaginary}i") == ("correct", "")
    assert note(spec, f"({a} + {b}i)^2")[1] == "form-cartesian"
    assert note(spec, f"{real} - {imaginary}i") == ("wrong", "conjugate")
    _, polar = asked(bank, "complex", part=3)
    assert note(polar, f"sqrt({a * a + b * b})*exp(i*atan({b}/{a}))") == ("correct", "")
    assert note(polar, f"{a} + {b}i")[1] == "form-polar"


def test_exact_keys_are_printed_exactly(bank):
    drawn, spec = asked(bank, "complex", part=1, seed=1)
    a, b = (int(drawn.shown[name]) for name in "ab")
    assert note(spec, f"sqrt({a * a + b * b})") == ("correct", "")
    assert "." not in spec.show()


def test_quantiles_sums_and_integrals_are_those_of_scipy(bank):
    drawn, _ = asked(bank, "statistics")
    n, p = int(drawn.shown["n"]), to_float(drawn.shown["p"])
    t, w, s = (to_float(drawn.values[name]) for name in "tws")
    assert t == pytest.approx(scipy.stats.t.ppf(0.975, n - 1), rel=1e-12)
    assert w == pytest.approx(scipy.stats.binom.cdf(2, n, p), rel=1e-12)
    integral, _ = scipy.integrate.quad(lambda k: sympy.exp(-p * k * k), 0, 1)
    assert s == pytest.approx(integral, rel=1e-12)
    assert drawn.template.chain.certainties == {"t": "ball", "w": "ball", "s": "checked"}


def test_sympy_computes_where_formulas_stay_as_they_are_written(tmp_path):
    (tmp_path / "mixed.py").write_text("""
from sympy import *
from quizgen.maths.model import Model, Step
a, x = symbols("a x")
with evaluate(False):
    MODEL = Model(given={a: ""}, free=("x",), steps=(
        Step("d", diff(a*x**3 + cos(2*x), x)),
        Step("i", integrate(a*x**2 + 1, x)),
        Step("m", Matrix([[a, 2], [1, 3]]).det() + 1*a),
        Step("s", solve(a*x - 6, x)[0]),
        Step("e", expand((x + a)**2)),
    ))
""")
    chain, _ = load_chain(tmp_path, "mixed")
    steps = {step.name: step.expr for step in (*chain.forms, *chain.steps)}
    assert format_tree(steps["m"]).endswith("1*a")
    at = {
        name: to_float(evaluate(tree, {"a": fmpq(5), "x": fmpq(2)})) for name, tree in steps.items()
    }
    wanted = {"d": 60 - 2 * math.sin(4), "i": 40 / 3 + 2, "m": 18, "s": 6 / 5, "e": 49}
    assert at == pytest.approx(wanted)


def test_a_mistake_without_a_certain_value_is_left_out(bank):
    """``acos`` of a product of roots over itself: a ball across 1."""
    seen = set()
    for seed in range(8):
        drawn, spec = asked(bank, "edge", seed=seed)
        a, b = (int(drawn.shown[name]) for name in "ab")
        angle = math.acos((a * b + 2) / math.hypot(a, 1) / math.hypot(b, 2))
        assert note(spec, f"{angle:.3f} rad") == ("correct", "")
        seen |= {*spec.traps}
    assert "first" in seen


def test_what_sympy_needs_evaluated_is_computed():
    k, n = sympy.symbols("k n")
    with sympy.evaluate(False):
        model = Model(
            given={n: ""},
            steps=(
                Step("d", sympy.Subs(sympy.Derivative(k**3, k), k, n)),
                Step("L", sympy.Limit(sympy.sin(n * k) / k, k, 0)),
                Step("G", sympy.Sum(1 / n**k, (k, 0, 3))),
            ),
        )
    texts = [format_tree(step.expr) for step in model.chain().steps]
    assert texts[:2] == ["3*n^2", "n"]


def test_a_form_that_no_step_defines_is_refused(tmp_path):
    folder = write_bank(tmp_path / "bank", "matrix")
    rules = folder / "templates" / "any" / "matrix" / "template.toml"
    rules.write_text(rules.read_text().replace('of = "P"', 'of = "Q"'))
    with pytest.raises(BankError, match="'Q' is no formula, matrix or set of the solver"):
        draw_variant(Bank(folder, trusted=True).template("matrix"), 0)
