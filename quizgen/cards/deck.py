"""From a wish (languages, topics, kinds, seed) to a deck of notes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.qualified_names import qualify_names
from quizgen.cards.kinds import KINDS, QUESTION
from quizgen.cards.note import Note
from quizgen.cards.request import SEED, DeckRequest
from quizgen.cards.versions import note_version
from quizgen.core.errors import BankError
from quizgen.core.executor import map_ordered, open_executor


@dataclass(frozen=True)
class Deck:
    """A deck: its notes in the order in which they are to be learnt.

    Parameters
    ----------
    notes : tuple of Note
    wish : Wish
        What was asked for.
    """

    notes: tuple[Note, ...]
    wish: DeckRequest

    @property
    def card_count(self) -> int:
        """The number of cards that the notes give."""
        return sum(len(note.cards()) for note in self.notes)

    @cached_property
    def media(self) -> Mapping[str, bytes]:
        """The content of each media file by its name, each once."""
        return {name: data for note in self.notes for name, data in note.media().items()}


def build_deck(
    lang: str = "en",
    *,
    topics: tuple[str, ...] = (),
    kinds: tuple[str, ...] = (),
    seed: int = SEED,
    bank: Bank | None = None,
    jobs: int = 1,
) -> Deck:
    """Return the deck of a bank in a language.

    Parameters
    ----------
    lang : str
        A language, or ``both`` for all of them.
    topics, kinds : tuple of str
        Only these; all if empty.
    seed : int
        Fixes the numbers of the worked questions.
    bank : Bank, optional
        Where content and questions come from; the built-in bank if left out.
    jobs : int
        Processes that share the work; the deck is the same for any number.

    Raises
    ------
    BankError
        If a topic or a kind is unknown, or content is wrong.
    """
    bank = builtin_bank() if bank is None else bank
    _check_names(topics, bank.topics, "topic")
    _check_names(kinds, tuple(KINDS), "kind")
    wish = DeckRequest(bank.resolve_languages(lang), topics, seed, bank)
    return Deck(tuple(_make_all_notes(wish, kinds or tuple(KINDS), jobs)), wish)


def _check_names(names: tuple[str, ...], allowed: tuple[str, ...], what: str) -> None:
    """Raise ``BankError`` for the first name that is not allowed; ``what`` is a topic or a kind."""
    for name in names:
        if name not in allowed:
            raise BankError(f"unknown {what} {name!r} (there are {', '.join(allowed)})")


def _make_all_notes(wish: DeckRequest, kinds: tuple[str, ...], jobs: int) -> Iterator[Note]:
    """Yield the notes of the kinds in order, made in ``jobs`` processes."""
    banks = {part: replace(wish, bank=part) for part in wish.bank.members}
    pieces = [
        (kind, piece)
        for kind in KINDS
        if kind in kinds
        for own in banks.values()
        for piece in _split_request(kind, own)
    ]
    made: dict[str, dict[Bank, list[Note]]] = {kind: {part: [] for part in banks} for kind in KINDS}
    with open_executor(jobs) as (executor, ahead):
        results = map_ordered(executor, _make_notes, pieces, ahead)
        for (kind, piece), notes in zip(pieces, results, strict=True):
            made[kind][piece.bank] += notes
    for found in made.values():
        keys = qualify_names({part: [note.key for note in notes] for part, notes in found.items()})
        for part, notes in found.items():
            for note in notes:
                if wish.includes_topic(note.topic):
                    yield replace(
                        note,
                        key=keys[part][note.key],
                        version=note_version(note, part),
                        columns=banks[part].columns,
                    )


def _split_request(kind: str, wish: DeckRequest) -> Iterator[DeckRequest]:
    """Yield requests that can be worked on apart: worked questions template by template."""
    if kind != QUESTION:
        yield wish
        return
    for name in wish.bank.template_paths:
        yield replace(wish, templates=(name,))


def _make_notes(piece: tuple[str, DeckRequest]) -> list[Note]:
    """Return the notes of one kind for one request; runs in a worker process."""
    kind, wish = piece
    return [*KINDS[kind](wish)]
