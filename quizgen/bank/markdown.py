"""The prose of a template: a small Markdown subset with slots and mathematics.

``{{ name }}`` fills in a drawn value with its unit and nothing else; ``$...$`` is mathematics in
the grammar that students type, else in LaTeX. Loops, calls, attributes and arithmetic do not exist
here.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, cached_property
from typing import Any

import msgspec

from quizgen.core.errors import BankError, FormulaError
from quizgen.core.positions import TEXT
from quizgen.maths.notation import FormulaReadError, format_tree, parse_formula, pretty
from quizgen.typeset import lay_out
from quizgen.typeset.from_latex import SLOT, LatexError, lay_out_latex, spell_as_latex
from quizgen.typeset.leaves import list_leaf_names
from quizgen.typeset.nodes import Display, Leaf
from quizgen.typeset.prose import (
    Block,
    CodeBlock,
    Emphasis,
    Inline,
    InlineCode,
    InlineFormula,
    LaidOutFormula,
    ListBlock,
    Paragraph,
    PictureLink,
    PlainText,
    RoundedMarker,
    Slot,
    TableBlock,
    Unfilled,
)

SlotValue = Callable[[Unfilled], tuple[Inline, ...]]
"""What a slot, a formula or a picture is replaced by."""
Program = Callable[[str], str]
"""What becomes of program text."""


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
        """Return a named sentence, or None if the file has none of this name."""
        return self.named.get(section, {}).get(name)

    @cached_property
    def unslotted_sentences(self) -> dict[tuple[str, str], tuple[Inline, ...]]:
        """Return the cache of filled sentences without slots, by section and name.

        Such a sentence is the same in every variant, so it is filled once; ``Interpolator`` writes
        into the dict.
        """
        return {}


TIED = "\u00a0=\u00a0"
"""``f = 50 mm`` stays on one line: the blanks around an equals sign do not break.

This holds in every output, also in plain text; ``unbreakable_groups`` in
``question.interpolation`` holds a formula to what follows it where an output could break between.
"""
_POWER = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?[eE][-+]?\d+)(?![\w.]*\w)")
_EQUALS = re.compile(r"=(?=\s*$)")
TABLE_MARK = "table:"
"""Begins a slot that is a table of lists: ``{{ table: x y }}``."""
FIELD_MARK = "?"
"""Begins a slot that is the field of a part: ``{{ ?b }}``."""
_SLOT = re.compile(
    r"\{\{\s*([A-Za-z_][\w']*(?:\[[0-9]{1,4}\]|:(?:0?[0-9]{1,2}[dboxX]?|[boxX]|\.[0-9]{1,2}f))?|table:(?:\s+[A-Za-z_][\w']*){1,12}|\?[a-j])\s*\}\}"
)
_MATH = re.compile(r"\$([^$\n]+|[^$]*\\[^$]*)\$")
"""Mathematics; LaTeX may go over several lines."""
_DISPLAY = re.compile(r"\$\$([^$]+)\$\$")
_IN_CELL = re.compile(r"\$(?! )[^$\n]*(?<! )\$")
_BAR = "\uf8fe"
"""Holds a bar of a formula in a table, where Markdown would end a cell at it."""
_LINK = re.compile(r"\[[^\]\n]+\]\((?:[a-z]+:|www\.|[\w-]*[/#.])[^\s)]*\)")
_BANNED = re.compile(r"\{\{|\}\}|\{%|%\}|\{#|#\}")


@cache
def _build_markdown_parser() -> Any:
    """Return the parser of the subset: CommonMark without links, headings and HTML.

    Slots and formulas are tokens of their own, looked for before escapes: a backslash or an
    underscore inside them belongs to them.
    """
    from markdown_it import MarkdownIt

    parser = MarkdownIt("zero", {"html": False})
    parser.enable(["emphasis", "backticks", "list", "table", "fence", "escape", "newline", "image"])
    parser.inline.ruler.before("escape", "slot", _make_inline_rule(_SLOT, "slot"))
    parser.inline.ruler.before("escape", "display", _make_inline_rule(_DISPLAY, "display"))
    parser.inline.ruler.before("escape", "math", _make_inline_rule(_MATH, "math"))
    parser.inline.add_terminator_char("{")
    parser.inline.add_terminator_char("$")
    return parser


def _make_inline_rule(pattern: re.Pattern[str], kind: str) -> Callable[[Any, bool], bool]:
    """Return a rule of markdown-it that makes a token ``kind`` of what a pattern matches."""

    def match(state: Any, silent: bool) -> bool:
        """Return whether the pattern matches here, and move past it; ``silent`` pushes no token."""
        found = pattern.match(state.src, state.pos)
        if found is None:
            return False
        if not silent:
            state.push(kind, "", 0).content = found[1]
        state.pos = found.end()
        return True

    return match


def parse_blocks(source: str, line: int = 0) -> tuple[Block, ...]:
    """Return the blocks of prose.

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
        held = _hold_bars(source)
        return tuple(_iter_blocks(iter(_build_markdown_parser().parse(held)), None))
    except BankError as error:
        error.line = error.line + line - 1 if line else 0
        raise


def _hold_bars(source: str) -> str:
    """Return the source with stand-ins for bars inside formulas, which end no cell of a table."""
    if "|" not in source or "$" not in source:
        return source
    return _IN_CELL.sub(lambda found: found[0].replace("|", _BAR), source)


def _release_bars(text: str) -> str:
    """Return the text of a cell with the bars of its formulas put back."""
    return text.replace(_BAR, "|")


def parse_inlines(source: str, line: int = 0) -> tuple[Inline, ...]:
    """Return the pieces of one sentence, however it is broken into lines.

    ``line`` and errors as for ``parse_blocks``.
    """
    try:
        return _sentence(" ".join(source.split()))
    except BankError as error:
        error.line = line and line + _count_breaks_before_fault(source.strip("\n "))
        raise


def _sentence(source: str) -> tuple[Inline, ...]:
    """Return the pieces of a sentence on one line; none if it is empty."""
    tokens = _build_markdown_parser().parseInline(source)
    return _parse_inline_token(tokens[0]) if tokens else ()


def _count_breaks_before_fault(source: str) -> int:
    """Return how many line breaks stand before the fault of a sentence.

    ``parse_inlines`` joins the lines first, and the joined line has no breaks, so the sentence
    is read once more as it is broken in the file.
    """
    try:
        _sentence(source)
    except BankError as error:
        return error.line - 1
    return 0


class _PieceIterator:
    """Pieces of a sentence, one by one, and how many ends of lines have come.

    An error is located by the count: markdown-it gives lines to blocks alone.
    """

    def __init__(self, token: Any) -> None:
        """Start at the first piece; ``breaks`` at the line that the block begins in, from 0."""
        self._rest = iter(token.children or ())
        self.breaks = token.map[0] if token.map else 0

    def __iter__(self) -> Iterator[Any]:
        """Return itself: the count belongs to one pass."""
        return self

    def __next__(self) -> Any:
        """Return the next piece, and count it if it ends a line."""
        piece = next(self._rest)
        self.breaks += piece.type in {"softbreak", "hardbreak"}
        return piece


def _parse_inline_token(token: Any) -> tuple[Inline, ...]:
    """Return the pieces of one inline token; a fault in it gets its line, from 1."""
    pieces = _PieceIterator(token)
    try:
        return tuple(_iter_inlines(pieces, None))
    except BankError as error:
        error.line = pieces.breaks + 1
        raise


def _iter_blocks(tokens: Iterator[Any], until: str | None) -> Iterator[Block]:
    """Yield blocks up to the closing token ``until``; None reads to the end.

    Raises ``BankError`` for a block that is not part of the subset.
    """
    for token in tokens:
        if token.type == until:
            return
        if token.type == "paragraph_open":
            inline = next(tokens)
            next(tokens)
            yield Paragraph(_parse_inline_token(inline))
        elif token.type in {"bullet_list_open", "ordered_list_open"}:
            close = token.type.replace("open", "close")
            yield ListBlock(
                tuple(_iter_list_items(tokens, close)), token.type.startswith("ordered")
            )
        elif token.type == "fence":
            yield CodeBlock(_release_bars(token.content.rstrip("\n")))
        elif token.type == "table_open":
            yield _parse_table(tokens)
        else:
            line = token.map[0] + 1 if token.map else 1
            what = f"Markdown {token.type!r} is not part of the subset"
            raise BankError(what, rule="QG153", line=line)


def _iter_list_items(tokens: Iterator[Any], until: str) -> Iterator[tuple[Block, ...]]:
    """Yield the blocks of each item of a list, up to its closing token ``until``."""
    for token in tokens:
        if token.type == until:
            return
        yield tuple(_iter_blocks(tokens, "list_item_close"))


def _parse_table(tokens: Iterator[Any]) -> TableBlock:
    """Return the table whose opening token has just been read; its first row is the head."""
    rows: list[tuple[tuple[Inline, ...], ...]] = []
    row: list[tuple[Inline, ...]] = []
    for token in tokens:
        if token.type == "table_close":
            break
        if token.type == "tr_open":
            row = []
        elif token.type == "inline":
            row.append(_parse_inline_token(token))
        elif token.type == "tr_close":
            rows.append(tuple(row))
    return TableBlock(rows[0], tuple(rows[1:]))


def _iter_inlines(tokens: Iterator[Any], until: str | None) -> Iterator[Inline]:
    """Yield pieces up to the closing token ``until``; None reads to the end.

    Raises ``BankError`` for a piece that is not part of the subset.
    """
    for token in tokens:
        if token.type == until:
            return
        if token.type == "text":
            if token.content:
                yield from _iter_words_and_numbers(_release_bars(token.content))
        elif token.type in _ALONE:
            yield _ALONE[token.type](token)
        elif token.type in {"em_open", "strong_open"}:
            style = token.type.removesuffix("_open")
            yield Emphasis(style, tuple(_iter_inlines(tokens, f"{style}_close")))
        else:
            raise BankError(f"Markdown {token.type!r} is not part of the subset", rule="QG153")


def _iter_words_and_numbers(text: str) -> Iterator[Inline]:
    """Yield words; a number such as ``6e-8`` in them becomes mathematics.

    Raises
    ------
    BankError
        If braces or an exclamation mark with a bracket are left: a slot or a picture with a
        typing error would otherwise be printed as it stands.
    """
    if "![" in text:
        what = f"a picture is not like ![words](file.png), without blanks, in {text!r}"
        raise BankError(what, rule="QG156")
    if found := _LINK.search(text):
        what = f"a link is not part of the subset: {found[0]!r}; a paper cannot follow it"
        raise BankError(what, rule="QG153", place=(TEXT, found[0]))
    if _BANNED.search(text):
        what = f"only {{{{ name }}}} may stand in double braces: {text.strip()!r}"
        raise BankError(what, rule="QG154")
    pieces = _POWER.split(text)
    for index, piece in enumerate(pieces):
        if index % 2:
            yield _parse_prose_formula(piece)
        elif piece:
            yield PlainText(pretty.format_numbers_in_prose(piece).replace(" = ", TIED))


def _parse_prose_formula(text: str) -> InlineFormula | LaidOutFormula:
    """Return a formula between dollars: of the grammar that students type, else of LaTeX.

    Raises ``BankError`` if neither reads it, or it begins with a sign + that nothing would print.
    """
    if "\\" not in text:
        if text.lstrip().startswith("+"):
            what = f"mathematics ${text}$: a sign + in front is not printed: set it as words"
            raise BankError(what, rule="QG155")
        try:
            return _parse_typed_formula(text)
        except FormulaError as error:
            unfinished = isinstance(error, FormulaReadError) and error.code in _UNFINISHED
            if unfinished or _TWO_SIGNS.search(text):
                raise BankError(f"mathematics ${text}$: {error}", rule="QG155") from error
    try:
        return LaidOutFormula(lay_out_latex(spell_as_latex(text)), text)
    except LatexError as error:
        place = (TEXT, f"${text}$", (error.column or 1) + len("$"))
        what = f"mathematics ${text}$: column {error.column}: {error.message}"
        raise BankError(what, rule="QG159", place=place) from error


def _set_large(formula: InlineFormula | LaidOutFormula) -> LaidOutFormula:
    """Return a formula between two dollar signs each, as large as one in a line of its own."""
    if isinstance(formula, InlineFormula):
        return LaidOutFormula(Display(lay_out(formula.expr)), format_tree(formula.expr))
    return LaidOutFormula(Display(formula.node), formula.source)


_TWO_SIGNS = re.compile(r"[-+*/^] *[*/^]|[*/^] *[+=<>]|\+ *[-+=]")
_UNFINISHED = frozenset({"unfinished", "empty", "too-long", "too-deep", "number-too-large"})
"""Faults of a formula that LaTeX would print without a word."""
_HELD = "\ua4d0"
"""A letter that nobody types; with a number it names a leaf while a formula is read."""


def _parse_typed_formula(text: str) -> InlineFormula | LaidOutFormula:
    """Return a formula that an author typed, laid out if it has slots for drawn values.

    A slot is read as a name and then becomes a place in the layout. Raises ``FormulaReadError``.
    """
    if not SLOT.search(text):
        return InlineFormula(parse_formula(text))
    if _HELD in text:
        raise FormulaReadError("bad-character", text.index(_HELD) + 1, _HELD)
    names = SLOT.findall(text)
    counts = iter(range(len(names)))
    expr = parse_formula(SLOT.sub(lambda _found: f" {_HELD}{next(counts)} ", text))
    places = {f"{_HELD}{count}": Leaf(name) for count, name in enumerate(names)}
    return LaidOutFormula(lay_out(expr, leaves=places, inline=True), text)


def leaves(parts: Iterable[Block | Inline]) -> Iterator[Block | Inline]:
    """Yield what holds no other piece, in order."""
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
    """Return a picture link; styles in its words are dropped, since nobody sees them."""
    said = (one for one in token.children or () if one.type == "text" or one.type in _ALONE)
    return PictureLink(token.attrs["src"], tuple(_iter_inlines(said, None)))


_ALONE: dict[str, Callable[[Any], Inline]] = {
    "softbreak": lambda _token: PlainText(" "),
    "hardbreak": lambda _token: PlainText(" "),
    "slot": lambda token: Slot(token.content),
    "math": lambda token: _parse_prose_formula(_release_bars(token.content)),
    "display": lambda token: _set_large(_parse_prose_formula(_release_bars(token.content))),
    "code_inline": lambda token: InlineCode(_release_bars(token.content)),
    "image": _parse_picture_link,
}
"""Tokens that are one piece of a sentence."""


def slot_names(parts: Iterable[Block | Inline]) -> Iterator[str]:
    """Yield the names of all slots in blocks or inlines, also those in programs and captions."""
    for part in leaves(parts):
        match part:
            case Slot(name):
                yield _drop_format(name)
            case LaidOutFormula(node):
                yield from sorted(list_leaf_names(node))
            case CodeBlock(text) | InlineCode(text):
                yield from map(_drop_format, _SLOT.findall(text))
            case PictureLink(_, alt):
                yield from slot_names(alt)
            case _:
                pass


def _drop_format(slot: str) -> str:
    """Return the name in ``h:02``, which prints ``h`` as Python does."""
    return slot if slot.startswith(TABLE_MARK) else slot.partition(":")[0]


def fill_inlines(
    parts: tuple[Inline, ...], value: SlotValue, program: Program = str
) -> tuple[Inline, ...]:
    """Return a sentence with slots, formulas and pictures replaced by what ``value`` gives.

    Code is replaced by what ``program`` makes of it. A ``RoundedMarker`` among the values turns
    the equals sign in front of it into ≈ and leaves no piece of its own.
    """
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
    """Return what one piece becomes; what holds no slot is returned as it is."""
    if isinstance(part, Unfilled):
        return value(part)
    if isinstance(part, Emphasis):
        return (Emphasis(part.style, fill_inlines(part.children, value, program)),)
    if isinstance(part, InlineCode) and _SLOT.search(part.text):
        return (InlineCode(program(part.text)),)
    return (part,)


def fill_blocks(parts: tuple[Block, ...], value: SlotValue, program: Program) -> tuple[Block, ...]:
    """Return blocks with every sentence filled as by ``fill_inlines``.

    ``program`` gives what blocks of program text become.
    """

    def fill_one_block(block: Block) -> Block:
        """Return one block, filled."""
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
        """Return one row of a table, each cell filled."""
        return tuple(fill_inlines(cell, value, program) for cell in cells)

    return tuple(map(fill_one_block, parts))


def fill_text(text: str, value: Callable[[str], str]) -> str:
    """Return program text in which ``value`` gives what stands for each ``{{ name }}``."""
    return _SLOT.sub(lambda found: value(found[1]), text)
