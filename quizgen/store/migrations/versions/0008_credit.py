"""What a part was worth at its first try, and which attempt it belonged to."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    """Add the columns; what was stored before has neither."""
    with op.batch_alter_table("seen") as table:
        table.add_column(sa.Column("credit", sa.Float))
        table.add_column(sa.Column("helped", sa.Boolean))
        table.add_column(sa.Column("attempt", sa.String(50)))
