"""Rows as values."""

from __future__ import annotations

from typing import TypeVar

from sqlalchemy import RowMapping

from quizgen.shapes import converted

T = TypeVar("T")


def value(row: RowMapping, kind: type[T]) -> T:
    """A row as a value; names of columns are a kind of text of their own."""
    return converted({str(name): cell for name, cell in row.items()}, kind)
