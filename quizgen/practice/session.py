"""A session: which question comes next, what has been done, and the summary at its end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import msgspec

from quizgen.bank.bank import Bank
from quizgen.core.errors import require_one_of
from quizgen.grading.options import DECIMALS, GradingOptions
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
    """One attempt at a question: its number (from 1), its seed and its part attempts."""

    number: int
    seed: str
    level: str
    question: Question
    tasks: tuple[PartAttempt[QuestionPart, PartSolution], ...]

    @property
    def outcomes(self) -> tuple[PartOutcome, ...]:
        """Return the outcomes of the parts that have ended."""
        return tuple(task.outcome for task in self.tasks if task.outcome is not None)

    @property
    def parts(self) -> dict[str, PartState]:
        """Return the state of each part by its label."""
        return {task.part.label: task.state for task in self.tasks}

    @property
    def is_finished(self) -> bool:
        """Whether every part has ended."""
        return len(self.outcomes) == len(self.tasks)


class Session:
    """A practice session: one question after another, chosen by its seed or by ``choose``.

    Parameters
    ----------
    bank : Bank
    state : SessionState
        A new one, or one that was kept.
    choose : callable, optional
        Gives template and seed of the question to be asked next, from the templates that fit.
    decimal : str
        The decimal sign that the learner declared: ``auto``, ``point`` or ``comma``.

    Raises
    ------
    InvalidChoiceError
        If there is no such language.
    """

    def __init__(
        self,
        bank: Bank,
        state: SessionState,
        choose: QuestionChooser | None = None,
        decimal: str = DECIMALS[0],
    ) -> None:
        require_one_of("language", state.wish.lang, list_languages())
        self.bank, self.state, self._choose = bank, state, choose or self._choose_by_seed
        self.decimal = decimal
        self.templates = matching_templates(bank, state.wish)
        """Names of the templates that fit the wish; without any the session is finished."""

    @property
    def is_finished(self) -> bool:
        """Whether the requested number of questions is done, or no template fits."""
        return not self.templates or self.state.done >= self.state.wish.count

    def current_question(self) -> QuestionAttempt:
        """Return the open question with its progress; the same one until ``finish``.

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
        marker = QuestionGrader(keyed, GradingOptions(wish.lang, self.decimal))
        parts = zip(
            question.parts,
            key.solution.parts,
            keyed.parts,
            self._restore_part_states(key),
            strict=True,
        )
        tasks = (PartAttempt(question.topic, *one, marker=marker) for one in parts)
        return QuestionAttempt(number, seed, key.level, question, tuple(tasks))

    def _choose_by_seed(self, names: Sequence[str]) -> tuple[str, str]:
        """Return template and question seed that the session's seed gives: the default chooser."""
        seed, number = self.state.seed, self.state.done + 1
        return template_at(self.bank, names, seed, number), question_seed(seed, number)

    def _restore_part_states(self, key: QuestionKey) -> list[PartState]:
        """Return the stored progress of the parts, or new states if the question has changed.

        A bank may change between two runs; progress in another question must not count.
        """
        kept = self.state.question, len(self.state.parts)
        if kept != (key.identity, len(key.specs)):
            self.state.question = key.identity
            self.state.parts = [PartState() for _ in key.specs]
        return self.state.parts

    def finish(self, attempt: QuestionAttempt) -> None:
        """Record the outcomes of a question, and advance to the next."""
        self.state.outcomes = [*self.state.outcomes, *attempt.outcomes]
        self.state.done = attempt.number
        self.state.due, self.state.question, self.state.parts = None, "", []

    def summary(self) -> tuple[TopicResult, ...]:
        """Return the results by topic, in alphabetical order."""
        return summarise_by_topic(self.state.outcomes)
