"""Every kind of node has its rule in every printer, and nothing else has one."""

from __future__ import annotations

from typing import get_args

import pytest

from quizgen.bank.prose import About, Block, CodeBlock, Inline, Printed, Slot, Unfilled, Words
from quizgen.errors import RenderError
from quizgen.question import markup
from quizgen.question.shown import Maths, PlacedPicture
from quizgen.render import text, typ
from quizgen.typeset import latex, mathml, nodes, spoken, typst

PRINTERS = [latex, mathml, typst, spoken]


def emitter(printer):
    module = printer.__globals__
    return module.get("_emit", module.get("_say"))


@pytest.mark.parametrize("printer", PRINTERS, ids=lambda p: p.__name__)
def test_every_layout_node_has_a_rule_in_every_printer(printer):
    assert emitter(printer).registry.keys() - {object} == set(get_args(nodes.Node))


@pytest.mark.parametrize("printer", PRINTERS, ids=lambda p: p.__name__)
def test_a_stranger_is_refused_by_name(printer):
    with pytest.raises(RenderError, match=r"no .* for Words"):
        printer(Words("x"), "en")


ARGUMENTS = {text.inline: [], markup._piece: ["en", markup.OURS]}


@pytest.mark.parametrize("inline", [markup._piece, typ.inline, text.inline])
def test_every_piece_of_a_filled_sentence_has_a_rule(inline):
    unfilled = {*get_args(Unfilled), About, Printed}
    filled = set(get_args(Inline)) - unfilled | {Maths, PlacedPicture, tuple}
    assert inline.registry.keys() - {object} == filled
    with pytest.raises(TypeError, match="Slot"):
        inline(Slot("f"), *ARGUMENTS.get(inline, ["en"]))


@pytest.mark.parametrize("block", [markup._block, typ._block, text._lines])
def test_every_block_has_a_rule(block):
    assert block.registry.keys() - {object} == set(get_args(Block))


def test_program_text_keeps_its_spaces_in_every_format():
    code = CodeBlock("if a < b:\n    c")
    assert markup.blocks([code], "en") == '<pre tabindex="0"><code>if a &lt; b:\n    c</code></pre>'
    assert list(text.blocks([code])) == ["    if a < b:", "        c"]
    assert typ.blocks([code], "en") == '#raw("if a < b:\\n    c", block: true);'
