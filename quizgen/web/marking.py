"""Marking a class: a card of similar answers at a time, the rubric as buttons, several markers."""

from __future__ import annotations

import getpass
import secrets
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote, urlencode

import msgspec
from markupsafe import Markup, escape
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import FileResponse, Response
from starlette.routing import Route

from quizgen.classes.agreement import SETTLED, ItemAgreement, agreement_by_item
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.generation import redraw_question
from quizgen.classes.grading_run import grade_class
from quizgen.classes.manual_grading import DecisionCase, check_points
from quizgen.classes.markers import ItemMarkers, read_markers, split_names, write_markers
from quizgen.classes.marking import AnswerCard, AnswerIndex, MarkingDesk, TakenError
from quizgen.classes.rubrics import (
    ItemRubric,
    RubricLine,
    join_lines,
    list_suggested_lines,
    parse_points,
    split_lines,
    word_line,
    write_points,
)
from quizgen.classes.rulings import DECIDE, SECOND, Ruling
from quizgen.classes.scanning.scan_folder import ON_PAPER
from quizgen.core.errors import ClassError, FormulaError, QuizgenError
from quizgen.core.executor import InlineExecutor
from quizgen.web.auth import set_cookie
from quizgen.web.forms import field_text, field_texts, read_form
from quizgen.web.question_view import QuestionRequest, QuestionView, question_view
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, redirect, request_language

PLACE = "/marking"
COOKIE, COOKIE_DAYS = "quizgen-marker", 30
"""Names the marker in a browser of a server where nobody signs in."""
LONGEST_NAME = 100
MOST_CROPS = 6
"""Pictures of a card."""
LONGEST_TYPED = 2000


@cache
def open_desk(folder: Path) -> MarkingDesk:
    """Return what the markers of a class share: one for each class and process."""
    return MarkingDesk(folder)


@dataclass(frozen=True)
class Marker:
    """Who marks, and whether that person may say who else does."""

    name: str
    manages: bool


def get_marker(request: Request) -> Marker:
    """Return who marks.

    Raises
    ------
    HTTPException
        404 for who signed in and marks nothing here: they do not learn that there is a class.
    """
    site: ServerState = request.app.state.site
    learner, folder = request.state.learner, site.settings.classroom
    if not site.settings.accounts:
        name = unquote(request.cookies.get(COOKIE, ""))[:LONGEST_NAME].strip()
        return Marker(name or getpass.getuser(), manages=True)
    if folder is None or not (learner.manages or read_markers(folder).names(learner.name)):
        raise HTTPException(404)
    return Marker(learner.name, manages=bool(learner.manages))


def _get_desk(request: Request) -> MarkingDesk:
    """Return the desk of the class that the server was started with."""
    site: ServerState = request.app.state.site
    folder = site.settings.classroom
    assert folder is not None  # noqa: S101 - without it there are no such pages
    return open_desk(folder)


@dataclass(frozen=True)
class ItemProgress:
    """An item on the overview: how far it is, who marks it, how far two agree."""

    item: str
    number: str
    worth: Fraction
    students: int
    decided: int
    seconded: int
    markers: ItemMarkers
    agreed: ItemAgreement | None
    is_second: bool


async def show_overview(request: Request) -> Response:
    """Return the page of all items, markers and disagreements."""
    who, desk = get_marker(request), _get_desk(request)
    found = await run_in_threadpool(_list_progress, desk, who)
    return page_response(
        request, "marking.html.j2", items=found, who=who,
        counts=desk.count_by_marker().most_common(), note=request.query_params.get("note", ""),
        changed=request.query_params.get("count", ""),
        local=not request.app.state.site.settings.accounts,
    )  # fmt: skip


def _list_progress(desk: MarkingDesk, who: Marker) -> list[ItemProgress]:
    """Return all items of a class with their progress."""
    index, state, markers = desk.index(), desk.state(), read_markers(desk.folder)
    agreed = agreement_by_item(state.rulings)
    done = [desk.list_done(second=second) for second in (False, True)]
    return [
        ItemProgress(
            item,
            index.numbers[item],
            cards[0].worth,
            sum(card.students for card in cards),
            _count_students(cards, done[0]),
            _count_students(cards, done[1]),
            markers.of(item),
            agreed.get(item),
            markers.of(item).is_second(who.name),
        )
        for item, cards in index.items.items()
    ]


def _count_students(cards: list[AnswerCard], done: Container[str]) -> int:
    """Return of how many students the answers are decided."""
    return sum(case.answer.students for card in cards for case in card.cases
               if case.answer.group in done)  # fmt: skip


@dataclass(frozen=True)
class _Asked:
    """What a request asks for: a round of marking of one item."""

    item: str
    second: bool
    markers: ItemMarkers

    def url(self, card: AnswerCard | None = None, page: str = "answer", **more: str) -> str:
        """Return the address of a page of this round."""
        asked = {"item": self.item, **({"card": card.name} if card else {}),
                 **({"second": "1"} if self.second else {}), **more}  # fmt: skip
        return f"{PLACE}/{page}?{urlencode(asked)}"


def _read_round(desk: MarkingDesk, who: Marker, item: str, second: str) -> _Asked:
    """Return the round that is asked for; HTTP 404 if there is no such item.

    Who is named as second marker alone never sees the first round.
    """
    if item not in desk.index().items:
        raise HTTPException(404)
    markers = read_markers(desk.folder).of(item)
    return _Asked(item, bool(second) or markers.is_second(who.name), markers)


async def show_answer(request: Request) -> Response:
    """Return the page of a card; without one in the address, of the next undecided one."""
    who, desk, query = get_marker(request), _get_desk(request), request.query_params
    asked, place = await run_in_threadpool(
        _find_card, desk, who, query.get("item", ""), query.get("second", ""), query.get("card", "")
    )
    if place is None:
        return _leave_cards(request)
    return await _render_card(request, who, desk, asked, place)


def _find_card(
    desk: MarkingDesk, who: Marker, item: str, second: str, card: str
) -> tuple[_Asked, int | None]:
    """Return the round that is asked for, and the place of the card, or of the next open one."""
    asked = _read_round(desk, who, item, second)
    place = desk.index().find(item, card)
    if place is None:
        place = desk.find_next(item, who.name, asked.markers, second=asked.second)
    return asked, place


def _leave_cards(request: Request) -> Response:
    """Return to the overview, which does not fit in the place of a card that a script fetched."""
    address = f"{PLACE}?note=done"
    if "hx-request" in request.headers:
        return Response(headers={"hx-redirect": address})
    return redirect(address)


async def _render_card(
    request: Request,
    who: Marker,
    desk: MarkingDesk,
    asked: _Asked,
    place: int,
    **more: Any,
) -> Response:
    """Return the page of one card."""
    lang = request_language(request)
    content = await run_in_threadpool(_build_card, desk, who, asked, place, lang)
    query = request.query_params
    moved = desk.list_moved(query["changed"]) if query.get("changed") else []
    return page_response(
        request, "marking_answer.html.j2", **content, moved=_describe_moved(desk, moved, asked),
        note=query.get("note", ""), taken=query.get("taken", ""), **more,
    )  # fmt: skip


def _build_card(
    desk: MarkingDesk, who: Marker, asked: _Asked, place: int, lang: str
) -> dict[str, Any]:
    """Return what stands on the page of a card."""
    index, state, rubric = desk.index(), desk.state(), desk.rubric(asked.item)
    cards = index.items[asked.item]
    card, said = cards[place], state.list_decisions(second=asked.second)
    desk.claim(card, who.name, second=asked.second)
    following = desk.find_next(
        asked.item, who.name, asked.markers, second=asked.second, after=place
    )
    decided = sum(one.is_decided(desk.list_done(second=asked.second)) for one in cards)
    pace = state.pace(who.name)
    now = said.get(card.name)
    untouched, first = desk.untouched_rubric(asked.item), card.cases[0]
    sample = index.students[card.name][0]
    ticked = (
        split_lines(now.lines) if now
        else frozenset[str]() if asked.second
        else list_suggested_lines(first, rubric)
    )  # fmt: skip
    return {
        "asked": asked, "card": card, "place": place, "count": len(cards), "decided": decided,
        "minutes": round(pace * (len(cards) - decided) / 60) if pace else None,
        "answers": [_AnswerRow.build(index, case, said, desk.list_typed()) for case in card.cases],
        "lines": [
            (one, word_line(one, untouched, first), one.id in ticked)
            for one in rubric.current_lines
        ],
        "total": rubric.add_up(ticked, card.worth), "rubric": rubric, "now": now, "who": who,
        "typed": now.value if now and not now.lines else "",
        "remark": _split_remark(now, rubric), "first": first,
        "before": cards[place - 1] if place else None,
        "after": cards[place + 1] if place + 1 < len(cards) else None,
        "following": None if following in {None, place} else cards[following],
        "number": index.numbers[asked.item],
        "view": find_view(index, sample.student, asked.item, lang),
        "label": sample.part, "code": index.head(sample.student).code,
    }  # fmt: skip


def _split_remark(now: Ruling | None, rubric: ItemRubric) -> str:
    """Return what the marker wrote, without the comments of the lines."""
    if now is None:
        return ""
    return now.comment.removeprefix(rubric.remark(split_lines(now.lines))).removeprefix("; ")


@dataclass(frozen=True)
class _AnswerRow:
    """Equal answers on a card.

    Parameters
    ----------
    group : str
    shown : Markup
        The answer, with what the suggestion goes by marked.
    students : int
    crops : list of str
        Addresses of pictures of what stands on paper.
    names : list of str
        Of the students, or their codes.
    step : str
        What is decided of it by now; empty if nothing.
    is_decided, to_read : bool
        Whether it is decided, and whether it stands on a picture alone.
    typed : str
        What somebody read there since the class was marked.
    proposal : str
        The number that the picture may show.
    """

    group: str
    shown: Markup
    students: int
    crops: list[str]
    names: list[str]
    step: str
    is_decided: bool
    to_read: bool
    typed: str
    proposal: str

    @classmethod
    def build(
        cls,
        index: AnswerIndex,
        case: DecisionCase,
        said: Mapping[str, Ruling],
        typed: Mapping[str, str],
    ) -> _AnswerRow:
        """Return the row of equal answers."""
        group = case.answer.group
        whose = index.students[group]
        crops = [
            f"{PLACE}/crop/{index.head(one.student).code}/{one.part}"
            for one in whose[:MOST_CROPS] if index.crop(one.student, one.part)
        ]  # fmt: skip
        return cls(
            group, _spots(case), case.answer.students, crops,
            [index.describe(one.student) for one in whose],
            said[group].step if group in said else "", group in said,
            index.is_to_be_read(case), typed.get(group, ""),
            index.proposals.get(whose[0], ""),
        )  # fmt: skip


def _spots(case: DecisionCase) -> Markup:
    """Return an answer as HTML with what the suggestion goes by marked."""
    typed, at, pieces = case.answer.typed, 0, []
    for start, end in case.spots:
        pieces += [escape(typed[at:start]), Markup("<mark>{}</mark>").format(typed[start:end])]
        at = end
    return Markup().join([*pieces, escape(typed[at:])])


def find_view(index: AnswerIndex, student: str, item: str, lang: str) -> QuestionView | None:
    """Return the question as it stands on a student's paper; None if it cannot be made again."""
    template = item.partition("/")[0].partition(":")[0]
    return _draw_view(index, student, template, lang)


@lru_cache(maxsize=256)
def _draw_view(index: AnswerIndex, student: str, template: str, lang: str) -> QuestionView | None:
    """Return a student's question as HTML; None if its bank is not what it was."""
    heads = {one: head for one, (head, _) in index.keys.places.items()}
    try:
        item = redraw_question(index.folder.settings, heads, student, template, lang)
    except QuizgenError:  # marking goes on by the key alone
        return None
    if item is None:
        return None
    question = item.questions[0]
    wanted = QuestionRequest(template, "", question.lang, number=item.number)
    return question_view(wanted, question, item.keys[0])


async def save_decision(request: Request) -> Response:
    """Write the decision on the ticked answers of a card; redirect to the next one."""
    return await _save_and_go_on(request, _save_decision)


async def _save_and_go_on(
    request: Request, save: Callable[[FormData, Marker, MarkingDesk], str]
) -> Response:
    """Save what a form says, and go where that leads; to the list if nothing is left to decide."""
    form, who, desk = await read_form(request), get_marker(request), _get_desk(request)
    following = await run_in_threadpool(save, form, who, desk)
    return redirect(following) if following else _leave_cards(request)


def _save_decision(form: FormData, who: Marker, desk: MarkingDesk) -> str:
    """Write a decision, and return where to go on; empty if nothing is left to decide."""
    asked = _read_round(desk, who, field_text(form, "item"), field_text(form, "second"))
    cards = desk.index().items[asked.item]
    place = desk.index().find(asked.item, field_text(form, "card"))
    if place is None:
        raise HTTPException(404)
    card, ticked = cards[place], {*field_texts(form, "group")}
    try:
        made = _read_decision(form, who, desk.rubric(asked.item), asked, card, ticked)
        seen = {group: field_text(form, f"seen-{group}") for group in ticked}
        desk.decide(made, seen)
    except TakenError as error:
        taken = f"{error.ruling.who}: {error.ruling.value}"
        return asked.url(card, note="taken", taken="" if asked.second else taken)
    except (ClassError, FormulaError) as error:
        return asked.url(card, note=str(error) if str(error) in NOTES else "range")
    following = desk.find_next(
        asked.item, who.name, asked.markers, second=asked.second, after=place
    )
    return "" if following is None else asked.url(cards[following])


NOTES = frozenset(
    {"typed", "unticked", "range", "taken", "undone", "nothing", "done", "marked", "busy"}
)
"""What pages say of what was just done."""


def _read_decision(
    form: FormData,
    who: Marker,
    rubric: ItemRubric,
    asked: _Asked,
    card: AnswerCard,
    ticked: set[str],
) -> list[Ruling]:
    """Return the rulings that a form asks for: points typed outrank lines.

    Raises
    ------
    ClassError, FormulaError
        If there are no answers, or the points cannot be.
    """
    lines = {*field_texts(form, "line")} & {one.id for one in rubric.current_lines}
    typed = field_text(form, "points").strip()
    points = parse_points(typed) if typed else rubric.add_up(lines, card.worth)
    own = field_text(form, "remark").strip()
    comment = own if typed else "; ".join(filter(None, (rubric.remark(lines), own)))
    made = [
        Ruling(
            SECOND if asked.second else DECIDE,
            asked.item,
            case.answer.typed[:2000],
            write_points(points),
            who=who.name,
            comment=comment,
            group=case.answer.group,
            lines="" if typed else join_lines(lines, rubric),
        )
        for case in card.cases
        if case.answer.group in ticked
    ]
    if not made:
        raise ClassError("unticked")
    for one in made:
        one.check()
        check_points(one, str(card.worth))
    return made


async def save_typed(request: Request) -> Response:
    """Take what a marker read on a picture as the answer; redirect to the next card."""
    return await _save_and_go_on(request, _save_typed)


def _save_typed(form: FormData, who: Marker, desk: MarkingDesk) -> str:
    """Write what was read, and return where to go on; empty if nothing is left to decide."""
    asked = _read_round(desk, who, field_text(form, "item"), field_text(form, "second"))
    group, typed = field_text(form, "group"), field_text(form, "typed").strip()[:LONGEST_TYPED]
    back = bool(field_text(form, "back"))
    place = desk.index().find(asked.item, group)
    if place is None:
        raise HTTPException(404)
    cards = desk.index().items[asked.item]
    try:
        made = desk.type_answer(asked.item, group, ON_PAPER if back else typed, who.name)
    except ClassError:
        return asked.url(cards[place], note="busy")
    if back:
        return asked.url(cards[place], note="undone")
    following = desk.find_next(
        asked.item, who.name, asked.markers, second=asked.second, after=place
    )
    if following is None:
        return ""
    earned = "" if made.marks is None else f" → {write_points(Fraction(made.marks))}"
    shown = f"{made.id}: {typed or '–'}{earned}"
    return asked.url(cards[following], note="typed", taken=shown)


async def undo_decision(request: Request) -> Response:
    """Take the last decision of this marker back; redirect to its card."""
    form, who, desk = await read_form(request), get_marker(request), _get_desk(request)
    return await run_in_threadpool(_undo_decision, form, who, desk)


def _undo_decision(form: FormData, who: Marker, desk: MarkingDesk) -> Response:
    """Take a decision back, and return where its card is."""
    back = desk.undo(who.name)
    item = back.item if back else field_text(form, "item")
    group = back.group if back else field_text(form, "card")
    second = back.what == SECOND if back else bool(field_text(form, "second"))
    asked = _read_round(desk, who, item, "1" if second else "")
    place = desk.index().find(item, group)
    card = None if place is None else desk.index().items[item][place]
    return redirect(asked.url(card, note="undone" if back else "nothing"))


async def change_line(request: Request) -> Response:
    """Change a line of the rubric, or show what that would do to marks."""
    form, who, desk = await read_form(request), get_marker(request), _get_desk(request)
    asked, found = await run_in_threadpool(
        _find_card, desk, who, *(field_text(form, name) for name in ("item", "second", "card"))
    )
    place = found or 0
    card = desk.index().items[asked.item][place]
    line = RubricLine(
        field_text(form, "line") or f"l{secrets.token_hex(3)}",
        field_text(form, "text").strip(),
        field_text(form, "points").strip() or "0",
        field_text(form, "comment").strip(),
        gone=bool(field_text(form, "gone")),
    )
    try:
        line = msgspec.structs.replace(line, points=write_points(parse_points(line.points)))
        if not field_text(form, "sure"):
            plan = await run_in_threadpool(desk.plan_line, asked.item, line, who.name)
            if plan.moved:
                return await _render_card(
                    request, who, desk, asked, place, proposed=line,
                    proposal=_describe_moved(desk, plan.moved, asked),
                )  # fmt: skip
        plan = await run_in_threadpool(desk.change_line, asked.item, line, who.name)
    except (ClassError, FormulaError):
        return redirect(asked.url(card, note="line"))
    return redirect(asked.url(card, changed=plan.rubric.history[-1].step))


@dataclass(frozen=True)
class _MovedMark:
    """Students whose points a change of the rubric moves, from what to what."""

    names: list[str]
    before: str
    after: str


def _describe_moved(
    desk: MarkingDesk, moved: Sequence[tuple[Ruling, Ruling]], asked: _Asked
) -> list[_MovedMark]:
    """Return whom a change of the rubric concerns, by the points before and after it.

    Only points of the round that is marked: a second marker learns nothing of the first.
    """
    index, found = desk.index(), dict[tuple[str, str], list[str]]()
    for before, after in moved:
        if after.what == (SECOND if asked.second else DECIDE):
            names = [index.describe(one.student) for one in index.students.get(after.group, ())]
            found.setdefault((before.value, after.value), []).extend(names)
    return [_MovedMark(names, *points) for points, names in sorted(found.items())]


async def show_list(request: Request) -> Response:
    """Return the page of all cards of an item, with what is decided."""
    who, desk, query = get_marker(request), _get_desk(request), request.query_params
    content = await run_in_threadpool(
        _build_list, desk, who, query.get("item", ""), query.get("second", "")
    )
    return page_response(request, "marking_list.html.j2", **content)


def _build_list(desk: MarkingDesk, who: Marker, item: str, second: str) -> dict[str, Any]:
    """Return what stands on the page of all cards of an item."""
    asked, index = _read_round(desk, who, item, second), desk.index()
    return {"asked": asked, "cards": index.items[item], "number": index.numbers[item],
            "said": desk.state().list_decisions(second=asked.second)}  # fmt: skip


async def show_apart(request: Request) -> Response:
    """Return the page of what two markers differ in; of one item."""
    who, desk, query = get_marker(request), _get_desk(request), request.query_params
    content = await run_in_threadpool(_build_apart, desk, who, query.get("item", ""))
    return page_response(
        request, "marking_apart.html.j2", **content, shown=_spots, note=query.get("note", "")
    )


def _build_apart(desk: MarkingDesk, who: Marker, item: str) -> dict[str, Any]:
    """Return what stands on the page of what two markers differ in."""
    asked, index = _read_round(desk, who, item, ""), desk.index()
    agreed = agreement_by_item(desk.state().rulings).get(item)
    texts = {case.answer.group: case for card in index.items[item] for case in card.cases}
    rows = [(one, two, texts[one.group]) for one, two in (agreed.apart if agreed else ())
            if one.group in texts]  # fmt: skip
    return {"asked": asked, "agreed": agreed, "rows": rows, "number": index.numbers[item],
            "rubric": desk.rubric(item)}  # fmt: skip


async def settle(request: Request) -> Response:
    """Write which points count where two markers differ; redirect to the rest."""
    form, who, desk = await read_form(request), get_marker(request), _get_desk(request)
    return await run_in_threadpool(_settle, form, who, desk)


def _settle(form: FormData, who: Marker, desk: MarkingDesk) -> Response:
    """Write what settles a disagreement; return where the others are."""
    item, group = field_text(form, "item"), field_text(form, "group")
    asked = _read_round(desk, who, item, "")
    agreed = agreement_by_item(desk.state().rulings).get(item)
    pair = next((one for one in (agreed.apart if agreed else ()) if one[0].group == group), None)
    if pair is None:
        return redirect(asked.url(page="apart"))
    typed = field_text(form, "points").strip()
    chosen = pair[field_text(form, "take") == "second"]
    try:
        if typed:
            points = write_points(parse_points(typed))
            chosen = msgspec.structs.replace(chosen, value=points, lines="", comment="")
        why = f"{SETTLED}: " + ", ".join(f"{one.who} {one.value}" for one in pair)
        made = msgspec.structs.replace(
            chosen, what=DECIDE, who=who.name, when="", because=why,
            comment=field_text(form, "remark").strip() or chosen.comment,
        )  # fmt: skip
        made.check()
        check_points(made, str(desk.index().worth[group]))
        now = desk.state().first[group]
        desk.decide([made], {group: now.step})
    except (ClassError, FormulaError):
        return redirect(asked.url(page="apart", note="range"))
    return redirect(asked.url(page="apart"))


async def save_markers(request: Request) -> Response:
    """Write who marks an item; only for who manages."""
    form, who, desk = await read_form(request), get_marker(request), _get_desk(request)
    if not who.manages:
        raise HTTPException(403)
    asked = await run_in_threadpool(_read_round, desk, who, field_text(form, "item"), "")
    markers = ItemMarkers(*(split_names(field_text(form, name)) for name in ("first", "second")))
    try:
        await run_in_threadpool(write_markers, desk.folder, asked.item, markers)
    except ClassError:
        return redirect(f"{PLACE}?note=busy")
    return redirect(PLACE)


async def save_name(request: Request) -> Response:
    """Note in this browser who marks; where people sign in that is known."""
    form = await read_form(request)
    get_marker(request)
    name = quote(field_text(form, "who").strip()[:LONGEST_NAME])
    return set_cookie(request.scope, redirect(PLACE), COOKIE, name, COOKIE_DAYS * 86_400)


async def regrade(request: Request) -> Response:
    """Mark the class again with all that was decided; redirect to the overview."""
    await read_form(request)
    get_marker(request)
    folder = ClassFolder(_get_desk(request).folder)
    try:
        run = await run_in_threadpool(grade_class, folder, InlineExecutor(), 1)
    except ClassError:
        return redirect(f"{PLACE}?note=busy")
    return redirect(f"{PLACE}?note=marked&count={len(run.outcome.changes)}")


async def show_crop(request: Request) -> Response:
    """Return the picture of a part of a paper; HTTP 404 if there is none."""
    get_marker(request)
    index = await run_in_threadpool(_get_desk(request).index)
    try:
        student = index.keys.find_by_code(request.path_params["code"])
    except ClassError:
        raise HTTPException(404) from None
    path = index.crop(student, request.path_params["part"])
    if path is None:
        raise HTTPException(404)
    return FileResponse(path, media_type="image/png")


ROUTES = [
    Route(PLACE, show_overview),
    Route(f"{PLACE}/answer", show_answer),
    Route(f"{PLACE}/list", show_list),
    Route(f"{PLACE}/apart", show_apart),
    Route(f"{PLACE}/crop/{{code}}/{{part}}", show_crop),
    Route(f"{PLACE}/decide", save_decision, methods=["POST"]),
    Route(f"{PLACE}/typed", save_typed, methods=["POST"]),
    Route(f"{PLACE}/undo", undo_decision, methods=["POST"]),
    Route(f"{PLACE}/line", change_line, methods=["POST"]),
    Route(f"{PLACE}/settle", settle, methods=["POST"]),
    Route(f"{PLACE}/markers", save_markers, methods=["POST"]),
    Route(f"{PLACE}/name", save_name, methods=["POST"]),
    Route(f"{PLACE}/mark", regrade, methods=["POST"]),
]
