"""What every printer shares: a rule for each kind of node, and tables that refuse strangers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from quizgen.errors import RenderError
from quizgen.typeset import nodes as n

KINDS = (
    n.Number,
    n.Ident,
    n.Word,
    n.Text,
    n.Unit,
    n.Op,
    n.Row,
    n.Quantity,
    n.Frac,
    n.Root,
    n.Scripts,
    n.Accent,
    n.Fence,
    n.Func,
    n.Big,
    n.Under,
    n.Cases,
    n.Matrix,
)
"""Every kind of layout node."""

Rule = Callable[[Any, str], str]

V = TypeVar("V")


def printer(medium: str, functions: Mapping[str, Any]) -> Rule:
    """Collect the rules of one medium: ``_frac`` for ``Frac``, and so on for every kind.

    Parameters
    ----------
    medium : str
        Its name, for errors.
    functions : mapping
        Names to functions: the globals of the module. A kind without a rule is a ``KeyError`` when
        the module is loaded.
    """
    rules = {kind: functions[f"_{kind.__name__.lower()}"] for kind in KINDS}

    def emit(node: n.Node, lang: str) -> str:
        rule: Rule | None = rules.get(type(node))
        if rule is None:
            raise RenderError(f"no {medium} for {type(node).__name__}")
        return rule(node, lang)

    return emit


def known(medium: str) -> Callable[[Mapping[str, V], str, str], V]:
    """Look-up in a medium's tables that names what it does not know."""

    def look_up(table: Mapping[str, V], key: str, what: str) -> V:
        try:
            return table[key]
        except KeyError:
            raise RenderError(f"no {medium} for the {what} {key!r}") from None

    return look_up
