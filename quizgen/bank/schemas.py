"""JSON Schema of what authors write, so that editors complete and check it."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any

import msgspec

from quizgen.bank.about import About
from quizgen.bank.limits import Answer
from quizgen.bank.rules import Rules

SCHEMAS: dict[str, type[msgspec.Struct]] = {"template": Rules, "bank": About}
"""File without its suffix to what stands in it."""
_TOLD = "told.toml"
"""What is said of each key, beside this module."""


def schema(name: str) -> bytes:
    """The schema of ``template.toml`` or ``bank.toml``, as JSON."""
    shapes = [SCHEMAS[name], Answer] if name == "template" else [SCHEMAS[name]]
    (whole, *_), parts = msgspec.json.schema_components(shapes, ref_template="#/$defs/{name}")
    if name == "template":  # a part holds a table of any keys, of which these are looked at
        parts["PartRule"]["properties"]["answer"] = {"$ref": "#/$defs/Answer"}
    _describe(parts)
    table = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"{name}.toml",
        **whole,
        "$defs": parts,
    }
    return msgspec.json.format(msgspec.json.encode(table), indent=1) + b"\n"


def _describe(parts: dict[str, dict[str, Any]]) -> None:
    """Say of each key what it means."""
    told = tomllib.loads((files(__package__) / _TOLD).read_text("utf-8"))
    for name, part in parts.items():
        for key, value in part["properties"].items():
            value["description"] = told[name][key]
