"""Drawn values in formulas: signs and brackets as one would write them by hand."""

from __future__ import annotations

import re

import pytest
from sweep import together

from quizgen.bank.markdown import parse_inlines
from quizgen.core.errors import RenderError
from quizgen.maths.notation import parse_formula
from quizgen.typeset import (
    lay_out,
    number,
    quantity,
    to_latex,
    to_mathml,
    to_speech,
    to_text,
    to_typst,
)
from quizgen.typeset.from_latex import lay_out_latex
from quizgen.typeset.leaves import LeafValue, fill_leaves, list_leaf_names
from quizgen.typeset.names import iter_names_written


def value(text: str) -> LeafValue:
    """A number, a quantity such as ``3 m``, or a formula such as ``f: x+1``."""
    if text.startswith("f: "):
        return LeafValue(lay_out(parse_formula(text[3:])))
    if " " in text:
        return LeafValue(quantity(*text.split(" ")))
    return LeafValue(number(text))


def filled(latex: str, *values: str) -> str:
    """A formula with the values of a and b, in plain text."""
    made = dict(zip("ab", map(value, values), strict=False))
    return to_text(fill_leaves(lay_out_latex(latex), made))


@together(
    ("latex", "a", "wanted"),
    [
        ("x - {{ a }}", "-3", "x + 3"),
        ("x - {{ a }}", "3", "x − 3"),
        ("x + {{ a }}", "-3", "x − 3"),
        ("x + {{ a }}y", "-1", "x − y"),
        ("x - {{ a }}y", "-1", "x + y"),
        ("x - {{ a }}y", "-2", "x + 2y"),
        ("-{{ a }}x", "-1", "x"),
        ("x = -{{ a }}", "4", "x = −4"),
        ("x = -{{ a }}", "-4", "x = 4"),
        ("{{ a }}x", "1", "x"),
        ("{{ a }}x", "-1", "−x"),
        ("{{ a }}x", "5", "5x"),
        (r"{{ a }}\cdot x", "1", "1·x"),
        (r"{{ a }}\sqrt{2}", "1", "√2"),
        ("{{ a }}(x + 1)", "-1", "−(x + 1)"),
        ("2 {{ a }}", "-3", "2·(−3)"),
        ("2 {{ a }}", "3", "2·3"),
        (r"2 \cdot {{ a }}", "-3", "2·(−3)"),
        ("x{{ a }}", "3", "x·3"),
        ("{{ a }}^2", "-3", "(−3)²"),
        ("{{ a }}^2", "3", "3²"),
        ("{{ a }}^2", "1/2", "(1/2)²"),
        ("{{ a }}!", "-3", "(−3)!"),
        ("x^{{ a }}", "-3", "x⁻³"),
        ("x^{{ a }}", "1", "x"),
        ("x_i^{{ a }}", "1", "xᵢ"),
        ("x^{{{ a }} + 1}", "3", "x³⁺¹"),
        ("x_{{ a }}", "3", "x₃"),
        ("|{{ a }}|", "-3", "|−3|"),
        ("f({{ a }})", "-3", "f(−3)"),
        (r"\sin {{ a }}", "-3", "sin (−3)"),
        (r"x \pm {{ a }}", "-3", "x ± (−3)"),
        ("(x - {{ a }})^2", "-3", "(x + 3)²"),
        (r"\frac{{{ a }}}{2}", "-3", "−3/2"),
        ("e^{-{{ a }}x}", "-2", "e^(2x)"),
        ("{{ a }}x", "3 m", "3 m·x"),
        ("{{ a }}^2", "3 m", "(3 m)²"),
        ("x - {{ a }}", "-3 m", "x + 3 m"),
        ("x - {{ a }}", "f: x+1", "x − (x + 1)"),
        ("2 + {{ a }}", "f: x+1", "2 + x + 1"),
        ("2 + {{ a }}", "f: -x+1", "2 + (−x + 1)"),
        ("y - {{ a }}", "f: -2*x", "y + 2·x"),
        ("{{ a }}x", "f: x+1", "(x + 1)x"),
        ("{{ a }}^2", "f: x^2", "(x²)²"),
        ("f(x) = {{ a }}", "f: x+1", "f(x) = x + 1"),
        (r"\frac{\mathrm{d}}{\mathrm{d}x} {{ a }}", "f: x^2+1", "d/(dx) (x² + 1)"),
        (r"\begin{pmatrix} {{ a }} \\ 1 \end{pmatrix}", "-3", "(−3; 1)"),
        (r"\text{for {{ a }} people}", "3", "for 3 people"),
    ],
)
def test_a_value_gets_the_sign_and_brackets_of_its_place(latex, a, wanted):
    assert filled(latex, a).replace("\u00a0", " ") == wanted


@together(
    ("typed", "a", "wanted"),
    [
        ("{{ a }}*x", "1", "x"),
        ("{{ a }}*x", "-1", "−x"),
        ("y = {{ a }}*x + 2", "-1", "y = −x + 2"),
        ("x + {{ a }}*y", "-1", "x − y"),
        ("x - {{ a }}*y", "-2", "x + 2y"),
        ("2*{{ a }}", "-3", "2 · (−3)"),
        ("2*{{ a }}", "3", "2 · 3"),
        ("{{ a }}*x", "3 m", "3 m · x"),
        ("x^{{ a }}", "-3", "x⁻³"),
        ("x/{{ a }}", "-3", "x/(−3)"),
        ("{{ a }}/x", "-3", "−3/x"),
        ("({{ a }} + x)/2", "-3", "(−3 + x)/2"),
        ("sqrt({{ a }}^2 + 1)", "-3", "√((−3)² + 1)"),
        ("s/{{ a }}", "5 m/s", "s/(5 m/s)"),
    ],
)
def test_values_in_typed_formulas_are_the_same(typed, a, wanted):
    (formula,) = parse_inlines(f"${typed}$")
    node = fill_leaves(formula.node, {"a": value(a)})
    shown = re.sub("<mo>\u2062</mo>", "", to_mathml(node)).replace("<mo>⋅</mo>", " · ")
    assert f"{to_text(node)}".replace("\u00a0", " ").replace("·", " · ") in {
        wanted, wanted.replace("2y", "2 · y"),
    }  # fmt: skip
    assert (" · " in shown) == (" · " in wanted)


@pytest.mark.parametrize(
    ("latex", "a", "b", "wanted"),
    [
        ("y = {{ a }}x + {{ b }}", "-1", "-2", "y = −x − 2"),
        ("x^2 + {{ a }}x + {{ b }}", "1", "-1", "x² + x − 1"),
        ("{{ a }} {{ b }}", "3", "-4", "3·(−4)"),
        ("[{{ a }}, {{ b }}]", "-3", "-1", "[−3, −1]"),
        (r"\frac{{{ a }}}{{{ b }}}", "3", "4", "3/4"),
    ],
)
def test_two_values_stand_side_by_side(latex, a, b, wanted):
    assert filled(latex, a, b) == wanted


def test_a_rounded_value_is_only_about_equal():
    node = fill_leaves(lay_out_latex("x = {{ a }}"), {"a": LeafValue(number("3.14"), True)})
    assert to_text(node) == "x ≈ 3.14"


def test_a_value_is_never_read_as_latex():
    from quizgen.typeset.nodes import Phrase

    value = {"a": LeafValue(Phrase(r"\frac{1}{2}_#$"))}
    node = fill_leaves(lay_out_latex(r"x + {{ a }}"), value)
    assert to_text(node) == r"x + \frac{1}{2}_#$"
    assert r"\frac" not in to_latex(node)
    assert to_typst(node) == r'x +"\\frac{1}{2}_#$"'


def test_the_names_are_those_of_the_places():
    assert list_leaf_names(lay_out_latex(r"x^{{ a }} + \sqrt{{{ b }}}")) == {"a", "b"}
    with pytest.raises(RenderError, match="'b'"):
        filled(r"x^{{ a }} + \sqrt{{{ b }}}", "1")


def test_the_letters_of_a_formula_are_spelled_as_solvers_do():
    node = lay_out_latex(r"\bar x = \frac{\mu_1 x_i'}{\sigma^a} + x_{\max} \sin b")
    assert set(iter_names_written(node)) == {"xbar", "mu_1", "x'_i", "sigma", "a", "x_max", "b"}


@pytest.mark.parametrize(("unit", "latex", "mathml", "typst", "spoken"), [
    ("J/(mol*K)", r"\mathrm{J}/(\mathrm{mol} \cdot \mathrm{K})", "<mtext>J/(mol⋅K)</mtext>",
     '"J"slash"(""mol"dot.op"K"")"', "joules per mole kelvin"),
    ("W/(m^2*K)", r"\mathrm{W}/(\mathrm{m}^{2} \cdot \mathrm{K})", "<mtext>⋅K)</mtext>",
     '"W"slash"(""m"^(2)dot.op"K"")"', "watts per square metre kelvin"),
])  # fmt: skip
def test_a_unit_is_divided_by_several(unit, latex, mathml, typst, spoken):
    shown = quantity("8.314", unit)
    assert latex in to_latex(shown)
    assert mathml in to_mathml(shown)
    assert typst in to_typst(shown)
    assert to_speech(shown).endswith(spoken)


@pytest.mark.parametrize("unit", ["J/mol)", "J(mol", "J/((mol)"])
def test_odd_brackets_are_no_unit(unit):
    with pytest.raises(RenderError):
        to_latex(quantity("1", unit))
