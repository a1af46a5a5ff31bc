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
from quizgen.bank import markdown
from quizgen.bank.pictures import PictureFile
from quizgen.question.data_files import DataFileLink
from quizgen.question.inlines import PlacedPicture, TypesetMaths
from quizgen.question.interpolation import NBSP, unbreakable_groups


class HtmlDialect(NamedTuple):
    """What a page understands: how its formulas are written, and whether it has our style.

    ``maths`` writes a formula in a line of text, ``display`` one that is a line of its own;
    ``source`` is where the page finds a picture.
    """

    maths: Callable[[typeset.Node, str], str]
    display: Callable[[typeset.Node, str], str]
    ours: bool = True
    source: Callable[[PictureFile], str] = lambda picture: picture.uri


def display_mathml(node: typeset.Node, lang: str) -> str:
    """A formula that is a line of its own."""
    return typeset.to_mathml(node, lang, display=True)


OURS = HtmlDialect(typeset.to_mathml, display_mathml)


def inlines_to_html(
    part: markdown.Inline | tuple[markdown.Inline, ...], lang: str, way: HtmlDialect = OURS
) -> Markup:
    """Inlines as HTML."""
    return Markup(_render_piece(part, lang, way))


@singledispatch
def _render_piece(
    part: markdown.Inline | tuple[markdown.Inline, ...], lang: str, _way: HtmlDialect
) -> str:
    raise TypeError(f"no HTML for {type(part).__name__} ({lang})")


@_render_piece.register(tuple)
def _render_inlines(parts: tuple[markdown.Inline, ...], lang: str, way: HtmlDialect) -> str:
    if not any(isinstance(part, TypesetMaths) for part in parts):
        return "".join([_render_piece(part, lang, way) for part in parts])
    return "".join([_render_unbroken(group, lang, way) for group in unbreakable_groups(parts)])


def _render_unbroken(group: tuple[markdown.Inline, ...], lang: str, way: HtmlDialect) -> str:
    """Pieces inside which no line may end: held by our style, or by blanks that do not break."""
    if len(group) == 1:
        return _render_piece(group[0], lang, way)
    if way.ours:
        return (
            f"<span "
            f'class="tied">{"".join([_render_piece(part, lang, way) for part in group])}</span>'
        )
    return "".join(
        [
            _render_piece(part, lang, way).replace(" ", NBSP)
            if isinstance(part, markdown.PlainText)
            else _render_piece(part, lang, way)
            for part in group
        ]
    )


def _escape_html(text: str) -> str:
    return escape(text, quote=False).replace('"', "&#34;").replace("'", "&#39;")


@_render_piece.register
def _render_words(part: markdown.PlainText, _lang: str, _way: HtmlDialect) -> str:
    return _escape_html(part.text)


@_render_piece.register
def _render_maths(part: TypesetMaths, lang: str, way: HtmlDialect) -> str:
    return way.maths(part.node, lang)


@_render_piece.register
def _render_code(part: markdown.InlineCode, _lang: str, _way: HtmlDialect) -> str:
    return f"<code>{_escape_html(part.text)}</code>"


@_render_piece.register
def _render_data_file(part: DataFileLink, _lang: str, way: HtmlDialect) -> str:
    saved = f' download="{_escape_html(part.text)}"' if way.ours else ""
    return f'<a href="{part.address}"{saved}><code>{_escape_html(part.text)}</code></a>'


@_render_piece.register
def _render_styled(part: markdown.Emphasis, lang: str, way: HtmlDialect) -> str:
    return f"<{part.style}>{_render_piece(part.children, lang, way)}</{part.style}>"


@_render_piece.register
def _render_picture(part: PlacedPicture, _lang: str, way: HtmlDialect) -> str:
    file = part.picture
    size = f'width="{file.width_pt * 4 / 3:.0f}" height="{file.height_pt * 4 / 3:.0f}"'
    named = ' class="picture"' if way.ours else ""
    return f'<img{named} src="{way.source(file)}" alt="{_escape_html(part.alt)}" {size}/>'


@singledispatch
def _render_block(part: markdown.Block, lang: str, _way: HtmlDialect) -> str:
    raise TypeError(f"no HTML for {type(part).__name__} ({lang})")


@_render_block.register
def _render_paragraph(part: markdown.Paragraph, lang: str, way: HtmlDialect) -> str:
    return f"<p>{_render_piece(part.children, lang, way)}</p>"


@_render_block.register
def _code_block(part: markdown.CodeBlock, _lang: str, way: HtmlDialect) -> str:
    """Program text; a long line scrolls, also by keyboard."""
    scrolls = ' tabindex="0"' if way.ours else ""
    return f"<pre{scrolls}><code>{_escape_html(part.text)}</code></pre>"


@_render_block.register
def _render_list(part: markdown.ListBlock, lang: str, way: HtmlDialect) -> str:
    tag = "ol" if part.ordered else "ul"
    items = "".join(
        [f"<li>{blocks_to_html(item, lang, way, tight=True)}</li>" for item in part.items]
    )
    return f"<{tag}>{items}</{tag}>"


@_render_block.register
def _render_table(part: markdown.TableBlock, lang: str, way: HtmlDialect) -> str:
    """Rows under a head; a wide one scrolls, also by keyboard."""
    head = "".join([_head_cell(cell, lang, way) for cell in part.head])
    rows = [[f"<td>{_render_piece(cell, lang, way)}</td>" for cell in cells] for cells in part.rows]
    body = "".join([f"<tr>{''.join(row)}</tr>" for row in rows])
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    return f'<div class="scroll" tabindex="0">{table}</div>' if way.ours else table


def _head_cell(cell: tuple[markdown.Inline, ...], lang: str, way: HtmlDialect) -> str:
    """A head cell; a lone formula is spelled out for listeners, and empty is no head."""
    if not cell:
        return "<td></td>"
    shown = _render_piece(cell, lang, way)
    if way.ours and len(cell) == 1 and isinstance(cell[0], TypesetMaths):
        spoken = _escape_html(typeset.to_speech(cell[0].node, lang))
        hidden = f'<span class="hidden">{spoken}</span>'
        return f'<th>{hidden}<span aria-hidden="true">{shown}</span></th>'
    return f"<th>{shown}</th>"


def blocks_to_html(
    parts: Sequence[markdown.Block], lang: str, way: HtmlDialect = OURS, *, tight: bool = False
) -> Markup:
    """Blocks as HTML; ``tight`` drops the paragraph around a single sentence."""
    if tight and len(parts) == 1 and isinstance(parts[0], markdown.Paragraph):
        return inlines_to_html(parts[0].children, lang, way)
    made = "".join([_render_block(part, lang, way) for part in parts])
    return Markup(made)


def display_to_html(maths: TypesetMaths, lang: str, way: HtmlDialect = OURS) -> Markup:
    """A worked line on its own; a long one scrolls, also by keyboard."""
    attributes = ' class="line" tabindex="0"' if way.ours else ""
    made = f"<div{attributes}>{way.display(maths.node, lang)}</div>"
    return Markup(made)
