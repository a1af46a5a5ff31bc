"""JSON Schema of what authors write, so that editors complete and check it."""

from __future__ import annotations

import re
import tomllib
from functools import reduce
from importlib.resources import files
from operator import or_
from typing import Any

import msgspec

from quizgen.bank.metadata import BankMetadata
from quizgen.bank.rules import Rules
from quizgen.kinds import KINDS

SCHEMAS: dict[str, type[msgspec.Struct]] = {"template": Rules, "bank": BankMetadata}
"""File without its suffix to what stands in it."""
REF = "#/$defs/{name}"
_TOLD = "told.toml"
"""What is said of each key whose field says nothing itself, beside this module."""
# Editors show these names: they are the schema's own, whatever the classes are called.
_NAMES = {"AuthoredTrueFalse": "Truth", "ParametricCurve": "Curve", "BankMetadata": "About"}
_CLASS = re.compile(r'(?<=["/])(?:Authored\w+|ParametricCurve|BankMetadata)(?=")')


def build_json_schema(name: str) -> bytes:
    """Return the schema of ``template.toml`` or ``bank.toml``, as JSON."""
    shapes: list[Any] = [SCHEMAS[name]]
    if name == "template":
        shapes.append(reduce(or_, (kind.authored for kind in KINDS.values())))
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
    text = _CLASS.sub(_to_schema_name, msgspec.json.encode(table).decode())
    return msgspec.json.format(text, indent=1).encode() + b"\n"


def _to_schema_name(found: re.Match[str]) -> str:
    """Return the name under which the schema shows a class, for ``re.sub``."""
    return _NAMES.get(found[0], found[0].removeprefix("Authored"))


def _add_key_descriptions(parts: dict[str, dict[str, Any]]) -> None:
    """Add to each key of a schema what it means."""
    told = tomllib.loads((files(__package__) / _TOLD).read_text("utf-8"))
    answers = {kind.authored.__name__ for kind in KINDS.values()}
    for name, part in parts.items():
        table = told["Answer" if name in answers else _NAMES.get(name, name)]
        for key, value in part["properties"].items():
            value.setdefault("description", table.get(key))
