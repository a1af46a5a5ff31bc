"""A paper as a tagged PDF (PDF/UA-1), typeset by Typst in this process."""

from __future__ import annotations

from typing import Any

from quizgen.locale import amount, marks, word
from quizgen.paper.paper import Item, Paper
from quizgen.question.compose import Field, Part, Question
from quizgen.question.solution import Line, Mistake, PartSolution, Solution
from quizgen.render.room import squares
from quizgen.render.typ import (
    blocks,
    compiled,
    document,
    each,
    equation,
    inline,
    joined,
    passage,
    printable,
    say,
    string,
    within,
    words,
)

SCALE = {"exam": 1.0, "solutions": 0.8}
"""Size of figures: smaller where they have been seen before, so that less of a page stays empty."""

SURE_TO_FIT = 80
"""Characters of a typed formula that is no wider than the page: none takes more than 5.5 pt."""


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
        if self.kind == "exam":
            body += "\n#v(1fr)"
        return f"{self._opening()}\n{cover}\n{body}\n"

    def _opening(self) -> str:
        of = word(self.main, "paper.page", page="{page}", pages="{pages}")
        title = self._title(self.main)
        return (
            f"#about(title: {string(title)}, code: {string(self.paper.code)}, "
            f"holder: {string(_named(self.paper))})\n"
            f"#show: paper.with(lang: {string(self.main)}, of: {string(of)})"
        )

    def _title(self, lang: str) -> str:
        title = self.paper.title(lang)
        if self.kind == "solutions":
            return f"{title} - {word(lang, 'paper.solutions')}"
        return title

    def _cover(self) -> str:
        main = self.main
        head = f"#heading(level: 1)[{say(main, f'#{string(self._title(main))};')}]"
        others = [
            within(lang, f"#text(14pt, {string(self._title(lang))});") for lang in self.langs[1:]
        ]
        facts = self._facts()
        if self.kind == "solutions":
            return "\n".join([head, *others, "#v(0.6em)", facts, *self._cited(), "#v(0.6em)"])
        unknown = () if self.paper.holder else ("name", "matriculation")
        lines = [f"#write-line([{words(self.langs, f'paper.{name}')}])" for name in unknown]
        rules = each(self.langs, [self._said("on_paper", lang) for lang in self.langs])
        gap = "#v(1.1em)"
        return "\n".join(
            [head, *others, gap, facts, *self._printing(), gap,
             *(f"{line}\n#v(0.5em)" for line in lines), gap, f"#notice[{rules}]", "#v(0.8em)",
             self._overview(), "#pagebreak(weak: true)"]
        )  # fmt: skip

    def _printing(self) -> list[str]:
        """Which questions have to be printed in colour."""
        if not self.paper.printing(self.main):
            return []
        said = [f"#hint[#{string(self.paper.printing(lang))};]" for lang in self.langs]
        return ["#v(0.6em)", each(self.langs, said)]

    def _said(self, name: str, lang: str) -> str:
        return f"#{string(word(lang, f'paper.{name}'))};"

    def _facts(self) -> str:
        """Code, points and minutes; before an exam also what may lie on the desk."""
        paper, main = self.paper, self.main
        minutes = word(main, "paper.minutes")
        more = f" + {paper.holder.extra} {minutes}" if paper.holder and paper.holder.extra else ""
        count = "question" if len(paper.items) == 1 else "contents"
        total = (
            f"{marks(paper.points, main)}, {paper.minutes} {minutes}{more}, "
            f"{len(paper.items)} {word(main, f'paper.{count}')}"
        )
        rows = [("code", f"raw({string(paper.code)})"), ("total", string(total))]
        if paper.holder:
            known = (("name", paper.holder.name), ("matriculation", paper.holder.id))
            rows = [*((name, string(printable(value))) for name, value in known if value), *rows]
        if self.kind == "exam":
            aids = joined(self.langs, [f"#{string(paper.aids(lang))};" for lang in self.langs])
            rows.append(("aids", f"[{aids}]"))
        named = [f"([{words(self.langs, f'paper.{name}')}], {value})" for name, value in rows]
        return f"#facts({', '.join(named)})"

    def _cited(self) -> list[str]:
        """What the numbers beside steps are."""
        if not self.paper.cited:
            return []
        said = {lang: word(lang, "solution.cited", formula=self.paper.cited) for lang in self.langs}
        return [each(self.langs, [f"#hint[#{string(said[lang])};]" for lang in self.langs])]

    def _overview(self) -> str:
        """Table of questions and marks, with room for the marks given."""
        rows = [
            f"([{item.number}], [{self._titles(item)}], [{amount(item.points, self.main)}])"
            for item in self.paper.items
        ]
        main, many = self.langs[:1], self.langs
        heads = [
            words(langs, f"paper.{name}")
            for name, langs in (("question", many), ("page_of", main), ("points_of", main),
                                ("reached", main))
        ]  # fmt: skip
        total = f"[{amount(self.paper.points, self.main)}]"
        return (
            f"#overview({', '.join(f'[{head}]' for head in heads)}, "
            f"[{words(many, 'paper.sum')}], {total}, ({', '.join(rows)},))"
        )

    def _titles(self, item: Item) -> str:
        return joined(self.langs, [f"#{string(q.title)};" for q in item.questions])

    def _item(self, item: Item) -> str:
        stem = each(self.langs, [blocks(q.stem, q.lang) for q in item.questions])
        if self.kind == "exam":
            picture = self._picture(item.number, [q.figure for q in item.questions])
        else:
            picture = self._picture(item.number, [k.figure for k in item.keys])
        parts = item.questions[0].parts
        shown = [f"#whole[{stem}\n{picture}]"]
        if picture and self.kind == "solutions":
            shown = [f"#below[{stem}]", picture]
        body = [*shown, *(self._part(item, index) for index in range(len(parts)))]
        if self.kind == "solutions":
            body.append(self._remarks(item))
        text = "\n".join(body)
        worth = marks(item.points, self.main)
        return f"#question({string(item.number)}, [{self._titles(item)}], {string(worth)})[{text}]"

    def _board(self, name: str, drawn: list[Field] | list[PartSolution]) -> str:
        """The field of a drawing, empty or solved."""
        figures = [one.drawing.figure for one in drawn if one.drawing]
        return self._picture(name, figures)

    def _picture(self, name: str, figures: list[Any]) -> str:
        if not figures or figures[0] is None:
            return ""
        name = f"figure-{name}.svg"
        self.pictures[name] = figures[0].standalone_svg
        alt = string(" / ".join(figure.alt for figure in figures))
        width = f"{figures[0].width_pt * SCALE[self.kind]:.2f}pt"
        return f"#v(0.4em)\n#image({string(name)}, width: {width}, alt: {alt})\n"

    def _part(self, item: Item, index: int) -> str:
        questions = item.questions
        first = questions[0].parts[index]
        label = f"({first.label}) " if first.label else ""
        worth = f"#worth({string(label + marks(first.points, self.main))})" if label else ""
        texts = [blocks(q.parts[index].body, q.lang) for q in questions]
        body = f"{worth}\n{each(self.langs, texts)}"
        rows = self._options(questions, index)
        if self.kind == "solutions":
            return f"#whole[{body}]\n{rows}\n{self._solution(item, index)}"
        field = self._field(questions, index)
        return f"#part[{body}\n{rows}\n{field}]\n{_left_over(first)}"

    def _field(self, questions: tuple[Question, ...], index: int) -> str:
        """What stands below a part and its options: hints, room to work in, lines to write on."""
        part = questions[0].parts[index]
        control = part.field.control
        fields = [q.parts[index].field for q in questions]
        hints = [inline(f.hint, lang) for f, lang in zip(fields, self.langs, strict=True)]
        if control.form == "truth":
            ways = [f"[{words(self.langs, f'ask.{way}')}]" for way in ("true", "false")]
            return f"#truth({', '.join(ways)})"
        shown = [f"#hint[{each(self.langs, hints)}]"] if any(hints) else []
        if control.form == "pairs":
            return "\n".join(shown)
        if control.board:
            shown.append(self._board(fields[0].id, fields))
        elif control.reckoned:
            shown.append(f"#answer-line([{words(self.langs, 'paper.answer_here')}])")
            shown.append(f"#room({squares(part.points)})")
        else:
            shown.append(f"#space({control.lines})")
        return "\n".join(shown)

    def _options(self, questions: tuple[Question, ...], index: int) -> str:
        """Lettered options and right sides; the first and the last row stand by what is around."""
        fields = [q.parts[index].field for q in questions]
        rows = [*self._rows(fields, "options"), *self._rows(fields, "targets")]
        ends = {0, len(rows) - 1}
        return "\n".join(
            f"#{row}, hold: {str(place in ends).lower()})" for place, row in enumerate(rows)
        )

    def _rows(self, fields: list[Field], side: str) -> list[str]:
        rows = []
        for place, (mark, _) in enumerate(getattr(fields[0], side)):
            texts = [
                inline(getattr(f, side)[place][1], lang)
                for f, lang in zip(fields, self.langs, strict=True)
            ]
            name = self._row(fields[0], side)
            rows.append(f"{name}({string(mark)}, [{joined(self.langs, texts)}]")
        return rows

    def _row(self, field: Field, side: str) -> str:
        """How a row of options looks: with a box to tick, with one for a number, or plain."""
        if self.kind == "exam" and field.control.ticked:
            return "tick"
        paired = field.control.form == "pairs" and side == "options"
        return "pair" if self.kind == "exam" and paired else "option"

    def _solution(self, item: Item, index: int) -> str:
        parts = [key.solution.parts[index] for key in item.keys]
        steps = [self._step([p.lines[i] for p in parts]) for i in range(len(parts[0].lines))]
        answer = joined(self.langs, [self._answer(p, lang) for p, lang in self._with_lang(parts)])
        reasons = [_reasons(part, lang) for part, lang in self._with_lang(parts)]
        drawn = filter(None, [self._board(item.number + parts[0].label, parts)])
        return "\n".join([*steps, *drawn, f"#result[{answer}]", each(self.langs, reasons)])

    def _with_lang(self, parts: list[PartSolution]) -> list[tuple[PartSolution, str]]:
        return list(zip(parts, self.langs, strict=True))

    def _step(self, lines: list[Line]) -> str:
        why = each(
            self.langs,
            [passage(inline(line.why, lang)) for line, lang in zip(lines, self.langs, strict=True)],
        )
        maths, cite = equation(lines[0].maths, self.main, block=True), string(lines[0].formula)
        shown = f"#fitted[{maths}]" if len(lines[0].maths.typed) > SURE_TO_FIT else maths
        return f"#step([{shown}], [{why}], {cite})"

    def _answer(self, part: PartSolution, lang: str) -> str:
        name = word(lang, "solution.answer")
        said = f"#strong({string(name + ':')}); {inline(part.shown, lang)}"
        options = [inline(option, lang) for option in part.options]
        if len(options) == 1:
            between = '#" - ";' if part.shown else ""
            return f"{said}{between}{options[0]}"
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
        return within(lang, f"{_heading(section, lang)}\n{blocks(body, lang)}") if body else ""

    def _mistakes(self, solution: Solution) -> str:
        rows = [
            _mistake(part.label, mistake, solution.lang)
            for part in solution.parts
            for mistake in part.mistakes
        ]
        if not rows:
            return ""
        return within(solution.lang, "\n".join([_heading("mistakes", solution.lang), *rows]))


def _named(paper: Paper) -> str:
    """Whose paper it is, at the foot of every page."""
    known = (paper.holder.name, paper.holder.id) if paper.holder else ()
    return " · ".join(map(printable, filter(None, known)))


def _left_over(part: Part) -> str:
    """What of the page is left goes to calculations, by points; without any it is for notes."""
    return f"#more-room({float(part.points):g})" if part.field.control.reckoned else "#rest"


def _reasons(part: PartSolution, lang: str) -> str:
    """Why the answer of a part is right, and why each other choice is wrong."""
    why = [f"#block(inset: (left: 0.7em))[{passage(inline(part.why, lang))}]"] if part.why else []
    wrong = [_mistake("", reason, lang) for reason in part.reasons]
    return "\n".join([*why, *wrong])


def _mistake(label: str, mistake: Mistake, lang: str) -> str:
    name = string(f"({label}) " if label else "")
    shown, sentence = (passage(inline(one, lang)) for one in (mistake.shown, mistake.sentence))
    return f"#mistake({name}, [{shown}], [{sentence}])"


def _heading(section: str, lang: str) -> str:
    key = "precision.title" if section == "precision" else f"solution.{section}"
    return f"#heading(level: 3)[#{string(word(lang, key))};]"


def source(paper: Paper, kind: str) -> dict[str, bytes]:
    """Typst files of a sheet, and its pictures."""
    sheet = _Sheet(paper, kind)
    return {**document("paper.typ", sheet.source()), **sheet.pictures}


def render(paper: Paper, kind: str) -> bytes:
    """Render a paper as a PDF file.

    Raises
    ------
    RenderError
        If Typst refuses the document or a font is missing.
    """
    return compiled(source(paper, kind))
