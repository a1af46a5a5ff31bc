"""Everything of a learner as one file, and such a file taken in: added to, never doubled."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, TypeAlias

import msgspec
from sqlalchemy import Connection, Table, insert, select, update

from quizgen.core.decoding import decode_json
from quizgen.core.errors import StoreError
from quizgen.practice.scheduler import Moment, ReviewCard
from quizgen.practice.session_state import PartState
from quizgen.store.database import Database
from quizgen.store.exam_attempts import numbers_of
from quizgen.store.review_cards import read_cards, write_card
from quizgen.store.schema import ANSWER, ATTEMPT, CARD, FLAG, LEARNER, PAPER, SEEN, SITTING

FORMAT = "quizgen learning"
TEXT = "^[^\0]*$"
"""What a database takes as text."""
Short: TypeAlias = Annotated[str, msgspec.Meta(max_length=200, pattern=TEXT)]
Part: TypeAlias = Annotated[str, msgspec.Meta(max_length=20, pattern=TEXT)]
Typed: TypeAlias = Annotated[str, msgspec.Meta(max_length=10_000, pattern=TEXT)]
Id: TypeAlias = Annotated[str, msgspec.Meta(pattern="^[A-Za-z0-9_-]{8,32}$")]


Wish: TypeAlias = dict[Literal["topic", "tier"], Short]
Settings: TypeAlias = dict[Literal["lang", "exam"], Part]


class StrictStruct(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part of the file; what nobody knows is an error."""


class ArchivedPart(StrictStruct, frozen=True):
    """How far a part has got."""

    state: PartState
    values: Annotated[list[Typed], msgspec.Meta(max_length=400)] = []
    asked_back: Typed = ""


class ArchivedState(StrictStruct, frozen=True, omit_defaults=True):
    """How far a question has got."""

    parts: dict[Part, ArchivedPart] = {}
    ended: list[Part] = []
    notes: dict[Part, Short] = {}
    """The mistakes, where earlier versions kept them."""


class ArchivedAttempt(StrictStruct, frozen=True):
    """A question that was practised."""

    id: Id
    template: Short
    seed: Annotated[str, msgspec.Meta(max_length=80, pattern=TEXT)]
    level: Part
    wish: Wish
    state: ArchivedState
    begun: Moment
    ended: Moment | None


class ArchivedOutcome(StrictStruct, frozen=True):
    """How a part went."""

    template: Short
    topic: Short
    part: Part
    note: Short
    right: bool
    first: bool
    at: Moment


class ArchivedAnswer(StrictStruct, frozen=True):
    """What stands in the fields of a part."""

    part: Part
    fields: Annotated[list[Typed], msgspec.Meta(max_length=400)]
    at: Moment


class ArchivedExam(StrictStruct, frozen=True):
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
    answers: list[ArchivedAnswer]
    flags: list[Part]
    practice: bool = False
    paper: Annotated[str, msgspec.Meta(pattern="^[0-9a-f]{64}$")] | None = None
    """Its id, once it was handed in. The paper itself is HTML: nobody's file is believed that."""


class LearnerArchive(StrictStruct, frozen=True):
    """Everything of a learner."""

    format: Literal["quizgen learning"]
    version: Literal[1]
    settings: Settings
    attempts: list[ArchivedAttempt]
    seen: list[ArchivedOutcome]
    cards: list[ReviewCard]
    sittings: list[ArchivedExam]


def read_archive(data: bytes) -> LearnerArchive:
    """Read a file.

    Raises
    ------
    StoreError
        If it is none of ours, of another version, or something in it cannot be.
    """
    try:
        return decode_json(data, LearnerArchive)
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        raise StoreError(f"{error}") from error


class ArchiveStore:
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
                "settings": _select_columns(
                    ("lang", "exam"),
                    connection.execute(
                        select(LEARNER.c.settings).where(LEARNER.c.id == learner)
                    ).scalar_one(),
                ),
                "attempts": [
                    {**row, "wish": _select_columns(("topic", "tier"), row["wish"])}
                    for row in _iter_learner_rows(connection, ATTEMPT, learner)
                ],
                "seen": list(_iter_learner_rows(connection, SEEN, learner, "id")),
                "cards": connection.execute(
                    select(CARD.c.data).where(CARD.c.learner == learner)
                ).scalars().all(),
                "sittings": [
                    {
                        **row,
                        "paper": row["paper"] if row["handed"] is not None else None,
                        **_read_sitting_contents(connection, str(row["id"])),
                    }
                    for row in _iter_learner_rows(connection, SITTING, learner, "counted")
                ],
            }  # fmt: skip
        return msgspec.json.encode(whole)

    def import_archive(self, learner: int, archive: LearnerArchive) -> int:
        """Add what a learner does not have yet, all of it or nothing; how many questions came."""
        with self.database.writing(learner) as connection:
            _merge_settings(connection, learner, archive.settings)
            count = sum(_insert_attempt(connection, learner, one) for one in archive.attempts)
            known = {
                _encode_row(row) for row in _iter_learner_rows(connection, SEEN, learner, "id")
            }
            for seen in archive.seen:
                row = msgspec.to_builtins(seen)
                if _encode_row(row) not in known:
                    known.add(_encode_row(row))
                    connection.execute(insert(SEEN).values(learner=learner, **row))
            cards = read_cards(connection, learner)
            for card in archive.cards:
                mine = cards.get((card.kind, card.name))
                if mine is None or mine.last < card.last:
                    write_card(connection, learner, card)
            # As handed in by a file, a paper would show the key of the same that is open here.
            sat = _open_papers(connection, learner)
            coming = [one for one in archive.sittings if numbers_of(one.code) not in sat]
            return count + sum(_insert_sitting(connection, learner, one) for one in coming)


def _select_columns(names: tuple[str, ...], table: Mapping[str, Any]) -> dict[str, Any]:
    """What the file has of a table, which may hold more."""
    return {name: table[name] for name in names if name in table}


def _iter_learner_rows(
    connection: Connection, table: Table, learner: int, *but: str
) -> Iterator[dict[str, Any]]:
    columns = [c for c in table.c if c.name not in {"learner", *but}]
    for row in connection.execute(select(*columns).where(table.c.learner == learner)).mappings():
        yield {str(name): cell for name, cell in row.items()}


def _read_sitting_contents(connection: Connection, sitting: str) -> dict[str, Any]:
    answers = select(ANSWER.c.part, ANSWER.c.fields, ANSWER.c.at).where(ANSWER.c.sitting == sitting)
    flags = select(FLAG.c.number).where(FLAG.c.sitting == sitting)
    return {
        "answers": [dict(row) for row in connection.execute(answers).mappings()],
        "flags": list(connection.execute(flags).scalars()),
    }


def _encode_row(row: object) -> bytes:
    return msgspec.json.encode(row, order="sorted")


def _merge_settings(connection: Connection, learner: int, settings: Settings) -> None:
    """Take over what was chosen where nothing is chosen yet."""
    place = LEARNER.c.id == learner
    mine = connection.execute(select(LEARNER.c.settings).where(place)).scalar_one()
    whole = {**settings, **mine}
    connection.execute(update(LEARNER).where(place).values(settings=whole))


def _find_free_name(connection: Connection, table: Table, learner: int, name: str) -> str | None:
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


def _insert_attempt(connection: Connection, learner: int, attempt: ArchivedAttempt) -> bool:
    name = _find_free_name(connection, ATTEMPT, learner, attempt.id)
    if name is not None:
        row = {**msgspec.to_builtins(attempt), "id": name, "learner": learner}
        connection.execute(insert(ATTEMPT).values(row))
    return name is not None


def _open_papers(connection: Connection, learner: int) -> set[str]:
    """What a learner has begun and not handed in, each by what the same papers have in common."""
    mine = (SITTING.c.learner == learner, SITTING.c.handed.is_(None))
    return set(map(numbers_of, connection.execute(select(SITTING.c.code).where(*mine)).scalars()))


def _insert_sitting(connection: Connection, learner: int, sitting: ArchivedExam) -> bool:
    name = _find_free_name(connection, SITTING, learner, sitting.id)
    if name is None:
        return False
    row = {**msgspec.to_builtins(sitting), "id": name, "learner": learner}
    answers, flags = row.pop("answers"), row.pop("flags")
    known = select(PAPER.c.id).where(PAPER.c.id == sitting.paper)
    row["paper"] = connection.execute(known).scalar()
    row["counted"] = sitting.handed is not None  # how its parts went is in the file, too
    connection.execute(insert(SITTING).values(row))
    for answer in {one["part"]: one for one in answers}.values():
        connection.execute(insert(ANSWER).values(sitting=name, **answer))
    for number in dict.fromkeys(flags):
        connection.execute(insert(FLAG).values(sitting=name, number=number))
    return True
