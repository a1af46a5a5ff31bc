"""Bringing a database to the tables of this version, by the steps in ``migrations``."""

from __future__ import annotations

from pathlib import Path

from sqlalchemy import Connection, inspect, text

from quizgen.errors import StoreError

NEWEST = "0004"
"""The last step in ``migrations/versions``."""


def upgrade(connection: Connection) -> None:
    """Take the steps that a database lacks; none are taken where it is up to date.

    Raises
    ------
    StoreError
        If a newer version has written it.
    """
    if connection.dialect.name == "postgresql":  # of two servers that start at once one waits
        connection.execute(text("SELECT pg_advisory_xact_lock(hashtext('quizgen'))"))
    found = _version(connection)
    if found == NEWEST:
        return
    if found is not None and found > NEWEST:
        raise StoreError(f"the database is of a newer version ({found}, this one knows {NEWEST})")
    from alembic import command  # loaded where something is to be done
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent / "migrations"))
    config.attributes["connection"] = connection
    command.upgrade(config, "head")


def _version(connection: Connection) -> str | None:
    if not inspect(connection).has_table("alembic_version"):
        return None
    return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
