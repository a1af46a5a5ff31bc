"""For authors: every template with its solution, read again whenever a file is saved."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.bank import Bank
from quizgen.bank.levels import EXAM, GUIDED
from quizgen.core.decoding import decode_json
from quizgen.core.errors import QuizgenError
from quizgen.figures import clear_alt_words
from quizgen.question.compose import compose_variant, draw_instance
from quizgen.web.question_view import QuestionRequest, QuestionView, question_view
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, request_language

LEVELS = (EXAM, GUIDED, "transfer")
FOLDERS = ("templates", "solvers")
"""What a bank consists of."""
DIGITS = 9
"""Of a seed."""


@dataclass(frozen=True)
class PreviewJob:
    """Renders a template in all its languages; ``stamp`` is that of the bank's files."""

    template: str
    seed: str
    level: str
    stamp: str

    def run(self, bank: Bank) -> bytes:
        """Return the rendered questions as JSON."""
        template = _reload_bank(bank).template(self.template)
        drawn = draw_instance(template, self.seed)
        found = []
        for lang in template.texts:
            wanted = QuestionRequest(self.template, self.seed, lang, level=self.level)
            found.append(question_view(wanted, *compose_variant(drawn, lang, level=self.level)))
        return msgspec.json.encode(found)


@dataclass(frozen=True)
class LintJob:
    """Checks a template; ``stamp`` is that of the bank's files, so a saved file makes a new job."""

    template: str
    examine: Callable[[Bank, str], list[str]]
    stamp: str

    def run(self, bank: Bank) -> bytes:
        """Return the messages as JSON."""
        return msgspec.json.encode(self.examine(*_reload_bank(bank).owner_of(self.template)))


def _reload_bank(bank: Bank) -> Bank:
    """Return the bank with files, solvers and figures read again."""
    clear_alt_words()
    return bank.reload()


def bank_stamp(bank: Bank) -> str:
    """Return a digest of paths and times of the bank's files: it changes when one is saved."""
    folders = [part.root / name for part in bank.members for name in FOLDERS]
    files = sorted(path for folder in folders for path in folder.rglob("*"))
    seen = [
        (str(path), path.stat().st_mtime_ns)
        for path in files
        if path.is_file() and path.suffix != ".pyc"  # written when a solver is read
    ]
    return hashlib.sha256(repr(seen).encode()).hexdigest()[:16]


async def list_templates(request: Request) -> Response:
    """Return the page of all templates by topic, with those that cannot be read."""
    site: ServerState = request.app.state.site
    bank, lang = site.bank.reload(), request_language(request)
    found, broken = dict[str, list[tuple[str, str]]](), list[tuple[str, str]]()
    for name in bank.template_paths:
        try:
            rules = bank.rules(name)
            found.setdefault(rules.topic, []).append((name, rules.tier))
        except QuizgenError as error:
            broken.append((name, str(error)))
    order = [topic for topic in (bank.metadata.topics or sorted(found)) if topic in found]
    groups = [(bank.topic_title(topic, lang), found[topic]) for topic in order]
    return page_response(request, "templates.html.j2", groups=groups, broken=broken)


def _get_requested_template(request: Request) -> str:
    """Return the name of the template requested; HTTP 404 if the bank has none.

    The bank is read again, since the template may be new.
    """
    site: ServerState = request.app.state.site
    name: str = request.path_params["name"]
    if name not in site.bank.reload().template_paths:
        raise HTTPException(404)
    return name


async def show_template(request: Request) -> Response:
    """Return the preview of a template in all languages; HTTP 204 if nothing was saved since."""
    site: ServerState = request.app.state.site
    name, asked = _get_requested_template(request), request.query_params
    seed = asked.get("seed", "")
    seed = str(int(seed)) if seed.isascii() and seed.isdecimal() and len(seed) <= DIGITS else "0"
    level = asked.get("level", "") if asked.get("level") in LEVELS else EXAM
    stamp = await run_in_threadpool(bank_stamp, site.bank)
    if asked.get("stamp") == stamp:
        return Response(status_code=204)  # nothing was saved: what is shown stays
    shown, wrong = list[QuestionView](), ""
    try:
        data = await site.workers.get_result(PreviewJob(name, seed, level, stamp))
        shown = decode_json(data, list[QuestionView])
    except QuizgenError as error:
        wrong = str(error)
    return page_response(
        request,
        "template.html.j2",
        name=name,
        seed=int(seed),
        level=level,
        levels=LEVELS,
        stamp=stamp,
        shown=shown,
        wrong=wrong,
    )


async def lint_template_page(request: Request) -> Response:
    """Return the page of what is wrong with a template."""
    site: ServerState = request.app.state.site
    name, examine = _get_requested_template(request), site.settings.examine
    stamp = await run_in_threadpool(bank_stamp, site.bank)
    assert examine is not None  # noqa: S101 - without it there is no such page
    problems: list[str] = decode_json(
        await site.workers.get_result(LintJob(name, examine, stamp)), list[str]
    )
    return page_response(request, "lint.html.j2", name=name, problems=problems)


ROUTES = [
    Route("/author", list_templates),
    Route("/author/{name}", show_template),
    Route("/author/{name}/lint", lint_template_page),
]
