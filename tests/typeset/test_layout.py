"""Brackets, dots and signs: what is printed means what the tree means."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import fmpq
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from sweep import together

from quizgen.core.errors import MathError, RenderError
from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import evaluate
from quizgen.maths.tree import Call, Num, Sym, make_number
from quizgen.maths.units import SIMPLE, format_unit
from quizgen.typeset import (
    decimal,
    lay_out,
    lay_out_name,
    number,
    quantity,
    relation_chain,
    to_latex,
    to_mathml,
    to_speech,
    to_text,
    to_typst,
)
from quizgen.typeset import nodes as n
from quizgen.typeset.mathml import bold_letter
from quizgen.typeset.speech import say_unit

WRITERS = (to_latex, to_mathml, to_typst, to_speech)


# A reader of layouts, kept apart from the writers: it trusts the printed brackets alone.


def _typed(node):  # noqa: PLR0911 - one line a node
    match node:
        case n.Digits(text=text) | n.Ident(text=text):
            return text
        case n.NumberWithUnit(value=value):
            return _typed(value)
        case n.MathRow(items=items):
            signs = {"": "*", "·": "*", "neg": "-", "+": "+", "-": "-"}
            return "".join(
                signs[item.name] if isinstance(item, n.OperatorSign) else _typed(item)
                for item in items
            )
        case n.Frac(top=top, bottom=bottom, inline=True):
            return f"{_typed(top)}/{_typed(bottom)}"
        case n.Frac(top=top, bottom=bottom):
            return f"(({_typed(top)})/({_typed(bottom)}))"
        case n.Fenced(kind="()", body=body):
            return f"({_typed(body)})"
        case n.Fenced(kind="||", body=body):
            return f"abs({_typed(body)})"
        case n.Root(body=body):
            return f"sqrt({_typed(body)})"
        case n.Scripts(base=base, sub=None, sup=sup, primes=0):
            return f"{_typed(base)}^({_typed(sup)})"
    raise AssertionError(node)


def _trees():
    numbers = st.builds(
        Num, st.sampled_from([Fraction(n, d) for n in range(-3, 8) for d in (1, 3)])
    )
    decimals = st.builds(
        Num, st.sampled_from([Fraction(-3, 2), Fraction(1, 4)]), st.just(value=True)
    )
    leaves = numbers | decimals | st.sampled_from([Sym("x"), Sym("f"), Sym("a")])

    def grow(inner):
        pairs = st.tuples(inner, inner)
        power = st.tuples(inner, st.sampled_from([Num(Fraction(k)) for k in (-1, 2, 3)]))
        return st.one_of(
            st.builds(Call, st.sampled_from(["add", "sub", "mul", "div"]), pairs),
            st.builds(Call, st.sampled_from(["add", "mul"]), st.tuples(inner, inner, inner)),
            st.builds(Call, st.sampled_from(["neg", "abs"]), st.tuples(inner)),
            st.builds(Call, st.just("pow"), power),
        )

    return st.recursive(leaves, grow, max_leaves=8)


VALUES = {"x": Fraction(3, 7), "f": Fraction(-5), "a": Fraction(2)}
FLINT = {key: fmpq(value.numerator, value.denominator) for key, value in VALUES.items()}
SHOWN = {"x": number("3/7"), "f": quantity("-5", "mm"), "a": quantity("2", "m")}


@settings(max_examples=150, deadline=None)
@given(tree=_trees(), inline=st.booleans(), numbers=st.booleans())
def test_printed_brackets_keep_the_value(tree, inline, numbers):
    try:
        expected = evaluate(tree, FLINT)
    except MathError:
        assume(False)
    node = lay_out(tree, inline=inline, leaves=SHOWN if numbers else None)
    typed = _typed(node)
    assert evaluate(parse_formula(typed), FLINT) == expected, typed
    for write in WRITERS:
        assert write(node)


@together(
    ("text", "expected"),
    [
        # two numbers, or a number after anything, need a dot; a letter after a number does not
        ("3*4", r"3 \cdot 4"),
        ("3*x", "3 x"),
        ("x*3", r"x \cdot 3"),
        ("f*(x + 1)", r"f \cdot (x + 1)"),
        ("x*(1 + x)", "x (1 + x)"),
        ("2*(1/3)", r"2 \cdot \frac{1}{3}"),
        ("abs(x)*abs(y)", r"|x| \cdot |y|"),
        ("SNR*x", r"\mathrm{SNR} \cdot x"),
        ("x^2*y", "x^{2} y"),
        # a later term takes its own sign
        ("a + (-3)*b", "a - 3 b"),
        ("a + (-1)*b", "a - b"),
        ("a - (-b)", "a - (- b)"),
        ("(-1)*b", "- b"),
        ("a - (b - c)", "a - (b - c)"),
        ("1.50*x", "1.5 x"),
        ("0.00002*x", r"2 \cdot 10^{- 5} x"),
        ("0 <= x and x < 1", r"0 \leq x < 1"),
        ("x < 1 and x >= 0", r"0 \leq x < 1"),
        ("x > 1 and y > 2", r"x > 1 \text{ and } y > 2"),
        ("not (x > 1)", r"x \leq 1"),
    ],
)
def test_layout_rules(text, expected):
    assert to_latex(lay_out(parse_formula(text))) == expected


@together(
    ("symbol", "expected"),
    [
        ("p_x", "p_{x}"),
        ("p'_x", "p'_{x}"),
        ("z'_s", "z'_{s}"),
        ("k_1", "k_{1}"),
        ("k1", "k_{1}"),
        ("sigma", r"\sigma"),
        ("Delta", r"\Delta"),
        ("zbar", r"\bar{z}"),
        ("z_bar", r"\bar{z}"),
        ("Ghat", r"\hat{G}"),
        ("N_1", "N_{1}"),
        ("f_x", "f_{x}"),
        ("lambda", r"\lambda"),
        ("I_n", "I_{n}"),
        ("SNR", r"\mathrm{SNR}"),
        ("H_0", "H_{0}"),
        ("p_x1", "p_{x 1}"),
        ("I_max", r"I_{\mathrm{max} }"),
        ("I_avg", r"I_{\mathrm{avg} }"),
        ("σ", r"\sigma"),
        ("µ", r"\mu"),
        ("Delta_z", r"\Delta_{z}"),
        ("Deltaz", r"\Delta z"),
        ("sRGB2lin", r"\mathrm{sRGB2lin}"),
        ("I_8bit", r"I_{\mathrm{8bit} }"),
        ("p_x'", "p'_{x}"),
        ("z_prime", "z'"),
        ("zbar_1", r"\bar{z}_{1}"),
    ],
)
def test_names(symbol, expected):
    assert to_latex(lay_out_name(symbol)) == expected


def test_subscript_words_are_upright_and_letters_are_not():
    assert to_typst(lay_out_name("I_max")) == 'I_("max")'
    assert "<mi>max</mi>" in to_mathml(lay_out_name("I_max"))
    assert '<mi mathvariant="normal">Δ</mi>' in to_mathml(lay_out_name("Delta"))


@together("bad", ["", "_x", "x__y!", "1x", "p x", "a-b", "x_$"])
def test_names_that_cannot_be_written(bad):
    with pytest.raises(RenderError):
        lay_out_name(bad)


@together(
    ("value", "text"),
    [
        (Fraction(5, 2), "2.5"),
        (Fraction(-1, 8), "-0.125"),
        (Fraction(1, 3), "1/3"),
        (Fraction(200), "200"),
        (Fraction(1, 2000), "0.0005"),
        (Fraction(3, 200000), "1.5e-5"),
        (Fraction(-1, 10**8), "-1e-8"),
    ],
)
def test_decimals(value, text):
    assert decimal(value) == text
    assert Fraction(text) == value


@together("bad", ["", "x", "1.2.3", "--2", "1/", "nan", "1e", "1;2"])
def test_texts_that_are_not_numbers(bad):
    with pytest.raises(RenderError):
        number(bad)


def test_numbers_keep_their_digits():
    assert to_latex(number("2.50")) == "2.50"
    assert to_latex(number("−3")) == "- 3"
    assert to_latex(number(Fraction(-20, 3))) == r"- \frac{20}{3}"
    assert to_latex(number("200 000")) == r"200\,000"
    assert to_latex(quantity("6.667", "")) == "6.667"


def test_relations_count_their_sides():
    with pytest.raises(RenderError):
        relation_chain(["="], [lay_out_name("x")])
    with pytest.raises(RenderError):
        relation_chain(["=="], [lay_out_name("x"), lay_out_name("y")])


@together("unit", sorted(set(SIMPLE) - {"", "1"}))
def test_every_unit_is_printed_and_said(unit):
    for written in (unit, format_unit(unit), f"{unit}/s", f"{unit}^2"):
        node = quantity("2", written)
        for write in WRITERS:
            assert write(node) == write(quantity("2", written.replace("µ", "u")))
    assert say_unit(unit, "en").isascii()
    assert not any(char.isascii() and char.isalpha() for char in say_unit(unit, "bn"))


def test_units_as_said():
    assert say_unit("um/px", "en") == "micrometres per pixel"
    assert say_unit("um/px", "bn") == "মাইক্রোমিটার প্রতি পিক্সেল"
    assert say_unit("mm^2", "en") == "square millimetres"
    assert say_unit("lx*s", "en") == "lux seconds"
    assert say_unit("s^-1", "en") == "per second"
    assert to_speech(quantity("1", "m")) == "1 metre"
    assert to_speech(quantity("1", "m/s")) == "1 metre per second"


@pytest.mark.parametrize("unit", ["mm^", "5", "<b>", "a_b"])
def test_what_cannot_be_a_unit_is_refused(unit):
    for write in WRITERS:
        with pytest.raises(RenderError):
            write(quantity("2", unit))


@together(
    "tree",
    [
        Call("frobnicate", (Sym("x"),)),
        Call("sin", ()),
        Call("sin", (Sym("x"), Sym("y"))),
        Call("div", (Sym("x"),)),
        Call("piecewise", (Sym("x"), Sym("y"))),
        Call("add", ()),
        Call("mul", ()),
        Call("and", ()),
    ],
)
def test_unknown_operators_raise(tree):
    with pytest.raises(RenderError):
        lay_out(tree)


class Stranger:
    level = n.ATOM


@together("write", WRITERS)
@together(
    "node",
    [
        Stranger(),
        n.OperatorSign("§"),
        n.ReaderWord("unless"),
        n.Accent("wave", n.Ident("x")),
        n.Fenced("<>", n.Ident("x")),
        n.LargeOperator("⨌"),
    ],
)
def test_unknown_nodes_raise(write, node):
    with pytest.raises(RenderError):
        write(node)


def test_markup_in_names_is_inert():
    nasty = n.Word('<b>"#$%&_\\')
    assert "<b>" not in to_mathml(nasty)
    assert to_typst(nasty) == r'"<b>\"#$%&_\\"'
    assert r"\#" in to_latex(nasty)
    assert r"\$" in to_latex(nasty)


def test_bold_letters():
    import unicodedata

    for letter in "aAzZ":
        assert unicodedata.normalize("NFKC", bold_letter(letter)) == letter
    assert unicodedata.name(bold_letter("μ")) == "MATHEMATICAL BOLD SMALL MU"
    assert unicodedata.name(bold_letter("Σ")) == "MATHEMATICAL BOLD CAPITAL SIGMA"
    with pytest.raises(RenderError):
        bold_letter("ж")


K, N, ONE = Sym("k"), Sym("n"), make_number(1)


@together(
    ("tree", "text", "speech"),
    [
        (Call("factorial", (N,)), "n!", "n factorial"),
        (
            Call("factorial", (Call("sub", (N, ONE)),)),
            "(n − 1)!",
            "open bracket n minus 1 close bracket factorial",
        ),
        (Call("pow", (Call("factorial", (N,)), make_number(2))), "(n!)²", None),
        (Call("binomial", (N, K)), "C(n, k)", "n choose k"),
        (
            Call("sum", (K, ONE, N, Call("pow", (K, make_number(2))))),
            "∑ₖ₌₁ⁿ k²",
            "the sum over k equals 1 up to n of k squared",
        ),
        (Call("product", (K, ONE, N, Call("add", (K, ONE)))), "∏ₖ₌₁ⁿ (k + 1)", None),
        (Call("integral", (Sym("x"), make_number(0), ONE, Sym("x"))), "∫[0…1] x dx", None),
        (Call("mul", (make_number(2), Call("sum", (K, ONE, N, K)))), "2·∑ₖ₌₁ⁿ k", None),
    ],
)
def test_sums_and_their_kin_are_written_with_their_signs(tree, text, speech):
    node = lay_out(tree)
    assert to_text(node) == text
    assert speech is None or to_speech(node) == speech


def test_a_matrix_has_one_pair_of_brackets():
    row = Call("row", (make_number(1), make_number(2)))
    node = lay_out(Call("matrix", (row, row)))
    assert to_latex(node) == r"\begin{pmatrix} 1 & 2 \\ 1 & 2 \end{pmatrix}"
    assert to_mathml(node).count('form="prefix"') == 1
    assert to_speech(node).count("bracket") == 0


@pytest.mark.parametrize(
    ("unit", "printed"),
    [
        ("s^2", "s²"),
        ("um^2/px", "µm²/px"),
        ("kg*m^2/s^2", "kg·m²/s²"),
        ("1/s^2", "s⁻²"),
        ("1/mm", "mm⁻¹"),
        ("m^-4", "m⁻⁴"),
    ],
)
def test_powers_of_units_stand_above_the_line(unit, printed):
    assert format_unit(unit) == printed


def test_distributions_have_their_letters():
    x, m, n = map(Sym, "xmn")
    assert to_text(lay_out(Call("normal_cdf", (x,)))) == "Φ(x)"
    assert to_text(lay_out(Call("normal_quantile", (x,)))) == "Φ⁻¹(x)"
    assert to_text(lay_out(Call("t_cdf", (x, n)))) == "P(Tₙ ≤ x)"
    assert to_text(lay_out(Call("t_quantile", (x, n)))) == "t_(n; x)"
    assert to_text(lay_out(Call("f_cdf", (x, m, n)))) == "P(F_(m, n) ≤ x)"
    assert to_text(lay_out(Call("chi2_cdf", (x, n)))) == "P(χₙ² ≤ x)"
    assert to_text(lay_out(Call("besselj", (n, x)))) == "Jₙ(x)"
    assert to_text(lay_out(Call("gamma", (x,)))) == "Γ(x)"
    assert to_speech(lay_out(Call("normal_cdf", (x,)))) == "normal distribution function of x"
