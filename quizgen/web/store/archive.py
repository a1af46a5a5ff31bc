"""Everything of a learner as one file, and such a file taken in: added to, never doubled."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, TypeAlias

import msgspec
from sqlalchemy import Connection, Table, insert, select, update

from quizgen.errors import StoreError
from quizgen.practice.schedule import Card, Moment
from quizgen.practice.state import PartState
from quizgen.shapes import decoded
from quizgen.web.store.cards import cards_of, put_card
from quizgen.web.store.database import Database
from quizgen.web.store.tables import ANSWER, ATTEMPT, CARD, FLAG, LEARNER, SEEN, SITTING

FORMAT = "quizgen learning"
TEXT = "^[^\0]*$"
"""What a database takes as text."""
Short: TypeAlias = Annotated[str, msgspec.Meta(max_length=200, pattern=TEXT)]
Part: TypeAlias = Annotated[str, msgspec.Meta(max_length=20, pattern=TEXT)]
Typed: TypeAlias = Annotated[str, msgspec.Meta(max_length=10_000, pattern=TEXT)]
Id: TypeAlias = Annotated[str, msgspec.Meta(pattern="^[A-Za-z0-9_-]{8,32}$")]


Wish: TypeAlias = dict[Literal["topic", "tier"], Short]
Settings: TypeAlias = dict[Literal["lang", "exam"], Part]


class Strict(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part of the file; what nobody knows is an error."""


class KeptPart(Strict, frozen=True):
    """How far a part has got."""

    state: PartState
    values: Annotated[list[Typed], msgspec.Meta(max_length=400)] = []
    asked_back: Typed = ""


class KeptState(Strict, frozen=True, omit_defaults=True):
    """How far a question has got."""

    parts: dict[Part, KeptPart] = {}
    ended: list[Part] = []
    notes: dict[Part, Short] = {}
    """The mistakes, where earlier versions kept them."""


class KeptAttempt(Strict, frozen=True):
    """A question that was practised."""

    id: Id
    template: Short
    seed: Annotated[str, msgspec.Meta(max_length=80, pattern=TEXT)]
    level: Part
    wish: Wish
    state: KeptState
    begun: Moment
    ended: Moment | None


class KeptSeen(Strict, frozen=True):
    """How a part went."""

    template: Short
    topic: Short
    part: Part
    note: Short
    right: bool
    first: bool
    at: Moment


class KeptAnswer(Strict, frozen=True):
    """What stands in the fields of a part."""

    part: Part
    fields: Annotated[list[Typed], msgspec.Meta(max_length=400)]
    at: Moment


class KeptSitting(Strict, frozen=True):
    """An exam that was sat."""

    id: Id
    code: Short
    begun: Moment
    limit: Moment | None
    pauses: bool
    rested: Moment
    resting: Moment | None
    handed: Moment | None
    marks: dict[Part, Annotated[float, msgspec.Meta(ge=0, le=1)]]
    answers: list[KeptAnswer]
    flags: list[Part]


class Archive(Strict, frozen=True):
    """Everything of a learner."""

    format: Literal["quizgen learning"]
    version: Literal[1]
    settings: Settings
    attempts: list[KeptAttempt]
    seen: list[KeptSeen]
    cards: list[Card]
    sittings: list[KeptSitting]


def read_archive(data: bytes) -> Archive:
    """Read a file.

    Raises
    ------
    StoreError
        If it is none of ours, of another version, or something in it cannot be.
    """
    try:
        return decoded(data, Archive)
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        raise StoreError(f"{error}") from error


class Archives:
    """Writes and takes in what learners did.

    Parameters
    ----------
    database : Database
    """

    def __init__(self, database: Database) -> None:
        self.database = database

    def write(self, learner: int) -> bytes:
        """Everything of a learner."""
        with self.database.reading() as connection:
            whole = {
                "format": FORMAT,
                "version": 1,
                "settings": _only(
                    ("lang", "exam"),
                    connection.execute(
                        select(LEARNER.c.settings).where(LEARNER.c.id == learner)
                    ).scalar_one(),
                ),
                "attempts": [
                    {**row, "wish": _only(("topic", "tier"), row["wish"])}
                    for row in _rows(connection, ATTEMPT, learner)
                ],
                "seen": list(_rows(connection, SEEN, learner, "id")),
                "cards": connection.execute(
                    select(CARD.c.data).where(CARD.c.learner == learner)
                ).scalars().all(),
                "sittings": [
                    {**row, **_inside(connection, str(row["id"]))}
                    for row in _rows(connection, SITTING, learner)
                ],
            }  # fmt: skip
        return msgspec.json.encode(whole)

    def take_in(self, learner: int, archive: Archive) -> int:
        """Add what a learner does not have yet, all of it or nothing; how many questions came."""
        with self.database.writing(learner) as connection:
            _settle(connection, learner, archive.settings)
            count = sum(_attempt(connection, learner, one) for one in archive.attempts)
            known = {_text(row) for row in _rows(connection, SEEN, learner, "id")}
            for seen in archive.seen:
                row = msgspec.to_builtins(seen)
                if _text(row) not in known:
                    known.add(_text(row))
                    connection.execute(insert(SEEN).values(learner=learner, **row))
            cards = cards_of(connection, learner)
            for card in archive.cards:
                mine = cards.get((card.kind, card.name))
                if mine is None or mine.last < card.last:
                    put_card(connection, learner, card)
            return count + sum(_sitting(connection, learner, one) for one in archive.sittings)


def _only(names: tuple[str, ...], table: Mapping[str, Any]) -> dict[str, Any]:
    """What the file has of a table, which may hold more."""
    return {name: table[name] for name in names if name in table}


def _rows(
    connection: Connection, table: Table, learner: int, *but: str
) -> Iterator[dict[str, Any]]:
    columns = [c for c in table.c if c.name not in {"learner", *but}]
    for row in connection.execute(select(*columns).where(table.c.learner == learner)).mappings():
        yield {str(name): cell for name, cell in row.items()}


def _inside(connection: Connection, sitting: str) -> dict[str, Any]:
    answers = select(ANSWER.c.part, ANSWER.c.fields, ANSWER.c.at).where(ANSWER.c.sitting == sitting)
    flags = select(FLAG.c.number).where(FLAG.c.sitting == sitting)
    return {
        "answers": [dict(row) for row in connection.execute(answers).mappings()],
        "flags": list(connection.execute(flags).scalars()),
    }


def _text(row: object) -> bytes:
    return msgspec.json.encode(row, order="sorted")


def _settle(connection: Connection, learner: int, settings: Settings) -> None:
    """Take over what was chosen where nothing is chosen yet."""
    place = LEARNER.c.id == learner
    mine = connection.execute(select(LEARNER.c.settings).where(place)).scalar_one()
    whole = {**settings, **mine}
    connection.execute(update(LEARNER).where(place).values(settings=whole))


def _free(connection: Connection, table: Table, learner: int, name: str) -> str | None:
    """The name under which something comes in: another one if somebody else has it; None if known.

    The same file always gives the same one, so that it does not come in twice.
    """
    other = hashlib.sha256(f"{learner}/{name}".encode()).hexdigest()[:24]
    for one in (name, other):
        owner = connection.execute(select(table.c.learner).where(table.c.id == one)).scalar()
        if owner is None:
            return one
        if owner == learner:
            return None
    return None


def _attempt(connection: Connection, learner: int, attempt: KeptAttempt) -> bool:
    name = _free(connection, ATTEMPT, learner, attempt.id)
    if name is not None:
        row = {**msgspec.to_builtins(attempt), "id": name, "learner": learner}
        connection.execute(insert(ATTEMPT).values(row))
    return name is not None


def _sitting(connection: Connection, learner: int, sitting: KeptSitting) -> bool:
    name = _free(connection, SITTING, learner, sitting.id)
    if name is None:
        return False
    row = {**msgspec.to_builtins(sitting), "id": name, "learner": learner}
    answers, flags = row.pop("answers"), row.pop("flags")
    connection.execute(insert(SITTING).values(row))
    for answer in {one["part"]: one for one in answers}.values():
        connection.execute(insert(ANSWER).values(sitting=name, **answer))
    for number in dict.fromkeys(flags):
        connection.execute(insert(FLAG).values(sitting=name, number=number))
    return True
