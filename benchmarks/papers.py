"""What a paper costs: ``uv run python benchmarks/papers.py``.

Fifteen questions with seven figures; HTML and PDF, questions and solutions, and the key.
Prints CPU seconds and megabytes per paper for n = 1, 10, 100 distinct papers (cold process and
warm), figures, typesetting and drawing apart, and draws per second with all trap checks. Timings
are CPU time of this process; compare ratios, the machine is shared.

``papers.py many`` makes 300 of these papers in four processes instead, beside what they may take,
and 300 of ``mock``, which are longer: on four idle cores the time on the clock is a quarter of the
CPU seconds.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

FIGURES = (
    "point-to-image-plane",
    "point-to-image-plane-fractions",
    "image-height-and-fill-distance",
    "gaussian-peak-and-tail-shares",
    "thin-lens-image-distance",
    "demosaic-blue-and-green-site",
    "blur-disc-diameter",
)
PLAIN = (
    "normalise-from-offset-range",
    "mixing-kind-and-resulting-colour",
    "floats-or-uint8",
    "rgb-to-hsv",
    "weak-perspective-scale-error",
    "photon-snr-and-decibels",
    "pixel-coordinates-in-python",
    "image-scaling-laws",
)
MANY, PROCESSES = 300, 4
MOST_SECONDS, MOST_MEGABYTES = 25, 350
COLD = "import sys; sys.path.insert(0, {path!r}); import papers; papers.paper_bytes(1)"


def cpu() -> float:
    """CPU seconds of this process."""
    return time.process_time()


def memory() -> float:
    """Largest resident size so far in megabytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def made(seed: int, *, figures: bool = True):  # noqa: ANN201
    from quizgen.bank.bank import builtin_bank
    from quizgen.paper.blueprint import Blueprint, SlotRule
    from quizgen.paper.paper import build_paper

    slots = tuple(SlotRule(templates=(name,)) for name in FIGURES + PLAIN)
    return build_paper(
        builtin_bank(),
        Blueprint({"en": "Benchmark"}, slots, name="bench"),
        seed,
        "en",
        figures=figures,
    )


def paper_bytes(seed: int) -> int:
    """Everything that ``quizgen exam`` writes, as a number of bytes."""
    from quizgen.paper.answer_form import write_blank_form
    from quizgen.paper.answer_key import write_answer_key
    from quizgen.render import KINDS, RENDERERS, render_paper

    paper = made(seed)
    assert sum(item.questions[0].figure is not None for item in paper.items) == len(FIGURES)
    rendered = [render_paper(paper, kind, output) for output in RENDERERS for kind in KINDS]
    return sum(map(len, rendered)) + len(write_answer_key(paper)) + len(write_blank_form(paper))


def timed(work: Callable[[int], object], seeds: range) -> float:
    """CPU seconds per call."""
    started = cpu()
    for seed in seeds:
        work(seed)
    return (cpu() - started) / len(seeds)


def cold() -> float:
    """CPU seconds of a fresh process that makes one paper."""
    best = 1e9
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.executable, "-c", COLD.format(path=sys.path[0])], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        best = min(best, used)
    return best


def stages(seeds: range) -> dict[str, float]:
    """CPU seconds per paper of each stage, warm."""
    from quizgen.render import KINDS, render_paper

    words = timed(lambda s: made(s, figures=False), seeds)
    full = timed(made, range(seeds.start + 1000, seeds.stop + 1000))
    papers = [made(s) for s in seeds]
    found = {"draw, solve, words": words, "14 figures": full - words}
    for output in ("html", "pdf"):
        for kind in KINDS:
            started = cpu()
            for paper in papers:
                render_paper(paper, kind, output)
            found[f"{output} {kind}"] = (cpu() - started) / len(papers)
    return found


def draws_per_second() -> float:
    """Questions drawn and solved per CPU second, all trap checks included."""
    from quizgen.bank.bank import builtin_bank
    from quizgen.bank.variant import draw_variant

    templates = [builtin_bank().template(name) for name in FIGURES + PLAIN]
    for template in templates:
        draw_variant(template, 0)
    count, started = 0, cpu()
    for seed in range(1, 121):
        for template in templates:
            draw_variant(template, seed)
            count += 1
    return count / (cpu() - started)


def many() -> bool:
    """Make two class sets by the command, and say whether the first took no more than it may."""
    with tempfile.TemporaryDirectory() as place:
        plan = Path(place) / "bench.toml"
        slots = "".join(f'[[slot]]\ntemplates = ["{name}"]\n' for name in FIGURES + PLAIN)
        plan.write_text(f'title = {{ en = "Benchmark" }}\n{slots}', encoding="utf-8")
        each, largest = _made_by_command(str(plan), f"{place}/bench")
        print(f"{MANY} papers in {PROCESSES} processes: {each:.0f} s of {MOST_SECONDS}, "
              f"{largest:.0f} MB of {MOST_MEGABYTES} in the largest")  # fmt: skip
        print("  the same of mock: {:.0f} s, {:.0f} MB".format(
            *_made_by_command("mock", f"{place}/mock")))  # fmt: skip
    return each <= MOST_SECONDS and largest <= MOST_MEGABYTES


def _made_by_command(blueprint: str, out: str) -> tuple[float, float]:
    """CPU seconds of each process, and megabytes of the largest one."""
    command = [sys.executable, "-m", "quizgen", "exam", "--blueprint", blueprint, "--seed", "1",
               "--count", str(MANY), "--jobs", str(PROCESSES), "--out", out]  # fmt: skip
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return used / PROCESSES, after.ru_maxrss / 1024


def main() -> None:
    """Print the tables."""
    if sys.argv[1:] == ["many"]:
        sys.exit(not many())
    print(f"cold process, one paper: {cold():.2f} CPU s")
    paper_bytes(0)
    print(f"{'n':>5} {'CPU s/paper':>12} {'peak MB':>8}")
    for n, first in ((1, 10), (10, 100), (100, 1000)):
        print(f"{n:>5} {timed(paper_bytes, range(first, first + n)):>12.3f} {memory():>8.0f}")
    print("warm, per paper, n = 20:")
    for name, seconds in stages(range(20)).items():
        print(f"  {name:<22} {1e3 * seconds:7.1f} ms")
    print(f"draw + solve + trap checks: {draws_per_second():,.0f} questions/s")


if __name__ == "__main__":
    main()
