"""What authors of other subjects wrote at first sight, and what they are told where it cannot be."""

from __future__ import annotations

import pytest
import sympy
from flint import fmpq
from symbolic_bank import write_questions

import quizgen
from quizgen.bank.bank import Bank
from quizgen.bank.solvers import load_chain
from quizgen.core.errors import BankError, MathError
from quizgen.lint.template_checks import lint_template
from quizgen.maths.model import Model, Step
from quizgen.paper.answer_key import make_key_question
from quizgen.paper.paper import single_question_paper


def test_an_infinite_sum_is_added_up_where_it_converges():
    a, b, k, s = sympy.symbols("a b k s", positive=True)
    chain = Model(
        given={a: "", b: ""}, steps=(Step(s, sympy.Sum((a / b) ** k, (k, 0, sympy.oo))),)
    ).chain()
    assert chain.solve({"a": fmpq(1), "b": fmpq(3)})["s"] == fmpq(3, 2)
    with pytest.raises(MathError):
        chain.solve({"a": fmpq(3), "b": fmpq(1)})


def test_an_integral_over_letters_needs_no_assumptions():
    a, x, s = sympy.symbols("a x s")
    f = sympy.Function("f")(x)
    steps = (Step(f, sympy.sin(a * x)), Step(s, sympy.Integral(f, (x, 0, sympy.pi))))
    chain = Model(given={a: ""}, free=("x",), steps=steps).chain()
    assert chain.solve({"a": fmpq(1)})["s"] == 2


def test_a_letter_is_free_or_has_a_value():
    q, p = sympy.symbols("q p")
    with pytest.raises(BankError, match=r"\['q'\] stand in free, and have a value"):
        Model(given={p: ""}, free=("q",), steps=(Step(q, p + 1), Step("r", q * p))).chain()


@pytest.mark.parametrize("formula", ["len(factorint(n))", "nsolve(x**3 - n, x, 1)"])
def test_what_needs_a_number_says_so(tmp_path, formula):
    (tmp_path / "odd.py").write_text(
        "from sympy import *\nfrom quizgen.maths.model import Model, Step\n"
        f"n, s, x = symbols('n s x')\nMODEL = Model(given={{n: ''}}, steps=(Step(s, {formula}),))\n"
    )
    said = r"odd\.py:4: ValueError: \w.*what is drawn is a letter here: docs/functions\.md"
    with pytest.raises(BankError, match=said):
        load_chain(tmp_path, "odd")


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    solvers = {
        "payments": ("""
from quizgen.maths.lists import at
f, r, V, k = symbols("f r V k")
MODEL = Model(given={f: "", r: ""}, steps=(Step(V, Sum(at(f, k)/(1 + r)**k, (k, 1, 3))),))
""", 'f = { values = ["110", "121", "133.1"] }\\nr = { pick = ["0.1"] }', ['kind = "number", of = "V", decimals = 1']),
        "pair": ("""
a, b, s, d = symbols("a b s d")
MODEL = Model(given={a: "mol/L", b: "mol/L"}, steps=(Step(s, a + b, "mol/L"), Step(d, a - b, "mol/L")))
""", 'a = { pick = [3], unit = "mol/L" }\\nb = { pick = [1], unit = "mol/L" }',
            ['kind = "table", of = { sum = "s", difference = "d" }, unit = "mol/L", rel = "0.01"']),
        "heat": ("""
Q, m, T, c = symbols("Q m T c")
MODEL = Model(given={Q: "J", m: "kg", T: "K"}, steps=(Step(c, Q/(m*T), "J/(kg*K)"),))
""", 'Q = { pick = [840], unit = "J" }\\nm = { pick = [2], unit = "kg" }\\nT = { pick = [10], unit = "K" }',
            ['kind = "quantity", of = "c", unit = "J/(kg*K)", sigfigs = 2']),
        "gas": ("""
n, T, R, w = symbols("n T R w")
MODEL = Model(given={n: "mol", T: "K", R: "J/(mol*K)"}, steps=(Step(w, n*R*T, "kJ"),))
""", 'n = { pick = [2], unit = "mol" }\\nt = { pick = [27], unit = "°C" }\\nT = { is = "t + 273.15", unit = "K" }\\nR = { pick = ["8.314"], unit = "J/(mol*K)" }',
            ['kind = "quantity", of = "w", unit = "kJ", sigfigs = 3']),
        "sawtooth": ("""
a, x = symbols("a x")
n = symbols("n", integer=True, positive=True)
MODEL = Model(given={a: ""}, free=("n",), steps=(Step("b", integrate(a*x*sin(n*x), (x, -pi, pi))/pi),))
""", "a = { pick = [2] }", ['kind = "expression", of = "b", symbols = { n = "whole" }']),
        "partial-sum": ("""
a, n, k, x = symbols("a n k x")
MODEL = Model(given={a: "", n: ""}, free=("x",), steps=(Step("s", Sum((a*x)**k/factorial(k), (k, 0, n))),))
""", "a = { pick = [2] }\\nn = { pick = [2] }", ['kind = "expression", of = "s"']),
        "confidence": ("""
m, w = symbols("m w")
MODEL = Model(given={m: "", w: ""}, steps=(Step("C", Interval(m - w*sqrt(2), m + w*sqrt(2))),))
""", "m = { pick = [10] }\\nw = { pick = [2] }", ['kind = "interval", of = "C", decimals = 2, brackets = "any"']),
    }  # fmt: skip
    return Bank(write_questions(tmp_path_factory.mktemp("walls") / "bank", solvers), trusted=True)


@pytest.mark.parametrize(("name", "typed"), [
    ("payments", "300"), ("pair", "sum = 4 mol/L; difference = 2 mol/L"),
    ("heat", "42 J/(kg K)"), ("heat", "42 J/kgK"), ("heat", "42 J/(kg·K)"), ("heat", "0.042 kJ/(kgK)"),
    ("gas", "4.99 kJ"), ("partial-sum", "1 + 2x + 2x^2"), ("sawtooth", "4(-1)^(n+1)/n"), ("sawtooth", "-4cos(n pi)/n"),
    ("confidence", "[7.17; 12.83]"), ("confidence", "(7.17, 12.83)"), ("confidence", "7.17 - 12.83"),
])  # fmt: skip
def test_right_answers_are_right(bank, name, typed):
    assert quizgen.mark_part(bank.template(name), typed).verdict == "correct"


@pytest.mark.parametrize("name", ["payments", "pair", "heat", "gas", "sawtooth"])
def test_what_is_printed_is_read_back(bank, name):
    rules = [problem.code for problem in lint_template(bank.template(name), 1).problems]
    assert not {"QG205", "QG601", "QG603"} & {*rules}


def test_bounds_are_printed_as_far_as_they_are_asked(bank):
    (part,) = make_key_question(
        single_question_paper(bank.template("confidence"), 1, "en").items[0]
    ).parts
    assert part.parse_spec().show() == "[7.17; 12.83]"


def test_a_key_of_the_file_below_a_table_is_told(bank):
    folder = bank.template_paths["pair"]
    file = folder / "template.toml"
    whole = file.read_text()
    file.write_text(whole.replace("[[part]]", 'where = ["a > b"]\n[[part]]', 1))
    with pytest.raises(BankError, match="'where' of the whole file stands above its first"):
        Bank(folder.parents[2], trusted=True).template("pair")
    file.write_text(whole)
