"""What is kept of a session: the wish it was started with, its seed, how far it got and how."""

from __future__ import annotations

import secrets
from pathlib import Path

import msgspec

from quizgen.files import write_all


class Wish(msgspec.Struct, frozen=True):
    """What to practise.

    Parameters
    ----------
    lang : str
    count : int
        Questions of the session.
    topic, tier : str, optional
        Only these.
    bank : str
        Folder of the bank; empty for the built-in one.
    """

    lang: str = "en"
    count: int = 10
    topic: str | None = None
    tier: str | None = None
    bank: str = ""


class Outcome(msgspec.Struct, frozen=True):
    """How one part went: right at all, and right at the first try without help."""

    topic: str
    right: bool
    first: bool


class State(msgspec.Struct):
    """A session as it is kept between runs."""

    wish: Wish
    seed: str
    done: int = 0
    outcomes: list[Outcome] = []

    def save(self, path: Path) -> None:
        """Write the state, whole or not at all.

        Raises
        ------
        RenderError
            If the file cannot be written.
        """
        text = msgspec.json.format(msgspec.json.encode(self), indent=1)
        write_all(path.parent, {path.name: text})


def new(wish: Wish, seed: str = "") -> State:
    """The state of a session that begins; without a seed, one that nobody has held before."""
    return State(wish, seed or secrets.token_hex(3))


def kept(path: Path, wish: Wish) -> State | None:
    """The state kept in a file, if it is of the same wish and can be read."""
    try:
        state = msgspec.json.decode(path.read_bytes(), type=State)
    except (OSError, msgspec.MsgspecError, RecursionError):
        return None
    return state if state.wish == wish else None
