"""Exams that are sat."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Make their tables."""
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
