"""Every kind of node has its rule in every printer, and nothing else has one."""

from __future__ import annotations

from typing import get_args

import pytest

from quizgen.core.errors import RenderError
from quizgen.question import html
from quizgen.question.data_files import DataFileLink
from quizgen.question.interpolation import PlacedPicture
from quizgen.render import text, typst_document
from quizgen.typeset import nodes, to_latex, to_mathml, to_speech, to_text, to_typst
from quizgen.typeset.prose import (
    Block,
    CodeBlock,
    Inline,
    PlacedField,
    PlainText,
    RoundedMarker,
    Slot,
    TypesetFormula,
    TypesetMaths,
    Unfilled,
)

PRINTERS = [to_latex, to_mathml, to_typst, to_speech, to_text]


def emitter(printer):
    module = printer.__globals__
    return module.get("_format_node", module.get("_say_node"))


@pytest.mark.parametrize("printer", PRINTERS, ids=lambda p: p.__name__)
def test_every_layout_node_has_a_rule_in_every_printer(printer):
    printed = set(get_args(nodes.Node)) - {nodes.Leaf}  # filled before anything is printed
    assert emitter(printer).registry.keys() - {object} == printed


@pytest.mark.parametrize("printer", PRINTERS, ids=lambda p: p.__name__)
def test_a_stranger_is_refused_by_name(printer):
    with pytest.raises(RenderError, match=r"no .* for PlainText"):
        printer(PlainText("x"), "en")


ARGUMENTS = {text.inlines_to_plain_text: [], html._render_piece: ["en", html.OURS]}


@pytest.mark.parametrize(
    "inline", [html._render_piece, typst_document.inlines_to_typst, text.inlines_to_plain_text]
)
def test_every_piece_of_a_filled_sentence_has_a_rule(inline):
    unfilled = {*get_args(Unfilled), RoundedMarker, TypesetFormula}
    filled = set(get_args(Inline)) - unfilled | {TypesetMaths, PlacedPicture, PlacedField, tuple}
    filled |= {DataFileLink} if inline is html._render_piece else set()  # elsewhere its name
    assert inline.registry.keys() - {object} == filled
    with pytest.raises(TypeError, match="Slot"):
        inline(Slot("f"), *ARGUMENTS.get(inline, ["en"]))


@pytest.mark.parametrize(
    "block", [html._render_block, typst_document._reject_block, text._reject_block]
)
def test_every_block_has_a_rule(block):
    assert block.registry.keys() - {object} == set(get_args(Block))


def test_program_text_keeps_its_spaces_in_every_format():
    code = CodeBlock("if a < b:\n    c")
    assert (
        html.blocks_to_html([code], "en")
        == '<pre tabindex="0"><code>if a &lt; b:\n    c</code></pre>'
    )
    assert list(text.blocks_to_plain_text([code])) == ["    if a < b:", "        c"]
    assert typst_document.blocks_to_typst([code], "en") == '#raw("if a < b:\\n    c", block: true);'
