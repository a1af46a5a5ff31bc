"""What a class's examiner has to decide: equal and similar answers together, one decision each."""

from __future__ import annotations

import getpass
from collections.abc import Sequence
from contextlib import suppress
from fractions import Fraction
from pathlib import Path
from urllib.parse import urlencode

from markupsafe import Markup, escape
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.grading_run import grade_class
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.manual_grading import (
    Agreement,
    DecisionCase,
    check_points,
    decision_cases,
    group_cases,
    marker_agreement,
    undecided_answers,
)
from quizgen.classes.rulings import (
    DECIDE,
    SECOND,
    Ruling,
    append_rulings,
    latest_rulings,
    read_rulings,
)
from quizgen.core.errors import ClassError, FormulaError
from quizgen.core.executor import InlineExecutor
from quizgen.maths.numbers import parse_written_number
from quizgen.paper.grading import round_to_quarters
from quizgen.web.forms import field_text, field_texts, read_form
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, redirect, request_language, translate_page

AT_ONCE = 10
"""Groups on a page."""
PLACE = "/class"


def _get_class_folder(request: Request) -> Path:
    """Return the folder of the class that the server was started with."""
    site: ServerState = request.app.state.site
    folder = site.settings.classroom
    assert folder is not None  # noqa: S101 - without it there is no such page
    return folder


def _build_answer_groups(
    folder: Path, lang: str, *, second: bool
) -> tuple[list[list[DecisionCase]], Agreement]:
    """Return the undecided answers in groups, and the agreement of the markers.

    ``second``: those that the first marker has decided and a second one has not seen.
    """
    rulings = read_rulings(folder)
    settled = latest_rulings(rulings, DECIDE).keys()
    seen = latest_rulings(rulings, SECOND).keys()
    marked = list(GradingHistory(folder).current())
    answers = undecided_answers(marked) + (
        undecided_answers(marked, decided=True) if second else []
    )
    wanted = settled - seen if second else {a.group for a in answers} - settled
    mine = [answer for answer in answers if answer.group in wanted]
    found = group_cases(decision_cases(mine, KeyIndex(ClassFolder(folder)).key, lang))
    return found, marker_agreement(rulings)


async def show_queue(request: Request) -> Response:
    """Return the page of undecided answers."""
    folder, lang = _get_class_folder(request), request_language(request)
    asked = request.query_params
    second = "second" in asked
    groups, agreed = await run_in_threadpool(_build_answer_groups, folder, lang, second=second)
    return page_response(
        request,
        "class.html.j2",
        groups=groups[:AT_ONCE],
        left=len(groups),
        agreed=agreed,
        second=second,
        who=asked.get("who") or getpass.getuser(),
        changed=asked.get("changed", ""),
        wrong=asked.get("wrong", ""),
        shown=_highlight_key_points,
        students=lambda group: sum(case.answer.students for case in group),
    )


def _highlight_key_points(case: DecisionCase) -> Markup:
    """Return an answer as HTML with what the suggestion goes by marked."""
    typed, at, pieces = case.answer.typed, 0, []
    for start, end in case.spots:
        pieces += [escape(typed[at:start]), Markup("<mark>{}</mark>").format(typed[start:end])]
        at = end
    return Markup().join([*pieces, escape(typed[at:])])


async def save_decision(request: Request) -> Response:
    """Append a ruling for each ticked answer; redirect to the queue."""
    form = await read_form(request)
    folder = _get_class_folder(request)
    second = bool(field_text(form, "second"))
    points, met = _read_points(form)
    made = [
        Ruling(
            SECOND if second else DECIDE,
            field_text(form, "item"),
            field_text(form, f"answer-{group}"),
            points,
            who=field_text(form, "who").strip(),
            comment=field_text(form, "comment").strip() or met,
            group=group,
        )
        for group in field_texts(form, "group")
    ]
    who, worth = field_text(form, "who"), field_text(form, "worth")
    wrong = _find_form_problem(made, worth)
    if wrong:
        told = translate_page(request_language(request), f"class.{wrong}", worth=worth)
        return redirect(_build_page_url(who, second=second, wrong=told))
    try:
        await run_in_threadpool(append_rulings, folder, made)
    except ClassError as error:  # another command writes there
        return redirect(_build_page_url(who, second=second, wrong=str(error)))
    return redirect(_build_page_url(who, second=second))


def _read_points(form: FormData) -> tuple[str, str]:
    """Return the points given, and the names of the criteria that they are for.

    Points typed outrank ticks. Ticked criteria are worth at most the part; of a criterion ticked
    whole and half the whole counts.
    """
    typed = field_text(form, "points").strip().replace(",", ".")
    ticked: dict[str, Fraction] = {}
    for mark in field_texts(form, "mark"):
        points, _, name = mark.partition(":")
        with suppress(FormulaError):
            ticked[name] = max(ticked.get(name, Fraction(0)), parse_written_number(points))
    if typed or "criteria" not in form:
        return typed, ""
    with suppress(FormulaError):
        worth = parse_written_number(field_text(form, "worth"))
        given = round_to_quarters(min(sum(ticked.values(), Fraction(0)), worth))
        return f"{float(given):g}", " + ".join(ticked)
    return "", ""


def _find_form_problem(made: Sequence[Ruling], worth: str) -> str:
    """Return the key of what is wrong with a decision; empty if nothing."""
    if not made:
        return "unticked"
    try:
        for ruling in made:
            ruling.check()
            check_points(ruling, worth)
    except (ClassError, FormulaError):
        return "range"
    return "" if all(ruling.value for ruling in made) else "range"


def _build_page_url(who: str, *, second: bool, **more: str) -> str:
    """Return the address of the queue, keeping marker and mode."""
    asked = {"who": who.strip(), **({"second": "1"} if second else {}), **more}
    return f"{PLACE}?{urlencode(asked)}"


async def regrade(request: Request) -> Response:
    """Grade the class again with the new rulings; redirect to the queue."""
    form = await read_form(request)
    folder = ClassFolder(_get_class_folder(request))
    try:
        run = await run_in_threadpool(grade_class, folder, InlineExecutor(), 1)
    except ClassError as error:
        return redirect(_build_page_url(field_text(form, "who"), second=False, wrong=str(error)))
    changed = str(len(run.outcome.changes))
    return redirect(_build_page_url(field_text(form, "who"), second=False, changed=changed))


ROUTES = [
    Route(PLACE, show_queue),
    Route(f"{PLACE}/decide", save_decision, methods=["POST"]),
    Route(f"{PLACE}/mark", regrade, methods=["POST"]),
]
