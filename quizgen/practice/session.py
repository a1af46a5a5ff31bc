"""A session: which question comes next, what has been done, and the summary at its end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import msgspec

from quizgen.bank.bank import Bank
from quizgen.core.errors import require_one_of
from quizgen.grading.options import GradingOptions
from quizgen.locale import list_languages
from quizgen.paper.answer_key import make_key_question
from quizgen.paper.grading import QuestionGrader
from quizgen.paper.paper import PaperItem
from quizgen.practice.part_attempt import PartAttempt
from quizgen.practice.selection import matching_templates, question_seed, template_at
from quizgen.practice.session_state import PartOutcome, PartState, SessionState
from quizgen.practice.topic_results import TopicResult, summarise_by_topic
from quizgen.question.compose import (
    Question,
    QuestionKey,
    QuestionPart,
    compose_variant,
    draw_instance,
)
from quizgen.question.solution import PartSolution

QuestionChooser: TypeAlias = Callable[[Sequence[str]], tuple[str, str]]


class QuestionAttempt(msgspec.Struct, frozen=True):
    """One question of a session and its tasks, in order."""

    number: int
    seed: str
    level: str
    question: Question
    tasks: tuple[PartAttempt[QuestionPart, PartSolution], ...]

    @property
    def outcomes(self) -> tuple[PartOutcome, ...]:
        """Outcomes of the tasks that are done."""
        return tuple(task.outcome for task in self.tasks if task.outcome is not None)

    @property
    def parts(self) -> dict[str, PartState]:
        """Label of each part and how far it has got."""
        return {task.part.label: task.state for task in self.tasks}

    @property
    def is_finished(self) -> bool:
        """Whether every task is done."""
        return len(self.outcomes) == len(self.tasks)


class Session:
    """Questions one after another, as a wish and a seed fix them or as somebody else chooses.

    Parameters
    ----------
    bank : Bank
    state : SessionState
        A new one, or one that was kept.
    choose : callable, optional
        Gives template and seed of the question to be asked next, from the templates that fit.

    Raises
    ------
    InvalidChoiceError
        If there is no such language.
    """

    def __init__(
        self, bank: Bank, state: SessionState, choose: QuestionChooser | None = None
    ) -> None:
        require_one_of("language", state.wish.lang, list_languages())
        self.bank, self.state, self._choose = bank, state, choose or self._by_seed
        self.templates = matching_templates(bank, state.wish)
        """Names of the templates that fit the wish; without any the session is finished."""

    @property
    def is_finished(self) -> bool:
        """Whether there is nothing more to ask."""
        return not self.templates or self.state.done >= self.state.wish.count

    def current_question(self) -> QuestionAttempt:
        """The question that is due, as far as it has got; the same until it is finished.

        Raises
        ------
        BankError, SamplingError
            If its template is wrong.
        """
        number = self.state.done + 1
        if self.state.due is None or self.state.due[0] not in self.templates:
            self.state.due = self._choose(self.templates)
        name, seed = self.state.due
        drawn = draw_instance(self.bank.template(name), seed)
        wish = self.state.wish
        question, key = compose_variant(drawn, wish.lang, number=str(number), level=wish.level)
        keyed = make_key_question(PaperItem(str(number), (question,), (key,)))
        marker = QuestionGrader(keyed, GradingOptions(wish.lang))
        parts = zip(
            question.parts,
            key.solution.parts,
            keyed.parts,
            self._restore_part_states(key),
            strict=True,
        )
        tasks = (PartAttempt(question.topic, *one, marker=marker) for one in parts)
        return QuestionAttempt(number, seed, key.level, question, tuple(tasks))

    def _by_seed(self, names: Sequence[str]) -> tuple[str, str]:
        """Every template once, in an order of the session's seed, before one returns."""
        seed, number = self.state.seed, self.state.done + 1
        return template_at(self.bank, names, seed, number), question_seed(seed, number)

    def _restore_part_states(self, key: QuestionKey) -> list[PartState]:
        """How far the parts have got; nowhere, if they are not those that were kept."""
        kept = self.state.question, len(self.state.parts)
        if kept != (key.identity, len(key.specs)):
            self.state.question = key.identity
            self.state.parts = [PartState() for _ in key.specs]
        return self.state.parts

    def finish(self, turn: QuestionAttempt) -> None:
        """Write down how a question went, and go on to the next."""
        self.state.outcomes = [*self.state.outcomes, *turn.outcomes]
        self.state.done = turn.number
        self.state.due, self.state.question, self.state.parts = None, "", []

    def summary(self) -> tuple[TopicResult, ...]:
        """Results by topic, in alphabetical order."""
        return summarise_by_topic(self.state.outcomes)
