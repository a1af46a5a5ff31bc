"""What is exported: questions in one language, in slots from which a course draws variants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import msgspec

from quizgen.bank.bank import Bank
from quizgen.figures import Figure
from quizgen.lms.interactions import ExtendedTextInteraction, PartInteractions, part_interactions
from quizgen.lms.manifest import question_token
from quizgen.paper.answer_key import KeyQuestion, make_key_question
from quizgen.paper.blueprint import Blueprint
from quizgen.paper.paper import PaperItem, ProgressCallback, build_paper, silent
from quizgen.question.compose import Question, QuestionKey, QuestionPart, compose_question


@dataclass(frozen=True)
class ExportItem:
    """A question in one language.

    Parameters
    ----------
    id : str
        The same for the same question whenever it is exported.
    slot : str
        Of which it is one of several variants.
    question : Question
    key : QuestionKey
    """

    id: str
    slot: str
    question: Question
    key: QuestionKey

    @property
    def lang(self) -> str:
        """The language of its words."""
        return self.question.lang

    @property
    def number(self) -> str:
        """Its id without the language."""
        return self.id.rsplit(".", 1)[0]

    def title(self, suffix: str = "") -> str:
        """Return the title in lists of a course, of the item or of a question made of it."""
        return f"{self.question.title} ({self.number}{suffix})"

    @property
    def category(self) -> str:
        """Its category in a course: a quiz may draw any question of one."""
        return f"{self.lang}/{self.slot}"

    @property
    def paper_item(self) -> PaperItem:
        """The same as a question of a paper, which can be printed and graded."""
        return PaperItem(self.question.number, (self.question,), (self.key,))

    @property
    def solution_figure(self) -> Figure | None:
        """The figure of the solution, if it shows more than that of the question."""
        asked, solved = self.question.figure, self.key.figure
        is_same = asked and solved and asked.standalone_svg == solved.standalone_svg
        return None if is_same else solved

    @cached_property
    def parts(self) -> tuple[PartInteractions, ...]:
        """Each part with what it asks."""
        rows = zip(self.question.parts, self.key.specs, self.key.solution.parts, strict=True)
        return tuple(
            (part, part_interactions(part, spec, solution, self.lang))
            for part, spec, solution in rows
        )

    @cached_property
    def key_question(self) -> KeyQuestion:
        """What grades it, as it is written to a file."""
        return make_key_question(self.paper_item)

    def token(self, suffix: str = "") -> str:
        """Return what stands in its text, so that a response to it is recognized."""
        key = msgspec.json.encode(self.key_question).decode()
        return question_token(f"{self.id}{suffix}\n{key}")

    @property
    def tags(self) -> tuple[str, ...]:
        """Topic, tier and the formulas that its solution applies."""
        lines = (line for part in self.key.solution.parts for line in part.lines)
        cited = dict.fromkeys(line.formula for line in lines if line.formula)
        return (self.question.topic, f"tier {self.question.tier}", *cited)


@dataclass(frozen=True)
class CourseQuestion:
    """A question as a system has it: an item, or some of its parts.

    Parameters
    ----------
    item : ExportItem
    suffix : str
        Tells it from the other questions made of the item.
    parts : sequence of (QuestionPart, interactions)
        What it asks.
    """

    item: ExportItem
    suffix: str
    parts: Sequence[PartInteractions]

    @property
    def id(self) -> str:
        """The same for the same question whenever it is exported."""
        return f"{self.item.id}{self.suffix}"

    @property
    def title(self) -> str:
        """Its title in lists of a course."""
        return self.item.title(self.suffix)

    @property
    def points(self) -> Fraction:
        """Marks of its parts together."""
        return sum((part.points for part, _ in self.parts), Fraction(0))


def part_suffix(part: QuestionPart) -> str:
    """Return what tells the question made of a part from others of its item."""
    return f".{part.label}" if part.label else ""


def manual_parts(item: ExportItem) -> Iterator[tuple[str, str]]:
    """Yield the field of each part that a person grades, and why."""
    for part, interactions in item.parts:
        for one in interactions:
            if isinstance(one, ExtendedTextInteraction):
                yield part.field.id, one.why


def group_by_slot(items: Iterable[ExportItem]) -> list[ExportItem]:
    """Return the items of one slot after another, those of a slot in their order."""
    return sorted(items, key=lambda item: item.category)


def items_from_templates(
    bank: Bank,
    names: Sequence[str],
    seed: int,
    variants: int,
    langs: Sequence[str],
    progress: ProgressCallback = silent,
) -> Iterator[ExportItem]:
    """Yield variants of templates, no two the same: fewer than asked for if there are no more.

    Parameters
    ----------
    bank : Bank
    names : sequence of str
    seed : int
        Of the first variant; the others follow.
    variants : int
    langs : sequence of str
        Languages, one after another, with the same numbers.
    progress : callable
        Called with each template.

    Raises
    ------
    BankError, SamplingError
        If a template is wrong, or not written in one of the languages.
    """
    for lang in langs:
        for name in names:
            template, seen = bank.template(name), set[str]()
            for place in range(seed, seed + variants):
                question, key = compose_question(template, place, lang)
                if key.identity not in seen:
                    seen.add(key.identity)
                    yield ExportItem(f"{name}.{place}.{lang}", name, question, key)
            progress(name)


def items_from_blueprint(
    bank: Bank,
    blueprint: Blueprint,
    seed: int,
    variants: int,
    langs: Sequence[str],
    progress: ProgressCallback = silent,
) -> Iterator[ExportItem]:
    """Yield the questions of papers of consecutive seeds; those of one number share a slot.

    No two in a slot are the same.

    Raises
    ------
    BlueprintError
        If no template fits a slot.
    """
    for lang in langs:
        seen = set[tuple[str, str]]()
        for place in range(seed, seed + variants):
            for item in build_paper(bank, blueprint, place, lang, progress=progress).items:
                slot, key = f"{blueprint.name}/{int(item.number):02}", item.keys[0]
                if (slot, key.identity) not in seen:
                    seen.add((slot, key.identity))
                    name = f"{blueprint.name}.{place}.{item.number}.{lang}"
                    yield ExportItem(name, slot, item.questions[0], key)
