"""What a bank costs: ``uv run python benchmarks/bank.py [--lint SEEDS]``.

Draws per CPU second over all templates, every check of the known mistakes included, and the
dearest templates; the best of five rounds over the same seeds each, so that a busy machine tells
less. With ``--lint`` the CPU seconds of ``quizgen lint --seeds SEEDS`` in a fresh process.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time

from quizgen.bank.bank import builtin_bank
from quizgen.bank.template import Template
from quizgen.bank.variant import draw_variant

ROUNDS, SEEDS, DEAREST = 5, 40, 8
TARGET, LINT_TARGET = 5000, 60


def seconds_per_draw(template: Template) -> float:
    """CPU seconds of one draw, best of some rounds."""
    draw_variant(template, "warm")
    best = float("inf")
    for _ in range(ROUNDS):
        started = time.process_time()
        for seed in range(SEEDS):
            draw_variant(template, seed)
        best = min(best, time.process_time() - started)
    return best / SEEDS


def draws() -> None:
    """Print draws per second and the dearest templates."""
    bank = builtin_bank()
    cost = {name: seconds_per_draw(bank.template(name)) for name in bank.template_paths}
    rate = len(cost) / sum(cost.values())
    print(f"draw + solve + trap checks: {rate:,.0f}/s over {len(cost)} templates ({TARGET:,})")
    for name in sorted(cost, key=cost.__getitem__, reverse=True)[:DEAREST]:
        tries = sum(draw_variant(bank.template(name), seed).tries for seed in range(SEEDS)) / SEEDS
        print(f"  {1e6 * cost[name]:6.0f} us  {tries:5.1f} tries  {name}")


def lint(seeds: int) -> None:
    """Print CPU seconds of linting the whole bank."""
    command = [sys.executable, "-m", "quizgen", "lint", "--seeds", str(seeds)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"lint, {seeds} seeds: {used.ru_utime + used.ru_stime:.1f} CPU s ({LINT_TARGET})")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lint", type=int, metavar="SEEDS")
    seeds = parser.parse_args().lint
    draws()
    if seeds:
        lint(seeds)


if __name__ == "__main__":
    main()
