"""The database itself: opened, read from, and written to by one hand of a learner at a time."""

from __future__ import annotations

import contextlib
import os
import re
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from sqlalchemy import (
    URL,
    Connection,
    Engine,
    Executable,
    Table,
    create_engine,
    event,
    make_url,
    select,
)
from sqlalchemy.dialects import sqlite
from sqlalchemy.exc import ArgumentError, DBAPIError, SQLAlchemyError

from quizgen.core.errors import StoreError, require_extra
from quizgen.core.files import PRIVATE, open_private
from quizgen.store.migrate import upgrade
from quizgen.store.schema import LEARNER

if TYPE_CHECKING:
    from sqlalchemy.dialects.postgresql import Insert as PostgreSQL
    from sqlalchemy.pool import ConnectionPoolEntry

ADDRESSES = "an address is sqlite:///FILE or postgresql+psycopg://USER:PASSWORD@HOST/DATABASE"
DRIVERS = {"sqlite", "sqlite+pysqlite", "postgresql", "postgresql+psycopg"}
PATIENCE = 10
"""Seconds to wait for a server to answer, or for another hand to have written."""
T = TypeVar("T")
_HOST = re.compile(r"[\w.:-]*")
_WRITES = "writes"


class Database:
    """Connections to an SQLite or PostgreSQL database, with grouped commits.

    Parameters
    ----------
    address : str
        ``sqlite:///file`` or ``postgresql+psycopg://...``.

    Raises
    ------
    StoreError
        If it cannot be opened, or was written by a newer version.
    MissingExtraError
        If it is PostgreSQL and its driver is not installed.
    """

    def __init__(self, address: str) -> None:
        url = _parse_database_url(address)
        _restrict_access(url)
        if url.get_backend_name() != "sqlite":
            require_extra("postgres", "a database of PostgreSQL")
        self._reader = _create_engine_for(url)
        self._writer = self._reader.execution_options(**{_WRITES: True})
        self._is_closed = False
        event.listen(self._reader, "checkin", self._close_late_connection)
        self._waiting: list[_Write] = []
        self._joining, self._turn = threading.Lock(), threading.Lock()
        with contextlib.ExitStack() as failing:
            failing.callback(self.close)
            try:
                with self.writing() as connection:
                    upgrade(connection)
            except (SQLAlchemyError, OSError, UnicodeError) as error:  # the names of damaged tables
                raise StoreError(
                    f"{_format_url_safely(url)}: {_format_database_error(error)}"
                ) from error
            failing.pop_all()

    def close(self) -> None:
        """Close all connections, each that a thread still uses as soon as it is given back."""
        self._is_closed = True
        self._reader.dispose()

    def _close_late_connection(self, _raw: object, record: ConnectionPoolEntry) -> None:
        """Close a connection that comes back after all others were closed.

        A server that ends cancels its tasks, but not the threads that they wait for.
        """
        if self._is_closed:
            record.invalidate()

    def reading(self) -> Connection:
        """Return a connection for reading, to be closed by ``with``.

        On SQLite everything that it reads is of one moment; on PostgreSQL each statement is.
        """
        return self._reader.connect()

    @contextlib.contextmanager
    def writing(self, learner: int | None = None) -> Iterator[Connection]:
        """Give a connection for a ``with`` block.

        All is committed, or nothing if an error is raised.

        Of two hands of one learner the second sees what the first has written: SQLite has one
        writer at a time, PostgreSQL holds the learner's row.

        Parameters
        ----------
        learner : int, optional
            Whose data is written.
        """
        # Who waits for SQLite itself only looks now and then, and comes too late in a crowd.
        is_alone = self._reader.dialect.name == "sqlite"
        turn = self._turn if is_alone else contextlib.nullcontext()
        with turn, self._writer.begin() as connection:
            if learner is not None and not is_alone:
                mine = select(LEARNER.c.id).where(LEARNER.c.id == learner)
                connection.execute(mine.with_for_update(key_share=True))
            yield connection

    def write(self, learner: int, work: Callable[[Connection], T]) -> T:
        """Return what ``work`` returns, once all that it wrote is on the disk.

        A disk takes some milliseconds for each commit, however little it holds. So all that waits
        while one is under way is committed together: the first writes for those who wait.
        What fails takes nothing else with it. PostgreSQL groups commits by itself.

        Parameters
        ----------
        learner : int
            Whose data is written.
        work : callable
            Given the connection; what it raises is raised here, and has written nothing.
        """
        if self._reader.dialect.name != "sqlite":
            with self.writing(learner) as connection:
                return work(connection)
        mine = _Write(work)
        with self._joining:
            self._waiting.append(mine)
        with self._turn:
            if not mine.done():
                with self._joining:
                    together, self._waiting = self._waiting, []
                self._commit_batch(together)
        found: T = mine.result()
        return found

    def _commit_batch(self, together: Sequence[_Write]) -> None:
        """Do all waiting writes in one commit; their futures are set when it is on the disk."""
        try:
            with self._writer.begin() as connection:
                ends = [one.run(connection) for one in together]
                _check_open(connection)
        except BaseException as error:  # noqa: BLE001 - raised again by each who waits
            for one in together:
                one.set_exception(error)
        else:
            for end in ends:
                end()


def _check_open(connection: Connection) -> None:
    """Raise an error if SQLite has rolled the transaction back, as it does on a full disk."""
    raw = connection.connection.dbapi_connection
    if isinstance(raw, sqlite3.Connection) and not raw.in_transaction:
        raise SQLAlchemyError("nothing was written")


class _Write(Future[Any]):
    """A write of one learner that waits for the next commit, as a future."""

    def __init__(self, work: Callable[[Connection], Any]) -> None:
        super().__init__()
        self.work = work

    def run(self, connection: Connection) -> Callable[[], None]:
        """Do the work, and return what sets the future once the commit is on the disk."""
        try:
            with connection.begin_nested():
                found = self.work(connection)
        except Exception as error:  # noqa: BLE001 - raised again by who asked
            return partial(self.set_exception, error)
        return partial(self.set_result, found)


def back_up(address: str, file: Path) -> None:
    """Copy a database to a file of its own, also while a server writes to it.

    The copy is of one moment, is one file without a separate log, and is there whole or not at
    all; only its owner reads it.

    Parameters
    ----------
    address : str
        As of ``Database``.
    file : pathlib.Path
        Replaced where there is one.

    Raises
    ------
    StoreError
        If there is no such database, it is PostgreSQL, or the file cannot be written.
    """
    url = _parse_database_url(address)
    if url.get_backend_name() != "sqlite":
        raise StoreError("--backup: PostgreSQL copies a database with its own pg_dump")
    place = Path(str(url.database))
    if not place.is_file():
        raise StoreError(f"{place}: there is no such database")
    fresh = file.with_name(f".{file.name}.new")
    try:
        open_private(fresh, truncate=True).close()
        with (
            contextlib.closing(sqlite3.connect(place, timeout=PATIENCE)) as source,
            contextlib.closing(sqlite3.connect(fresh)) as copy,
        ):
            source.backup(copy)
            copy.execute("PRAGMA journal_mode=DELETE")
        with fresh.open("rb+") as written:
            os.fsync(written.fileno())
        fresh.replace(file)
    except (sqlite3.Error, OSError, UnicodeError) as error:
        fresh.unlink(missing_ok=True)
        raise StoreError(f"{file}: {error}") from error


def upsert(
    connection: Connection,
    table: Table,
    row: Mapping[str, object],
    key: Sequence[str],
    changed: Sequence[str] = (),
) -> None:
    """Insert a row; if one with its key exists, update the columns in ``changed``, or nothing.

    Parameters
    ----------
    connection : sqlalchemy.Connection
    table : sqlalchemy.Table
    row : mapping
    key : sequence of str
        Columns that no two rows share.
    changed : sequence of str
        Columns that are written over.
    """
    query = _build_upsert(connection.dialect.name, table, tuple(key), tuple(changed))
    connection.execute(query, dict(row))


@cache
def _build_upsert(
    dialect: str, table: Table, key: tuple[str, ...], changed: tuple[str, ...]
) -> Executable:
    """Return the statement of `upsert`, cached by table and columns."""
    query: sqlite.Insert | PostgreSQL
    if dialect == "sqlite":
        query = sqlite.insert(table)
    else:
        from sqlalchemy.dialects import postgresql

        query = postgresql.insert(table)
    new = {name: query.excluded[name] for name in changed}
    if not new:
        return query.on_conflict_do_nothing(index_elements=key)
    return query.on_conflict_do_update(index_elements=key, set_=new)


def _create_engine_for(url: URL) -> Engine:
    """Return the SQLAlchemy engine of an address, with SQLite set up for several readers."""
    if url.get_backend_name() != "sqlite":
        wait = {"connect_timeout": PATIENCE}
        return create_engine(url, pool_pre_ping=True, hide_parameters=True, connect_args=wait)
    wait = {"check_same_thread": False, "timeout": PATIENCE}
    engine = create_engine(url, hide_parameters=True, connect_args=wait)

    @event.listens_for(engine, "connect")
    def _set_up(connection: sqlite3.Connection, _record: object) -> None:
        """Set a new SQLite connection up: write-ahead log, synchronous commits, foreign keys."""
        connection.isolation_level = None  # ``_begin`` says when something begins
        _enable_wal(connection)
        # In a log NORMAL waits for no disk: a power cut would take back what was acknowledged.
        for setting in ("synchronous=FULL", "foreign_keys=ON"):
            connection.execute(f"PRAGMA {setting}")

    @event.listens_for(engine, "begin")
    def _begin(connection: Connection) -> None:
        """Begin a transaction on SQLite, which its driver would delay."""
        writes = connection.get_execution_options().get(_WRITES)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")

    return engine


def _restrict_access(url: URL) -> None:
    """Create an SQLite file that only its owner may read, or restrict the one there is.

    It holds answers and names. SQLite gives its log the same mode; the umask is not asked.
    """
    if url.get_backend_name() != "sqlite" or url.database in {None, "", ":memory:"}:
        return
    file = Path(str(url.database))
    with contextlib.suppress(OSError):  # SQLite says what is wrong, or it is another's
        open_private(file).close()
        for one in (file, *(file.with_name(file.name + end) for end in ("-wal", "-shm"))):
            if one.exists():
                one.chmod(PRIVATE)


def _enable_wal(connection: sqlite3.Connection) -> None:
    """Switch SQLite to a write-ahead log, with which readers wait for no writer.

    Of several that ask a new file for it at once SQLite refuses all but one, without waiting.
    """
    last = time.monotonic() + PATIENCE
    while True:
        try:
            connection.execute("PRAGMA journal_mode=WAL")
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY or time.monotonic() > last:
                raise
            time.sleep(0.01)
        else:
            return


def _parse_database_url(address: str) -> URL:
    """Return the parsed address; errors do not quote it, as it may hold a password."""
    try:
        url = make_url(address)
    except (ArgumentError, ValueError) as error:
        raise StoreError(f"--database: {ADDRESSES}") from error
    if url.drivername not in DRIVERS or not _HOST.fullmatch(url.host or ""):
        raise StoreError(f"--database: {ADDRESSES} (write @ : / of a password as %40 %3A %2F)")
    return url


def _format_url_safely(url: URL) -> str:
    """Return the address without its password, which may stand among its settings, too."""
    return url.set(query={}).render_as_string()


def _format_database_error(error: Exception) -> str:
    """Return what went wrong, in the database's own words."""
    cause = error.orig if isinstance(error, DBAPIError) else error
    return str(cause).strip().partition("\n")[0]
