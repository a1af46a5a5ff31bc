"""The formula sheet: a page to read and practise from, and a file to print."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import msgspec
from markupsafe import Markup
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen import typeset
from quizgen.bank.bank import Bank
from quizgen.bank.formulas import MovingName, read_formulas
from quizgen.core.decoding import decode_json
from quizgen.locale import translate
from quizgen.question.formula_sheet import NOTES, FormulaSheet, SheetFormula, compose_sheet
from quizgen.question.html import blocks_to_html, display_to_html, inlines_to_html
from quizgen.render import render_sheet
from quizgen.render.html import sheet_css
from quizgen.typeset.prose import TypesetMaths
from quizgen.web.moving import MovingView, view_formula_figure
from quizgen.web.question_view import Html
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, request_language


class FormulaView(msgspec.Struct, frozen=True):
    """A formula as HTML."""

    id: str
    title: Html
    sketch: Html
    moving: MovingView | None
    lines: list[Html]
    units: Html
    notes: list[tuple[str, Html]]
    """What is said about it, each with its heading."""
    questions: list[tuple[str, str]]
    """Name and title of the templates that ask for it."""
    section: str


class FormulaTopicView(msgspec.Struct, frozen=True):
    """The formulas of one topic."""

    topic: str
    title: str
    formulas: list[FormulaView]


class SheetView(msgspec.Struct, frozen=True):
    """The formulas of a bank in one language."""

    title: str
    groups: list[FormulaTopicView]


@dataclass(frozen=True)
class SheetPageJob:
    """Renders the formula sheet as HTML."""

    lang: str

    def run(self, bank: Bank) -> bytes:
        """Return the sheet as JSON of HTML pieces."""
        moves = {entry.id: entry.moves for entry in read_formulas(bank)}
        return msgspec.json.encode(_build_sheet(compose_sheet(bank, self.lang), moves))


@dataclass(frozen=True)
class SheetFileJob:
    """Renders the formula sheet as PDF."""

    lang: str

    def run(self, bank: Bank) -> bytes:
        """Return the bytes of the PDF."""
        return render_sheet(compose_sheet(bank, self.lang), "pdf")


def _build_sheet(one: FormulaSheet, moves: Mapping[str, MovingName | None]) -> SheetView:
    """Return the sheet in its first language as HTML pieces."""
    lang = one.langs[0]
    groups = [
        FormulaTopicView(
            group.topic,
            group.titles[lang],
            [_build_sheet_formula(line, moves[line.id], lang) for line in group.lines],
        )
        for group in one.groups
    ]
    return SheetView(one.titles[lang], groups)


def _build_sheet_formula(line: SheetFormula, moves: MovingName | None, lang: str) -> FormulaView:
    """Return one formula of the sheet as HTML."""
    said = line.said[0]
    return FormulaView(
        line.id,
        str(inlines_to_html(said.title, lang)),
        line.figures[0].inline_svg.decode() if line.figures else "",
        view_formula_figure(line.id, moves, lang) if moves else None,
        [_render_spoken_line(maths, lang) for maths in line.lines],
        str(inlines_to_html(line.units, lang)),
        [
            (
                translate(lang, f"sheet.{name}"),
                str(blocks_to_html(said.notes[name], lang, tight=True)),
            )
            for name in NOTES
            if name in said.notes
        ],
        list(said.questions),
        translate(lang, "sheet.section", section=line.section) if line.section else "",
    )


def _render_spoken_line(maths: TypesetMaths, lang: str) -> Html:
    """Return a formula as MathML with its speech in the language of the page."""
    aloud = Markup('<math aria-label="{}"').format(typeset.to_speech(maths.node, lang))
    return str(display_to_html(maths, lang)).replace("<math", aloud, 1)


async def show_formulas(request: Request) -> Response:
    """Return the page of all formulas."""
    site: ServerState = request.app.state.site
    if "formulas" not in site.bank.cards:
        return _render_not_found(request)
    data = await site.workers.get_result(SheetPageJob(request_language(request)))
    made = decode_json(data, SheetView)
    words = {
        name: translate(request_language(request), f"sheet.{name}") for name in ("units", "topics")
    }
    return page_response(request, "formulas.html.j2", sheet=made, words=words)


async def download_sheet(request: Request) -> Response:
    """Return the printable formula sheet (PDF)."""
    site: ServerState = request.app.state.site
    if "formulas" not in site.bank.cards:
        return _render_not_found(request)
    data = await site.workers.get_result(SheetFileJob(request_language(request)))
    return Response(data, media_type="application/pdf")


async def show_formula_css(_request: Request) -> Response:
    """Return the style sheet that the page shares with the printable sheet."""
    return Response(sheet_css(), media_type="text/css")


def _render_not_found(request: Request) -> Response:
    """Return the page for a bank without formulas (HTTP 404)."""
    return page_response(request, "message.html.j2", 404, title="error.title", text="error.404")


ROUTES = [
    Route("/formulas", show_formulas),
    Route("/formulas.pdf", download_sheet),
    Route("/static/sheet.css", show_formula_css),
]
