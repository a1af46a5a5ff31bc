"""The rewrites one by one, where errors point, and what the checker understood."""

from __future__ import annotations

import pytest
from sweep import together

from quizgen.core.errors import KeyFileError
from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.spelling import allowed_typos, fold_word, nearest_terms, typo_distance
from quizgen.grading.reading.formulas import FORMULA_REWRITES, read_formula
from quizgen.grading.reading.literals import read_literal
from quizgen.grading.reading.normalise import REWRITES, apply_rewrite, normalise_typed
from quizgen.grading.reading.units import list_unit_words, read_unit
from quizgen.kinds.grade import grade_answer
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.units import get_unit

ONE_BY_ONE = [
    ("direction marks around", "\u200f12\u200e", "12"),
    ("blanks", "1\u202f234\u00a0m", "1 234 m"),
    ("digits", "১২.৫ ４", "12.5 4"),
    ("full-width forms", "（1，5）", "(1,5)"),
    ("minus and dashes", "−5 – 3 — 1", "-5 - 3 - 1"),
    ("minus and dashes", "x⁻²", "x⁻²"),
    ("times", "3·4 × 5", "3*4 * 5"),
    ("degrees", "30º 30˚", "30° 30°"),
    ("division", "6 ÷ 2 ⁄ 3", "6 / 2 / 3"),
    ("decimal marks", "12٫5", "12.5"),
    ("quotes and primes", "z′ p’_x", "z' p'_x"),
    ("double primes", "z″", "z''"),
    ("semicolons", "1；2", "1;2"),
    ("angle brackets", "⟨1; 2⟩", "(1; 2)"),
    ("superscripts", "x² 10⁻³ r¹⁰", "x^2 10^(-3) r^(10)"),
    ("subscripts", "k₁ pₓ", "k1 px"),
    ("vulgar fractions", "½ 1½ 2 ¾", "(1/2) (1+1/2) (2+3/4)"),
    ("letters with a dot", "ও\u09df\u09beট", "ও\u09af\u09bc\u09beট"),
    ("classifiers", "8000টি পিক্সেল", "8000 পিক্সেল"),
    ("classifiers", "6টা", "6"),
    ("classifiers", "6টিন", "6টিন"),
    ("powers of ten in words", "96 million bytes", "96*10^6 bytes"),
    ("powers of ten in words", "9,6 Mio. Byte", "9,6*10^6 Byte"),
    ("powers of ten in words", "৬২ লাখ", "৬২*10^5"),
    ("powers of ten in words", "5 lacquers", "5 lacquers"),
    ("blank before a power of ten", "1.085 10^-2", "1.085*10^-2"),
    ("blank before a power of ten", "12.5 10^-2", "12.5 10^-2"),
    ("ties", "12~mm", "12 mm"),
    ("ties", "20/3 ~ 6.67", "20/3 ~ 6.67"),
    ("answer", "Answer: 5", "5"),
    ("answer", "Die Antwort ist 5", "5"),
    ("answer", "উত্তরঃ ৫", "৫"),
    ("answer", "answers 5", "answers 5"),
    ("about", "≈ 5", "5"),
    ("about", "ca. 5", "5"),
    ("about", "approximately 5", "5"),
    ("about", "cat", "cat"),
    ("x between numbers", "3x10^5", "3*10^5"),
    ("x between numbers", "0x3", "0x3"),
    ("x between numbers", "2x", "2x"),
]


@together(("name", "typed", "wanted"), ONE_BY_ONE)
def test_rewrite(name, typed, wanted):
    assert apply_rewrite(name, typed) == wanted


def test_every_rewrite_is_tested_alone():
    assert {name for name, _, _ in ONE_BY_ONE} == set(REWRITES)


@together(
    ("name", "typed", "same"),
    [
        ("function synonyms", "arctan(x) + lg(x)", "atan(x) + log10(x)"),
        ("degrees", "sin(30°)", "sin((30*pi/180))"),
        ("percent", "5 % * x", "(5/100)*x"),
        ("semicolon arguments", "max(x; 1)", "max(x, 1)"),
        ("square brackets", "2[x+1]", "2*(x+1)"),
        ("leading point", "x + .5", "x + 0.5"),
        ("pi", "2πx", "2*pi*x"),
    ],
)
def test_formula_rewrite(name, typed, same):
    assert name in FORMULA_REWRITES
    assert read_formula(typed, ["x"]).tree == read_formula(same, ["x"]).tree


@together(
    ("typed", "decimal", "text", "other"),
    [
        ("12,5", "auto", "12.5", ""),
        ("1.000", "auto", "1.000", "1000"),
        ("1.000", "point", "1.000", "1000"),
        ("0,500", "comma", "0.500", ""),
        ("1234,500", "comma", "1234.500", ""),
        ("1.234.567,8", "auto", "1234567.8", ""),
        ("1,234.5", "auto", "1234.5", ""),
        ("12,34,567", "auto", "1234567", ""),
        ("1'234'567", "auto", "1234567", ""),
        (",5", "auto", "0.5", ""),
        ("5.", "auto", "5", ""),
    ],
)
def test_literals(typed, decimal, text, other):
    literal = read_literal(typed, decimal)
    assert (literal.text, literal.other) == (text, other)
    assert (literal.doubt is None) == (not other or decimal == "point")


@pytest.mark.parametrize("typed", ["1.2.3", "1,2,3", "1..2", "1.23,45,6", "12,3456,7"])
def test_literals_that_are_none(typed):
    with pytest.raises(FormulaReadError):
        read_literal(typed)


@together(
    ("typed", "column"),
    [
        ("1\u00072", 2),
        ("  1\u00072", 4),
        ("২ + ৩ $", 7),
        ("½ + $", 5),
        ("x² + y", 6),
        ("\u200f 3 $", 5),
    ],
)
def test_errors_point_into_what_was_typed(typed, column):
    spec = {"kind": "expression", "value": "x", "symbols": {"x": "real"}}
    assert grade_answer(spec, typed).fields["column"] == column


@together(
    ("kind", "typed", "column"),
    [
        ("point", "1; 1/0", 4),
        ("point", "1; 1e999", 4),
        ("point", "1; sqrt(-1)", 4),
        ("point", "1; (2", 6),
        ("table", "V = 1; S = 1/0", 12),
        ("table", "V = 1; S = ab", 12),
        ("table", "V = 1; S = 2 foo", 14),
        ("table", "(V, T) = (1, 2)", 5),
    ],
)
def test_what_is_wrong_with_one_of_several_values_is_said_where_it_stands(kind, typed, column):
    values = {"point": ["1", "2"], "table": {"V": "1", "S": "2"}}
    verdict = grade_answer({"kind": kind, "values": values[kind]}, typed)
    assert verdict.verdict == "unreadable"
    assert verdict.fields["column"] == column


def test_a_missing_end_points_behind_the_text():
    spec = {"kind": "expression", "value": "x", "symbols": {"x": "real"}}
    verdict = grade_answer(spec, "(x + 1")
    assert verdict.fields["column"] == 7
    assert ")" in verdict.message


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("<b>", "<b>"),
        ("a\x00b", "a[U+0000 control character]b"),
        ("a\u200bb", "a[U+200B ZERO WIDTH SPACE]b"),
        ("\x1b[31m", "[U+001B control character][31m"),
        ("x" * 100, "x" * 39 + "…"),
    ],
)
def test_echo_is_harmless_and_short(text, shown):
    assert safe_echo(text) == shown


def test_every_listed_unit_word_is_a_listed_unit():
    for word, name in list_unit_words().items():
        turned = {"rad": "deg", "eV": "J"}
        assert read_unit(word).dimension == get_unit(turned.get(name, name)).dimension


@together(
    ("typed", "listed"),
    [
        ("µm/px", "um/px"),
        ("mm²".replace("²", "^2"), "mm^2"),
        ("lx s", "lx*s"),
        ("mm^-1", "1/mm"),
        ("m s^-1", "m/s"),
        ("px per mm", "px/mm"),
    ],
)
def test_compound_units(typed, listed):
    found, wanted = read_unit(typed), get_unit(listed)
    assert (found.dimension, str(found.factor)) == (wanted.dimension, str(wanted.factor))


# 26 pairs of terms that fuzzy thresholds confuse: typed, all terms, the term meant (None: none)
TERMS = [
    "far-sighted",
    "near-sighted",
    "demosaicing",
    "mosaicing",
    "rod",
    "cone",
    "barrel",
    "pincushion",
    "blooming",
    "zooming",
    "hue",
    "value",
    "additive",
    "subtractive",
    "vignetting",
    "photosite",
]


@together(
    ("typed", "meant"),
    [
        ("far sighted", "far-sighted"), ("nearsighted", "near-sighted"), ("farsigted", "far-sighted"), ("demosaicng", "demosaicing"),
        ("mosaicng", "mosaicing"), ("mosaicing", "mosaicing"), ("rods", None), ("cones", None), ("barel", "barrel"), ("barrell", "barrel"),
        ("pincusion", "pincushion"), ("pinchusion", "pincushion"), ("bloomin", "blooming"), ("zoomin", "zooming"), ("hues", None), ("valeu", "value"),
        ("additiv", "additive"), ("subtractiv", "subtractive"), ("adictive", None), ("vinetting", "vignetting"), ("vignette", None), ("photosit", "photosite"),
        ("photo site", "photosite"), ("photograph", None), ("", None), ("nonsense", None),
    ],
)  # fmt: skip
def test_the_nearest_term_decides(typed, meant):
    found, _ = nearest_terms(typed, TERMS)
    assert found == ([meant] if meant else [])


def test_folding_of_words():
    assert fold_word("  The Colour-Filter  Array. ") == fold_word("color filter array")
    assert fold_word("O\u0308ffnung") == fold_word("Oeffnung") == fold_word("öffnung")
    assert fold_word("বেয়ার") == fold_word("বেয়ার".replace("\u09df", "\u09af\u09bc"))


def test_the_cap_stands_before_everything_else():
    with pytest.raises(FormulaReadError) as caught:
        normalise_typed("\u200b" * 1_000_000)
    assert caught.value.code == "too-long"


@together("separator", ["\u2028", "\u2029", "\x85", "\x0b", "\x0c", "\x1c"])
@together("kind", ["number", "gap", "choice", "code", "rubric", "order", "match"])
def test_separators_of_lines_are_named_and_never_echoed(separator, kind):
    specs = {
        "number": {"value": "1"}, "gap": {"accept": ["a"]}, "code": {"output": "1"},
        "choice": {"options": ["p", "q"], "correct": [1]},
        "rubric": {"full": "1", "criteria": {"a": {"points": "1", "accept": ["a"]}}},
        "order": {"steps": ["A", "B"]}, "match": {"pairs": {"A": "1"}},
    }  # fmt: skip
    verdict = grade_answer({"kind": kind, **specs[kind]}, f"1{separator}2")
    assert separator not in verdict.message + verdict.read_as
    assert verdict.note == "bad-character"
    assert f"U+{ord(separator):04X}" in verdict.message


def test_a_key_without_a_value_is_refused():
    with pytest.raises(KeyFileError):
        grade_answer({"kind": "expression", "value": "1/0", "symbols": {"x": "real"}}, "x")


def test_terms_equally_near_are_returned_together():
    assert nearest_terms("bloowing", ["blooming", "hue", "blooping"]) == (
        ["blooming", "blooping"],
        1,
    )
    assert nearest_terms("bloomng", ["blooping", "blooming"]) == (["blooming"], 1)


def test_slips_allowed_grow_with_the_word():
    assert [allowed_typos("a" * length) for length in (4, 5, 8, 9)] == [0, 1, 1, 2]
    assert [typo_distance("hue", "cat", most) for most in (1, 2, 3)] == [2, 3, 3]


@together(("typed", "term", "counted"), [
    ("gamma", "gamma", 0), ("gmama", "gamma", 1), ("gama", "gamma", 1), ("gammaa", "gamma", 1),
    ("gamna", "gamma", 1), ("gmmaa", "gamma", 2), ("aberation", "aberrations", 2),
    ("binnign", "bining", 2), ("retina", "cornea", 3), ("tertiary", "whitepaper", 3),
    ("hyperopia", "whitepaper", 3), ("iris", "virus", 2), ("", "ab", 2), ("", "abc", 3),
])  # fmt: skip
def test_slips_are_counted_up_to_two(typed, term, counted):
    assert typo_distance(typed, term, 2) == typo_distance(term, typed, 2) == counted
    assert typo_distance(typed, term, 0) == min(counted, 1)
