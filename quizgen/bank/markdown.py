"""The prose of a template: a small Markdown subset with slots and mathematics.

``{{ name }}`` fills in a drawn value with its unit and nothing else; ``$...$`` is mathematics in
the grammar that students type. Loops, calls, attributes and arithmetic do not exist here.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Protocol

import msgspec

from quizgen.core.errors import BankError, FormulaError
from quizgen.maths.notation import parse_formula, pretty
from quizgen.maths.tree import Expr


class PlainText(msgspec.Struct, frozen=True, array_like=True, tag="w"):
    """Plain text."""

    text: str


class Slot(msgspec.Struct, frozen=True, array_like=True, tag="s"):
    """A place to be filled: a drawn value, or a drawn phrase."""

    name: str


class InlineFormula(msgspec.Struct, frozen=True, array_like=True, tag="f"):
    """Mathematics in a sentence, as a formula tree."""

    expr: Expr


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
    """What stands in the place of a ``Formula`` or a ``PictureLink`` once filled."""

    @property
    def typed(self) -> str:
        """How it would be typed."""

    @property
    def text(self) -> str:
        """How it is written in plain text, for people."""


class RoundedMarker(msgspec.Struct, frozen=True):
    """Says that what follows is rounded: an equals sign in front of it becomes ≈."""


if TYPE_CHECKING:
    Inline = (
        PlainText
        | Slot
        | InlineFormula
        | InlineCode
        | Emphasis
        | PictureLink
        | RoundedMarker
        | TypesetFormula
    )
else:  # what a file gives, and what is kept of it
    Inline = PlainText | Slot | InlineFormula | InlineCode | Emphasis | PictureLink
"""A piece of a sentence; once filled, without ``Slot``, ``Formula``, ``PictureLink``, ``About``."""
Unfilled = Slot | InlineFormula | PictureLink
SlotValue = Callable[[Unfilled], tuple[Inline, ...]]
"""What a slot, a formula or a picture is replaced by."""
Program = Callable[[str], str]
"""What becomes of program text."""


class Paragraph(msgspec.Struct, frozen=True, array_like=True, tag="p"):
    """One paragraph."""

    children: tuple[Inline, ...]


class ListBlock(msgspec.Struct, frozen=True, array_like=True, tag="i"):
    """A list; ``ordered`` counts from 1."""

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


ConditionalSentence = tuple[str, tuple[Inline, ...]]
"""A condition (empty: always) and the sentence that is said where it holds."""


class LanguageFile(msgspec.Struct, frozen=True, dict=True):
    """The parsed prose of one language."""

    title: str
    stem: tuple[Block, ...]
    sections: Mapping[str, tuple[Block, ...]] = msgspec.field(default_factory=dict)
    named: Mapping[str, Mapping[str, tuple[Inline, ...]]] = msgspec.field(default_factory=dict)
    cases: Mapping[tuple[str, str], tuple[ConditionalSentence, ...]] = msgspec.field(
        default_factory=dict
    )
    pictures: tuple[PictureLink, ...] = ()

    def sentence(self, section: str, name: str) -> tuple[Inline, ...] | None:
        """A named sentence, or None."""
        return self.named.get(section, {}).get(name)

    @cached_property
    def unslotted_sentences(self) -> dict[tuple[str, str], tuple[Inline, ...]]:
        """Named sentences without blanks, each as it stands in every draw once it was asked for."""
        return {}


TIED = "\u00a0=\u00a0"
"""``f = 50 mm`` stays on one line: the blanks around an equals sign do not break.

This holds in every output, also in plain text; ``question.filling.tied`` holds a formula to what
follows it where an output could break between them.
"""
_POWER = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?[eE][-+]?\d+)(?![\w.]*\w)")
_EQUALS = re.compile(r"=(?=\s*$)")
_SLOT = re.compile(
    r"\{\{\s*([A-Za-z_][\w']*(?:\[[0-9]{1,4}\])?|table:(?:\s+[A-Za-z_][\w']*){1,12})\s*\}\}"
)
TABLE_MARK = "table:"
"""Begins a slot that is a table of lists: ``{{ table: x y }}``."""
_MATH = re.compile(r"\$([^$\n]+)\$")
_BANNED = re.compile(r"\{\{|\}\}|\{%|%\}|\{#|#\}")


@cache
def _build_markdown_parser() -> Any:
    from markdown_it import MarkdownIt

    parser = MarkdownIt("zero", {"html": False})
    parser.enable(["emphasis", "backticks", "list", "table", "fence", "escape", "newline", "image"])
    parser.inline.ruler.before("escape", "slot", _make_inline_rule(_SLOT, "slot"))
    parser.inline.ruler.before("escape", "math", _make_inline_rule(_MATH, "math"))
    parser.inline.add_terminator_char("{")
    parser.inline.add_terminator_char("$")
    return parser


def _make_inline_rule(pattern: re.Pattern[str], kind: str) -> Callable[[Any, bool], bool]:
    def match(state: Any, silent: bool) -> bool:
        found = pattern.match(state.src, state.pos)
        if found is None:
            return False
        if not silent:
            state.push(kind, "", 0).content = found[1]
        state.pos = found.end()
        return True

    return match


def parse_blocks(source: str, line: int = 0) -> tuple[Block, ...]:
    """Parse prose.

    Parameters
    ----------
    source : str
    line : int
        The line of its file that it begins in, for errors; 0 if it has none.

    Raises
    ------
    BankError
        If it holds anything but the subset.
    """
    try:
        return tuple(_iter_blocks(iter(_build_markdown_parser().parse(source)), None))
    except BankError as error:
        error.line = error.line + line - 1 if line else 0
        raise


def parse_inlines(source: str, line: int = 0) -> tuple[Inline, ...]:
    """Parse one sentence, however it is broken into lines; ``line`` as for ``blocks``."""
    try:
        return _sentence(" ".join(source.split()))
    except BankError as error:
        error.line = line and line + _breaks_before_fault(source.strip("\n "))
        raise


def _sentence(source: str) -> tuple[Inline, ...]:
    tokens = _build_markdown_parser().parseInline(source)
    return _inline(tokens[0]) if tokens else ()


def _breaks_before_fault(source: str) -> int:
    try:
        _sentence(source)
    except BankError as error:
        return error.line - 1
    return 0


class _Pieces:
    """Pieces of a sentence, one by one, and how many ends of lines have come."""

    def __init__(self, token: Any) -> None:
        self._rest = iter(token.children or ())
        self.breaks = token.map[0] if token.map else 0

    def __iter__(self) -> Iterator[Any]:
        return self

    def __next__(self) -> Any:
        piece = next(self._rest)
        self.breaks += piece.type in {"softbreak", "hardbreak"}
        return piece


def _inline(token: Any) -> tuple[Inline, ...]:
    pieces = _Pieces(token)
    try:
        return tuple(_iter_inlines(pieces, None))
    except BankError as error:
        error.line = pieces.breaks + 1
        raise


def _iter_blocks(tokens: Iterator[Any], until: str | None) -> Iterator[Block]:
    for token in tokens:
        if token.type == until:
            return
        if token.type == "paragraph_open":
            inline = next(tokens)
            next(tokens)
            yield Paragraph(_inline(inline))
        elif token.type in {"bullet_list_open", "ordered_list_open"}:
            close = token.type.replace("open", "close")
            yield ListBlock(
                tuple(_iter_list_items(tokens, close)), token.type.startswith("ordered")
            )
        elif token.type == "fence":
            yield CodeBlock(token.content.rstrip("\n"))
        elif token.type == "table_open":
            yield _parse_table(tokens)
        else:
            line = token.map[0] + 1 if token.map else 1
            what = f"Markdown {token.type!r} is not part of the subset"
            raise BankError(what, rule="QG153", line=line)


def _iter_list_items(tokens: Iterator[Any], until: str) -> Iterator[tuple[Block, ...]]:
    for token in tokens:
        if token.type == until:
            return
        yield tuple(_iter_blocks(tokens, "list_item_close"))


def _parse_table(tokens: Iterator[Any]) -> TableBlock:
    rows: list[tuple[tuple[Inline, ...], ...]] = []
    row: list[tuple[Inline, ...]] = []
    for token in tokens:
        if token.type == "table_close":
            break
        if token.type == "tr_open":
            row = []
        elif token.type == "inline":
            row.append(_inline(token))
        elif token.type == "tr_close":
            rows.append(tuple(row))
    return TableBlock(rows[0], tuple(rows[1:]))


def _iter_inlines(tokens: Iterator[Any], until: str | None) -> Iterator[Inline]:
    for token in tokens:
        if token.type == until:
            return
        if token.type == "text":
            if token.content:
                yield from _iter_words_and_numbers(token.content)
        elif token.type in _ALONE:
            yield _ALONE[token.type](token)
        elif token.type in {"em_open", "strong_open"}:
            style = token.type.removesuffix("_open")
            yield Emphasis(style, tuple(_iter_inlines(tokens, f"{style}_close")))
        else:
            raise BankError(f"Markdown {token.type!r} is not part of the subset", rule="QG153")


def _iter_words_and_numbers(text: str) -> Iterator[Inline]:
    """Words; a number such as ``6e-8`` in them is set as mathematics."""
    if "![" in text:
        what = f"a picture is not like ![words](file.png), without blanks, in {text!r}"
        raise BankError(what, rule="QG156")
    if _BANNED.search(text):
        what = f"only {{{{ name }}}} may stand in double braces: {text.strip()!r}"
        raise BankError(what, rule="QG154")
    pieces = _POWER.split(text)
    for index, piece in enumerate(pieces):
        if index % 2:
            yield _parse_prose_formula(piece)
        elif piece:
            yield PlainText(pretty.format_numbers_in_prose(piece).replace(" = ", TIED))


def _parse_prose_formula(text: str) -> InlineFormula:
    if text.lstrip().startswith("+"):
        what = f"mathematics ${text}$: a sign + in front is not printed: set it as words"
        raise BankError(what, rule="QG155")
    try:
        return InlineFormula(parse_formula(text))
    except FormulaError as error:
        raise BankError(f"mathematics ${text}$: {error}", rule="QG155") from error


def leaves(parts: Iterable[Block | Inline]) -> Iterator[Block | Inline]:
    """What holds nothing else, in order."""
    for part in parts:
        match part:
            case Paragraph(children) | Emphasis(_, children):
                yield from leaves(children)
            case ListBlock(items):
                yield from (leaf for item in items for leaf in leaves(item))
            case TableBlock(head, rows):
                yield from (leaf for row in (head, *rows) for cell in row for leaf in leaves(cell))
            case _:
                yield part


def _parse_picture_link(token: Any) -> PictureLink:
    """A picture; nobody sees a style in its words."""
    said = (one for one in token.children or () if one.type == "text" or one.type in _ALONE)
    return PictureLink(token.attrs["src"], tuple(_iter_inlines(said, None)))


_ALONE: dict[str, Callable[[Any], Inline]] = {
    "softbreak": lambda _token: PlainText(" "),
    "hardbreak": lambda _token: PlainText(" "),
    "slot": lambda token: Slot(token.content),
    "math": lambda token: _parse_prose_formula(token.content),
    "code_inline": lambda token: InlineCode(token.content),
    "image": _parse_picture_link,
}
"""Tokens that are one piece of a sentence."""


def slot_names(parts: Iterable[Block | Inline]) -> Iterator[str]:
    """Names of all slots in blocks or inlines."""
    for part in leaves(parts):
        match part:
            case Slot(name):
                yield name
            case CodeBlock(text) | InlineCode(text):
                yield from _SLOT.findall(text)
            case PictureLink(_, alt):
                yield from slot_names(alt)
            case _:
                pass


def fill_inlines(
    parts: tuple[Inline, ...], value: SlotValue, program: Program = str
) -> tuple[Inline, ...]:
    """Fill a sentence: what is unfilled with what ``value`` gives, code as ``program`` does."""
    done: list[Inline] = []
    for part in parts:
        if isinstance(part, PlainText):
            done.append(part)
            continue
        for one in _fill_part(part, value, program):
            if not isinstance(one, RoundedMarker):
                done.append(one)
            elif done and isinstance(before := done[-1], PlainText):
                done[-1] = PlainText(_EQUALS.sub("≈", before.text))
    return tuple(done)


def _fill_part(part: Inline, value: SlotValue, program: Program) -> tuple[Inline, ...]:
    if isinstance(part, Unfilled):
        return value(part)
    if isinstance(part, Emphasis):
        return (Emphasis(part.style, fill_inlines(part.children, value, program)),)
    if isinstance(part, InlineCode) and _SLOT.search(part.text):
        return (InlineCode(program(part.text)),)
    return (part,)


def fill_blocks(parts: tuple[Block, ...], value: SlotValue, program: Program) -> tuple[Block, ...]:
    """Fill every sentence of blocks as ``fill`` does, and programs by ``program``."""

    def fill_one_block(block: Block) -> Block:
        match block:
            case Paragraph(children):
                return Paragraph(fill_inlines(children, value, program))
            case CodeBlock(text):
                return CodeBlock(program(text))
            case ListBlock(items, ordered):
                return ListBlock(tuple(tuple(map(fill_one_block, item)) for item in items), ordered)
            case TableBlock(head, rows):
                return TableBlock(row(head), tuple(map(row, rows)))

    def row(cells: tuple[tuple[Inline, ...], ...]) -> tuple[tuple[Inline, ...], ...]:
        return tuple(fill_inlines(cell, value, program) for cell in cells)

    return tuple(map(fill_one_block, parts))


def fill_text(text: str, value: Callable[[str], str]) -> str:
    """Replace ``{{ name }}`` in program text by what ``value`` gives for the name."""
    return _SLOT.sub(lambda found: value(found[1]), text)
