"""A session: which question comes next, what has been done, and the summary at its end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import msgspec

from quizgen.bank.folder import Bank
from quizgen.errors import one_of
from quizgen.locale import languages
from quizgen.marking.options import Options
from quizgen.paper.key import key_question
from quizgen.paper.marking import Marker
from quizgen.paper.paper import Item
from quizgen.practice.choosing import fitting, nth, seed_of
from quizgen.practice.results import TopicResult, by_topic
from quizgen.practice.state import Outcome, PartState, State
from quizgen.practice.task import Task
from quizgen.question.compose import Key, Part, Question, instance, put_into_words
from quizgen.question.solution import PartSolution

Choose: TypeAlias = Callable[[Sequence[str]], tuple[str, str]]


class Turn(msgspec.Struct, frozen=True):
    """One question of a session and its tasks, in order."""

    number: int
    seed: str
    level: str
    question: Question
    tasks: tuple[Task[Part, PartSolution], ...]

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """Outcomes of the tasks that are done."""
        return tuple(task.outcome for task in self.tasks if task.outcome is not None)

    @property
    def parts(self) -> dict[str, PartState]:
        """Label of each part and how far it has got."""
        return {task.part.label: task.state for task in self.tasks}

    @property
    def finished(self) -> bool:
        """Whether every task is done."""
        return len(self.outcomes) == len(self.tasks)


class Session:
    """Questions one after another, as a wish and a seed fix them or as somebody else chooses.

    Parameters
    ----------
    bank : Bank
    state : State
        A new one, or one that was kept.
    choose : callable, optional
        Gives template and seed of the question to be asked next, from the templates that fit.

    Raises
    ------
    ChoiceError
        If there is no such language.
    """

    def __init__(self, bank: Bank, state: State, choose: Choose | None = None) -> None:
        one_of("language", state.wish.lang, languages())
        self.bank, self.state, self._choose = bank, state, choose or self._by_seed
        self.templates = fitting(bank, state.wish)
        """Names of the templates that fit the wish; without any the session is finished."""

    @property
    def finished(self) -> bool:
        """Whether there is nothing more to ask."""
        return not self.templates or self.state.done >= self.state.wish.count

    def turn(self) -> Turn:
        """The question that is due, as far as it has got; the same until it is finished.

        Raises
        ------
        BankError, DrawError
            If its template is wrong.
        """
        number = self.state.done + 1
        if self.state.due is None or self.state.due[0] not in self.templates:
            self.state.due = self._choose(self.templates)
        name, seed = self.state.due
        drawn = instance(self.bank.template(name), seed)
        wish = self.state.wish
        question, key = put_into_words(drawn, wish.lang, number=str(number), level=wish.level)
        keyed = key_question(Item(str(number), (question,), (key,)))
        marker = Marker(keyed, Options(wish.lang))
        parts = zip(question.parts, key.solution.parts, keyed.parts, self._parts(key), strict=True)
        tasks = (Task(question.topic, *one, marker=marker) for one in parts)
        return Turn(number, seed, key.level, question, tuple(tasks))

    def _by_seed(self, names: Sequence[str]) -> tuple[str, str]:
        """Every template once, in an order of the session's seed, before one returns."""
        seed, number = self.state.seed, self.state.done + 1
        return nth(self.bank, names, seed, number), seed_of(seed, number)

    def _parts(self, key: Key) -> list[PartState]:
        """How far the parts have got; nowhere, if they are not those that were kept."""
        kept = self.state.question, len(self.state.parts)
        if kept != (key.identity, len(key.specs)):
            self.state.question = key.identity
            self.state.parts = [PartState() for _ in key.specs]
        return self.state.parts

    def finish(self, turn: Turn) -> None:
        """Write down how a question went, and go on to the next."""
        self.state.outcomes = [*self.state.outcomes, *turn.outcomes]
        self.state.done = turn.number
        self.state.due, self.state.question, self.state.parts = None, "", []

    def summary(self) -> tuple[TopicResult, ...]:
        """Results by topic, in alphabetical order."""
        return by_topic(self.state.outcomes)
