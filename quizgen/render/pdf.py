"""A paper as a tagged PDF (PDF/UA-1), typeset by Typst in this process."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any, TypeVar

import msgspec

from quizgen.locale import format_amount, format_marks, translate
from quizgen.paper.paper import Paper, PaperItem
from quizgen.question.compose import Question
from quizgen.render.answer_fields import (
    BOARD_SCALE,
    GUTTER,
    WIDEST_BESIDE,
    PaperPart,
    choose_scale,
    count_beside,
    count_rows,
    is_ticked,
    mm_to_pt,
    name_fields,
    typeset_hint,
    typeset_letters,
    typeset_part,
    typeset_room,
    typeset_ruled_lines,
    typeset_text,
)
from quizgen.render.layouts import MOST_ROWS
from quizgen.render.solved_parts import typeset_remarks, typeset_solved_part
from quizgen.render.typst_document import (
    blocks_to_typst,
    compile_pdf,
    document_files,
    in_language,
    join_languages,
    replace_unprintable,
    say_in_language,
    stack_languages,
    translate_all,
    typst_literal,
)

SOLVED_SCALE = 0.66
"""Size of figures in solutions, which have been seen before."""
MOST_UNDER_A_COVER = 8
"""Questions of a paper whose first questions stand on the page of its cover."""

POINTS_A_PAGE = 10
"""Points for which a long paper has a page at most, beside that of its cover."""
TIGHTER = ("0.8", "0.6", "0.4", "0.25")
"""Shares of the room to work in that are tried where a paper has more pages."""
_PAGE = re.compile(rb"/Type ?/Page\b")

MOST_SOLVED_WIDTH = 80
"""Millimetres that a figure in solutions is wide at most."""

Typeset = TypeVar("Typeset")


class _TypstPaper:
    """Typst source of one paper or its solutions, and the pictures that it refers to."""

    def __init__(self, paper: Paper, kind: str, *, scanned: bool = False) -> None:
        self.paper, self.kind, self.langs, self.scanned = paper, kind, paper.langs, scanned
        self.main = paper.langs[0]
        self.pictures: dict[str, bytes] = {}

    def source(self) -> str:
        """Return the whole document."""
        cover = self._typeset_cover()
        body = "\n\n".join(self._typeset_question(item) for item in self.paper.items)
        if self.kind == "exam":
            body += "\n#v(1fr)"
        if self.scanned:
            body += '\n#spot("end", 0mm, 0mm)'
        return f"{self._typeset_opening()}\n{cover}\n{body}\n"

    def _typeset_opening(self) -> str:
        """Return the Typst rules that set title, code, language and page numbers."""
        of = translate(self.main, "paper.page", page="{page}", pages="{pages}")
        title = self._build_title(self.main)
        return (
            f"#about(title: {typst_literal(title)}, code: {typst_literal(self.paper.code)}, "
            f"holder: {typst_literal(_format_holder(self.paper))})\n"
            f"#show: paper.with(lang: {typst_literal(self.main)}, of: {typst_literal(of)})"
        )

    def _build_title(self, lang: str) -> str:
        """Return the title in one language."""
        title = self.paper.title(lang)
        if self.kind == "solutions":
            return f"{title} - {translate(lang, 'paper.solutions')}"
        return title

    def _typeset_cover(self) -> str:
        """Return the cover page of an exam."""
        main = self.main
        head = (
            f"#heading(level: "
            f"1)[{say_in_language(main, f'#{typst_literal(self._build_title(main))};')}]"
        )
        others = [
            in_language(lang, f"#text(14pt, {typst_literal(self._build_title(lang))});")
            for lang in self.langs[1:]
        ]
        facts = self._typeset_facts()
        if self.kind == "solutions":
            return "\n".join(
                [head, *others, "#v(0.6em)", facts, *self._typeset_scheme_note(), "#v(0.6em)"]
            )
        unknown = () if self.paper.holder else ("name", "matriculation")
        labels = ", ".join(f"[{translate_all(self.langs, f'paper.{name}')}]" for name in unknown)
        ends = "#pagebreak(weak: true)" if len(self.paper.items) > MOST_UNDER_A_COVER else ""
        return "\n".join(
            [
                head,
                *others,
                facts,
                *self._typeset_printing_note(),
                f"#blanks({labels})" if labels else "",
                self._typeset_rules(),
                *typeset_house_rules(self.paper),
                self._typeset_mark_table(),
                ends,
            ]
        )

    def _typeset_rules(self) -> str:
        """Return what may lie on the desk and how answers are written, in two columns."""
        aids = join_languages(
            self.langs, [f"#{typst_literal(self.paper.aids(lang))};" for lang in self.langs]
        )
        rows = [f"rule([{translate_all(self.langs, 'paper.aids')}], [{aids}])"]
        for name in ("numbers", "working", "ticks"):
            said = [self._typeset_paper_word(name, lang) for lang in self.langs]
            if name == "numbers" and self.scanned:
                cells = [self._typeset_paper_word("cells", lang) for lang in self.langs]
                said = [f"{one} {cell}" for one, cell in zip(said, cells, strict=True)]
            title = translate_all(self.langs, f"paper.{name}_title")
            rows.append(f"rule([{title}], [{stack_languages(self.langs, said)}])")
        return f"#rules({', '.join(rows)})"

    def _typeset_printing_note(self) -> list[str]:
        """Return a note that names the questions to be printed in colour; none without such."""
        if not self.paper.printing(self.main):
            return []
        said = [f"#hint[#{typst_literal(self.paper.printing(lang))};]" for lang in self.langs]
        return ["#v(0.6em)", stack_languages(self.langs, said)]

    def _typeset_paper_word(self, name: str, lang: str) -> str:
        """Return a word of the section ``paper`` of the interface, as Typst markup."""
        return f"#{typst_literal(translate(lang, f'paper.{name}'))};"

    def _typeset_facts(self) -> str:
        """Return code, points and minutes; before an exam also what may lie on the desk."""
        paper, main = self.paper, self.main
        minutes = translate(main, "paper.minutes")
        count = "question" if len(paper.items) == 1 else "contents"
        total = (
            f"{format_marks(paper.points, main)}, {paper.minutes} {minutes}, "
            f"{len(paper.items)} {translate(main, f'paper.{count}')}"
        )
        if self.kind == "exam":
            total = f"{total}. {translate(main, 'paper.time')}"
        rows = [("code", f"raw({typst_literal(paper.code)})"), ("total", typst_literal(total))]
        if paper.holder:
            known = (("name", paper.holder.name), ("matriculation", paper.holder.id))
            rows = [
                *(
                    (name, typst_literal(replace_unprintable(value)))
                    for name, value in known
                    if value
                ),
                *rows,
            ]
        if self.kind == "exam":
            rows = [*list_cover_facts(paper), *rows]
        named = [
            f"([{translate_all(self.langs, f'paper.{name}')}], {value})" for name, value in rows
        ]
        return f"#facts({', '.join(named)})"

    def _typeset_scheme_note(self) -> list[str]:
        """Return a note on the points and, if there are any, the numbers of formulas at steps."""
        cited = self.paper.cited_formula
        said = []
        for lang in self.langs:
            lines = [translate(lang, "scheme.rule")]
            lines += [translate(lang, "solution.cited", formula=cited)] if cited else []
            said.append(f"#hint[#{typst_literal(' '.join(lines))};]")
        return [stack_languages(self.langs, said)]

    def _typeset_mark_table(self) -> str:
        """Return the table of questions and points, with room for the points given."""
        rows = [
            f"([{item.number}], [{self._join_question_titles(item)}"
            f"], [{format_amount(item.points, self.main)}])"
            for item in self.paper.items
        ]
        main, many = self.langs[:1], self.langs
        heads = [
            translate_all(langs, f"paper.{name}")
            for name, langs in (
                ("question", many),
                ("page_of", main),
                ("points_of", main),
                ("reached", main),
            )
        ]
        total = f"[{format_amount(self.paper.points, self.main)}]"
        return (
            f"#overview({', '.join(f'[{head}]' for head in heads)}, "
            f"[{translate_all(many, 'paper.sum')}], {total}, ({', '.join(rows)},))"
        )

    def _join_question_titles(self, item: PaperItem) -> str:
        """Return a question's titles in all languages of the paper, in one line."""
        return join_languages(self.langs, [f"#{typst_literal(q.title)};" for q in item.questions])

    def _typeset_question(self, item: PaperItem) -> str:
        """Return one question with its parts; in solutions, with what follows them."""
        worth = format_marks(item.points, self.main)
        head = (
            f"#question({typst_literal(item.number)}, "
            f"[{self._join_question_titles(item)}], {typst_literal(worth)})"
        )
        asked = self._typeset_asked if self.kind == "exam" else self._typeset_solved
        return f"{head}\n{asked(item)}"

    def _typeset_solved(self, item: PaperItem) -> str:
        """Return the stem of a question, its figure beside it, its solved parts, and remarks."""
        stem = f"#asked[{self._typeset_stem(item)}]"
        figure = item.keys[0].figure
        if figure:
            scale = min(SOLVED_SCALE, mm_to_pt(MOST_SOLVED_WIDTH) / figure.width_pt)
            picture = self._typeset_picture(item.number, [k.figure for k in item.keys], scale)
            wide = figure.width_pt * scale / mm_to_pt(1)
            is_small = wide <= WIDEST_BESIDE and bool(item.questions[0].stem)
            stem = (
                f"#beside({wide:.1f}mm, {picture})[{stem}]"
                if is_small
                else f"#stem[{stem}]\n#centred({picture})"
            )
        else:
            stem = f"#stem[{stem}]"
        solved = []
        for one in self._list_parts(item):
            drawn = [s.drawing.figure for s in one.solved if s.drawing]
            name = f"{item.number}{one.first.label}"
            solved.append(typeset_solved_part(one, self._typeset_picture(name, drawn, BOARD_SCALE)))
        return "\n".join([stem, *solved, typeset_remarks([key.solution for key in item.keys])])

    def _typeset_stem(self, item: PaperItem) -> str:
        """Return what stands before the parts of a question, in all languages."""
        questions = write_for_paper(item)
        return stack_languages(self.langs, [blocks_to_typst(q.stem, q.lang) for q in questions])

    def _list_parts(self, item: PaperItem) -> list[PaperPart]:
        """Return the parts of a question, each in all languages."""
        questions = write_for_paper(item)
        return [
            PaperPart(
                self.langs,
                tuple(q.parts[index] for q in questions),
                tuple(key.solution.parts[index] for key in item.keys),
            )
            for index in range(len(item.questions[0].parts))
        ]

    def _typeset_asked(self, item: PaperItem) -> str:
        """Return a question as it is asked: its stem beside or above its figure, and its parts.

        A question with a figure stays on one page; another may go on to the next between parts.
        """
        stem, parts = self._typeset_stem(item), self._list_parts(item)
        figure = item.questions[0].figure
        if not figure:
            drawn = any(one.first.field.drawing for one in parts)
            begun = [f"#stem[{stem}]"] if stem else []
            return "\n".join([*begun, *self._iter_asked(parts, hold=drawn)])
        scale = choose_scale(figure)
        picture = self._typeset_picture(item.number, [q.figure for q in item.questions], scale)
        wide = figure.width_pt * scale / mm_to_pt(1)
        if wide > WIDEST_BESIDE:
            return "\n".join(
                [f"#stem[{stem}]", f"#centred({picture})", *self._iter_asked(parts, hold=True)]
            )
        high = figure.height_pt * scale / mm_to_pt(1)
        beside = count_beside(parts, item.questions, wide, high)
        narrow = [part._replace(less=wide + GUTTER) for part in parts[:beside]]
        left = "\n".join([stem, *self._iter_asked(narrow, hold=True)])
        return "\n".join(
            [
                f"#beside({wide:.1f}mm, {picture})[{left}]",
                *self._iter_asked(parts, begin=beside, hold=True),
            ]
        )

    def _iter_asked(
        self, parts: Sequence[PaperPart], begin: int = 0, *, hold: bool
    ) -> Iterator[str]:
        """Yield the parts of a question from one on; ``hold`` keeps all of them on one page."""
        for index in range(begin, len(parts)):
            one, is_last = parts[index], index == len(parts) - 1
            held = hold and not is_last
            if one.first.field.near is not None:
                yield self._typeset_placed_part(parts, index, hold=held)
                continue
            empty = [field.drawing.figure for field in one.fields if field.drawing]
            drawing = self._typeset_picture(one.first.field.id, empty, BOARD_SCALE)
            if drawing and self.scanned:
                size = (side * BOARD_SCALE for side in (empty[0].width_pt, empty[0].height_pt))
                drawing = f"board({', '.join(f'{side:.2f}' for side in size)}, {drawing})"
            room = typeset_ruled_lines(one, hold=held) or typeset_room(
                count_rows(one), one.first.points, hold=held
            )
            worth = format_amount(one.first.points, self.main)
            yield (
                f"#part({typst_literal(one.first.label)}, {typst_literal(worth)}, "
                f"hold: {str(held or bool(room)).lower()}, less: {one.less:.1f}mm)"
                f"[{typeset_part(one, drawing)}]\n{room}"
            )

    def _typeset_picture(self, name: str, figures: list[Any], scale: float) -> str:
        """Return the call for a figure with its description, or "" without one.

        Its file is noted under ``name`` among the pictures of the paper.
        """
        if not figures or figures[0] is None:
            return ""
        name = f"figure-{name}.svg"
        self.pictures[name] = figures[0].standalone_svg
        alt = typst_literal(" / ".join(figure.alt for figure in figures))
        width = f"{figures[0].width_pt * scale:.2f}pt"
        return f"image({typst_literal(name)}, width: {width}, alt: {alt})"

    def _typeset_placed_part(self, parts: Sequence[PaperPart], index: int, *, hold: bool) -> str:
        """Return a part whose field stands in a text: one line below it, with points and hints.

        The last of those in one text has room to work in.
        """
        one = parts[index]
        is_last = not any(part.first.shared for part in parts[index + 1 : index + 2])
        begin = max(place for place in range(index + 1) if not parts[place].first.shared)
        group = parts[begin : index + 1]
        points = sum((part.first.points for part in group), Fraction(0))
        rows = sum(count_rows(part) for part in group) if is_last else 0
        room = typeset_room(min(rows, MOST_ROWS), points, hold=hold)
        said = typeset_hint(one) if not is_ticked(one.first.field) else ""
        worth = format_amount(one.first.points, self.main)
        return (
            f"#part({typst_literal(one.first.label)}, {typst_literal(worth)}, "
            f"hold: {str(hold or bool(room) or not is_last).lower()})"
            f"[{typeset_text(one)}#box(height: 1em);{said}]\n{room}"
        )


def write_for_paper(item: PaperItem) -> tuple[Question, ...]:
    """Return a question in its languages: a field stands in the words of the first alone.

    Where a formula is asked, its letters are no code.
    """
    first, *others = item.questions
    questions = (first, *(_change_words(question, name_fields) for question in others))
    fields = [part.field for part in first.parts]
    if not any(field.control.form == "line" and not field.is_number for field in fields):
        return questions
    return tuple(_change_words(question, typeset_letters) for question in questions)


def _change_words(question: Question, change: Callable[[Any], Any]) -> Question:
    """Return a question whose stem and parts are said otherwise."""
    parts = (msgspec.structs.replace(part, body=change(part.body)) for part in question.parts)
    return msgspec.structs.replace(question, stem=change(question.stem), parts=tuple(parts))


def _format_holder(paper: Paper) -> str:
    """Return whose paper it is, for the foot of every page."""
    holder = paper.holder
    known = (holder.name, holder.id) if holder and not holder.hidden else ()
    return " · ".join(map(replace_unprintable, filter(None, known)))


def typst_sources(paper: Paper, kind: str, *, scanned: bool = False) -> dict[str, bytes]:
    """Return the Typst files of a paper and its pictures, by file name.

    With ``scanned``, fields to draw in say where they stand, and so does the end.
    """
    sheet = _TypstPaper(paper, kind, scanned=scanned)
    return {**document_files("paper.typ", sheet.source()), **sheet.pictures}


def render_paper_pdf(paper: Paper, kind: str) -> bytes:
    """Return a paper as a PDF file.

    Raises
    ------
    RenderError
        If Typst refuses the document or a font is missing.
    """
    sources = typst_sources(paper, kind)
    if kind != "exam":
        return compile_pdf(sources)
    return fit_to_pages(paper, sources, compile_pdf, lambda data: len(_PAGE.findall(data)))


def fit_to_pages(
    paper: Paper,
    sources: dict[str, bytes],
    typeset: Callable[[dict[str, bytes]], Typeset],
    count_pages: Callable[[Typeset], int],
) -> Typeset:
    """Return a paper typeset with as much room to work in as its pages allow, or on the fewest.

    What is left of a page is room, too, so that tight questions lose little. A paper in two
    languages is as long as it is.

    Parameters
    ----------
    paper : Paper
    sources : dict of str to bytes
        Typst files of the paper.
    typeset : callable
        Makes of them what is wanted.
    count_pages : callable
        Pages of that.
    """
    made = typeset(sources)
    if len(paper.items) <= MOST_UNDER_A_COVER or len(paper.langs) > 1:
        return made
    pages, most = count_pages(made), math.ceil(paper.points / POINTS_A_PAGE) + 1
    for share in TIGHTER:
        if pages <= most:
            break
        layout = sources["paper.typ"].replace(b"#let tight = 1", f"#let tight = {share}".encode())
        tight = typeset({**sources, "paper.typ": layout})
        if count_pages(tight) < pages:
            made, pages = tight, count_pages(tight)
    return made


def list_cover_facts(paper: Paper) -> list[tuple[str, str]]:
    """Return pairs of a word of the section ``paper`` and its value as Typst code."""
    if paper.cover is None:
        return []
    rows = []
    for name in paper.cover.facts:
        said = dict.fromkeys(
            replace_unprintable(paper.cover.pick_fact(name, lang)) for lang in paper.langs
        )
        shown = [f"#{typst_literal(text)};" for text in said]
        value = join_languages(paper.langs, shown) if len(said) > 1 else shown[0]
        rows.append((name, f"[{value}]"))
    return rows


def typeset_house_rules(paper: Paper) -> list[str]:
    """Return Typst source of the rules of the room, and of the line to sign on."""
    if paper.cover is None:
        return []
    found = []
    rules = paper.cover.rules
    spoken = [lang for lang in paper.langs if rules.get(lang)]
    lists = {lang: _typeset_list(rules[lang]) for lang in spoken}
    if not lists and any(rules.values()):
        lists = {paper.langs[0]: _typeset_list(next(filter(None, rules.values())))}
    if lists:
        found.append(f"#block(above: 0.9em)[{stack_languages([*lists], lists.values())}]")
    if paper.cover.signature:
        label = translate_all(paper.langs, "paper.signature")
        found.append(
            "#v(1.4em)\n#grid(columns: (auto, 1fr), column-gutter: 0.6em, align: bottom, "
            f"[{label}], line(length: 100%, stroke: 0.5pt))"
        )
    return found


def _typeset_list(lines: Iterable[str]) -> str:
    """Return Typst source of lines as a list."""
    rows = "".join(f"[#{typst_literal(replace_unprintable(line))};]," for line in lines)
    return f"#list({rows})"
