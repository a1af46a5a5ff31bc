"""A paper as a tagged PDF (PDF/UA-1), typeset by Typst in this process."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from quizgen.locale import format_amount, format_marks, translate
from quizgen.paper.paper import Paper, PaperItem
from quizgen.question.compose import AnswerField, Question, QuestionPart
from quizgen.question.solution import (
    PartSolution,
    Solution,
    SolutionStep,
    SolvedMisconception,
    scheme_examples,
)
from quizgen.render.layouts import answer_rows
from quizgen.render.typst_document import (
    blocks_to_typst,
    compile_pdf,
    document_files,
    in_language,
    inlines_to_typst,
    join_languages,
    replace_unprintable,
    say_in_language,
    stack_languages,
    translate_all,
    typst_equation,
    typst_literal,
    typst_passage,
)

SCALE = {"exam": 1.0, "solutions": 0.8}
"""Size of figures: smaller where they have been seen before, so that less of a page stays empty."""

SURE_TO_FIT = 80
"""Characters of a typed formula that is no wider than the page: none takes more than 5.5 pt."""


class _TypstPaper:
    """Typst source of one paper or its solutions, and the pictures that it refers to."""

    def __init__(self, paper: Paper, kind: str) -> None:
        self.paper, self.kind, self.langs = paper, kind, paper.langs
        self.main = paper.langs[0]
        self.pictures: dict[str, bytes] = {}

    def source(self) -> str:
        """Return the whole document."""
        cover = self._typeset_cover()
        body = "\n\n".join(self._typeset_question(item) for item in self.paper.items)
        if self.kind == "exam":
            body += "\n#v(1fr)"
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
                [head, *others, "#v(0.6em)", facts, *self._typeset_citation_note(), "#v(0.6em)"]
            )
        unknown = () if self.paper.holder else ("name", "matriculation")
        lines = [f"#write-line([{translate_all(self.langs, f'paper.{name}')}])" for name in unknown]
        rules = stack_languages(
            self.langs, [self._typeset_paper_word("on_paper", lang) for lang in self.langs]
        )
        gap = "#v(1.1em)"
        return "\n".join(
            [
                head,
                *others,
                gap,
                facts,
                *self._typeset_printing_note(),
                gap,
                *(f"{line}\n#v(0.5em)" for line in lines),
                gap,
                f"#notice[{rules}]",
                "#v(0.8em)",
                self._typeset_mark_table(),
                "#pagebreak(weak: true)",
            ]
        )

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
        more = f" + {paper.holder.extra} {minutes}" if paper.holder and paper.holder.extra else ""
        count = "question" if len(paper.items) == 1 else "contents"
        total = (
            f"{format_marks(paper.points, main)}, {paper.minutes} {minutes}{more}, "
            f"{len(paper.items)} {translate(main, f'paper.{count}')}"
        )
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
            aids = join_languages(
                self.langs, [f"#{typst_literal(paper.aids(lang))};" for lang in self.langs]
            )
            rows.append(("aids", f"[{aids}]"))
        named = [
            f"([{translate_all(self.langs, f'paper.{name}')}], {value})" for name, value in rows
        ]
        return f"#facts({', '.join(named)})"

    def _typeset_citation_note(self) -> list[str]:
        """Return a note on what the numbers next to steps refer to; none without such numbers."""
        if not self.paper.cited_formula:
            return []
        said = {
            lang: translate(lang, "solution.cited", formula=self.paper.cited_formula)
            for lang in self.langs
        }
        return [
            stack_languages(
                self.langs, [f"#hint[#{typst_literal(said[lang])};]" for lang in self.langs]
            )
        ]

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
        stem = stack_languages(
            self.langs, [blocks_to_typst(q.stem, q.lang) for q in item.questions]
        )
        if self.kind == "exam":
            picture = self._typeset_picture(item.number, [q.figure for q in item.questions])
        else:
            picture = self._typeset_picture(item.number, [k.figure for k in item.keys])
        parts = item.questions[0].parts
        shown = [f"#whole[{stem}\n{picture}]"]
        if picture and self.kind == "solutions":
            shown = [f"#below[{stem}]", picture]
        body = [*shown, *(self._typeset_part(item, index) for index in range(len(parts)))]
        if self.kind == "solutions":
            body.append(self._typeset_remarks(item))
        text = "\n".join(body)
        worth = format_marks(item.points, self.main)
        return (
            f"#question({typst_literal(item.number)}, "
            f"[{self._join_question_titles(item)}], {typst_literal(worth)})[{text}]"
        )

    def _typeset_drawing_field(
        self, name: str, drawn: list[AnswerField] | list[PartSolution]
    ) -> str:
        """Return the field of a drawing, empty or solved."""
        figures = [one.drawing.figure for one in drawn if one.drawing]
        return self._typeset_picture(name, figures)

    def _typeset_picture(self, name: str, figures: list[Any]) -> str:
        """Return a figure with its description, or "" without one.

        Its file is noted under ``name`` among the pictures of the paper.
        """
        if not figures or figures[0] is None:
            return ""
        name = f"figure-{name}.svg"
        self.pictures[name] = figures[0].standalone_svg
        alt = typst_literal(" / ".join(figure.alt for figure in figures))
        width = f"{figures[0].width_pt * SCALE[self.kind]:.2f}pt"
        return f"#v(0.4em)\n#image({typst_literal(name)}, width: {width}, alt: {alt})\n"

    def _typeset_part(self, item: PaperItem, index: int) -> str:
        """Return one part of a question, as it is asked or solved."""
        questions = item.questions
        first = questions[0].parts[index]
        label = f"({first.label}) " if first.label else ""
        worth = (
            f"#worth({typst_literal(label + format_marks(first.points, self.main))})"
            if label
            else ""
        )
        texts = [blocks_to_typst(q.parts[index].body, q.lang) for q in questions]
        body = f"{worth}\n{stack_languages(self.langs, texts)}"
        if first.field.near is not None and self.kind == "exam":
            text = stack_languages(self.langs, texts)
            return self._typeset_placed_part(questions, index, text, worth)
        rows = self._typeset_options(questions, index)
        if self.kind == "solutions":
            return f"#whole[{body}]\n{rows}\n{self._typeset_part_solution(item, index)}"
        field = self._typeset_answer_space(questions, index)
        return f"#part[{body}\n{rows}\n{field}]\n{_typeset_notes_area(first)}"

    def _typeset_placed_part(
        self, questions: tuple[Question, ...], index: int, text: str, worth: str
    ) -> str:
        """Return a part whose field stands in a text: one line below it, with points and hints.

        The last of those in one text has room to work in.
        """
        parts = questions[0].parts
        is_typed = parts[index].field.control.form not in {"one", "truth"}
        hints = [inlines_to_typst(q.parts[index].field.hint, q.lang) for q in questions]
        said = f"#hint[{join_languages(self.langs, hints)}]" if is_typed else ""
        body = "\n\n".join(filter(None, [text, f"{worth} #h(0.6em); {said}"]))
        if any(part.shared for part in parts[index + 1 : index + 2]):
            return f"#part[{body}]"
        begin = max(place for place in range(index + 1) if not parts[place].shared)
        group = parts[begin : index + 1]
        if not any(part.field.control.needs_working for part in group):
            return f"#part[{body}]\n#rest"
        points = sum((part.points for part in group), Fraction(0))
        room = f"#room({answer_rows(points)})"
        return f"#part[{body}\n{room}]\n#more-room({float(points):g})"

    def _typeset_hints(self, fields: list[AnswerField]) -> str:
        """Return how the answer of a part is typed, in all languages; "" if nothing is said."""
        hints = [inlines_to_typst(f.hint, lang) for f, lang in zip(fields, self.langs, strict=True)]
        return f"#hint[{stack_languages(self.langs, hints)}]" if any(hints) else ""

    def _typeset_answer_space(self, questions: tuple[Question, ...], index: int) -> str:
        """Return what stands below a part and its options: hints, room to work in, answer lines."""
        part = questions[0].parts[index]
        control = part.field.control
        fields = [q.parts[index].field for q in questions]
        hints = self._typeset_hints(fields)
        if control.form == "truth":
            ways = [f"[{translate_all(self.langs, f'ask.{way}')}]" for way in ("true", "false")]
            return f"#truth({', '.join(ways)})"
        shown = [hints] if hints else []
        if control.form == "pairs":
            return "\n".join(shown)
        if control.board:
            shown.append(self._typeset_drawing_field(fields[0].id, fields))
        elif control.needs_working:
            shown.append(f"#answer-line([{translate_all(self.langs, 'paper.answer_here')}])")
            shown.append(f"#room({answer_rows(part.points)})")
        else:
            shown.append(f"#space({control.lines})")
        return "\n".join(shown)

    def _typeset_options(self, questions: tuple[Question, ...], index: int) -> str:
        """Return lettered options and right sides of a part, kept with the text around them."""
        fields = [q.parts[index].field for q in questions]
        rows = [
            *self._typeset_option_rows(fields, "options"),
            *self._typeset_option_rows(fields, "targets"),
        ]
        ends = {0, len(rows) - 1}
        return "\n".join(
            f"#{row}, hold: {str(place in ends).lower()})" for place, row in enumerate(rows)
        )

    def _typeset_option_rows(self, fields: list[AnswerField], side: str) -> list[str]:
        """Return the rows of options of one side, in all languages."""
        rows = []
        for place, (mark, _) in enumerate(getattr(fields[0], side)):
            texts = [
                inlines_to_typst(getattr(f, side)[place][1], lang)
                for f, lang in zip(fields, self.langs, strict=True)
            ]
            name = self._choose_option_style(fields[0], side)
            rows.append(f"{name}({typst_literal(mark)}, [{join_languages(self.langs, texts)}]")
        return rows

    def _choose_option_style(self, field: AnswerField, side: str) -> str:
        """Return how a row of options looks: with a box to tick, a box for a number, or plain."""
        if self.kind == "exam" and field.control.is_ticked:
            return "tick"
        paired = field.control.form == "pairs" and side == "options"
        return "pair" if self.kind == "exam" and paired else "option"

    def _typeset_part_solution(self, item: PaperItem, index: int) -> str:
        """Return answer, steps and reasons of one part."""
        parts = [key.solution.parts[index] for key in item.keys]
        steps = [
            self._typeset_step([p.lines[i] for p in parts]) for i in range(len(parts[0].lines))
        ]
        answer = join_languages(
            self.langs, [self._typeset_answer(p, lang) for p, lang in self._with_lang(parts)]
        )
        schemes = [_typeset_scheme(part, lang) for part, lang in self._with_lang(parts)]
        reasons = [_typeset_reasons(part, lang) for part, lang in self._with_lang(parts)]
        drawn = filter(None, [self._typeset_drawing_field(item.number + parts[0].label, parts)])
        return "\n".join(
            [
                *steps,
                *drawn,
                f"#result[{answer}]",
                stack_languages(self.langs, schemes),
                stack_languages(self.langs, reasons),
            ]
        )

    def _with_lang(self, parts: list[PartSolution]) -> list[tuple[PartSolution, str]]:
        """Return each solution with the language that it is written in."""
        return list(zip(parts, self.langs, strict=True))

    def _typeset_step(self, lines: list[SolutionStep]) -> str:
        """Return one worked line: its formula once, its sentence in each language."""
        why = stack_languages(
            self.langs,
            [
                typst_passage(inlines_to_typst(line.why, lang))
                for line, lang in zip(lines, self.langs, strict=True)
            ],
        )
        maths, cite = (
            typst_equation(lines[0].maths, self.main, block=True),
            typst_literal(lines[0].formula),
        )
        shown = f"#fitted[{maths}]" if len(lines[0].maths.typed_text) > SURE_TO_FIT else maths
        return f"#step([{shown}], [{why}], {cite})"

    def _typeset_answer(self, part: PartSolution, lang: str) -> str:
        """Return the answer of a part in a language."""
        name = translate(lang, "solution.answer")
        said = f"#strong({typst_literal(name + ':')}); {inlines_to_typst(part.shown, lang)}"
        ideas = () if part.scheme else part.options
        options = [inlines_to_typst(one, lang) for one in ideas]
        if len(options) == 1:
            between = '#" - ";' if part.shown else ""
            return f"{said}{between}{options[0]}"
        return f"{said}#list({', '.join(f'[{o}]' for o in options)});" if options else said

    def _typeset_remarks(self, item: PaperItem) -> str:
        """Return what follows the parts: explanation, sanity check, common mistakes, remark."""
        solutions = [key.solution for key in item.keys]
        texts = [
            self._typeset_mistakes(s) if section == "mistakes" else self._typeset_remark(s, section)
            for section in ("why", "check", "precision", "mistakes", "note")
            for s in solutions
        ]
        return "\n" + "\n".join(filter(None, texts))

    def _typeset_remark(self, solution: Solution, section: str) -> str:
        """Return one section of a solution with its heading; "" if it is empty."""
        body, lang = getattr(solution, section), solution.lang
        return (
            in_language(lang, f"{_typeset_heading(section, lang)}\n{blocks_to_typst(body, lang)}")
            if body
            else ""
        )

    def _typeset_mistakes(self, solution: Solution) -> str:
        """Return the known misconceptions of a question, each with its sentence."""
        rows = [
            _typeset_mistake(part.label, mistake, solution.lang)
            for part in solution.parts
            for mistake in part.mistakes
        ]
        if not rows:
            return ""
        return in_language(
            solution.lang, "\n".join([_typeset_heading("mistakes", solution.lang), *rows])
        )


def _format_holder(paper: Paper) -> str:
    """Return whose paper it is, for the foot of every page."""
    known = (paper.holder.name, paper.holder.id) if paper.holder else ()
    return " · ".join(map(replace_unprintable, filter(None, known)))


def _typeset_notes_area(part: QuestionPart) -> str:
    """Return Typst for the rest of the page: squares for calculations by points, or notes."""
    return f"#more-room({float(part.points):g})" if part.field.control.needs_working else "#rest"


def _typeset_scheme(part: PartSolution, lang: str) -> str:
    """Return what a person marks sentences by: a row for each criterion, its points in front."""
    rows = []
    for row in part.scheme:
        lines = [typst_passage(inlines_to_typst(row.idea, lang))]
        for name, examples in scheme_examples(row):
            head = typst_literal(f"{translate(lang, f'solution.{name}')}: ")
            lines.append(f"#emph({head})#{typst_literal('; '.join(examples))}")
        if row.follows:
            lines.append(f"#{typst_literal(translate(lang, 'solution.follows'))}")
        points = typst_literal(format_amount(row.points, lang))
        rows.append(f"[#{points}], [{' #linebreak() '.join(lines)}]")
    if not rows:
        return ""
    title = typst_literal(translate(lang, "solution.scheme"))
    return f"#mark-scheme({title}, {', '.join(rows)})"


def _typeset_reasons(part: PartSolution, lang: str) -> str:
    """Return why the answer of a part is right, and why each other choice is wrong."""
    why = (
        [f"#block(inset: (left: 0.7em))[{typst_passage(inlines_to_typst(part.why, lang))}]"]
        if part.why
        else []
    )
    wrong = [_typeset_mistake("", reason, lang) for reason in part.reasons]
    return "\n".join([*why, *wrong])


def _typeset_mistake(label: str, mistake: SolvedMisconception, lang: str) -> str:
    """Return one misconception: the wrong answer with its label, and what is wrong with it."""
    name = typst_literal(f"({label}) " if label else "")
    shown, sentence = (
        typst_passage(inlines_to_typst(one, lang)) for one in (mistake.shown, mistake.sentence)
    )
    return f"#mistake({name}, [{shown}], [{sentence}])"


def _typeset_heading(section: str, lang: str) -> str:
    """Return the heading of a section of the solution in a language."""
    key = "precision.title" if section == "precision" else f"solution.{section}"
    return f"#heading(level: 3)[#{typst_literal(translate(lang, key))};]"


def typst_sources(paper: Paper, kind: str) -> dict[str, bytes]:
    """Return the Typst files of a paper and its pictures, by file name."""
    sheet = _TypstPaper(paper, kind)
    return {**document_files("paper.typ", sheet.source()), **sheet.pictures}


def render_paper_pdf(paper: Paper, kind: str) -> bytes:
    """Return a paper as a PDF file.

    Raises
    ------
    RenderError
        If Typst refuses the document or a font is missing.
    """
    return compile_pdf(typst_sources(paper, kind))
