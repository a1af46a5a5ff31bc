"""Every operator of the table is known wherever formulas go, or is declared absent there."""

from __future__ import annotations

import math
import subprocess
import sys

import pytest
import sympy
from sweep import together

from quizgen.maths import number_systems
from quizgen.maths.from_sympy import from_sympy
from quizgen.maths.notation import format_tree, parse_formula
from quizgen.maths.operators import (
    BINDERS,
    CONDITIONS,
    DISTRIBUTIONS,
    FURTHER,
    SYSTEMS,
    OperatorSyntax,
)
from quizgen.maths.operators import OPERATORS as TABLE
from quizgen.maths.tree import Call, Sym, make_number
from quizgen.typeset import lay_out, to_latex, to_mathml, to_speech, to_typst

BUILT = {
    "exact": number_systems.exact_system(),
    "floats": number_systems.float64_system(),
    "arrays": number_systems.array_system(64),
    "sympy": number_systems.sympy_system(),
}

X, Y = 0.75, 0.375  # exact in binary
OPERATORS = {name: row for name, row in TABLE.items() if row.typed is not OperatorSyntax.LIST}
"""Operators of numbers; ``test_lists`` has those of lists."""
VALUED = [name for name in OPERATORS if name not in FURTHER]
"""Those that have a value at any number; ``test_further`` has the others."""
VALUES = {
    "add": X + Y, "sub": X - Y, "mul": X * Y, "div": 2.0, "neg": -X, "abs": X,
    "pow": 0.421875, "sqrt": 0.8660254037844386, "exp": 2.117000016612675,
    "ln": -0.2876820724517809, "log2": -0.4150374992788438, "log10": -0.1249387366082999,
    "sin": 0.6816387600233341, "cos": 0.7316888688738209, "tan": 0.9315964599440725,
    "asin": 0.848062078981481, "acos": 0.7227342478134157, "atan": 0.6435011087932844,
    "atan2": 1.1071487177940904, "erf": 0.7111556336535151, "erfc": 0.28884436634648487,
    "sign": 1.0, "floor": 0.0, "ceil": 1.0, "round": 1.0, "mod": 0.0, "min": Y, "max": X,
    "pi": math.pi, "eq": False, "ne": True, "lt": False, "le": False, "gt": True, "ge": True,
    "and": True, "or": True, "not": False, "piecewise": X,
    "sinh": 0.82231673193582998, "cosh": 1.2946832846768447, "tanh": 0.63514895238728732,
    "asinh": 0.69314718055994531, "acosh": 1.1588103604299468, "atanh": 0.97295507452765665,
    "sec": 1.3667011246722261, "csc": 1.4670527244750101, "cot": 1.0734261485493774,
    "factorial": 0.91906252684888323, "gamma": 1.2254167024651776, "erfinv": 0.81341984759761854,
    "zeta": -3.4412853869452229, "binomial": 1.1631239206755094, "beta": 3.0844646770030915,
    "besselj": 0.30384292761693685, "bessely": -1.4829648879462711,
    "besseli": 0.31629980132089778, "besselk": 1.7543403981447849,
    "lambertw": 0.46915021069498823, "lowergamma": 0.54746337649881262,
    "uppergamma": 0.67795332596636502, "normal_cdf": 0.7733726476231318,
    "normal_quantile": 0.67448975019608174, "t_cdf": 0.64714096414896522,
    "t_quantile": 2.1457942046790832, "chi2_cdf": 0.85435919656472034,
    "chi2_quantile": 0.31760272348248694, "f_cdf": 0.58506623593746616,
    "f_quantile": 4.6024408202570962, "sum": 2.25, "product": 0.31640625, "integral": 1.5,
}  # fmt: skip
"""Each operator at (0.75, 0.375), printed by mpmath where it is not arithmetic."""


def example(name: str) -> Call:
    x, y = Sym("x"), Sym("y")
    more, less = Call("gt", (x, y)), Call("lt", (x, y))
    special = {
        "pow": (x, make_number(3)),
        "piecewise": (x, more, y),
        "and": (more, more),
        "or": (less, more),
        "not": (more,),
        "acosh": (Call("add", (x, make_number(1))),),
        **dict.fromkeys(BINDERS, (x, make_number(1), make_number(3), Call("mul", (x, y)))),
    }
    row = OPERATORS[name]
    return Call(name, special.get(name, (x, y, x)[: max(row.least, min(2, row.most))]))


def close(found, expected) -> bool:
    if isinstance(expected, bool):
        return bool(found) is expected
    return math.isclose(float(found), expected, rel_tol=1e-14)


def runs(name: str, system: str) -> bool:
    """Whether a system runs an operator: ``piecewise`` runs everywhere that conditions do."""
    if name in BINDERS:
        return system in {"exact", "floats"}
    if name in DISTRIBUTIONS and system == "sympy":
        return False  # SymPy carries them as names
    return name == "piecewise" or system not in OPERATORS[name].absent


def test_examples_cover_the_table():
    assert set(VALUES) == set(VALUED)
    assert set(BUILT) == set(SYSTEMS)


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_system_knows_what_the_table_says(system):
    declared = {name for name, row in TABLE.items() if system not in row.absent}
    assert set(BUILT[system].ops) == declared


@together(
    ("name", "system"),
    [(name, system) for name in VALUED for system in SYSTEMS if runs(name, system)],
)
def test_every_system_finds_the_same_value(name, system):
    built = BUILT[system]
    env = {
        "x": built.constant(make_number("0.75").value),
        "y": built.constant(make_number("0.375").value),
    }
    assert close(number_systems.compile_expr(example(name), built)(env), VALUES[name])


@together("name", ["add", "mul", "min", "max"])
@together("system", SYSTEMS)
def test_operators_of_many_arguments_fold(name, system):
    built = BUILT[system]
    args = tuple(make_number(text) for text in ("3", "-2", "0.5"))
    expected = {"add": 1.5, "mul": -3.0, "min": -2.0, "max": 3.0}[name]
    assert close(number_systems.compile_expr(Call(name, args), built)({}), expected)


@together("name", ["min", "max"])
@together("system", SYSTEMS)
def test_the_least_of_one_is_itself(name, system):
    assert close(
        number_systems.compile_expr(Call(name, (make_number("0.5"),)), BUILT[system])({}), 0.5
    )


@together("system", SYSTEMS)
@together(("text", "expected"), [("-2.5", -3), ("2.5", 3), ("-0.4", 0)])
def test_rounding_is_half_away_from_zero_everywhere(system, text, expected):
    assert close(
        number_systems.compile_expr(Call("round", (make_number(text),)), BUILT[system])({}),
        expected,
    )


@together("name", OPERATORS)
def test_what_is_written_reads_as_the_same_tree(name):
    assert parse_formula(format_tree(example(name)), symbols=("x", "y")) == example(name)


@together(("name", "sign"), [(name, sign) for name, row in OPERATORS.items() for sign in row.signs])
def test_every_sign_is_read(name, sign):
    row = OPERATORS[name]
    text = {0: sign, 1: f"{sign} x"}.get(row.most, f"x {sign} y")
    if row.name == "not":
        text = "not x > y"
    read = parse_formula("x > y " + sign + " x > y" if row.name in {"and", "or"} else text)
    assert read.op == name


@together("name", OPERATORS)
def test_every_printer_writes_it(name):
    laid_out = lay_out(example(name))
    printed = [to_latex(laid_out), to_mathml(laid_out), to_typst(laid_out)]
    spoken_both = [to_speech(laid_out, lang) for lang in ("en", "bn")]
    assert all(printed)
    assert all(spoken_both)
    assert spoken_both[0] != spoken_both[1] or name in {"log2", "log10"}


@together("name", VALUED)
def test_sympy_reads_back_what_it_was_given(name):
    if name == "piecewise":
        x, y = sympy.symbols("x y")
        built = sympy.Piecewise((x, x > y), (y, True))
    elif name in BINDERS:
        x, y = sympy.symbols("x y")
        kinds = {"sum": sympy.Sum, "product": sympy.Product, "integral": sympy.Integral}
        built = kinds[name](x * y, (x, 1, 3))
    else:
        env = {n: sympy.Symbol(n, real=True) for n in ("x", "y")}
        with sympy.evaluate(False):
            built = number_systems.compile_expr(example(name), number_systems.sympy_system())(env)
    again = number_systems.compile_expr(from_sympy(built), number_systems.float64_system())(
        {"x": X, "y": Y}
    )
    assert close(again, VALUES[name])


def test_conditions_give_true_or_false():
    assert {name for name, value in VALUES.items() if isinstance(value, bool)} == CONDITIONS


@pytest.mark.parametrize(("use", "without"), [
    ("import quizgen.maths.operators", {"flint", "numpy", "sympy", "mpmath"}),
    ("from quizgen.maths.number_systems import float64_system; float64_system()", {"numpy", "sympy", "mpmath"}),
    ("from quizgen.maths.number_systems import exact_system; exact_system()", {"numpy", "sympy", "mpmath"}),
])  # fmt: skip
def test_a_number_system_loads_only_its_own_library(use, without):
    run = subprocess.run(
        [sys.executable, "-c", f"import sys; {use}; print(*sys.modules)"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert not without & set(run.stdout.split())
