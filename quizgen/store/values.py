"""Rows as values."""

from __future__ import annotations

from typing import TypeVar

from sqlalchemy import RowMapping

from quizgen.core.decoding import convert

T = TypeVar("T")


def row_to_record(row: RowMapping, kind: type[T]) -> T:
    """A row as a value; names of columns are a kind of text of their own."""
    return convert({str(name): cell for name, cell in row.items()}, kind)
