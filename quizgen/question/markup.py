"""Filled blocks and sentences as HTML: the same for a page, a notebook and a web answer."""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch

from markupsafe import Markup, escape

from quizgen import typeset
from quizgen.bank import prose
from quizgen.question.filling import tied
from quizgen.question.shown import Maths


@singledispatch
def inline(part: prose.Inline | tuple[prose.Inline, ...], lang: str) -> Markup:
    """Inlines as HTML."""
    raise TypeError(f"no HTML for {type(part).__name__} ({lang})")


@inline.register(tuple)
def _inlines(parts: tuple[prose.Inline, ...], lang: str) -> Markup:
    return Markup("").join(_together(group, lang) for group in tied(parts))


def _together(group: tuple[prose.Inline, ...], lang: str) -> Markup:
    body = Markup("").join(inline(part, lang) for part in group)
    return Markup('<span class="tied">{}</span>').format(body) if len(group) > 1 else body


@inline.register
def _words(part: prose.Words, _lang: str) -> Markup:
    return escape(part.text)


@inline.register
def _maths(part: Maths, lang: str) -> Markup:
    return Markup(typeset.mathml(part.node, lang))


@inline.register
def _code(part: prose.Code, _lang: str) -> Markup:
    return Markup("<code>{}</code>").format(part.text)


@inline.register
def _styled(part: prose.Styled, lang: str) -> Markup:
    return Markup("<{0}>{1}</{0}>").format(Markup(part.style), inline(part.children, lang))


@singledispatch
def block(part: prose.Block, lang: str) -> Markup:
    """A block as HTML."""
    raise TypeError(f"no HTML for {type(part).__name__} ({lang})")


@block.register
def _paragraph(part: prose.Paragraph, lang: str) -> Markup:
    return Markup("<p>{}</p>").format(inline(part.children, lang))


@block.register
def _code_block(part: prose.CodeBlock, _lang: str) -> Markup:
    return Markup('<pre tabindex="0"><code>{}</code></pre>').format(part.text)


@block.register
def _items(part: prose.Items, lang: str) -> Markup:
    tag = Markup("ol" if part.ordered else "ul")
    items = Markup("").join(
        Markup("<li>{}</li>").format(blocks(item, lang, tight=True)) for item in part.items
    )
    return Markup("<{0}>{1}</{0}>").format(tag, items)


@block.register
def _table(part: prose.Table, lang: str) -> Markup:
    def row(cells: tuple[tuple[prose.Inline, ...], ...]) -> Markup:
        tags = [Markup("<td>{}</td>").format(inline(cell, lang)) for cell in cells]
        return Markup("<tr>{}</tr>").format(Markup("").join(tags))

    head = Markup("").join(_head_cell(cell, lang) for cell in part.head)
    body = Markup("").join(row(cells) for cells in part.rows)
    return Markup("<table><thead><tr>{}</tr></thead><tbody>{}</tbody></table>").format(head, body)


def _head_cell(cell: tuple[prose.Inline, ...], lang: str) -> Markup:
    """A head cell; a lone formula is spelled out for listeners, and empty is no head."""
    if not cell:
        return Markup("<td></td>")
    if len(cell) == 1 and isinstance(cell[0], Maths):
        shown = Markup('<span class="hidden">{}</span><span aria-hidden="true">{}</span>')
        spoken = typeset.spoken(cell[0].node, lang)
        return Markup("<th>{}</th>").format(shown.format(spoken, inline(cell, lang)))
    return Markup("<th>{}</th>").format(inline(cell, lang))


def blocks(parts: Sequence[prose.Block], lang: str, *, tight: bool = False) -> Markup:
    """Blocks as HTML; ``tight`` drops the paragraph around a single sentence."""
    if tight and len(parts) == 1 and isinstance(parts[0], prose.Paragraph):
        return inline(parts[0].children, lang)
    return Markup("").join(block(part, lang) for part in parts)


def display(maths: Maths, lang: str) -> Markup:
    """A worked line on its own; a long one scrolls, also by keyboard."""
    body = Markup(typeset.mathml(maths.node, lang, display=True))
    return Markup('<div class="line" tabindex="0">{}</div>').format(body)
