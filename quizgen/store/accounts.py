"""People who sign in: invited once, known by a session. Of tokens only their hashes are kept."""

from __future__ import annotations

import hashlib
import secrets
import time
import unicodedata
from collections.abc import Mapping
from typing import Any

from sqlalchemy import (
    ColumnElement,
    Connection,
    Select,
    Table,
    delete,
    insert,
    select,
    update,
)
from sqlalchemy.exc import IntegrityError

from quizgen.store.database import Database
from quizgen.store.paper_stock import delete_unused_papers
from quizgen.store.records import Invitation, Learner, Person, row_to_record
from quizgen.store.schema import ACCOUNT, INVITATION, LEARNER, SESSION

ALONE = "me"
"""Name of the learner of a server for one person; nobody signs in under it."""
DAY = 86_400.0
SESSION_DAYS, INVITATION_DAYS = 30, 7


def fold_user_name(name: str) -> str:
    """Return a name in the form in which names are compared: NFKC, without case."""
    return unicodedata.normalize("NFKC", name).casefold()


class Accounts:
    """Accounts, invitations and sessions of the people who use a server, in its database.

    Parameters
    ----------
    database : Database
    """

    def __init__(self, database: Database) -> None:
        self.database = database

    def has_manager(self) -> bool:
        """Return whether anybody manages this server."""
        with self.database.reading() as connection:
            query = select(ACCOUNT.c.learner).where(ACCOUNT.c.manages).limit(1)
            return connection.execute(query).first() is not None

    def invite(self, learner: int | None = None, *, manages: bool = False) -> str:
        """Return the token of a new invitation, which is good once.

        Parameters
        ----------
        learner : int, optional
            Who may choose a new password with it, instead of somebody new.
        manages : bool
            Whether somebody new is to manage.
        """
        token, now = secrets.token_urlsafe(24), time.time()
        row = {"learner": learner, "manages": manages, "until": now + INVITATION_DAYS * DAY}
        with self.database.writing() as connection:
            connection.execute(delete(INVITATION).where(INVITATION.c.until < now))
            connection.execute(insert(INVITATION).values(hash=hash_token(token), **row))
        return token

    def find_valid_invitation(self, token: str) -> Invitation | None:
        """Return what a token invites to; None if it was used, withdrawn or is too old."""
        with self.database.reading() as connection:
            return _find_invitation(connection, token)

    def invitations(self) -> list[Invitation]:
        """Return the invitations of new people that are still good."""
        place = (INVITATION.c.until > time.time(), INVITATION.c.learner.is_(None))
        query = select(INVITATION).where(*place).order_by(INVITATION.c.until)
        with self.database.reading() as connection:
            return [row_to_record(row, Invitation) for row in connection.execute(query).mappings()]

    def withdraw(self, name: str) -> None:
        """Delete an invitation; ``name`` is the hash of its token."""
        with self.database.writing() as connection:
            connection.execute(delete(INVITATION).where(INVITATION.c.hash == name))

    def join(self, token: str, name: str, password: str, settings: Mapping[str, Any]) -> int | None:
        """Return the id of a new account made by an invitation, which is then used up.

        Parameters
        ----------
        token : str
        name : str
        password : str
            Its hash.
        settings : mapping
            What was chosen so far.

        Returns
        -------
        int, optional
            The new learner; None if somebody else has the name, or the token is no good.
        """
        if fold_user_name(name) == ALONE:
            return None
        try:
            with self.database.writing() as connection:
                invitation = _consume_invitation(connection, token)
                if invitation is None or invitation.learner:
                    return None
                new = insert(LEARNER).values(name=name, settings=settings, since=time.time())
                made = connection.execute(new).inserted_primary_key
                assert made is not None  # noqa: S101 - the row was written
                row = {
                    "key": fold_user_name(name),
                    "password": password,
                    "manages": invitation.manages,
                }
                connection.execute(insert(ACCOUNT).values(learner=made[0], **row))
        except IntegrityError:
            return None
        return int(made[0])

    def renew(self, token: str, password: str) -> int | None:
        """Replace a password hash by an invitation.

        Return the learner, or None if it is no good.
        """
        with self.database.writing() as connection:
            invitation = _consume_invitation(connection, token)
            if invitation is None or invitation.learner is None:
                return None
            _set_password(connection, invitation.learner, password)
        return invitation.learner

    def password_hash_of(self, name: str) -> tuple[int, str] | None:
        """Return learner id and password hash of a name; None if nobody has it."""
        query = select(ACCOUNT.c.learner, ACCOUNT.c.password)
        with self.database.reading() as connection:
            row = connection.execute(query.where(ACCOUNT.c.key == fold_user_name(name))).first()
        return (int(row[0]), str(row[1])) if row else None

    def set_password(self, learner: int, password: str) -> None:
        """Replace a password's hash; all sessions of the learner end."""
        with self.database.writing(learner) as connection:
            _set_password(connection, learner, password)

    def start_session(self, learner: int) -> str:
        """Return the token of a new session of a learner."""
        token, now = secrets.token_urlsafe(24), time.time()
        row = {"hash": hash_token(token), "learner": learner, "until": now + SESSION_DAYS * DAY}
        with self.database.writing(learner) as connection:
            connection.execute(delete(SESSION).where(SESSION.c.until < now))
            connection.execute(insert(SESSION).values(row))
        return token

    def end_session(self, token: str) -> None:
        """Delete the session of a token: its learner is signed out."""
        with self.database.writing() as connection:
            connection.execute(delete(SESSION).where(SESSION.c.hash == hash_token(token)))

    def end_other_sessions(self, learner: int, token: str) -> None:
        """Delete all sessions of a learner but the one of a token."""
        others = (SESSION.c.learner == learner, SESSION.c.hash != hash_token(token))
        with self.database.writing(learner) as connection:
            connection.execute(delete(SESSION).where(*others))

    def signed_in(self, token: str) -> Learner | None:
        """Return the learner whose session a token is of; None if there is none."""
        query = _select_people(LEARNER.c.settings, ACCOUNT.c.manages).join(SESSION)
        query = query.where(SESSION.c.hash == hash_token(token), SESSION.c.until > time.time())
        with self.database.reading() as connection:
            row = connection.execute(query).mappings().first()
        return row_to_record(row, Learner) if row else None

    def is_session(self, token: str, learner: int) -> bool:
        """Return whether a token is a session of this learner, who may have no account."""
        place = (SESSION.c.hash == hash_token(token), SESSION.c.learner == learner)
        query = select(SESSION.c.hash).where(*place, SESSION.c.until > time.time())
        with self.database.reading() as connection:
            return connection.execute(query).first() is not None

    def people(self) -> list[Person]:
        """Return everybody who can sign in, sorted by name."""
        query = _select_people(ACCOUNT.c.manages, LEARNER.c.since).order_by(ACCOUNT.c.key)
        with self.database.reading() as connection:
            return [row_to_record(row, Person) for row in connection.execute(query).mappings()]

    def rename(self, learner: int, name: str) -> bool:
        """Change a learner's name; return False, changing nothing, if it is taken or reserved."""
        if fold_user_name(name) == ALONE:
            return False
        try:
            with self.database.writing(learner) as connection:
                new = {"key": fold_user_name(name)}
                connection.execute(
                    update(ACCOUNT).where(_match_learner(ACCOUNT, learner)).values(new)
                )
                connection.execute(update(LEARNER).where(LEARNER.c.id == learner).values(name=name))
        except IntegrityError:
            return False
        return True

    def remove(self, learner: int) -> None:
        """Delete a learner with all that they did, and papers that nobody else sat."""
        with self.database.writing(learner) as connection:
            connection.execute(delete(LEARNER).where(LEARNER.c.id == learner))
            delete_unused_papers(connection)


def _select_people(*more: ColumnElement[Any]) -> Select[Any]:
    """Return the query of learners with accounts: id, name, and more columns."""
    query = select(LEARNER.c.id, LEARNER.c.name, *more)
    return query.select_from(LEARNER).join(ACCOUNT)


def _match_learner(table: Table, learner: int) -> ColumnElement[bool]:
    """Return the condition that a row of a table belongs to a learner."""
    return table.c.learner == learner


def hash_token(token: str) -> str:
    """Return the SHA-256 of a token, in hexadecimal digits.

    Tokens are random and long, so that no slow password hash is needed.
    """
    return hashlib.sha256(token.encode()).hexdigest()


def _find_invitation(connection: Connection, token: str) -> Invitation | None:
    """Return the invitation of a token that is still good, or None."""
    good = (INVITATION.c.hash == hash_token(token), INVITATION.c.until > time.time())
    row = connection.execute(select(INVITATION).where(*good)).mappings().first()
    return row_to_record(row, Invitation) if row else None


def _consume_invitation(connection: Connection, token: str) -> Invitation | None:
    """Return the invitation of a token and delete it, or return None.

    Of two requests at once only one gets it.
    """
    found = _find_invitation(connection, token)
    gone = connection.execute(delete(INVITATION).where(INVITATION.c.hash == hash_token(token)))
    return found if gone.rowcount else None


def _set_password(connection: Connection, learner: int, password: str) -> None:
    """Replace a password's hash, and delete the learner's sessions and invitations."""
    new = {"password": password}
    connection.execute(update(ACCOUNT).where(_match_learner(ACCOUNT, learner)).values(new))
    for table in (SESSION, INVITATION):
        connection.execute(delete(table).where(_match_learner(table, learner)))
