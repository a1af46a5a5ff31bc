"""A practice session as a conversation: what is shown, asked, typed and said to it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import TYPE_CHECKING, TypedDict, Unpack

import click

from quizgen.cli.terminal import terminal_width
from quizgen.core.files import write_all
from quizgen.core.text_width import wrap_lines
from quizgen.core.untrusted import escape_control_characters
from quizgen.figures import Figure
from quizgen.grading.feedback import format_read_back, load_practice_words
from quizgen.grading.offered_readings import (
    OfferedReading,
    choose_offered_reading,
    list_offered_readings,
)
from quizgen.grading.verdict import Verdict
from quizgen.kinds.rubric import Suggestion, share_of_marks
from quizgen.locale import FIRST, format_amount, translate
from quizgen.practice.part_attempt import NextStep, PartAttempt
from quizgen.practice.session import QuestionAttempt, Session
from quizgen.practice.session_store import SessionStore
from quizgen.question.compose import QuestionPart
from quizgen.question.formula_sheet import cite_formula
from quizgen.question.solution import PartSolution, scheme_examples
from quizgen.render.text import blocks_to_plain_text, inlines_to_plain_text

if TYPE_CHECKING:
    from quizgen.store.learner import LearnerProgress

COLOURS = {"correct": "green", "partial": "yellow", "wrong": "red"}
SIGNS = {"correct": "✓", "partial": "~", "wrong": "✗"}
"""What stands before a line that was judged."""

_CODE = "    "
_BULLET = re.compile(r" *(?:- )*")


class TextStyle(TypedDict, total=False):
    """Style options of ``click.secho``."""

    fg: str
    bold: bool
    dim: bool


class QuitSession(Exception):  # noqa: N818 - a wish, not a failure
    """Raised when the learner wants to stop for now."""


def print_wrapped(text: str, first: str = "", rest: str = "", **style: Unpack[TextStyle]) -> None:
    """Print a text, broken between words at the width of the terminal.

    ``first`` and ``rest`` stand before the first and the other lines.
    """
    for line in wrap_lines(escape_control_characters(text), terminal_width(), first, rest):
        click.secho(line, **style)


def print_heading(text: str) -> None:
    """Print a heading, with a blank line above."""
    click.echo()
    print_wrapped(text, bold=True)


def print_prose(lines: Iterable[str], first: str = "", rest: str = "") -> None:
    """Print lines of prose; program text keeps its lines, list items their indent."""
    for line in lines:
        if line.startswith(_CODE):
            click.echo(rest + escape_control_characters(line))
        else:
            bullet = _BULLET.match(line)
            indent = bullet[0] if bullet else ""
            print_wrapped(line[len(indent) :], first + indent, rest + " " * len(indent))
        first = rest


class Conversation:
    """Runs one practice session on a terminal.

    Parameters
    ----------
    session : Session
    shelf : SessionStore
        Where it is kept after every answer.
    learning : LearnerProgress, optional
        Where finished questions are kept; without it the session alone is.
    """

    def __init__(
        self, session: Session, shelf: SessionStore, learning: LearnerProgress | None
    ) -> None:
        self.session, self.shelf, self.learning = session, shelf, learning
        self.words = load_practice_words(session.state.wish.lang)
        self._asked_back = ""
        self._offered: tuple[OfferedReading, ...] = ()

    def hold(self) -> None:
        """Ask until every question is done; the session is saved after each answer.

        Raises
        ------
        QuitSession
            If the learner stops before.
        """
        while not self.session.is_finished:
            attempt = self.session.current_question()
            self._show_question(attempt)
            for task in attempt.tasks:
                if task.outcome is None:
                    self._ask_part(task)
            self.session.finish(attempt)
            self._save_session()
            if self.learning is not None:
                from quizgen.store import QuestionRef

                which = QuestionRef(attempt.question.template, attempt.seed, attempt.level)
                self.learning.save_practice(which, attempt.question.topic, attempt.parts)

    def _save_session(self) -> None:
        """Save the session."""
        self.shelf.save(self.session.state)

    def _print_sentence(self, name: str, **blanks: object) -> None:
        """Print a sentence by its key, with its blanks filled in."""
        print_wrapped(self.words[name].format(**blanks))

    def _show_question(self, attempt: QuestionAttempt) -> None:
        """Print the question, and which of its parts are done."""
        count, title = self.session.state.wish.count, attempt.question.title
        print_heading(
            self.words["question"].format(number=attempt.number, count=count, title=title)
        )
        print_prose(blocks_to_plain_text(attempt.question.stem))
        self._show_figure(attempt.question.figure)
        done = [f"({task.part.label})" for task in attempt.tasks if task.outcome is not None]
        if done:
            self._print_sentence("done-before", parts=", ".join(done))

    def _show_figure(self, figure: Figure | None) -> None:
        """Print a figure in words and write its SVG file; nothing without one."""
        if figure is None:
            return
        path = self.shelf.figure(self.session.state.wish)
        write_all(path.parent, {path.name: figure.standalone_svg})
        self._print_sentence("figure", alt=figure.alt)
        self._print_sentence("figure-file", path=path)

    def _ask_part(self, task: PartAttempt[QuestionPart, PartSolution]) -> None:
        """Ask a part until it has ended."""
        self._show_part(task)
        while task.outcome is None:
            typed = self._read_answer(task)
            with self._save_on_stop():
                self._handle_input(task, typed)

    @contextmanager
    def _save_on_stop(self) -> Iterator[None]:
        """Save the session after the body of ``with``, also if the learner stops in it."""
        try:
            yield
        finally:
            self._save_session()

    def _handle_input(self, task: PartAttempt[QuestionPart, PartSolution], typed: str) -> None:
        """Act on what was typed: a reading offered, a hint, the solution, a skip or an answer."""
        chosen, self._offered = choose_offered_reading(self._offered, typed), ()
        if chosen is not None:
            self._grade_input(task, chosen.typed or self._asked_back, chosen.decimal)
        elif typed == "?":
            self._show_hint(task)
        elif typed == "!":
            task.give_up()
            self._show_solution(task)
        elif self._is_word_for("skip-words", typed):
            task.skip()
            self._print_sentence("skipped")
        else:
            self._grade_input(task, typed)

    def _read_answer(self, task: PartAttempt[QuestionPart, PartSolution]) -> str:
        """Return what was typed: a line, or where each line is judged all up to an empty one."""
        typed = self._read_line(self.words["prompt"])
        if not task.part.field.control.rows or not typed or self._is_command(typed):
            return typed
        lines = [typed]
        while line := self._read_line(" " * (len(self.words["prompt"]) - 1) + "…"):
            lines.append(line)
        return "\n".join(lines)

    def _is_command(self, typed: str) -> bool:
        """Return whether a line is no answer: help, the solution, a skip, a reading by number."""
        chosen = choose_offered_reading(self._offered, typed)
        return typed in {"?", "!"} or chosen is not None or self._is_word_for("skip-words", typed)

    def _read_line(self, prompt: str) -> str:
        """Return what was typed, without blanks around it.

        Raises
        ------
        QuitSession
            If that was the word for it, or the end of the input.
        """
        try:
            typed = input(f"{prompt}: ").strip()
        except EOFError:
            click.echo()
            raise QuitSession from None
        if self._is_word_for("quit-words", typed):
            raise QuitSession
        return typed

    def _is_word_for(self, name: str, typed: str) -> bool:
        """Return whether the learner typed one of a command's words, translated or English."""
        listed = f"{self.words[name]}, {load_practice_words(FIRST)[name]}"
        return typed.casefold() in {word.casefold() for word in listed.split(", ")}

    def _show_part(self, task: PartAttempt[QuestionPart, PartSolution]) -> None:
        """Print a part with its options and how to answer it."""
        part = task.part
        label = f"({part.label}) " if part.label else ""
        click.echo()
        print_prose(blocks_to_plain_text(part.body), label, " " * len(label))
        if part.field.drawing:
            print_wrapped(part.field.drawing.alt, "   ", "   ")
        for mark, text in (*part.field.options, *part.field.targets):
            print_wrapped(inlines_to_plain_text(text), f"   {mark}  ", " " * (len(mark) + 5))
        for hint in part.field.hints:
            print_wrapped(f"[{hint}]", "   ", "    ")
        if part.field.control.rows:
            self._print_sentence("rows")
        print_wrapped(self.words["help"], "   ", "   ", dim=True)

    def _grade_input(
        self, task: PartAttempt[QuestionPart, PartSolution], typed: str, decimal: str = ""
    ) -> None:
        """Grade an answer, print the feedback, and show the solution if the part has ended.

        ``decimal`` is the decimal sign that the learner has just declared.
        """
        if decimal:
            self._declare_decimal(task, decimal)
        feedback = task.answer(typed)
        verdict = task.explain_verdict(feedback.verdict)
        match feedback.then:
            case NextStep.ASK_BACK:
                print_wrapped(verdict.message, fg="magenta")
                self._offer_readings(feedback.verdict, typed)
                return
            case NextStep.SELF_MARK:
                self._print_lines(verdict)
                print_wrapped(verdict.message)
                self._show_solution(task)
                made = task.suggest()
                share = self._ask_criteria(task, made) if made else self._ask_whether_right()
                task.self_mark(share)
                return
        lang = self.session.state.wish.lang
        if verdict.lines:
            self._print_lines(verdict)
        else:
            read_as = format_read_back(task.kind, verdict.read_as, lang)
            self._print_sentence("read", read_as=read_as)
        word = self.words[verdict.word]
        repeated = verdict.message.startswith(word.rstrip(".।"))  # "Not right: gap 1."
        said = verdict.message if repeated else f"{word} {verdict.message}".strip()
        print_wrapped(said, fg=COLOURS[verdict.verdict])
        if feedback.then is NextStep.AGAIN:
            self._print_sentence("again", left=feedback.left)
        elif feedback.then is NextStep.OUT_OF_TRIES:
            self._show_solution(task)

    def _print_lines(self, verdict: Verdict) -> None:
        """Print the lines of a derivation, each with a sign and what is said of it."""
        for number, line in enumerate(verdict.lines, 1):
            sign = SIGNS.get(line.verdict, "·")
            said = f" – {line.message}" if line.note != "line-right" else ""
            style: TextStyle = {"fg": COLOURS[line.verdict]} if line.verdict in COLOURS else {}
            print_wrapped(f"{line.read_as}{said}", f"{number:>3} {sign} ", "      ", **style)

    def _offer_readings(self, verdict: Verdict, typed: str) -> None:
        """Print the readings of an answer asked back with their numbers, if it has some."""
        self._offered, self._asked_back = list_offered_readings(verdict), typed
        for number, one in enumerate(self._offered, 1):
            print_wrapped(f"{number}: {one.label}", "   ", "      ")
        if self._offered:
            self._print_sentence("choose-reading")

    def _declare_decimal(self, task: PartAttempt[QuestionPart, PartSolution], decimal: str) -> None:
        """Read answers by a decimal sign from now on, and keep it for the learner."""
        task.declare_decimal(decimal)
        self.session.decimal = decimal
        if self.learning is not None:
            self.learning.save_decimal(decimal)

    def _ask_criteria(
        self, task: PartAttempt[QuestionPart, PartSolution], made: Suggestion
    ) -> float:
        """Return the share that the learner gives an own sentence, asked criterion by criterion."""
        lang, rows = self.session.state.wish.lang, task.solved.scheme
        for told in task.wrong_ideas(made):
            print_wrapped(told, "   ", "   ", fg="yellow")
        marks: dict[str, Fraction] = {}
        for row, finding in zip(rows, made.findings, strict=True):
            idea = inlines_to_plain_text(row.idea)
            print_wrapped(f"[{format_amount(row.points, lang)}] {idea}", "   ", "      ")
            for name, examples in scheme_examples(row):
                listed = f"{translate(lang, f'solution.{name}')}: {'; '.join(examples)}"
                print_wrapped(listed, "      ", "      ", dim=True)
            told = translate(lang, f"suggested.{finding.status}", quote=finding.quote)
            print_wrapped(told, "      ", "      ")
            self._print_sentence("self-mark")
            if self._ask_yes_or_no():
                marks[row.name] = Fraction(1)
        full = Fraction(task.part.points)
        return float(share_of_marks(marks, {row.name: row.points for row in rows}, full))

    def _ask_whether_right(self) -> float:
        """Return 1 if the learner judges the own answer right, else 0."""
        self._print_sentence("was-right")
        return float(self._ask_yes_or_no())

    def _ask_yes_or_no(self) -> bool:
        """Return whether the learner says yes."""
        while True:
            typed = self._read_line(self.words["yes-or-no"])
            if self._is_word_for("yes-words", typed):
                return True
            if self._is_word_for("no-words", typed):
                return False

    def _show_hint(self, task: PartAttempt[QuestionPart, PartSolution]) -> None:
        """Print the next hint, or that there is none."""
        rung = task.next_hint()
        if rung is None:
            self._print_sentence("no-more-hints")
            return
        shown, why = inlines_to_plain_text(rung.shown), inlines_to_plain_text(rung.why)
        self._print_sentence(f"hint-{rung.kind}", hint=f"{shown}. {why}" if why else shown)
        sheet = cite_formula(self.session.bank, rung.formula, self.session.state.wish.lang)
        if sheet:
            self._print_sentence("hint-sheet", hint=inlines_to_plain_text(sheet))

    def _show_solution(self, task: PartAttempt[QuestionPart, PartSolution]) -> None:
        """Print the worked solution of a part."""
        for line in task.solved.lines:
            print_wrapped(inlines_to_plain_text(line.maths), "   ", "      ")
            print_wrapped(inlines_to_plain_text(line.why), "      ", "      ")
        print_wrapped(self.words["answer"].format(answer=task.solved.answer), bold=True)
        solved = task.solved
        ideas = () if solved.scheme else solved.options
        for sentence in (*ideas, *filter(None, [solved.why])):
            print_wrapped(inlines_to_plain_text(sentence), "   ", "   ")
