"""Joining conditions, in every number system whose relations give Python's true and false."""

from __future__ import annotations


def logical_and(a: object, b: object) -> bool:
    """Whether both conditions hold."""
    return bool(a and b)


def logical_or(a: object, b: object) -> bool:
    """Whether one of the conditions holds."""
    return bool(a or b)
