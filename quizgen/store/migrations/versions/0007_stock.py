"""Papers that were made ahead, each for the one who begins it."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    """Make its table."""
    op.create_table(
        "stock",
        sa.Column("paper", sa.String(64), sa.ForeignKey("paper.id"), primary_key=True),
        sa.Column("blueprint", sa.String(200), nullable=False),
        sa.Column("version", sa.String(64), nullable=False),
        sa.Column("minutes", sa.Integer, nullable=False),
        sa.Column("pauses", sa.Boolean),
    )
    op.create_index("stock_of", "stock", ["blueprint", "version"])
