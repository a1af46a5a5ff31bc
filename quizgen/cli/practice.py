"""``quizgen practice``: questions in the terminal, with hints, retries and a summary by topic."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import (
    BankOptions,
    Whole,
    bank_options,
    checked,
    database_option,
    language_option,
    level_option,
    open_bank,
    topic_option,
)
from quizgen.locale import leading

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from quizgen.bank.folder import Bank
    from quizgen.practice.results import TopicResult
    from quizgen.practice.session import Session
    from quizgen.practice.shelf import Shelf
    from quizgen.practice.state import Wish
    from quizgen.web.learning import Learning

INTERRUPTED = 130
TIERS = tuple("ABCD")


class Options(BankOptions):
    """What can be asked for."""

    topic: str | None
    tier: str | None
    lang: str | None
    count: int
    seed: str | None
    level: str
    database: str
    fresh: bool


@click.command(short_help="Practise in the terminal with instant feedback.")
@click.option("--topic", help="Only this topic.")
@click.option("--tier", metavar="[A|B|C|D]", help="Only this tier.")
@language_option
@level_option
@click.option("--count", type=Whole(1, 200), default=10, show_default=True,
              help="How many questions.")  # fmt: skip
@click.option("--seed", help="Any text: the same text gives the same questions.")
@database_option
@bank_options
@click.option("--fresh", is_flag=True, help="Begin anew, not where these options were left.")
def practice(**options: Unpack[Options]) -> None:
    """Practise in the terminal: instant feedback, hints, retries, worked solutions.

    Type ? for a hint, ! for the solution, skip to leave a part out, quit (or Ctrl-C) to stop. The
    session is kept part by part, and the same command goes on with it; sessions with other options
    are kept beside it. Without --seed it asks what is due, here or in the browser.
    """
    from quizgen.cli.conversation import Conversation, Quit, say
    from quizgen.practice.shelf import Shelf

    shelf = Shelf(state_folder())
    bank = open_bank(options)
    wish = _wish(options, bank)
    learning = _learning(bank, options["database"])
    session = _session(learning, wish, shelf, fresh=options["fresh"])
    conversation = Conversation(session, shelf, learning)
    try:
        conversation.hold()
    except (Quit, KeyboardInterrupt) as stop:
        shelf.keep(session.state)
        click.echo()
        say(conversation.words["saved"])
        raise click.exceptions.Exit(0 if isinstance(stop, Quit) else INTERRUPTED) from None
    shelf.forget(wish)
    _summary(session, learning, conversation.words)


def state_folder() -> Path:
    """Where sessions are kept."""
    return Path(click.get_app_dir("quizgen")) / "practice"


def _learning(bank: Bank, database: str) -> Learning:
    """What has been learnt, here and in the browser."""
    from quizgen.web.learning import Learning
    from quizgen.web.store import Store

    store = Store(database)
    return Learning(store, bank, store.learner())


def _session(learning: Learning, wish: Wish, shelf: Shelf, *, fresh: bool) -> Session:
    """The session that a wish has begun, or a new one."""
    from quizgen.marking.messages import practice_words
    from quizgen.practice.session import Session
    from quizgen.practice.state import new

    def due(names: Sequence[str]) -> tuple[str, str]:
        which = learning.following(names)
        return which.template, which.seed

    if fresh:
        shelf.forget(wish)
    state = shelf.kept(wish)
    if state is not None:
        click.echo(practice_words(wish.lang)["resumed"].format(seed=state.seed))
    return Session(learning.bank, state or new(wish), None if wish.seed else due)


def _wish(options: Options, bank: Bank) -> Wish:
    """What is asked for, if there is such a question.

    Raises
    ------
    click.BadParameter
        Naming what there is.
    """
    from quizgen.bank.mixed import sources
    from quizgen.practice.choosing import fitting
    from quizgen.practice.state import Wish

    topic, tier = options["topic"], options["tier"]
    topic = None if topic is None else topic_option(bank, topic)
    tier = None if tier is None else checked("--tier", tier, TIERS)
    folder = "+".join(root for root, _ in sources(bank))
    (lang,), seed = bank.chosen(options["lang"] or leading(bank.languages)), options["seed"] or ""
    wish = Wish(lang, options["count"], topic, tier, folder, seed, options["level"])
    if not fitting(bank, wish):
        there = [one for one in TIERS if fitting(bank, Wish(lang, topic=topic, tier=one))]
        what = f"no question of topic {topic or 'any'}, tier {tier or 'any'}, language {lang}"
        raise click.BadParameter(f"{what} (tiers there: {', '.join(there) or 'none'})")
    return wish


def _summary(session: Session, learning: Learning, words: dict[str, str]) -> None:
    """Say how the session went, how the last ones did, and what to practise."""
    from quizgen.cli.conversation import head, say
    from quizgen.practice.results import RECENT, by_topic, to_practise

    head(words["summary"])
    _print(session, session.summary(), words)
    there = session.bank.topics
    past = [outcome for outcome in learning.outcomes() if outcome.topic in there]
    skipped = [outcome for outcome in session.state.outcomes if outcome.skipped]  # kept nowhere
    results = by_topic([*past, *skipped], RECENT)
    if len(past) > len(session.state.outcomes):
        head(words["so-far"])
        _print(session, results, words)
    weak = to_practise(results)
    named = ", ".join(f"{_title(session, topic)} (--topic {topic})" for topic in weak)
    click.echo()
    say(words["next"].format(topics=named) if weak else words["all-right"])


def _print(session: Session, results: Iterable[TopicResult], words: dict[str, str]) -> None:
    from quizgen.cli.conversation import say

    for row in results:
        title = _title(session, row.topic)
        if row.count:
            counts = {"right": row.right, "count": row.count, "later": row.later}
            say(words["topic"].format(topic=title, **counts), "", "  ")
        if row.skipped:
            say(words["topic-skipped"].format(topic=title, skipped=row.skipped), "", "  ")


def _title(session: Session, topic: str) -> str:
    return session.bank.topic_title(topic, session.state.wish.lang)
