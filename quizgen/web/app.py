"""The application: its routes, and what stands around them."""

from __future__ import annotations

import contextlib
from collections.abc import AsyncIterator
from importlib.resources import files

from sqlalchemy.exc import SQLAlchemyError
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import BaseRoute, Mount, Route
from starlette.staticfiles import StaticFiles

from quizgen.errors import QuizgenError
from quizgen.render.fonts import WEB
from quizgen.web import (
    accounts,
    anki,
    author,
    camera,
    exam,
    formulas,
    practice,
    progress,
    tradeoff,
)
from quizgen.web.door import Door
from quizgen.web.forms import one, posted
from quizgen.web.guard import Guard
from quizgen.web.settings import Settings
from quizgen.web.site import Site
from quizgen.web.views import inside, language_style, page, to

PAGES = (*practice.ROUTES, *exam.ROUTES, *progress.ROUTES, *formulas.ROUTES, *camera.ROUTES,
         *anki.ROUTES, *tradeoff.ROUTES)  # fmt: skip


def application(settings: Settings) -> Starlette:
    """The application.

    Parameters
    ----------
    settings : Settings

    Raises
    ------
    BankError, StoreError
        If the bank or the database cannot be opened.
    """
    site = Site(settings)

    @contextlib.asynccontextmanager
    async def lifespan(_app: Starlette) -> AsyncIterator[None]:
        try:
            site.workers.warm()
            yield
        finally:
            site.close()

    app = Starlette(
        routes=_routes(settings),
        middleware=[
            Middleware(Guard, settings=site.settings),
            Middleware(GZipMiddleware, minimum_size=2000, compresslevel=3),
            Middleware(Door, site=site),
        ],
        exception_handlers={
            HTTPException: refused,
            SQLAlchemyError: unreachable,
            QuizgenError: failed,
        },
        lifespan=lifespan,
    )
    app.state.site = site
    return app


def _routes(settings: Settings) -> list[BaseRoute]:
    return [
        *PAGES,
        *(author.ROUTES if settings.examine else ()),
        *(_classroom() if settings.classroom else ()),
        *(accounts.ROUTES if settings.accounts else ()),
        Route("/settings", settle, methods=["POST"]),
        Route("/static/languages.css", language_sheet),
        Mount("/static/fonts", StaticFiles(directory=WEB)),
        Mount("/static/board", StaticFiles(directory=str(files("quizgen.render") / "board"))),
        Mount("/static", StaticFiles(directory=str(files("quizgen.web") / "static"))),
    ]


def _classroom() -> list[Route]:
    """Pages for who marks a class; they load what nobody else waits for."""
    from quizgen.web import classroom

    return classroom.ROUTES


async def settle(request: Request) -> Response:
    """Choose the language, and go back."""
    form = await posted(request)
    lang = one(form, "lang")
    site: Site = request.app.state.site
    if lang in site.languages:
        await run_in_threadpool(site.store.settle, request.state.learner.id, {"lang": lang})
    return to(inside(one(form, "back")))


async def language_sheet(_request: Request) -> Response:
    """The style of languages with lines of their own height."""
    return Response(language_style(), media_type="text/css")


async def refused(request: Request, error: Exception) -> Response:
    """A page for what is not there or not allowed."""
    status = error.status_code if isinstance(error, HTTPException) else 500
    name = f"error.{status}" if status in {400, 403, 404, 405, 410, 413, 429} else "error.400"
    if not hasattr(request.state, "learner"):  # a style or a picture that is not there
        return PlainTextResponse(str(status), status)
    return page(request, "message.html.j2", status, title="error.title", text=name)


async def unreachable(request: Request, error: Exception) -> Response:
    """A page for a database that does not answer."""
    del error
    return page(request, "message.html.j2", 503, title="error.title", text="error.503")


async def failed(request: Request, error: Exception) -> Response:
    """A page for a template that is wrong; authors are told what is."""
    site: Site = request.app.state.site
    wrong = str(error) if site.settings.examine else ""
    return page(request, "message.html.j2", 500, title="error.title", text="error.500", wrong=wrong)
