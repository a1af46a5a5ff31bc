"""Pieces of Typst markup that every PDF is made of, and the typesetting itself."""

from __future__ import annotations

import json
import os
import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from datetime import UTC, datetime
from functools import cache, lru_cache, singledispatch
from itertools import groupby
from operator import attrgetter
from typing import Any, Final

from quizgen import typeset
from quizgen.core.errors import RenderError
from quizgen.locale import languages_in_script, translate
from quizgen.question.interpolation import NBSP, SHORT, PlacedPicture, unbreakable_groups
from quizgen.render import fonts
from quizgen.typeset import prose
from quizgen.typeset.prose import PlacedField, TypesetMaths

_KNOWN = frozenset(map(chr, (*range(0x20, 0x7F), *range(0xA1, 0x180), *range(0x985, 0x9E4))))
"""Latin and Bangla, in which most names are written."""
_LITERAL: Final = json.JSONEncoder(ensure_ascii=False)
GAP = re.compile("_{3,}")
_TIED = re.compile(
    r"\d[ \u00a0][A-Za-zµ°%]{1,4}\b(?:/[A-Za-zµ]+)?"
    r"|\((?:[^()\s]{1,7}[;,] ){1,3}[^()\s]{1,7}\)"
)
"""A number with its unit, and a point: no line ends within them."""
_BREAKS = frozenset("=<>≤≥≈+-*/")
"""Signs of a formula beside which a line may end."""
WORD_JOINER = "\u2060"
STANDARD: Final = "ua-1"
MAIN: Final = "main.typ"
MOMENT = datetime(2000, 1, 1, tzinfo=UTC)
"""The date written into every file: the same paper is the same bytes on any day."""


def typst_literal(text: str) -> str:
    """Return a Typst string literal, in which nothing is read as markup."""
    return _LITERAL.encode(text)


@singledispatch
def inlines_to_typst(part: prose.Inline | tuple[prose.Inline, ...], lang: str) -> str:
    """Return inlines as Typst markup."""
    raise TypeError(f"no Typst for {type(part).__name__} ({lang})")


@inlines_to_typst.register(tuple)
@lru_cache(maxsize=1 << 13)
def _join_inlines(parts: tuple[prose.Inline, ...], lang: str) -> str:
    """Return several inlines as Typst markup, cached: most sentences occur in several papers."""
    groups = unbreakable_groups(_join_words(parts))
    return "".join(_keep_together(group, lang) for group in groups)


def _join_words(parts: Iterable[prose.Inline]) -> Iterator[prose.Inline]:
    """Yield inlines with the words side by side as one, numbers tied to their units.

    What was filled in is read together with what stands around it.
    """
    for is_words, run in groupby(parts, key=lambda part: isinstance(part, prose.PlainText)):
        if is_words:
            yield prose.PlainText(_TIED.sub(_tie, "".join(map(attrgetter("text"), run))))
        else:
            yield from run


def _keep_together(group: tuple[prose.Inline, ...], lang: str) -> str:
    """Return inlines as Typst markup between which no line ends, nor within a short formula."""
    body = "".join(inlines_to_typst(part, lang) for part in group)
    return f"#box[{body}];" if len(group) > 1 or _is_short_line(group[0]) else body


def _is_short_line(part: prose.Inline) -> bool:
    """Return whether a piece is a formula that is short, and that a line may end in."""
    return (
        isinstance(part, TypesetMaths)
        and len(part.typed_text) <= SHORT
        and not _BREAKS.isdisjoint(part.typed_text)
    )


@inlines_to_typst.register
def _format_words(part: prose.PlainText, _lang: str) -> str:
    """Return words as Typst markup, with a blank of the width of a word where they have a gap."""
    said = [f"#{typst_literal(text)};" if text else "" for text in GAP.split(part.text)]
    return "#gap;".join(said)


def _tie(found: re.Match[str]) -> str:
    """Return words found in a sentence so that no line ends within them."""
    return found[0].replace(" ", NBSP).replace("/", f"/{WORD_JOINER}")


@inlines_to_typst.register
def _format_maths(part: TypesetMaths, lang: str) -> str:
    """Return an inline formula as Typst markup, with its words for screen readers."""
    return typst_equation(part, lang, block=False)


@inlines_to_typst.register
def _format_code(part: prose.InlineCode, _lang: str) -> str:
    """Return inline code as Typst markup; a whole program is a block."""
    block = "block: true, " if "\n" in part.text else ""
    return f"#raw({block}{typst_literal(part.text)});"


@inlines_to_typst.register
def _format_styled(part: prose.Emphasis, lang: str) -> str:
    """Return emphasised words as Typst markup."""
    name = "emph" if part.style == "em" else "strong"
    return f"#{name}[{inlines_to_typst(part.children, lang)}];"


@inlines_to_typst.register
def _format_picture(part: PlacedPicture, _lang: str) -> str:
    """Return a picture as Typst markup that contains its file: a string can refer to none."""
    file = f'bytes({typst_literal(part.picture.svg)}), format: "svg"'
    return f"#box(baseline: 40%, image({file}, alt: {typst_literal(part.alt)}));"


@inlines_to_typst.register
def _format_field(part: PlacedField, lang: str) -> str:
    """Return the field of a part as Typst markup: a ruled blank, or a box before each option.

    Where the field stands elsewhere, there are dots or the options alone.
    """
    label = f'#text(0.85em, fill: rgb("#4b5563"), {typst_literal(f"({part.label})")});#h(0.25em);'
    label = label if part.label else ""
    if not part.options:
        blank = "…" if part.elsewhere else f"#blank({typst_literal(part.label)});"
        return f"#box[{label}{blank}];"
    boxed = [
        f"#box[{'' if part.elsewhere else _format_box(part.label, mark)}"
        f"{_format_mark(mark)}{inlines_to_typst(said, lang)}];"
        for mark, said in part.options
    ]
    first, *rest = boxed
    return " #h(0.4em); ".join([f"#box[{label}{first}];", *rest])


def _format_box(label: str, mark: str) -> str:
    """Return the box of an option in Typst."""
    return f"#option({typst_literal(label)}, {typst_literal(mark)});#h(0.3em);"


def _format_mark(mark: str) -> str:
    """Return the letter of an option in Typst; nothing where its words are its mark."""
    return f"#strong({typst_literal(mark)}) " if len(mark) == 1 else ""


def typst_passage(body: str) -> str:
    """Return Typst that evaluates the markup of one passage from a string.

    Typst remembers how it laid a passage out, but takes its place in a file as part of it. What is
    read from a string has none: it is laid out once for all papers that say it.
    """
    return f"#passage({typst_literal(body)});" if body else ""


@lru_cache(maxsize=1 << 12)
def typst_equation(maths: TypesetMaths, lang: str, *, block: bool) -> str:
    """Return a formula as Typst markup, with its words for screen readers."""
    spoken = typst_literal(typeset.to_speech(maths.node, lang))
    space = " " if block else ""
    body = f"${space}{typeset.to_typst(maths.node, lang)}{space}$"
    return f"#math.equation(alt: {spoken}, block: {str(block).lower()}, {body});"


def blocks_to_typst(parts: Iterable[prose.Block], lang: str) -> str:
    """Return blocks as Typst markup."""
    return "\n\n".join(_reject_block(part, lang) for part in parts)


@singledispatch
def _reject_block(part: prose.Block, lang: str) -> str:
    """Raise ``TypeError``: no writer is registered for this type of block."""
    raise TypeError(f"no Typst for {type(part).__name__} ({lang})")


@_reject_block.register
def _format_paragraph(part: prose.Paragraph, lang: str) -> str:
    """Return a paragraph as Typst markup."""
    return typst_passage(inlines_to_typst(part.children, lang))


@_reject_block.register
def _format_code_block(part: prose.CodeBlock, _lang: str) -> str:
    """Return a block of code as Typst markup."""
    return f"#raw({typst_literal(part.text)}, block: true);"


@_reject_block.register
def _format_list(part: prose.ListBlock, lang: str) -> str:
    """Return a list as Typst markup."""
    name = "enum" if part.ordered else "list"
    return f"#{name}({', '.join(f'[{blocks_to_typst(item, lang)}]' for item in part.items)});"


@_reject_block.register
def _format_table(part: prose.TableBlock, lang: str) -> str:
    """Return a table as Typst markup."""
    cells = [cell for row in (part.head, *part.rows) for cell in row]
    head = ", ".join(f"[{inlines_to_typst(cell, lang)}]" for cell in part.head)
    rest = ", ".join(f"[{inlines_to_typst(cell, lang)}]" for cell in cells[len(part.head) :])
    placed = any(isinstance(one, PlacedField) for cell in cells for one in cell)
    align = "align: horizon, " if placed else ""
    headed = f"table.header({head}), " if any(part.head) else ""
    return f"#table(columns: {len(part.head)}, {align}{headed}{rest});"


def in_language(lang: str, body: str) -> str:
    """Return paragraphs marked as written in a language."""
    return f"#spoken({typst_literal(lang)})[{body}];"


def say_in_language(lang: str, body: str) -> str:
    """Return words within a line, marked as written in a language."""
    return f"#say({typst_literal(lang)})[{typst_passage(body)}];"


def stack_languages(langs: Iterable[str], bodies: Iterable[str]) -> str:
    """Return the same paragraphs in each language, the second one set off by a rule."""
    spoken = [in_language(lang, body) for lang, body in zip(langs, bodies, strict=True) if body]
    return "\n".join([*spoken[:1], *(f"#bilingual[{body}];" for body in spoken[1:])])


def join_languages(langs: tuple[str, ...], texts: Iterable[str]) -> str:
    """Return the same words in each language, in one line."""
    return '#" / ";'.join(
        say_in_language(lang, text) for lang, text in zip(langs, texts, strict=True)
    )


def translate_all(langs: tuple[str, ...], key: str, **values: object) -> str:
    """Return words of the interface in each language, in one line."""
    return join_languages(
        langs, [f"#{typst_literal(translate(lang, key, **values))};" for lang in langs]
    )


@cache
def _load_font_collection() -> Any:
    """Return the fonts that Typst may use: pinned ones, never the machine's own."""
    import typst

    return typst.Fonts(
        include_system_fonts=False,
        include_embedded_fonts=True,
        font_paths=[str(fonts.bangla_folder()), str(fonts.PRINT)],
    )


def replace_unprintable(text: str) -> str:
    """Return a text with ``?`` for each character that no font has, as one alone stops the page."""
    return "".join(c if _has_glyph(c) else "?" for c in text)


@cache
def _has_glyph(character: str) -> bool:
    """Return whether a character can be printed, found out by typesetting it."""
    if character in _KNOWN or unicodedata.category(character) in {"Mn", "Mc", "Cf"}:
        return True  # a mark is printed with the letter before it
    page = f'#set document(title: [x])\n#text(lang: "en", {typst_literal(character)})'
    try:
        compile_pdf({MAIN: page.encode()})
    except RenderError:
        return False
    return True


@cache
def _make_empty_compiler() -> Any:
    """Return a Typst compiler for empty documents, which push older ones out of Typst's memory."""
    import typst

    return typst.Compiler(b"", font_paths=_load_font_collection())


def evict_cache(documents: int) -> None:
    """Free memory: Typst keeps what it typeset until ten more documents did not need it.

    Parameters
    ----------
    documents : int
        How many to pretend.
    """
    _check_not_forked()
    for _ in range(documents):
        _make_empty_compiler().compile(b"", format="pdf")


def document_files(layout: str, body: str, package: str = "quizgen.render") -> dict[str, bytes]:
    """Return the files of a document by name: its body, and the layouts that all documents share.

    Parameters
    ----------
    layout : str
        The page layout, a file of ``pages``.
    body : str
        What calls its functions.
    package : str
        Whose ``pages``.
    """
    names = {"common.typ": "quizgen.render", layout: package}
    imports = "".join(f"#import {typst_literal(name)}: *\n" for name in names)
    pages = {name: _build_layout_source(name, whose) for name, whose in names.items()}
    return {**pages, MAIN: f"{imports}{body}".encode()}


@cache
def _build_layout_source(name: str, package: str) -> bytes:
    """Return the Typst source of a layout, with the values from Python that it needs."""
    before = '#import "common.typ": *'
    if name == "common.typ":
        before = (
            f"#let bangla = "
            f"({''.join(f'{typst_literal(lang)},' for lang in languages_in_script('Beng'))})"
        )
    text = (fonts.package_folder(package) / "pages" / name).read_text(encoding="utf-8")
    return f"{before}\n{text}".encode()


def compile_pdf(sources: Mapping[str, bytes]) -> bytes:
    """Return a document with its pictures as a tagged PDF.

    Raises
    ------
    RenderError
        If Typst refuses the document or a font is missing.
    """
    import typst

    _check_not_forked()
    world: Any = dict(sources)  # the stub knows one file only
    try:
        data, warnings = typst.compile_with_warnings(
            world,
            format="pdf",
            pdf_standards=STANDARD,
            font_paths=_load_font_collection(),
            timestamp=MOMENT,
        )
    except typst.TypstError as error:
        raise RenderError(f"PDF: {error}") from error
    if warnings:
        raise RenderError(f"PDF: {warnings[0]}")
    return bytes(data)


def query_metadata(sources: Mapping[str, bytes], label: str) -> list[list[Any]]:
    """Return what a document says of itself in the metadata with a label, in its order.

    Raises
    ------
    RenderError
        If Typst refuses the document.
    """
    import typst

    _check_not_forked()
    world: Any = dict(sources)
    try:
        fonts: Any = _load_font_collection()
        return json.loads(typst.query(world, f"<{label}>", field="value", font_paths=fonts))
    except typst.TypstError as error:
        raise RenderError(f"PDF: {error}") from error


def _check_not_forked() -> None:
    """Raise an error in a forked process: Typst's threads are missing there, and it would hang."""
    if _get_first_process_id() != os.getpid():
        raise RenderError(
            "PDF: this process was forked from one that had made a PDF, and Typst does not survive "
            'that: start processes by multiprocessing.get_context("spawn") or "forkserver"'
        )


@cache
def _get_first_process_id() -> int:
    """Return the id of the process that typeset first."""
    return os.getpid()
