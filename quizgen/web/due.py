"""What a learner has done, and what is due today."""

from __future__ import annotations

from dataclasses import dataclass

from starlette.requests import Request

from quizgen.bank.rules import suggested_minutes
from quizgen.practice.selection import matching_templates
from quizgen.practice.session_state import PracticeRequest
from quizgen.store.learner import LearnerProgress
from quizgen.web.state import ServerState
from quizgen.web.views import request_language


@dataclass(frozen=True)
class DueToday:
    """What is due today, for the start page.

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


def progress_of(request: Request) -> LearnerProgress:
    """Return the progress of the learner who sent a request."""
    site: ServerState = request.app.state.site
    return LearnerProgress(site.store, site.bank, request.state.learner)


def readable_templates(request: Request) -> tuple[str, ...]:
    """Return the templates that are written in the learner's language."""
    site: ServerState = request.app.state.site
    return matching_templates(site.bank, PracticeRequest(request_language(request)))


def due_today(request: Request) -> DueToday:
    """Return how many templates are due or new today, and about how long they take."""
    agenda, names = progress_of(request).agenda(), readable_templates(request)
    ready, fresh = agenda.due_templates(names), agenda.new_per_day(names)
    minutes = {name: suggested_minutes(agenda.bank.rules(name)) for name in names}
    usual = sum(minutes.values()) / max(1, len(minutes))
    whole = sum(minutes[name] for name in ready) + fresh * usual
    return DueToday(len(ready), fresh, round(whole), agenda.left)
