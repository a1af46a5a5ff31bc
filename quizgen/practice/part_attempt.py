"""One part being asked: tries, hints one by one, feedback, and how it went."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from typing import Any, Generic, Protocol, TypeVar

import msgspec
from msgspec import structs

from quizgen.core.errors import AttemptFinishedError
from quizgen.grading.verdict import Verdict
from quizgen.kinds.rubric import Suggestion, suggest_marks
from quizgen.paper.answer_key import KeyPart
from quizgen.paper.grading import OwnValue, QuestionGrader
from quizgen.practice.scheduler import NAMED
from quizgen.practice.session_state import PartOutcome, PartState

TRIES = 3
"""Wrong answers after which the solution is shown."""


class NextStep(Enum):
    """What is to happen after an answer."""

    ASK_BACK = "ask back"
    """It could not be read as meant; that cost no try."""
    AGAIN = "again"
    """Not right yet, and there are tries left."""
    SELF_MARK = "self-mark"
    """Show the solution and let the learner say whether the answer was right."""
    RIGHT = "right"
    OUT_OF_TRIES = "out of tries"


class AnswerFeedback(msgspec.Struct, frozen=True):
    """The verdict on one answer, what happens next and how many tries are left.

    Parameters
    ----------
    verdict : Verdict
        Without words: ``PartAttempt.explain_verdict`` finds them where it is shown.
    then : NextStep
        What is to happen now.
    left : int
        Tries that are left.
    """

    verdict: Verdict
    then: NextStep
    left: int


class HintSource(Protocol):
    """A worked solution whose lines carry hints, shown one by one."""

    @property
    def lines(self) -> Sequence[Any]:
        """Lines with ``hints``, in order."""


P = TypeVar("P")
S = TypeVar("S", bound=HintSource)


class PartAttempt(Generic[P, S]):
    """One attempt at a part: it lasts until it is right, given up, skipped or out of tries.

    Parameters
    ----------
    topic : str
    part : P
        What is shown.
    solved : S
        Its worked solution, shown when the part has ended.
    keyed : KeyPart
        What it is marked by.
    state : PartState
        How far it has got; changed as it goes on.
    marker : QuestionGrader
        Of the whole question: it carries errors forward to the parts that follow.

    Notes
    -----
    Once a part has an outcome, whatever would change it raises ``AttemptFinishedError``.
    """

    @property
    def kind(self) -> str:
        """Return the answer kind, such as ``number``."""
        return str(self._keyed.spec["kind"])

    def __init__(
        self,
        topic: str,
        part: P,
        solved: S,
        keyed: KeyPart,
        state: PartState,
        *,
        marker: QuestionGrader,
    ) -> None:
        self.topic, self.part, self.solved, self.state = topic, part, solved, state
        self._keyed, self._marker = keyed, marker
        self.verdict = (
            marker.judge_part(keyed, state.typed, state.decimal).verdict if state.typed else None
        )
        """On the last answer that could be read, without words."""

    @property
    def outcome(self) -> PartOutcome | None:
        """Return how the part went; None while it is open."""
        return self.state.outcome

    def next_hint(self) -> Any:
        """Count one more hint as used and return it; None if all were given."""
        if not self.more_hints:
            return None
        self.state.hints += 1
        return self._available_hints[self.state.hints - 1]

    @property
    def hints(self) -> Sequence[Any]:
        """Return the hints given so far."""
        return self._available_hints[: self.state.hints]

    @property
    def more_hints(self) -> bool:
        """Whether there is another hint."""
        return self.state.hints < len(self._available_hints)

    @property
    def _available_hints(self) -> list[Any]:
        """Return all hints of the solution, in the order they are given."""
        return [hint for line in self.solved.lines for hint in line.hints]

    def give_up(self) -> None:
        """End the part as wrong; raise ``AttemptFinishedError`` if it has ended."""
        if not self.state.tries:
            self.state.helped = bool(self.state.hints)
        self._finish_part(right=False)

    def skip(self) -> None:
        """End the part as neither right nor wrong."""
        self._require_unfinished()
        self.state.outcome = PartOutcome(self.topic, right=False, first=False, skipped=True)

    def declare_decimal(self, decimal: str) -> None:
        """Read the answers to the whole question by a decimal sign: ``point`` or ``comma``."""
        self._marker.options = structs.replace(self._marker.options, decimal=decimal)

    def answer(self, typed: str) -> AnswerFeedback:
        """Grade an answer and return the feedback; an unreadable one costs no try.

        Raises
        ------
        AttemptFinishedError
            The part has ended: its solution may have been shown.
        """
        self._require_unfinished()
        verdict = self._marker.judge_part(self._keyed, typed).verdict
        then = self._decide_next_step(verdict)
        if self.state.tries == 1 and then is not NextStep.ASK_BACK:
            self.state.credit, self.state.helped = float(verdict.credit), bool(self.state.hints)
        if then is not NextStep.ASK_BACK:
            self.state.typed, self.verdict = typed, verdict
            self.state.decimal = self._marker.options.decimal
        if then in {NextStep.AGAIN, NextStep.OUT_OF_TRIES}:
            self.state.wrong, self.state.note = typed, verdict.note
            if verdict.note.startswith(NAMED):
                self.state.mistakes.setdefault(verdict.note, typed)
        if then in {NextStep.RIGHT, NextStep.OUT_OF_TRIES}:
            self._finish_part(right=then is NextStep.RIGHT)
        return AnswerFeedback(verdict, then, TRIES - self.state.tries)

    def explain_verdict(self, verdict: Verdict) -> Verdict:
        """Return the verdict with its sentence, in the language of the learner.

        While there are tries left, reasons that tell the right answer are held back.
        """
        return self._marker.explain_part(self._keyed, verdict, reveal=self.outcome is not None)

    def own_values(self) -> dict[str, OwnValue]:
        """Return what the learner gave instead of the right values, by quantity.

        Empty where nothing could be read as numbers, or all is right.
        """
        if self.verdict is None or self.verdict.verdict == "correct":
            return {}
        return self._marker.own_values(self._keyed, self.verdict)

    def explain_wrong(self) -> str:
        """Return in words what the last wrong answer was; empty if there is none."""
        if not self.state.wrong:
            return ""
        judged = self._marker.judge_part(self._keyed, self.state.wrong, self.state.decimal)
        return str(self._marker.explain_part(self._keyed, judged.verdict, reveal=True).message)

    def _decide_next_step(self, verdict: Verdict) -> NextStep:
        """Return what follows a verdict; count a try unless it could not be read."""
        self_marked = verdict.needs_self_marking
        if not verdict.is_graded and not self_marked:
            return NextStep.ASK_BACK
        self.state.tries += 1
        if self_marked:
            return NextStep.SELF_MARK
        if verdict.verdict == "correct":
            return NextStep.RIGHT
        return NextStep.AGAIN if self.state.tries < TRIES else NextStep.OUT_OF_TRIES

    def self_mark(self, share: float) -> None:
        """End the part with the share of its points, 0 to 1, that the learner gives it."""
        self._require_unfinished()
        if self.state.tries == 1:
            self.state.credit = share
        self._finish_part(right=share >= 1)

    def suggest(self) -> Suggestion | None:
        """Return what is suggested of an own sentence; None for every other kind of answer."""
        return suggest_marks(self._keyed.parse_spec(proven=True), self.state.typed)

    def wrong_ideas(self, made: Suggestion) -> list[str]:
        """Return what to tell of the known wrong ideas in an own sentence."""
        spec = self._keyed.parse_spec(proven=True)
        known = spec.notes.get(self._marker.options.lang, {})
        return [known[name] for name in made.mistakes if name in known]

    def _require_unfinished(self) -> None:
        """Raise ``AttemptFinishedError`` if the part has an outcome."""
        # A second request, or a page left open, must not turn a solution read into marks.
        if self.outcome is not None:
            raise AttemptFinishedError("this part has ended; what follows does not count")

    def _finish_part(self, *, right: bool) -> None:
        """Record the outcome; ``first`` is set for a right first try without hints."""
        self._require_unfinished()
        first = right and self.state.tries == 1 and not self.state.hints
        self.state.outcome = PartOutcome(self.topic, right, first)
