"""``quizgen practice``: questions in the terminal, with hints, retries and a summary by topic."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import (
    BankOptions,
    IntRangeParam,
    bank_options,
    database_option,
    language_option,
    level_option,
    match_choice,
    open_sound_bank,
    resolve_topic,
)
from quizgen.core.errors import MissingExtraError, has_extra
from quizgen.locale import default_language

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from quizgen.bank.bank import Bank
    from quizgen.practice.session import Session
    from quizgen.practice.session_state import PracticeRequest
    from quizgen.practice.session_store import SessionStore
    from quizgen.practice.topic_results import TopicResult
    from quizgen.store.learner import LearnerProgress

INTERRUPTED = 130
TIERS = tuple("ABCD")


class PracticeOptions(BankOptions):
    """Options of ``quizgen practice``."""

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
@click.option("--count", type=IntRangeParam(1, 200), default=10, show_default=True,
              help="How many questions.")  # fmt: skip
@click.option("--seed", help="Any text: the same text gives the same questions.")
@database_option
@bank_options
@click.option("--fresh", is_flag=True, help="Start over, not where these options were left.")
def practice(**options: Unpack[PracticeOptions]) -> None:
    """Practise in the terminal: instant feedback, hints, retries, worked solutions.

    Type ? for a hint, ! for the solution, skip to leave a part out, quit (or Ctrl-C) to stop. The
    session is kept part by part, and the same command goes on with it; sessions with other options
    are kept beside it. Without --seed it asks what is due, here or in the browser.
    """
    from quizgen.cli.conversation import Conversation, QuitSession, print_wrapped
    from quizgen.practice.session_store import SessionStore

    shelf = SessionStore(state_folder())
    bank = open_sound_bank(options)
    wish = _build_request(options, bank)
    learning = _open_learning(bank, options["database"])
    session = _open_session(bank, learning, wish, shelf, fresh=options["fresh"])
    conversation = Conversation(session, shelf, learning)
    try:
        conversation.hold()
    except (QuitSession, KeyboardInterrupt) as stop:
        shelf.save(session.state)
        click.echo()
        print_wrapped(conversation.words["saved"])
        raise click.exceptions.Exit(0 if isinstance(stop, QuitSession) else INTERRUPTED) from None
    shelf.delete(wish)
    _print_summary(session, learning, conversation.words)


def state_folder() -> Path:
    """Return the folder where unfinished sessions are saved."""
    return Path(click.get_app_dir("quizgen")) / "practice"


def _open_learning(bank: Bank, database: str) -> LearnerProgress | None:
    """Return the learner's progress; None without the packages for databases.

    Raises
    ------
    MissingExtraError
        If a database was named that cannot be opened without them.
    """
    if not has_extra("web"):
        source = click.get_current_context().get_parameter_source("database")
        if source is not click.core.ParameterSource.DEFAULT:
            raise MissingExtraError("web", "quizgen practice --database")
        return None
    from quizgen.store import Store
    from quizgen.store.learner import LearnerProgress

    store = Store(database)
    return LearnerProgress(store, bank, store.learner())


def _open_session(
    bank: Bank,
    learning: LearnerProgress | None,
    wish: PracticeRequest,
    shelf: SessionStore,
    *,
    fresh: bool,
) -> Session:
    """Return the stored session of a request, or a new one."""
    from quizgen.grading.feedback import load_practice_words
    from quizgen.practice.session import Session
    from quizgen.practice.session_state import new_session

    if fresh:
        shelf.delete(wish)
    state = shelf.load(wish)
    if state is not None:
        click.echo(load_practice_words(wish.lang)["resumed"].format(seed=state.seed))
    choose = None if wish.seed or learning is None else partial(_choose_due_question, learning)
    return Session(bank, state or new_session(wish), choose)


def _choose_due_question(learning: LearnerProgress, names: Sequence[str]) -> tuple[str, str]:
    """Return template and seed of the question that is due."""
    which = learning.next_question(names)
    return which.template, which.seed


def _build_request(options: PracticeOptions, bank: Bank) -> PracticeRequest:
    """Return what the options ask to practise, if any template fits.

    Raises
    ------
    click.BadParameter
        Naming what there is.
    """
    from quizgen.bank.combined import bank_sources
    from quizgen.practice.selection import matching_templates
    from quizgen.practice.session_state import PracticeRequest

    topic, tier = options["topic"], options["tier"]
    topic = None if topic is None else resolve_topic(bank, topic)
    tier = None if tier is None else match_choice("--tier", tier, TIERS)
    folder = "+".join(root for root, _ in bank_sources(bank))
    (lang,), seed = (
        bank.resolve_languages(options["lang"] or default_language(bank.languages)),
        options["seed"] or "",
    )
    wish = PracticeRequest(lang, options["count"], topic, tier, folder, seed, options["level"])
    if not matching_templates(bank, wish):
        there = [
            one
            for one in TIERS
            if matching_templates(bank, PracticeRequest(lang, topic=topic, tier=one))
        ]
        what = f"no question of topic {topic or 'any'}, tier {tier or 'any'}, language {lang}"
        raise click.BadParameter(f"{what} (tiers there: {', '.join(there) or 'none'})")
    return wish


def _print_summary(
    session: Session, learning: LearnerProgress | None, words: dict[str, str]
) -> None:
    """Print how the session went, how recent ones did, and what to practise next."""
    from quizgen.cli.conversation import print_heading, print_wrapped
    from quizgen.practice.topic_results import RECENT, summarise_by_topic, weak_topics

    print_heading(words["summary"])
    _print_topic_results(session, session.summary(), words)
    there = session.bank.topics
    done = session.state.outcomes
    skipped = [outcome for outcome in done if outcome.skipped]  # kept nowhere
    kept = learning.outcomes() if learning else [one for one in done if not one.skipped]
    past = [outcome for outcome in kept if outcome.topic in there]
    results = summarise_by_topic([*past, *skipped], RECENT)
    if len(past) > len(session.state.outcomes):
        print_heading(words["so-far"])
        _print_topic_results(session, results, words)
    if learning is not None:
        _print_estimate(session, learning, words)
    weak = weak_topics(results)
    named = ", ".join(f"{_get_topic_title(session, topic)} (--topic {topic})" for topic in weak)
    click.echo()
    print_wrapped(words["next"].format(topics=named) if weak else words["all-right"])


def _print_estimate(session: Session, learning: LearnerProgress, words: dict[str, str]) -> None:
    """Print the points to expect in the exam; nothing before there is evidence."""
    from quizgen.cli.conversation import print_wrapped
    from quizgen.locale import format_amount

    estimate = learning.plan(session.templates).estimate()
    if estimate is None:
        return
    lang, known = session.state.wish.lang, estimate.expected
    told = {"low": estimate.low, "high": estimate.high, "of": estimate.of}
    if known is not None:
        told["points"] = round(2 * known) / 2
    said = {name: format_amount(value, lang) for name, value in told.items()}
    click.echo()
    print_wrapped(words["estimate-range" if known is None else "estimate"].format(**said))


def _print_topic_results(
    session: Session, results: Iterable[TopicResult], words: dict[str, str]
) -> None:
    """Print the counts of each topic."""
    from quizgen.cli.conversation import print_wrapped

    for row in results:
        title = _get_topic_title(session, row.topic)
        if row.count:
            counts = {"right": row.right, "count": row.count, "later": row.later}
            print_wrapped(words["topic"].format(topic=title, **counts), "", "  ")
        if row.skipped:
            print_wrapped(words["topic-skipped"].format(topic=title, skipped=row.skipped), "", "  ")


def _get_topic_title(session: Session, topic: str) -> str:
    """Return the title of a topic in the session's language."""
    return session.bank.topic_title(topic, session.state.wish.lang)
