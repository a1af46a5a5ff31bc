"""All tables as they were before exams kept their papers; databases in use begin here."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = None


def upgrade() -> None:
    """Make them."""
    op.create_table(
        "learner",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("name", sa.String(200), nullable=False, unique=True),
        sa.Column("settings", sa.JSON, nullable=False),
        sa.Column("since", sa.Float, nullable=False),
    )
    op.create_table(
        "attempt",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column(
            "learner", sa.Integer, sa.ForeignKey("learner.id", ondelete="CASCADE"), nullable=False
        ),
        sa.Column("template", sa.String(200), nullable=False),
        sa.Column("seed", sa.String(80), nullable=False),
        sa.Column("level", sa.String(20), nullable=False),
        sa.Column("wish", sa.JSON, nullable=False),
        sa.Column("state", sa.JSON, nullable=False),
        sa.Column("begun", sa.Float, nullable=False),
        sa.Column("ended", sa.Float),
    )
    op.create_index("attempt_of", "attempt", ["learner", "ended", "begun"])
    op.create_table(
        "seen",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column(
            "learner", sa.Integer, sa.ForeignKey("learner.id", ondelete="CASCADE"), nullable=False
        ),
        sa.Column("template", sa.String(200), nullable=False),
        sa.Column("topic", sa.String(200), nullable=False),
        sa.Column("part", sa.String(20), nullable=False),
        sa.Column("note", sa.String(200), nullable=False),
        sa.Column("right", sa.Boolean, nullable=False),
        sa.Column("first", sa.Boolean, nullable=False),
        sa.Column("at", sa.Float, nullable=False),
    )
    op.create_index("seen_of", "seen", ["learner", "at"])
    op.create_table(
        "sitting",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column(
            "learner", sa.Integer, sa.ForeignKey("learner.id", ondelete="CASCADE"), nullable=False
        ),
        sa.Column("code", sa.String(200), nullable=False),
        sa.Column("begun", sa.Float, nullable=False),
        sa.Column("limit", sa.Float),
        sa.Column("pauses", sa.Boolean, nullable=False),
        sa.Column("rested", sa.Float, nullable=False),
        sa.Column("resting", sa.Float),
        sa.Column("handed", sa.Float),
        sa.Column("marks", sa.JSON, nullable=False),
    )
    op.create_index("sitting_of", "sitting", ["learner", "begun"])
    sitting = sa.ForeignKey("sitting.id", ondelete="CASCADE")
    op.create_table(
        "answer",
        sa.Column("sitting", sa.String(32), sitting, primary_key=True),
        sa.Column("part", sa.String(20), primary_key=True),
        sa.Column("fields", sa.JSON, nullable=False),
        sa.Column("at", sa.Float, nullable=False),
    )
    op.create_table(
        "flag",
        sa.Column(
            "sitting", sa.String(32), sa.ForeignKey("sitting.id", ondelete="CASCADE"),
            primary_key=True,
        ),
        sa.Column("number", sa.String(20), primary_key=True),
    )  # fmt: skip
    op.create_table(
        "server",
        sa.Column("name", sa.String(40), primary_key=True),
        sa.Column("value", sa.String(200), nullable=False),
    )
    op.create_table(
        "card",
        sa.Column(
            "learner", sa.Integer, sa.ForeignKey("learner.id", ondelete="CASCADE"),
            primary_key=True,
        ),
        sa.Column("kind", sa.String(20), primary_key=True),
        sa.Column("name", sa.String(300), primary_key=True),
        sa.Column("data", sa.JSON, nullable=False),
        sa.Column("due", sa.Float, nullable=False),
    )  # fmt: skip
    op.create_table(
        "account",
        sa.Column(
            "learner",
            sa.Integer,
            sa.ForeignKey("learner.id", ondelete="CASCADE"),
            primary_key=True,
        ),
        sa.Column("key", sa.String(200), nullable=False, unique=True),
        sa.Column("password", sa.String(200), nullable=False),
        sa.Column("manages", sa.Boolean, nullable=False),
    )
    op.create_table(
        "session",
        sa.Column("hash", sa.String(64), primary_key=True),
        sa.Column(
            "learner", sa.Integer, sa.ForeignKey("learner.id", ondelete="CASCADE"), nullable=False
        ),
        sa.Column("until", sa.Float, nullable=False),
    )
    op.create_index("session_of", "session", ["learner"])
    op.create_table(
        "invitation",
        sa.Column("hash", sa.String(64), primary_key=True),
        sa.Column("learner", sa.Integer, sa.ForeignKey("learner.id", ondelete="CASCADE")),
        sa.Column("manages", sa.Boolean, nullable=False),
        sa.Column("until", sa.Float, nullable=False),
    )
