"""What a class's examiner has to decide: equal and similar answers together, one decision each."""

from __future__ import annotations

import getpass
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import urlencode

from markupsafe import Markup, escape
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.classes.decide import Agreement, Case, agreement, cases, grouped, waiting, within
from quizgen.classes.folder import ClassFolder
from quizgen.classes.history import History
from quizgen.classes.keys import Keys
from quizgen.classes.rulings import (
    DECIDE,
    SECOND,
    Ruling,
    append_rulings,
    last_words,
    read_rulings,
)
from quizgen.classes.run import mark_class
from quizgen.errors import ClassError, FormulaError
from quizgen.executors import Here
from quizgen.web.forms import every, one, posted
from quizgen.web.site import Site
from quizgen.web.views import lang_of, page, said, to

AT_ONCE = 10
"""Groups on a page."""
PLACE = "/class"


def _folder(request: Request) -> Path:
    site: Site = request.app.state.site
    folder = site.settings.classroom
    assert folder is not None  # noqa: S101 - without it there is no such page
    return folder


def _groups(folder: Path, lang: str, *, second: bool) -> tuple[list[list[Case]], Agreement]:
    """What is still to be decided, or what a second marker has not seen."""
    rulings = read_rulings(folder)
    settled = last_words(rulings, DECIDE).keys()
    seen = last_words(rulings, SECOND).keys()
    marked = list(History(folder).current())
    answers = waiting(marked) + (waiting(marked, decided=True) if second else [])
    wanted = settled - seen if second else {a.group for a in answers} - settled
    mine = [answer for answer in answers if answer.group in wanted]
    found = grouped(cases(mine, Keys(ClassFolder(folder)).key, lang))
    return found, agreement(rulings)


async def queue(request: Request) -> Response:
    """The answers that nobody has decided on."""
    folder, lang = _folder(request), lang_of(request)
    asked = request.query_params
    second = "second" in asked
    groups, agreed = await run_in_threadpool(_groups, folder, lang, second=second)
    return page(
        request,
        "class.html.j2",
        groups=groups[:AT_ONCE],
        left=len(groups),
        agreed=agreed,
        second=second,
        who=asked.get("who") or getpass.getuser(),
        changed=asked.get("changed", ""),
        wrong=asked.get("wrong", ""),
        shown=_shown,
        students=lambda group: sum(case.answer.students for case in group),
    )


def _shown(case: Case) -> Markup:
    """An answer with its key points marked."""
    typed, at, pieces = case.answer.typed, 0, []
    for start, end in case.spots:
        pieces += [escape(typed[at:start]), Markup("<mark>{}</mark>").format(typed[start:end])]
        at = end
    return Markup().join([*pieces, escape(typed[at:])])


async def decide(request: Request) -> Response:
    """Write a decision down, for all answers that were ticked."""
    form = await posted(request)
    folder = _folder(request)
    second = bool(one(form, "second"))
    made = [
        Ruling(
            SECOND if second else DECIDE,
            one(form, "item"),
            one(form, f"answer-{group}"),
            one(form, "points").strip().replace(",", "."),
            who=one(form, "who").strip(),
            comment=one(form, "comment").strip(),
            group=group,
        )
        for group in every(form, "group")
    ]
    who, worth = one(form, "who"), one(form, "worth")
    wrong = _wrong(made, worth)
    if wrong:
        told = said(lang_of(request), f"class.{wrong}", worth=worth)
        return to(_address(who, second=second, wrong=told))
    await run_in_threadpool(append_rulings, folder, made)
    return to(_address(who, second=second))


def _wrong(made: Sequence[Ruling], worth: str) -> str:
    """The name of a sentence: nothing is ticked, or these are no points that can be had."""
    if not made:
        return "unticked"
    try:
        for ruling in made:
            ruling.check()
            within(ruling, worth)
    except (ClassError, FormulaError):
        return "range"
    return "" if all(ruling.value for ruling in made) else "range"


def _address(who: str, *, second: bool, **more: str) -> str:
    asked = {"who": who.strip(), **({"second": "1"} if second else {}), **more}
    return f"{PLACE}?{urlencode(asked)}"


async def mark(request: Request) -> Response:
    """Mark the class anew, with what was decided."""
    form = await posted(request)
    folder = ClassFolder(_folder(request))
    try:
        run = await run_in_threadpool(mark_class, folder, Here(), 1)
    except ClassError as error:
        return to(_address(one(form, "who"), second=False, wrong=str(error)))
    changed = str(len(run.outcome.changes))
    return to(_address(one(form, "who"), second=False, changed=changed))


ROUTES = [
    Route(PLACE, queue),
    Route(f"{PLACE}/decide", decide, methods=["POST"]),
    Route(f"{PLACE}/mark", mark, methods=["POST"]),
]
