"""A paper as a tagged PDF (PDF/UA-1), typeset by Typst in this process."""

from __future__ import annotations

import json
from collections.abc import Iterable
from datetime import UTC, datetime
from functools import cache, singledispatch
from importlib.resources import files
from typing import Any, Final

from quizgen import typeset
from quizgen.bank.prose import (
    Block,
    Code,
    CodeBlock,
    Inline,
    Items,
    Paragraph,
    Styled,
    Table,
    Words,
)
from quizgen.errors import RenderError
from quizgen.locale import in_script, marks, word
from quizgen.paper.paper import Item, Paper
from quizgen.question.compose import Field, Part, Question
from quizgen.question.filling import tied
from quizgen.question.shown import Maths
from quizgen.question.solution import Line, Mistake, PartSolution, Solution
from quizgen.render import fonts

STANDARD: Final = "ua-1"
MOMENT = datetime(2000, 1, 1, tzinfo=UTC)
"""The date written into every file: the same paper is the same bytes on any day."""


def string(text: str) -> str:
    """A Typst string literal: nothing in it is ever read as markup."""
    return json.dumps(text, ensure_ascii=False).replace("\\/", "/")


@singledispatch
def inline(part: Inline | tuple[Inline, ...], lang: str) -> str:
    """Inlines as Typst markup."""
    raise TypeError(f"no Typst for {type(part).__name__} ({lang})")


@inline.register(tuple)
def _inlines(parts: tuple[Inline, ...], lang: str) -> str:
    return "".join(_together(group, lang) for group in tied(parts))


def _together(group: tuple[Inline, ...], lang: str) -> str:
    body = "".join(inline(part, lang) for part in group)
    return f"#box[{body}];" if len(group) > 1 else body


@inline.register
def _plain(part: Words, _lang: str) -> str:
    return f"#{string(part.text)};"


@inline.register
def _maths(part: Maths, lang: str) -> str:
    return equation(part, lang, block=False)


@inline.register
def _code(part: Code, _lang: str) -> str:
    return f"#raw({string(part.text)});"


@inline.register
def _styled(part: Styled, lang: str) -> str:
    name = "emph" if part.style == "em" else "strong"
    return f"#{name}[{inline(part.children, lang)}];"


def equation(maths: Maths, lang: str, *, block: bool) -> str:
    """A formula with its spoken alternative."""
    spoken = string(typeset.spoken(maths.node, lang))
    space = " " if block else ""
    body = f"${space}{typeset.typst(maths.node, lang)}{space}$"
    return f"#math.equation(alt: {spoken}, block: {str(block).lower()}, {body});"


def blocks(parts: Iterable[Block], lang: str) -> str:
    """Blocks as Typst markup."""
    return "\n\n".join(_block(part, lang) for part in parts)


@singledispatch
def _block(part: Block, lang: str) -> str:
    raise TypeError(f"no Typst for {type(part).__name__} ({lang})")


@_block.register
def _paragraph(part: Paragraph, lang: str) -> str:
    return inline(part.children, lang)


@_block.register
def _code_block(part: CodeBlock, _lang: str) -> str:
    return f"#raw({string(part.text)}, block: true);"


@_block.register
def _items(part: Items, lang: str) -> str:
    name = "enum" if part.ordered else "list"
    return f"#{name}({', '.join(f'[{blocks(item, lang)}]' for item in part.items)});"


@_block.register
def _table(part: Table, lang: str) -> str:
    cells = [cell for row in (part.head, *part.rows) for cell in row]
    head = ", ".join(f"[{inline(cell, lang)}]" for cell in part.head)
    rest = ", ".join(f"[{inline(cell, lang)}]" for cell in cells[len(part.head) :])
    return f"#table(columns: {len(part.head)}, table.header({head}), {rest});"


def _in(lang: str, body: str) -> str:
    return f"#spoken({string(lang)})[{body}];"


def _say(lang: str, body: str) -> str:
    return f"#say({string(lang)})[{body}];"


def _each(langs: Iterable[str], bodies: Iterable[str]) -> str:
    """The same thing in each language: the second one set off by a rule."""
    spoken = [_in(lang, body) for lang, body in zip(langs, bodies, strict=True) if body]
    return "\n".join([*spoken[:1], *(f"#bilingual[{body}];" for body in spoken[1:])])


def _joined(langs: tuple[str, ...], texts: Iterable[str]) -> str:
    return '#" / ";'.join(_say(lang, text) for lang, text in zip(langs, texts, strict=True))


def _words(langs: tuple[str, ...], key: str, **values: object) -> str:
    return _joined(langs, [f"#{string(word(lang, key, **values))};" for lang in langs])


class _Sheet:
    """Typst source of one sheet, and the pictures it refers to."""

    def __init__(self, paper: Paper, kind: str) -> None:
        self.paper, self.kind, self.langs = paper, kind, paper.langs
        self.main = paper.langs[0]
        self.pictures: dict[str, bytes] = {}

    def source(self) -> str:
        """The whole document."""
        cover = self._cover()
        body = "\n\n".join(self._item(item) for item in self.paper.items)
        return f"{self._opening()}\n{cover}\n{body}\n"

    def _opening(self) -> str:
        page = word(self.main, "paper.page", page="\u0001", pages="\u0002")
        for mark, name in (("\u0001", "page"), ("\u0002", "pages")):
            page = page.replace(mark, f'" + {name} + "')
        title = self._title(self.main)
        return (
            f"#show: paper.with(title: {string(title)}, code: {string(self.paper.code)}, "
            f'lang: {string(self.main)}, of: (page, pages) => "{page}")'
        )

    def _title(self, lang: str) -> str:
        title = self.paper.title(lang)
        if self.kind == "solutions":
            return f"{title} - {word(lang, 'paper.solutions')}"
        return title

    def _cover(self) -> str:
        paper, main = self.paper, self.main
        head = f"#heading(level: 1)[{_say(main, f'#{string(self._title(main))};')}]"
        others = [
            _in(lang, f"#text(14pt, {string(self._title(lang))});") for lang in self.langs[1:]
        ]
        total = (
            f"{marks(paper.points, main)}, {paper.minutes} {word(main, 'paper.minutes')}, "
            f"{len(paper.items)} {word(main, 'paper.contents')}"
        )
        facts = (
            f"#facts(([{_words(self.langs, 'paper.code')}], raw({string(paper.code)})), "
            f"([{_words(self.langs, 'paper.total')}], {string(total)}))"
        )
        if self.kind == "solutions":
            return "\n".join([head, *others, "#v(0.6em)", facts, "#v(0.6em)"])
        lines = [
            f"#write-line([{_words(self.langs, f'paper.{name}')}])"
            for name in ("name", "matriculation")
        ]
        rules = _each(self.langs, [f"#{string(word(lang, 'paper.rules'))};" for lang in self.langs])
        gap = "#v(1.1em)"
        return "\n".join(
            [head, *others, gap, facts, gap, *(f"{line}\n#v(0.5em)" for line in lines), gap,
             f"#notice[{rules}]", "#v(0.8em)", self._overview(), "#pagebreak(weak: true)"]
        )  # fmt: skip

    def _overview(self) -> str:
        """Table of questions and marks, with room for the marks given."""
        rows = [
            f"[{item.number}], [{self._titles(item)}], [{float(item.points):g}], []"
            for item in self.paper.items
        ]
        head = (
            f"table.header([], [{_words(self.langs, 'paper.question')}], "
            f"[{_words(self.langs[:1], 'paper.points')}], [])"
        )
        return (
            "#{set text(9pt); table(columns: (auto, 1fr, auto, 4em), inset: 3.5pt, "
            f'stroke: 0.4pt + rgb("#b5bac2"), {head}, {", ".join(rows)})}}'
        )

    def _titles(self, item: Item) -> str:
        return _joined(self.langs, [f"#{string(q.title)};" for q in item.questions])

    def _item(self, item: Item) -> str:
        stem = _each(self.langs, [blocks(q.stem, q.lang) for q in item.questions])
        if self.kind == "exam":
            picture = self._picture(item, [q.figure for q in item.questions])
        else:
            picture = self._picture(item, [k.figure for k in item.keys])
        single = len(item.questions[0].parts) == 1
        parts = [self._part(item, index) for index in range(len(item.questions[0].parts))]
        body = f"#whole[{stem}\n{picture}]\n" + "\n".join(parts)
        if self.kind == "exam" and single:
            body = f"#part[{stem}\n{picture}\n{parts[0]}]"
        if self.kind == "solutions":
            body += self._remarks(item)
        worth = marks(item.points, self.main)
        return f"#question({string(item.number)}, [{self._titles(item)}], {string(worth)})[{body}]"

    def _picture(self, item: Item, figures: list[Any]) -> str:
        if figures[0] is None:
            return ""
        name = f"figure-{item.number}.svg"
        self.pictures[name] = figures[0].svg
        alt = string(" / ".join(figure.alt for figure in figures))
        width = f"{figures[0].width_pt:.2f}pt"
        return f"#v(0.4em)\n#image({string(name)}, width: {width}, alt: {alt})\n"

    def _part(self, item: Item, index: int) -> str:
        questions = item.questions
        first = questions[0].parts[index]
        label = f"({first.label}) " if first.label else ""
        worth = f"#worth({string(label + marks(first.points, self.main))})" if label else ""
        texts = [blocks(q.parts[index].body, q.lang) for q in questions]
        body = f"{worth}\n{_each(self.langs, texts)}"
        if self.kind == "exam":
            return f"#part[{body}\n{self._field(questions, index)}]"
        options = self._options(questions, index)
        return f"#whole[{body}\n{options}]\n{self._solution(item, index)}"

    def _field(self, questions: tuple[Question, ...], index: int) -> str:
        fields = [q.parts[index].field for q in questions]
        hints = [inline(f.hint, lang) for f, lang in zip(fields, self.langs, strict=True)]
        shown = f"#hint[{_each(self.langs, hints)}]" if any(hints) else ""
        return f"{self._options(questions, index)}\n{shown}\n#space({fields[0].control.lines})"

    def _options(self, questions: tuple[Question, ...], index: int) -> str:
        fields = [q.parts[index].field for q in questions]
        return "\n".join([*self._rows(fields, "options"), *self._rows(fields, "targets")])

    def _rows(self, fields: list[Field], side: str) -> list[str]:
        rows = []
        for place, (mark, _) in enumerate(getattr(fields[0], side)):
            texts = [
                inline(getattr(f, side)[place][1], lang)
                for f, lang in zip(fields, self.langs, strict=True)
            ]
            box = self.kind == "exam" and fields[0].control.ticked
            name = "tick" if box else "option"
            rows.append(f"#{name}({string(mark)}, [{_joined(self.langs, texts)}])")
        return rows

    def _solution(self, item: Item, index: int) -> str:
        parts = [key.solution.parts[index] for key in item.keys]
        steps = [self._step([p.lines[i] for p in parts]) for i in range(len(parts[0].lines))]
        answer = _joined(self.langs, [self._answer(p, lang) for p, lang in self._with_lang(parts)])
        reasons = [_reasons(part, lang) for part, lang in self._with_lang(parts)]
        return "\n".join([*steps, f"#result[{answer}]", _each(self.langs, reasons)])

    def _with_lang(self, parts: list[PartSolution]) -> list[tuple[PartSolution, str]]:
        return list(zip(parts, self.langs, strict=True))

    def _step(self, lines: list[Line]) -> str:
        why = _each(
            self.langs,
            [inline(line.why, lang) for line, lang in zip(lines, self.langs, strict=True)],
        )
        return f"#step([{equation(lines[0].maths, self.main, block=True)}], [{why}])"

    def _answer(self, part: PartSolution, lang: str) -> str:
        name = word(lang, "solution.answer")
        said = f"#strong({string(name + ':')}); {inline(part.shown, lang)}"
        options = [inline(option, lang) for option in part.options]
        if len(options) == 1:
            return f'{said}#" - ";{options[0]}'
        return f"{said}#list({', '.join(f'[{o}]' for o in options)});" if options else said

    def _remarks(self, item: Item) -> str:
        """What follows the parts: explanation, sanity check, common mistakes, remark."""
        solutions = [key.solution for key in item.keys]
        texts = [
            self._mistakes(s) if section == "mistakes" else self._remark(s, section)
            for section in ("why", "check", "precision", "mistakes", "note")
            for s in solutions
        ]
        return "\n" + "\n".join(filter(None, texts))

    def _remark(self, solution: Solution, section: str) -> str:
        body, lang = getattr(solution, section), solution.lang
        return _in(lang, f"{_heading(section, lang)}\n{blocks(body, lang)}") if body else ""

    def _mistakes(self, solution: Solution) -> str:
        rows = [
            _mistake(part.label, mistake, solution.lang)
            for part in solution.parts
            for mistake in part.mistakes
        ]
        if not rows:
            return ""
        return _in(solution.lang, "\n".join([_heading("mistakes", solution.lang), *rows]))


def _reasons(part: PartSolution, lang: str) -> str:
    """Why the answer of a part is right, and why each other choice is wrong."""
    why = [f"#block(inset: (left: 0.7em))[{inline(part.why, lang)}]"] if part.why else []
    wrong = [_mistake("", reason, lang) for reason in part.reasons]
    return "\n".join([*why, *wrong])


def _mistake(label: str, mistake: Mistake, lang: str) -> str:
    name = string(f"({label}) " if label else "")
    return f"#mistake({name}, [{inline(mistake.shown, lang)}], [{inline(mistake.sentence, lang)}])"


def _heading(section: str, lang: str) -> str:
    key = "precision.title" if section == "precision" else f"solution.{section}"
    return f"#heading(level: 3)[#{string(word(lang, key))};]"


@cache
def _fonts() -> Any:
    """One font collection per process: only pinned fonts, never the machine's own."""
    import typst

    return typst.Fonts(
        include_system_fonts=False,
        include_embedded_fonts=True,
        font_paths=[str(fonts.bangla_folder())],
    )


@cache
def _layout() -> str:
    return (files("quizgen.render") / "pages" / "paper.typ").read_text(encoding="utf-8")


def source(paper: Paper, kind: str) -> tuple[str, dict[str, bytes]]:
    """Typst source and pictures of a sheet."""
    sheet = _Sheet(paper, kind)
    bangla = "".join(f"{string(lang)}," for lang in in_script("Beng"))
    return f"#let bangla = ({bangla})\n{_layout()}\n{sheet.source()}", sheet.pictures


def render(paper: Paper, kind: str) -> bytes:
    """Render a paper as a PDF file.

    Raises
    ------
    RenderError
        If Typst refuses the document or a font is missing.
    """
    import typst

    text, pictures = source(paper, kind)
    world: Any = {"main.typ": text.encode(), **pictures}  # the stub knows one file only
    try:
        data, warnings = typst.compile_with_warnings(
            world, format="pdf", pdf_standards=STANDARD, font_paths=_fonts(), timestamp=MOMENT
        )
    except typst.TypstError as error:
        raise RenderError(f"PDF: {error}") from error
    if warnings:
        raise RenderError(f"PDF: {warnings[0]}")
    return bytes(data)


__all__ = ["Part", "render", "source"]
