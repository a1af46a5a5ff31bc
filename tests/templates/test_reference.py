"""Reference instances give the results printed in the notes, or the corrected ones.

``reference/*.toml`` holds the expected numbers, typed from the notes and their errata.
"""

from __future__ import annotations

import tomllib
from fractions import Fraction
from pathlib import Path

from msgspec import to_builtins
from sweep import together

from quizgen.bank.variant import reference_variant
from quizgen.question.part_context import ask_part

ROWS = [
    {**row, "file": path.name}
    for path in sorted((Path(__file__).parent / "reference").glob("*.toml"))
    for row in tomllib.loads(path.read_text(encoding="utf-8"))["row"]
]


def flat(spec):
    values = spec.get("values", spec.get("value"))
    if isinstance(values, dict):
        return list(values.values())
    return values if isinstance(values, list) else [values]


@together("row", ROWS)
def test_the_notes_are_reproduced(bank, row):
    spec = to_builtins(
        ask_part(reference_variant(bank.template(row["template"])), row["part"] - 1).spec
    )
    if "spec" in row:
        for name, value in row["spec"].items():
            assert spec[name] == value, row["source"]
        return
    got = [Fraction(text) for text in flat(spec)]
    within = Fraction(row.get("within", "0"))
    expected = [Fraction(text) for text in row["values"]]
    assert len(got) == len(expected)
    for ours, theirs in zip(got, expected, strict=True):
        assert abs(ours - theirs) <= within, row["source"]


def test_every_template_with_numbers_of_the_notes_has_a_row(bank):
    named = {row["template"] for row in ROWS}
    lacking = [t.id for t in bank if t.rules.reference is not None and t.chain.steps]
    assert not [name for name in lacking if name not in named]
