"""Compare the minutes of the model with times that people took: their archives of the browser.

``uv run python tools/compare_minutes.py archive.json ...`` prints, for each template that was
answered, how many times it was, the median of the minutes for which it was on the screen and the
model's, and for all together by which factor the model is off.
"""

from __future__ import annotations

import statistics
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.core.errors import PaperCodeError, StoreError
from quizgen.paper.paper import rebuild_paper
from quizgen.store.archive import ArchivedExam, read_archive

LEAST = 10
"""Seconds below which nobody has read a question."""


class TakenTime(NamedTuple):
    """How long one person took for one question, in minutes, and what the model says."""

    template: str
    taken: float
    model: float


class Comparison(NamedTuple):
    """All times of one template: how many, their median and the model's minutes."""

    template: str
    count: int
    median: float
    model: float


def iter_times(exams: Iterable[ArchivedExam], bank: Bank) -> Iterator[TakenTime]:
    """Yield the times of questions that were answered; none of papers that cannot be made again."""
    for exam in exams:
        try:
            paper = rebuild_paper(bank, exam.code, figures=False)
        except PaperCodeError:
            continue
        answered = [one.part for one in exam.answers if any(one.fields)]
        for item in paper.items:
            seconds = exam.spent.get(item.number, 0.0)
            given = any(part.rstrip("abcdefghijklmnop") == item.number for part in answered)
            if given and seconds >= LEAST:
                minutes = float(item.questions[0].minutes)
                yield TakenTime(item.keys[0].template, seconds / 60, minutes)


def compare_times(times: Iterable[TakenTime]) -> list[Comparison]:
    """Return the comparison of each template, those that are off most first."""
    found: defaultdict[str, list[TakenTime]] = defaultdict(list)
    for one in times:
        found[one.template].append(one)
    compared = [
        Comparison(
            name,
            len(of),
            statistics.median(one.taken for one in of),
            statistics.median(one.model for one in of),
        )
        for name, of in found.items()
    ]
    return sorted(compared, key=lambda one: -abs(one.median / one.model - 1))


def main(paths: list[str]) -> int:
    """Print the comparison; return 1 if a file is no archive, or no time can be compared."""
    exams: list[ArchivedExam] = []
    for path in paths:
        try:
            exams += read_archive(Path(path).read_bytes()).sittings
        except (OSError, StoreError) as error:
            print(f"{path}: {error}", file=sys.stderr)
            return 1
    times = [*iter_times(exams, builtin_bank())]
    if not times:
        print("no answered question with a time", file=sys.stderr)
        return 1
    for one in compare_times(times):
        ratio = one.median / one.model
        print(f"{one.template:40} {one.count:4} {one.median:6.1f} {one.model:6.1f} {ratio:5.2f}")
    factor = statistics.median(one.taken / one.model for one in times)
    print(f"{len(times)} times; half took more than {factor:.2f} of the model's minutes")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
