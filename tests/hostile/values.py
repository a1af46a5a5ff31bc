"""What a broken or a malicious file may hold, and files made of it."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Iterator

Plain = dict | list | str | int | float | bool | None

NAUGHTY: list[Plain] = [
    -1, 0, 1, 3, -3, 10**9, 10**30, 10**5000, 1.5, -2.5, float("inf"), float("nan"), True, False,
    "", " ", "0", "-1", "1/0", "1/3", "7", "x", "1e300000000", "1e-300000000", "1e400", "9" * 5000,
    "nan", "inf", "0x" + "f" * 50, "x + y", "1 +", "(((((1", "(" * 300 + "1" + ")" * 300, "2^2^2^2^99",
    "10^10^10", "x/0", "f(x)", "sqrt(-1)", "__import__('os')", "{{ x }}", "{{", "$x$", "$1/$",
    "\x00", "\x1b]0;owned\x07", "\u202etxt", "\u2028", "a\nb", "a\tb", "=1+1", " =1+1", "\uff1d1", "@x",
    "[/]", "[bold]x", "<script>alert(1)</script>", 'x" onerror="alert(1)', "\\(x\\)", "#import", "../../x",
    "/dev/zero", "/dev/zero-1-en-000000", "mock-1-en-000000", "\ud800", "é" * 300, "a" * 100_000,
    [], {}, [[]], [None], ["a", "a"], [1, 2], ["x", "y", "z"], ["1", "5", "0"], ["5", "1", "1"],
    ["1", "1e9", "1"], {"x": "y"}, {"x": {"y": "z"}}, {"": ""}, {"kind": "number"}, None,
    "number", "choice", "table", "match", "order", "en", "bn", "xx", "1 m", "1e400 mm", "1e12 px",
    "-1 px", "mm", "m/s/s/s", "optics", "all", "A", "E",
]  # fmt: skip
"""Values that no author means."""

DEEP = 3000


def places(table: Plain) -> list[tuple[Plain, object]]:
    """Every container with each key or index in it."""
    found: list[tuple[Plain, object]] = []
    todo = [table]
    while todo:
        inside = todo.pop()
        keys = list(inside) if isinstance(inside, dict) else range(len(inside))
        for key in keys:
            found.append((inside, key))
            if isinstance(inside[key], (dict, list)) and inside[key]:
                todo.append(inside[key])
    return found


def mutated(table: Plain, chance: random.Random) -> Plain:
    """The table with one to three things wrong."""
    table = copy.deepcopy(table)
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        spots = places(table)
        if not spots:
            break
        inside, key = chance.choice(spots)
        match chance.choice((0, 1, 2, 3, 4, 5, 5, 6, 6, 6, 7)):
            case 0:
                del inside[key]
            case 1 if isinstance(inside, dict):
                inside[_word(chance)] = inside.pop(key)
            case 2 if isinstance(inside, dict):
                inside[_word(chance)] = copy.deepcopy(chance.choice(NAUGHTY))
            case 3 if isinstance(inside, list):
                inside.insert(chance.randrange(len(inside) + 1), copy.deepcopy(inside[key]))
            case 4:
                other, name = chance.choice(spots)
                inside[key] = copy.deepcopy(other[name])
            case 5 if isinstance(inside[key], str) and inside[key]:
                inside[key] = bent(inside[key], chance)
            case 6:
                same = [v for v in NAUGHTY if type(v) is type(inside[key])]
                inside[key] = copy.deepcopy(chance.choice(same or NAUGHTY))
            case _:
                inside[key] = copy.deepcopy(chance.choice(NAUGHTY))
    return table


def _word(chance: random.Random) -> str:
    return str(chance.choice([v for v in NAUGHTY if isinstance(v, str)]))[:200]


def bent(text: str, chance: random.Random) -> str:
    """A text with something cut out, doubled or put in."""
    at, to = sorted((chance.randrange(len(text) + 1), chance.randrange(len(text) + 1)))
    match chance.randrange(5):
        case 0:
            return text[:at] + text[to:]
        case 1:
            return text[:to] + text[at:]
        case 2:
            return text[:at]
        case 3:
            return text[:at] + _word(chance) + text[at:]
        case _:
            return text[:at] + chr(chance.randrange(1, 0x3000)) + text[at + 1 :]


def toml(table: dict) -> str:
    """Write TOML, tables inline; what TOML cannot say is left out."""
    return "".join(f"{_key(k)} = {_value(v)}\n" for k, v in table.items() if v is not None)


def _key(key: str) -> str:
    return _text(str(key))


def _text(text: str) -> str:
    safe = text.encode("utf-8", "replace").decode()
    return json.dumps(safe, ensure_ascii=False).replace("\x7f", "\\u007F")


def _value(value: Plain) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return (
            "{"
            + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items() if v is not None)
            + "}"
        )
    if isinstance(value, list):
        return "[" + ", ".join(_value(v) for v in value if v is not None) + "]"
    if isinstance(value, int):
        return hex(value) if value > 10**400 else str(value)
    return _text(value) if isinstance(value, str) else repr(value)


def as_json(table: Plain) -> str:
    """Write JSON, half characters and all."""
    return json.dumps(table, default=str) if not huge(table) else "1" * 6000


def huge(table: Plain) -> bool:
    """Whether a number in it is longer than Python writes."""
    return any(isinstance(v, int) and abs(v) > 10**4000 for v in _leaves(table))


def _leaves(table: Plain) -> Iterator[Plain]:
    if isinstance(table, (dict, list)):
        for inside, key in places(table):
            yield inside[key]


def damaged(data: bytes, chance: random.Random) -> bytes:
    """Bytes with something flipped, cut, doubled or replaced."""
    at, to = sorted((chance.randrange(len(data) + 1), chance.randrange(len(data) + 1)))
    match chance.randrange(6):
        case 0:
            return data[:at]
        case 1:
            return data[:at] + data[to:]
        case 2:
            return data[:to] + data[at:]
        case 3:
            return data[:at] + chance.randbytes(chance.randrange(1, 9)) + data[at:]
        case 4:
            return data[:at] + b"[" * DEEP + data[at:]
        case _:
            return data[:at] + bytes([chance.randrange(256)]) + data[at + 1 :]
