"""A practice session as a conversation: what is shown, asked, typed and said to it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TypedDict, Unpack

import click

from quizgen.cli.terminal import columns, wrapped
from quizgen.figures import Figure
from quizgen.files import write_all
from quizgen.locale import FIRST
from quizgen.marking.messages import practice_words, read_back
from quizgen.outside import visible
from quizgen.practice.session import Session, Turn
from quizgen.practice.shelf import Shelf
from quizgen.practice.task import Next, Task
from quizgen.question.compose import Part
from quizgen.question.sheet import cited
from quizgen.question.solution import PartSolution
from quizgen.render.text import blocks, inline
from quizgen.web.learning import Learning
from quizgen.web.store import Which

COLOURS = {"correct": "green", "partial": "yellow", "wrong": "red"}

_CODE = "    "
_BULLET = re.compile(r" *(?:- )*")


class Style(TypedDict, total=False):
    """How a text stands out; nothing where colours are not wished."""

    fg: str
    bold: bool
    dim: bool


class Quit(Exception):  # noqa: N818 - a wish, not a failure
    """The learner wants to stop for now."""


def say(text: str, first: str = "", rest: str = "", **style: Unpack[Style]) -> None:
    """Print a text, broken between words at the width of the terminal."""
    for line in wrapped(visible(text), columns(), first, rest):
        click.secho(line, **style)


def head(text: str) -> None:
    """Print a heading, with a blank line above."""
    click.echo()
    say(text, bold=True)


def prose(lines: Iterable[str], first: str = "", rest: str = "") -> None:
    """Print lines of prose; program text keeps its lines, list items their indent."""
    for line in lines:
        if line.startswith(_CODE):
            click.echo(rest + visible(line))
        else:
            bullet = _BULLET.match(line)
            indent = bullet[0] if bullet else ""
            say(line[len(indent) :], first + indent, rest + " " * len(indent))
        first = rest


class Conversation:
    """One session on a terminal.

    Parameters
    ----------
    session : Session
    shelf : Shelf
        Where it is kept after every answer.
    learning : Learning
        Where every question is kept that is finished.
    """

    def __init__(self, session: Session, shelf: Shelf, learning: Learning) -> None:
        self.session, self.shelf, self.learning = session, shelf, learning
        self.words = practice_words(session.state.wish.lang)

    def hold(self) -> None:
        """Ask until every question is done.

        Raises
        ------
        Quit
            If the learner stops before.
        """
        while not self.session.finished:
            turn = self.session.turn()
            self._show_question(turn)
            for task in turn.tasks:
                if task.outcome is None:
                    self._ask(task)
            self.session.finish(turn)
            self._keep()
            which = Which(turn.question.template, turn.seed, turn.level)
            self.learning.practised(which, turn.question.topic, turn.parts)

    def _keep(self) -> None:
        self.shelf.keep(self.session.state)

    def _say(self, name: str, **blanks: object) -> None:
        say(self.words[name].format(**blanks))

    def _show_question(self, turn: Turn) -> None:
        count, title = self.session.state.wish.count, turn.question.title
        head(self.words["question"].format(number=turn.number, count=count, title=title))
        prose(blocks(turn.question.stem))
        self._show_figure(turn.question.figure)
        done = [f"({task.part.label})" for task in turn.tasks if task.outcome is not None]
        if done:
            self._say("done-before", parts=", ".join(done))

    def _show_figure(self, figure: Figure | None) -> None:
        if figure is None:
            return
        path = self.shelf.figure(self.session.state.wish)
        write_all(path.parent, {path.name: figure.standalone_svg})
        self._say("figure", alt=figure.alt)
        self._say("figure-file", path=path)

    def _ask(self, task: Task[Part, PartSolution]) -> None:
        """Ask a part until it is done."""
        self._show_part(task)
        while task.outcome is None:
            typed = self._typed(self.words["prompt"])
            with self._kept():
                self._take(task, typed)

    @contextmanager
    def _kept(self) -> Iterator[None]:
        """Keep what has been done, also if the learner stops in the middle of it."""
        try:
            yield
        finally:
            self._keep()

    def _take(self, task: Task[Part, PartSolution], typed: str) -> None:
        if typed == "?":
            self._hint(task)
        elif typed == "!":
            task.give_up()
            self._solution(task)
        elif self._means("skip-words", typed):
            task.skip()
            self._say("skipped")
        else:
            self._answer(task, typed)

    def _typed(self, prompt: str) -> str:
        """What was typed.

        Raises
        ------
        Quit
            If that was the word for it, or the end of the input.
        """
        try:
            typed = input(f"{prompt}: ").strip()
        except EOFError:
            click.echo()
            raise Quit from None
        if self._means("quit-words", typed):
            raise Quit
        return typed

    def _means(self, name: str, typed: str) -> bool:
        """Whether a word was typed that stands for something, here or in English."""
        listed = f"{self.words[name]}, {practice_words(FIRST)[name]}"
        return typed.casefold() in {word.casefold() for word in listed.split(", ")}

    def _show_part(self, task: Task[Part, PartSolution]) -> None:
        part = task.part
        label = f"({part.label}) " if part.label else ""
        click.echo()
        prose(blocks(part.body), label, " " * len(label))
        if part.field.drawing:
            say(part.field.drawing.alt, "   ", "   ")
        for mark, text in (*part.field.options, *part.field.targets):
            say(inline(text), f"   {mark}  ", " " * (len(mark) + 5))
        for hint in part.field.hints:
            say(f"[{hint}]", "   ", "    ")
        say(self.words["help"], "   ", "   ", dim=True)

    def _answer(self, task: Task[Part, PartSolution], typed: str) -> None:
        feedback = task.answer(typed)
        verdict = feedback.verdict
        match feedback.then:
            case Next.ASK_BACK:
                say(verdict.message, fg="magenta")
                return
            case Next.SELF_MARK:
                say(verdict.message)
                self._solution(task)
                task.mark_yourself(right=self._judged(task))
                return
        lang = self.session.state.wish.lang
        self._say("read", read_as=read_back(task.kind, verdict.read_as, lang))
        said = f"{self.words[verdict.verdict]} {verdict.message}".strip()
        say(said, fg=COLOURS[verdict.verdict])
        if feedback.then is Next.AGAIN:
            self._say("again", left=feedback.left)
        elif feedback.then is Next.OUT_OF_TRIES:
            self._solution(task)

    def _judged(self, task: Task[Part, PartSolution]) -> bool:
        """Whether the learner finds the own answer right."""
        self._say("self-mark", points=task.solved.answer)
        while True:
            typed = self._typed(self.words["yes-or-no"])
            if self._means("yes-words", typed):
                return True
            if self._means("no-words", typed):
                return False

    def _hint(self, task: Task[Part, PartSolution]) -> None:
        rung = task.hint()
        if rung is None:
            self._say("no-more-hints")
            return
        shown, why = inline(rung.shown), inline(rung.why)
        self._say(f"hint-{rung.kind}", hint=f"{shown}. {why}" if why else shown)
        sheet = cited(self.session.bank, rung.formula, self.session.state.wish.lang)
        if sheet:
            self._say("hint-sheet", hint=inline(sheet))

    def _solution(self, task: Task[Part, PartSolution]) -> None:
        for line in task.solved.lines:
            say(inline(line.maths), "   ", "      ")
            say(inline(line.why), "      ", "      ")
        say(self.words["answer"].format(answer=task.solved.answer), bold=True)
        solved = task.solved
        for sentence in (*solved.options, *filter(None, [solved.why])):
            say(inline(sentence), "   ", "   ")
