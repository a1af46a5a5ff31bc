"""What all servers of a database have in common: short texts by name."""

from __future__ import annotations

from sqlalchemy import select

from quizgen.store.database import Database, upsert
from quizgen.store.schema import SERVER


class SharedValues:
    """Short texts by name, which outlive the server that wrote them.

    Parameters
    ----------
    database : Database
    """

    def __init__(self, database: Database) -> None:
        self.database = database

    def find(self, name: str) -> str:
        """Return what stands under a name; "" if nothing."""
        query = select(SERVER.c.value).where(SERVER.c.name == name)
        with self.database.reading() as connection:
            return str(connection.execute(query).scalar() or "")

    def settle(self, name: str, value: str) -> str:
        """Return what stands under a name; ``value``, which then stays, if nothing did.

        Of servers that ask at once, all get that of the first.
        """
        query = select(SERVER.c.value).where(SERVER.c.name == name)
        with self.database.writing() as connection:
            upsert(connection, SERVER, {"name": name, "value": value}, ["name"])
            return str(connection.execute(query).scalar_one())

    def replace(self, name: str, value: str) -> None:
        """Write a text under a name, whatever stood there."""
        with self.database.writing() as connection:
            upsert(connection, SERVER, {"name": name, "value": value}, ["name"], ["value"])
