"""Bringing a database to the tables of this version; an older one by ``migrations``."""

from __future__ import annotations

from pathlib import Path

from sqlalchemy import (
    Column,
    Connection,
    MetaData,
    PrimaryKeyConstraint,
    String,
    Table,
    insert,
    inspect,
    select,
    text,
)

from quizgen.core.errors import StoreError
from quizgen.store.schema import METADATA

OLDEST, NEWEST = "0005", "0011"
"""The first and the last step in ``migrations/versions``."""
_VERSIONS = Table(
    "alembic_version",
    MetaData(),
    Column("version_num", String(32), nullable=False),
    PrimaryKeyConstraint("version_num", name="alembic_version_pkc"),
)
"""Where alembic writes the last step that was taken."""


def upgrade(connection: Connection) -> None:
    """Run the migrations that a database lacks, none if it is up to date.

    Raises
    ------
    StoreError
        If a newer version has written it, or one from before the first step.
    """
    if connection.dialect.name == "postgresql":  # of two servers that start at once one waits
        connection.execute(text("SELECT pg_advisory_xact_lock(hashtext('quizgen'))"))
    if not inspect(connection).get_table_names():
        _create_all_tables(connection)
    found = _read_schema_version(connection)
    if found == NEWEST:
        return
    if found is not None and found > NEWEST:
        raise StoreError(f"the database is of a newer version ({found}, this one knows {NEWEST})")
    if found is not None and found < OLDEST:
        raise StoreError(
            f"the database is too old ({found}, this version goes back to {OLDEST}): "
            "save everything as a file with the version that wrote it, and take the file in here"
        )
    from alembic import command  # loaded where something is to be done
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent / "migrations"))
    config.attributes["connection"] = connection
    command.upgrade(config, "head")


def _create_all_tables(connection: Connection) -> None:
    """Create all tables of a new database: the migrations give the same, but load slowly."""
    METADATA.create_all(connection)
    _VERSIONS.create(connection)
    connection.execute(insert(_VERSIONS).values(version_num=NEWEST))


def _read_schema_version(connection: Connection) -> str | None:
    """Return the revision of the last migration; None for a new database."""
    if not inspect(connection).has_table(_VERSIONS.name):
        return None
    return connection.execute(select(_VERSIONS.c.version_num)).scalar()
