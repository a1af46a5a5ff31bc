"""What exams have shown; those of before keep theirs once it was made from their code again."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"


def upgrade() -> None:
    """Make its table, and note which exams have been counted: all that were handed in.

    Columns are added, for a batch would make the table of exams again, and with the old one SQLite
    would delete all answers.
    """
    op.create_table(
        "paper",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("code", sa.String(200), nullable=False),
        sa.Column("parts", sa.JSON, nullable=False),
        sa.Column("data", sa.LargeBinary, nullable=False),
    )
    op.execute("ALTER TABLE sitting ADD COLUMN paper VARCHAR(64) REFERENCES paper (id)")
    for name in ("practice", "counted"):
        op.execute(f"ALTER TABLE sitting ADD COLUMN {name} BOOLEAN DEFAULT false NOT NULL")
    op.execute("UPDATE sitting SET counted = (handed IS NOT NULL)")
