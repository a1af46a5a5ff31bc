"""Rows as values."""

from __future__ import annotations

from typing import TypeVar

import msgspec
from sqlalchemy import RowMapping

T = TypeVar("T")


def value(row: RowMapping, kind: type[T]) -> T:
    """A row as a value; names of columns are a kind of text of their own."""
    return msgspec.convert({str(name): cell for name, cell in row.items()}, kind)
