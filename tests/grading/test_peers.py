"""What other programs publish of their decisions on typed answers, against the decisions here.

``peers/*.toml`` has them as facts. A row where grading decides otherwise says what it decides, and why.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from sweep import together

from quizgen.kinds.grade import grade_answer

FOLDER = Path(__file__).parent / "peers"
PEERS = sorted(path.stem for path in FOLDER.glob("*.toml"))
AGREED = {
    "numbas": (72, 72),
    "prairielearn": (55, 57),
    "stack_formulas": (135, 154),
    "stack_numbers": (73, 74),
    "stack_units": (87, 96),
}
"""Rows on which both decide alike, of all rows."""
NAME = re.compile(r"[A-Za-z]\w*(?![\w(])")


def rows_of(peer: str) -> Iterator[tuple[str, dict[str, Any], dict[str, Any]]]:
    """Each row of a file: its decimal sign, the question, and the row."""
    for group in tomllib.loads((FOLDER / f"{peer}.toml").read_text("utf-8"))["group"]:
        for row in group["rows"]:
            yield group["decimal"], make_spec(group["spec"], row), row


def make_spec(base: dict[str, Any], row: dict[str, Any]) -> dict[str, Any]:
    """The question of a row; formulas may use every name that is no function or constant."""
    said = {"typed", "key", "theirs", "ours", "why", "positive"}
    spec = base | {name: value for name, value in row.items() if name not in said}
    spec["values" if isinstance(row["key"], list) else "value"] = row["key"]
    if spec["kind"] in {"expression", "equation"}:
        names = sorted(set(NAME.findall(f"{row['key']} {row['typed']}")) - {"e", "pi"})
        real = spec.get("symbols") or dict.fromkeys(names, "real")
        domains = real | dict.fromkeys(row.get("positive", ()), "positive")
        spec["symbols"] = domains if spec["kind"] == "expression" else names
    return spec


def decide(decimal: str, spec: dict[str, Any], typed: str) -> str:
    """The verdict, or ``asked`` where the answer is asked back."""
    verdict = grade_answer(spec, typed, decimal=decimal)
    return verdict.verdict if verdict.is_graded else "asked"


def differing(peer: str) -> Iterator[str]:
    """The rows that get another verdict than they say."""
    for decimal, spec, row in rows_of(peer):
        found = decide(decimal, spec, row["typed"])
        fits = found == row["ours"] if "ours" in row else (found == "correct") == row["theirs"]
        if not fits:
            yield f"{row['typed']!r} for {row['key']!r}: {found}"


@together("peer", PEERS)
def test_rows_are_decided_as_they_say(peer):
    assert list(differing(peer)) == []


@together("peer", PEERS)
def test_differences_are_counted_and_have_reasons(peer):
    rows = [row for _decimal, _spec, row in rows_of(peer)]
    other = [row for row in rows if "ours" in row]
    assert (len(rows) - len(other), len(rows)) == AGREED[peer]
    for row in other:
        assert (row["ours"] == "correct") != row["theirs"], row
        assert len(row["why"]) > 20, row
