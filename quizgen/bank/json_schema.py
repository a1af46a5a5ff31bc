"""JSON Schema of what authors write, so that editors complete and check it."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any

import msgspec

from quizgen.bank.answers import ANSWERS, AnyAnswer
from quizgen.bank.metadata import BankMetadata
from quizgen.bank.rules import Rules

SCHEMAS: dict[str, type[msgspec.Struct]] = {"template": Rules, "bank": BankMetadata}
"""File without its suffix to what stands in it."""
REF = "#/$defs/{name}"
_TOLD = "told.toml"
"""What is said of each key, beside this module."""


def build_json_schema(name: str) -> bytes:
    """The schema of ``template.toml`` or ``bank.toml``, as JSON."""
    shapes = [SCHEMAS[name], AnyAnswer] if name == "template" else [SCHEMAS[name]]
    (whole, *others), parts = msgspec.json.schema_components(shapes, ref_template=REF)
    for answers in others:  # a part holds a table of any keys, which its kind knows
        parts["PartRule"]["properties"]["answer"] = answers
    _add_key_descriptions(parts)
    table = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"{name}.toml",
        **whole,
        "$defs": parts,
    }
    return msgspec.json.format(msgspec.json.encode(table), indent=1) + b"\n"


def _add_key_descriptions(parts: dict[str, dict[str, Any]]) -> None:
    """Say of each key what it means."""
    told = tomllib.loads((files(__package__) / _TOLD).read_text("utf-8"))
    answers = {shape.__name__ for shape in ANSWERS.values()}
    for name, part in parts.items():
        for key, value in part["properties"].items():
            value["description"] = told["Answer" if name in answers else name][key]
