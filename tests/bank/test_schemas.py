"""The schemas that editors check by, against what is read: seeded changes of real files."""

from __future__ import annotations

import copy
import json
import re
import tomllib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from random import Random

import msgspec
import pytest
from jsonschema import Draft202012Validator
from sweep import draws, together

from quizgen.bank.json_schema import build_json_schema
from quizgen.bank.metadata import read_metadata
from quizgen.bank.template import read_rules
from quizgen.core.errors import BankError
from quizgen.kinds import KINDS

ROOT = Path(__file__).parents[2]
READ: dict[str, Callable[[Path], object]] = {"template": read_rules, "bank": read_metadata}
SHAPE = re.compile(r"stands there|unknown key|is missing|is not allowed")
"""What is said of a value of another type, of a key that there is not, and of one that lacks."""
OTHERS = ("text", 7, 2.5, 3.0, True, [], ["one"], [1, 2], {}, {"some": "table"}, [[]], [{}])
"""What is put in the place of something else; 3.0 is a whole number to schemas."""
CHANGES = [50, pytest.param(draws(200, full=5000), marks=pytest.mark.slow)]


@cache
def validator(kind: str) -> Draft202012Validator:
    return Draft202012Validator(json.loads(build_json_schema(kind)))


def files(kind: str) -> list[Path]:
    banks = (ROOT / "templates", ROOT / "examples/filtering/templates")
    return sorted(path for bank in banks for path in bank.rglob(f"{kind}.toml"))


def places(value: object, before: tuple[object, ...] = ()) -> Iterator[tuple[object, ...]]:
    """Every place in a table, the whole aside."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for key, inside in items:
            yield (*before, key)
            yield from places(inside, (*before, key))


def changed(table: dict[str, object], by: Random) -> dict[str, object]:
    """A table with one to three changes: a key dropped, renamed or added, a value of another type."""
    new = copy.deepcopy(table)
    for _ in range(by.randint(1, 3)):
        every = list(places(new))
        if not every:
            return new
        *way, last = by.choice(every)
        inner: object = new
        for key in way:
            inner = inner[key]  # type: ignore[index]
        how = by.choice(("drop", "rename", "retype", "add"))
        if how == "drop":
            del inner[last]  # type: ignore[attr-defined]
        elif how == "retype" or isinstance(inner, list):
            inner[last] = copy.deepcopy(by.choice(OTHERS))  # type: ignore[index]
        elif how == "rename":
            inner[f"{last}x"] = inner.pop(last)
        else:
            inner[by.choice(("extra", "points", "unit", "min", "tier"))] = copy.deepcopy(
                by.choice(OTHERS)
            )
    return new


def written(value: object) -> str:
    """A value as TOML, tables in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {written(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def verdicts(folder: Path, kind: str, table: dict[str, object]) -> tuple[str, str]:
    """What the loader says of a table, and what the schema says; nothing where it is right."""
    path = folder / f"{kind}.toml"
    path.write_text("\n".join(f"{json.dumps(k)} = {written(v)}" for k, v in table.items()), "utf-8")
    assert tomllib.loads(path.read_text("utf-8")) == table
    wrong = "; ".join(error.message for error in validator(kind).iter_errors(table))
    try:
        READ[kind](path)
    except BankError as error:
        return str(error), wrong
    return "", wrong


@pytest.mark.parametrize("kind", READ)
def test_real_files_fit_their_schema(kind):
    Draft202012Validator.check_schema(json.loads(build_json_schema(kind)))
    for path in files(kind):
        found = validator(kind).iter_errors(tomllib.loads(path.read_text("utf-8")))
        assert [f"{path}: {error.message}" for error in found] == []


@pytest.mark.parametrize("changes", CHANGES)
@pytest.mark.parametrize("kind", READ)
def test_schema_and_loader_refuse_the_same(tmp_path, kind, changes):
    by, sources = Random(16), [tomllib.loads(path.read_text("utf-8")) for path in files(kind)]
    refused = 0
    for number in range(changes):
        table = changed(by.choice(sources), by)
        said, wrong = verdicts(tmp_path, kind, table)
        assert bool(said) >= bool(wrong), (number, "only the schema refuses", wrong, table)
        assert wrong or not SHAPE.search(said), (number, "only the loader refuses", said, table)
        assert not said or re.match(rf"{tmp_path}/{kind}\.toml(:\d+)?: ", said), said
        refused += bool(wrong)
    assert changes / 4 < refused < changes


@pytest.mark.parametrize("kind", READ)
def test_editors_are_told_what_each_key_means(kind):
    for part in json.loads(build_json_schema(kind))["$defs"].values():
        for key, value in part["properties"].items():
            assert value["description"].endswith("."), key


ANSWERS = {
    "Number", "Quantity", "Angle", "Point", "Set", "Table", "Interval", "Expression", "Choice",
    "Multi", "Truth", "Match", "Order", "Gap", "Witness", "Code", "Program", "Rubric", "Sketch",
    "Complex", "Equation", "Matrix", "Vector", "Checked", "Derivation",
}  # fmt: skip
"""Names that editors know the answers of each kind by."""


def test_nothing_is_told_of_a_key_that_there_is_not():
    parts = {
        name: part
        for kind in READ
        for name, part in json.loads(build_json_schema(kind))["$defs"].items()
    }
    known = {name: set(part["properties"]) for name, part in parts.items()}
    answers = {key for name in ANSWERS for key in known.pop(name)}
    told = tomllib.loads((ROOT / "quizgen/bank/told.toml").read_text("utf-8"))
    assert {*told.pop("Answer")} <= answers
    assert {name: set(keys) for name, keys in told.items()} == known


UNUSED = {
    "checked": {"kind": "checked", "function": "judge", "traps": ["near"]},
    "set": {"kind": "set", "of": ["x"]},
    "derivation": {
        "kind": "derivation",
        "symbols": {"x": "real"},
        "let": {"x": "2"},
        "lines": {"goal": {"is": "x = 2"}},
    },
    "interval": {"kind": "interval", "value": "[0, 1]"},
    "equation": {"kind": "equation", "of": "c", "symbols": ["x", "y"]},
    "complex": {"kind": "complex", "of": "z", "form": "polar"},
    "matrix": {"kind": "matrix", "of": "A"},
    "vector": {"kind": "vector", "of": "v", "up_to": "scale"},
}
"""Answers of the kinds that no bank here asks."""
OF_MULTI = {"choice": {"negative"}, "tf": {"negative", "options"}}
"""What these kinds share with ``multi`` in marking, and do not have."""
MADE = {
    "calls",
    "accept",
    "said",
    "kind",
    "notes",
    "why",
    "define",
    "correct",
    "value",
    "values",
    "units",
    "traps",
    "terms",
    "letters",
    "names",
    "parts",
    "entries",
    "components",
    "check",
    "example",
    "full",
    "called",
    "words",
    "bound",
    "ideas",
    "model",
    "synonyms",
}
"""What a draw, the bank or the words give to the key of a part, and nobody writes in an answer."""


@together("kind", KINDS)
def test_editors_know_what_a_key_of_the_kind_may_hold(kind):
    """All that marking goes by is authored, or made."""
    authored = {field.encode_name for field in msgspec.structs.fields(KINDS[kind].authored)}
    keys = {field.encode_name for field in msgspec.structs.fields(KINDS[kind].spec)}
    assert keys - authored - OF_MULTI.get(kind, set()) <= MADE


@pytest.mark.parametrize("kind", KINDS)
def test_the_keys_of_other_kinds_are_refused(tmp_path, kind):
    """Of each kind one real answer, with a key that only others have."""
    parts = [
        part
        for file in files("template")
        for part in tomllib.loads(file.read_text("utf-8"))["part"]
    ]
    found = {part["answer"]["kind"]: part["answer"] for part in parts}
    real = {**found, **UNUSED}[kind]
    table = {"topic": "noise", "tier": "A"}
    assert verdicts(tmp_path, "template", {**table, "part": [{"answer": real}]})[1] == ""
    own = {field.encode_name for field in msgspec.structs.fields(KINDS[kind].authored)}
    other = {"options", "percent", "gaps", "output", "correct", "notes"} - own
    for name in sorted(other):
        answer = {**real, name: {"a": True}}
        said, wrong = verdicts(tmp_path, "template", {**table, "part": [{"answer": answer}]})
        assert f"part 1: answer: unknown key {name!r}" in said
        assert wrong
