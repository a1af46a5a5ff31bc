"""Pieces of Typst markup that every PDF is made of, and the typesetting itself."""

from __future__ import annotations

import json
import os
import unicodedata
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from functools import cache, lru_cache, singledispatch
from typing import Any, Final

from quizgen import typeset
from quizgen.bank import prose
from quizgen.errors import RenderError
from quizgen.locale import in_script, word
from quizgen.question.filling import tied
from quizgen.question.shown import Maths, PlacedPicture
from quizgen.render import fonts

_KNOWN = frozenset(map(chr, (*range(0x20, 0x7F), *range(0xA1, 0x180), *range(0x985, 0x9E4))))
"""Latin and Bangla, in which most names are written."""
_LITERAL: Final = json.JSONEncoder(ensure_ascii=False)
STANDARD: Final = "ua-1"
MAIN: Final = "main.typ"
MOMENT = datetime(2000, 1, 1, tzinfo=UTC)
"""The date written into every file: the same paper is the same bytes on any day."""


def string(text: str) -> str:
    """A Typst string literal: nothing in it is ever read as markup."""
    return _LITERAL.encode(text)


@singledispatch
def inline(part: prose.Inline | tuple[prose.Inline, ...], lang: str) -> str:
    """Inlines as Typst markup."""
    raise TypeError(f"no Typst for {type(part).__name__} ({lang})")


@inline.register(tuple)
@lru_cache(maxsize=1 << 13)
def _inlines(parts: tuple[prose.Inline, ...], lang: str) -> str:
    """A sentence: most stand in the exam and its solutions, or in the next paper too."""
    return "".join(_together(group, lang) for group in tied(parts))


def _together(group: tuple[prose.Inline, ...], lang: str) -> str:
    body = "".join(inline(part, lang) for part in group)
    return f"#box[{body}];" if len(group) > 1 else body


@inline.register
def _plain(part: prose.Words, _lang: str) -> str:
    return f"#{string(part.text)};"


@inline.register
def _maths(part: Maths, lang: str) -> str:
    return equation(part, lang, block=False)


@inline.register
def _code(part: prose.Code, _lang: str) -> str:
    return f"#raw({string(part.text)});"


@inline.register
def _styled(part: prose.Styled, lang: str) -> str:
    name = "emph" if part.style == "em" else "strong"
    return f"#{name}[{inline(part.children, lang)}];"


@inline.register
def _picture(part: PlacedPicture, _lang: str) -> str:
    """A picture with its file in it, as what is read from a string knows no files."""
    file = f'bytes({string(part.picture.svg)}), format: "svg"'
    return f"#box(baseline: 40%, image({file}, alt: {string(part.alt)}));"


def passage(body: str) -> str:
    """Markup that reads markup of one passage out of a string.

    Typst remembers how it laid a passage out, but takes its place in a file as part of it. What is
    read from a string has none: it is laid out once for all papers that say it.
    """
    return f"#passage({string(body)});" if body else ""


@lru_cache(maxsize=1 << 12)
def equation(maths: Maths, lang: str, *, block: bool) -> str:
    """A formula with its spoken alternative."""
    spoken = string(typeset.spoken(maths.node, lang))
    space = " " if block else ""
    body = f"${space}{typeset.typst(maths.node, lang)}{space}$"
    return f"#math.equation(alt: {spoken}, block: {str(block).lower()}, {body});"


def blocks(parts: Iterable[prose.Block], lang: str) -> str:
    """Blocks as Typst markup."""
    return "\n\n".join(_block(part, lang) for part in parts)


@singledispatch
def _block(part: prose.Block, lang: str) -> str:
    raise TypeError(f"no Typst for {type(part).__name__} ({lang})")


@_block.register
def _paragraph(part: prose.Paragraph, lang: str) -> str:
    return passage(inline(part.children, lang))


@_block.register
def _code_block(part: prose.CodeBlock, _lang: str) -> str:
    return f"#raw({string(part.text)}, block: true);"


@_block.register
def _items(part: prose.Items, lang: str) -> str:
    name = "enum" if part.ordered else "list"
    return f"#{name}({', '.join(f'[{blocks(item, lang)}]' for item in part.items)});"


@_block.register
def _table(part: prose.Table, lang: str) -> str:
    cells = [cell for row in (part.head, *part.rows) for cell in row]
    head = ", ".join(f"[{inline(cell, lang)}]" for cell in part.head)
    rest = ", ".join(f"[{inline(cell, lang)}]" for cell in cells[len(part.head) :])
    return f"#table(columns: {len(part.head)}, table.header({head}), {rest});"


def within(lang: str, body: str) -> str:
    """Paragraphs in a language."""
    return f"#spoken({string(lang)})[{body}];"


def say(lang: str, body: str) -> str:
    """Words in a language, within a line."""
    return f"#say({string(lang)})[{passage(body)}];"


def each(langs: Iterable[str], bodies: Iterable[str]) -> str:
    """The same thing in each language: the second one set off by a rule."""
    spoken = [within(lang, body) for lang, body in zip(langs, bodies, strict=True) if body]
    return "\n".join([*spoken[:1], *(f"#bilingual[{body}];" for body in spoken[1:])])


def joined(langs: tuple[str, ...], texts: Iterable[str]) -> str:
    """The same words in each language, in one line."""
    return '#" / ";'.join(say(lang, text) for lang, text in zip(langs, texts, strict=True))


def words(langs: tuple[str, ...], key: str, **values: object) -> str:
    """Words of the interface in each language, in one line."""
    return joined(langs, [f"#{string(word(lang, key, **values))};" for lang in langs])


@cache
def _fonts() -> Any:
    """One font collection per process: only pinned fonts, never the machine's own."""
    import typst

    return typst.Fonts(
        include_system_fonts=False,
        include_embedded_fonts=True,
        font_paths=[str(fonts.bangla_folder())],
    )


def printable(text: str) -> str:
    """A text with ``?`` for each character that no font here has: one alone would stop the page."""
    return "".join(c if _has_glyph(c) else "?" for c in text)


@cache
def _has_glyph(character: str) -> bool:
    if character in _KNOWN or unicodedata.category(character) in {"Mn", "Mc", "Cf"}:
        return True  # a mark is printed with the letter before it
    page = f'#set document(title: [x])\n#text(lang: "en", {string(character)})'
    try:
        compiled({MAIN: page.encode()})
    except RenderError:
        return False
    return True


@cache
def _scratch() -> Any:
    """A compiler for documents that nobody reads."""
    import typst

    return typst.Compiler(b"", font_paths=_fonts())


def forget(documents: int) -> None:
    """Free memory: Typst keeps what it typeset until ten more documents have not needed it.

    Parameters
    ----------
    documents : int
        How many to pretend.
    """
    _stay()
    for _ in range(documents):
        _scratch().compile(b"", format="pdf")


def document(layout: str, body: str, package: str = "quizgen.render") -> dict[str, bytes]:
    """Files of a document: the layouts stand in files of their own, the same for all documents.

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
    imports = "".join(f"#import {string(name)}: *\n" for name in names)
    pages = {name: _layout(name, whose) for name, whose in names.items()}
    return {**pages, MAIN: f"{imports}{body}".encode()}


@cache
def _layout(name: str, package: str) -> bytes:
    before = '#import "common.typ": *'
    if name == "common.typ":
        before = f"#let bangla = ({''.join(f'{string(lang)},' for lang in in_script('Beng'))})"
    text = (fonts.folder(package) / "pages" / name).read_text(encoding="utf-8")
    return f"{before}\n{text}".encode()


def compiled(sources: Mapping[str, bytes]) -> bytes:
    """Typeset a document, with the pictures among its files, as a tagged PDF.

    Raises
    ------
    RenderError
        If Typst refuses the document or a font is missing.
    """
    import typst

    _stay()
    world: Any = dict(sources)  # the stub knows one file only
    try:
        data, warnings = typst.compile_with_warnings(
            world, format="pdf", pdf_standards=STANDARD, font_paths=_fonts(), timestamp=MOMENT
        )
    except typst.TypstError as error:
        raise RenderError(f"PDF: {error}") from error
    if warnings:
        raise RenderError(f"PDF: {warnings[0]}")
    return bytes(data)


def png(svg: bytes, width: int) -> bytes:
    """Draw an SVG on white, at 144 pixels to an inch.

    Parameters
    ----------
    svg : bytes
    width : int
        Width of the picture in points.
    """
    import typst

    _stay()
    page = (
        f"#set page(width: {width}pt, height: auto, margin: 4pt, fill: white)\n"
        '#image("plot.svg", width: 100%)'
    )
    world: Any = {MAIN: page.encode(), "plot.svg": svg}  # the stub knows one file only
    made: Any = typst.compile(world, format="png", ppi=144.0, font_paths=_fonts())
    return bytes(made)


def _stay() -> None:
    """Refuse what would wait for ever: the threads of Typst do not come along in a fork."""
    if _home() != os.getpid():
        raise RenderError(
            "PDF: this process was forked from one that had made a PDF, and Typst does not survive "
            'that: start processes by multiprocessing.get_context("spawn") or "forkserver"'
        )


@cache
def _home() -> int:
    """The process that typeset first."""
    return os.getpid()
