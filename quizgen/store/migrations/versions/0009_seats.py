"""Students of a class that sits its exam in the browser."""

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"


def upgrade() -> None:
    """Make their table."""
    op.create_table(
        "seat",
        sa.Column("student", sa.String(200), primary_key=True),
        sa.Column(
            "learner",
            sa.Integer,
            sa.ForeignKey("learner.id", ondelete="CASCADE"),
            nullable=False,
            unique=True,
        ),
        sa.Column("issue", sa.Integer, nullable=False),
        sa.Column("used", sa.Float),
        sa.Column("more", sa.Float, nullable=False),
        sa.Column("paper", sa.String(64), sa.ForeignKey("paper.id")),
        sa.Column("sitting", sa.String(32), sa.ForeignKey("sitting.id", ondelete="SET NULL")),
        sa.Column("stored", sa.Float),
    )
