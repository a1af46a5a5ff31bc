"""Formulas as cloze cards: the right-hand side is hidden, written once and printed for MathJax."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from quizgen import typeset
from quizgen.bank.formulas import FormulaEntry, formulas
from quizgen.bank.prose import Paragraph
from quizgen.cards.kinds._authored import noted
from quizgen.cards.note import Note, Words
from quizgen.cards.prose import Hole
from quizgen.cards.wish import Wish
from quizgen.errors import BankError
from quizgen.question.authored import passage, sentence
from quizgen.question.equations import sides
from quizgen.question.shown import Maths
from quizgen.typeset.nodes import Row


def notes(wish: Wish) -> Iterator[Note]:
    """One note per formula; a formula of several lines hides them together or one by one."""
    for entry in formulas(wish.bank):
        said: dict[str, Words] = {
            "Title": {lang: (Paragraph(sentence(entry, "title", lang)),) for lang in wish.langs},
            "Extra": {
                lang: (*passage(entry, "about", lang), *passage(entry, "beware", lang))
                for lang in wish.langs
            },
        }
        note = noted(wish, entry, "formula", said, (entry.id, *entry.refs))
        yield replace(note, form="cloze", shared={"Text": tuple(_holes(entry))})


def _holes(entry: FormulaEntry) -> Iterator[Hole]:
    for index, line in enumerate(entry.lines):
        signs, parts = sides(line, entry.inside, entry.place)
        if not signs:
            raise BankError(f"{entry.place}: {line!r} has only one side")
        cut = signs.index("⇒") + 1 if "⇒" in signs else 1
        yield Hole(
            _shown(parts[:cut], signs[:cut]),
            _joined(parts[cut:], signs[cut:]),
            index + 1 if entry.separate else 1,
        )


def _shown(parts: list[Maths], signs: list[str]) -> Maths:
    """The sides before the hidden one, with the sign after each."""
    node = typeset.relation(signs, [*(part.node for part in parts), Row(())])
    typed = " ".join(f"{part.typed} {sign}" for part, sign in zip(parts, signs, strict=True))
    return Maths(node, typed)


def _joined(parts: list[Maths], signs: list[str]) -> Maths:
    if not signs:
        return parts[0]
    pairs = zip(signs, parts[1:], strict=True)
    typed = " ".join([parts[0].typed, *(f"{sign} {part.typed}" for sign, part in pairs)])
    return Maths(typeset.relation(signs, [part.node for part in parts]), typed)
