"""The evening before the exam: where somebody stands, and what to do in the minutes there are."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from datetime import timedelta
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
from quizgen.web.lens_drawing import draw_aperture
from quizgen.web.state import ServerState
from quizgen.web.views import request_language

if TYPE_CHECKING:
    from quizgen.practice.exam_plan import ExamPlan, ScoreEstimate

MINUTES = (15, 25, 45, 60, 90)
"""How long somebody may say to have; the second is meant where nobody has said."""
LOOKED_AT = 300
"""Attempts that are looked at for days in a row."""
SAID = {"exam", "minutes"}
"""Settings that somebody has who has been here before."""
MOST_TASKS = 12
"""Questions of the exam that have a card of their own; of more only topics are shown."""


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
class BlockEntry:
    """Questions of one kind in the block that is proposed.

    Parameters
    ----------
    title : str
    count : int
    minutes : int
    gain : float
        Points of the exam that they are expected to bring.
    in_exam : bool
        Whether the exam may ask all of them.
    """

    title: str
    count: int
    minutes: int
    gain: float
    in_exam: bool


@dataclass(frozen=True)
class TopicRow:
    """A section of the notes, or a topic: how much of it is known, how long it takes.

    Parameters
    ----------
    kind : str
        ``section`` or ``topic``.
    name, title : str
    minutes : int
    aperture : Markup
    """

    kind: str
    name: str
    title: str
    minutes: int
    aperture: Markup


@dataclass(frozen=True)
class TonightView:
    """What the start page says first.

    Parameters
    ----------
    left : int, optional
        Days until the exam.
    estimate : ScoreEstimate, optional
        None before there is evidence.
    missing, missing_for_number : int
        Questions until there is a range, and until there is a number.
    worth : float
        Points of the exam.
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
    block : tuple of BlockEntry
        What the proposed questions are about.
    topics : tuple of TopicRow
        The rest of the notes.
    is_new : bool
        Whether nothing was asked yet.
    """

    left: int | None
    estimate: ScoreEstimate | None
    missing: int
    missing_for_number: int
    worth: float
    minutes: int
    takes: int
    count: int
    exam: str
    exam_title: str
    exam_minutes: int
    tasks: tuple[ExamTask, ...]
    block: tuple[BlockEntry, ...]
    topics: tuple[TopicRow, ...]
    is_new: bool

    @property
    def gain(self) -> float:
        """The points that the block is expected to bring, in halves."""
        return round(2 * sum(one.gain for one in self.block)) / 2

    @property
    def expected_points(self) -> float | None:
        """The points that the exam would bring today; None before there is evidence."""
        return self.estimate.expected if self.estimate else None


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
    from quizgen.practice.exam_plan import FROM_NUMBER  # NumPy, only where it is asked

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
        max(0, FROM_NUMBER - plan.evidence),
        plan.goal.points,
        minutes,
        round(block.minutes),
        len(block.templates),
        plan.goal.name if named else "",
        blueprint.title.get(lang, blueprint.title["en"]) if blueprint and named else "",
        longest_minutes(blueprint) if blueprint else 0,
        tuple(_list_tasks(plan, learning.bank, lang)),
        tuple(_list_entries(plan, block.templates, learning.bank, lang)),
        tuple(_list_topics(plan, names, learning.bank, lang)),
        not (
            learning.store.latest(learning.learner.id, 1)
            or {*request.state.learner.settings} & SAID
        ),
    )


def count_days(request: Request) -> int:
    """Return on how many days in a row, up to today, the learner has begun a question."""
    learning = progress_of(request)
    days = {local_date(one.begun) for one in learning.store.latest(learning.learner.id, LOOKED_AT)}
    day, count = local_date(time.time()), 0
    if day not in days:
        day -= timedelta(days=1)
    while day in days:
        day, count = day - timedelta(days=1), count + 1
    return count


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


def _list_entries(
    plan: ExamPlan, templates: Sequence[str], bank: Bank, lang: str
) -> Iterator[BlockEntry]:
    """Yield the questions of a block: those of one template by its title, others by topic."""
    model = plan.model
    minutes, rates = model.working_minutes(model.expected_credit()), plan.gain_per_minute(model)
    groups: dict[str, list[int]] = {}
    for name in templates:
        groups.setdefault(bank.rules(name).topic, []).append(model.places[name])
    for topic, places in groups.items():
        gain = float(sum(rates[place] * minutes[place] for place in set(places)))
        names = {model.items[place].name for place in places}
        title = template_title(bank, min(names), lang) if len(names) == 1 else ""
        yield BlockEntry(
            title or bank.topic_title(topic, lang), len(places),
            max(1, round(float(sum(minutes[place] for place in places)))), gain,
            names <= plan.goal.templates,
        )  # fmt: skip


def _list_topics(
    plan: ExamPlan, names: Collection[str], bank: Bank, lang: str
) -> Iterator[TopicRow]:
    """Yield the sections of the notes, then topics that are in none, with what is known of each."""
    places = [
        place
        for place, item in enumerate(plan.model.items)
        if item.name in names and not item.beyond
    ]
    rows = [
        *(("section", one.section) for one in bank.curriculum.notes),
        *(("topic", topic) for topic in bank.topics),
    ]
    groups: dict[tuple[str, str], list[int]] = {row: [] for row in rows}
    for place in places:
        item = plan.model.items[place]
        section = bank.notes_section(item.name)
        groups["section" if section else "topic", section or item.topic].append(place)
    credit, seen = plan.model.expected_credit(), {one.template for one in plan.attempts}
    for (kind, name), of in groups.items():
        if of:
            known = [credit[p] if plan.model.items[p].name in seen else 0.0 for p in of]
            title = bank.section_title if kind == "section" else bank.topic_title
            yield TopicRow(
                kind, name, title(name, lang),
                round(sum(plan.model.items[place].minutes for place in of)),
                draw_aperture(sum(map(float, known)) / len(of)),
            )  # fmt: skip


def template_title(bank: Bank, name: str, lang: str) -> str:
    """Return the title of a template in a language, or in one that it is written in."""
    there = bank.template_languages(name)
    found = lang if lang in there else next(iter(there))
    return read_language_file(bank.template_paths[name] / f"{found}.md").title
