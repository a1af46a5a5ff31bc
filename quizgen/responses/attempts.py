"""Attempts at a quiz, and what was responded in each, whatever file they come from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

LONGEST = 131_072
"""Characters of the longest text that is taken for a response, as many as a cell of CSV has."""

Lost = Callable[[str], None]
"""Told what cannot be read, and where it stands."""


@dataclass(frozen=True, slots=True)
class Response:
    """The number of a question in the quiz, its mark or id, and what was responded to it.

    ``number`` is empty where questions have none; ``given`` is a line of text, or by variable its
    values.
    """

    number: str
    question: str
    given: str | Mapping[str, list[str]]


@dataclass(frozen=True, slots=True)
class Attempt:
    """What somebody handed in.

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
    def who(self) -> tuple[str, str]:
        """What is the same in all attempts of one person."""
        return self.id or self.email, self.name
