"""What those who watch an exam of a class see and do: who is in, more time, pauses, an end."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.classes.roster import RosterStudent
from quizgen.core.errors import ClassError
from quizgen.store import Seat
from quizgen.web.auth import SUPERVISION
from quizgen.web.class_exam import get_room
from quizgen.web.class_room import HELD, MINUTE, OPENED, ClassRoom, Presence, list_learners
from quizgen.web.event_log import log_event
from quizgen.web.forms import field_text, read_form
from quizgen.web.views import page_response, redirect, request_language, translate_page

MOST_MINUTES = 600
"""Of more time that is given at once."""
STATES = ("away", "early", "ready", "writing", "lost", "paused", "handed", "missed")
"""In the order in which they are counted: ``away`` has not come in."""


@dataclass(frozen=True)
class LiveSeat:
    """A student as those who watch see one.

    Parameters
    ----------
    student : RosterStudent
    place : str
    seat : Seat
    state : str
        One of ``STATES``.
    presence : Presence
    """

    student: RosterStudent
    place: str
    seat: Seat
    state: str
    presence: Presence


def _require_supervisor(request: Request) -> None:
    """Raise HTTP 403 unless somebody with an account asks."""
    if request.state.seat is not None or not request.state.learner.id:
        raise HTTPException(403)


def _list_live_seats(room: ClassRoom) -> list[LiveSeat]:
    """Return all students in the order of their seats."""
    seats = {one.student: one for one in room.store.seats.list_progress()}
    return [_watch_seat(room, seats[student]) for student in room.students]


def _watch_seat(room: ClassRoom, seat: Seat) -> LiveSeat:
    """Return a student as those who watch see one."""
    state = room.status(seat)
    if state in {"early", "ready"} and seat.used is None:
        state = "away"
    elif room.is_lost(seat):
        state = "lost"
    return LiveSeat(
        room.students[seat.student], room.places[seat.student], seat, state,
        room.presence[seat.student],
    )  # fmt: skip


async def show_room(request: Request) -> Response:
    """Return the page of everybody; a script asks for it every few seconds."""
    _require_supervisor(request)
    return await run_in_threadpool(_render_room, request, request.query_params.get("said", ""))


def _render_room(request: Request, said: str = "", status: int = 200) -> Response:
    """Return the page of everybody; ``said`` is what became of what was asked for."""
    room = get_room(request)
    seats = _list_live_seats(room)
    counts = Counter(one.state for one in seats)
    return page_response(
        request, "class_live.html.j2", status, seats=seats, room=room, now=room.now(),
        counts=[(state, counts[state]) for state in STATES if counts[state]],
        papers=sum(one.seat.paper is not None for one in seats),
        unstored=sum(one.seat.is_to_be_stored for one in seats),
        opens=room.opens(), held=room.is_held(), released=room.is_released(),
        said=_translate_known(request_language(request), said), here=SUPERVISION,
    )  # fmt: skip


def _translate_known(lang: str, said: str) -> str:
    """Return the sentence of a key of ours; "" for anything else that stands in an address."""
    return (
        translate_page(lang, f"live.{said}") if said in {"done", "not_sure", "no_minutes"} else ""
    )


def _find_seat(request: Request) -> Seat:
    """Return the seat that an address names; HTTP 404 if there is none."""
    room = get_room(request)
    seat = room.store.seats.find(request.path_params["learner"])
    if seat is None or seat.student not in room.students:
        raise HTTPException(404)
    return seat


async def show_student(request: Request) -> Response:
    """Return the page of one student."""
    _require_supervisor(request)
    return await run_in_threadpool(_render_student, request)


def _render_student(request: Request) -> Response:
    """Return the page of one student, with the code as long as nobody has used it."""
    room, seat = get_room(request), _find_seat(request)
    code = room.code_of(seat.student, seat.issue) if seat.used is None else ""
    lang, said = request_language(request), request.query_params.get("said", "")
    return page_response(
        request, "class_student.html.j2", one=_watch_seat(room, seat), code=code, room=room,
        now=room.now(), said=_translate_known(lang, said),
        minutes=room.minutes_of(seat.student), extra=room.extra_of(seat) / MINUTE,
    )  # fmt: skip


async def change_room(request: Request) -> Response:
    """Do for everybody what a form asks: open, pause, more time, an end, marks to be seen."""
    form = await read_form(request)
    _require_supervisor(request)
    room = get_room(request)
    seats = await run_in_threadpool(room.store.seats.list_seats)
    present = [one for one in seats if one.student in room.students]
    what = field_text(form, "do")
    try:
        if what in {"open", "pause", "go-on", "release", "withhold"}:
            await run_in_threadpool(_change_exam, room, what)
        said = await run_in_threadpool(_change_seats, request, form, present, "")
    except ClassError as error:
        return await run_in_threadpool(_render_room, request, str(error), 409)
    return redirect(f"{SUPERVISION}?said={said}")


def _change_exam(room: ClassRoom, what: str) -> None:
    """Open, pause, resume or release the exam for the whole class, also for who comes later."""
    shared = room.store.shared
    if what == "open":
        shared.replace(OPENED, str(room.now()))
    elif what in {"pause", "go-on"}:
        shared.replace(HELD, "1" if what == "pause" else "")
    else:
        room.release(on=what == "release")


async def change_student(request: Request) -> Response:
    """Do for one student what a form asks: another code, pause, more time, an end."""
    form = await read_form(request)
    _require_supervisor(request)
    seat = await run_in_threadpool(_find_seat, request)
    if field_text(form, "do") in {"open", "release", "withhold"}:
        raise HTTPException(400)
    said = await run_in_threadpool(_change_seats, request, form, [seat], seat.student)
    return redirect(f"{SUPERVISION}/{seat.learner}?said={said}")


def _change_seats(request: Request, form: FormData, seats: Sequence[Seat], whom: str) -> str:
    """Do what a form asks for some students and write it down; return the key of what to say."""
    room, what = get_room(request), field_text(form, "do")
    store, learners = room.store.seats, list_learners(seats)
    typed = field_text(form, "minutes")
    minutes = int(typed) if typed.isascii() and typed.isdecimal() and len(typed) < 5 else 0
    if what in {"extend", "reopen"} and not 1 <= minutes <= MOST_MINUTES:
        return "no_minutes"
    if what in {"hand-in", "reopen", "code"} and not field_text(form, "sure"):
        return "not_sure"
    if what == "extend":
        store.give_time(learners, minutes * MINUTE)
    elif what in {"pause", "go-on"}:
        store.set_pause(learners, on=what == "pause")
    elif what == "hand-in":
        store.hand_in(learners)
    elif what == "reopen" and whom:
        store.reopen(learners[0], minutes * MINUTE)
    elif what == "code" and whom:
        store.issue_code(learners[0])
    elif what not in {"open", "release", "withhold"}:
        raise HTTPException(400)
    learner = request.state.learner
    log_event("supervision", by=learner.id, what=what, learner=learners[0] if whom else "all")
    more = f"{minutes} min" if what in {"extend", "reopen"} else ""
    room.record(learner.name, whom or "all", what, more)
    return "done"


ROUTES = [
    Route(SUPERVISION, show_room),
    Route(SUPERVISION, change_room, methods=["POST"]),
    Route(f"{SUPERVISION}/{{learner:int}}", show_student),
    Route(f"{SUPERVISION}/{{learner:int}}", change_student, methods=["POST"]),
]
