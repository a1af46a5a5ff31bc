"""The application: its routes, and what stands around them."""

from __future__ import annotations

import contextlib
from collections.abc import AsyncIterator
from importlib.resources import files

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp, Receive, Scope, Send

from quizgen.errors import QuizgenError
from quizgen.locale import languages
from quizgen.render.fonts import WEB
from quizgen.web import anki, author, camera, exam, formulas, practice, progress, tradeoff
from quizgen.web.forms import one, posted
from quizgen.web.guard import Guard
from quizgen.web.settings import Settings
from quizgen.web.site import Site
from quizgen.web.views import language_style, page, to

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
        routes=[
            *(*PAGES, *(author.ROUTES if settings.examine else ())),
            Route("/settings", settle, methods=["POST"]),
            Route("/static/languages.css", language_sheet),
            Mount("/static/fonts", StaticFiles(directory=WEB)),
            Mount("/static", StaticFiles(directory=str(files("quizgen.web") / "static"))),
        ],
        middleware=[
            Middleware(Guard, settings=site.settings),
            Middleware(GZipMiddleware, minimum_size=2000, compresslevel=3),
            Middleware(Known, site=site),
        ],
        exception_handlers={HTTPException: refused, QuizgenError: failed},
        lifespan=lifespan,
    )
    app.state.site = site
    return app


class Known:
    """Says who asks.

    Parameters
    ----------
    app : ASGI application
    site : Site
    """

    def __init__(self, app: ASGIApp, site: Site) -> None:
        self.app, self.site = app, site

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Put the learner beside the request."""
        if scope["type"] == "http" and not scope["path"].startswith("/static/"):
            store = self.site.store
            learner = store.remembered() or await run_in_threadpool(store.learner)
            scope.setdefault("state", {})["learner"] = learner
        await self.app(scope, receive, send)


async def settle(request: Request) -> Response:
    """Choose the language, and go back."""
    form = await posted(request)
    lang, back = one(form, "lang"), one(form, "back")
    if lang in languages():
        site: Site = request.app.state.site
        await run_in_threadpool(site.store.settle, request.state.learner.id, {"lang": lang})
    inside = back.startswith("/") and not back.startswith(("//", "/\\"))
    return to(back if inside else "/")


async def language_sheet(_request: Request) -> Response:
    """The style of languages with lines of their own height."""
    return Response(language_style(), media_type="text/css")


async def refused(request: Request, error: Exception) -> Response:
    """A page for what is not there or not allowed."""
    status = error.status_code if isinstance(error, HTTPException) else 500
    name = f"error.{status}" if status in {400, 403, 404, 405, 413} else "error.400"
    return page(request, "message.html.j2", status, title="error.title", text=name)


async def failed(request: Request, error: Exception) -> Response:
    """A page for a template that is wrong; its author reads why."""
    del error
    return page(request, "message.html.j2", 500, title="error.title", text="error.500")
