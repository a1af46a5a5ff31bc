"""Typst: the whole golden table compiles as one accessible PDF, alternative texts included."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest
import typst as engine

from quizgen.typeset import to_speech, to_typst
from quizgen.typeset.typst import typst_string
from tests.typeset.table import nodes


def _document(lang):
    rows = [
        f"[#{typst_string(key)}], math.equation(block: true, alt: {typst_string(to_speech(node, lang))}, "
        f"$ {to_typst(node, lang)} $),"
        for key, node in nodes().items()
    ]
    return "\n".join(
        [
            '#set document(title: "Formulas")',
            f'#set text(lang: "{lang}", font: ("Libertinus Serif", "Hind Siliguri"), size: 9pt)',
            '#show math.equation: set text(font: ("New Computer Modern Math", "Hind Siliguri"))',
            "#set page(width: 21cm, height: 29.7cm, margin: 1cm, columns: 3)",
            "#table(columns: (auto, 1fr), inset: 4pt,",
            *rows,
            ")",
        ]
    )


@pytest.fixture(scope="module")
def fonts():
    spec = importlib.util.find_spec("fontpkg_hind_siliguri")
    folder = Path(spec.origin).with_name("files")
    return engine.Fonts(include_system_fonts=False, font_paths=[str(folder)])


@pytest.mark.parametrize("lang", ["en", "bn"])
def test_every_formula_compiles_without_a_warning(lang, fonts):
    source = _document(lang).encode()
    pdf, warnings = engine.compile_with_warnings(
        source, font_paths=fonts, format="pdf", pdf_standards="ua-1"
    )
    assert pdf.startswith(b"%PDF")
    assert [str(warning) for warning in warnings] == []
