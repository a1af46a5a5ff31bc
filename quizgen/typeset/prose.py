"""Pieces of a sentence: words, mathematics, code and places to fill, as read and as said.

What Unicode can only hint at is typeset.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Protocol

import msgspec

from quizgen import typeset
from quizgen.locale import FIRST, localise_numbers, translate
from quizgen.maths.notation import pretty
from quizgen.maths.notation.names import NAME
from quizgen.maths.tree import Expr
from quizgen.typeset.nodes import Node, Word


class PlainText(msgspec.Struct, frozen=True, array_like=True, tag="w"):
    """Words of a sentence, without mathematics."""

    text: str


class Slot(msgspec.Struct, frozen=True, array_like=True, tag="s"):
    """A place to be filled: a drawn value, or a drawn phrase."""

    name: str


class InlineFormula(msgspec.Struct, frozen=True, array_like=True, tag="f"):
    """Mathematics in a sentence, as a formula tree."""

    expr: Expr


class LaidOutFormula(msgspec.Struct, frozen=True, array_like=True, tag="x"):
    """Mathematics in a sentence that is laid out already, with leaves for drawn values.

    ``source`` is how it stands in the file.
    """

    node: Node
    source: str


class InlineCode(msgspec.Struct, frozen=True, array_like=True, tag="c"):
    """Program text in a sentence."""

    text: str


class Emphasis(msgspec.Struct, frozen=True, array_like=True, tag="e"):
    """Emphasised (``em``) or strong (``strong``) text."""

    style: str
    children: tuple[Inline, ...]


class PictureLink(msgspec.Struct, frozen=True, array_like=True, tag="l"):
    """A picture from a file beside the words, and what it shows in words."""

    file: str
    alt: tuple[Inline, ...]


class TypesetFormula(Protocol):
    """What stands in the place of a formula or a ``PictureLink`` once filled."""

    @property
    def typed_text(self) -> str:
        """Return the formula as a learner would type it."""

    @property
    def text(self) -> str:
        """Return the formula in plain text, for people."""


class RoundedMarker(msgspec.Struct, frozen=True):
    """Says that what follows is rounded: an equals sign in front of it becomes ≈."""


if TYPE_CHECKING:
    Inline = (
        PlainText
        | Slot
        | InlineFormula
        | LaidOutFormula
        | InlineCode
        | Emphasis
        | PictureLink
        | RoundedMarker
        | TypesetFormula
    )
else:  # what a file gives, and what is kept of it
    Inline = PlainText | Slot | InlineFormula | LaidOutFormula | InlineCode | Emphasis | PictureLink
"""A piece of a sentence; once filled, without ``Slot``, ``Formula``, ``PictureLink``, ``About``."""
Unfilled = Slot | InlineFormula | LaidOutFormula | PictureLink


class Paragraph(msgspec.Struct, frozen=True, array_like=True, tag="p"):
    """One paragraph."""

    children: tuple[Inline, ...]


class ListBlock(msgspec.Struct, frozen=True, array_like=True, tag="i"):
    """A list; if ``ordered``, it is numbered from 1."""

    items: tuple[tuple[Block, ...], ...]
    ordered: bool = False


class CodeBlock(msgspec.Struct, frozen=True, array_like=True, tag="b"):
    """Lines of program text."""

    text: str


class TableBlock(msgspec.Struct, frozen=True, array_like=True, tag="t"):
    """A table with a head row."""

    head: tuple[tuple[Inline, ...], ...]
    rows: tuple[tuple[tuple[Inline, ...], ...], ...]


Block = Paragraph | ListBlock | CodeBlock | TableBlock


class TypesetMaths(msgspec.Struct, frozen=True):
    """A formula ready for printing: its layout, how it would be typed, and in which language."""

    node: typeset.Node
    typed_text: str
    lang: str = FIRST

    @property
    def text(self) -> str:
        """Return it in plain text for people; a comma in numbers separates none."""
        text = pretty.format_formula(self.typed_text)
        if localise_numbers(self.lang, text) != text:
            text = text.replace(", ", "; ")
        return localise_numbers(self.lang, text)


class TypesetLayout(TypesetMaths, frozen=True):
    """A formula that is more than the grammar of typed ones has; its layout says all of it."""

    @property
    def text(self) -> str:
        """How it is written in plain text, for people."""
        return typeset.to_text(self.node, self.lang)


def typeset_layout(node: typeset.Node) -> TypesetLayout:
    """Return a laid out formula ready for printing."""
    return TypesetLayout(node, typeset.to_text(node))


class PlacedField(msgspec.Struct, frozen=True):
    """The field of a part in a sentence or a cell: a blank on paper, an input on a page.

    Parameters
    ----------
    label : str
        Of the part; empty where there is only one.
    options : tuple of (str, inlines)
        What there is to choose from, each after its mark; none where something is typed.
    elsewhere : bool
        Whether the field itself stands in the same words of another language: a part has one.
    """

    label: str
    options: tuple[tuple[str, tuple[Inline, ...]], ...] = ()
    elsewhere: bool = False

    @property
    def text(self) -> str:
        """Return the blank in plain text."""
        return f"({self.label})\u00a0____" if self.label else "____"

    @property
    def typed_text(self) -> str:
        """Return the same as ``text``: what is typed there stands elsewhere."""
        return self.text


TextOrInlines = str | tuple[Inline, ...]
"""A text for people, or pieces of a sentence."""

_BEFORE_UNIT = re.compile(r"(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹]) (?=(?![A-Z]\d)[^\W\d]|%)")


def to_inlines(shown: TextOrInlines) -> tuple[Inline, ...]:
    """Return text as pieces of a sentence, powers of ten typeset and units held to numbers."""
    return _split_powers(shown) if isinstance(shown, str) else shown


@lru_cache(maxsize=4096)
def _split_powers(text: str) -> tuple[Inline, ...]:
    """Return a text as inlines, with blanks that do not break before units."""
    return tuple(_iter_powers(_BEFORE_UNIT.sub("\u00a0", text)))


def _iter_powers(text: str) -> Iterator[Inline]:
    """Yield words, and powers of ten as mathematics."""
    last = 0
    for found in pretty.POWER.finditer(text):
        yield from _make_words(text[last : found.start()])
        yield TypesetMaths(typeset.number(found[0]), found[0])
        last = found.end()
    yield from _make_words(text[last:])


def _make_words(text: str) -> tuple[Inline, ...]:
    """Return words as a tuple; an empty text gives none, so that no empty piece is printed."""
    return (PlainText(text),) if text else ()


def name_inline(symbol: str) -> Inline:
    """Return the name of a quantity, typeset; a label in words stays text."""
    if not NAME.fullmatch(symbol) or isinstance(node := typeset.lay_out_name(symbol), Word):
        return PlainText(symbol)
    return TypesetMaths(node, symbol)


def join_inlines(rows: Iterable[Iterable[Inline]], between: str) -> tuple[Inline, ...]:
    """Return several sentences as one, with a sign between them."""
    found: list[Inline] = []
    for row in rows:
        found += [PlainText(between), *row] if found else row
    return tuple(found)


def assignment_inlines(values: Iterable[tuple[str, str]]) -> tuple[Inline, ...]:
    """Return names with their values in a sentence: ``n₁ = 128; n₂ = 3``."""
    return join_inlines(
        ((name_inline(name), *to_inlines(f" = {text}")) for name, text in values), "; "
    )


def begin_sentence(said: tuple[Inline, ...]) -> tuple[Inline, ...]:
    """Return a sentence that begins with a capital, but for a single letter, as in ``f-number``."""
    first, *rest = said
    if not isinstance(first, PlainText) or not re.match("[a-z]{2}", first.text):
        return said
    return (PlainText(first.text[0].upper() + first.text[1:]), *rest)


def translate_inlines(lang: str, key: str, **blanks: tuple[Inline, ...]) -> tuple[Inline, ...]:
    """Return a sentence of the interface with inlines in its blanks."""
    marks = {name: f"\0{name}\0" for name in blanks}
    cut = translate(lang, key, **marks).split("\0")
    texts, names = cut[::2], cut[1::2]
    found: list[Inline] = list(_make_words(texts[0]))
    for name, text in zip(names, texts[1:], strict=True):
        found += [*blanks[name], *_make_words(text)]
    return tuple(found)
