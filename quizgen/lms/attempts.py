"""Attempts at a quiz and the responses in each, from any kind of file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

# Characters of the longest text that is taken for a response: as many as a cell of CSV has.
LONGEST_RESPONSE = 131_072

# Called with what cannot be read, and where it stands.
ReportLoss = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Response:
    """The response to a question, which has a number in the quiz, and a token or an id.

    ``number`` is empty where questions have none; ``given`` is a line of text, or values by
    variable.
    """

    number: str
    question: str
    given: str | Mapping[str, list[str]]


@dataclass(frozen=True, slots=True)
class QuizAttempt:
    """What one person handed in.

    Parameters
    ----------
    where : str
        File and line, for messages.
    name, id, email : str
        As the report has them; empty where it has none.
    responses : tuple of Response
    """

    where: str
    name: str
    id: str
    email: str
    responses: tuple[Response, ...]

    @property
    def person_key(self) -> tuple[str, str]:
        """What is equal in all attempts of one person."""
        return self.id or self.email, self.name
