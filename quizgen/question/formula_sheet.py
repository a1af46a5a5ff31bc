"""The formulas of a bank in words: what a formula sheet shows, whatever it is printed on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import msgspec

from quizgen import typeset
from quizgen.bank.bank import Bank
from quizgen.bank.formulas import FormulaEntry, read_formulas, templates_by_formula
from quizgen.bank.language_file import read_language_file
from quizgen.core.errors import BankError
from quizgen.figures import Figure, draw_figure
from quizgen.question.entry_prose import entry_blocks, entry_inlines
from quizgen.question.formula_lines import parse_formula_line
from quizgen.typeset.prose import Block, Inline, PlainText, TypesetMaths, join_inlines, name_inline

NOTES = ("about", "holds", "limits", "beware")
"""What is said about a formula, in the order in which it is said."""


class FormulaText(msgspec.Struct, frozen=True):
    """What is said about a formula in one language."""

    lang: str
    title: tuple[Inline, ...]
    notes: Mapping[str, tuple[Block, ...]]
    questions: tuple[tuple[str, str], ...]
    """Name and title of the templates that ask for it."""


class SheetFormula(msgspec.Struct, frozen=True):
    """A formula: its lines, units of its letters, and what is said about it."""

    id: str
    section: str
    lines: tuple[TypesetMaths, ...]
    units: tuple[Inline, ...]
    said: tuple[FormulaText, ...]
    figures: tuple[Figure, ...] = ()
    """Its sketch, described in each language; none if it has no sketch."""


class SheetTopic(msgspec.Struct, frozen=True):
    """The formulas of a topic, and its title by language."""

    topic: str
    titles: Mapping[str, str]
    lines: tuple[SheetFormula, ...]


class FormulaSheet(msgspec.Struct, frozen=True):
    """Formulas by topic, and the title of the chapter by language."""

    langs: tuple[str, ...]
    titles: Mapping[str, str]
    groups: tuple[SheetTopic, ...]


def compose_sheet(bank: Bank, choice: str, topics: Sequence[str] = ()) -> FormulaSheet:
    """Return the formulas of a bank with their words, by topic.

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
    langs = bank.resolve_languages(choice)
    wanted = [entry for entry in read_formulas(bank) if not topics or entry.topic in topics]
    if not wanted:
        of = f" of the topic {', '.join(topics)}" if topics and read_formulas(bank) else ""
        raise BankError(
            f"{bank.name}: no formulas{of} here (they stand in templates/cards/formulas.toml)"
        )
    asked = templates_by_formula(bank)
    order = dict.fromkeys((*bank.topics, *(entry.topic for entry in wanted)))
    made = {
        topic: [_build_sheet_line(bank, e, langs, asked[e.id]) for e in wanted if e.topic == topic]
        for topic in order
    }
    groups = (
        SheetTopic(topic, {lang: bank.topic_title(topic, lang) for lang in langs}, tuple(lines))
        for topic, lines in made.items()
        if lines
    )
    return FormulaSheet(langs, {lang: bank.title(lang) for lang in langs}, tuple(groups))


def cite_formula(bank: Bank, name: str, lang: str) -> tuple[Inline, ...]:
    """Return a line of the sheet for a sentence: number, title, formulas; empty if it has none."""
    for entry in read_formulas(bank):
        if entry.id == name:
            lines = join_inlines(
                [(_typeset_sheet_formula(line, entry),) for line in entry.lines], "; "
            )
            return (
                PlainText(f"{name}, "),
                *entry_inlines(entry, "title", lang),
                PlainText(": "),
                *lines,
            )
    return ()


def _build_sheet_line(
    bank: Bank, entry: FormulaEntry, langs: tuple[str, ...], asked: tuple[str, ...]
) -> SheetFormula:
    """Return one formula with its words in each language, its sketch and who asks for it."""
    lines = tuple(_typeset_sheet_formula(line, entry) for line in entry.lines)
    said = tuple(
        FormulaText(
            lang,
            entry_inlines(entry, "title", lang),
            {name: entry_blocks(entry, name, lang) for name in NOTES if getattr(entry, name)},
            tuple((name, _read_template_title(bank, name, lang)) for name in asked),
        )
        for lang in langs
    )
    figures = draw_sketch(bank, entry, langs)
    return SheetFormula(
        entry.id, entry.section, lines, tuple(_iter_letter_units(entry)), said, figures
    )


def draw_sketch(bank: Bank, entry: FormulaEntry, langs: tuple[str, ...]) -> tuple[Figure, ...]:
    """Return the sketch of a formula in each language; none if it has no sketch.

    Raises
    ------
    BankError
        If there is no such figure, or it cannot be drawn; names the file and the formula.
    """
    wanted = entry.figure
    if wanted is None:
        return ()
    with entry.name_in_errors("figure"):
        figure = bank.figure(wanted.name)
        return tuple(draw_figure(figure, wanted.values, quiz=False, lang=lang) for lang in langs)


def _typeset_sheet_formula(line: str, entry: FormulaEntry) -> TypesetMaths:
    """Return a line of the sheet typeset as one piece."""
    with entry.name_in_errors("lines"):
        signs, parts = parse_formula_line(line, entry.inside)
    node = typeset.relation_chain(signs, [part.node for part in parts])
    return TypesetMaths(node, line)


def _iter_letter_units(entry: FormulaEntry) -> Iterator[Inline]:
    """Yield letters with their unit, those of one unit together: ``f, p′ [mm]; z [m]``."""
    for place, (unit, letters) in enumerate(entry.units.items()):
        if place:
            yield PlainText("; ")
        for index, letter in enumerate(letters):
            if index:
                yield PlainText(", ")
            yield name_inline(letter)
        yield PlainText(f"\u00a0[{unit}]")


def _read_template_title(bank: Bank, name: str, lang: str) -> str:
    """Return the title of a template, in the language or else in one that it is written in."""
    written = bank.template_languages(name)
    found = lang if lang in written else next(iter(written))
    return read_language_file(bank.template_paths[name] / f"{found}.md").title
