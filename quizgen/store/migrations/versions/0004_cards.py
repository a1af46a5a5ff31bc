"""What is asked again, and when."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    """Make its table."""
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
