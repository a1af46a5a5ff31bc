"""What whoever asks has done, and what today asks for."""

from __future__ import annotations

from dataclasses import dataclass

from starlette.requests import Request

from quizgen.bank.rules import minutes_of
from quizgen.practice.choosing import fitting
from quizgen.practice.state import Wish
from quizgen.web.learning import Learning
from quizgen.web.site import Site
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


def learning_of(request: Request) -> Learning:
    """What whoever asks has done and is to do."""
    site: Site = request.app.state.site
    return Learning(site.store, site.bank, request.state.learner)


def readable(request: Request) -> tuple[str, ...]:
    """Templates in the language of who asks."""
    site: Site = request.app.state.site
    return fitting(site.bank, Wish(lang_of(request)))


def today(request: Request) -> Today:
    """What today asks for."""
    agenda, names = learning_of(request).agenda(), readable(request)
    ready, fresh = agenda.ready(names), agenda.fresh(names)
    minutes = {name: minutes_of(agenda.bank.rules(name)) for name in names}
    usual = sum(minutes.values()) / max(1, len(minutes))
    whole = sum(minutes[name] for name in ready) + fresh * usual
    return Today(len(ready), fresh, round(whole), agenda.left)
