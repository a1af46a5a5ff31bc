"""``quizgen practice``: questions in the terminal, with hints, retries and a summary by topic."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import BankOptions, bank_options, language_option, open_bank

if TYPE_CHECKING:
    from quizgen.figures import Figure
    from quizgen.practice.session import Session
    from quizgen.practice.task import Task

COLOURS = {"correct": "green", "partial": "yellow", "wrong": "red"}

Words = dict[str, str]
"""Sentences of the session in its language."""


class Options(BankOptions):
    """What can be asked for."""

    topic: str | None
    tier: str | None
    lang: str
    count: int
    seed: str | None
    fresh: bool


@click.command(short_help="Practise in the terminal with instant feedback.")
@click.option("--topic", help="Only this topic.")
@click.option("--tier", type=click.Choice(list("ABCD")), help="Only this tier.")
@language_option
@click.option("--count", type=click.IntRange(1, 200), default=10, show_default=True)
@click.option("--seed", help="Start the same session again.")
@bank_options
@click.option("--fresh", is_flag=True, help="Forget a session that was interrupted.")
def practice(**options: Unpack[Options]) -> None:
    """Practise in the terminal: instant feedback, hints, retries, worked solutions.

    Ctrl-C keeps the session; the same command goes on with it.
    """
    from quizgen.marking.messages import practice_words

    words = practice_words(options["lang"])
    session, path = _session(options, words), state_path()
    try:
        _hold(session, path, words)
    except (click.exceptions.Abort, KeyboardInterrupt):
        session.state.save(path)
        click.echo(f"\n{words['saved']}")
        return
    path.unlink(missing_ok=True)
    _summary(session, words)


def state_path() -> Path:
    """Where an interrupted session is kept."""
    return Path(click.get_app_dir("quizgen")) / "practice.json"


def _session(options: Options, words: Words) -> Session:
    """The session that was interrupted, or a new one."""
    from quizgen.practice.session import Session
    from quizgen.practice.state import Wish, kept, new

    folder = str(options["bank"] or "")
    wish = Wish(options["lang"], options["count"], options["topic"], options["tier"], folder)
    state = None if options["fresh"] or options["seed"] else kept(state_path(), wish)
    if state is not None:
        click.echo(words["resumed"].format(seed=state.seed))
    return Session(open_bank(options), state or new(wish, options["seed"] or ""))


def _hold(session: Session, path: Path, words: Words) -> None:
    from quizgen.render.text import blocks

    if not session.templates:
        click.echo(words["nothing"])
    while not session.finished:
        turn = session.turn()
        count, title = session.state.wish.count, turn.question.title
        head = words["question"].format(number=turn.number, count=count, title=title)
        click.secho(f"\n{head}", bold=True)
        for line in blocks(turn.question.stem):
            click.echo(line)
        _show_figure(turn.question.figure, words)
        for task in turn.tasks:
            _ask(task, words)
        session.finish(turn)
        session.state.save(path)


def _show_figure(figure: Figure | None, words: Words) -> None:
    if figure is None:
        return
    from quizgen.files import write_all

    (path,) = write_all(state_path().parent, {"figure.svg": figure.svg})
    click.echo(words["figure"].format(alt=figure.alt))
    click.echo(words["figure-file"].format(path=path))


def _ask(task: Task, words: Words) -> None:
    """Ask a part until it is done."""
    _show(task, words)
    while task.outcome is None:
        typed = click.prompt(words["prompt"], default="", show_default=False).strip()
        if typed == "?":
            _hint(task, words)
        elif typed == "!":
            task.give_up()
            _solution(task, words)
        else:
            _answer(task, typed, words)


def _show(task: Task, words: Words) -> None:
    from quizgen.render.text import blocks, inline

    click.echo()
    part = task.part
    label = f"({part.label}) " if part.label else ""
    first, *more = list(blocks(part.body)) or [""]
    click.echo(f"{label}{first}")
    for line in more:
        click.echo(line)
    for mark, text in (*part.field.options, *part.field.targets):
        click.echo(f"   {mark}  {inline(text)}")
    for hint in part.field.hints:
        click.echo(f"   [{hint}]")
    click.secho(f"   {words['help']}", dim=True)


def _answer(task: Task, typed: str, words: Words) -> None:
    from quizgen.practice.task import Next

    feedback = task.answer(typed)
    verdict = feedback.verdict
    match feedback.then:
        case Next.ASK_BACK:
            click.secho(verdict.message, fg="magenta")
            return
        case Next.SELF_MARK:
            click.echo(verdict.message)
            _solution(task, words)
            question = words["self-mark"].format(points=task.solved.answer)
            task.mark_yourself(right=click.confirm(question, default=False))
            return
    click.echo(words["read"].format(read_as=verdict.read_as))
    said = f"{words[verdict.verdict]} {verdict.message}".strip()
    click.secho(said, fg=COLOURS[verdict.verdict])
    if feedback.then is Next.AGAIN:
        click.echo(words["again"].format(left=feedback.left))
    elif feedback.then is Next.OUT_OF_TRIES:
        _solution(task, words)


def _hint(task: Task, words: Words) -> None:
    from quizgen.render.text import inline

    why = task.hint()
    if why is None:
        click.echo(words["no-more-hints"])
    else:
        click.echo(words["hint"].format(hint=inline(why)))


def _solution(task: Task, words: Words) -> None:
    from quizgen.render.text import inline

    for line in task.solved.lines:
        click.echo(f"   {line.maths.typed}")
        click.echo(f"      {inline(line.why)}")
    click.secho(words["answer"].format(answer=task.solved.answer), bold=True)


def _summary(session: Session, words: Words) -> None:
    results = session.summary()
    if results:
        click.secho(f"\n{words['summary']}", bold=True)
    for row in results:
        click.echo(
            words["topic"].format(
                topic=row.topic, right=row.right, count=row.count, later=row.later
            )
        )
