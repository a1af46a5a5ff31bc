"""How numbers, names and formulas are written for people, against forms typed by hand."""

from __future__ import annotations

from sweep import together

from quizgen.maths.notation import format_tree, parse_formula, pretty

GAP = "\N{NARROW NO-BREAK SPACE}"


@together(
    ("machine", "person"),
    [
        ("0", "0"),
        ("2026", "2026"),
        ("-27", "−27"),
        ("12345", f"12{GAP}345"),
        ("1228800", f"1{GAP}228{GAP}800"),
        ("-1228800.123456", f"−1{GAP}228{GAP}800.123456"),
        ("1.2288e7", "1.2288·10⁷"),
        ("2.2e-41", "2.2·10⁻⁴¹"),
        ("6.0e-08", "6.0·10⁻⁸"),
        ("-5e+10", "−5·10¹⁰"),
        ("1e-0", "1·10⁰"),
        ("0012345", f"12{GAP}345"),
        ("1" * 5001, "11" + f"1{GAP}11" * 1666 + "1"),
        ("1e" + "2" * 5000, "1·10" + "²" * 5000),
        ("0.00012", "0.00012"),
        ("0.000050", "5.0·10⁻⁵"),
        ("0.00000", "0.00000"),
        ("-7/1550", "−7/1550"),
        ("1/12345", f"1/12{GAP}345"),
        ("-∞", "−∞"),
        ("5.0·10⁻⁵", "5.0·10⁻⁵"),
    ],
)
def test_a_number(machine, person):
    assert pretty.format_number(machine) == person
    assert pretty.format_number(person.replace(GAP, "")) == person


@together(
    ("symbol", "person"),
    [
        ("f", "f"),
        ("k1", "k₁"),
        ("k_1", "k₁"),
        ("n_12", "n₁₂"),
        ("p'_x", "p′ₓ"),
        ("p_x'", "p′ₓ"),
        ("z''", "z″".replace("″", "′′")),
        ("sigma", "σ"),
        ("sigma_1", "σ₁"),
        ("I_max", "Iₘₐₓ"),
        ("N_b", "N_b"),
        ("p'_y", "p′_y"),
        ("SNR_1", "SNR₁"),
        ("Delta", "Δ"),
        ("Deltaz", "Δz"),
        ("zbar", "z̄"),
        ("Ghat", "Ĝ"),
        ("x_plus", "x₊"),
        ("red", "red"),
        ("lower right", "lower right"),
        ("1", "1"),
    ],
)
def test_a_name(symbol, person):
    assert pretty.format_name(symbol) == person


@together(
    ("typed", "person"),
    [
        ("f*X/Z", "f·X/Z"),
        ("-x^2 - 12345*y", f"−x² − 12{GAP}345·y"),
        ("x^(-2) + x^12 + x^(1/2) + x^2.5", "x⁻² + x¹² + x^(1/2) + x^2.5"),
        ("exp(-x^2/(2*sigma_1^2))", "exp(−x²/(2·σ₁²))"),
        ("sqrt(x) + log2(y) + log10(z) + pi", "√(x) + log₂(y) + log₁₀(z) + π"),
        ("atan2(y, x) <= 1e-5 and x != 0", "atan2(y, x) ≤ 1·10⁻⁵ and x ≠ 0"),
        ("u = f*X = (50 mm)*(30 m) ≈ 1.5 m²", "u = f·X = (50 mm)·(30 m) ≈ 1.5 m²"),
        ("1/gamma + beta*gamma(x)", "1/γ + β·gamma(x)"),
        ("abs((-0.5))", "abs(−0.5)"),
        ("L = (-inf; 0] or [1; inf)", "L = (−∞; 0] or [1; ∞)"),
        ("v = (-1; 2)", "v = (−1; 2)"),
    ],
)
def test_a_formula(typed, person):
    assert pretty.format_formula(typed) == person
    assert pretty.format_formula(person) == person


def test_constants_that_need_braces_get_brackets():
    assert (
        pretty.format_formula(format_tree(parse_formula("x*{-1/3} + {-2/1} + x^{-2/1}")))
        == "x·(−1/3) + (−2) + x⁻²"
    )


@together(
    ("text", "person"),
    [
        ("between -1 and 1", "between −1 and 1"),
        ("(-1; -2)", "(−1; −2)"),
        ("256 - 180 = 76", "256 − 180 = 76"),
        ("a 16-bit image, 0-255, 3x3-5", "a 16-bit image, 0-255, 3x3-5"),
        ("up to 65535.", f"up to 65{GAP}535."),
        ("in 2026 the ISO 25600", f"in 2026 the ISO 25{GAP}600"),
    ],
)
def test_a_sentence(text, person):
    assert pretty.format_numbers_in_prose(text) == person
