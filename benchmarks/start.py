"""How long the first answer takes: ``uv run python benchmarks/start.py``.

CPU seconds of a fresh process, the best of five, beside what it may take; exit code 1 if one is
over. Twenty questions of five parts each are marked, all right, and all wrong with a diagnosis.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

SPECS = {
    "a": {"kind": "number", "value": "20/3", "decimals": 3},
    "b": {"kind": "quantity", "value": "50", "unit": "mm"},
    "c": {"kind": "expression", "value": "f*X/Z", "symbols": dict.fromkeys("fXZ", "positive")},
    "d": {"kind": "gap", "accept": [["demosaicing"]]},
    "e": {"kind": "witness", "predicate": "x^2 < x", "symbols": ["x"]},
}
RIGHT = {"a": "6,667", "b": "5 cm", "c": "fX/Z", "d": "demosaicng", "e": "0,5"}
WRONG = dict.fromkeys(RIGHT, "9")
CHAIN = {
    "given": {
        "f": {"value": "1/20", "unit": "mm"},
        "X": {"value": "4", "unit": "m"},
        "Z": {"value": "30", "unit": "m"},
    },
    "steps": [["u", "f*X/Z", "mm"], ["n", "u/0.000005", "px"]],
}
QUESTIONS = 20
ROUNDS = 5


def key() -> dict[str, object]:
    """A paper's key."""
    questions = [
        {
            "number": str(number),
            "chain": CHAIN,
            "parts": [
                {"id": f"{number}{label}", "points": "1", "spec": spec}
                for label, spec in SPECS.items()
            ],
        }
        for number in range(1, QUESTIONS + 1)
    ]
    return {"format": "quizgen-key/2", "questions": questions}


def form(typed: Mapping[str, str]) -> dict[str, object]:
    """A filled-in form."""
    numbers = range(1, QUESTIONS + 1)
    return {"answers": {f"{n}{label}": text for n in numbers for label, text in typed.items()}}


def seconds(*arguments: str) -> float:
    """CPU seconds of a command in a fresh process."""
    best = float("inf")
    for _ in range(ROUNDS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [sys.executable, "-m", "quizgen", *arguments], check=True, stdout=subprocess.DEVNULL
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        best = min(best, used)
    return best


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as place:
        files = {"key": key(), "right": form(RIGHT), "wrong": form(WRONG)}
        paths = {name: str(Path(place) / f"{name}.json") for name in files}
        for name, table in files.items():
            Path(paths[name]).write_text(json.dumps(table), encoding="utf-8")
        budgets = {
            "quizgen --help": (0.15, ("--help",)),
            "check, 20 questions right": (0.4, ("check", paths["key"], paths["right"])),
            "check, 20 questions wrong": (0.4, ("check", paths["key"], paths["wrong"])),
        }
        over = False
        for name, (budget, arguments) in budgets.items():
            used = seconds(*arguments)
            over = over or used > budget
            print(f"{name:<28} {used:.3f} CPU s of {budget:.2f}{'  OVER' * (used > budget)}")
    sys.exit(over)


if __name__ == "__main__":
    main()
