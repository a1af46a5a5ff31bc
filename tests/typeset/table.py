"""The formulas of the golden table: F01 to F46 of the chapter, then one entry per typesetting rule.

``python -m tests.typeset.table`` writes ``golden.toml`` anew; read the difference before keeping it.
"""

from __future__ import annotations

import sys
from pathlib import Path

from quizgen.maths.notation import parse_formula
from quizgen.typeset import (
    add_brackets,
    comma_list,
    fence,
    lay_out,
    lay_out_name,
    lay_out_power,
    negative,
    number,
    quantity,
    relation_chain,
    to_latex,
    to_mathml,
    to_speech,
    to_typst,
)
from quizgen.typeset.nodes import (
    ATOM,
    PRODUCT,
    SUM,
    Cases,
    Digits,
    Frac,
    Func,
    Ident,
    LargeOperator,
    MathRow,
    Matrix,
    Node,
    OperatorSign,
    ReaderWord,
    Root,
    Scripts,
    Under,
    Word,
)

GOLDEN = Path(__file__).with_name("golden.toml")

FORMULAS = {
    "F01 samples": "W*H*C*b",
    "F01 levels": "L = 2^b",
    "F03 one wavelength": "B = K_m*P*V_lambda",
    "F05 x": "p'_x = f*p_x/p_z",
    "F05 y": "p'_y = f*p_y/p_z",
    "F07 scale": "b/a*p'_x",
    "F08 density": "m = 1/p",
    "F08 pixels": "f_x = m_x*f",
    "F09 column": "u = f_x*p_x/p_z + o_x",
    "F09 row upwards": "v = o_y - f_y*p_y/p_z",
    "F10 depth": "p_z = f*p_y/p'_y",
    "F10 focal length": "f = p'_y*p_z/p_y",
    "F11 range": "N = (N_max - N_min)/(I_max - I_min)*(I - I_min) + N_min",
    "F12 unit range": "I_n = (I - I_min)/(I_max - I_min)",
    "F13 clamp": "max(N_min, min(N_max, N))",
    "F14 noise": "I_noisy = I + n",
    "F15 density": "g = exp(-(n - mu)^2/(2*sigma^2))/(sqrt(2*pi)*sigma)",
    "F16 peak": "1/(sqrt(2*pi)*sigma)",
    "F16 peak number": "0.39894/sigma",
    "F17 plane": "exp(-(x^2 + y^2)/(2*sigma^2))/(2*pi*sigma^2)",
    "F18 within": "erf(k/sqrt(2))",
    "F19 count": "M*P",
    "F19 tail": "q = erfc(z/sqrt(2))/2",
    "F19 score": "z = (t - mu)/sigma",
    "F20 distorted": "x_d = x*(1 + k_1*r^2 + k_2*r^4)",
    "F20 monotone": "1 + 3*k_1*r^2 + 5*k_2*r^4 > 0",
    "F21 radius": "r^2 = x^2 + y^2",
    "F22 fold": "r_fold = 1/sqrt(-3*k_1)",
    "F23 value": "V = max(R, G, B)",
    "F23 spread": "Delta = max(R, G, B) - min(R, G, B)",
    "F23 saturation": "S = Delta/V",
    "F24 hue": "piecewise(60*(G - B)/Delta, V = R, 60*(2 + (B - R)/Delta), V = G,"
    " 60*(4 + (R - G)/Delta))",
    "F24 wrapped": "mod(60*(G - B)/Delta, 360)",
    "F25 chroma": "C = V*S",
    "F25 second": "X = C*(1 - abs(mod(H/60, 2) - 1))",
    "F25 offset": "m = V - C",
    "F26 sector": "floor(H/60)",
    "F28 green": "Ghat = (G_1 + G_2 + G_3 + G_4)/4",
    "F30 red": "Rhat = (R_left + R_right)/2",
    "F31 f-number": "N_f = f/D",
    "F33 blur disc": "c = D*abs(z'_s - z'_p)/z'_p",
    "F34 stops": "s = log2(E_1/E_2)",
    "F34 stops by N": "2*log2(N_2/N_1)",
    "F35 times": "t_2/t_1 = (N_2/N_1)^2",
    "F36 wrap": "mod(a + b, 256)",
    "F36 wrapped product": "mod(a*b, 256)",
    "F37 opencv hue": "round(H/2)",
    "F38 salt and pepper": "piecewise(0, u < p/2, 255, u > 1 - p/2, I)",
    "F39 flat field": "I*Fbar/F",
    "F41 ellipse": "exp(-x^2/(2*sigma_1^2) - y^2/(2*sigma_2^2))/(2*pi*sigma_1*sigma_2)",
    "F42 thin lens": "1/f = 1/z + 1/z'",
    "F42 image": "z' = f*z/(z - f)",
    "F42 reciprocal": "1/(1/f - 1/z)",
    "F42 magnification": "m = z'/z",
    "F43 weak": "x' = f/zbar*p_x",
    "F44 error": "d/zbar",
    "F44 weak scale": "d/(zbar - d)",
    "F45 ratio": "SNR = sqrt(N_ph)",
    "F45 decibel": "20*log10(SNR)",
    "F46 encode": "I_enc = I_lin^(1/2.2)",
    "F46 decode": "I_lin = I_enc^2.2",
    "number by number": "3*4*5",
    "number by letter": "3*x*y",
    "letter by number": "x*2",
    "number by negative": "5*(-6)",
    "sum of negatives": "-a + -b - -c",
    "difference of sums": "a - (b + c) - (d - e)",
    "sum of sums": "a + (b - c) + d",
    "coefficient minus": "x^2 + -3*x - 1.5",
    "negative sum": "-(a + b)",
    "negative quotient": "c - (-x)/p",
    "product of sums": "(a + b)*(c - d)",
    "function-like letter": "f*(a + b)",
    "power of power": "(x^2)^3",
    "power tower": "x^y^2",
    "power of sum": "(x + 1)^2",
    "power of negative": "(-2)^2",
    "minus power": "-2^2",
    "power of fraction": "(a/b)^2",
    "power of index": "N_1^2",
    "power of prime": "z'_s^2",
    "power of sine": "sin(x)^2 + cos(x)^2",
    "power of log": "log2(x)^2",
    "power of maximum": "max(a, b)^2",
    "root of root": "sqrt(1 + sqrt(x))",
    "root of fraction": "sqrt(a/b)*c",
    "e": "exp(1)",
    "logarithm": "ln(x/y) - ln(2)",
    "angles": "atan2(y, x) + asin(x) - acos(x)*atan(x)",
    "tangent": "tan(pi/4)",
    "sign": "sign(x)*ceil(abs(x))",
    "bars": "abs(a)*abs(b)",
    "fraction of fractions": "(a/b)/(c/d)",
    "chained division": "a/b/c",
    "number before fraction": "2*(1/3)",
    "fraction before letter": "1/2*m*v^2",
    "word factors": "SNR*x*ISO",
    "small decimal": "0.0000015*x",
    "three conditions": "x > 0 and x < 1 or not x = 2",
    "between": "x >= 0 and x < 1",
    "unequal": "x != y",
    "at most": "abs(x) <= 1",
    "mod in product": "2*mod(a, b)",
    "mod in difference": "1 - mod(a, b)",
    "subscripts": "p_x1 + sigma_xy + x_max_1 + k1 + f''",
    "greek": "alpha + beta*theta - Deltaz*Delta_z + lambda",
    "axis tilde": "x_tilde + y_hat",
}
"""Name of the entry to formula in the authors' notation."""

INLINE = {
    "inline product": "f*X/Z*V",
    "inline sums": "(a + b)/(c*d)",
    "inline nested": "a/b/(c/d)",
    "inline powers": "x^2/(2*y^2)",
    "inline third": "(1/3)*x",
}


def _integral(*factors: Node) -> Node:
    differential = MathRow((OperatorSign(" "), Ident("d"), Ident("λ")))
    times: list[Node] = [LargeOperator("∫"), factors[0]]
    for factor in factors[1:]:
        times += [OperatorSign(""), factor]
    return MathRow((*times, differential), PRODUCT)


def _of(head: str, *args: Node) -> Node:
    return Func(lay_out_name(head), args)


def _line() -> Node:
    """The worked line of a pinhole question."""
    values = {"f": quantity("50", "mm"), "X": quantity("30", "m"), "Z": quantity("600", "m")}
    formula = parse_formula("f*X/Z")
    sides = [
        lay_out_name("u"),
        lay_out(formula),
        lay_out(formula, leaves=values),
        quantity("2.5", "mm"),
    ]
    return relation_chain(["=", "=", "="], sides)


def _with(text: str, **leaves: Node) -> Node:
    return lay_out(parse_formula(text), leaves=leaves)


def built() -> dict[str, Node]:
    """Entries that no formula tree expresses, or that print numbers in the place of symbols."""
    lam, bold = lay_out_name("lambda"), {letter: Ident(letter, bold=True) for letter in "abdpμ"}
    off = add_brackets(MathRow((bold["d"], OperatorSign("-"), bold["μ"]), SUM), ATOM)
    inverse = Scripts(Ident("Σ"), None, negative(Digits("1")))
    quadratic = MathRow(
        (lay_out_power(off, OperatorSign("ᵀ")), OperatorSign(""), inverse, OperatorSign(""), off),
        PRODUCT,
    )
    half = MathRow(
        (Frac(Digits("1"), Digits("2"), inline=True), OperatorSign("·"), quadratic), PRODUCT
    )
    det = Root(Func(Word("det"), (Ident("Σ"),)))
    gauss = Frac(
        Scripts(Ident("e"), None, negative(half)),
        MathRow(
            (Digits("2"), OperatorSign(""), lay_out_name("pi"), OperatorSign(""), det), PRODUCT
        ),
    )
    point = fence([lay_out_name("u"), lay_out_name("v")])
    return {
        "F02 brightness": relation_chain(
            ["="],
            [
                lay_out_name("B"),
                MathRow(
                    (
                        lay_out_name("K_m"),
                        OperatorSign(""),
                        _integral(_of("L", lam), _of("R", lam), _of("V", lam)),
                    ),
                    PRODUCT,
                ),
            ],
        ),
        "F04 metamers": relation_chain(
            ["="],
            [
                _integral(lay_out_name("s_i"), lay_out_name("L"), lay_out_name("R_1")),
                _integral(lay_out_name("s_i"), lay_out_name("L"), lay_out_name("R_2")),
            ],
        ),
        "F06 same image": relation_chain(
            ["="],
            [
                _of("P", MathRow((lay_out_name("s"), OperatorSign(""), bold["p"]), PRODUCT)),
                _of("P", bold["p"]),
            ],
        ),
        "F26 sector zero": fence([lay_out_name("C"), lay_out_name("X"), number(0)]),
        "F27 not additive": relation_chain(
            ["≠"],
            [
                _of("V", MathRow((bold["a"], OperatorSign("+"), bold["b"]), SUM)),
                MathRow((_of("V", bold["a"]), OperatorSign("+"), _of("V", bold["b"])), SUM),
            ],
        ),
        "F32 light": relation_chain(
            ["∝", "∝"],
            [lay_out_name("E"), lay_out(parse_formula("D^2")), lay_out(parse_formula("1/N_f^2"))],
        ),
        "F40 plane gauss": gauss,
        "worked line": _line(),
        "pixel point": relation_chain(["="], [point, fence([number("440"), number("160")])]),
        "exact and rounded": relation_chain(
            ["=", "≈"], [lay_out_name("p'_x"), number("20/3"), number("6.667")]
        ),
        "negative quantity added": _with("c + x", x=quantity("-2", "m"), c=quantity("5", "m")),
        "negative quantity first": _with("x*c", x=quantity("-2", "m"), c=quantity("5", "m")),
        "negative quantity last": _with("c*x", x=quantity("-2", "m"), c=quantity("5", "m")),
        "negative number taken": _with("c - x", x=number("-2"), c=number("5")),
        "quantity squared": _with("D^2/4", D=quantity("5", "mm")),
        "fraction squared": _with("(2*x)^2 + x^2", x=number("2/3")),
        "numbers in a product": _with("k_1*r^2", k_1=number("-0.25"), r=number("0.5")),
        "numbers in a bracket": _with("a*(b + c)", a=number("2"), b=number("3"), c=number("4")),
        "decibel": quantity("20", "dB"),
        "angle": quantity("140", "deg"),
        "percent": quantity("4.55", "%"),
        "micrometre": quantity("2.5", "um/px"),
        "exposure": quantity("1", "lx*s"),
        "area": quantity("12", "mm^2"),
        "electrons": quantity("1200", "e-"),
        "rate": quantity("1", "e-/s"),
        "grouped": quantity("200 000", "px/m"),
        "scientific": number("-1.2e-5"),
        "limit": MathRow(
            (
                Under(Word("lim"), relation_chain(["→"], [lay_out_name("z"), lay_out_name("f")])),
                OperatorSign(" "),
                lay_out_name("z'"),
            ),
            PRODUCT,
        ),
        "sum": MathRow(
            (
                LargeOperator(
                    "∑", relation_chain(["="], [lay_out_name("i"), number(1)]), lay_out_name("n")
                ),
                lay_out_name("x_i"),
            ),
            PRODUCT,
        ),
        "matrix": Matrix(
            (
                (lay_out_name("f_x"), number(0), lay_out_name("o_x")),
                (number(0), lay_out_name("f_y"), lay_out_name("o_y")),
            )
        ),
        "interval": relation_chain(
            ["∈"], [lay_out_name("H"), fence([number(0), number(360)], "[)")]
        ),
        "cube root": Root(lay_out_name("x"), Digits("3")),
        "list": comma_list([lay_out_name("R"), lay_out_name("G"), lay_out_name("B")]),
        "words": Cases(
            (
                (number(1), MathRow((lay_out_name("a"), ReaderWord("and"), lay_out_name("b")))),
                (number(0), None),
            )
        ),
    }


def nodes() -> dict[str, Node]:
    """Every entry of the table."""
    plain = {key: lay_out(parse_formula(text)) for key, text in FORMULAS.items()}
    inline = {key: lay_out(parse_formula(text), inline=True) for key, text in INLINE.items()}
    return plain | inline | built()


def outputs(node: Node) -> dict[str, str]:
    """The outputs that the golden table keeps."""
    return {
        "latex": to_latex(node),
        "typst": to_typst(node),
        "mathml": to_mathml(node),
        "en": to_speech(node, "en"),
        "bn": to_speech(node, "bn"),
    }


def _toml() -> str:
    lines = []
    for key, node in nodes().items():
        lines.append(f'["{key}"]')
        lines += [f"{kind} = '''{text}'''" for kind, text in outputs(node).items()]
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    GOLDEN.write_text(_toml(), encoding="utf-8")
    sys.stdout.write(f"{GOLDEN.name}: {len(nodes())} formulas\n")
