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

from quizgen.bank.folder import Bank
from quizgen.bank.levels import EXAM, GUIDED
from quizgen.errors import QuizgenError
from quizgen.figures import clear_alt_words
from quizgen.question.compose import instance, put_into_words
from quizgen.shapes import decoded
from quizgen.web.made import Made, Wanted, made
from quizgen.web.site import Site
from quizgen.web.views import lang_of, page

LEVELS = (EXAM, GUIDED, "transfer")
FOLDERS = ("templates", "solvers")
"""What a bank consists of."""
DIGITS = 9
"""Of a seed."""


@dataclass(frozen=True)
class Preview:
    """A template in all its languages, as the files were when they had this stamp."""

    template: str
    seed: str
    level: str
    stamp: str

    def run(self, bank: Bank) -> bytes:
        """Make it."""
        template = _afresh(bank).template(self.template)
        drawn = instance(template, self.seed)
        found = []
        for lang in template.texts:
            wanted = Wanted(self.template, self.seed, lang, level=self.level)
            found.append(made(wanted, *put_into_words(drawn, lang, level=self.level)))
        return msgspec.json.encode(found)


@dataclass(frozen=True)
class Examined:
    """What is wrong with a template."""

    template: str
    examine: Callable[[Bank, str], list[str]]
    stamp: str

    def run(self, bank: Bank) -> bytes:
        """Find it."""
        return msgspec.json.encode(self.examine(*_afresh(bank).home(self.template)))


def _afresh(bank: Bank) -> Bank:
    """The same bank, its files, solvers, figures and what figures say read again."""
    clear_alt_words()
    return bank.afresh()


def stamp_of(bank: Bank) -> str:
    """What changes when a file of a bank is saved."""
    folders = [part.root / name for part in bank.parts for name in FOLDERS]
    files = sorted(path for folder in folders for path in folder.rglob("*"))
    seen = [
        (str(path), path.stat().st_mtime_ns)
        for path in files
        if path.is_file() and path.suffix != ".pyc"  # written by whoever reads a solver
    ]
    return hashlib.sha256(repr(seen).encode()).hexdigest()[:16]


async def templates(request: Request) -> Response:
    """All templates by topic."""
    site: Site = request.app.state.site
    bank, lang = site.bank.afresh(), lang_of(request)
    found, broken = dict[str, list[tuple[str, str]]](), list[tuple[str, str]]()
    for name in bank.paths:
        try:
            rules = bank.rules(name)
            found.setdefault(rules.topic, []).append((name, rules.tier))
        except QuizgenError as error:
            broken.append((name, str(error)))
    order = [topic for topic in (bank.about.topics or sorted(found)) if topic in found]
    groups = [(bank.topic_title(topic, lang), found[topic]) for topic in order]
    return page(request, "templates.html.j2", groups=groups, broken=broken)


def _name(request: Request) -> str:
    """The template that is asked for; the bank may have got it just now."""
    site: Site = request.app.state.site
    name: str = request.path_params["name"]
    if name not in site.bank.afresh().paths:
        raise HTTPException(404)
    return name


async def template(request: Request) -> Response:
    """A template: its question and solution in all languages."""
    site: Site = request.app.state.site
    name, asked = _name(request), request.query_params
    seed = asked.get("seed", "")
    seed = str(int(seed)) if seed.isascii() and seed.isdecimal() and len(seed) <= DIGITS else "0"
    level = asked.get("level", "") if asked.get("level") in LEVELS else EXAM
    stamp = await run_in_threadpool(stamp_of, site.bank)
    if asked.get("stamp") == stamp:
        return Response(status_code=204)  # nothing was saved: what is shown stays
    shown, wrong = list[Made](), ""
    try:
        data = await site.workers.done(Preview(name, seed, level, stamp))
        shown = decoded(data, list[Made])
    except QuizgenError as error:
        wrong = str(error)
    return page(
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


async def lint(request: Request) -> Response:
    """What is wrong with a template."""
    site: Site = request.app.state.site
    name, examine = _name(request), site.settings.examine
    stamp = await run_in_threadpool(stamp_of, site.bank)
    assert examine is not None  # noqa: S101 - without it there is no such page
    problems: list[str] = decoded(
        await site.workers.done(Examined(name, examine, stamp)), list[str]
    )
    return page(request, "lint.html.j2", name=name, problems=problems)


ROUTES = [
    Route("/author", templates),
    Route("/author/{name}", template),
    Route("/author/{name}/lint", lint),
]
