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
    """A folder with one file for each unfinished session, named by its request.

    Parameters
    ----------
    folder : pathlib.Path
        Made when something is first kept.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def path(self, wish: PracticeRequest) -> Path:
        """Return the file of a request's session, whether it exists or not."""
        return self.folder / f"{_compute_request_digest(wish)}.json"

    def figure(self, wish: PracticeRequest) -> Path:
        """Return the file for the figure of the open question, named like the session's file."""
        return self.path(wish).with_suffix(".svg")

    def load(self, wish: PracticeRequest) -> SessionState | None:
        """Return the stored session of a request; None if there is none that can be read."""
        state = _read_state(self.path(wish))
        return state if state is not None and state.wish == wish else None

    def save(self, state: SessionState) -> None:
        """Write the session atomically, so that an interruption leaves the old one.

        Raises
        ------
        RenderError
            If the file cannot be written.
        """
        path = self.path(state.wish)
        text = msgspec.json.format(msgspec.json.encode(state), indent=1)
        write_all(path.parent, {path.name: text})

    def delete(self, wish: PracticeRequest) -> None:
        """Delete the session of a request and its figure; nothing happens if there is none."""
        self.path(wish).unlink(missing_ok=True)
        self.figure(wish).unlink(missing_ok=True)


def _compute_request_digest(wish: PracticeRequest) -> str:
    """Return 16 hexadecimal digits that name a request's file."""
    told = msgspec.to_builtins(wish)
    if wish.level == EXAM:  # wishes were kept before there were levels
        del told["level"]
    return hashlib.sha256(msgspec.json.encode(told)).hexdigest()[:16]


def _read_state(path: Path) -> SessionState | None:
    """Return the state in a file; None if it is missing or damaged: practice then begins again."""
    try:
        return decode_json(path.read_bytes(), SessionState)
    except (OSError, msgspec.MsgspecError, RecursionError):
        return None
