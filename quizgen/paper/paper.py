"""From a blueprint and a seed to a paper, and from a paper's code back to the same paper."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from itertools import islice
from typing import NamedTuple

import msgspec
from msgspec.structs import replace

from quizgen.bank.bank import Bank
from quizgen.bank.levels import EXAM
from quizgen.bank.metadata import pick_language
from quizgen.bank.template import Template
from quizgen.bank.variant import Variant
from quizgen.core.errors import BlueprintError, PaperCodeError
from quizgen.core.shares import rescale_points
from quizgen.core.untrusted import error_context
from quizgen.locale import localise_numbers, translate
from quizgen.maths.notation import pretty
from quizgen.paper.blueprint import Blueprint, SlotRule, find_blueprint
from quizgen.paper.code import (
    REFERENCE,
    PaperCode,
    check_seed,
    content_digest,
    parse_code,
    source_digest,
)
from quizgen.paper.constraints import paper_minutes
from quizgen.paper.provenance import BankRecord, record_banks
from quizgen.paper.selection import count_papers, select_templates, slot_levels, slot_points
from quizgen.paper.variants import draw_variants, with_siblings
from quizgen.question.compose import Question, QuestionKey, compose_variant, draw_instance
from quizgen.question.data_files import iter_data_files
from quizgen.question.interpolation import PlacedPicture
from quizgen.question.levels import effective_level
from quizgen.question.mark_scheme import rescale_criteria
from quizgen.typeset.prose import Block, CodeBlock, Paragraph

ProgressCallback = Callable[[str], None]
"""Told the template of each question as it is done."""


def silent(_name: str) -> None:
    """Ignore progress: the callback for whoever watches none."""


class PaperItem(msgspec.Struct, frozen=True):
    """One question of a paper in every language of the paper."""

    number: str
    questions: tuple[Question, ...]
    keys: tuple[QuestionKey, ...]

    @property
    def points(self) -> Fraction:
        """Return the marks of the question."""
        return self.questions[0].points


class PaperHolder(msgspec.Struct, frozen=True):
    """Whose paper it is; stands on the cover, and at the foot of every page.

    Parameters
    ----------
    id, name : str
    hidden : bool
        Whether the feet of pages leave it out, so that who marks them does not read it.
    """

    id: str
    name: str = ""
    hidden: bool = False


class PaperCover(msgspec.Struct, frozen=True):
    """What the cover of an exam says of its circumstances.

    Parameters
    ----------
    facts : mapping of str to mapping of str to str
        Word of the section ``paper`` of the interface to its value in each language.
    rules : mapping of str to tuple of str
        What holds in the room, in each language.
    signature : bool
        Whether there is a line to sign on.
    """

    facts: Mapping[str, Mapping[str, str]] = {}
    rules: Mapping[str, tuple[str, ...]] = {}
    signature: bool = False

    def pick_fact(self, name: str, lang: str) -> str:
        """Return a fact in a language, else in English, else in another one."""
        return pick_language(self.facts[name], lang, "")


class Paper(msgspec.Struct, frozen=True):
    """A paper: its questions, and the code that rebuilds it."""

    code: str
    blueprint: Blueprint
    langs: tuple[str, ...]
    items: tuple[PaperItem, ...]
    variety: int = 0
    """How many different papers the blueprint can make; 0 if not counted."""
    seal: str = ""
    """What a graded paper bears for a digest: one without a secret would confirm guesses."""
    holder: PaperHolder | None = None
    """Whose paper it is, if it is one person's."""
    banks: tuple[BankRecord, ...] = ()
    """What it was made from."""
    cover: PaperCover | None = None
    """What its cover says of the circumstances, if anything."""

    def __repr__(self) -> str:
        """Return code, number of questions and points."""
        return f"<Paper {self.code}: {len(self.items)} questions, {float(self.points):g} points>"

    @property
    def points(self) -> Fraction:
        """Return the marks of all questions."""
        return sum((item.points for item in self.items), Fraction(0))

    @property
    def data_files(self) -> dict[str, bytes]:
        """Return the files with drawn data that its questions name, by those names."""
        return {
            name: content
            for item in self.items
            for name, content in iter_data_files(item.keys[0].draw, item.number)
        }

    @property
    def cited_formula(self) -> str:
        """Return the formula's number beside a step of the solutions; empty if there is none."""
        solved = (part for item in self.items for part in item.keys[0].solution.parts)
        return next((line.formula for part in solved for line in part.lines if line.formula), "")

    @property
    def has_drawing(self) -> bool:
        """Return whether an answer is drawn."""
        return any(one.field.drawing for item in self.items for one in item.questions[0].parts)

    @property
    def has_placed_fields(self) -> bool:
        """Return whether the field of a part stands inside a sentence or a cell."""
        parts = (part for item in self.items for part in item.questions[0].parts)
        return any(part.field.near is not None for part in parts)

    @property
    def digest(self) -> str:
        """Return a short digest of what is asked and marked; page, form and key must share it.

        It is of names and numbers as they were drawn, so it is the same for all formats.
        """
        asked = [
            (
                item.number,
                item.keys[0].template,
                item.keys[0].identity,
                [(part.field.id, str(part.points)) for part in item.questions[0].parts],
            )
            for item in self.items
        ]
        return self.seal or content_digest(self.code, asked)

    @property
    def variety_text(self) -> str:
        """Return the number of possible papers, short: 40, or 3.1·10²⁷."""
        if self.variety < 10**6:
            return pretty.format_number(str(self.variety))
        return localise_numbers(self.langs[0], pretty.format_number(f"{Decimal(self.variety):.1e}"))

    @property
    def minutes(self) -> int:
        """Return the working time in minutes: the blueprint's, else of questions and reading."""
        said = self.blueprint.minutes
        if isinstance(said, int):
            return said
        return paper_minutes(sum((i.questions[0].minutes for i in self.items), Fraction(0)))

    def aids(self, lang: str) -> str:
        """Return what may be used in the exam: what the blueprint says, else the usual."""
        said = self.blueprint.aids
        return said.get(lang) or said.get("en") or translate(lang, "paper.aids_allowed")

    def printing(self, lang: str) -> str:
        """Return which questions have to be printed in colour; empty if none has."""
        numbers = [
            item.number for item in self.items
            if (figure := item.questions[0].figure) and figure.needs_colour
        ]  # fmt: skip
        if not numbers:
            return ""
        key = "paper.in_colour" if len(numbers) == 1 else "paper.several_in_colour"
        return translate(lang, key, numbers=", ".join(numbers))

    def title(self, lang: str) -> str:
        """Return the title in a language, else in English, else in another one."""
        return pick_language(self.blueprint.title, lang, self.blueprint.name)


def build_paper(
    bank: Bank,
    blueprint: Blueprint,
    seed: int,
    choice: str = "en",
    *,
    figures: bool = True,
    progress: ProgressCallback = silent,
) -> Paper:
    """Return the paper that a blueprint and a seed make.

    Parameters
    ----------
    bank : Bank
    blueprint : Blueprint
    seed : int
        0 to 10^9.
    choice : str
        A language, or ``both`` for all of them.
    figures : bool
        Whether to draw the figures.
    progress : callable
        Told each question's template as it is done.

    Raises
    ------
    BlueprintError
        If no template fits a slot.
    InvalidChoiceError
        If there is no such language, or the seed is out of range.
    """
    names = select_templates(bank, blueprint, seed)
    drawn = draw_variants(bank, names, str(check_seed(seed)), colour=blueprint.colour)
    named = PaperCode(blueprint.name, str(seed), choice, level=blueprint.level)
    ready = compose_paper(bank, blueprint, drawn, named, figures=figures, progress=progress)
    return replace(ready, variety=count_papers(bank, blueprint))


def compose_paper(
    bank: Bank,
    blueprint: Blueprint,
    drawn: Iterable[Variant],
    named: PaperCode,
    *,
    figures: bool = True,
    progress: ProgressCallback = silent,
) -> Paper:
    """Return the paper of variants that are already drawn; its code gets their digest."""
    langs = bank.resolve_languages(named.choice)
    asked = [*_iter_question_levels(drawn, slot_levels(blueprint))]
    items = []
    for number, (one, points) in enumerate(zip(asked, slot_points(blueprint), strict=False), 1):
        items.append(_build_paper_item(one, langs, str(number), points, figures=figures))
        progress(one.drawn.template.id)
    code = str(_add_digest(named, blueprint, asked))
    banks = record_banks(bank, [one.drawn.template.id for one in asked])
    return Paper(code, blueprint, langs, tuple(items), banks=banks)


def compose_paper_item(
    blueprint: Blueprint, drawn: Sequence[Variant], place: int, langs: Sequence[str]
) -> PaperItem:
    """Return one question of a paper, as it stands there.

    Parameters
    ----------
    blueprint : Blueprint
    drawn : sequence of Variant
        Of the whole paper: what a question may tell depends on the others.
    place : int
        From 0.
    langs : sequence of str
    """
    asked = [*_iter_question_levels(drawn, slot_levels(blueprint))]
    points = next(islice(slot_points(blueprint), place, None))
    return _build_paper_item(asked[place], tuple(langs), str(place + 1), points)


class _WantedQuestion(NamedTuple):
    """A variant and the level that it is asked at."""

    drawn: Variant
    level: str


def _iter_question_levels(
    drawn: Iterable[Variant], wanted: Iterable[str]
) -> Iterator[_WantedQuestion]:
    """Yield the level of each question.

    The wanted one, as far as the question has such a form and it tells nothing of another.
    """
    pairs = [*zip(drawn, wanted, strict=False)]
    ones = [one for one, _ in pairs]
    made = any(level != EXAM for _, level in pairs)
    for one, (_, level) in zip(with_siblings(ones) if made else ones, pairs, strict=True):
        yield _WantedQuestion(one, effective_level(one, level))


def rebuild_paper(
    bank: Bank,
    code: str,
    blueprint: Blueprint | None = None,
    *,
    figures: bool = True,
    progress: ProgressCallback = silent,
) -> Paper:
    """Return the paper that a code stands for, built again.

    Parameters
    ----------
    bank : Bank
    code : str
    blueprint : Blueprint, optional
        The one that the code names, if it does not come with the package.
    figures : bool
    progress : callable

    Raises
    ------
    PaperCodeError
        If it is not a code, or the templates behind it have changed since.
    """
    wanted = parse_code(code)
    plan = msgspec.structs.replace(
        blueprint or _find_code_blueprint(wanted, bank), level=wanted.level
    )
    if wanted.is_reference:
        paper = build_reference_paper(bank, plan, wanted.choice, figures=figures, progress=progress)
    else:
        paper = build_paper(
            bank, plan, int(wanted.seed), wanted.choice, figures=figures, progress=progress
        )
    if paper.code != str(wanted):
        raise PaperCodeError(
            f"{code} was made with other templates or another version: "
            f"this installation would make {paper.code}"
        )
    return paper


def _find_code_blueprint(code: PaperCode, bank: Bank) -> Blueprint:
    """Return the blueprint that a code names: one of the bank's own, never a file."""
    plan = find_blueprint(code.blueprint, bank)
    if plan is None:
        raise PaperCodeError(
            f"{code}: this bank has no blueprint {code.blueprint!r}; "
            "give the file that the paper was made with (--blueprint FILE)"
        )
    return plan


def build_reference_paper(
    bank: Bank,
    blueprint: Blueprint,
    choice: str = "en",
    *,
    figures: bool = True,
    progress: ProgressCallback = silent,
) -> Paper:
    """Return the paper with the numbers printed in the notes.

    Raises
    ------
    BlueprintError
        If the blueprint lists no such questions.
    InvalidChoiceError
        If there is no such language.
    """
    if not blueprint.reference:
        raise BlueprintError(f"blueprint {blueprint.name!r} lists no reference questions")
    with error_context(blueprint.file):
        for name in blueprint.reference:
            bank.folder_of(name)
    templates = [bank.template(name) for name in blueprint.reference]
    drawn = [draw_instance(t, REFERENCE if t.rules.reference is not None else 0) for t in templates]
    named = PaperCode(blueprint.name, REFERENCE, choice, level=blueprint.level)
    slotless = msgspec.structs.replace(blueprint, slot=())  # its slots are for other questions
    ready = compose_paper(bank, slotless, drawn, named, figures=figures, progress=progress)
    title = {lang: _title_reference(lang, text) for lang, text in blueprint.title.items()}
    return replace(ready, blueprint=msgspec.structs.replace(blueprint, title=title))


def _title_reference(lang: str, title: str) -> str:
    """Return the title of all questions at once, which is longer than the exam it names."""
    return translate(lang, "paper.reference", title=title)


def single_question_paper(
    template: Template, seed: str | int, lang: str, *, level: str = EXAM, figures: bool = True
) -> Paper:
    """Return a paper of one question, for looking at a template."""
    drawn = draw_instance(template, seed)
    wanted = _WantedQuestion(drawn, effective_level(drawn, level))
    item = _build_paper_item(wanted, (lang,), "1", figures=figures)
    title, slot = {"en": template.id}, SlotRule(templates=(template.id,))
    minutes = math.ceil(item.questions[0].minutes)
    blueprint = Blueprint(title, (slot,), name=template.id, minutes=minutes)
    return Paper(f"{template.id}-{seed}", blueprint, (lang,), (item,))


def _add_digest(code: PaperCode, blueprint: Blueprint, asked: list[_WantedQuestion]) -> PaperCode:
    """Return the code with the digest of the blueprint, the templates and the levels."""
    templates = [one.drawn.template for one in asked]
    digest = source_digest(blueprint.source, templates, [one.level for one in asked])
    return replace(code, digest=digest)


def _build_paper_item(
    one: _WantedQuestion,
    langs: tuple[str, ...],
    number: str,
    points: float | None = None,
    *,
    figures: bool = True,
) -> PaperItem:
    """Return one question in every language, and its keys.

    ``points`` are shared out over its parts; None leaves them as authored.
    """
    pairs = [
        compose_variant(one.drawn, lang, number=number, level=one.level, figures=figures)
        for lang in langs
    ]
    first = pairs[0][0]
    questions = tuple(
        _distribute_points(_drop_repeated_blocks(question, first), points) for question, _ in pairs
    )
    return PaperItem(number, questions, tuple(_rescale_key(key, questions[0]) for _, key in pairs))


def _drop_repeated_blocks(question: Question, first: Question) -> Question:
    """Return a question without the programs and pictures that the first language shows, too."""
    if question is first:
        return question
    bodies = (first.stem, *(part.body for part in first.parts))
    shown = {alike for body in bodies for alike in map(_strip_language, body) if alike}

    def keep_new(body: tuple[Block, ...]) -> tuple[Block, ...]:
        """Return the blocks that the first language does not already show."""
        return tuple(block for block in body if _strip_language(block) not in shown)

    parts = tuple(replace(part, body=keep_new(part.body)) for part in question.parts)
    return replace(question, stem=keep_new(question.stem), parts=parts)


def _strip_language(block: Block) -> object:
    """Return what of a block looks the same in every language: a program, or pictures alone."""
    if isinstance(block, CodeBlock):
        return block
    pieces = block.children if isinstance(block, Paragraph) else ()
    pictures = tuple(piece.picture for piece in pieces if isinstance(piece, PlacedPicture))
    return pictures if len(pictures) == len(pieces) else None


def _rescale_key(key: QuestionKey, question: Question) -> QuestionKey:
    """Return a key whose criteria add up to what the parts are worth on this paper."""
    solved = tuple(
        rescale_criteria(part, asked.points)
        for part, asked in zip(key.solution.parts, question.parts, strict=True)
    )
    return replace(key, solution=replace(key.solution, parts=solved))


def _distribute_points(question: Question, points: float | None) -> Question:
    """Return a question with the marks of its slot shared out over the parts.

    They stand to each other as the parts' own marks do; the time is what it was.
    """
    if points is None:
        return question
    shares = rescale_points(tuple(part.points for part in question.parts), Fraction(str(points)))
    parts = tuple(
        replace(part, points=worth) for part, worth in zip(question.parts, shares, strict=True)
    )
    return replace(question, parts=parts)
