"""The formula sheet: a page to read and practise from, and a file to print."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
from markupsafe import Markup
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen import typeset
from quizgen.bank.folder import Bank
from quizgen.locale import word
from quizgen.question.markup import blocks, display, inline
from quizgen.question.sheet import NOTES, Line, Sheet, sheet
from quizgen.question.shown import Maths
from quizgen.render import render_sheet
from quizgen.render.sheet_html import style
from quizgen.shapes import decoded
from quizgen.web.made import Html
from quizgen.web.site import Site
from quizgen.web.views import lang_of, page


class MadeFormula(msgspec.Struct, frozen=True):
    """A formula as markup."""

    id: str
    title: Html
    sketch: Html
    lines: list[Html]
    units: Html
    notes: list[tuple[str, Html]]
    """What is said about it, each with its heading."""
    questions: list[tuple[str, str]]
    """Name and title of the templates that ask for it."""
    section: str


class MadeGroup(msgspec.Struct, frozen=True):
    """The formulas of a topic."""

    topic: str
    title: str
    formulas: list[MadeFormula]


class MadeSheet(msgspec.Struct, frozen=True):
    """The formulas of a bank in one language."""

    title: str
    groups: list[MadeGroup]


@dataclass(frozen=True)
class SheetPage:
    """The sheet as markup."""

    lang: str

    def run(self, bank: Bank) -> bytes:
        """Make it."""
        return msgspec.json.encode(_made(sheet(bank, self.lang)))


@dataclass(frozen=True)
class SheetFile:
    """The sheet as a PDF file."""

    lang: str

    def run(self, bank: Bank) -> bytes:
        """Make it."""
        return render_sheet(sheet(bank, self.lang), "pdf")


def _made(one: Sheet) -> MadeSheet:
    lang = one.langs[0]
    groups = [
        MadeGroup(group.topic, group.titles[lang], [_formula(line, lang) for line in group.lines])
        for group in one.groups
    ]
    return MadeSheet(one.titles[lang], groups)


def _formula(line: Line, lang: str) -> MadeFormula:
    said = line.said[0]
    return MadeFormula(
        line.id,
        str(inline(said.title, lang)),
        line.figures[0].inline_svg.decode() if line.figures else "",
        [_spoken(maths, lang) for maths in line.lines],
        str(inline(line.units, lang)),
        [
            (word(lang, f"sheet.{name}"), str(blocks(said.notes[name], lang, tight=True)))
            for name in NOTES
            if name in said.notes
        ],
        list(said.questions),
        word(lang, "sheet.section", section=line.section) if line.section else "",
    )


def _spoken(maths: Maths, lang: str) -> Html:
    """A line that is read aloud in the language of the page."""
    aloud = Markup('<math aria-label="{}"').format(typeset.spoken(maths.node, lang))
    return str(display(maths, lang)).replace("<math", aloud, 1)


async def formulas(request: Request) -> Response:
    """All formulas of the chapter."""
    site: Site = request.app.state.site
    if "formulas" not in site.bank.cards:
        return _missing(request)
    data = await site.workers.done(SheetPage(lang_of(request)))
    made = decoded(data, MadeSheet)
    words = {name: word(lang_of(request), f"sheet.{name}") for name in ("units", "topics")}
    return page(request, "formulas.html.j2", sheet=made, words=words)


async def file(request: Request) -> Response:
    """The sheet to print."""
    site: Site = request.app.state.site
    if "formulas" not in site.bank.cards:
        return _missing(request)
    data = await site.workers.done(SheetFile(lang_of(request)))
    return Response(data, media_type="application/pdf")


async def style_sheet(_request: Request) -> Response:
    """The style that the page shares with the sheet as a file."""
    return Response(style(), media_type="text/css")


def _missing(request: Request) -> Response:
    return page(request, "message.html.j2", 404, title="error.title", text="error.404")


ROUTES = [
    Route("/formulas", formulas),
    Route("/formulas.pdf", file),
    Route("/static/sheet.css", style_sheet),
]
