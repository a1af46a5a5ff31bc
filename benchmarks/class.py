"""What a class costs: ``uv run python benchmarks/class.py [STUDENTS]`` (300 if left out).

Papers and solutions of twenty questions for each student, as ``quizgen class make`` writes them: in
this process, in four processes, and on a Dask cluster of two workers on this machine of which one
is killed half way. Prints CPU seconds and megabytes, and whether all wrote the same bytes.
CPU seconds grow when others use the machine: the line ``loop`` says how fast it is now.
"""

from __future__ import annotations

import hashlib
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path

from quizgen.bank.folder import builtin
from quizgen.classes.executors import Here, workers
from quizgen.classes.folder import ClassFolder, Settings
from quizgen.classes.make import CHUNK, make, new_settings
from quizgen.classes.roster import Student
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import Progress, silent

PROCESSES = 4
MOST_CPU, MOST_MEMORY = 0.3, 400
FIRST = CHUNK
"""Papers that warm a process."""


def loop() -> float:
    """CPU milliseconds of half a million additions, the best of nine."""
    best = 1e9
    for _ in range(9):
        started, total = time.process_time(), 0
        for number in range(500_000):
            total += number
        best = min(best, time.process_time() - started)
    return best * 1e3


def cpu() -> float:
    """CPU seconds of this process and of its children that have ended."""
    both = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in both)


def memory(who: int = resource.RUSAGE_SELF) -> float:
    """Largest resident size so far in megabytes: of this process, or of the largest child."""
    return resource.getrusage(who).ru_maxrss / 1024


def digest(folder: Path) -> str:
    """Digest of every file of a folder."""
    total = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        total.update(f"{path.relative_to(folder)}\n".encode() + path.read_bytes())
    return total.hexdigest()[:16]


def made(
    home: Path,
    settings: Settings,
    students: list[Student],
    executor: Executor,
    ahead: int,
    told: Progress = silent,
) -> str:
    """Make a class anew; digest of its folder."""
    folder = ClassFolder(home / "class")
    shutil.rmtree(folder.path, ignore_errors=True)
    folder.create(settings, students)
    plan = load_blueprint(settings.blueprint, builtin())
    make(folder, students, plan, executor, ahead, told)
    return digest(folder.path)


def here(home: Path, settings: Settings, students: list[Student]) -> str:
    """In this process: the digest."""
    marks: list[tuple[float, float]] = []
    name = made(home, settings, students, Here(), 1, lambda _: marks.append((cpu(), memory())))
    spent = (marks[-1][0] - marks[FIRST - 1][0]) / (len(marks) - FIRST)
    middle = marks[len(marks) // 2][1]
    print(f"1 process: {spent:.3f} CPU s a student after the first {FIRST} (<= {MOST_CPU}), "
          f"{middle:.0f} MB half way, {marks[-1][1]:.0f} at last (<= {MOST_MEMORY})")  # fmt: skip
    return name


def processes(home: Path, settings: Settings, students: list[Student], count: int) -> str:
    """In processes: the digest."""
    started, before = time.monotonic(), cpu()
    with workers(count) as (executor, ahead):
        name = made(home, settings, students, executor, ahead)
    clock = time.monotonic() - started
    print(f"{count} processes: {clock:.1f} s by the clock, {cpu() - before:.1f} CPU s, "
          f"{memory(resource.RUSAGE_CHILDREN):.0f} MB the largest (<= {MOST_MEMORY})")  # fmt: skip
    return name


@contextmanager
def cluster() -> Iterator[tuple[str, list[int]]]:
    """A Dask cluster of two workers: its address, and their process numbers."""
    from distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as local,
        Client(local) as client,
    ):
        yield local.scheduler_address, list(client.run(os.getpid).values())


def on_a_cluster(home: Path, settings: Settings, students: list[Student]) -> str:
    """On a cluster, one of whose workers is killed half way."""
    done: list[str] = []

    def tell(student: str) -> None:
        done.append(student)
        if len(done) == len(students) // 2:
            os.kill(numbers[0], signal.SIGKILL)

    started = time.monotonic()
    with cluster() as (address, numbers), workers(1, address) as (executor, ahead):
        name = made(home, settings, students, executor, ahead, tell)
    print(f"Dask, 2 workers, one killed half way: {time.monotonic() - started:.1f} s by the clock")
    return name


def main(count: int) -> None:
    """Print the table."""
    students = [Student(str(10_000 + number), f"Student {number}") for number in range(count)]
    settings = new_settings("class", builtin(), load_blueprint("mock", builtin()), "en")
    print(f"{count} students, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as temporary:
        home = Path(temporary)
        print(f"loop: {loop():.1f} ms")
        names = [here(home, settings, students)]
        print(f"loop: {loop():.1f} ms")
        names.append(processes(home, settings, students, PROCESSES))
        names.append(on_a_cluster(home, settings, students))
    print("same bytes" if len(set(names)) == 1 else f"OTHER BYTES: {names}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 300)
