"""The one table of answer kinds: a module each, with ``Spec``, ``check`` and ``show``."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from types import ModuleType

KINDS = {
    "number": "number",
    "quantity": "quantity",
    "angle": "angle",
    "point": "point",
    "table": "table",
    "set": "sets",
    "interval": "interval",
    "expression": "expression",
    "choice": "choice",
    "multi": "choice",
    "tf": "choice",
    "match": "match",
    "order": "order",
    "gap": "gap",
    "witness": "witness",
    "code": "code",
    "text": "text",
}
"""Kind to the module in this folder."""


@cache
def kind_module(kind: str) -> ModuleType:
    """Import the module of a kind on first use."""
    return import_module(f"quizgen.marking.kinds.{KINDS[kind]}")
