"""The sentences that people write about a bank, made ready for printing.

They are Markdown as in templates. Mathematics between dollar signs and the lines of formulas are
written in the grammar that students type.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from quizgen.bank.about import in_language
from quizgen.bank.entries import Entry, Passage
from quizgen.bank.prose import (
    Block,
    Inline,
    PictureLink,
    Slot,
    Unfilled,
    blocks,
    fill,
    fill_blocks,
    inlines,
)
from quizgen.errors import BankError
from quizgen.question.equations import inline


def passage(entry: Entry, name: str, lang: str) -> tuple[Block, ...]:
    """A passage of an entry as blocks, its mathematics ready for printing.

    Raises
    ------
    BankError
        Naming file, entry, field, language and column.
    """
    with _at(entry, name, lang) as text:
        return fill_blocks(blocks(text), printed, _no_program)


def sentence(entry: Entry, name: str, lang: str) -> tuple[Inline, ...]:
    """The same as ``passage`` for a sentence, as inlines."""
    with _at(entry, name, lang) as text:
        return fill(inlines(text), printed)


@contextmanager
def _at(entry: Entry, name: str, lang: str) -> Iterator[str]:
    """The text of a field; what is wrong with it is located."""
    texts: Passage = getattr(entry, name)
    try:
        yield in_language(texts, lang, "")
    except BankError as error:
        raise BankError(f"{entry.place}: {name}.{lang}: {error}") from error


def printed(part: Unfilled) -> tuple[Inline, ...]:
    """Mathematics of a sentence, ready for printing.

    Raises
    ------
    BankError
        If a blank or a picture stands there.
    """
    if isinstance(part, PictureLink):
        raise BankError(f"picture {part.file!r} cannot stand here, only in the words of a template")
    if isinstance(part, Slot):
        raise BankError(f"{{{{ {part.name} }}}} cannot be filled in here")
    return (inline(part.expr),)


def _no_program(text: str) -> str:
    raise BankError(f"program {text!r} cannot stand here")
