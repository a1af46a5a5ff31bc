"""What is exported: questions in one language, in slots from which a course draws variants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import msgspec

from quizgen.bank.bank import Bank
from quizgen.export.asks import Ask, Write, asks
from quizgen.figures import Figure
from quizgen.paper.answer_key import KeyQuestion, make_key_question
from quizgen.paper.blueprint import Blueprint
from quizgen.paper.paper import PaperItem, ProgressCallback, build_paper, silent
from quizgen.question.compose import Question, QuestionKey, QuestionPart, compose_question
from quizgen.responses.keys import mark


@dataclass(frozen=True)
class Item:
    """A question in one language.

    Parameters
    ----------
    id : str
        The same for the same question whenever it is exported.
    slot : str
        What it is one of several variants of.
    question : Question
    key : Key
    """

    id: str
    slot: str
    question: Question
    key: QuestionKey

    @property
    def lang(self) -> str:
        """The language that it is in."""
        return self.question.lang

    @property
    def number(self) -> str:
        """What it is called in any language."""
        return self.id.rsplit(".", 1)[0]

    def called(self, suffix: str = "") -> str:
        """What a course lists it by, or what it becomes there with a suffix."""
        return f"{self.question.title} ({self.number}{suffix})"

    @property
    def category(self) -> str:
        """Where a course keeps it: what stands together there, a quiz may draw from."""
        return f"{self.lang}/{self.slot}"

    @property
    def paper_item(self) -> PaperItem:
        """The same as a question of a paper, which is printed and marked."""
        return PaperItem(self.question.number, (self.question,), (self.key,))

    @property
    def solved_figure(self) -> Figure | None:
        """The figure of the solution, if it shows more than that of the question."""
        asked, solved = self.question.figure, self.key.figure
        alike = asked and solved and asked.standalone_svg == solved.standalone_svg
        return None if alike else solved

    @cached_property
    def parts(self) -> tuple[tuple[QuestionPart, tuple[Ask, ...]], ...]:
        """Each part with what it asks."""
        rows = zip(self.question.parts, self.key.specs, self.key.solution.parts, strict=True)
        return tuple((part, asks(part, spec, solved, self.lang)) for part, spec, solved in rows)

    @cached_property
    def key_question(self) -> KeyQuestion:
        """What marks it, as it is written to a file."""
        return make_key_question(self.paper_item)

    def mark(self, suffix: str = "") -> str:
        """What stands in its text, so that a response to it is known."""
        return mark(f"{self.id}{suffix}\n{msgspec.json.encode(self.key_question).decode()}")

    @property
    def tags(self) -> tuple[str, ...]:
        """Topic, tier and the formulas that its solution applies."""
        lines = (line for part in self.key.solution.parts for line in part.lines)
        cited = dict.fromkeys(line.formula for line in lines if line.formula)
        return (self.question.topic, f"tier {self.question.tier}", *cited)


def suffix(part: QuestionPart) -> str:
    """What tells the question that a part becomes from others of its item."""
    return f".{part.label}" if part.label else ""


def by_hand(item: Item) -> Iterator[tuple[str, str]]:
    """Field and why, of each part that a person marks."""
    for part, found in item.parts:
        yield from ((part.field.id, ask.why) for ask in found if isinstance(ask, Write))


def by_slot(items: Iterable[Item]) -> list[Item]:
    """The items of one slot after another, those of a slot in their order."""
    return sorted(items, key=lambda item: item.category)


def of_templates(
    bank: Bank,
    names: Sequence[str],
    seed: int,
    variants: int,
    langs: Sequence[str],
    progress: ProgressCallback = silent,
) -> Iterator[Item]:
    """Variants of templates, no two of them the same: fewer than asked for if there are no more.

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
        Told each template.

    Raises
    ------
    BankError, DrawError
        If a template is wrong, or not written in one of the languages.
    """
    for lang in langs:
        for name in names:
            template, seen = bank.template(name), set[str]()
            for place in range(seed, seed + variants):
                question, key = compose_question(template, place, lang)
                if key.identity not in seen:
                    seen.add(key.identity)
                    yield Item(f"{name}.{place}.{lang}", name, question, key)
            progress(name)


def of_blueprint(
    bank: Bank,
    blueprint: Blueprint,
    seed: int,
    variants: int,
    langs: Sequence[str],
    progress: ProgressCallback = silent,
) -> Iterator[Item]:
    """The questions of papers of consecutive seeds; those of one number share a slot.

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
                    yield Item(name, slot, item.questions[0], key)
