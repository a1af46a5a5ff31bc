"""The evening before the exam: where somebody stands, and what to do in the minutes there are."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup
from starlette.requests import Request

from quizgen.bank.bank import Bank
from quizgen.bank.language_file import read_language_file
from quizgen.paper.blueprint import EVERYTHING, find_blueprint, longest_minutes
from quizgen.practice.scheduler import days_left, local_date
from quizgen.practice.selection import matching_templates
from quizgen.practice.session_state import PracticeRequest
from quizgen.store.learner import LearnerProgress
from quizgen.web.state import ServerState
from quizgen.web.views import request_language

if TYPE_CHECKING:
    from quizgen.practice.exam_plan import ExamPlan, ScoreEstimate

MINUTES = (15, 25, 45, 60, 90)
"""How long somebody may say to have; the second is meant where nobody has said."""
MOST_TASKS = 12
"""Questions of the exam that have a card of their own; of more only topics are shown."""
BLADES, RADIUS = 7, 20.0
"""Of the aperture that opens with what is known: its radius when wide open, of a picture of 48."""


@dataclass(frozen=True)
class ExamTask:
    """A question of the exam, as the start page shows it.

    Parameters
    ----------
    template, title : str
        The template that is practised for it.
    points, expected : float
        What it is worth, and what it would bring today.
    tried : bool
        Whether it was ever asked.
    """

    template: str
    title: str
    points: float
    expected: float
    tried: bool

    @property
    def aperture(self) -> Markup:
        """Return an aperture whose opening is the share of the points."""
        return draw_aperture(self.expected / self.points if self.tried else 0.0)


@dataclass(frozen=True)
class TonightView:
    """What the start page says first.

    Parameters
    ----------
    left : int, optional
        Days until the exam.
    estimate : ScoreEstimate, optional
        None before there is evidence.
    missing : int
        Questions until there is some.
    minutes : int
        That the learner has.
    takes : int
        Minutes of the block that fits into them.
    count : int
        Its questions.
    exam, exam_title : str
        Name and title of the blueprint that is practised for; empty if there is none.
    exam_minutes : int
        How long it takes; 0 if it does not say.
    tasks : tuple of ExamTask
    """

    left: int | None
    estimate: ScoreEstimate | None
    missing: int
    minutes: int
    takes: int
    count: int
    exam: str
    exam_title: str
    exam_minutes: int
    tasks: tuple[ExamTask, ...]


def progress_of(request: Request) -> LearnerProgress:
    """Return the progress of the learner who sent a request."""
    site: ServerState = request.app.state.site
    return LearnerProgress(site.store, site.bank, request.state.learner)


def readable_templates(request: Request) -> tuple[str, ...]:
    """Return the templates that are written in the learner's language."""
    site: ServerState = request.app.state.site
    return matching_templates(site.bank, PracticeRequest(request_language(request)))


def look_at_tonight(request: Request) -> TonightView | None:
    """Return where the learner stands and what fits into the minutes; None without a question."""
    learning, names, lang = (
        progress_of(request), readable_templates(request), request_language(request),
    )  # fmt: skip
    if not names:
        return None
    plan = learning.plan(names)
    minutes = chosen_minutes(request)
    block = plan.plan_block(minutes)
    blueprint = find_blueprint(plan.goal.name, learning.bank)
    named = blueprint is not None and plan.goal.name != EVERYTHING
    return TonightView(
        days_left(learning.exam, local_date(plan.model.clock * 86400)),
        plan.estimate(),
        plan.missing,
        minutes,
        round(block.minutes),
        len(block.templates),
        plan.goal.name if named else "",
        blueprint.title.get(lang, blueprint.title["en"]) if blueprint and named else "",
        longest_minutes(blueprint) if blueprint else 0,
        tuple(_list_tasks(plan, learning.bank, lang)),
    )


def chosen_minutes(request: Request) -> int:
    """Return the minutes that the learner has said to have."""
    said = str(request.state.learner.settings.get("minutes", ""))
    return int(said) if said in map(str, MINUTES) else MINUTES[1]


def _list_tasks(plan: ExamPlan, bank: Bank, lang: str) -> Iterator[ExamTask]:
    """Yield the questions of the exam, unless there are too many for cards."""
    if len(plan.goal.slots) > MOST_TASKS:
        return
    tried = {one.template for one in plan.attempts}
    for slot in plan.goal.slots:
        name = slot.templates[0]
        yield ExamTask(
            name,
            template_title(bank, name, lang),
            slot.points,
            slot.points * plan.expected_share(slot),
            any(one in tried for one in slot.templates),
        )


def template_title(bank: Bank, name: str, lang: str) -> str:
    """Return the title of a template in a language, or in one that it is written in."""
    there = bank.template_languages(name)
    found = lang if lang in there else next(iter(there))
    return read_language_file(bank.template_paths[name] / f"{found}.md").title


def draw_aperture(share: float) -> Markup:
    """Return a picture of an aperture whose open area is a share of the whole, 0 to 1."""
    opening = RADIUS * math.sqrt(min(max(share, 0.02), 1.0))
    corners = [_corner(opening, turn) for turn in range(BLADES)]
    rims = [_corner(RADIUS, turn + 1.6) for turn in range(BLADES)]
    blades = " ".join(
        f"M{x:.1f} {y:.1f}L{to_x:.1f} {to_y:.1f}"
        for (x, y), (to_x, to_y) in zip(corners, rims, strict=True)
    )
    outline = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
    return Markup(
        '<svg class="aperture" viewBox="0 0 48 48" width="40" height="40" aria-hidden="true">'
        '<circle class="rim" cx="24" cy="24" r="22"/><path class="blades" d="{}"/>'
        '<polygon class="opening" points="{}"/></svg>'
    ).format(blades, outline)


def _corner(radius: float, turn: float) -> tuple[float, float]:
    """Return a point on a circle around the middle, a number of blades on from the right."""
    angle = 2 * math.pi * turn / BLADES + 0.3
    return 24 + radius * math.cos(angle), 24 + radius * math.sin(angle)
