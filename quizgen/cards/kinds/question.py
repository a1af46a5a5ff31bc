"""Worked questions: fresh numbers per seed, the answer with all its steps on the back."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from quizgen.bank.folder import Bank
from quizgen.bank.formulas import formulas
from quizgen.bank.prose import Inline, Items, Paragraph, Styled, Words
from quizgen.bank.template import Template
from quizgen.cards.content import Term, entries, words
from quizgen.cards.note import Blocks, Note
from quizgen.cards.prose import Display, Fold, Label, Picture, Said
from quizgen.cards.versions import template_version
from quizgen.cards.wish import Wish
from quizgen.figures import Figure
from quizgen.locale import word
from quizgen.question.compose import Key, Part, Question, instance, put_into_words
from quizgen.question.solution import Mistake, PartSolution

SLOT = "card"
"""The place of a card in the draw: the same for every template, so only the seed changes it."""

Pair = tuple[Question, Key]


def notes(wish: Wish) -> Iterator[Note]:
    """Notes of every template asked for that is written in the languages asked for."""
    for name in wish.templates or wish.bank.paths:
        if wish.wants(wish.bank.rules(name).topic):
            template = wish.bank.template(name)
            if set(wish.langs) <= set(template.languages):
                yield from of_template(template, wish)


def of_template(template: Template, wish: Wish) -> Iterator[Note]:
    """One note per part of a question: the stem with that part, its answer and its steps.

    Parameters
    ----------
    template : Template
    wish : Wish
        Its seed fixes the numbers; the notes' identity does not depend on them.
    """
    drawn = instance(template, wish.seed, SLOT)
    pairs = {lang: put_into_words(drawn, lang, number="") for lang in wish.langs}
    rules = template.rules
    for index, label in enumerate(template.labels):
        yield Note(
            key=f"question/{template.origin}" + (f"/{label}" if label else ""),
            kind="question",
            form="basic",
            topic=rules.topic,
            tier=rules.tier,
            section=section_of(wish.bank, rules.covers, rules.topic),
            refs=tuple(dict.fromkeys((*rules.covers, template.id))),
            langs=wish.langs,
            words={
                "Front": {lang: front(pair[0], index) for lang, pair in pairs.items()},
                "Back": once(
                    {lang: answer(key.solution.parts[index]) for lang, (_, key) in pairs.items()}
                ),
                "More": {lang: _more(key, index) for lang, (_, key) in pairs.items()},
            },
            shared=shared(pairs, index),
            version=template_version(template, wish.bank),
        )


def section_of(bank: Bank, covers: tuple[str, ...], topic: str) -> str:
    """Section of the notes that a question belongs to: that of its formula, else of its topic."""
    sections = {entry.id: entry.section for entry in formulas(bank)}
    found = [sections[ref] for ref in covers if ref in sections]
    by_topic = [entry.section for entry in entries(bank, Term) if entry.topic == topic]
    return str((found or by_topic or [""])[0])


def shared(pairs: dict[str, Pair], index: int) -> dict[str, Blocks]:
    """What all languages share: figures, and the worked lines with a sentence per language."""
    questions, keys = zip(*pairs.values(), strict=True)
    template, label = questions[0].template, questions[0].parts[index].label
    fields = [question.parts[index].field for question in questions]
    solved = [key.solution.parts[index] for key in keys]
    return {
        "Figure": (
            *picture(template, [question.figure for question in questions]),
            *picture(template + label, [one.drawing.figure for one in fields if one.drawing]),
        ),
        "Work": tuple(steps(list(keys), index)),
        "Answer figure": (
            *picture(template, [key.figure for key in keys]),
            *picture(template + label, [one.drawing.figure for one in solved if one.drawing]),
        ),
    }


def picture(name: str, figures: Iterable[Figure | None]) -> Blocks:
    """A figure, told in every language; nothing if there is none."""
    drawn = [figure for figure in figures if figure is not None]
    if not drawn:
        return ()
    return (Picture(name, drawn[0], " / ".join(figure.alt for figure in drawn)),)


def front(question: Question, index: int) -> Blocks:
    """The question as it is asked, with one of its parts and its lettered options."""
    return (Label(question.title), *question.stem, *asked(question.parts[index]))


def asked(part: Part) -> Iterator[Any]:
    """One part of a question, with its lettered options."""
    body = part.body
    if part.label:
        label = Styled("strong", (Words(f"({part.label}) "),))
        first, *rest = body
        lead = first.children if isinstance(first, Paragraph) else ()
        yield Paragraph((label, *lead))
        yield from rest if lead else body
    else:
        yield from body
    for mark, text in part.field.options:
        yield Paragraph((Styled("strong", (Words(f"{mark} "),)), *text))
    if part.field.targets:
        targets = [(Paragraph(text),) for _, text in part.field.targets]
        yield Items(tuple(targets), ordered=True)


def once(said: dict[str, Blocks]) -> dict[str, Blocks]:
    """Leave out of the further languages what reads the same in the first, such as numbers."""
    main, *others = said
    own = {lang: tuple(b for b in said[lang] if b not in said[main]) for lang in others}
    kept = {lang: own[lang] for lang in others if not all(isinstance(b, Label) for b in own[lang])}
    return {main: said[main]} | kept


def answer(part: PartSolution) -> Blocks:
    """The key of one part, with the wording of the right options (or of the key points)."""
    if len(part.options) > 1:
        points = tuple((Paragraph(option),) for option in part.options)
        return (*_keyed(part, ()), Items(points))
    return _keyed(part, part.options)


def _keyed(part: PartSolution, options: tuple[Any, ...]) -> Blocks:
    label = f"({part.label})" if part.label else ""
    lead = (Words(f"{label} " if part.shown else label),) if label else ()
    said: list[Any] = [Styled("strong", (*lead, *part.shown))]
    for option in options:
        said += [Words(" – " if part.shown else " "), *option]
    return (Paragraph(tuple(said)),) if label or part.shown or options else ()


def steps(keys: list[Key], index: int) -> Iterator[Any]:
    """The worked lines of one part: each formula once, with a sentence per language."""
    langs = [key.solution.lang for key in keys]
    for same in zip(*(key.solution.parts[index].lines for key in keys), strict=True):
        yield Display(same[0].maths)
        for lang, line in zip(langs, same, strict=True):
            yield Said(lang, (Paragraph(line.why),))


def _told(mistake: Mistake) -> tuple[Inline, ...]:
    """A wrong answer, if it is shown, and what is wrong with it."""
    return (*mistake.shown, *([Words(" – ")] if mistake.shown else []), *mistake.sentence)


def _more(key: Key, index: int) -> Blocks:
    """What is worth a look after the answer: how to check it, and the known mistakes."""
    lang, solution = key.solution.lang, key.solution
    found: list[Any] = []
    part = solution.parts[index]
    if part.why:
        found.append(Fold(word(lang, "solution.why"), (Paragraph(part.why),)))
    if solution.check:
        found.append(Fold(word(lang, "solution.check"), solution.check))
    mistakes = (*part.reasons, *part.mistakes)
    if mistakes:
        told = tuple((Paragraph(_told(mistake)),) for mistake in mistakes)
        found.append(Fold(word(lang, "solution.mistakes"), (Items(told),)))
    if solution.note:
        found.append(Fold(words(lang)["notes"], solution.note))
    return tuple(found)
