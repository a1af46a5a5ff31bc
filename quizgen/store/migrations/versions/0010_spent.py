"""How long each question of an exam was looked at."""

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"


def upgrade() -> None:
    """Add the column; of exams that were sat before nothing is known.

    In place: SQLite would make the table anew for a batch, and drop the answers that refer to it.
    """
    spent = sa.Column("spent", sa.JSON, nullable=False, server_default=sa.text("'{}'"))
    op.add_column("sitting", spent)
