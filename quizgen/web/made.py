"""A question ready to be shown: its pieces as HTML, and the key that stays on the server.

Made in a worker process; plain structs, so that they travel as bytes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Protocol

import msgspec

from quizgen.bank.folder import Bank
from quizgen.bank.levels import EXAM, GUIDED
from quizgen.bank.prose import Block, Inline
from quizgen.errors import BlueprintError
from quizgen.figures import FieldPicture
from quizgen.locale import BOTH
from quizgen.marking.kinds import point
from quizgen.marking.specs import AnySpec
from quizgen.paper.banks import used_banks
from quizgen.paper.blueprint import named_blueprint
from quizgen.paper.key import KeyQuestion, key_question
from quizgen.paper.paper import Item, build, rebuild
from quizgen.question.compose import Field, Key, Part, Question, instance, put_into_words
from quizgen.question.contract import Control
from quizgen.question.filling import plain
from quizgen.question.levels import level_of
from quizgen.question.markup import blocks, display, inline
from quizgen.question.sheet import cited
from quizgen.question.shown import named
from quizgen.question.solution import Mistake, PartSolution, Rung

_MATHS = re.compile("</?math[^>]*>")

Html = str
"""Markup made here; whatever a learner typed never gets into it."""


class MadeField(msgspec.Struct, frozen=True):
    """Where the answer of a part goes."""

    id: str
    control: Control
    names: list[Html]
    """Names of the boxes, typeset; empty where they have none."""
    options: list[tuple[str, Html]]
    targets: list[tuple[str, Html]]
    words: list[str]
    """The targets in plain text, for lists that hold no markup."""
    hint: Html
    board: Html
    """The field that is drawn in, if the answer is a drawing."""

    @property
    def marks(self) -> list[str]:
        """Marks of the options."""
        return [mark for mark, _ in self.options]


class MadeRung(msgspec.Struct, frozen=True):
    """A hint, and the line of the formula sheet that it stands on."""

    kind: str
    shown: Html
    why: Html
    formula: str
    sheet: Html


class MadeLine(msgspec.Struct, frozen=True):
    """A step of the worked solution."""

    maths: Html
    why: Html
    formula: str
    rungs: list[MadeRung] = []


class MadePart(msgspec.Struct, frozen=True):
    """A part and its worked solution."""

    label: str
    points: float
    body: Html
    field: MadeField
    lines: list[MadeLine]
    answer: Html
    board: Html
    """What was to be drawn, in its field."""
    right: list[Html]
    why: Html
    reasons: list[tuple[Html, Html]]
    mistakes: list[tuple[Html, Html]]


class Wanted(msgspec.Struct, frozen=True):
    """Which question: the same one gives the same page."""

    template: str
    seed: str
    lang: str
    number: str = "1"
    level: str = EXAM


class WantedPaper(msgspec.Struct, frozen=True):
    """Which paper: by its code, or anew from a blueprint and a seed; in one of its languages."""

    lang: str
    code: str = ""
    blueprint: str = ""
    seed: int = 0


class Made(msgspec.Struct, frozen=True):
    """A question in one language."""

    wanted: Wanted
    title: str
    topic: str
    tier: str
    stem: Html
    figure: Html
    solved_figure: Html
    parts: list[MadePart]
    check: Html
    note: Html
    why: Html
    key: KeyQuestion
    guided: bool
    """Whether its steps can be asked one after another instead."""
    bank: str = ""
    """The bank that it stands in, with version and digest, where that is said of each question."""


class MadePaper(msgspec.Struct, frozen=True):
    """A paper in one language."""

    code: str
    title: str
    points: float
    minutes: int
    pauses: bool | None
    """Whether its blueprint allows pauses; None where whoever sits it chooses."""
    banks: list[str]
    """The banks that its questions stand in, with version and digest."""
    items: list[Made]


class Job(Protocol):
    """Something else that a worker makes; equal jobs give equal bytes."""

    def run(self, bank: Bank) -> bytes:
        """Make it."""
        ...

    def __hash__(self) -> int: ...


def make(bank: Bank, wanted: Wanted | WantedPaper | Job) -> bytes:
    """Compose a question or a paper and put it into markup, or do another job.

    Parameters
    ----------
    bank : Bank
    wanted : Wanted or WantedPaper or Job

    Raises
    ------
    QuizgenError
        If a template is wrong, or there is no such paper.
    """
    if not isinstance(wanted, Wanted | WantedPaper):
        return wanted.run(bank)
    if isinstance(wanted, WantedPaper):
        return msgspec.json.encode(_paper(bank, wanted))
    drawn = instance(bank.template(wanted.template), wanted.seed)
    question, key = put_into_words(drawn, wanted.lang, number=wanted.number, level=wanted.level)
    return msgspec.json.encode(made(wanted, question, key, bank))


def _paper(bank: Bank, wanted: WantedPaper) -> MadePaper:
    """A paper in all languages of the bank, so that its code is the same in each."""
    if wanted.code:
        paper = rebuild(bank, wanted.code)
    else:
        plan = named_blueprint(wanted.blueprint, bank)
        if plan is None:
            raise BlueprintError(f"no blueprint {wanted.blueprint!r}")
        paper = build(bank, plan, wanted.seed, BOTH)
    place = paper.langs.index(wanted.lang) if wanted.lang in paper.langs else 0
    lang = paper.langs[place]
    items = [
        made(
            Wanted(item.questions[place].template, "", lang, number=item.number),
            item.questions[place],
            item.keys[place],
        )
        for item in paper.items
    ]
    return MadePaper(
        paper.code,
        paper.title(lang),
        float(paper.points),
        paper.minutes,
        paper.blueprint.pauses,
        [str(one) for one in paper.banks],
        items,
    )


def made(wanted: Wanted, question: Question, key: Key, bank: Bank | None = None) -> Made:
    """A composed question as markup; with hints and its bank, if it is said which that is."""
    steps = wanted.level != GUIDED and level_of(key.draw, GUIDED) == GUIDED
    lang, solution = question.lang, key.solution
    stem = _blocks(question.stem, lang)
    figure, solved = question.figure, key.figure
    other = solved if solved and (figure is None or solved != figure) else None
    return Made(
        wanted,
        question.title,
        question.topic,
        question.tier,
        stem=stem,
        figure=figure.inline_svg.decode() if figure else "",
        solved_figure=other.inline_svg.decode() if other else "",
        parts=[
            _part(part, solved_part, _names(part, spec, stem, lang), lang, bank)
            for part, solved_part, spec in zip(
                question.parts, solution.parts, key.specs, strict=True
            )
        ],
        check=_blocks(solution.check, lang),
        note=_blocks(solution.note, lang),
        why=_blocks(solution.why, lang),
        key=key_question(Item(wanted.number, (question,), (key,))),
        guided=steps,
        bank=str(*used_banks(bank, [wanted.template])) if bank else "",
    )


def _rung(rung: Rung, bank: Bank, lang: str) -> MadeRung:
    return MadeRung(
        rung.kind,
        _inline(rung.shown, lang),
        _inline(rung.why, lang),
        rung.formula,
        _inline(cited(bank, rung.formula, lang), lang),
    )


def _names(part: Part, spec: AnySpec, stem: Html, lang: str) -> list[Html]:
    """Names of the boxes, typeset: their own, or those of the quantities, where all are said."""
    boxes = part.field.control.boxes
    if any(box.name for box in boxes):
        return [_inline((named(box.name),), lang) for box in boxes]
    of = spec.of if isinstance(spec, point.Spec) and isinstance(spec.of, list) else []
    names = [_inline((named(name),), lang) for name in of]
    asked = stem + _blocks(part.body, lang)
    said = all(_MATHS.sub("", name) in asked for name in names)
    return names if said and len(names) == len(boxes) else [""] * len(boxes)


def _part(
    part: Part, solved: PartSolution, names: list[Html], lang: str, bank: Bank | None
) -> MadePart:
    return MadePart(
        part.label,
        float(part.points),
        _blocks(part.body, lang),
        _field(part.field, names, lang),
        [
            MadeLine(
                str(display(line.maths, lang)),
                _inline(line.why, lang),
                line.formula,
                [_rung(rung, bank, lang) for rung in line.rungs] if bank else [],
            )
            for line in solved.lines
        ],
        _inline(solved.shown, lang),
        _board(solved.drawing),
        [_inline(option, lang) for option in solved.options],
        _inline(solved.why, lang),
        _pairs(solved.reasons, lang),
        _pairs(solved.mistakes, lang),
    )


def _field(field: Field, names: list[Html], lang: str) -> MadeField:
    return MadeField(
        field.id,
        field.control,
        names,
        [(mark, _inline(text, lang)) for mark, text in field.options],
        [(mark, _inline(text, lang)) for mark, text in field.targets],
        [plain(text) for _, text in field.targets],
        _inline(field.hint_in_fields, lang),
        _board(field.drawing),
    )


def _board(drawing: FieldPicture | None) -> Html:
    return drawing.figure.inline_svg.decode() if drawing else ""


def _pairs(mistakes: Iterable[Mistake], lang: str) -> list[tuple[Html, Html]]:
    return [(_inline(one.shown, lang), _inline(one.sentence, lang)) for one in mistakes]


def _blocks(parts: tuple[Block, ...], lang: str) -> Html:
    return str(blocks(parts, lang))


def _inline(parts: tuple[Inline, ...], lang: str) -> Html:
    return str(inline(parts, lang))
