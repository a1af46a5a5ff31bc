"""Figure to term: what a picture shows, and how to tell."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from quizgen.cards.content import FigureEntry, entries
from quizgen.cards.kinds._authored import noted
from quizgen.cards.note import Note
from quizgen.cards.prose import Picture
from quizgen.cards.wish import Wish
from quizgen.errors import BankError
from quizgen.figures import draw_figure
from quizgen.question.authored import passage


def notes(wish: Wish) -> Iterator[Note]:
    """One note per figure: the quiz version on the front, the full one on the back."""
    for entry in entries(wish.bank, FigureEntry):
        sides = {
            "Front": {lang: passage(entry, "ask", lang) for lang in wish.langs},
            "Back": {lang: passage(entry, "answer", lang) for lang in wish.langs},
        }
        pictures = {
            "Figure": (_picture(entry, wish, quiz=True),),
            "Answer figure": (_picture(entry, wish, quiz=False),),
        }
        refs = (entry.id, *entry.refs)
        yield replace(noted(wish, entry, "figure", sides, refs), shared=pictures)


def _picture(entry: FigureEntry, wish: Wish, *, quiz: bool) -> Picture:
    try:
        figure = wish.bank.figure(entry.figure)
        drawn = [draw_figure(figure, entry.values, quiz=quiz, lang=lang) for lang in wish.langs]
    except BankError as error:
        raise BankError(f"{entry.place}: {error}") from error
    return Picture(entry.figure, drawn[0], " / ".join(one.alt for one in drawn))
