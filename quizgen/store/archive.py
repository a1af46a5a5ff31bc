"""Everything of a learner as one file, and such a file taken in: added to, never doubled."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Annotated, Any, Literal, TypeAlias, TypeVar

import msgspec
from sqlalchemy import Connection, Table, insert, select, update

from quizgen.core.decoding import decode_json
from quizgen.core.errors import StoreError
from quizgen.practice.scheduler import Moment, ReviewCard
from quizgen.practice.session_state import PartState
from quizgen.store.database import Database
from quizgen.store.exam_attempts import MOST_PARTS, numbers_of
from quizgen.store.review_cards import read_cards, write_card
from quizgen.store.schema import ANSWER, ATTEMPT, CARD, FLAG, LEARNER, PAPER, SEEN, SITTING

FORMAT = "quizgen learning"
CHUNK = 50
"""Rows of a file that are written together: some milliseconds."""
_PAUSE = 0.005
"""Seconds between them: a writer outside of a group only looks now and then."""
T = TypeVar("T")
TEXT = "^[^\0]*$"
"""What a database takes as text."""
Short: TypeAlias = Annotated[str, msgspec.Meta(max_length=200, pattern=TEXT)]
Part: TypeAlias = Annotated[str, msgspec.Meta(max_length=20, pattern=TEXT)]
Typed: TypeAlias = Annotated[str, msgspec.Meta(max_length=10_000, pattern=TEXT)]
Id: TypeAlias = Annotated[str, msgspec.Meta(pattern="^[A-Za-z0-9_-]{8,32}$")]


Wish: TypeAlias = dict[Literal["topic", "tier", "repair"], Short]
Settings: TypeAlias = dict[Literal["lang", "exam"], Part]


class StrictStruct(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part of an archive file, in which unknown keys are errors."""


class ArchivedPart(StrictStruct, frozen=True):
    """How far a practised part has got: its state and what stands in its fields."""

    state: PartState
    values: Annotated[list[Typed], msgspec.Meta(max_length=400)] = []
    asked_back: Typed = ""


class ArchivedState(StrictStruct, frozen=True, omit_defaults=True):
    """How far a practised question has got, part by part."""

    parts: dict[Part, ArchivedPart] = {}
    ended: list[Part] = []
    notes: dict[Part, Short] = {}
    """The mistakes, where earlier versions kept them."""


class ArchivedAttempt(StrictStruct, frozen=True):
    """One question that was practised."""

    id: Id
    template: Short
    seed: Annotated[str, msgspec.Meta(max_length=80, pattern=TEXT)]
    level: Part
    wish: Wish
    state: ArchivedState
    begun: Moment
    ended: Moment | None


class ArchivedOutcome(StrictStruct, frozen=True):
    """How one part went, practised or in an exam."""

    template: Short
    topic: Short
    part: Part
    note: Short
    right: bool
    first: bool
    at: Moment
    credit: Annotated[float, msgspec.Meta(ge=0, le=1)] | None = None
    helped: bool | None = None
    attempt: Annotated[str, msgspec.Meta(max_length=50, pattern=TEXT)] | None = None


class ArchivedAnswer(StrictStruct, frozen=True):
    """What stands in the fields of one part of an exam, and since when."""

    part: Part
    fields: Annotated[list[Typed], msgspec.Meta(max_length=400)]
    at: Moment


class ArchivedExam(StrictStruct, frozen=True):
    """One exam that was sat, with its answers, flags and pauses."""

    id: Id
    code: Short
    begun: Moment
    limit: Moment | None
    pauses: bool
    rested: Moment
    resting: Moment | None
    handed: Moment | None
    marks: dict[Part, Annotated[float, msgspec.Meta(ge=0, le=1)]]
    answers: Annotated[list[ArchivedAnswer], msgspec.Meta(max_length=MOST_PARTS)]
    flags: Annotated[list[Part], msgspec.Meta(max_length=MOST_PARTS)]
    practice: bool = False
    spent: dict[Part, Annotated[float, msgspec.Meta(ge=0)]] = {}
    decimal: Literal["auto", "point", "comma"] = "auto"
    paper: Annotated[str, msgspec.Meta(pattern="^[0-9a-f]{64}$")] | None = None
    """Its id, once it was handed in. The paper itself is HTML: nobody's file is believed that."""


class LearnerArchive(StrictStruct, frozen=True):
    """All data of one learner: the content of an archive file."""

    format: Literal["quizgen learning"]
    version: Literal[1]
    settings: Settings
    attempts: list[ArchivedAttempt]
    seen: list[ArchivedOutcome]
    cards: list[ReviewCard]
    sittings: list[ArchivedExam]


def read_archive(data: bytes) -> LearnerArchive:
    """Return the checked content of an archive file.

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
    """Exports the data of learners to archive files and imports such files.

    Parameters
    ----------
    database : Database
    """

    def __init__(self, database: Database) -> None:
        self.database = database

    def write(self, learner: int) -> bytes:
        """Return the archive file of a learner, in JSON."""
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
                    {**row, "wish": _select_columns(("topic", "tier", "repair"), row["wish"])}
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
        """Add what a learner does not have yet; return how many questions and exams were added.

        SQLite has one writer at a time, and a long file takes many seconds: it is written in
        slices, between which answers of others are saved. What a file that was interrupted has
        brought stays; taken in again it brings the rest, and nothing twice.
        """
        count = 0
        for step in _iter_import_steps(learner, archive):
            count += self.database.write(learner, step)
            time.sleep(_PAUSE)
        return count


def _iter_import_steps(
    learner: int, archive: LearnerArchive
) -> Iterator[Callable[[Connection], int]]:
    """Yield functions that each import a slice of an archive and return how much it added.

    Added questions and exams are counted, nothing else.
    """
    yield partial(_merge_settings, learner=learner, settings=archive.settings)
    for attempts in _split_chunks(archive.attempts):
        yield partial(_add_attempts, learner=learner, attempts=attempts)
    for seen in _split_chunks(archive.seen):
        yield partial(_add_seen, learner=learner, coming=seen)
    for cards in _split_chunks(archive.cards):
        yield partial(_add_cards, learner=learner, coming=cards)
    for sitting in archive.sittings:
        yield partial(_add_sitting, learner=learner, sitting=sitting)


def _split_chunks(rows: Sequence[T]) -> Iterator[Sequence[T]]:
    """Return consecutive pieces of ``CHUNK`` rows."""
    return (rows[first : first + CHUNK] for first in range(0, len(rows), CHUNK))


def _select_columns(names: tuple[str, ...], table: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of these columns that a record of the database has."""
    return {name: table[name] for name in names if name in table}


def _iter_learner_rows(
    connection: Connection, table: Table, learner: int, *but: str
) -> Iterator[dict[str, Any]]:
    """Yield a learner's rows of a table as dicts, without the columns ``learner`` and ``but``."""
    columns = [c for c in table.c if c.name not in {"learner", *but}]
    for row in connection.execute(select(*columns).where(table.c.learner == learner)).mappings():
        yield {str(name): cell for name, cell in row.items()}


def _read_sitting_contents(connection: Connection, sitting: str) -> dict[str, Any]:
    """Return answers and flags of an exam, by the names of an archive's fields."""
    answers = select(ANSWER.c.part, ANSWER.c.fields, ANSWER.c.at).where(ANSWER.c.sitting == sitting)
    flags = select(FLAG.c.number).where(FLAG.c.sitting == sitting)
    return {
        "answers": [dict(row) for row in connection.execute(answers).mappings()],
        "flags": list(connection.execute(flags).scalars()),
    }


def _merge_settings(connection: Connection, learner: int, settings: Settings) -> int:
    """Set those settings that the learner has not chosen; return 0, as nothing is counted."""
    place = LEARNER.c.id == learner
    mine = connection.execute(select(LEARNER.c.settings).where(place)).scalar_one()
    whole = {**settings, **mine}
    connection.execute(update(LEARNER).where(place).values(settings=whole))
    return 0


def _choose_free_names(
    connection: Connection, table: Table, learner: int, names: Iterable[str]
) -> dict[str, str]:
    """Return archived ids to the ids to import under; those already imported are left out.

    An id that somebody else has is replaced by one that follows from it, so that the same file
    never adds anything twice.
    """
    others = {name: hashlib.sha256(f"{learner}/{name}".encode()).hexdigest()[:24] for name in names}
    query = select(table.c.id, table.c.learner)
    query = query.where(table.c.id.in_([*others, *others.values()]))
    owners = {str(name): owner for name, owner in connection.execute(query)}
    free = {
        name: next((one for one in (name, other) if owners.get(one, learner) == learner), name)
        for name, other in others.items()
    }
    return {name: one for name, one in free.items() if one not in owners}


def _add_attempts(connection: Connection, learner: int, attempts: Sequence[ArchivedAttempt]) -> int:
    """Add practised questions that the learner lacks; return how many."""
    named = {one.id: one for one in reversed(attempts)}
    free = _choose_free_names(connection, ATTEMPT, learner, named)
    rows = [
        {**msgspec.to_builtins(named[name]), "id": one, "learner": learner}
        for name, one in free.items()
    ]
    if rows:
        connection.execute(insert(ATTEMPT), rows)
    return len(rows)


def _add_seen(connection: Connection, learner: int, coming: Sequence[ArchivedOutcome]) -> int:
    """Add outcomes that the learner lacks; return 0, as they are not counted."""
    times = {one.at for one in coming}
    place = (SEEN.c.learner == learner, SEEN.c.at >= min(times), SEEN.c.at <= max(times))
    columns = [SEEN.c[name] for name in ArchivedOutcome.__struct_fields__]
    known = {tuple(row) for row in connection.execute(select(*columns).where(*place))}
    new = {msgspec.structs.astuple(one): one for one in coming}
    rows = [
        {"learner": learner, **msgspec.structs.asdict(one)}
        for key, one in new.items()
        if key not in known
    ]
    if rows:
        connection.execute(insert(SEEN), rows)
    return 0


def _add_cards(connection: Connection, learner: int, coming: Sequence[ReviewCard]) -> int:
    """Add review cards, or replace those last reviewed earlier.

    Return 0, as they are not counted.
    """
    cards = read_cards(connection, learner)
    for card in coming:
        mine = cards.get((card.kind, card.name))
        if mine is None or mine.last < card.last:
            write_card(connection, learner, card)
    return 0


def _list_open_numbers(connection: Connection, learner: int) -> set[str]:
    """Return `numbers_of` each exam that a learner has begun and not handed in."""
    mine = (SITTING.c.learner == learner, SITTING.c.handed.is_(None))
    return set(map(numbers_of, connection.execute(select(SITTING.c.code).where(*mine)).scalars()))


def _add_sitting(connection: Connection, learner: int, sitting: ArchivedExam) -> int:
    """Add an exam with answers and flags; return 1, or 0 if it was there or the same is open."""
    # As handed in by a file, a paper would show the key of the same that is open here.
    if numbers_of(sitting.code) in _list_open_numbers(connection, learner):
        return 0
    name = _choose_free_names(connection, SITTING, learner, [sitting.id]).get(sitting.id)
    if name is None:
        return 0
    row = {**msgspec.to_builtins(sitting), "id": name, "learner": learner}
    answers, flags = row.pop("answers"), row.pop("flags")
    known = select(PAPER.c.id).where(PAPER.c.id == sitting.paper)
    row["paper"] = connection.execute(known).scalar()
    row["counted"] = sitting.handed is not None  # how its parts went is in the file, too
    connection.execute(insert(SITTING).values(row))
    last = {one["part"]: {"sitting": name, **one} for one in answers}
    if last:
        connection.execute(insert(ANSWER), list(last.values()))
    if flags:
        rows = [{"sitting": name, "number": number} for number in dict.fromkeys(flags)]
        connection.execute(insert(FLAG), rows)
    return 1
