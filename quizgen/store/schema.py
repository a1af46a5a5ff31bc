"""The tables. Times are seconds since 1970, in UTC; tables of JSON hold what only pages read."""

from __future__ import annotations

from sqlalchemy import (
    JSON,
    Boolean,
    Column,
    Float,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    text,
)

METADATA = MetaData()

LEARNER = Table(
    "learner",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("name", String(200), nullable=False, unique=True),
    Column("settings", JSON, nullable=False),
    Column("since", Float, nullable=False),
)
"""Who learns; a server for one person has one."""

ATTEMPT = Table(
    "attempt",
    METADATA,
    Column("id", String(32), primary_key=True),
    Column("learner", ForeignKey("learner.id", ondelete="CASCADE"), nullable=False),
    Column("template", String(200), nullable=False),
    Column("seed", String(80), nullable=False),
    Column("level", String(20), nullable=False),
    Column("wish", JSON, nullable=False),
    Column("state", JSON, nullable=False),
    Column("begun", Float, nullable=False),
    Column("ended", Float),
    Index("attempt_of", "learner", "ended", "begun"),
)
"""One question that somebody practises; ``wish`` is what it was chosen by."""

SEEN = Table(
    "seen",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("learner", ForeignKey("learner.id", ondelete="CASCADE"), nullable=False),
    Column("template", String(200), nullable=False),
    Column("topic", String(200), nullable=False),
    Column("part", String(20), nullable=False),
    Column("note", String(200), nullable=False),
    Column("right", Boolean, nullable=False),
    Column("first", Boolean, nullable=False),
    Column("at", Float, nullable=False),
    Column("credit", Float),
    Column("helped", Boolean),
    Column("attempt", String(50)),
    Index("seen_of", "learner", "at"),
)
"""How a part went: right, right at once, the note of the last mistake, what the first try was worth
and which attempt it belonged to; the last three are null where an earlier version wrote the row."""

PAPER = Table(
    "paper",
    METADATA,
    Column("id", String(64), primary_key=True),
    Column("code", String(200), nullable=False),
    Column("parts", JSON, nullable=False),
    Column("data", LargeBinary, nullable=False),
)
"""What an exam shows and what marks it, see ``web.papers``; shared by all who sit it.

``parts`` are the names of its parts: no answer is kept under another.
"""

STOCK = Table(
    "stock",
    METADATA,
    Column("paper", ForeignKey("paper.id"), primary_key=True),
    Column("blueprint", String(200), nullable=False),
    Column("version", String(64), nullable=False),
    Column("minutes", Integer, nullable=False),
    Column("pauses", Boolean),
    Index("stock_of", "blueprint", "version"),
)
"""Papers that were made ahead and that nobody has begun, see ``store.paper_stock``."""

SITTING = Table(
    "sitting",
    METADATA,
    Column("id", String(32), primary_key=True),
    Column("learner", ForeignKey("learner.id", ondelete="CASCADE"), nullable=False),
    Column("code", String(200), nullable=False),
    Column("paper", ForeignKey("paper.id")),
    Column("practice", Boolean, nullable=False, server_default=text("false")),
    Column("begun", Float, nullable=False),
    Column("limit", Float),
    Column("pauses", Boolean, nullable=False),
    Column("rested", Float, nullable=False),
    Column("resting", Float),
    Column("handed", Float),
    Column("counted", Boolean, nullable=False, server_default=text("false")),
    Column("marks", JSON, nullable=False),
    Column("spent", JSON, nullable=False, server_default=text("'{}'")),
    Column("decimal", String(5), nullable=False, server_default="auto"),
    Index("sitting_of", "learner", "begun"),
)
"""An exam that somebody sits, see ``rows.Sitting``."""

ANSWER = Table(
    "answer",
    METADATA,
    Column("sitting", ForeignKey("sitting.id", ondelete="CASCADE"), primary_key=True),
    Column("part", String(20), primary_key=True),
    Column("fields", JSON, nullable=False),
    Column("at", Float, nullable=False),
)
"""What stands in the fields of a part."""

SEAT = Table(
    "seat",
    METADATA,
    Column("student", String(200), primary_key=True),
    Column("learner", ForeignKey("learner.id", ondelete="CASCADE"), nullable=False, unique=True),
    Column("issue", Integer, nullable=False),
    Column("used", Float),
    Column("more", Float, nullable=False),
    Column("paper", ForeignKey("paper.id")),
    Column("sitting", ForeignKey("sitting.id", ondelete="SET NULL")),
    Column("stored", Float),
)
"""A student of a class that sits its exam here, see ``store.seats``."""

FLAG = Table(
    "flag",
    METADATA,
    Column("sitting", ForeignKey("sitting.id", ondelete="CASCADE"), primary_key=True),
    Column("number", String(20), primary_key=True),
)
"""Questions to come back to."""

SERVER = Table(
    "server",
    METADATA,
    Column("name", String(40), primary_key=True),
    Column("value", String(200), nullable=False),
)
"""What a server has in common with the one before it, so that open pages outlive both."""

CARD = Table(
    "card",
    METADATA,
    Column("learner", ForeignKey("learner.id", ondelete="CASCADE"), primary_key=True),
    Column("kind", String(20), primary_key=True),
    Column("name", String(300), primary_key=True),
    Column("data", JSON, nullable=False),
    Column("due", Float, nullable=False),
)
"""What is asked again, and when: see ``practice.schedule.Card``, which ``data`` is all of."""

ACCOUNT = Table(
    "account",
    METADATA,
    Column("learner", ForeignKey("learner.id", ondelete="CASCADE"), primary_key=True),
    Column("key", String(200), nullable=False, unique=True),
    Column("password", String(200), nullable=False),
    Column("manages", Boolean, nullable=False),
)
"""Who signs in: ``key`` is the name as it is compared, ``password`` what Argon2 made of it."""

SESSION = Table(
    "session",
    METADATA,
    Column("hash", String(64), primary_key=True),
    Column("learner", ForeignKey("learner.id", ondelete="CASCADE"), nullable=False),
    Column("until", Float, nullable=False),
    Index("session_of", "learner"),
)
"""A browser in which somebody has signed in; the hash is that of the token in its cookie."""

INVITATION = Table(
    "invitation",
    METADATA,
    Column("hash", String(64), primary_key=True),
    Column("learner", ForeignKey("learner.id", ondelete="CASCADE")),
    Column("manages", Boolean, nullable=False),
    Column("until", Float, nullable=False),
)
"""A link for somebody new, or for a learner to choose a new password; gone once it is used."""
