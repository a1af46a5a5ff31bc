"""Students who answer as the simulation tells them, so that it knows every mark beforehand.

What an answer is worth is known without the checker: a value of the key is right, what a trap of
the key's solver gives is wrong, and so is a value with the other sign.
"""

from __future__ import annotations

import json
import random
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

SENTENCES = {
    "The cone of rays gets narrower, so the circle of confusion is smaller.": 1.0,
    "the cone of rays gets narrower so the circle of confusion is smaller": 1.0,
    "The disc shrinks because the lens is better.": 0.5,
    "I do not know why": 0.0,
}
"""Sentences and the points that the examiner of the simulation gives them."""
UNREADABLE = "§§ ??"


@dataclass
class Truth:
    """What a student typed, part by part, and the marks that it deserves (None: to be decided)."""

    id: str
    code: str
    typed: dict[str, str] = field(default_factory=dict)
    marks: dict[str, float | None] = field(default_factory=dict)
    points: dict[str, float] = field(default_factory=dict)
    trapped: dict[str, str] = field(default_factory=dict)


def keys(folder: Path) -> list[dict]:
    return [json.loads(line) for line in (folder / "keys.jsonl").read_text("utf-8").splitlines()]


def truth(line: dict, chance: random.Random) -> Truth:
    """One student's answers: right, a trap, a slip, blank, unreadable, or a sentence."""
    made = Truth(line["id"], line["code"])
    for question in line["key"]["questions"]:
        wrong = False  # a second mistake in one question could be the first one carried forward
        for part in question["parts"]:
            label = part["id"].removeprefix(question["number"])
            item = f"{question['template']}/{label}" if label else question["template"]
            worth = float(Fraction(part["points"]))
            name, typed, share = _answer(part["spec"], chance, wrong=wrong)
            wrong = wrong or (share == 0.0 and bool(typed.strip()))
            made.typed[part["id"]] = typed
            made.points[item] = worth
            made.marks[item] = None if share is None else share * worth
            if name:
                made.trapped[item] = name
    return made


def _answer(spec: dict, chance: random.Random, *, wrong: bool) -> tuple[str, str, float | None]:
    """Name of the trap, what is typed, and the share of the points."""
    if spec["kind"] == "rubric":
        return "", chance.choice([*SENTENCES]), None
    way = chance.choices(["right", "trap", "slip", "blank", "unreadable"], [6, 3, 1, 1, 0.6])[0]
    if way == "blank":
        return "", chance.choice(["", "  "]), 0.0
    if way == "unreadable":
        return "", UNREADABLE, None
    way = "right" if wrong else way
    if spec["kind"] == "tf":
        right = spec["correct"] == [1]
        return "", str(right == (way == "right")).lower(), float(way == "right")
    if spec["kind"] == "match":
        return "", " ".join(a + b for a, b in spec["pairs"].items()), 1.0
    return _number(spec, way, chance)


def _number(spec: dict, way: str, chance: random.Random) -> tuple[str, str, float]:
    unit = f" {spec['unit']}" if spec.get("unit") else ""
    traps = {name: value for name, value in spec["traps"].items() if isinstance(value, str)}
    if way == "trap" and traps:
        name = chance.choice(sorted(traps))
        return name, traps[name] + unit, 0.0
    if way == "slip" and Fraction(spec["value"]):
        return "", str(-Fraction(spec["value"])) + unit, 0.0
    return "", spec["value"] + unit, 1.0
