"""Outputs of papers: one module per format, each with ``render(paper, kind)``.

The formula sheet has ``sheet_pdf`` for itself.

In: a ``Paper`` or a ``Sheet``. Out: the bytes of a file. Must never know: how a paper was chosen,
drawn or marked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from quizgen.core.errors import require_one_of

if TYPE_CHECKING:
    from quizgen.paper.paper import Paper
    from quizgen.question.formula_sheet import FormulaSheet

KINDS = ("exam", "solutions")
"""What a file shows: the questions alone, or with worked solutions."""

RENDERERS = ("html", "pdf")
"""The formats of papers there are."""

SHEET_FORMATS = ("html", "pdf")
"""Those of the formula sheet."""


class Renderer(Protocol):
    """A function that renders papers in one format; each format's module has one."""

    def __call__(self, paper: Paper, kind: str) -> bytes:
        """Return a whole file; the same paper gives the same bytes on any day and machine."""
        ...


def load_renderer(output: str) -> Renderer:
    """Return the function that renders a paper in one format, imported when first needed.

    Raises
    ------
    InvalidChoiceError
        Naming the formats there are.
    """
    match require_one_of("format", output, RENDERERS):
        case "pdf":
            from quizgen.render import pdf

            return pdf.render_paper_pdf
        case _:
            from quizgen.render import html

            return html.render_paper_html


def render_paper(paper: Paper, kind: str, output: str) -> bytes:
    """Return the file of a paper in one format.

    Parameters
    ----------
    paper : Paper
    kind : str
        ``exam`` (questions only) or ``solutions``.
    output : str
        One of ``RENDERERS``.

    Raises
    ------
    InvalidChoiceError
        If there is no such kind or format.
    RenderError
        If the output cannot be made.
    """
    return load_renderer(output)(paper, require_one_of("kind", kind, KINDS))


def render_sheet(sheet: FormulaSheet, output: str) -> bytes:
    """Return the file of a formula sheet in one of ``SHEET_FORMATS``.

    Raises
    ------
    InvalidChoiceError
        If there is no such format.
    RenderError
        If the output cannot be made.
    """
    match require_one_of("format", output, SHEET_FORMATS):
        case "pdf":
            from quizgen.render import sheet_pdf

            return sheet_pdf.render_sheet_pdf(sheet)
        case _:
            from quizgen.render import html

            return html.render_sheet_html(sheet)
