"""Filled blocks and sentences as HTML: the same for a page, a notebook and a web answer.

Pieces are escaped one by one and joined as plain text; only what is handed out is ``Markup``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import singledispatch
from html import escape
from typing import NamedTuple

from markupsafe import Markup

from quizgen import typeset
from quizgen.bank import prose
from quizgen.bank.pictures import PictureFile
from quizgen.question.filling import NBSP, tied
from quizgen.question.shown import Maths, PlacedPicture


class Manner(NamedTuple):
    """What a page understands: how its formulas are written, and whether it has our style.

    ``maths`` writes a formula in a line of text, ``display`` one that is a line of its own;
    ``source`` is where the page finds a picture.
    """

    maths: Callable[[typeset.Node, str], str]
    display: Callable[[typeset.Node, str], str]
    ours: bool = True
    source: Callable[[PictureFile], str] = lambda picture: picture.uri


def mathml_line(node: typeset.Node, lang: str) -> str:
    """A formula that is a line of its own."""
    return typeset.mathml(node, lang, display=True)


OURS = Manner(typeset.mathml, mathml_line)


def inline(part: prose.Inline | tuple[prose.Inline, ...], lang: str, way: Manner = OURS) -> Markup:
    """Inlines as HTML."""
    return Markup(_piece(part, lang, way))


@singledispatch
def _piece(part: prose.Inline | tuple[prose.Inline, ...], lang: str, _way: Manner) -> str:
    raise TypeError(f"no HTML for {type(part).__name__} ({lang})")


@_piece.register(tuple)
def _inlines(parts: tuple[prose.Inline, ...], lang: str, way: Manner) -> str:
    if not any(isinstance(part, Maths) for part in parts):
        return "".join([_piece(part, lang, way) for part in parts])
    return "".join([_together(group, lang, way) for group in tied(parts)])


def _together(group: tuple[prose.Inline, ...], lang: str, way: Manner) -> str:
    """Pieces inside which no line may end: held by our style, or by blanks that do not break."""
    if len(group) == 1:
        return _piece(group[0], lang, way)
    if way.ours:
        return f'<span class="tied">{"".join([_piece(part, lang, way) for part in group])}</span>'
    return "".join([
        _piece(part, lang, way).replace(" ", NBSP) if isinstance(part, prose.Words)
        else _piece(part, lang, way)
        for part in group
    ])  # fmt: skip


def _escaped(text: str) -> str:
    return escape(text, quote=False).replace('"', "&#34;").replace("'", "&#39;")


@_piece.register
def _words(part: prose.Words, _lang: str, _way: Manner) -> str:
    return _escaped(part.text)


@_piece.register
def _maths(part: Maths, lang: str, way: Manner) -> str:
    return way.maths(part.node, lang)


@_piece.register
def _code(part: prose.Code, _lang: str, _way: Manner) -> str:
    return f"<code>{_escaped(part.text)}</code>"


@_piece.register
def _styled(part: prose.Styled, lang: str, way: Manner) -> str:
    return f"<{part.style}>{_piece(part.children, lang, way)}</{part.style}>"


@_piece.register
def _picture(part: PlacedPicture, _lang: str, way: Manner) -> str:
    file = part.picture
    size = f'width="{file.width_pt * 4 / 3:.0f}" height="{file.height_pt * 4 / 3:.0f}"'
    named = ' class="picture"' if way.ours else ""
    return f'<img{named} src="{way.source(file)}" alt="{_escaped(part.alt)}" {size}/>'


@singledispatch
def _block(part: prose.Block, lang: str, _way: Manner) -> str:
    raise TypeError(f"no HTML for {type(part).__name__} ({lang})")


@_block.register
def _paragraph(part: prose.Paragraph, lang: str, way: Manner) -> str:
    return f"<p>{_piece(part.children, lang, way)}</p>"


@_block.register
def _code_block(part: prose.CodeBlock, _lang: str, way: Manner) -> str:
    """Program text; a long line scrolls, also by keyboard."""
    scrolls = ' tabindex="0"' if way.ours else ""
    return f"<pre{scrolls}><code>{_escaped(part.text)}</code></pre>"


@_block.register
def _items(part: prose.Items, lang: str, way: Manner) -> str:
    tag = "ol" if part.ordered else "ul"
    items = "".join([f"<li>{blocks(item, lang, way, tight=True)}</li>" for item in part.items])
    return f"<{tag}>{items}</{tag}>"


@_block.register
def _table(part: prose.Table, lang: str, way: Manner) -> str:
    """Rows under a head; a wide one scrolls, also by keyboard."""
    head = "".join([_head_cell(cell, lang, way) for cell in part.head])
    rows = [[f"<td>{_piece(cell, lang, way)}</td>" for cell in cells] for cells in part.rows]
    body = "".join([f"<tr>{''.join(row)}</tr>" for row in rows])
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    return f'<div class="scroll" tabindex="0">{table}</div>' if way.ours else table


def _head_cell(cell: tuple[prose.Inline, ...], lang: str, way: Manner) -> str:
    """A head cell; a lone formula is spelled out for listeners, and empty is no head."""
    if not cell:
        return "<td></td>"
    shown = _piece(cell, lang, way)
    if way.ours and len(cell) == 1 and isinstance(cell[0], Maths):
        spoken = _escaped(typeset.spoken(cell[0].node, lang))
        hidden = f'<span class="hidden">{spoken}</span>'
        return f'<th>{hidden}<span aria-hidden="true">{shown}</span></th>'
    return f"<th>{shown}</th>"


def blocks(
    parts: Sequence[prose.Block], lang: str, way: Manner = OURS, *, tight: bool = False
) -> Markup:
    """Blocks as HTML; ``tight`` drops the paragraph around a single sentence."""
    if tight and len(parts) == 1 and isinstance(parts[0], prose.Paragraph):
        return inline(parts[0].children, lang, way)
    made = "".join([_block(part, lang, way) for part in parts])
    return Markup(made)


def display(maths: Maths, lang: str, way: Manner = OURS) -> Markup:
    """A worked line on its own; a long one scrolls, also by keyboard."""
    attributes = ' class="line" tabindex="0"' if way.ours else ""
    made = f"<div{attributes}>{way.display(maths.node, lang)}</div>"
    return Markup(made)
