"""People who sign in."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
    """Make their tables."""
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
