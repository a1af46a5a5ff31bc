"""Figure to term: what a picture shows, and how to tell."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from quizgen.cards.content import FigureEntry, read_card_entries
from quizgen.cards.kinds._entry_note import entry_note
from quizgen.cards.markup import CardPicture
from quizgen.cards.note import Note
from quizgen.cards.request import DeckRequest
from quizgen.figures import draw_figure
from quizgen.question.entry_prose import entry_blocks


def notes(wish: DeckRequest) -> Iterator[Note]:
    """Yield one note per figure: without labels on the front, with them on the back."""
    for entry in read_card_entries(wish.bank, FigureEntry):
        sides = {
            "Front": {lang: entry_blocks(entry, "ask", lang) for lang in wish.langs},
            "Back": {lang: entry_blocks(entry, "answer", lang) for lang in wish.langs},
        }
        pictures = {
            "Figure": (_draw_entry_picture(entry, wish, quiz=True),),
            "Answer figure": (_draw_entry_picture(entry, wish, quiz=False),),
        }
        refs = (entry.id, *entry.refs)
        yield replace(entry_note(wish, entry, "figure", sides, refs), shared=pictures)


def _draw_entry_picture(entry: FigureEntry, wish: DeckRequest, *, quiz: bool) -> CardPicture:
    """Return the picture of an entry; ``quiz`` hides what is asked."""
    with entry.name_in_errors("figure"):
        figure = wish.bank.figure(entry.figure)
        drawn = [draw_figure(figure, entry.values, quiz=quiz, lang=lang) for lang in wish.langs]
    return CardPicture(entry.figure, drawn[0], " / ".join(one.alt for one in drawn))
