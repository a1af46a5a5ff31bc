"""What a learner is to do next, and what a finished question changes in it."""

from __future__ import annotations

import hashlib
import secrets
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import date

from starlette.requests import Request

from quizgen.bank.rules import minutes_of
from quizgen.practice.agenda import Agenda
from quizgen.practice.choosing import fitting
from quizgen.practice.schedule import Asked, day_of, days_left
from quizgen.practice.state import Outcome, Wish
from quizgen.web.site import Site
from quizgen.web.store import Attempt, Which
from quizgen.web.turn import Turn
from quizgen.web.views import lang_of


@dataclass(frozen=True)
class Today:
    """What today asks for.

    Parameters
    ----------
    ready, fresh : int
        Templates that are due, and new ones.
    minutes : int
        About how long that takes.
    left : int, optional
        Days until the exam.
    """

    ready: int
    fresh: int
    minutes: int
    left: int | None


def exam_day(request: Request) -> date | None:
    """The day of the exam that a learner has set."""
    try:
        return date.fromisoformat(str(request.state.learner.settings.get("exam", "")))
    except ValueError:
        return None


def agenda_of(request: Request) -> Agenda:
    """What whoever asks has to do."""
    site: Site = request.app.state.site
    cards = site.store.cards.all(request.state.learner.id)
    return Agenda(site.bank, cards, time.time(), exam_day(request))


def readable(request: Request) -> tuple[str, ...]:
    """Templates in the language of who asks."""
    site: Site = request.app.state.site
    return fitting(site.bank, Wish(lang_of(request)))


def today(request: Request) -> Today:
    """What today asks for."""
    agenda, names = agenda_of(request), readable(request)
    ready, fresh = agenda.ready(names), agenda.fresh(names)
    minutes = {name: minutes_of(agenda.bank.rules(name)) for name in names}
    usual = sum(minutes.values()) / max(1, len(minutes))
    whole = sum(minutes[name] for name in ready) + fresh * usual
    return Today(len(ready), fresh, round(whole), agenda.left)


def following_of(request: Request, names: Sequence[str]) -> Which:
    """The question of these templates that is to be done next."""
    site: Site = request.app.state.site
    learner = request.state.learner.id
    latest = site.store.latest(learner, 1)
    seed = _seed_after(latest)
    template = agenda_of(request).next(
        names,
        [Outcome(one.topic, one.right, one.first) for one in site.store.seen(learner)],
        site.store.times(learner),
        latest[0].template if latest else "",
        seed,
    )
    return Which(template, seed)


def seed_of_next(request: Request) -> str:
    """Seed of the question that is begun next."""
    site: Site = request.app.state.site
    return _seed_after(site.store.latest(request.state.learner.id, 1))


def _seed_after(latest: Sequence[Attempt]) -> str:
    """By chance; the same until another is begun, so that it can be made before it is asked."""
    if not latest:
        return secrets.token_hex(4)
    return hashlib.sha256(latest[0].id.encode()).hexdigest()[:8]


def count_turn(request: Request, turn: Turn) -> None:
    """Take a practised question into the schedule; the same numbers again say nothing new."""
    site: Site = request.app.state.site
    asked = turn.asked(site.bank.origin(turn.attempt.template))
    if asked is not None and not site.store.known(turn.attempt):
        count(request, [asked])


def count(request: Request, asked: Iterable[Asked]) -> None:
    """Take finished questions into the schedule."""
    site: Site = request.app.state.site
    now = time.time()
    left = days_left(exam_day(request), day_of(now))
    site.store.cards.review(request.state.learner.id, asked, now, left)
