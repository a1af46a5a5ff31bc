"""Formulas as cloze cards: the right-hand side is hidden, written once and printed for MathJax."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from quizgen import typeset
from quizgen.bank.formulas import FormulaEntry, read_formulas
from quizgen.cards.kinds._entry_note import entry_note
from quizgen.cards.markup import ClozeHole
from quizgen.cards.note import CardWords, Note
from quizgen.cards.request import DeckRequest
from quizgen.question.entry_prose import entry_blocks, entry_inlines
from quizgen.question.formula_lines import parse_formula_line
from quizgen.typeset.nodes import MathRow
from quizgen.typeset.prose import Paragraph, TypesetMaths


def notes(wish: DeckRequest) -> Iterator[Note]:
    """Yield one note per formula; one of several lines hides them together or one by one."""
    for entry in read_formulas(wish.bank):
        said: dict[str, CardWords] = {
            "Title": {
                lang: (Paragraph(entry_inlines(entry, "title", lang)),) for lang in wish.langs
            },
            "Extra": {
                lang: (*entry_blocks(entry, "about", lang), *entry_blocks(entry, "beware", lang))
                for lang in wish.langs
            },
        }
        note = entry_note(wish, entry, "formula", said, (entry.id, *entry.refs))
        yield replace(note, form="cloze", shared={"Text": tuple(_iter_cloze_holes(entry))})


def _iter_cloze_holes(entry: FormulaEntry) -> Iterator[ClozeHole]:
    """Yield the lines of a formula, each with its side to be recalled hidden."""
    for index, line in enumerate(entry.lines):
        with entry.name_in_errors("lines"):
            signs, parts = parse_formula_line(line, entry.inside)
        if not signs:
            raise entry.fault(f"{line!r} has only one side", "QG155", "lines")
        cut = signs.index("⇒") + 1 if "⇒" in signs else 1
        yield ClozeHole(
            _typeset_visible_sides(parts[:cut], signs[:cut]),
            _typeset_hidden_sides(parts[cut:], signs[cut:]),
            index + 1 if entry.separate else 1,
        )


def _typeset_visible_sides(parts: list[TypesetMaths], signs: list[str]) -> TypesetMaths:
    """Return the sides before the hidden one, with the sign after each, as one formula."""
    node = typeset.relation_chain(signs, [*(part.node for part in parts), MathRow(())])
    typed = " ".join(f"{part.typed_text} {sign}" for part, sign in zip(parts, signs, strict=True))
    return TypesetMaths(node, typed)


def _typeset_hidden_sides(parts: list[TypesetMaths], signs: list[str]) -> TypesetMaths:
    """Return the hidden sides with the signs between them, as one formula."""
    if not signs:
        return parts[0]
    pairs = zip(signs, parts[1:], strict=True)
    typed = " ".join([parts[0].typed_text, *(f"{sign} {part.typed_text}" for sign, part in pairs)])
    return TypesetMaths(typeset.relation_chain(signs, [part.node for part in parts]), typed)
