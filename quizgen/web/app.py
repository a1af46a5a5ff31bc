"""The application: its routes, and what stands around them."""

from __future__ import annotations

import asyncio
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

from quizgen.core.errors import QuizgenError
from quizgen.grading.options import DECIMALS
from quizgen.render.fonts import WEB
from quizgen.web import (
    accounts,
    author,
    camera,
    error_cards,
    exam,
    formula_sheet,
    practice,
    progress,
    questions,
    task_pictures,
    tradeoff,
)
from quizgen.web.auth import AuthMiddleware
from quizgen.web.event_log import find_cause
from quizgen.web.exam import GoneError
from quizgen.web.forms import field_text, read_form
from quizgen.web.security import SecurityMiddleware
from quizgen.web.settings import ServerSettings
from quizgen.web.state import QuotaError, ServerState
from quizgen.web.views import page_language_css, page_response, redirect, safe_redirect_target

PAGES = (*practice.ROUTES, *exam.ROUTES, *progress.ROUTES, *formula_sheet.ROUTES, *camera.ROUTES,
         *error_cards.ROUTES, *tradeoff.ROUTES, *questions.ROUTES,
         *task_pictures.ROUTES)  # fmt: skip


def create_app(settings: ServerSettings) -> Starlette:
    """Return the web application, with its database open.

    Parameters
    ----------
    settings : ServerSettings

    Raises
    ------
    BankError, StoreError
        If the bank or the database cannot be opened.
    """
    site = ServerState(settings)

    @contextlib.asynccontextmanager
    async def lifespan(_app: Starlette) -> AsyncIterator[None]:
        """Start the workers before the first request, and close everything after the last."""
        try:
            site.workers.warm()
            attaching = asyncio.ensure_future(site.papers.attach_all())
            filling = asyncio.ensure_future(site.papers_ahead.fill_always())
            sitting = [] if site.room is None else [
                asyncio.ensure_future(one)
                for one in (site.room.make_all_papers(), site.room.watch())
            ]  # fmt: skip
            yield
            for task in (attaching, filling, *sitting):
                task.cancel()
        finally:
            site.close()

    app = Starlette(
        routes=_build_routes(settings),
        middleware=[
            Middleware(SecurityMiddleware, settings=site.settings),
            Middleware(GZipMiddleware, minimum_size=2000, compresslevel=3),
            Middleware(AuthMiddleware, site=site),
            *_load_class_exam_middleware(site),
        ],
        exception_handlers={
            HTTPException: handle_http_error,
            SQLAlchemyError: handle_store_error,
            QuizgenError: handle_bank_error,
        },
        lifespan=lifespan,
    )
    app.state.site = site
    return app


def _build_routes(settings: ServerSettings) -> list[BaseRoute]:
    """Return the routes; those for authors, classes and accounts only where they are in use."""
    common = [
        Route("/settings", set_language, methods=["POST"]),
        Route("/static/languages.css", serve_language_css),
        Mount("/static/fonts", StaticFiles(directory=WEB)),
        *(
            Mount(f"/static/{name}", StaticFiles(directory=str(files("quizgen.render") / name)))
            for name in ("board", "look")
        ),
        Mount("/static", StaticFiles(directory=str(files("quizgen.web") / "static"))),
    ]
    if settings.class_exam:
        return [*_load_class_exam_routes(), *exam.SITTING_ROUTES, *accounts.ROUTES, *common]
    return [
        *PAGES,
        *(author.ROUTES if settings.examine else ()),
        *(_load_classroom_routes() if settings.classroom else ()),
        *(accounts.ROUTES if settings.accounts else ()),
        *(_load_phone_routes() if settings.phone else ()),
        *common,
    ]


def _load_class_exam_routes() -> list[Route]:
    """Return the pages of a class that sits its exam, imported only where one does."""
    from quizgen.web import class_exam, class_live

    return [*class_exam.ROUTES, *class_live.ROUTES]


def _load_class_exam_middleware(site: ServerState) -> list[Middleware]:
    """Return what stands before these pages."""
    if site.room is None:
        return []
    from quizgen.web.class_exam import ClassExamMiddleware

    return [Middleware(ClassExamMiddleware, room=site.room)]


def _load_phone_routes() -> list[Route]:
    """Return the pages for going on with a phone, imported only where one may come."""
    from quizgen.web import phone

    return phone.ROUTES


def _load_classroom_routes() -> list[Route]:
    """Return the pages for marking a class, imported only where there is one."""
    from quizgen.web import marking

    return marking.ROUTES


async def set_language(request: Request) -> Response:
    """Store the learner's language or decimal sign, and redirect to the page they came from."""
    form = await read_form(request)
    lang = field_text(form, "lang")
    site: ServerState = request.app.state.site
    if lang in site.languages:
        await run_in_threadpool(
            site.store.update_settings, request.state.learner.id, {"lang": lang}
        )
    decimal = field_text(form, "decimal")
    if decimal in DECIMALS:
        await run_in_threadpool(
            site.store.update_settings, request.state.learner.id, {"decimal": decimal}
        )
    return redirect(safe_redirect_target(field_text(form, "back")))


async def serve_language_css(_request: Request) -> Response:
    """Return the style sheet of languages that need another line height."""
    return Response(page_language_css(), media_type="text/css")


async def handle_http_error(request: Request, error: Exception) -> Response:
    """Return the error page of an HTTP status, in the learner's language."""
    status = error.status_code if isinstance(error, HTTPException) else 500
    name = f"error.{status}" if status in {400, 403, 404, 405, 410, 413, 429} else "error.400"
    if isinstance(error, GoneError):
        name = "exam.gone"
    if isinstance(error, QuotaError):
        name = "error.quota"
    if not hasattr(request.state, "learner"):  # a style or a picture that is not there
        return PlainTextResponse(str(status), status)
    answer = page_response(request, "message.html.j2", status, title="error.title", text=name)
    answer.headers.update(getattr(error, "headers", None) or {})
    return answer


async def handle_store_error(request: Request, error: Exception) -> Response:
    """Return the page for a database that does not answer (HTTP 503)."""
    return _render_failure_page(request, error, 503, "error.503")


async def handle_bank_error(request: Request, error: Exception) -> Response:
    """Return the page for a faulty template (HTTP 500); authors see the message."""
    site: ServerState = request.app.state.site
    wrong = str(error) if site.settings.examine else ""
    return _render_failure_page(request, error, 500, "error.500", wrong)


def _render_failure_page(
    request: Request, error: Exception, status: int, text: str, wrong: str = ""
) -> Response:
    """Return an error page with the request's id, and record the cause for the log."""
    request.state.cause = find_cause(error)
    return page_response(
        request,
        "message.html.j2",
        status,
        title="error.title",
        text=text,
        wrong=wrong,
        number=request.state.request_id,
    )
