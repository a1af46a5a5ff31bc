"""What is kept of a session: the wish it was started with, its seed, how far it got and how."""

from __future__ import annotations

import secrets

import msgspec

from quizgen.bank.levels import EXAM


class PracticeRequest(msgspec.Struct, frozen=True):
    """What a learner asked to practise.

    Parameters
    ----------
    lang : str
    count : int
        Questions of the session.
    topic, tier : str, optional
        Only these.
    bank : str
        Folder of the bank; empty for the built-in one.
    seed : str
        That a session is to have; empty for one that nobody has held before.
    level : str
        Of its questions.
    """

    lang: str = "en"
    count: int = 10
    topic: str | None = None
    tier: str | None = None
    bank: str = ""
    seed: str = ""
    level: str = EXAM


class PartOutcome(msgspec.Struct, frozen=True):
    """How one part went: ``right`` at all, right at the ``first`` try without hints, or skipped."""

    topic: str
    right: bool
    first: bool
    skipped: bool = False


class Attempt(msgspec.Struct, frozen=True):
    """One attempt at a template.

    Parameters
    ----------
    template : str
    credit : float
        Share of its points that the first tries were worth, 0 to 1.
    at : float
        When it ended, in seconds since 1970.
    helped : bool
        Whether help came before a first try: that says nothing of what is known, but it teaches.
    taught : bool
        Whether its solution was seen.
    """

    template: str
    credit: float
    at: float
    helped: bool = False
    taught: bool = True


class PartState(msgspec.Struct):
    """Progress of one part of the open question.

    Parameters
    ----------
    typed : str
        The last answer that could be read.
    tries, hints : int
        How many have been used.
    outcome : PartOutcome, optional
        How it went, once it is done.
    wrong, note : str
        The last answer that was not right, and which mistake it was.
    mistakes : mapping of str to str
        Every mistake with a name that was made, and what was typed.
    credit : float
        Share of the points that the first try was worth, 0 to 1.
    helped : bool
        Whether a hint came before that try.
    decimal : str
        The decimal sign that ``typed`` was read by; empty for the one declared now.
    """

    typed: str = ""
    tries: int = 0
    hints: int = 0
    outcome: PartOutcome | None = None
    wrong: str = ""
    note: str = ""
    credit: float = 0.0
    helped: bool = False
    decimal: str = ""
    mistakes: dict[str, str] = {}


class SessionState(msgspec.Struct):
    """A session as it is kept between runs.

    ``due`` is the template and the seed of the question that is due, ``question`` its identity and
    ``parts`` how far it has got; all are empty before it is shown.
    """

    wish: PracticeRequest
    seed: str
    done: int = 0
    outcomes: list[PartOutcome] = []
    due: tuple[str, str] | None = None
    question: str = ""
    parts: list[PartState] = []


def new_session(wish: PracticeRequest) -> SessionState:
    """Return the state of a new session; its seed is random if the request has none."""
    return SessionState(wish, wish.seed or secrets.token_hex(3))
