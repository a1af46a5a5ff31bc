"""Damage to a file as disks, editors, spreadsheets and people who mean harm do it."""

from __future__ import annotations

import csv
import io
import json
import random
import re
import tomllib
from collections.abc import Callable
from pathlib import Path

from values import DEEP, NAUGHTY, as_json, bent, damaged, mutated, toml

Damage = Callable[[bytes, random.Random], bytes]

BINARY = {".png", ".pdf", ".zip", ".sqlite3"}
NUMBERS = ("0", "-1", "1.5", "9" * 5000, "1" + "0" * 30, "1e400", "-1e-400", "nan", "inf", "1/0", "৩", "১e৯")  # fmt: skip
TEXTS = [str(one) for one in NAUGHTY if isinstance(one, str)]
ENCODINGS = (
    "utf-16",
    "utf-16-le",
    "utf-16-be",
    "utf-32",
    "latin-1",
    "cp1252",
    "cp500",
    "utf-8-sig",
)
PUT_IN = ("\0", "\ufeff", "\r", "\x1b[2J", "\u202e", "\u2028", "[" * DEEP, "{" * DEEP, '"', "'''")  # fmt: skip


def damage_file(file: Path, chance: random.Random) -> None:
    """Write one damage into a file, of a kind that its ending suggests."""
    data = file.read_bytes()
    if file.suffix in BINARY:
        ways: list[Damage] = [damage_binary]
    else:
        own = STRUCTURED.get(file.suffix)
        ways = [damaged, damage_lines, change_encoding, change_number, put_in, bend]
        ways += [own] * 5 if own else []
    file.write_bytes(chance.choice(ways)(data, chance))


def damage_binary(data: bytes, chance: random.Random) -> bytes:
    """Some bytes flipped, or what ``damaged`` does."""
    if chance.random() < 0.5 or not data:
        return damaged(data, chance)
    flipped = bytearray(data)
    for _ in range(chance.choice((1, 1, 4, 100))):
        flipped[chance.randrange(len(flipped))] ^= 1 << chance.randrange(8)
    return bytes(flipped)


def damage_lines(data: bytes, chance: random.Random) -> bytes:
    """Lines taken out, doubled, moved or cut."""
    lines = data.splitlines(keepends=True)
    if not lines:
        return b"\n"
    at, to = chance.randrange(len(lines)), chance.randrange(len(lines))
    match chance.randrange(6):
        case 0:
            del lines[at]
        case 1:
            lines.insert(to, lines[at])
        case 2:
            lines[at], lines[to] = lines[to], lines[at]
        case 3:
            lines = lines[at:]
        case 4:
            lines[at] = lines[at][: chance.randrange(len(lines[at]))]
        case _:
            lines += lines
    return b"".join(lines)


def change_encoding(data: bytes, chance: random.Random) -> bytes:
    """The same text as another program would save it."""
    text = data.decode("utf-8", "replace")
    return text.encode(chance.choice(ENCODINGS), "replace")


def change_number(data: bytes, chance: random.Random) -> bytes:
    """One number replaced by one that nobody means."""
    text = data.decode("utf-8", "replace")
    places = [found.span() for found in re.finditer(r"\d+(\.\d+)?", text)]
    if not places:
        return bend(data, chance)
    first, last = chance.choice(places)
    return (text[:first] + chance.choice(NUMBERS) + text[last:]).encode("utf-8", "replace")


def put_in(data: bytes, chance: random.Random) -> bytes:
    """A sign or a text where it is not expected."""
    text = data.decode("utf-8", "replace")
    at = chance.randrange(len(text) + 1)
    what = chance.choice((*PUT_IN, chance.choice(TEXTS)))
    return (text[:at] + what + text[at:]).encode("utf-8", "replace")


def bend(data: bytes, chance: random.Random) -> bytes:
    """A piece of the text cut out, doubled or moved."""
    return bent(data.decode("utf-8", "replace"), chance).encode("utf-8", "replace")


def damage_toml(data: bytes, chance: random.Random) -> bytes:
    """Another table, which is TOML still."""
    return toml(mutated(tomllib.loads(data.decode("utf-8-sig")), chance)).encode("utf-8", "replace")


def damage_json(data: bytes, chance: random.Random) -> bytes:
    """Another table, which is JSON still."""
    return as_json(mutated(json.loads(data), chance)).encode("utf-8", "replace")


def damage_json_line(data: bytes, chance: random.Random) -> bytes:
    """Another table in one of the lines."""
    lines = data.splitlines()
    at = chance.randrange(len(lines))
    lines[at] = damage_json(lines[at], chance)
    return b"\n".join(lines) + b"\n"


def damage_cells(data: bytes, chance: random.Random) -> bytes:
    """A table with other columns, rows or cells."""
    text = data.decode("utf-8-sig", "replace")
    head = text.partition("\n")[0]
    separator = max(",;\t", key=head.count)
    rows = list(csv.reader(io.StringIO(text), delimiter=separator))
    row = chance.choice(rows)
    column, other = (chance.randrange(max(map(len, rows))) for _ in range(2))
    match chance.randrange(7):
        case 0:
            rows = [[*one[:column], *one[column + 1 :]] for one in rows]
        case 1:
            rows = [[*one[:column], *one[column : column + 1] * 2, *one[column + 1 :]] for one in rows]  # fmt: skip
        case 2:
            for one in rows:
                if max(column, other) < len(one):
                    one[column], one[other] = one[other], one[column]
        case 3:
            row.insert(min(column, len(row)), chance.choice(TEXTS))
        case 4:
            rows = [list(one) for one in zip(*rows, strict=False)]
        case _:
            row[column : column + 1] = [chance.choice((*TEXTS, *NUMBERS))]
    out = io.StringIO()
    csv.writer(out, delimiter=chance.choice((separator, separator, ";", "\t"))).writerows(rows)
    return out.getvalue().encode("utf-8", "replace")


STRUCTURED: dict[str, Damage] = {
    ".toml": damage_toml, ".json": damage_json, ".jsonl": damage_json_line, ".csv": damage_cells,
}  # fmt: skip
"""Ending to what leaves a file that can be read and says something else."""
