"""Filled blocks and sentences as HTML: the same for a page, a notebook and a web answer.

Pieces are escaped one by one and joined as plain text; only what is handed out is ``Markup``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import singledispatch
from html import escape
from typing import NamedTuple

from markupsafe import Markup

from quizgen import typeset
from quizgen.bank.pictures import PictureFile
from quizgen.question.data_files import DataFileLink
from quizgen.question.interpolation import NBSP, PlacedPicture, unbreakable_groups
from quizgen.typeset import prose
from quizgen.typeset.prose import PlacedField, TypesetMaths


class HtmlDialect(NamedTuple):
    """How a page writes formulas and finds pictures, and whether it has our style.

    ``maths`` writes a formula in a line of text, ``display`` one that is a line of its own;
    ``source`` is where the page finds a picture.
    """

    maths: Callable[[typeset.Node, str], str]
    display: Callable[[typeset.Node, str], str]
    ours: bool = True
    source: Callable[[PictureFile], str] = lambda picture: picture.uri


def display_mathml(node: typeset.Node, lang: str) -> str:
    """Return the MathML of a formula that is a line of its own."""
    return typeset.to_mathml(node, lang, display=True)


OURS = HtmlDialect(typeset.to_mathml, display_mathml)


def inlines_to_html(
    part: prose.Inline | tuple[prose.Inline, ...], lang: str, way: HtmlDialect = OURS
) -> Markup:
    """Return one inline, or a sentence of them, as HTML."""
    return Markup(_render_piece(part, lang, way))


@singledispatch
def _render_piece(
    part: prose.Inline | tuple[prose.Inline, ...], lang: str, _way: HtmlDialect
) -> str:
    """Return the HTML of an inline; each type of them registers what writes it.

    Raises ``TypeError`` for a type without one.
    """
    raise TypeError(f"no HTML for {type(part).__name__} ({lang})")


@_render_piece.register(tuple)
def _render_inlines(parts: tuple[prose.Inline, ...], lang: str, way: HtmlDialect) -> str:
    """Return the HTML of a sentence, with what may not be parted from a formula held to it."""
    if not any(isinstance(part, TypesetMaths) for part in parts):
        return "".join([_render_piece(part, lang, way) for part in parts])
    return "".join([_render_unbroken(group, lang, way) for group in unbreakable_groups(parts)])


def _render_unbroken(group: tuple[prose.Inline, ...], lang: str, way: HtmlDialect) -> str:
    """Return the HTML of pieces inside which no line may end.

    They are held by our style where there is one, else by blanks that do not break.
    """
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
            if isinstance(part, prose.PlainText)
            else _render_piece(part, lang, way)
            for part in group
        ]
    )


def _escape_html(text: str) -> str:
    """Return text that is safe between tags and inside attributes.

    Quotes are written as numbers, as ``markupsafe`` writes them: pages stay equal to those that
    a Jinja template escapes.
    """
    return escape(text, quote=False).replace('"', "&#34;").replace("'", "&#39;")


@_render_piece.register
def _render_words(part: prose.PlainText, _lang: str, _way: HtmlDialect) -> str:
    """Return plain text, escaped."""
    return _escape_html(part.text)


@_render_piece.register
def _render_maths(part: TypesetMaths, lang: str, way: HtmlDialect) -> str:
    """Return a formula as the page's dialect writes it."""
    return way.maths(part.node, lang)


@_render_piece.register
def _render_code(part: prose.InlineCode, _lang: str, _way: HtmlDialect) -> str:
    """Return program text in a sentence; a whole program keeps its lines."""
    first, *more = (_escape_html(line) for line in part.text.split("\n"))
    lines = (line.replace("  ", "\u00a0 ") for line in (first, *more))
    return f"<code><br/>{'<br/>'.join(lines)}</code>" if more else f"<code>{first}</code>"


@_render_piece.register
def _render_data_file(part: DataFileLink, _lang: str, way: HtmlDialect) -> str:
    """Return a link to a data file, which our own pages have the browser save."""
    saved = f' download="{_escape_html(part.text)}"' if way.ours else ""
    return f'<a href="{part.address}"{saved}><code>{_escape_html(part.text)}</code></a>'


@_render_piece.register
def _render_styled(part: prose.Emphasis, lang: str, way: HtmlDialect) -> str:
    """Return emphasised or strong text; the tag is the style's name."""
    return f"<{part.style}>{_render_piece(part.children, lang, way)}</{part.style}>"


@_render_piece.register
def _render_picture(part: PlacedPicture, _lang: str, way: HtmlDialect) -> str:
    """Return an ``img`` with its words; sizes in CSS pixels, of which 4 are 3 points."""
    file = part.picture
    size = f'width="{file.width_pt * 4 / 3:.0f}" height="{file.height_pt * 4 / 3:.0f}"'
    named = ' class="picture"' if way.ours else ""
    return f'<img{named} src="{way.source(file)}" alt="{_escape_html(part.alt)}" {size}/>'


@_render_piece.register
def _render_field(part: PlacedField, _lang: str, way: HtmlDialect) -> str:
    """Return a blank; a page that is answered puts the field itself there (``put_fields``)."""
    if not way.ours:
        return part.text
    return f'<span class="blank" data-field="{part.label}">{part.text}</span>'


_BLANK = re.compile(r'<span class="blank" data-field="([a-j]?)">[^<]*</span>')


def put_fields(page: str, fields: Mapping[str, str]) -> Markup:
    """Return HTML made here with the fields of parts, by their labels, for the blanks in it."""
    return Markup(_BLANK.sub(lambda found: fields.get(found[1], found[0]), page))


@singledispatch
def _render_block(part: prose.Block, lang: str, _way: HtmlDialect) -> str:
    """Return the HTML of a block; each type of them registers what writes it.

    Raises ``TypeError`` for a type without one.
    """
    raise TypeError(f"no HTML for {type(part).__name__} ({lang})")


@_render_block.register
def _render_paragraph(part: prose.Paragraph, lang: str, way: HtmlDialect) -> str:
    """Return a ``p`` element around the sentence."""
    return f"<p>{_render_piece(part.children, lang, way)}</p>"


@_render_block.register
def _render_code_block(part: prose.CodeBlock, _lang: str, way: HtmlDialect) -> str:
    """Return a block of program text; a long line scrolls, also by keyboard."""
    scrolls = ' tabindex="0"' if way.ours else ""
    return f"<pre{scrolls}><code>{_escape_html(part.text)}</code></pre>"


@_render_block.register
def _render_list(part: prose.ListBlock, lang: str, way: HtmlDialect) -> str:
    """Return a list; an item of one sentence has no paragraph around it."""
    tag = "ol" if part.ordered else "ul"
    items = "".join(
        [f"<li>{blocks_to_html(item, lang, way, tight=True)}</li>" for item in part.items]
    )
    return f"<{tag}>{items}</{tag}>"


@_render_block.register
def _render_table(part: prose.TableBlock, lang: str, way: HtmlDialect) -> str:
    """Return rows under a head; a wide table scrolls, also by keyboard."""
    head = "".join([_render_head_cell(cell, lang, way) for cell in part.head])
    rows = [[f"<td>{_render_piece(cell, lang, way)}</td>" for cell in cells] for cells in part.rows]
    body = "".join([f"<tr>{''.join(row)}</tr>" for row in rows])
    head = f"<thead><tr>{head}</tr></thead>" if any(part.head) else ""
    table = f"<table>{head}<tbody>{body}</tbody></table>"
    return f'<div class="scroll" tabindex="0">{table}</div>' if way.ours else table


def _render_head_cell(cell: tuple[prose.Inline, ...], lang: str, way: HtmlDialect) -> str:
    """Return a head cell; a lone formula is spelled out for listeners.

    An empty cell is no head: a screen reader would announce it for every row.
    """
    if not cell:
        return "<td></td>"
    shown = _render_piece(cell, lang, way)
    if way.ours and len(cell) == 1 and isinstance(cell[0], TypesetMaths):
        spoken = _escape_html(typeset.to_speech(cell[0].node, lang))
        hidden = f'<span class="hidden">{spoken}</span>'
        return f'<th>{hidden}<span aria-hidden="true">{shown}</span></th>'
    return f"<th>{shown}</th>"


def blocks_to_html(
    parts: Sequence[prose.Block], lang: str, way: HtmlDialect = OURS, *, tight: bool = False
) -> Markup:
    """Return blocks as HTML; ``tight`` drops the paragraph around a single sentence."""
    if tight and len(parts) == 1 and isinstance(parts[0], prose.Paragraph):
        return inlines_to_html(parts[0].children, lang, way)
    made = "".join([_render_block(part, lang, way) for part in parts])
    return Markup(made)


def display_to_html(maths: TypesetMaths, lang: str, way: HtmlDialect = OURS) -> Markup:
    """Return a worked line on its own; a long one scrolls, also by keyboard."""
    attributes = ' class="line" tabindex="0"' if way.ours else ""
    made = f"<div{attributes}>{way.display(maths.node, lang)}</div>"
    return Markup(made)


def chain_to_html(maths: TypesetMaths, lang: str, way: HtmlDialect = OURS) -> Markup:
    """Return a worked line on its own, broken before its signs where the page is narrow."""
    pieces = typeset.split_chain(maths.node)
    if not way.ours or len(pieces) == 1:
        return display_to_html(maths, lang, way)
    made = "".join(way.display(piece, lang) for piece in pieces)
    return Markup('<div class="line worked" tabindex="0">{}</div>').format(Markup(made))
