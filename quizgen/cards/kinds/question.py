"""Worked questions: fresh numbers per seed, the answer with all its steps on the back."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from quizgen.bank.bank import Bank
from quizgen.bank.formulas import read_formulas
from quizgen.bank.template import Template
from quizgen.cards.content import VocabularyEntry, load_card_words, read_card_entries
from quizgen.cards.markup import CardLabel, CardPicture, Details, DisplayMaths, InLanguage
from quizgen.cards.note import CardBlocks, Note
from quizgen.cards.request import DeckRequest
from quizgen.cards.versions import template_version
from quizgen.figures import Figure
from quizgen.locale import translate
from quizgen.question.compose import (
    Question,
    QuestionKey,
    QuestionPart,
    compose_variant,
    draw_instance,
)
from quizgen.question.solution import PartSolution, SolvedMisconception
from quizgen.typeset.prose import Emphasis, Inline, ListBlock, Paragraph, PlainText

SLOT = "card"
"""The place of a card in the draw: the same for every template, so only the seed changes it."""

Pair = tuple[Question, QuestionKey]


def notes(wish: DeckRequest) -> Iterator[Note]:
    """Yield the notes of every requested template that is written in the requested languages."""
    for name in wish.templates or wish.bank.template_paths:
        if wish.includes_topic(wish.bank.rules(name).topic):
            template = wish.bank.template(name)
            if set(wish.langs) <= set(template.languages):
                yield from template_notes(template, wish)


def template_notes(template: Template, wish: DeckRequest) -> Iterator[Note]:
    """Yield one note per part of a question: the stem with that part, its answer and its steps.

    Parameters
    ----------
    template : Template
    wish : DeckRequest
        Its seed fixes the numbers; the notes' identity does not depend on them.
    """
    drawn = draw_instance(template, wish.seed, SLOT)
    pairs = {lang: compose_variant(drawn, lang, number="") for lang in wish.langs}
    rules = template.rules
    for index, label in enumerate(template.labels):
        yield Note(
            key=f"question/{template.origin}" + (f"/{label}" if label else ""),
            kind="question",
            form="basic",
            topic=rules.topic,
            tier=rules.tier,
            section=section_for(wish.bank, rules.covers, rules.topic),
            refs=tuple(dict.fromkeys((*rules.covers, template.id))),
            langs=wish.langs,
            words={
                "Front": {lang: front_blocks(pair[0], index) for lang, pair in pairs.items()},
                "Back": deduplicate(
                    {
                        lang: answer_blocks(key.solution.parts[index])
                        for lang, (_, key) in pairs.items()
                    }
                ),
                "More": {lang: _build_extra_blocks(key, index) for lang, (_, key) in pairs.items()},
            },
            shared=shared_blocks(pairs, index),
            version=template_version(template, wish.bank),
        )


def section_for(bank: Bank, covers: tuple[str, ...], topic: str) -> str:
    """Return the section of the notes a question belongs to: its formula's, else its topic's."""
    sections = {entry.id: entry.section for entry in read_formulas(bank)}
    found = [sections[ref] for ref in covers if ref in sections]
    by_topic = [
        entry.section for entry in read_card_entries(bank, VocabularyEntry) if entry.topic == topic
    ]
    return str((found or by_topic or [""])[0])


def shared_blocks(pairs: dict[str, Pair], index: int) -> dict[str, CardBlocks]:
    """Return by field what all languages share: figures, and worked lines with sentences."""
    questions, keys = zip(*pairs.values(), strict=True)
    template, label = questions[0].template, questions[0].parts[index].label
    fields = [question.parts[index].field for question in questions]
    solved = [key.solution.parts[index] for key in keys]
    return {
        "Figure": (
            *figure_blocks(template, [question.figure for question in questions]),
            *figure_blocks(template + label, [one.drawing.figure for one in fields if one.drawing]),
        ),
        "Work": tuple(step_blocks(list(keys), index)),
        "Answer figure": (
            *figure_blocks(template, [key.figure for key in keys]),
            *figure_blocks(template + label, [one.drawing.figure for one in solved if one.drawing]),
        ),
    }


def figure_blocks(name: str, figures: Iterable[Figure | None]) -> CardBlocks:
    """Return a figure with its description in every language; nothing if there is none."""
    drawn = [figure for figure in figures if figure is not None]
    if not drawn:
        return ()
    return (CardPicture(name, drawn[0], " / ".join(figure.alt for figure in drawn)),)


def front_blocks(question: Question, index: int) -> CardBlocks:
    """Return the question as it is asked, with part number ``index`` and its lettered options."""
    return (CardLabel(question.title), *question.stem, *asked_blocks(question.parts[index]))


def asked_blocks(part: QuestionPart) -> Iterator[Any]:
    """Yield the blocks of one part of a question, with its lettered options."""
    body = part.body or part.shared
    if part.label:
        label = Emphasis("strong", (PlainText(f"({part.label}) "),))
        first, *rest = body
        lead = first.children if isinstance(first, Paragraph) else ()
        yield Paragraph((label, *lead))
        yield from rest if lead else body
    else:
        yield from body
    for mark, text in part.field.options:
        yield Paragraph((Emphasis("strong", (PlainText(f"{mark} "),)), *text))
    if part.field.targets:
        targets = [(Paragraph(text),) for _, text in part.field.targets]
        yield ListBlock(tuple(targets), ordered=True)


def deduplicate(said: dict[str, CardBlocks]) -> dict[str, CardBlocks]:
    """Return the blocks by language, without those that read as in the first, such as numbers."""
    main, *others = said
    own = {lang: tuple(b for b in said[lang] if b not in said[main]) for lang in others}
    kept = {
        lang: own[lang] for lang in others if not all(isinstance(b, CardLabel) for b in own[lang])
    }
    return {main: said[main]} | kept


def answer_blocks(part: PartSolution) -> CardBlocks:
    """Return the key of one part, with the wording of the right options or criteria."""
    if len(part.options) > 1:
        points = tuple((Paragraph(option),) for option in part.options)
        return (*_build_answer_blocks(part, ()), ListBlock(points))
    return _build_answer_blocks(part, part.options)


def _build_answer_blocks(part: PartSolution, options: tuple[Any, ...]) -> CardBlocks:
    """Return the key of one part, with the wording of the given options."""
    label = f"({part.label})" if part.label else ""
    shown = () if part.drawing else part.shown  # a drawing is told by what it must show
    lead = (PlainText(f"{label} " if shown else label),) if label else ()
    said: list[Any] = [Emphasis("strong", (*lead, *shown))]
    for option in options:
        said += [PlainText(" – " if shown else " "), *option]
    return (Paragraph(tuple(said)),) if label or shown or options else ()


def step_blocks(keys: list[QuestionKey], index: int) -> Iterator[Any]:
    """Yield the worked lines of one part: each formula once, with a sentence per language."""
    langs = [key.solution.lang for key in keys]
    for same in zip(*(key.solution.parts[index].lines for key in keys), strict=True):
        yield DisplayMaths(same[0].maths)
        for lang, line in zip(langs, same, strict=True):
            yield InLanguage(lang, (Paragraph(line.why),))


def _describe_mistake(mistake: SolvedMisconception) -> tuple[Inline, ...]:
    """Return a wrong answer, if it is shown, and what is wrong with it."""
    return (
        *mistake.shown,
        *([PlainText(" – ")] if mistake.shown else []),
        *mistake.listed_sentence,
    )


def _build_extra_blocks(key: QuestionKey, index: int) -> CardBlocks:
    """Return what follows the answer: how to check it, and the known misconceptions."""
    lang, solution = key.solution.lang, key.solution
    found: list[Any] = []
    part = solution.parts[index]
    if part.why:
        found.append(Details(translate(lang, "solution.why"), (Paragraph(part.why),)))
    if solution.check:
        found.append(Details(translate(lang, "solution.check"), solution.check))
    mistakes = (*part.reasons, *part.mistakes)
    if mistakes:
        told = tuple((Paragraph(_describe_mistake(mistake)),) for mistake in mistakes)
        found.append(Details(translate(lang, "solution.mistakes"), (ListBlock(told),)))
    if solution.note:
        found.append(Details(load_card_words(lang)["notes"], solution.note))
    return tuple(found)
