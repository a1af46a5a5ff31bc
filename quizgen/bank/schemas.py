"""JSON Schema of what authors write, so that editors complete and check it."""

from __future__ import annotations

import msgspec

from quizgen.bank.about import About
from quizgen.bank.rules import Rules

SCHEMAS: dict[str, type[msgspec.Struct]] = {"template": Rules, "bank": About}
"""File without its suffix to what stands in it."""


def schema(name: str) -> bytes:
    """The schema of ``template.toml`` or ``bank.toml``, as JSON."""
    table = msgspec.json.schema(SCHEMAS[name])
    table = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"{name}.toml",
    } | table
    return msgspec.json.format(msgspec.json.encode(table), indent=1) + b"\n"
