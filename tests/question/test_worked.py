"""A worked step from formula to rounded value, against lines written by hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from quizgen import typeset
from quizgen.bank.language_file import parse_language_file
from quizgen.bank.rules import DrawRule, PartRule, Rules
from quizgen.bank.sampler import sampler_for
from quizgen.bank.template import Template
from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula
from quizgen.maths.numbers import to_rational
from quizgen.question.compose import compose_variant
from quizgen.question.interpolation import Interpolator, inlines_to_text
from quizgen.question.worked_steps import typeset_step
from quizgen.typeset.prose import TypesetMaths

BLANK = "\u00a0"
TEXT = """# Title
{stem}
## steps
- u: because
- w: because
## traps
## check
"""


def drawn(given, steps, stem="Stem", *, words="", said=None):
    """A draw of a template made by hand: quantity to (unit, value), and name, formula, unit."""
    units = {name: unit for name, (unit, _) in given.items()}
    names = (*given, *(name for name, _, _ in steps))
    chain = Chain(
        units, tuple(ChainStep(n, parse_formula(f, symbols=names), unit) for n, f, unit in steps)
    )
    rules = Rules(
        topic="noise",
        tier="A",
        part=(PartRule(answer={"kind": "number", "of": steps[-1][0]}),),
        draw={name: DrawRule(unit=unit, pick=(value,)) for name, (unit, value) in given.items()}
        | {name: DrawRule(words=(word,)) for name, word in (said or {}).items()},
    )
    text = parse_language_file(TEXT.replace("{stem}", stem) + words)
    template = Template("by-hand", rules, chain, {"en": text}, f"{given}{steps}{stem}", Path())
    shown = {name: to_rational(value) for name, (_, value) in given.items()}
    return Variant(
        template, "0", "0", 1, shown, said or {}, sampler_for(template).solve(shown), ((),)
    )


def typed(one, name):
    line = typeset_step(one, one.template.chain.by_name[name])
    return line.typed_text.replace(BLANK, " "), typeset.to_latex(line.node)


LENS = {"f": ("mm", "50"), "X": ("m", "30"), "Z": ("m", "600")}


def test_exact_numbers_and_an_exact_value_are_equal():
    said, _ = typed(drawn(LENS, [("u", "f*X/Z", "mm")]), "u")
    assert said == "u = f*X/Z = (50 mm)*(30 m)/(600 m) = 2.5 mm"


def test_a_value_without_a_short_form_is_about_its_rounded_one():
    said, _ = typed(drawn({"a": ("", "2")}, [("u", "sqrt(a)", "")]), "u")
    assert said == "u = sqrt(a) = sqrt(2) ≈ 1.414"


def test_a_fraction_is_equal_and_its_decimal_is_about():
    said, _ = typed(drawn({"a": ("", "20"), "b": ("", "3")}, [("u", "a/b", "")]), "u")
    assert said == "u = a/b = 20/3 ≈ 6.667"


def test_numbers_that_had_to_be_rounded_are_about_equal_in_every_output():
    """sqrt(2) stands as 1.41421 in the second line: that line is not an equation."""
    one = drawn({"a": ("", "2")}, [("u", "sqrt(a)", ""), ("w", "3*u", "")])
    said, printed = typed(one, "w")
    assert said == "w = 3*u ≈ 3*1.41421 ≈ 4.243"
    assert printed.count(r"\approx") == 2
    assert printed.count("=") == 1


def test_a_formula_without_names_has_no_numbers_to_put_in_place():
    said, _ = typed(drawn({"a": ("", "1")}, [("u", "3/4", "")]), "u")
    assert said == "u = 3/4 = 0.75"


def test_a_name_alone_needs_no_brackets():
    said, _ = typed(drawn({"a": ("mm", "-7")}, [("u", "a", "mm")]), "u")
    assert said == "u = a = −7 mm"


def test_numbers_stand_where_the_tree_has_the_name():
    """exp and x, log2 and l: a name inside another word is no name."""
    given = {"x": ("", "2"), "e": ("", "-3")}
    said, _ = typed(drawn(given, [("u", "max(x, e) + log2(x)^x", "")]), "u")
    assert said == "u = max(x, e) + log2(x)^x = max(2, (−3)) + log2(2)^2 = 3"


def test_a_stem_shows_what_is_drawn():
    question, _ = compose_variant(drawn(LENS, [("u", "f*X/Z", "mm")], "A lens of {{ f }}."), "en")
    assert inlines_to_text(question.stem[0].children).replace(BLANK, " ") == "A lens of 50 mm."


def test_a_stem_cannot_show_a_solved_value():
    one = drawn(LENS, [("u", "f*X/Z", "mm")], "The image is {{ u }} wide.")
    with pytest.raises(BankError, match=r"\{\{ u \}\} is not a drawn quantity"):
        compose_variant(one, "en")


def test_a_program_in_a_stem_cannot_show_a_solved_value():
    one = drawn(LENS, [("u", "f*X/Z", "mm")], "Look:\n\n```\nprint({{ u }})\n```\n")
    with pytest.raises(BankError, match=r"\{\{ u \}\} cannot stand in a program"):
        compose_variant(one, "en")


def test_a_program_in_a_stem_has_the_minus_of_the_keyboard():
    one = drawn({"a": ("", "-3")}, [("u", "2*a", "")], "Look:\n\n```\nprint({{ a }})\n```\n")
    question, _ = compose_variant(one, "en")
    assert question.stem[1].text.strip() == "print(-3)"


def test_code_in_a_sentence_is_filled_as_a_program():
    words = "## words\n- call: It returns `f({{ a }}, {{ a }}.0)`.\n"
    steps = [("u", "2*a", "")]
    one = drawn({"a": ("", "-3")}, steps, "{{ what }}", words=words, said={"what": "call"})
    question, _ = compose_variant(one, "en")
    assert inlines_to_text(question.stem[0].children) == "It returns f(-3, -3.0)."


def test_a_stem_shows_a_drawn_phrase():
    words = "## words\n- wide: a wide lens\n- long: a long lens\n"
    one = drawn(
        LENS, [("u", "f*X/Z", "mm")], "Take {{ lens }}.", words=words, said={"lens": "long"}
    )
    question, _ = compose_variant(one, "en")
    assert inlines_to_text(question.stem[0].children) == "Take a long lens."


@pytest.mark.parametrize(
    ("a", "line"), [("3", "u = a + 1 = 3 + 1 = 4"), ("1", "u = 2*a = 2*1 = 2")]
)
def test_only_the_branch_that_applies_is_shown(a, line):
    said, _ = typed(drawn({"a": ("", a)}, [("u", "piecewise(a + 1, a > 2, 2*a)", "")]), "u")
    assert said == line


def test_the_solution_may_show_it():
    one = drawn(LENS, [("u", "f*X/Z", "mm")])
    shown = Interpolator(one, "en").blocks(parse_language_file("# T\nIt is {{ u }} wide.").stem)
    assert inlines_to_text(shown[0].children).replace(BLANK, " ") == "It is 2.5 mm wide."


def test_a_fraction_of_long_numbers_gives_way_to_its_decimal():
    """70/11 says nothing to a reader, 2/3 does; it stands where an answer must be exact."""
    given = {"a": ("mm", "70"), "b": ("", "11")}
    one = drawn(given, [("u", "a/b", "mm"), ("w", "3*u", "mm"), ("s", "b*u", "mm")])
    assert typed(one, "u")[0] == "u = a/b = (70 mm)/11 ≈ 6.364 mm"
    assert typed(one, "w")[0] == "w = 3*u ≈ 3*(6.36364 mm) ≈ 19.09 mm"
    assert typed(one, "s")[0] == "s = b*u ≈ 11*(6.36364 mm) ≈ 70 mm"
    small = drawn({"a": ("", "2"), "b": ("", "3")}, [("u", "a/b", ""), ("w", "3*u", "")])
    assert typed(small, "w")[0] == "w = 3*u = 3*(2/3) = 2"


def test_a_rounded_value_is_never_said_to_be_equal():
    one = drawn({"a": ("", "70"), "b": ("", "11")}, [("u", "a/b", ""), ("w", "3/2", "")])
    shown = Interpolator(one, "en").blocks(
        parse_language_file("# T\n$u$ = {{ u }}, $w$ = {{ w }}.").stem
    )
    assert inlines_to_text(shown[0].children).replace(BLANK, " ") == "u ≈ 6.364, w = 1.5."


def test_long_and_small_numbers_of_a_sentence_are_typeset():
    one = drawn({"a": ("B", "1228800"), "b": ("", "1/4000000")}, [("u", "a*b", "B")])
    (shown,) = Interpolator(one, "en").blocks(parse_language_file("# T\nOf {{ a }}, {{ b }}.").stem)
    assert inlines_to_text(shown.children) == "Of 1\u202f228\u202f800\u00a0B, 2.5·10⁻⁷."
    assert [
        typeset.to_latex(part.node) for part in shown.children if isinstance(part, TypesetMaths)
    ] == [r"2.5 \cdot 10^{- 7}"]
