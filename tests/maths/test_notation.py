"""The formula grammar: what authors write, what comes back, and where errors point."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sweep import together

from quizgen.maths.notation import FUNCTIONS, FormulaReadError, format_tree, parse_formula
from quizgen.maths.operators import BINDERS
from quizgen.maths.tree import Call, Num, Sym

a, b, c = Sym("a"), Sym("b"), Sym("c")
one, two = Num(Fraction(1)), Num(Fraction(2))

TREES = {
    "a + b + c": Call("add", (a, b, c)),
    "(a + b) + c": Call("add", (Call("add", (a, b)), c)),
    "a - b + c": Call("add", (Call("sub", (a, b)), c)),
    "a - (b - c)": Call("sub", (a, Call("sub", (b, c)))),
    "a*b/c": Call("div", (Call("mul", (a, b)), c)),
    "a/b/c": Call("div", (Call("div", (a, b)), c)),
    "-a^2": Call("neg", (Call("pow", (a, two)),)),
    "-a*b": Call("neg", (Call("mul", (a, b)),)),
    "a^b^c": Call("pow", (a, Call("pow", (b, c)))),
    "a^-b": Call("pow", (a, Call("neg", (b,)))),
    "a**2": Call("pow", (a, two)),
    "{-1/2}*a": Call("mul", (Num(Fraction(-1, 2)), a)),
    "2.50": Num(Fraction(5, 2), decimal=True),
    "1e3": Num(Fraction(1000)),
    "pi": Call("pi", ()),
    "√2": Call("sqrt", (two,)),
    "√(a)*b": Call("mul", (Call("sqrt", (a,)), b)),
    "|a - b|": Call("abs", (Call("sub", (a, b)),)),
    "a < b <= c": Call("and", (Call("lt", (a, b)), Call("le", (b, c)))),
    "not a = b": Call("not", (Call("eq", (a, b)),)),
    "a > 1 and b != 2 or c >= 1": Call(
        "or",
        (
            Call("and", (Call("gt", (a, one)), Call("ne", (b, two)))),
            Call("ge", (c, one)),
        ),
    ),
    "piecewise(a, b > 1, c)": Call("piecewise", (a, Call("gt", (b, one)), c)),
    "p'_x + k_1*z'": Call("add", (Sym("p'_x"), Call("mul", (Sym("k_1"), Sym("z'"))))),
    "Delta/sigma": Call("div", (Sym("Delta"), Sym("sigma"))),
}


@together("text", TREES)
def test_author_notation(text):
    assert parse_formula(text) == TREES[text]


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("fX/Z", "f*X/Z"),
        ("2f X", "2*f*X"),
        ("r(1+k_1 r^2)", "r*(1+k_1*r^2)"),
        ("2 sqrt(f)", "2*sqrt(f)"),
        ("(f)(X)", "f*X"),
    ],
)
def test_juxtaposition_of_declared_names(text, same):
    declared = {"f", "X", "Z", "r", "k_1"}
    assert parse_formula(text, symbols=declared) == parse_formula(same, symbols=declared)


@together(
    ("text", "code", "column"),
    [
        ("", "empty", 1),
        ("a +", "unfinished", 4),
        ("(a", "unfinished", 3),
        ("a)", "unexpected", 2),
        ("a $ b", "bad-character", 3),
        ("2 3", "unexpected", 3),
        ("a/b c", "two-readings", 5),
        ("h + 1", "unknown-name", 1),
        ("sin(a, b)", "argument-count", 1),
        ("1e99999", "number-too-large", 1),
        ("1" * 61, "number-too-long", 1),
        ("(" * 1900 + "a" + ")" * 1900, None, None),
        ("sqrt(" * 200 + "a" + ")" * 200, "too-deep", 1),
        ("a" * 5000, "too-long", 4001),
    ],
)
def test_errors_carry_reason_and_column(text, code, column):
    if code is None:
        assert parse_formula(text, symbols="abc") == a
        return
    with pytest.raises(FormulaReadError) as caught:
        parse_formula(text, symbols="abc")
    assert (caught.value.code, caught.value.column) == (code, column)


SIGNS = ["AND", "JOIN", "MINUS", "OR", "PLUS", "POWER", "RELATION", "SLASH", "TIMES"]
TERM = ["CONSTANT", "FUNCTION", "LBAR", "LPAR", "NAME", "NUMBER", "ROOT"]


@together(
    ("text", "expected"),
    [
        ("a +", [*TERM, "MINUS", "PLUS"]),
        ("not", [*TERM, "MINUS", "NOT", "PLUS"]),
        ("a = not b", [*TERM, "MINUS", "PLUS"]),
        ("a^*b", [*TERM, "MINUS", "PLUS"]),
        ("√-a", TERM),
        ("(a", ["RPAR"]),
        ("|a", ["RBAR"]),
        ("max(a + b", ["COMMA", "RPAR"]),
        ("(a, b)", ["RPAR"]),
        ("a, b", ["$END"]),
        ("(a not b)", [*SIGNS, "RPAR"]),
        ("sin(a, b) not c", ["$END", *SIGNS]),
    ],
)
def test_errors_name_what_could_have_stood_there(text, expected):
    with pytest.raises(FormulaReadError) as caught:
        parse_formula(text)
    assert list(caught.value.expected) == sorted(expected)


@together(
    ("text", "same"),
    [
        ("-a^-b^c", "-(a^(-(b^c)))"),
        ("a*-b*c", "a*(-b)*c"),
        ("a - -b*c", "a - (-(b*c))"),
        ("√a^2", "(√a)^2"),
        ("not a < b and c < a", "(not (a < b)) and (c < a)"),
        ("a or b and not c or a", "a or (b and (not c)) or a"),
        ("+a", "a"),
        ("2^+a", "2^a"),
    ],
)
def test_what_binds_tighter(text, same):
    assert parse_formula(text) == parse_formula(same)


def test_without_declared_names_nothing_is_guessed():
    assert parse_formula("foo + 1") == Call("add", (Sym("foo"), one))
    for text in ("foo(1)", "a b"):
        with pytest.raises(FormulaReadError):
            parse_formula(text)


NUMBERS = st.fractions(max_denominator=10**6).flatmap(
    lambda q: st.builds(Num, st.just(q), st.booleans())
)
NAMES = st.sampled_from(["f", "X", "k_1", "p'_x", "z'", "Delta", "min", "pi", "and", "σ"])
LEAVES = NUMBERS | st.builds(Sym, NAMES)


def _calls(inner):
    two_args = st.tuples(inner, inner)
    several = st.lists(inner, min_size=2, max_size=4).map(tuple)
    named = [
        st.builds(
            Call,
            st.just(name),
            st.lists(inner, min_size=low, max_size=min(high, low + 2) if low != 3 else 3).map(
                tuple
            ),
        )
        for name, (low, high) in FUNCTIONS.items()
        if name not in BINDERS
    ]
    bound = st.tuples(st.builds(Sym, NAMES), inner, inner, inner)  # a sum begins with a name
    named += [st.builds(Call, st.just(name), bound) for name in sorted(BINDERS)]
    return st.one_of(
        st.builds(Call, st.sampled_from(["add", "mul", "and", "or"]), several),
        st.builds(
            Call,
            st.sampled_from(["sub", "div", "pow", "eq", "ne", "lt", "le", "gt", "ge"]),
            two_args,
        ),
        st.builds(Call, st.sampled_from(["neg", "not"]), st.tuples(inner)),
        *named,
    )


@settings(max_examples=200, deadline=None)
@given(st.recursive(LEAVES, _calls, max_leaves=12))
def test_written_text_reads_as_the_same_tree(tree):
    assert parse_formula(format_tree(tree)) == tree
