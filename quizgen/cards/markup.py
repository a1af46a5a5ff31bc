r"""What stands on a card, written as HTML with MathJax or as plain text.

The blocks of ``quizgen.bank.markdown`` are used as they are; a card adds five of its own: a worked
line, a picture, a formula with a hidden side, a part that folds, and a label.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import singledispatch
from html import escape
from typing import Any, TypeGuard

from quizgen import typeset
from quizgen.bank.markdown import leaves
from quizgen.figures import Figure
from quizgen.question.interpolation import PlacedPicture, unbreakable_groups
from quizgen.typeset.nodes import RELATION, MathRow, Node
from quizgen.typeset.prose import (
    CodeBlock,
    Emphasis,
    Inline,
    InlineCode,
    ListBlock,
    Paragraph,
    PlacedField,
    PlainText,
    TableBlock,
    TypesetMaths,
)


@dataclass(frozen=True, slots=True)
class DisplayMaths:
    """A formula on a line of its own; a chain of equations may wrap at its signs."""

    maths: TypesetMaths


@dataclass(frozen=True, slots=True)
class ClozeHole:
    """A formula with one side to be recalled: what is visible, what is hidden, its number."""

    shown: TypesetMaths
    hidden: TypesetMaths
    number: int


@dataclass(frozen=True, slots=True)
class CardPicture:
    """A figure on a card, with its alt text."""

    name: str
    figure: Figure
    alt: str

    @property
    def data(self) -> bytes:
        """The SVG file, which every language shares."""
        return self.figure.standalone_svg

    @property
    def shade(self) -> str:
        """The CSS class for dark cards: line art is inverted, a photograph stays on white."""
        return "keep" if b"<image" in self.data else "invert"

    @property
    def file(self) -> str:
        """The name of the media file, unique for its content."""
        return f"qg_{self.name}_{hashlib.sha256(self.data).hexdigest()[:12]}.svg"


@dataclass(frozen=True, slots=True)
class Details:
    """Blocks that are shown after a tap on their title."""

    title: str
    body: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class NoBreak:
    """Inlines between which a line must not end."""

    parts: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class InLanguage:
    """Blocks in one language, marked as such for screen readers and fonts."""

    lang: str
    body: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class CardLabel:
    """A short line that says what is asked, or what follows."""

    text: str


LATEX = "en"
"""Language of words in formulas: MathJax sets Bangla letter by letter, without conjuncts."""


def to_mathjax(node: Node) -> str:
    r"""Return an inline formula for MathJax.

    Parameters
    ----------
    node : Node

    Returns
    -------
    str
        HTML, between ``\(`` and ``\)``.
    """
    if _is_relation_row(node) and len(node.items) > len(("left", "=", "right")):
        return " ".join(_iter_mathjax_pieces(node, ""))
    return rf"\({escape(typeset.to_latex(node, LATEX), quote=False)}\)"


def _is_relation_row(node: Node) -> TypeGuard[MathRow]:
    """Return whether a formula is a row of sides with a relation sign between any two of them."""
    if not isinstance(node, MathRow) or node.level != RELATION:
        return False
    # "not (...)" is on the level of relations, too, and has no sign to wrap at.
    return len(node.items) > 1 and len(node.items) % 2 == 1


def equations_to_mathjax(node: Node) -> str:
    """Return a chain of equations as one formula per side, so that a narrow screen can wrap it."""
    style = r"\displaystyle "
    if not _is_relation_row(node):
        return _format_mathjax(style, typeset.to_latex(node, LATEX))
    return " ".join(_iter_mathjax_pieces(node, style))


def _iter_mathjax_pieces(node: MathRow, style: str) -> Iterator[str]:
    """Yield each side of a chain with the sign in front of it, for MathJax."""
    first, *rest = node.items
    yield _format_mathjax(style, typeset.to_latex(first, LATEX))
    for sign, side in zip(rest[::2], rest[1::2], strict=True):
        empty = "{}" if side == MathRow(()) else ""  # keeps the space after a sign at the end
        yield _format_mathjax(
            style, "{}" + typeset.to_latex(MathRow((sign, side), RELATION), LATEX) + empty
        )


def _format_mathjax(style: str, text: str) -> str:
    """Return LaTeX in MathJax's brackets, in a text or display style."""
    return rf"\({style}{escape(text, quote=False)}\)"


_MARKS = re.compile(r"\\(?=[(\[]|begin|(?:eq)?ref)|\[(?=\$|/?latex|sound:|anki:)|\{(?=\{)|\}(?=\})")
"""Where MathJax or Anki would take words for a formula, a sound or a blank of theirs."""
BULLET = "•"
"""Before an item in plain text; a spreadsheet would take a hyphen for the start of a formula."""
WORD_JOINER = "\u2060"


def escape_words(words: str, *, quote: bool = False) -> str:
    """Return words as HTML that no reader of the card takes for markup, formulas or clozes."""
    if _MARKS.search(words):
        words = _MARKS.sub(lambda mark: mark[0] + WORD_JOINER, words)
    return escape(words, quote=quote)


@singledispatch
def to_card_html(part: object, lang: str, *, ask: bool | None = None) -> str:
    """Return a block, an inline or a tuple of them as HTML of a card.

    Parameters
    ----------
    part : block, inline or tuple
    lang : str
    ask : bool, optional
        For a hidden side: True hides it, False shows it, None writes an Anki cloze.

    Raises
    ------
    TypeError
        If the part has no form on a card.
    """
    del lang, ask
    raise TypeError(type(part).__name__)


@to_card_html.register
def _format_blocks_html(part: tuple, lang: str, *, ask: bool | None = None) -> str:  # type: ignore[type-arg]
    """Return several blocks or inlines as HTML."""
    groups = unbreakable_groups(part)
    return "".join(to_card_html(g[0] if len(g) == 1 else NoBreak(g), lang, ask=ask) for g in groups)


@to_card_html.register
def _format_no_break_html(part: NoBreak, lang: str, *, ask: bool | None = None) -> str:
    """Return inlines without a line break as HTML."""
    inside = "".join(to_card_html(item, lang, ask=ask) for item in part.parts)
    return f'<span class="qg-together">{inside}</span>'


@to_card_html.register
def _format_plain_text_html(part: PlainText, lang: str, *, ask: bool | None = None) -> str:
    """Return words as HTML."""
    del lang, ask
    return escape_words(part.text)


@to_card_html.register
def _format_field_html(part: PlacedField, lang: str, *, ask: bool | None = None) -> str:
    """Return the field of a part as a blank."""
    del lang, ask
    return escape_words(part.text)


@to_card_html.register
def _format_typeset_maths_html(part: TypesetMaths, lang: str, *, ask: bool | None = None) -> str:
    """Return a formula as HTML."""
    del lang, ask
    return to_mathjax(part.node)


@to_card_html.register
def _format_inline_code_html(part: InlineCode, lang: str, *, ask: bool | None = None) -> str:
    """Return code as HTML."""
    del lang, ask
    return f"<code>{escape_words(part.text)}</code>"


@to_card_html.register
def _format_emphasis_html(part: Emphasis, lang: str, *, ask: bool | None = None) -> str:
    """Return emphasised words as HTML."""
    return f"<{part.style}>{to_card_html(part.children, lang, ask=ask)}</{part.style}>"


@to_card_html.register
def _format_paragraph_html(part: Paragraph, lang: str, *, ask: bool | None = None) -> str:
    """Return a paragraph as HTML."""
    return f"<p>{to_card_html(part.children, lang, ask=ask)}</p>"


@to_card_html.register
def _format_code_block_html(part: CodeBlock, lang: str, *, ask: bool | None = None) -> str:
    """Return a block of code as HTML."""
    del lang, ask
    lines = escape_words(part.text).replace("\n", "<br>")
    return f"<pre>{lines}</pre>"


@to_card_html.register
def _format_list_block_html(part: ListBlock, lang: str, *, ask: bool | None = None) -> str:
    """Return a list as HTML."""
    tag = "ol" if part.ordered else "ul"
    items = "".join(f"<li>{_render_tight_item(item, lang, ask)}</li>" for item in part.items)
    return f"<{tag}>{items}</{tag}>"


def _render_tight_item(item: tuple[Any, ...], lang: str, ask: bool | None) -> str:
    """Return a list item as HTML, without ``<p>`` around a single paragraph."""
    single = len(item) == 1 and isinstance(item[0], Paragraph)
    return to_card_html(item[0].children if single else item, lang, ask=ask)


@to_card_html.register
def _format_table_block_html(part: TableBlock, lang: str, *, ask: bool | None = None) -> str:
    """Return a table as HTML."""

    def row(cells: Iterable[Sequence[Inline]], tag: str) -> str:
        """Return one row of the table; ``tag`` is ``th`` or ``td``."""
        return "".join(f"<{tag}>{to_card_html(cell, lang, ask=ask)}</{tag}>" for cell in cells)

    head = f"<tr>{row(part.head, 'th')}</tr>"
    body = "".join(f"<tr>{row(cells, 'td')}</tr>" for cells in part.rows)
    return f"<table>{head}{body}</table>"


@to_card_html.register
def _format_display_maths_html(part: DisplayMaths, lang: str, *, ask: bool | None = None) -> str:
    """Return a formula on its own line as HTML."""
    del lang, ask
    return f'<div class="qg-line">{equations_to_mathjax(part.maths.node)}</div>'


@to_card_html.register
def _format_cloze_hole_html(part: ClozeHole, lang: str, *, ask: bool | None = None) -> str:
    """Return a formula with a hidden side as HTML; ``ask`` as for `to_card_html`."""
    del lang
    shown, hidden = (equations_to_mathjax(side.node) for side in (part.shown, part.hidden))
    if ask is None:
        hidden = f"{{{{c{part.number}::{hidden}}}}}"
    elif ask:
        hidden = "<b>[…]</b>"
    return f'<div class="qg-line">{shown} {hidden}</div>'


@to_card_html.register
def _format_card_picture_html(part: CardPicture, lang: str, *, ask: bool | None = None) -> str:
    """Return a figure as HTML."""
    del lang, ask
    alt = escape_words(part.alt, quote=True)
    return f'<img class="qg-{part.shade}" src="{escape(part.file, quote=True)}" alt="{alt}">'


@to_card_html.register
def _format_placed_picture_html(part: PlacedPicture, lang: str, *, ask: bool | None = None) -> str:
    """Return a picture of the prose as HTML."""
    del lang, ask
    wide, alt = f"{part.picture.width_pt * 4 / 3:.0f}", escape_words(part.alt, quote=True)
    return f'<img class="qg-keep" src="{part.picture.file}" alt="{alt}" width="{wide}">'


@to_card_html.register
def _format_details_html(part: Details, lang: str, *, ask: bool | None = None) -> str:
    """Return blocks under a title as HTML."""
    body = to_card_html(part.body, lang, ask=ask)
    return f"<details><summary>{escape_words(part.title)}</summary>{body}</details>"


@to_card_html.register
def _format_in_language_html(part: InLanguage, lang: str, *, ask: bool | None = None) -> str:
    """Return blocks in their language as HTML."""
    del lang
    return (
        f'<div lang="{escape(part.lang, quote=True)}'
        f'">{to_card_html(part.body, part.lang, ask=ask)}</div>'
    )


@to_card_html.register
def _format_card_label_html(part: CardLabel, lang: str, *, ask: bool | None = None) -> str:
    """Return a label as HTML."""
    del lang, ask
    return f'<div class="qg-label">{escape_words(part.text)}</div>'


@singledispatch
def to_card_text(part: object, *, ask: bool = False) -> str:
    """Return a block, an inline or a tuple of them as plain text, formulas in Unicode.

    Parameters
    ----------
    part : block, inline or tuple
    ask : bool
        Whether to leave hidden sides out.

    Raises
    ------
    TypeError
        If the part has no form as text.
    """
    del ask
    raise TypeError(type(part).__name__)


@to_card_text.register
def _format_blocks_text(part: tuple, *, ask: bool = False) -> str:  # type: ignore[type-arg]
    """Return several blocks or inlines as plain text."""
    return "".join(to_card_text(item, ask=ask) for item in part)


@to_card_text.register
def _format_plain_text_text(part: PlainText | InlineCode, *, ask: bool = False) -> str:
    """Return words or code as plain text."""
    del ask
    return part.text


@to_card_text.register
def _format_typeset_maths_text(
    part: TypesetMaths | PlacedPicture | PlacedField, *, ask: bool = False
) -> str:
    """Return a formula, a picture of the prose or a blank as plain text."""
    del ask
    return part.text


@to_card_text.register
def _format_emphasis_text(part: Emphasis, *, ask: bool = False) -> str:
    """Return emphasised words as plain text."""
    return to_card_text(part.children, ask=ask)


@to_card_text.register
def _format_paragraph_text(part: Paragraph, *, ask: bool = False) -> str:
    """Return a paragraph as plain text."""
    return to_card_text(part.children, ask=ask) + "\n"


@to_card_text.register
def _format_code_block_text(part: CodeBlock | CardLabel, *, ask: bool = False) -> str:
    """Return a block of code or a label as plain text."""
    del ask
    return f"{part.text}\n"


@to_card_text.register
def _format_list_block_text(part: ListBlock, *, ask: bool = False) -> str:
    """Return a list as plain text."""
    return "".join(f"{BULLET} {to_card_text(item, ask=ask).strip()}\n" for item in part.items)


@to_card_text.register
def _format_table_block_text(part: TableBlock, *, ask: bool = False) -> str:
    """Return a table as plain text."""
    rows = (part.head, *part.rows)
    return "".join(" | ".join(to_card_text(cell, ask=ask) for cell in row) + "\n" for row in rows)


@to_card_text.register
def _format_display_maths_text(part: DisplayMaths, *, ask: bool = False) -> str:
    """Return a formula on its own line as plain text."""
    del ask
    return f"{part.maths.text}\n"


@to_card_text.register
def _format_cloze_hole_text(part: ClozeHole, *, ask: bool = False) -> str:
    """Return a formula with a hidden side as plain text, without that side if ``ask``."""
    return f"{part.shown.text} {'[...]' if ask else part.hidden.text}\n"


@to_card_text.register
def _format_card_picture_text(part: CardPicture, *, ask: bool = False) -> str:
    """Return a figure as plain text."""
    del ask
    return f"[{part.alt}]\n"


@to_card_text.register
def _format_details_text(part: Details, *, ask: bool = False) -> str:
    """Return blocks under a title as plain text."""
    return f"{part.title}: {to_card_text(part.body, ask=ask)}"


@to_card_text.register
def _format_in_language_text(part: InLanguage, *, ask: bool = False) -> str:
    """Return blocks in their language as plain text."""
    return to_card_text(part.body, ask=ask)


def media(parts: Iterable[Any]) -> Iterator[tuple[str, bytes]]:
    """Yield name and content of the file of every picture in blocks."""
    for part in leaves(parts):
        if isinstance(part, CardPicture):
            yield part.file, part.data
        elif isinstance(part, PlacedPicture):
            yield part.picture.file, part.picture.data
        elif isinstance(part, Details | InLanguage):
            yield from media(part.body)
