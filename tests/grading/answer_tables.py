"""The marking tables: read for the tests, printed into the documentation."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "answers"
PAGE = Path(__file__).parents[2] / "docs" / "answers.md"
START, END = "<!-- marking tables -->", "<!-- end of marking tables -->"


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


def _cell(text: object) -> str:
    shown = "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in str(text))
    return f"`{shown}`" if shown else ""


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        inside = ", ".join(f"{_key(k)} = {_toml(v)}" for k, v in value.items())
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    text = str(value).replace("\n", "\\n")
    return f'"{text}"' if isinstance(value, str) else text


def _key(name: str) -> str:
    return (
        name if name.isascii() and name.replace("_", "").replace("-", "").isalnum() else f'"{name}"'
    )


def markdown() -> str:
    """All tables as Markdown."""
    lines, last = [START], None
    for row in rows():
        if (row.file, row.group) != last:
            last = (row.file, row.group)
            sign = "" if row.decimal == "auto" else f" (decimal sign: {row.decimal})"
            lines += ["", f"**{row.file}: {row.group}**{sign}", "", f"`{_toml(row.spec)}`", ""]
            lines += ["| typed | verdict | note |", "|---|---|---|"]
        typed = _cell(row.typed).replace("|", "\\|")
        lines.append(f"| {typed} | {row.verdict} | {row.note or ''} |")
    return "\n".join([*lines, "", END])


def page() -> str:
    """The page with its tables renewed."""
    text = PAGE.read_text("utf-8")
    before, _, rest = text.partition(START)
    return before + markdown() + rest.partition(END)[2]


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
