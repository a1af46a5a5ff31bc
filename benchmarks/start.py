"""How long the first answer takes: ``uv run python benchmarks/start.py``.

CPU seconds of a fresh process, the best of five, beside what it may take; exit code 1 if one is
over. Twenty questions of five parts each are marked, all right, and all wrong with a diagnosis. A
paper may take a share of what importing SymPy and matplotlib takes, measured in turn with it, on a
machine that is as slow then.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
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


def once(*words: str) -> float:
    """CPU seconds of Python in a fresh process, and of all that it begins."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, *words], check=True, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def seconds(*arguments: str) -> float:
    """CPU seconds of a command."""
    return min(once("-m", "quizgen", *arguments) for _ in range(ROUNDS))


def shares(place: str) -> Iterator[tuple[str, float, float]]:
    """What a paper takes of importing SymPy and matplotlib, and what it may take."""
    page = ("-m", "quizgen", "exam", "--seed", "5", "--format", "html", "--out", f"{place}/page")
    whole = ("-m", "quizgen", "exam", "--seed", "5", "--out", f"{place}/whole")
    rounds = [
        (once("-c", "import sympy, matplotlib"), once(*page), once(*whole)) for _ in range(ROUNDS)
    ]
    imports, html, both = map(min, zip(*rounds, strict=True))
    yield "exam, HTML", html / imports, 0.8
    yield "exam, all six files", both / imports, 1.15


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as place:
        files = {"key": key(), "right": form(RIGHT), "wrong": form(WRONG)}
        paths = {name: str(Path(place) / f"{name}.json") for name in files}
        for name, table in files.items():
            Path(paths[name]).write_text(json.dumps(table), encoding="utf-8")
        budgets = {
            "quizgen --help": (0.15, ("--help",)),
            "check, 20 questions right": (0.2, ("check", paths["key"], paths["right"])),
            "check, 20 questions wrong": (0.4, ("check", paths["key"], paths["wrong"])),
            "practice, first question": (
                0.6,
                ("practice", "--topic", "noise", "--database", f"sqlite:///{place}/learnt.sqlite3"),
            ),
        }
        over = False
        for name, (budget, arguments) in budgets.items():
            used = seconds(*arguments)
            over = over or used > budget
            print(f"{name:<28} {used:.3f} CPU s of {budget:.2f}{'  OVER' * (used > budget)}")
        for name, share, most in shares(place):
            over = over or share > most
            print(f"{name:<28} {share:.2f} x imports of {most:.2f}{'  OVER' * (share > most)}")
    sys.exit(over)


if __name__ == "__main__":
    main()
