"""The golden table, read by eye in print, and properties that every entry must have."""

from __future__ import annotations

import re
import tomllib
from xml.etree import ElementTree as ET

from latex2mathml.converter import convert as latex_to_mathml
from matplotlib.mathtext import MathTextParser
from sweep import together

from quizgen.typeset import to_latex, to_mathml, to_speech, to_typst
from tests.typeset.table import FORMULAS, GOLDEN, nodes, outputs

TABLE = tomllib.loads(GOLDEN.read_text(encoding="utf-8"))
NODES = nodes()


def test_the_table_is_complete():
    assert set(TABLE) == set(NODES)
    assert len(TABLE) >= 80
    chapter = {key.split()[0] for key in TABLE if re.match(r"F\d\d", key)}
    # F29 is F28 with other neighbours
    assert chapter == {f"F{number:02}" for number in range(1, 47) if number != 29}


@together("key", NODES)
def test_outputs_are_the_reviewed_ones(key):
    assert outputs(NODES[key]) == TABLE[key]


@together("key", NODES)
def test_latex_parses_and_never_closes_a_cloze(key):
    for lang in ("en", "bn"):
        text = to_latex(NODES[key], lang)
        assert "}}" not in text
        assert text.count("{") - text.count(r"\{") == text.count("}") - text.count(r"\}")
        latex_to_mathml(text)


@together("key", [key for key in NODES if r"\begin" not in TABLE[key]["latex"]])
def test_latex_is_drawn_by_mathtext(key):
    text = TABLE[key]["latex"].replace(r"\bmod", r"\ \mathrm{mod}\ ")  # unknown to mathtext
    MathTextParser("path").parse(f"${text}$")


@together("key", NODES)
def test_mathml_is_well_formed_core(key):
    core = {"math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "mfrac", "msqrt", "mroot", "msub"}
    core |= {"mpadded", "msup", "msubsup", "mover", "munder", "munderover", "mtable", "mtr", "mtd"}
    arity = {"mfrac": 2, "mroot": 2, "msub": 2, "msup": 2, "msubsup": 3, "mover": 2}
    arity |= {"munder": 2, "munderover": 3}
    for lang in ("en", "bn"):
        tree = ET.fromstring(to_mathml(NODES[key], lang, display=True))
        for element in tree.iter():
            assert element.tag in core
            assert len(element) == arity.get(element.tag, len(element))
            assert "-" not in (element.text or "")


@together("key", NODES)
def test_speech_holds_words_only(key):
    english, bangla = (to_speech(NODES[key], lang) for lang in ("en", "bn"))
    assert re.fullmatch(r"[A-Za-z0-9 .,;:]+", english)
    # English words stand only where a quantity is named by one
    assert set(re.findall(r"[A-Za-z]+", bangla)) <= {"fold"}
    for text in (english, bangla):
        assert "  " not in text
        assert text == text.strip(" ,")
        assert not re.search(r"[,;][,;]| [,;]", text)


def test_speech_tells_the_formulas_apart():
    said = [TABLE[key]["en"] for key in FORMULAS]
    assert len(set(said)) == len(said)


def test_words_follow_the_language():
    node = NODES["F38 salt and pepper"]
    assert "otherwise" in to_latex(node) + to_typst(node)
    for write in (to_latex, to_typst, to_mathml):
        text = write(node, "bn")
        assert "অন্যথায়" in text
        assert "যদি" in text
        assert "otherwise" not in text
