"""Numbers and formulas as figures and their descriptions print them, and where their words stand."""

from __future__ import annotations

import pytest
from sweep import together

from quizgen.core.errors import BankError
from quizgen.figures.kit import (
    format_derived,
    format_equation,
    format_given,
    format_statement,
    load_alt_words,
    relation_sign,
    strip_mathtext,
)


@together(
    ("value", "text"),
    [
        (200 / 3, "66.67"),
        (2.5, "2.5"),
        (-0.8, "−0.8"),
        (1e-05, "0.00001"),
        (2699.8, "2700"),
        (0.00125, "0.00125"),
        (1.0005, "1.001"),
        (-66.665, "−66.67"),
        (0.0, "0"),
        (5535.0, "5535"),
    ],
)
def test_results_are_rounded_half_away_from_zero(value, text):
    assert format_derived(value) == text


def test_given_numbers_are_printed_in_full():
    assert format_given(1234567.0) == "1234567"
    assert format_given(0.1 + 0.2) == "0.3"
    assert format_statement("$f$", 50, "mm") == "$f$ = 50 mm"


def test_equations_say_whether_they_are_exact():
    assert format_equation("x", 115.0) == "x = 115"
    assert format_equation("x", 20 / 3, "mm") == "x ≈ 6.667 mm"
    assert format_equation("x", 20 / 3, "mm", hide=True) == "x = ?"
    assert format_equation("x", 12345.0) == "x = 12345"
    assert [relation_sign(value) for value in (0.25, 1 / 3)] == ["=", "≈"]


@pytest.mark.parametrize(
    ("label", "text"),
    [
        ("$z'_p$ = 60 mm", "z'_p = 60 mm"),
        (r"$\lambda$ = 550 nm", "λ = 550 nm"),
        (r"$p_{\mathrm{max}}$", "p_max"),
        (r"$\varphi$ / °", "φ / °"),
        ("mass / g", "mass / g"),
    ],
)
def test_a_label_as_plain_text(label, text):
    assert strip_mathtext(label) == text


def test_words_stand_beside_the_figure_in_english_where_there_are_no_others(tmp_path):
    figure = tmp_path / "lamp.py"
    (tmp_path / "en.toml").write_text('[lamp]\nshown = "A lamp."\n', encoding="utf-8")
    (tmp_path / "bn.toml").write_text('[lamp]\nshown = "একটি বাতি।"\n', encoding="utf-8")
    said = [load_alt_words(str(figure), lang)["shown"] for lang in ("en", "bn", "de")]
    assert said == ["A lamp.", "একটি বাতি।", "A lamp."]
    with pytest.raises(BankError, match=r"en\.toml: no table \[desk\], the figure's sentences"):
        load_alt_words(str(tmp_path / "desk.py"), "en")
