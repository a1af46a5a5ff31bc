"""Formulas of courses as authors write them: what is heard and read was written by hand.

Each was looked at in print (Typst) and on a page (Chromium) when it was added.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from xml.etree import ElementTree as ET

import typst as engine
from latex2mathml.converter import convert as latex_to_mathml
from sweep import together

from quizgen.typeset import to_latex, to_mathml, to_speech, to_text, to_typst
from quizgen.typeset.from_latex import lay_out_latex
from quizgen.typeset.latex_commands import GROUPS
from quizgen.typeset.typst import typst_string

ROOT = Path(__file__).parents[2]
TABLE = tomllib.loads(Path(__file__).with_name("course_formulas.toml").read_text(encoding="utf-8"))[
    "formula"
]
LATEX = [row["latex"] for row in TABLE]
EXAMPLES = [example for group in GROUPS.values() for example in group]
ALLOWED = {
    "math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "mfrac", "msqrt", "mroot", "msub", "msup",
    "msubsup", "mover", "munder", "munderover", "mtable", "mtr", "mtd", "mpadded", "mstyle",
}  # fmt: skip
ARITY = {"mfrac": 2, "mroot": 2, "msub": 2, "msup": 2, "msubsup": 3, "mover": 2, "munder": 2,
         "munderover": 3}  # fmt: skip


def test_there_are_sixty_formulas():
    assert len(set(LATEX)) >= 60


@together("row", TABLE)
def test_a_formula_is_heard_and_read_as_written_by_hand(row):
    node = lay_out_latex(row["latex"])
    assert to_speech(node) == row["speech"]
    assert to_text(node) == row["text"]
    for lang in row.keys() & {"de", "bn"}:
        assert to_speech(node, lang) == row[lang]


@together("latex", LATEX + EXAMPLES)
def test_mathml_is_well_formed_core(latex):
    tree = ET.fromstring(to_mathml(lay_out_latex(latex)))
    for element in tree.iter():
        assert element.tag in ALLOWED
        assert len(element) == ARITY.get(element.tag, len(element))
        assert "\\" not in "".join(element.itertext())


def _write_equation(node):
    alt = typst_string(to_speech(node))
    return f"#math.equation(alt: {alt}, ${to_typst(node)}$)"


def test_all_formulas_compile_in_typst_without_a_warning():
    page = [
        '#set document(title: "Formulas")\n#set text(lang: "en")',
        '#show math.equation: set text(font: "New Computer Modern Math")',
        *(_write_equation(lay_out_latex(latex)) for latex in LATEX + EXAMPLES),
    ]
    _, warnings = engine.compile_with_warnings(
        "\n\n".join(page).encode(),
        font_paths=engine.Fonts(include_system_fonts=False),
        format="pdf",
        pdf_standards="ua-1",  # a sign that no font has would be an error
    )
    assert [str(warning) for warning in warnings] == []


@together("latex", LATEX + EXAMPLES)
def test_what_is_written_as_latex_is_read_as_the_same_formula(latex):
    node = lay_out_latex(latex)
    written = to_latex(node)
    assert "}}" not in written  # the end of a cloze in Anki
    assert to_speech(lay_out_latex(written)) == to_speech(node)


@together("latex", LATEX)
def test_exports_can_read_what_is_written(latex):
    latex_to_mathml(to_latex(lay_out_latex(latex)))


@together("lang", ["de", "bn"])
@together("latex", EXAMPLES)
def test_every_example_has_words_in_every_language(latex, lang):
    said = to_speech(lay_out_latex(latex), lang)
    assert said
    assert not re.search(r"[\\{}^_]", said)


def test_bangla_says_signs_in_bangla():
    for latex in EXAMPLES:
        said = to_speech(lay_out_latex(latex), "bn")
        # functions that have no Bangla name, and words of the author, stay as they are written
        assert set(re.findall(r"[A-Za-z]+", said)) <= {"Var", "hom", "if"}, latex


def test_the_manual_lists_what_there_is():
    sys.path.insert(0, str(ROOT / "tools"))
    from list_formulas import PAGE, write_list

    page = PAGE.read_text(encoding="utf-8")
    assert page == write_list(page), "run `uv run python tools/do.py formulas`"
