"""The database: every released form of it comes up, on both kinds; what is wrong with one is said."""

from __future__ import annotations

import contextlib
import json
import sqlite3
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path

import psycopg
import pytest
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from sqlalchemy import create_engine, insert, inspect, text
from sqlalchemy.exc import IntegrityError
from sweep import together

from quizgen.core.errors import MissingExtraError, StoreError
from quizgen.practice.scheduler import ReviewEvent, ReviewRating
from quizgen.store import OutcomeRecord, QuestionRef, Store, migrate
from quizgen.store.schema import METADATA

STEPS = Path(migrate.__file__).parent / "migrations"
ROWS = {
    "0005": {
        "learner": {"id": 7, "name": "me", "settings": '{"lang": "bn"}', "since": 1.5},
        "attempt": {"id": "abcdefghijkl", "learner": 7, "template": "rgb-to-hsv", "seed": "3",
                    "level": "exam", "wish": "{}", "state": '{"ended": ["1"]}', "begun": 2.5, "ended": 3.5},
        "seen": {"id": 5, "learner": 7, "template": "rgb-to-hsv", "topic": "colour", "part": "a",
                 "note": "trap:হ্যাঁ", "right": False, "first": False, "at": 3.5},
        "sitting": {"id": "zyxwvutsrqpo", "learner": 7, "code": "trial-1-both-000000", "begun": 4.5, "limit": 60.0,
                    "pauses": True, "rested": 0.0, "resting": None, "handed": None, "marks": "{}"},
        "answer": {"sitting": "zyxwvutsrqpo", "part": "1a", "fields": '["৩", ""]', "at": 5.5},
        "flag": {"sitting": "zyxwvutsrqpo", "number": "2"},
        "server": {"name": "token", "value": "secret"},
        "card": {"learner": 7, "kind": "template", "name": "C1", "due": 9.5, "data": json.dumps(
        {"kind": "template", "name": "C1", "state": 2, "step": None, "stability": 2.5,
         "difficulty": 5.5, "last": 3.5, "due": 9.5})},
        "account": {"learner": 7, "key": "me7", "password": "$argon2id$x", "manages": True},
        "session": {"hash": sha256(b"token").hexdigest(), "learner": 7, "until": 4e9},
        "invitation": {"hash": sha256(b"link").hexdigest(), "learner": None, "manages": False, "until": 4e9},
    },
    "0006": {"paper": {"id": "f" * 64, "code": "trial-1-both-000000", "parts": '["1a"]', "data": b"packed"}},
    "0007": {"stock": {"paper": "f" * 64, "blueprint": "trial", "version": "v", "minutes": 9, "pauses": None}},
    "0008": {},
    "0009": {},
    "0010": {},
    "0011": {},
}  # fmt: skip
"""What each release keeps, in the tables that it has added."""

pytestmark = pytest.mark.both_databases


def as_released(address: str, release: str) -> None:
    """Make the database as a release left it, with something in each table."""
    engine = create_engine(address)
    with engine.begin() as connection:
        config = Config()
        config.set_main_option("script_location", str(STEPS))
        config.attributes["connection"] = connection
        command.upgrade(config, release)
        for step, rows in ROWS.items():
            for table, row in rows.items() if step <= release else ():
                names = ", ".join(f'"{name}"' for name in row)
                values = ", ".join(f":{name}" for name in row)
                connection.execute(text(f"INSERT INTO {table} ({names}) VALUES ({values})"), row)
    engine.dispose()


def test_a_new_database_is_as_the_steps_leave_one(database):
    stepped, made = database(), database()
    as_released(stepped, "head")
    Store(made).close()

    def tables(address: str) -> dict[str, object]:
        engine = create_engine(address)
        with engine.connect() as connection:
            there = inspect(connection)
            version = connection.execute(text("SELECT * FROM alembic_version")).all()
            found = {
                name: [
                    sorted(map(str, told(name)))
                    for told in (there.get_columns, there.get_indexes, there.get_foreign_keys,
                                 there.get_unique_constraints)
                ] + [there.get_pk_constraint(name)]
                for name in there.get_table_names()
            }  # fmt: skip
        engine.dispose()
        return {"version": version, **found}

    assert tables(made) == tables(stepped)


@pytest.mark.parametrize("release", sorted(path.name[:4] for path in STEPS.glob("versions/*.py")))
def test_every_release_comes_up_with_what_it_keeps(database, release):
    address = database()
    as_released(address, release)
    store = Store(address)
    with store.database.reading() as connection:
        assert compare_metadata(MigrationContext.configure(connection), METADATA) == []
    learner = store.learner()
    assert (learner.id, learner.settings) == (7, {"lang": "bn"})
    assert store.latest(7)[0].state == {"ended": ["1"]}
    assert store.list_outcomes(7)[0].note == "trap:হ্যাঁ"
    (sitting,) = store.sittings.latest(7)
    assert (sitting.limit, sitting.pauses) == (60.0, True)
    assert store.sittings.answers(sitting) == {"1a": ["৩", ""]}
    assert store.sittings.flags(sitting) == {"2"}
    assert store.shared.settle("token", "other") == "secret"
    assert store.cards.all(7)["template", "C1"].stability == 2.5
    assert store.accounts.password_hash_of("ME7") == (7, "$argon2id$x")
    assert store.accounts.signed_in("token").manages
    assert store.accounts.find_valid_invitation("link").learner is None
    if release >= "0006":
        assert store.sittings.paper("f" * 64) == b"packed"
    if release >= "0007":
        assert store.stock.count_papers("trial", "v") == 1
    store.save_attempt(store.start_attempt(7, QuestionRef("rgb-to-hsv", "4"), {}))
    store.close()


def test_a_connection_in_use_is_closed_when_it_is_given_back(database):
    store = Store(database())
    with store.database.reading() as before:
        raw = before.connection.dbapi_connection
        store.close()
        raw.cursor().execute("SELECT 1")
    with store.database.reading() as after:
        late = after.connection.dbapi_connection
    for one in (raw, late):
        with pytest.raises((sqlite3.ProgrammingError, psycopg.OperationalError), match="closed"):
            one.cursor().execute("SELECT 1")


@pytest.mark.parametrize(("version", "said"), [("9999", "newer version"), ("0004", "too old")])
def test_a_database_of_unknown_tables_is_left_alone(database, version, said):
    address = database()
    Store(address).close()
    engine = create_engine(address)
    with engine.begin() as connection:
        statement = text("UPDATE alembic_version SET version_num = :version")
        connection.execute(statement, {"version": version})
    engine.dispose()
    with pytest.raises(StoreError, match=said):
        Store(address)


def test_servers_that_begin_at_once_make_the_tables_once(database):
    address = database()
    with ThreadPoolExecutor(4) as threads:
        stores = list(threads.map(Store, [address] * 4))
        assert len({store.learner().id for store in stores}) == 1
        assert len(set(threads.map(lambda s: s.shared.settle("token", str(id(s))), stores))) == 1
    for store in stores:
        store.close()


def test_a_new_file_is_opened_while_another_hand_writes_to_it(tmp_path):
    file = tmp_path / "learning.sqlite3"
    with contextlib.closing(sqlite3.connect(file, check_same_thread=False)) as other:
        other.execute("BEGIN IMMEDIATE")
        done = threading.Timer(0.3, other.rollback)
        done.start()
        store = Store(f"sqlite:///{file}")
        done.join()
    assert store.learner().id == 1
    store.close()


def test_of_what_comes_at_once_from_two_servers_nothing_is_lost(database):
    address = database()
    stores = [Store(address) for _ in range(2)]
    me = stores[0].learner().id
    sitting = stores[0].sittings.begin(me, "trial-1-both-000000", None, pauses=True)
    seen = OutcomeRecord("rgb-to-hsv", "colour", "a", "", right=True, first=True, at=time.time())

    def write(place: int) -> tuple[bool, bool]:
        store = stores[place % 2]
        store.update_settings(me, {f"s{place}": place})
        store.cards.review(me, [ReviewEvent(f"T{place}", ReviewRating.GOOD)], time.time())
        store.sittings.save(sitting.learner, sitting.id, {"1": [str(place)], f"{place}a": ["x"]})
        if place <= 7:
            return False, False
        return store.sittings.hand_in(sitting), store.sittings.count(sitting, (seen,))

    with ThreadPoolExecutor(8) as threads:
        list(threads.map(write, range(8)))
        handed = list(threads.map(write, range(8, 16)))
    assert [sum(once) for once in zip(*handed, strict=True)] == [1, 1]
    assert len(stores[1].list_outcomes(me)) == 1
    assert len(stores[1].cards.all(me)) == 16
    assert stores[0].learner().settings.keys() == {f"s{place}" for place in range(16)}
    assert stores[0].sittings.answers(sitting).keys() >= {"1"} | {f"{n}a" for n in range(8)}
    for store in stores:
        store.close()


def test_what_fails_half_way_has_written_nothing(database):
    store = Store(database())
    me = store.learner().id
    attempt = store.start_attempt(me, QuestionRef("rgb-to-hsv", "4"), {})
    attempt.state = {"new": True}
    with pytest.raises(TypeError):
        store.save_attempt(
            attempt, (OutcomeRecord("t", "c", "a", "", right=True, first=True, at=0.0), None)
        )
    assert store.attempt(me, attempt.id).state == {}
    assert store.list_outcomes(me) == []
    store.close()


class TestAddresses:
    """What is wrong with an address is said, and never its password."""

    @together(
        ("address", "said"),
        [
            ("postgresql+psycopg://me:geheim@127.0.0.1:1/x", r"me:\*\*\*@127.0.0.1:1/x: .*refused"),
            ("postgresql+psycopg://me@127.0.0.1:1/x?password=geheim", "refused"),
            ("postgresql+psycopg://me:geheim@nowhere.invalid/x", "nowhere.invalid"),
            ("postgresql+psycopg://me:geh@eim@127.0.0.1/x", "%40"),
            ("postgresql+psycopg://me:x@127.0.0.1:geheim/x", "an address is"),
            ("postgresql+psycopg2://me:geheim@127.0.0.1/x", "an address is"),
            ("postgres://me:geheim@127.0.0.1/x", "an address is"),
            ("mysql://me:geheim@127.0.0.1/x", "an address is"),
            ("geheim", "an address is"),
            ("", "an address is"),
            ("sqlite:////nowhere/geh/x.sqlite3", "unable to open"),
        ],
    )
    def test_what_is_wrong_is_said(self, address, said):
        with pytest.raises(StoreError, match=said) as raised:
            Store(address)
        assert "geheim" not in str(raised.value)
        assert "eim@" not in str(raised.value)
        assert "\n" not in str(raised.value)

    def test_a_driver_that_is_missing_is_named(self, monkeypatch):
        monkeypatch.setitem(sys.modules, "psycopg", None)
        with pytest.raises(MissingExtraError, match=r"quizgen\[postgres\]"):
            Store("postgresql+psycopg://me:geheim@127.0.0.1:1/x")

    def test_errors_of_the_database_do_not_hold_what_was_written(self, database):
        store = Store(database())
        row = {
            "id": store.learner().id,
            "name": "me",
            "settings": {"typed": "geheim"},
            "since": 1.0,
        }
        with store.database.writing() as connection, pytest.raises(IntegrityError) as raised:
            connection.execute(insert(METADATA.tables["learner"]).values(**row))
        assert "geheim" not in str(raised.value)
        store.close()
