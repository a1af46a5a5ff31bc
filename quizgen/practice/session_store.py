"""Where sessions are kept that are not finished: a file per wish."""

from __future__ import annotations

import hashlib
from pathlib import Path

import msgspec

from quizgen.bank.levels import EXAM
from quizgen.core.decoding import decode_json
from quizgen.core.files import write_all
from quizgen.practice.session_state import PracticeRequest, SessionState


class SessionStore:
    """A folder of sessions. One wish never touches the session of another.

    Parameters
    ----------
    folder : pathlib.Path
        Made when something is first kept.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def path(self, wish: PracticeRequest) -> Path:
        """File of the session that a wish has begun."""
        return self.folder / f"{_compute_request_digest(wish)}.json"

    def figure(self, wish: PracticeRequest) -> Path:
        """File of the picture of the question that is due."""
        return self.path(wish).with_suffix(".svg")

    def load(self, wish: PracticeRequest) -> SessionState | None:
        """The session that a wish has begun, if it can be read."""
        state = _read_state(self.path(wish))
        return state if state is not None and state.wish == wish else None

    def save(self, state: SessionState) -> None:
        """Keep a session, whole or not at all.

        Raises
        ------
        RenderError
            If the file cannot be written.
        """
        path = self.path(state.wish)
        text = msgspec.json.format(msgspec.json.encode(state), indent=1)
        write_all(path.parent, {path.name: text})

    def delete(self, wish: PracticeRequest) -> None:
        """Give up the session that a wish has begun."""
        self.path(wish).unlink(missing_ok=True)
        self.figure(wish).unlink(missing_ok=True)


def _compute_request_digest(wish: PracticeRequest) -> str:
    told = msgspec.to_builtins(wish)
    if wish.level == EXAM:  # wishes were kept before there were levels
        del told["level"]
    return hashlib.sha256(msgspec.json.encode(told)).hexdigest()[:16]


def _read_state(path: Path) -> SessionState | None:
    try:
        return decode_json(path.read_bytes(), SessionState)
    except (OSError, msgspec.MsgspecError, RecursionError):
        return None
