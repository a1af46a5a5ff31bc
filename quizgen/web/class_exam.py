"""What a student of a class sees: coming in by a code, waiting, beginning, what became of it.

The paper itself is the page of any exam (`web.exam`).
"""

from __future__ import annotations

import hashlib
import hmac
from collections.abc import Sequence
from http import HTTPStatus

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import FileResponse, Response
from starlette.routing import Route
from starlette.types import ASGIApp, Receive, Scope, Send

from quizgen.classes.gradebook import FOLDER as RESULTS
from quizgen.classes.safe_exam_browser import END
from quizgen.classes.safe_exam_browser import FILE as SETTINGS_FILE
from quizgen.classes.seats import normalise_entry_code
from quizgen.classes.student_reports import REPORTS
from quizgen.locale import FIRST
from quizgen.store import Seat
from quizgen.web.auth import INVITED, SETTINGS, SIGN_IN, SUPERVISION, set_session_cookie
from quizgen.web.class_room import CAME_IN, ClassRoom
from quizgen.web.event_log import log_event
from quizgen.web.forms import field_text, read_form
from quizgen.web.security import OPEN, plain_error
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, redirect, request_language

SEAT = "/seat"
WATCHED = (
    SETTINGS,
    SUPERVISION,
    SIGN_IN,
    INVITED,
    "/sign-out",
    "/account",
    "/people",
    "/settings",
    OPEN,
)
"""Pages of those who watch, and what brings the prescribed browser: no browser is refused them."""
CONFIG_KEY, EXAM_KEY = "x-safeexambrowser-configkeyhash", "x-safeexambrowser-requesthash"


def is_prescribed_browser(
    address: str, headers: Headers, config_keys: Sequence[str], exam_keys: Sequence[str]
) -> bool:
    """Return whether a request comes from Safe Exam Browser with one of the keys, if there are any.

    It sends the SHA-256 of the whole address and its key, in hexadecimal digits.

    Parameters
    ----------
    address : str
        As the browser has asked for it, without what stands behind ``#``.
    headers : Headers
    config_keys, exam_keys : sequence of str
        Of settings, and of settings and program; if there are both, one of each must be proven.
    """
    return _is_proven(address, headers.get(CONFIG_KEY, ""), config_keys) and _is_proven(
        address, headers.get(EXAM_KEY, ""), exam_keys
    )


def _is_proven(address: str, given: str, keys: Sequence[str]) -> bool:
    """Return whether a hash is that of an address and one of the keys; yes if there are none."""
    wanted = [hashlib.sha256((address + key.lower()).encode()).hexdigest() for key in keys]
    sent = given.strip().lower().encode()
    return not keys or any(hmac.compare_digest(one.encode(), sent) for one in wanted)


class ClassExamMiddleware:
    """Refuses students' pages to other browsers than the prescribed one; notes who is there.

    Parameters
    ----------
    app : ASGI application
    room : ClassRoom
    """

    def __init__(self, app: ASGIApp, room: ClassRoom) -> None:
        self.app, self.room = app, room

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a refused request, or pass it on."""
        if scope["type"] == "http" and not scope["path"].startswith(WATCHED):
            request = Request(scope)
            keys = self.room.config_keys, self.room.exam.browser.exam_keys
            if not is_prescribed_browser(_build_address(scope), request.headers, *keys):
                await self._refuse(request)(scope, receive, send)
                return
            seat: Seat | None = scope["state"].get("seat")
            if seat is not None and seat.student in self.room.students:
                address = _get_client_address(request)
                if self.room.note_seen(seat.student, address):
                    await run_in_threadpool(self.room.warn, seat.student, "address", address)
        await self.app(scope, receive, send)

    def _refuse(self, request: Request) -> ASGIApp:
        """Return what another browser is answered: where the settings are, if they are here."""
        is_here = self.room.exam.browser.safe_exam_browser
        if is_here and request.method == "GET" and request.scope["path"] == "/":
            return _show_way_in
        return plain_error("kiosk", HTTPStatus.FORBIDDEN)


def _build_address(scope: Scope) -> str:
    """Return the address of a request as the browser wrote it."""
    path = scope.get("raw_path", scope["path"].encode()).decode("latin-1").partition("?")[0]
    query = scope["query_string"].decode("latin-1")
    host = Headers(scope=scope).get("host", "")
    return f"{scope['scheme']}://{host}{path}{query and f'?{query}'}"


def _get_client_address(request: Request) -> str:
    """Return the IP address that a request came from; empty if it is unknown."""
    return request.client.host if request.client else ""


async def _show_way_in(scope: Scope, receive: Receive, send: Send) -> None:
    """Send the page that opens Safe Exam Browser with the settings of this exam."""
    request = Request(scope)
    room, lang = get_room(request), request_language(request)
    scheme = "sebs" if scope["scheme"] == "https" else "seb"
    answer = page_response(
        request, "class_kiosk.html.j2", HTTPStatus.FORBIDDEN, title=_find_title(room, lang),
        link=f"{scheme}://{request.headers.get('host', '')}{SETTINGS}", file=SETTINGS,
    )  # fmt: skip
    await answer(scope, receive, send)


async def send_settings(request: Request) -> Response:
    """Send the settings of Safe Exam Browser; they hold nothing that students may not know."""
    room = get_room(request)
    if not room.exam.browser.safe_exam_browser:
        raise HTTPException(404)
    return FileResponse(room.settings_file, media_type="application/seb", filename=SETTINGS_FILE)


async def leave_browser(request: Request) -> Response:
    """Redirect from the address at which Safe Exam Browser ends: another browser stays here."""
    del request
    return redirect(SEAT)


def get_room(request: Request) -> ClassRoom:
    """Return the class that sits its exam here."""
    site: ServerState = request.app.state.site
    assert site.room is not None  # noqa: S101 - without it there is no such page
    return site.room


def _get_seat(request: Request) -> Seat:
    """Return the seat of the student who asks; HTTP 404 for anybody else."""
    seat: Seat | None = request.state.seat
    if seat is None or seat.student not in get_room(request).students:
        raise HTTPException(404)
    return seat


async def show_entrance(request: Request) -> Response:
    """Return the page on which a student types the code of the card."""
    if request.state.seat is not None:
        return redirect(SEAT)
    if request.state.learner.id:
        return redirect(SUPERVISION)
    return _render_entrance(request)


def _render_entrance(
    request: Request, status: int = 200, problem: str = "", typed: str = ""
) -> Response:
    """Return the entrance; ``problem`` is the key of its message."""
    room, lang = get_room(request), request_language(request)
    code = typed or request.query_params.get("code", "")
    kept = {"code": code[:20]} if code else {}
    return page_response(
        request, "class_entrance.html.j2", status,
        title=_find_title(room, lang), problem=problem, code=code[:20], kept=kept,
    )  # fmt: skip


def _find_title(room: ClassRoom, lang: str) -> str:
    """Return what the exam is called."""
    return (
        room.exam.pick("title", lang)
        or room.exam.pick("course", lang)
        or (room.folder.settings.name)
    )


async def enter(request: Request) -> Response:
    """Let a student in by a code that nobody has used; a code that was used says so.

    Right codes are never made to wait, however many wrong ones came from the same address: a whole
    class may share it.
    """
    form = await read_form(request)
    room, address = get_room(request), _get_client_address(request)
    typed = field_text(form, "code")
    code = normalise_entry_code(typed)
    found = await run_in_threadpool(room.find_code, code) if code else None
    if found is None:
        return _refuse_code(request, typed)
    student, learner, issue, used = found
    if used is None and await run_in_threadpool(room.store.seats.use_code, learner, issue):
        log_event("code used", learner=learner, address=address)
        await run_in_threadpool(room.record, student, student, CAME_IN, address)
    elif not await run_in_threadpool(_may_look_again, room, learner):
        await run_in_threadpool(room.warn, student, "reused", address)
        log_event("code used again", learner=learner, address=address)
        return _render_entrance(request, 403, "used", typed)
    token = await run_in_threadpool(room.store.accounts.start_session, learner)
    return set_session_cookie(request.scope, redirect(SEAT), token)


def _refuse_code(request: Request, typed: str) -> Response:
    """Return the entrance with what is wrong; after many tries it takes a while."""
    room, address = get_room(request), _get_client_address(request)
    wait = room.wrong_codes.seconds_to_wait(address)
    if wait:
        answer = _render_entrance(request, 429, "often", typed)
        answer.headers["retry-after"] = str(wait)
        return answer
    room.wrong_codes.spend(address)
    log_event("code wrong", address=address)
    return _render_entrance(request, 403, "wrong", typed)


def _may_look_again(room: ClassRoom, learner: int) -> bool:
    """Return whether a code that was used shows the marks: once they may be seen."""
    seat = room.store.seats.find(learner)
    return seat is not None and room.status(seat) == "handed" and room.is_released()


async def show_seat(request: Request) -> Response:
    """Return where a student is: waiting, to begin, handed in; who writes is led to the paper."""
    seat, room = _get_seat(request), get_room(request)
    status = await run_in_threadpool(room.status, seat)
    if status in {"writing", "paused"} and seat.sitting is not None:
        return redirect(f"/exam/{seat.sitting.id}")
    is_shown = status == "handed" and await run_in_threadpool(room.is_released)
    result = await run_in_threadpool(room.marks_of, seat.student) if is_shown else None
    lang = request_language(request)
    return page_response(
        request, "class_seat.html.j2", title=_find_title(room, lang), seat=seat, state=status,
        student=room.students[seat.student], place=room.places[seat.student], room=room,
        rules=_list_rules(room, lang), result=result, shown=is_shown,
        report=bool(_list_reports(room, seat)), tag=await run_in_threadpool(room.state_tag, seat),
        opens=await run_in_threadpool(room.opens), now=room.now(),
    )  # fmt: skip


def _list_rules(room: ClassRoom, lang: str) -> Sequence[str]:
    """Return what holds in the room, in a language."""
    rules = room.exam.rules
    if isinstance(rules, list):
        return rules
    return rules.get(lang) or rules.get(FIRST) or next(iter(rules.values()), [])


async def begin_exam(request: Request) -> Response:
    """Begin the student's exam and redirect to it; if it may not be begun, to where they wait."""
    await read_form(request)
    begun = await get_room(request).begin(_get_seat(request))
    return redirect(f"/exam/{begun.id}" if begun else SEAT)


async def tell_state(request: Request) -> Response:
    """Have the page read again if something has changed since it was made (htmx)."""
    seat, room = _get_seat(request), get_room(request)
    tag = await run_in_threadpool(room.state_tag, seat)
    if tag == request.query_params.get("tag"):
        return Response(status_code=204)
    return Response(headers={"hx-refresh": "true"})


def _list_reports(room: ClassRoom, seat: Seat) -> list[str]:
    """Return the formats in which the student's report was written."""
    folder, name = room.folder.path / RESULTS / REPORTS, room.students[seat.student].file
    return [form for form in ("pdf", "html") if (folder / f"{name}.{form}").is_file()]


async def send_report(request: Request) -> Response:
    """Send the student's report as a file, once marks may be seen."""
    seat, room = _get_seat(request), get_room(request)
    forms = await run_in_threadpool(_list_reports, room, seat)
    status = await run_in_threadpool(room.status, seat)
    if not forms or status != "handed" or not await run_in_threadpool(room.is_released):
        raise HTTPException(404)
    name = f"{room.students[seat.student].file}.{forms[0]}"
    path = room.folder.path / RESULTS / REPORTS / name
    answer = FileResponse(path, filename=name)
    MutableHeaders(raw=answer.raw_headers)["content-security-policy"] = "sandbox"
    return answer


ROUTES = [
    Route("/", show_entrance),
    Route("/", enter, methods=["POST"]),
    Route(SETTINGS, send_settings),
    Route(SEAT, show_seat),
    Route(END, leave_browser),
    Route(f"{SEAT}/begin", begin_exam, methods=["POST"]),
    Route(f"{SEAT}/state", tell_state),
    Route(f"{SEAT}/report", send_report),
]
