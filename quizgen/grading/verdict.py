"""What the checker says about one typed answer."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from html import escape
from typing import Any

import msgspec

from quizgen.maths.values import Value

CORRECT = "correct"
PARTIAL = "partial"
WRONG = "wrong"
UNREADABLE = "unreadable"
AMBIGUOUS = "ambiguous"

SELF_MARKED = frozenset(
    {
        "self-mark",
        "self-mark-open",
        "self-mark-none",
        "self-mark-lines",
        "self-mark-lines-none",
        "unchecked",
    }
)
"""Notes on what a person marks: free text, and what only its bank could check."""

FULL, NONE = Fraction(1), Fraction(0)
HALF = Fraction(1, 2)
"""Credit for a right value in the wrong form, precision or without its unit."""


class Verdict(msgspec.Struct, frozen=True):
    """The judgement of one typed answer.

    Parameters
    ----------
    verdict : str
        ``correct``, ``partial``, ``wrong``, ``unreadable`` or ``ambiguous``; the last two cost
        nothing and ask for another try.
    credit : Fraction
        Share of the marks, 0 to 1.
    read_as : str
        What was read, in the checker's own spelling.
    note : str
        Stable reason that names no language: ``unit-prefix``, ``trap:one-sided-tail``, ...
    message : str
        The same for the learner, in the learner's language.
    fields : mapping
        What the message fills in (language-free).
    cells : tuple of Verdict
        Verdicts of a table's cells, a point's coordinates, ... in order.
    values : tuple
        The numbers read, in the key's unit, for carrying errors forward.
    """

    verdict: str
    credit: Fraction = NONE
    read_as: str = ""
    note: str = ""
    message: str = ""
    fields: Mapping[str, object] = msgspec.field(default_factory=dict)
    cells: tuple[Verdict, ...] = ()
    values: tuple[Value | None, ...] = ()

    @property
    def is_graded(self) -> bool:
        """Whether the answer counts; one that could not be read as meant is asked back."""
        return self.verdict not in {UNREADABLE, AMBIGUOUS}

    @property
    def needs_self_marking(self) -> bool:
        """Whether a person has to decide: criteria are only suggested."""
        return self.note in SELF_MARKED

    @property
    def lines(self) -> tuple[Verdict, ...]:
        """The verdicts of the lines of a derivation; none for any other answer."""
        return self.cells if any(cell.note.startswith("line-") for cell in self.cells) else ()

    @property
    def word(self) -> str:
        """The key of the word it is shown by: an error carried forward is not partly right."""
        return "carried" if (self.verdict, self.credit) == (PARTIAL, FULL) else self.verdict

    def __repr__(self) -> str:
        """Return verdict, what was read and note, for a terminal."""
        said = (self.verdict, f"read as {self.read_as}" if self.read_as else "", self.note)
        return f"<Verdict {', '.join(filter(None, said))}>"

    def _repr_html_(self) -> str:
        """Return the verdict as a notebook shows it."""
        read = f" (<code>{escape(self.read_as)}</code>)" if self.read_as else ""
        return f"<p><strong>{self.verdict}</strong>{read} {escape(self.message)}</p>"

    def as_json(self) -> dict[str, Any]:
        """Return the five public members, for JSON; the credit as a float."""
        return {
            "verdict": self.verdict,
            "credit": float(self.credit),
            "read_as": self.read_as,
            "note": self.note,
            "message": self.message,
        }


def correct(read_as: str, note: str = "", **fields: object) -> Verdict:
    """Return a verdict with full credit; ``fields`` fill in the sentence of a note."""
    return Verdict(CORRECT, FULL, read_as, note, fields=fields)


def partial(credit: Fraction, read_as: str, note: str, **fields: object) -> Verdict:
    """Return a verdict with some credit, 0 to 1, and the reason."""
    return Verdict(PARTIAL, credit, read_as, note, fields=fields)


def wrong(read_as: str, note: str = "", **fields: object) -> Verdict:
    """Return a verdict without credit."""
    return Verdict(WRONG, NONE, read_as, note, fields=fields)


def unreadable(note: str, read_as: str = "", **fields: object) -> Verdict:
    """Return a verdict that asks back: the answer could not be read."""
    return Verdict(UNREADABLE, NONE, read_as, note, fields=fields)


def ambiguous(note: str, read_as: str = "", **fields: object) -> Verdict:
    """Return a verdict that asks back: there are two readings, or a person has to decide."""
    return Verdict(AMBIGUOUS, NONE, read_as, note, fields=fields)


def verdict_by_share(credit: Fraction, read_as: str, note: str, **fields: object) -> Verdict:
    """Return correct, partial or wrong by the share of right pieces."""
    if credit >= 1:
        return correct(read_as, "", **fields)
    if credit <= 0:
        return wrong(read_as, note, **fields)
    return partial(credit, read_as, note, **fields)


def attach_values(verdict: Verdict, *values: Value | None) -> Verdict:
    """Return the verdict with the numbers that were read, in the key's unit."""
    return Verdict(
        verdict.verdict,
        verdict.credit,
        verdict.read_as,
        verdict.note,
        verdict.message,
        verdict.fields,
        verdict.cells,
        values,
    )


def attach_message(verdict: Verdict, message: str, cells: tuple[Verdict, ...]) -> Verdict:
    """Return the verdict with the sentence in the learner's language, and explained cells."""
    return Verdict(
        verdict.verdict,
        verdict.credit,
        verdict.read_as,
        verdict.note,
        message,
        verdict.fields,
        cells,
        verdict.values,
    )
