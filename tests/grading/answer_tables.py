"""The typed answers of ``answers/*.toml`` with the verdict that each must get."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "answers"


@dataclass(frozen=True)
class Row:
    """One typed answer and what it must get."""

    file: str
    group: str
    spec: dict[str, Any]
    decimal: str
    typed: str
    verdict: str
    note: str
    credit: float | None

    def __str__(self) -> str:
        """Name of the test."""
        return f"{self.file}: {self.group}: {self.typed!r}"


def rows() -> Iterator[Row]:
    """Every row of every table."""
    for path in sorted(FOLDER.glob("*.toml")):
        for group in tomllib.loads(path.read_text("utf-8"))["group"]:
            for row in group["rows"]:
                typed, verdict, *rest = row
                note = rest[0] if rest else None
                credit = rest[1] if len(rest) > 1 else None
                decimal = group.get("decimal", "auto")
                yield Row(
                    path.stem, group["name"], group["spec"], decimal, typed, verdict, note, credit
                )
