"""Fonts of pages: packed as the command packs them, with every character that pages show."""

from __future__ import annotations

import re
import sys
from html import unescape
from io import BytesIO
from pathlib import Path

import pytest
from fontTools.ttLib import TTFont
from sweep import sample

from quizgen.bank.bank import builtin_bank
from quizgen.core.errors import RenderError
from quizgen.lint.doctor import all_bangla_text
from quizgen.paper.paper import single_question_paper
from quizgen.render import fonts, render_paper
from quizgen.typeset.signs import list_formula_characters

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))

from pack_fonts import list_sources, pack_font

NAMES = [fonts.MATHS, fonts.ALL_MATHS, *fonts.BANGLA.values()]


def characters(name: str) -> set[str]:
    with TTFont(BytesIO(fonts.read_web_font(name))) as font:
        return set(map(chr, font.getBestCmap()))


@pytest.mark.slow
@pytest.mark.parametrize("name", sample(NAMES, 2))
def test_the_packed_font_is_what_the_command_makes(name):
    """Packing takes up to 3 CPU s; that is why the fonts are kept."""
    source, wanted = list_sources()[fonts.packed_font_path(name)]
    assert fonts.read_web_font(name) == pack_font(source, wanted)


@pytest.mark.parametrize("name", fonts.BANGLA.values())
def test_bangla_of_templates_and_locale_has_its_letters(name):
    joiners = {"\u200c", "\u200d"}
    used = {c for c in all_bangla_text() if "\u0980" <= c <= "\u09ff" or c in joiners or c in "।॥"}
    assert len(used) > 50
    assert used <= characters(name)


def mathematics(page: str) -> set[str]:
    """Characters of the formulas of a page."""
    formulas = re.findall(r"<math.*?</math>", page, re.DOTALL)
    return set(unescape(re.sub(r"<[^>]*>", "", "".join(formulas)))) - {"\n"}


@pytest.mark.slow
def test_formulas_of_all_templates_have_their_letters():
    """Composes every template once, 7 CPU s: no smaller set holds all letters."""
    pages = (render_paper(single_question_paper(template, 1, template.languages[0], figures=False),
                          "solutions", "html").decode() for template in builtin_bank())  # fmt: skip
    used = set().union(*map(mathematics, pages))
    assert len(used) > 80
    assert used <= characters(fonts.MATHS)


def test_the_larger_font_has_every_sign_of_latex():
    small, large = characters(fonts.MATHS), characters(fonts.ALL_MATHS)
    assert small < large
    assert list_formula_characters() <= large


def test_a_page_brings_the_larger_font_only_where_it_needs_it():
    template = next(iter(builtin_bank()))
    page = render_paper(single_question_paper(template, 1, "en", figures=False), "exam", "html")
    assert fonts.maths_uri().encode() in page
    assert fonts.all_maths_uri().encode() not in page
    assert fonts.has_rare_signs("<math><mi>ℝ</mi></math>")
    assert not fonts.has_rare_signs("<math><mi>x</mi><mo>∑</mo></math>")


@pytest.mark.parametrize(
    "damage", [lambda d: d[:1000], lambda _: b"", lambda d: b"x" + d[1:], lambda d: d + b"x"]
)
def test_a_damaged_font_is_said_and_never_put_into_a_page(monkeypatch, tmp_path, damage):
    data = fonts.read_web_font(fonts.MATHS)
    monkeypatch.setattr(fonts, "WEB", tmp_path)
    with pytest.raises(RenderError, match=r"stix-two-math\.woff2"):
        fonts.read_web_font(fonts.MATHS)
    fonts.packed_font_path(fonts.MATHS).write_bytes(damage(data))
    with pytest.raises(RenderError, match="damaged font; reinstall quizgen"):
        fonts.read_web_font(fonts.MATHS)


def test_the_licence_stands_beside_the_fonts_and_no_font_has_a_reserved_name():
    licence = (fonts.WEB / "OFL.txt").read_text("utf-8")
    for name in NAMES:
        assert f"{name}.woff2" in licence
        with TTFont(BytesIO(fonts.read_web_font(name))) as font:
            family = font["name"].getBestFamilyName()
        assert "TM Math" not in family
        assert family.removesuffix(" SemiBold").removesuffix(" Bold") in licence
