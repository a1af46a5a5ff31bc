"""What faults were counted from: code and templates by their digests, so that stale counts show."""

from __future__ import annotations

import ast
import hashlib
from dataclasses import dataclass
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import TypeGuard

from quizgen.bank.folder import Bank

CODE = {
    "number systems": ("maths",),
    "marking": ("marking", "question/kinds"),
    "comparison": ("tradeoff/solving.py",),
}
"""Parts of the engine that decide what is counted; solvers belong to their templates."""


@dataclass(frozen=True)
class Basis:
    """Digests of the parts in ``CODE``, and of every template with its solver."""

    code: dict[str, str]
    templates: dict[str, str]


def basis(bank: Bank) -> Basis:
    """What counts over a bank follow from."""
    code = {name: _digest(places) for name, places in CODE.items()}
    templates = {name: bank.template(name).digest[:16] for name in bank.paths}
    return Basis(code, templates)


def _digest(places: tuple[str, ...]) -> str:
    found = [text for place in places for text in _sources(files("quizgen").joinpath(place))]
    return hashlib.sha256("\n".join(map(meaning, found)).encode()).hexdigest()[:16]


def _sources(place: Traversable) -> list[str]:
    """Every module of a folder, or the one module."""
    if place.is_dir():
        inner = sorted(place.iterdir(), key=lambda one: one.name)
        return [text for one in inner for text in _sources(one)]
    return [place.read_text("utf-8")] if place.name.endswith(".py") else []


def meaning(source: str) -> str:
    """A module without lines of comments, blank ones and docstrings: these make nothing stale."""
    texts = [node for node in ast.walk(ast.parse(source)) if _is_text(node)]
    said = {n for node in texts for n in range(node.lineno, (node.end_lineno or 0) + 1)}
    lines = enumerate(source.splitlines(), 1)
    kept = [line for n, line in lines if n not in said and line.lstrip()[:1] not in {"", "#"}]
    return "\n".join(kept)


def _is_text(node: ast.AST) -> TypeGuard[ast.Expr]:
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )
