"""Outputs: one module per format, one table of formats."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module

from quizgen.paper.paper import Paper

KINDS = ("exam", "solutions")

RENDERERS: Mapping[str, str] = {"html": "quizgen.render.html", "pdf": "quizgen.render.pdf"}
"""Format name to the module whose ``render(paper, kind)`` makes it."""


def renderer(name: str) -> Callable[[Paper, str], bytes]:
    """The function that renders a paper in one format."""
    function: Callable[[Paper, str], bytes] = import_module(RENDERERS[name]).render
    return function


def render(paper: Paper, kind: str, output: str) -> bytes:
    """Render a paper.

    Parameters
    ----------
    paper : Paper
    kind : str
        ``exam`` (questions only) or ``solutions``.
    output : str
        A format of ``RENDERERS``.
    """
    return renderer(output)(paper, kind)
