r"""What stands on a card, written as HTML with MathJax or as plain text.

The blocks of ``quizgen.bank.prose`` are used as they are; a card adds five of its own: a worked
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
from quizgen.bank.prose import (
    Code,
    CodeBlock,
    Inline,
    Items,
    Paragraph,
    Styled,
    Table,
    Words,
    leaves,
)
from quizgen.figures import Figure
from quizgen.question.filling import tied
from quizgen.question.shown import Maths, PlacedPicture
from quizgen.typeset.nodes import RELATION, Node, Row


@dataclass(frozen=True, slots=True)
class Display:
    """A formula on a line of its own; a chain of equations may wrap at its signs."""

    maths: Maths


@dataclass(frozen=True, slots=True)
class Hole:
    """A formula of which one side is asked: what is shown, and the hidden rest with its number."""

    shown: Maths
    hidden: Maths
    number: int


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure with its alt text."""

    name: str
    figure: Figure
    alt: str

    @property
    def data(self) -> bytes:
        """The drawing, which every language shares."""
        return self.figure.standalone_svg

    @property
    def shade(self) -> str:
        """What a dark card does to it: line art is inverted, a photograph stays on white."""
        return "keep" if b"<image" in self.data else "invert"

    @property
    def file(self) -> str:
        """Name of the media file: unique for its content."""
        return f"qg_{self.name}_{hashlib.sha256(self.data).hexdigest()[:12]}.svg"


@dataclass(frozen=True, slots=True)
class Fold:
    """Blocks that open on a tap."""

    title: str
    body: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Together:
    """Inlines that a line must not end between."""

    parts: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Said:
    """Blocks in one language, marked as such for screen readers and fonts."""

    lang: str
    body: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Label:
    """A short line that says what is asked, or what follows."""

    text: str


LATEX = "en"
"""Language of words in formulas: MathJax sets Bangla letter by letter, without conjuncts."""


def maths(node: Node) -> str:
    r"""An inline formula for MathJax.

    Parameters
    ----------
    node : Node

    Returns
    -------
    str
        HTML, between ``\(`` and ``\)``.
    """
    if _wraps(node) and len(node.items) > len(("left", "=", "right")):
        return " ".join(_pieces(node, ""))
    return rf"\({escape(typeset.latex(node, LATEX), quote=False)}\)"


def _wraps(node: Node) -> TypeGuard[Row]:
    return isinstance(node, Row) and node.level == RELATION and len(node.items) > 1


def chain(node: Node) -> str:
    """A chain of equations as one formula per side, so that a narrow screen can wrap it."""
    style = r"\displaystyle "
    if not _wraps(node):
        return _piece(style, typeset.latex(node, LATEX))
    return " ".join(_pieces(node, style))


def _pieces(node: Row, style: str) -> Iterator[str]:
    first, *rest = node.items
    yield _piece(style, typeset.latex(first, LATEX))
    for sign, side in zip(rest[::2], rest[1::2], strict=True):
        empty = "{}" if side == Row(()) else ""  # keeps the space after a sign at the end
        yield _piece(style, "{}" + typeset.latex(Row((sign, side), RELATION), LATEX) + empty)


def _piece(style: str, text: str) -> str:
    return rf"\({style}{escape(text, quote=False)}\)"


_MARKS = re.compile(r"\\(?=[(\[]|begin|(?:eq)?ref)|\[(?=\$|/?latex|sound:|anki:)|\{(?=\{)|\}(?=\})")
"""Where MathJax or Anki would take words for a formula, a sound or a blank of theirs."""
BULLET = "•"
"""Before an item in plain text; a spreadsheet would take a hyphen for the start of a formula."""
WORD_JOINER = "\u2060"


def text(words: str, *, quote: bool = False) -> str:
    """Words as HTML that no reader of the card takes for anything but words."""
    if _MARKS.search(words):
        words = _MARKS.sub(lambda mark: mark[0] + WORD_JOINER, words)
    return escape(words, quote=quote)


@singledispatch
def html(part: object, lang: str, *, ask: bool | None = None) -> str:
    """One block, inline or tuple of them as HTML.

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


@html.register
def _(part: tuple, lang: str, *, ask: bool | None = None) -> str:  # type: ignore[type-arg]
    groups = tied(part)
    return "".join(html(g[0] if len(g) == 1 else Together(g), lang, ask=ask) for g in groups)


@html.register
def _(part: Together, lang: str, *, ask: bool | None = None) -> str:
    inside = "".join(html(item, lang, ask=ask) for item in part.parts)
    return f'<span class="qg-together">{inside}</span>'


@html.register
def _(part: Words, lang: str, *, ask: bool | None = None) -> str:
    del lang, ask
    return text(part.text)


@html.register
def _(part: Maths, lang: str, *, ask: bool | None = None) -> str:
    del lang, ask
    return maths(part.node)


@html.register
def _(part: Code, lang: str, *, ask: bool | None = None) -> str:
    del lang, ask
    return f"<code>{text(part.text)}</code>"


@html.register
def _(part: Styled, lang: str, *, ask: bool | None = None) -> str:
    return f"<{part.style}>{html(part.children, lang, ask=ask)}</{part.style}>"


@html.register
def _(part: Paragraph, lang: str, *, ask: bool | None = None) -> str:
    return f"<p>{html(part.children, lang, ask=ask)}</p>"


@html.register
def _(part: CodeBlock, lang: str, *, ask: bool | None = None) -> str:
    del lang, ask
    lines = text(part.text).replace("\n", "<br>")
    return f"<pre>{lines}</pre>"


@html.register
def _(part: Items, lang: str, *, ask: bool | None = None) -> str:
    tag = "ol" if part.ordered else "ul"
    items = "".join(f"<li>{_tight(item, lang, ask)}</li>" for item in part.items)
    return f"<{tag}>{items}</{tag}>"


def _tight(item: tuple[Any, ...], lang: str, ask: bool | None) -> str:
    single = len(item) == 1 and isinstance(item[0], Paragraph)
    return html(item[0].children if single else item, lang, ask=ask)


@html.register
def _(part: Table, lang: str, *, ask: bool | None = None) -> str:
    def row(cells: Iterable[Sequence[Inline]], tag: str) -> str:
        return "".join(f"<{tag}>{html(cell, lang, ask=ask)}</{tag}>" for cell in cells)

    head = f"<tr>{row(part.head, 'th')}</tr>"
    body = "".join(f"<tr>{row(cells, 'td')}</tr>" for cells in part.rows)
    return f"<table>{head}{body}</table>"


@html.register
def _(part: Display, lang: str, *, ask: bool | None = None) -> str:
    del lang, ask
    return f'<div class="qg-line">{chain(part.maths.node)}</div>'


@html.register
def _(part: Hole, lang: str, *, ask: bool | None = None) -> str:
    del lang
    shown, hidden = (chain(side.node) for side in (part.shown, part.hidden))
    if ask is None:
        hidden = f"{{{{c{part.number}::{hidden}}}}}"
    elif ask:
        hidden = "<b>[…]</b>"
    return f'<div class="qg-line">{shown} {hidden}</div>'


@html.register
def _(part: Picture, lang: str, *, ask: bool | None = None) -> str:
    del lang, ask
    alt = text(part.alt, quote=True)
    return f'<img class="qg-{part.shade}" src="{escape(part.file, quote=True)}" alt="{alt}">'


@html.register
def _(part: PlacedPicture, lang: str, *, ask: bool | None = None) -> str:
    del lang, ask
    wide, alt = f"{part.picture.width_pt * 4 / 3:.0f}", text(part.alt, quote=True)
    return f'<img class="qg-keep" src="{part.picture.file}" alt="{alt}" width="{wide}">'


@html.register
def _(part: Fold, lang: str, *, ask: bool | None = None) -> str:
    body = html(part.body, lang, ask=ask)
    return f"<details><summary>{text(part.title)}</summary>{body}</details>"


@html.register
def _(part: Said, lang: str, *, ask: bool | None = None) -> str:
    del lang
    return (
        f'<div lang="{escape(part.lang, quote=True)}">{html(part.body, part.lang, ask=ask)}</div>'
    )


@html.register
def _(part: Label, lang: str, *, ask: bool | None = None) -> str:
    del lang, ask
    return f'<div class="qg-label">{text(part.text)}</div>'


@singledispatch
def plain(part: object, *, ask: bool = False) -> str:
    """One block, inline or tuple of them as text; formulas as Unicode can write them.

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


@plain.register
def _(part: tuple, *, ask: bool = False) -> str:  # type: ignore[type-arg]
    return "".join(plain(item, ask=ask) for item in part)


@plain.register
def _(part: Words | Code, *, ask: bool = False) -> str:
    del ask
    return part.text


@plain.register
def _(part: Maths | PlacedPicture, *, ask: bool = False) -> str:
    del ask
    return part.text


@plain.register
def _(part: Styled, *, ask: bool = False) -> str:
    return plain(part.children, ask=ask)


@plain.register
def _(part: Paragraph, *, ask: bool = False) -> str:
    return plain(part.children, ask=ask) + "\n"


@plain.register
def _(part: CodeBlock | Label, *, ask: bool = False) -> str:
    del ask
    return f"{part.text}\n"


@plain.register
def _(part: Items, *, ask: bool = False) -> str:
    return "".join(f"{BULLET} {plain(item, ask=ask).strip()}\n" for item in part.items)


@plain.register
def _(part: Table, *, ask: bool = False) -> str:
    rows = (part.head, *part.rows)
    return "".join(" | ".join(plain(cell, ask=ask) for cell in row) + "\n" for row in rows)


@plain.register
def _(part: Display, *, ask: bool = False) -> str:
    del ask
    return f"{part.maths.text}\n"


@plain.register
def _(part: Hole, *, ask: bool = False) -> str:
    return f"{part.shown.text} {'[...]' if ask else part.hidden.text}\n"


@plain.register
def _(part: Picture, *, ask: bool = False) -> str:
    del ask
    return f"[{part.alt}]\n"


@plain.register
def _(part: Fold, *, ask: bool = False) -> str:
    return f"{part.title}: {plain(part.body, ask=ask)}"


@plain.register
def _(part: Said, *, ask: bool = False) -> str:
    return plain(part.body, ask=ask)


def media(parts: Iterable[Any]) -> Iterator[tuple[str, bytes]]:
    """Name and content of every picture's file in blocks."""
    for part in leaves(parts):
        if isinstance(part, Picture):
            yield part.file, part.data
        elif isinstance(part, PlacedPicture):
            yield part.picture.file, part.picture.data
        elif isinstance(part, Fold | Said):
            yield from media(part.body)
