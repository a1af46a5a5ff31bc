"""The syntax of the product's files, for tests of how it is written: each is parsed once."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path


@cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    """All nodes of a file, the module first."""
    return tuple(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))


@cache
def constants(path: Path) -> frozenset[object]:
    """Texts, numbers and the like of a program."""
    return frozenset(node.value for node in nodes(path) if isinstance(node, ast.Constant))
