"""The sentences that people write about a bank, made ready for printing.

They are Markdown as in templates. Mathematics between dollar signs and the lines of formulas are
written in the grammar that students type.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from quizgen.bank.entries import Entry, Passage
from quizgen.bank.markdown import fill_blocks, fill_inlines, parse_blocks, parse_inlines
from quizgen.bank.metadata import pick_language
from quizgen.core.errors import BankError
from quizgen.question.formula_lines import typeset_inline
from quizgen.typeset.leaves import list_leaf_names
from quizgen.typeset.prose import (
    Block,
    Inline,
    LaidOutFormula,
    PictureLink,
    Slot,
    Unfilled,
    typeset_layout,
)


def entry_blocks(entry: Entry, name: str, lang: str) -> tuple[Block, ...]:
    """Return a passage of an entry as blocks, its mathematics typeset.

    Raises
    ------
    BankError
        Naming file, entry, field, language and column.
    """
    with _iter_field_text(entry, name, lang) as text:
        return fill_blocks(parse_blocks(text), typeset_slot, _refuse_program)


def entry_inlines(entry: Entry, name: str, lang: str) -> tuple[Inline, ...]:
    """Return a sentence of an entry as inlines; otherwise as ``entry_blocks``."""
    with _iter_field_text(entry, name, lang) as text:
        return fill_inlines(parse_inlines(text), typeset_slot)


@contextmanager
def _iter_field_text(entry: Entry, name: str, lang: str) -> Iterator[str]:
    """Yield the text of a field once; an error raised by its reader is located in the entry."""
    texts: Passage = getattr(entry, name)
    with entry.name_in_errors(name, lang):
        try:
            yield pick_language(texts, lang, "")
        except BankError as error:
            error.args = (f"{name}.{lang}: {error.message}",)
            raise


def typeset_slot(part: Unfilled) -> tuple[Inline, ...]:
    """Return the mathematics of a sentence, typeset.

    Raises
    ------
    BankError
        If a blank or a picture stands there.
    """
    if isinstance(part, PictureLink):
        raise BankError(f"picture {part.file!r} cannot stand here, only in the words of a template")
    if isinstance(part, Slot):
        raise BankError(f"{{{{ {part.name} }}}} cannot be filled in here")
    if isinstance(part, LaidOutFormula):
        for name in list_leaf_names(part.node):
            raise BankError(f"{{{{ {name} }}}} cannot be filled in here")
        return (typeset_layout(part.node),)
    return (typeset_inline(part.expr),)


def _refuse_program(text: str) -> str:
    """Raise ``BankError``: an entry draws no numbers that a program could hold."""
    raise BankError(f"program {text!r} cannot stand here")
