"""The formulas of a bank in words: what a formula sheet shows, whatever it is printed on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import msgspec

from quizgen import typeset
from quizgen.bank.folder import Bank
from quizgen.bank.formulas import FormulaEntry, asked_in, formulas
from quizgen.bank.pages import read_text
from quizgen.bank.prose import Block, Inline, Words
from quizgen.errors import BankError
from quizgen.figures import Figure, draw_figure
from quizgen.question.authored import passage, sentence
from quizgen.question.equations import sides
from quizgen.question.shown import Maths, listed, named

NOTES = ("about", "holds", "limits", "beware")
"""What is said about a formula, in the order in which it is said."""


class Said(msgspec.Struct, frozen=True):
    """What is said about a formula in one language."""

    lang: str
    title: tuple[Inline, ...]
    notes: Mapping[str, tuple[Block, ...]]
    questions: tuple[tuple[str, str], ...]
    """Name and title of the templates that ask for it."""


class Line(msgspec.Struct, frozen=True):
    """A formula: its lines, units of its letters, and what is said about it."""

    id: str
    section: str
    lines: tuple[Maths, ...]
    units: tuple[Inline, ...]
    said: tuple[Said, ...]
    figures: tuple[Figure, ...] = ()
    """Its sketch, described in each language; none if it has no sketch."""


class Group(msgspec.Struct, frozen=True):
    """The formulas of a topic, and its title by language."""

    topic: str
    titles: Mapping[str, str]
    lines: tuple[Line, ...]


class Sheet(msgspec.Struct, frozen=True):
    """Formulas by topic, and the title of the chapter by language."""

    langs: tuple[str, ...]
    titles: Mapping[str, str]
    groups: tuple[Group, ...]


def sheet(bank: Bank, choice: str, topics: Sequence[str] = ()) -> Sheet:
    """Put the formulas of a bank into words.

    Parameters
    ----------
    bank : Bank
    choice : str
        A language, or ``both`` for all of the bank's.
    topics : sequence of str
        Only these; all of them if there are none.

    Raises
    ------
    BankError
        If there is no formula, or one of them is wrong; names the file and the place.
    """
    langs = bank.chosen(choice)
    wanted = [entry for entry in formulas(bank) if not topics or entry.topic in topics]
    if not wanted:
        of = f" of the topic {', '.join(topics)}" if topics and formulas(bank) else ""
        raise BankError(
            f"{bank.name}: no formulas{of} here (they stand in templates/cards/formulas.toml)"
        )
    asked = asked_in(bank)
    order = dict.fromkeys((*bank.topics, *(entry.topic for entry in wanted)))
    made = {topic: [_line(bank, e, langs, asked[e.id]) for e in wanted if e.topic == topic]
            for topic in order}  # fmt: skip
    groups = (
        Group(topic, {lang: bank.topic_title(topic, lang) for lang in langs}, tuple(lines))
        for topic, lines in made.items()
        if lines
    )
    return Sheet(langs, {lang: bank.title(lang) for lang in langs}, tuple(groups))


def cited(bank: Bank, name: str, lang: str) -> tuple[Inline, ...]:
    """A line of the sheet in a sentence: its number, title and formulas; empty if it has none."""
    for entry in formulas(bank):
        if entry.id == name:
            lines = listed([(_whole(line, entry),) for line in entry.lines], "; ")
            return (Words(f"{name}, "), *sentence(entry, "title", lang), Words(": "), *lines)
    return ()


def _line(bank: Bank, entry: FormulaEntry, langs: tuple[str, ...], asked: tuple[str, ...]) -> Line:
    lines = tuple(_whole(line, entry) for line in entry.lines)
    said = tuple(
        Said(
            lang,
            sentence(entry, "title", lang),
            {name: passage(entry, name, lang) for name in NOTES if getattr(entry, name)},
            tuple((name, _title(bank, name, lang)) for name in asked),
        )
        for lang in langs
    )
    figures = draw_sketch(bank, entry, langs)
    return Line(entry.id, entry.section, lines, tuple(_units(entry)), said, figures)


def draw_sketch(bank: Bank, entry: FormulaEntry, langs: tuple[str, ...]) -> tuple[Figure, ...]:
    """Draw the sketch of a formula for each language; none if it has no sketch.

    Raises
    ------
    BankError
        If there is no such figure, or it cannot be drawn; names the file and the formula.
    """
    wanted = entry.figure
    if wanted is None:
        return ()
    try:
        figure = bank.figure(wanted.name)
        return tuple(draw_figure(figure, wanted.values, quiz=False, lang=lang) for lang in langs)
    except BankError as error:
        raise BankError(f"{entry.place}: {error}") from error


def _whole(line: str, entry: FormulaEntry) -> Maths:
    """A line in one piece."""
    signs, parts = sides(line, entry.inside, entry.place)
    node = typeset.relation(signs, [part.node for part in parts])
    return Maths(node, line)


def _units(entry: FormulaEntry) -> Iterator[Inline]:
    """Letters with their unit, those of the same unit together: ``f, p′ [mm]; z [m]``."""
    for place, (unit, letters) in enumerate(entry.units.items()):
        if place:
            yield Words("; ")
        for index, letter in enumerate(letters):
            if index:
                yield Words(", ")
            yield named(letter)
        yield Words(f"\u00a0[{unit}]")


def _title(bank: Bank, name: str, lang: str) -> str:
    """Title of a template, in the language or else in one that it is written in."""
    written = bank.written_in(name)
    found = lang if lang in written else next(iter(written))
    return read_text(bank.paths[name] / f"{found}.md").title
