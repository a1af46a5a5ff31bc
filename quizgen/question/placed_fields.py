"""Fields of parts that stand inside a sentence or a cell: which can, and what is around them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from quizgen.kinds.contract import InputControl
from quizgen.question.interpolation import inlines_to_text
from quizgen.typeset.prose import (
    Block,
    Emphasis,
    Inline,
    ListBlock,
    Paragraph,
    PlacedField,
    TableBlock,
)

_SENTENCE = re.compile(r".*[.!?;।]\s", re.DOTALL)
_BREAK = re.compile(r"[.!?;।](?:\s|$)")
_BETWEEN = ": "


def can_be_placed(control: InputControl) -> bool:
    """Return whether a part is answered by one line of text or one option.

    Values without names, such as those of a point, go into one line: ``(3; 4)``.
    """
    if control.form in {"one", "truth"}:
        return True
    text = control.form in {"line", "lines", "gaps"}
    return text and not (control.boxes and control.named) and control.board is None


def iter_placed_fields(blocks: Iterable[Block]) -> Iterator[tuple[str, str]]:
    """Yield the label of each field in blocks and the words around it, which name it.

    In a table these are the first cell of its row and the head of its column, in a sentence the
    words before it, else those after it.
    """
    for block in blocks:
        match block:
            case Paragraph(children):
                yield from _iter_in_sentence(children)
            case ListBlock(items):
                for item in items:
                    yield from iter_placed_fields(item)
            case TableBlock(head, rows):
                for row in (head, *rows):
                    yield from _iter_in_row(head, row)
            case _:
                pass


def _iter_in_row(
    head: Sequence[tuple[Inline, ...]], row: Sequence[tuple[Inline, ...]]
) -> Iterator[tuple[str, str]]:
    """Yield the fields in a row of a table, named by row and column and by their own cell."""
    for column, cell in enumerate(row):
        for label, near in _iter_in_sentence(cell):
            titles = [row[0] if column else (), head[column] if row is not head else ()]
            said = [inlines_to_text(title) for title in titles if title and not _has_field(title)]
            yield label, _BETWEEN.join(filter(None, [*said, near]))


def _has_field(parts: Iterable[Inline]) -> bool:
    """Return whether a field stands among pieces of a sentence."""
    return any(isinstance(piece, PlacedField) for piece in _flatten(parts))


def _iter_in_sentence(parts: Iterable[Inline]) -> Iterator[tuple[str, str]]:
    """Yield the fields of a sentence, each with the words before it, else those after it."""
    texts, fields = [""], list[PlacedField]()
    for piece in _flatten(parts):
        if isinstance(piece, PlacedField):
            fields.append(piece)
            texts.append("")
        else:
            texts[-1] += inlines_to_text((piece,))
    for field, (before, after) in zip(fields, pairwise(texts), strict=True):
        lead = _SENTENCE.sub("", before).strip(" ,:\u00a0")
        yield field.label, lead or _BREAK.split(after)[0].strip(" ,:\u00a0")


def _flatten(parts: Iterable[Inline]) -> Iterator[Inline]:
    """Yield pieces of a sentence without their emphasis."""
    for part in parts:
        if isinstance(part, Emphasis):
            yield from _flatten(part.children)
        else:
            yield part
