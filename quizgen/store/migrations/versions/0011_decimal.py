"""The decimal sign by which the answers of an exam are read."""

import sqlalchemy as sa
from alembic import op

revision = "0011"
down_revision = "0010"


def upgrade() -> None:
    """Add the column, in place as that of the times; earlier exams were read by either sign."""
    decimal = sa.Column("decimal", sa.String(5), nullable=False, server_default="auto")
    op.add_column("sitting", decimal)
