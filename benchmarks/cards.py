"""What a deck costs: CPU seconds and memory, cold and warm, by kind and by output.

``python benchmarks/cards.py [--quick]``. Each cold row is a fresh process (best of three); warm
rows share one process, as a service would. Target: the full deck in under 5 s CPU, memory bounded.
"""

from __future__ import annotations

import resource
import subprocess
import sys
from collections.abc import Callable
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

COLD = """
import resource, sys
from time import process_time
from quizgen.cli.main import main
import click
click.echo = lambda *a, **k: None
main(sys.argv[1:])
usage = resource.getrusage(resource.RUSAGE_SELF)
print(process_time(), usage.ru_maxrss / 1024)
"""


def cold(arguments: list[str], repeats: int) -> tuple[float, float]:
    """Least CPU seconds of a command in a fresh process, and its peak memory in MB."""
    runs = []
    for _ in range(repeats):
        run = subprocess.run([sys.executable, "-c", COLD, *arguments], capture_output=True,
                             text=True, check=True)  # fmt: skip
        runs.append(tuple(map(float, run.stdout.split())))
    return min(seconds for seconds, _ in runs), max(memory for _, memory in runs)


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    started = process_time()
    result = work()
    return process_time() - started, result


def row(name: str, *cells: object) -> None:
    print(f"{name:<38}" + "".join(f"{cell:>12}" for cell in cells))


def commands(repeats: int) -> None:
    row("cold process", "CPU s", "peak MB")
    for name, arguments in {
        "full deck, both languages, apkg": ["--lang", "both"],
        "full deck, en, apkg": ["--lang", "en"],
        "full deck, both, apkg + tsv + csv": ["--lang", "both", "--format", "apkg,tsv,csv"],
        "vocabulary only": ["--kind", "vocab"],
    }.items():
        with TemporaryDirectory() as folder:
            seconds, peak = cold(["cards", "--out", folder, *arguments], repeats)
        row(name, f"{seconds:.2f}", f"{peak:.0f}")


def kinds() -> None:
    from quizgen.cards import build_deck
    from quizgen.cards.kinds import KINDS

    row("\nwarm, by kind (both languages)", "CPU ms", "cards", "ms/card")
    build_deck("both")
    for kind in KINDS:
        seconds, deck = timed(lambda kind=kind: build_deck("both", kinds=(kind,), seed=7))
        row(kind, f"{seconds * 1e3:.0f}", deck.card_count, f"{seconds * 1e3 / deck.card_count:.2f}")


def outputs() -> None:
    from quizgen.cards import build_deck
    from quizgen.cards.apkg import write_apkg
    from quizgen.cards.delimited import write_csv, write_tsv

    row("\nwarm, by output (full deck)", "CPU ms", "KB")
    deck = build_deck("both")
    for name, write in (("apkg", write_apkg), ("tsv", write_tsv), ("csv", write_csv)):
        seconds, data = timed(lambda write=write: write(deck))
        row(name, f"{seconds * 1e3:.0f}", f"{len(data) / 1024:.0f}")


def memory(count: int) -> None:
    from quizgen.cards import build_deck
    from quizgen.cards.apkg import write_apkg

    row(f"\n{count} decks in one process", "CPU s/deck", "peak MB")
    for done in range(1, count + 1):
        seconds, _ = timed(lambda done=done: write_apkg(build_deck("both", seed=done)))
        if done in {1, 2, 5, 10, 20, 50}:
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            row(f"deck {done}", f"{seconds:.2f}", f"{peak:.0f}")


if __name__ == "__main__":
    quick = "--quick" in sys.argv
    commands(1 if quick else 3)
    kinds()
    outputs()
    memory(2 if quick else 20)
