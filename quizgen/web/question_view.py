"""A question ready to be shown: its pieces as HTML, and the key that stays on the server.

Made in a worker process; plain structs, so that they travel as bytes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.levels import EXAM, GUIDED
from quizgen.core.errors import BlueprintError
from quizgen.figures import FieldPicture
from quizgen.grading.spec import AnySpec
from quizgen.kinds import point
from quizgen.kinds.contract import InputControl
from quizgen.kinds.derivation import DerivationSpec
from quizgen.kinds.equation import EquationSpec
from quizgen.kinds.expression import ExpressionSpec
from quizgen.locale import BOTH
from quizgen.paper.answer_key import KeyQuestion, make_key_question
from quizgen.paper.blueprint import find_blueprint
from quizgen.paper.paper import Paper, PaperItem, build_paper, rebuild_paper
from quizgen.paper.provenance import record_banks
from quizgen.question.compose import (
    Question,
    QuestionKey,
    QuestionPart,
    compose_variant,
    draw_instance,
)
from quizgen.question.figure import draw_marked_figure
from quizgen.question.formula_sheet import cite_formula
from quizgen.question.html import blocks_to_html, chain_to_html, inlines_to_html
from quizgen.question.interpolation import inlines_to_text
from quizgen.question.levels import effective_level
from quizgen.question.solution import (
    PartSolution,
    SolutionHint,
    SolvedMisconception,
    scheme_examples,
    scheme_title,
)
from quizgen.typeset.prose import Block, Inline, name_inline
from quizgen.web.moving import MovingView, find_moving_figure

_MATHS = re.compile("</?math[^>]*>")
_NUMBERED = re.compile(
    r"\(([1-9])\) (?:<span[^>]*>)?(<math[^>]*>.*?</math>|[^,;:?.(<_]{1,24}(?=[,?]))"
)
"""The number of what is asked, and its sign or few words."""

GAP = "____"
"""Where a word is missing in a sentence."""

Html = str
"""Markup made here; whatever a learner typed never gets into it."""


class FieldView(msgspec.Struct, frozen=True):
    """The input field of a part."""

    id: str
    control: InputControl
    names: list[Html]
    """Names of the boxes, typeset; empty where they have none."""
    options: list[tuple[str, Html]]
    targets: list[tuple[str, Html]]
    words: list[str]
    """The targets in plain text, for lists that hold no markup; options of a field in a text."""
    hint: Html
    board: Html
    """The field that is drawn in, if the answer is a drawing."""
    near: str | None = None
    """The words around the field, if it stands inside a sentence or a cell."""
    formula_names: list[tuple[str, Html]] | None = None
    """Names that a formula may hold, as they are typed and typeset; None if no formula is asked."""
    sentences: Html = ""
    """The text of the part, if each of its gaps takes one of the boxes."""

    @property
    def marks(self) -> list[str]:
        """Return the letters of the options."""
        return [mark for mark, _ in self.options]


class HintView(msgspec.Struct, frozen=True):
    """A hint, and the formula of the sheet that it cites."""

    kind: str
    shown: Html
    why: Html
    formula: str
    sheet: Html


class StepView(msgspec.Struct, frozen=True):
    """A step of the worked solution."""

    maths: Html
    why: Html
    formula: str
    hints: list[HintView] = []


class SchemeView(msgspec.Struct, frozen=True):
    """A criterion that an own sentence is marked by, as HTML."""

    name: str
    points: float
    idea: Html
    examples: list[tuple[str, list[str]]]
    """What stands before a list of examples (a key of ``solution``), and the examples."""
    follows: bool
    halves: bool


class PartView(msgspec.Struct, frozen=True):
    """A part with its worked solution, as HTML."""

    label: str
    points: float
    body: Html
    field: FieldView
    lines: list[StepView]
    answer: Html
    board: Html
    """What was to be drawn, in its field."""
    right: list[Html]
    why: Html
    reasons: list[tuple[Html, Html]]
    mistakes: list[tuple[Html, Html]]
    scheme: list[SchemeView]
    scheme_title: str

    @property
    def criteria(self) -> frozenset[str]:
        """Return the names of the criteria that an own sentence is marked by."""
        return frozenset(row.name for row in self.scheme)


class QuestionRequest(msgspec.Struct, frozen=True):
    """Identifies a rendered question: equal requests give equal pages."""

    template: str
    seed: str
    lang: str
    number: str = "1"
    level: str = EXAM


class QuestionView(msgspec.Struct, frozen=True):
    """A question in one language, as HTML, with the key that grades it."""

    wanted: QuestionRequest
    title: str
    topic: str
    tier: str
    stem: Html
    figure: Html
    solved_figure: Html
    parts: list[PartView]
    check: Html
    note: Html
    why: Html
    key: KeyQuestion
    guided: bool
    """Whether its steps can be asked one after another instead."""
    bank: str = ""
    """The bank that it stands in, with version and digest, where that is said of each question."""
    moving: MovingView | None = None
    """The figure that moves: to be shown once no part of the question is open."""


class PaperView(msgspec.Struct, frozen=True):
    """A paper in one language, as HTML."""

    code: str
    title: str
    points: float
    minutes: int
    pauses: bool | None
    """Whether its blueprint allows pauses; None where the student chooses."""
    banks: list[str]
    """The banks that its questions stand in, with version and digest."""
    items: list[QuestionView]


class WorkerJob(Protocol):
    """Anything else that a worker makes; equal jobs give equal bytes."""

    def run(self, bank: Bank) -> bytes:
        """Return the job's bytes."""
        ...

    def __hash__(self) -> int: ...


@dataclass(frozen=True)
class MarkedFigureJob:
    """Draws the figure of a question with a learner's values in it; empty if it shows none.

    Parameters
    ----------
    wanted : QuestionRequest
    values : tuple of (str, (float, float))
        Quantity, what the learner gave, and how many base units its unit has.
    quiz : bool
        Whether what is asked for stays hidden.
    """

    wanted: QuestionRequest
    values: tuple[tuple[str, tuple[float, float]], ...]
    quiz: bool

    def run(self, bank: Bank) -> bytes:
        """Return the figure as SVG for a page."""
        drawn = draw_instance(bank.template(self.wanted.template), self.wanted.seed)
        given = dict(self.values)
        figure = draw_marked_figure(drawn, self.wanted.lang, given, quiz=self.quiz)
        return figure.inline_svg if figure else b""


def run_request(bank: Bank, wanted: QuestionRequest | WorkerJob) -> bytes:
    """Return a rendered question as JSON, or the bytes of another job.

    Parameters
    ----------
    bank : Bank
    wanted : QuestionRequest or WorkerJob

    Raises
    ------
    QuizgenError
        If a template is wrong, or there is no such paper.
    """
    if not isinstance(wanted, QuestionRequest):
        return wanted.run(bank)
    drawn = draw_instance(bank.template(wanted.template), wanted.seed)
    question, key = compose_variant(drawn, wanted.lang, number=wanted.number, level=wanted.level)
    return msgspec.json.encode(question_view(wanted, question, key, bank))


_HELD: list[Bank] = []  # the bank of a worker process, whose files it reads once


def prepare_process(bank: Bank) -> None:
    """Store the bank for every job of this process, and load what the first one needs."""
    import numpy  # noqa: F401, ICN001

    _HELD[:] = [bank]


def make_from_held_bank(wanted: QuestionRequest | WorkerJob) -> bytes:
    """Return ``run_request`` with the bank that this process was prepared with."""
    return run_request(_HELD[0], wanted)


def make_papers(bank: Bank, code: str, blueprint: str, seed: int) -> dict[str, PaperView]:
    """Return a paper in each of its languages, by its code, or by blueprint and seed.

    Raises
    ------
    QuizgenError
        If there is no such paper, or a template is wrong.
    """
    if code:
        paper = rebuild_paper(bank, code)
    else:
        plan = find_blueprint(blueprint, bank)
        if plan is None:
            raise BlueprintError(f"no blueprint {blueprint!r}")
        paper = build_paper(bank, plan, seed, BOTH)
    return paper_views(paper)


def paper_views(paper: Paper) -> dict[str, PaperView]:
    """Return a paper as HTML in each of its languages."""
    return {lang: _build_paper(paper, place) for place, lang in enumerate(paper.langs)}


def _build_paper(paper: Paper, place: int) -> PaperView:
    """Return a paper in its language at an index, as HTML."""
    lang = paper.langs[place]
    items = [
        question_view(
            QuestionRequest(item.questions[place].template, "", lang, number=item.number),
            item.questions[place],
            item.keys[place],
        )
        for item in paper.items
    ]
    return PaperView(
        paper.code,
        paper.title(lang),
        float(paper.points),
        paper.minutes,
        paper.blueprint.pauses,
        [str(one) for one in paper.banks],
        items,
    )


def question_view(
    wanted: QuestionRequest, question: Question, key: QuestionKey, bank: Bank | None = None
) -> QuestionView:
    """Return a composed question as HTML; with a bank, hints cite its formula sheet."""
    # No exam is asked step by step, and to find out whether it could takes a while.
    steps = (
        bank is not None and wanted.level != GUIDED and effective_level(key.draw, GUIDED) == GUIDED
    )
    lang, solution = question.lang, key.solution
    stem = _render_blocks(question.stem, lang)
    figure, solved = question.figure, key.figure
    other = solved if solved and (figure is None or solved != figure) else None
    return QuestionView(
        wanted,
        question.title,
        question.topic,
        question.tier,
        stem=stem,
        figure=figure.inline_svg.decode() if figure else "",
        solved_figure=other.inline_svg.decode() if other else "",
        parts=[
            _render_part(part, solved_part, _render_field(part, spec, stem, lang), lang, bank)
            for part, solved_part, spec in zip(
                question.parts, solution.parts, key.specs, strict=True
            )
        ],
        check=_render_blocks(solution.check, lang),
        note=_render_blocks(solution.note, lang),
        why=_render_blocks(solution.why, lang),
        key=make_key_question(PaperItem(wanted.number, (question,), (key,))),
        guided=steps,
        bank=str(*record_banks(bank, [wanted.template])) if bank else "",
        moving=find_moving_figure(bank, wanted.template, key.draw, lang) if bank else None,
    )


def _render_hint(rung: SolutionHint, bank: Bank, lang: str) -> HintView:
    """Return a hint as HTML, with the formula that it cites."""
    return HintView(
        rung.kind,
        _render_inline(rung.shown, lang),
        _render_inline(rung.why, lang),
        rung.formula,
        _render_inline(cite_formula(bank, rung.formula, lang), lang),
    )


def _render_box_names(part: QuestionPart, spec: AnySpec, stem: Html, lang: str) -> list[Html]:
    """Return the typeset names of a part's boxes.

    Quantities name boxes only where the question mentions all of them: else a name would reveal
    what is asked.
    """
    boxes = part.field.control.boxes
    if any(box.name for box in boxes):
        return [_render_inline((name_inline(box.name),), lang) for box in boxes]
    of = spec.of if isinstance(spec, point.PointSpec) and isinstance(spec.of, list) else []
    names = [_render_inline((name_inline(name),), lang) for name in of]
    asked = stem + _render_blocks(part.body, lang)
    if _are_said(names, asked) and len(names) == len(boxes):
        return names
    return _find_numbered(asked, len(boxes)) or [""] * len(boxes)


def _are_said(names: Iterable[Html], asked: Html) -> bool:
    """Return whether a question mentions all of some typeset names."""
    return all(_MATHS.sub("", name) in asked for name in names)


def _list_formula_names(
    part: QuestionPart, spec: AnySpec, stem: Html, lang: str
) -> list[tuple[str, Html]] | None:
    """Return the names of a formula, if the question says them; None if no formula is asked."""
    if not isinstance(spec, ExpressionSpec | EquationSpec | DerivationSpec):
        return None
    names = [(name, _render_inline((name_inline(name),), lang)) for name in spec.symbols]
    asked = stem + _render_blocks(part.body, lang)
    given = isinstance(spec, DerivationSpec) or _are_said((shown for _, shown in names), asked)
    return names if given else []


def _find_numbered(asked: Html, count: int) -> list[Html]:
    """Return what a sentence such as "(1) V, (2) S, (3) H" asks of each box; empty if not all."""
    found = _NUMBERED.findall(asked)
    in_order = [number for number, _ in found] == [str(place) for place in range(1, count + 1)]
    return [f"({number}) {name}" for number, name in found] if in_order else []


def _render_part(
    part: QuestionPart, solved: PartSolution, field: FieldView, lang: str, bank: Bank | None
) -> PartView:
    """Return a part and its solution as HTML."""
    return PartView(
        part.label,
        float(part.points),
        _render_blocks(part.body, lang),
        field,
        [
            StepView(
                str(chain_to_html(line.maths, lang)),
                _render_inline(line.why, lang),
                line.formula,
                [_render_hint(rung, bank, lang) for rung in line.hints] if bank else [],
            )
            for line in solved.lines
        ],
        _render_inline(solved.shown, lang),
        _render_board(solved.drawing),
        [_render_inline(option, lang) for option in solved.options],
        _render_inline(solved.why, lang),
        _render_mistakes(solved.reasons, lang),
        _render_mistakes(solved.mistakes, lang),
        [
            SchemeView(
                row.name,
                float(row.points),
                _render_inline(row.idea, lang),
                [(name, [*examples]) for name, examples in scheme_examples(row)],
                row.follows,
                row.halves,
            )
            for row in solved.scheme
        ],
        scheme_title(solved, lang),
    )


def _render_field(part: QuestionPart, spec: AnySpec, stem: Html, lang: str) -> FieldView:
    """Return the input field of a part, with its options as HTML."""
    field = part.field
    return FieldView(
        field.id,
        field.control,
        _render_box_names(part, spec, stem, lang),
        [(mark, _render_inline(text, lang)) for mark, text in field.options],
        [(mark, _render_inline(text, lang)) for mark, text in field.targets],
        [
            inlines_to_text(text)
            for _, text in (field.targets if field.near is None else field.options)
        ],
        _render_inline(field.hint_in_fields, lang),
        _render_board(field.drawing),
        field.near,
        _list_formula_names(part, spec, stem, lang),
        _find_sentences(part, lang),
    )


def _find_sentences(part: QuestionPart, lang: str) -> Html:
    """Return the text of a part if it has a gap for each of several boxes; else an empty one."""
    body, boxes = _render_blocks(part.body, lang), part.field.control.boxes
    is_gapped = part.field.control.form == "gaps" and body.count(GAP) == len(boxes) > 1
    return body if is_gapped else ""


def _render_board(drawing: FieldPicture | None) -> Html:
    """Return the SVG to draw on; empty if there is none."""
    return drawing.figure.inline_svg.decode() if drawing else ""


def _render_mistakes(mistakes: Iterable[SolvedMisconception], lang: str) -> list[tuple[Html, Html]]:
    """Return the shown value and the sentence of each misconception as HTML."""
    return [
        (_render_inline(one.shown, lang), _render_inline(one.listed_sentence, lang))
        for one in mistakes
    ]


def _render_blocks(parts: tuple[Block, ...], lang: str) -> Html:
    """Return blocks as HTML."""
    return str(blocks_to_html(parts, lang))


def _render_inline(parts: tuple[Inline, ...], lang: str) -> Html:
    """Return a sentence as HTML."""
    return str(inlines_to_html(parts, lang))
