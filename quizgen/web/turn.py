"""A question that somebody practises: its parts as tasks, and how far each has got."""

from __future__ import annotations

import time

import msgspec

from quizgen.marking.options import Options
from quizgen.marking.verdict import Verdict, unreadable
from quizgen.paper.key import KeyPart
from quizgen.paper.marking import Marker
from quizgen.practice.boxes import filled, joined
from quizgen.practice.state import PartState
from quizgen.practice.task import TRIES, Next, Task
from quizgen.shapes import converted
from quizgen.web.learning import seen_of
from quizgen.web.made import Made, MadePart
from quizgen.web.store import Attempt, Seen
from quizgen.web.unread import Unread, unread

HALF = unreadable("values-missing")
"""Said of fields of which some are empty."""


class Progress(msgspec.Struct):
    """How far a part has got, and what stands in its fields."""

    state: PartState = msgspec.field(default_factory=PartState)
    values: list[str] = msgspec.field(default_factory=list)
    asked_back: str = ""
    """What stands there, if it could not be read as meant."""


class Place:
    """A part on the page: its task, its fields, what was said of it last."""

    def __init__(
        self, task: Task[MadePart, MadePart], progress: Progress, verdict: Verdict | None, lang: str
    ) -> None:
        self.task, self.progress, self.verdict = task, progress, verdict
        self.part, self._lang = task.part, lang

    @property
    def name(self) -> str:
        """Its name in addresses."""
        return self.part.field.id

    @property
    def done(self) -> bool:
        """Whether it is answered, given up or skipped."""
        return self.task.outcome is not None

    @property
    def unread(self) -> Unread | None:
        """Why it could not be read, if it could not."""
        if self.verdict is None or not self.progress.asked_back:
            return None
        return unread(self.part.field, self.progress.values, self.verdict, self._lang)

    @property
    def left(self) -> int:
        """Tries that are left."""
        return TRIES - self.task.state.tries

    @property
    def to_judge(self) -> bool:
        """Whether the learner has to say whether it was right."""
        return not self.done and self.verdict is not None and self.verdict.self_marked


class Turn:
    """A question and how far it has got.

    Parameters
    ----------
    made : Made
        In the language of who asks.
    attempt : Attempt
    """

    def __init__(self, made: Made, attempt: Attempt) -> None:
        self.made, self.attempt = made, attempt
        kept = attempt.state.get("parts", {})
        self._marker = Marker(made.key, Options(made.wanted.lang))
        self.places = [
            self._place(part, keyed, converted(kept.get(part.field.id, {}), Progress))
            for part, keyed in zip(made.parts, made.key.parts, strict=True)
        ]

    def _place(self, part: MadePart, keyed: KeyPart, progress: Progress) -> Place:
        task = Task(self.made.topic, part, part, keyed, progress.state, marker=self._marker)
        verdict = task.verdict
        if progress.asked_back:
            whole = _whole(part, progress.values)
            verdict = self._marker.mark(keyed, progress.asked_back).verdict if whole else HALF
        return Place(task, progress, verdict, self.made.wanted.lang)

    def place(self, name: str) -> Place | None:
        """A part by its name."""
        return next((place for place in self.places if place.name == name), None)

    @property
    def finished(self) -> bool:
        """Whether every part is done."""
        return all(place.done for place in self.places)

    def answer(self, place: Place, values: list[str]) -> None:
        """Mark what stands in the fields of a part, unless that is nothing, or it is done.

        A field that was left out costs no try: Enter sends all of them from any of them.
        """
        typed = joined(place.part.field.control, values, place.part.field.marks)
        place.progress.values = values
        if not typed or place.done:
            return
        if not _whole(place.part, values):
            place.verdict, place.progress.asked_back = HALF, typed
            return
        feedback = place.task.answer(typed)
        place.verdict = feedback.verdict
        place.progress.asked_back = typed if feedback.then is Next.ASK_BACK else ""

    def keep(self) -> tuple[Seen, ...]:
        """Write into the attempt how far the question has got; say which parts have just ended."""
        before = self.attempt.state.get("ended", [])
        ended = [place for place in self.places if place.done]
        self.attempt.state = {
            "parts": {p.name: msgspec.to_builtins(p.progress) for p in self.places},
            "ended": [place.name for place in ended],
        }
        if self.finished and self.attempt.ended is None:
            self.attempt.ended = time.time()
        return tuple(self._seen(place) for place in ended if place.name not in before)

    @property
    def states(self) -> list[PartState]:
        """How far each part has got."""
        return [place.task.state for place in self.places]

    def _seen(self, place: Place) -> Seen:
        return seen_of(self.attempt.which, self.made.topic, place.part.label, place.task.state)


def _whole(part: MadePart, values: list[str]) -> bool:
    return filled(part.field.control, values, part.field.marks)
