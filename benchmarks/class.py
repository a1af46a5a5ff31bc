"""What a class costs: ``uv run python benchmarks/class.py [STUDENTS] [marks]`` (300 if left out).

Papers and solutions of twenty questions for each student, as ``quizgen class make`` writes them: in
this process, in four processes, and on a Dask cluster of two workers on this machine of which one
is killed half way. Prints CPU seconds and megabytes, and whether all wrote the same bytes.
With ``marks``, what marking and analysing costs instead: one table of answers, of which six of ten
are right, one is blank, two are wrong numbers and one cannot be read. Sentences are of each student
alone: ideas of the mark scheme in its words, and one more word. A hundred papers are drawn, and
every hundredth student has the same, under a code of the own; nothing is typeset.
CPU seconds grow when others use the machine: the line ``loop`` says how fast it is now.
"""

from __future__ import annotations

import csv
import hashlib
import os
import random
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
from unittest.mock import patch

import msgspec

from quizgen.bank.bank import builtin_bank
from quizgen.classes import generation as made_by
from quizgen.classes.analysis_page import write_analysis_page
from quizgen.classes.class_folder import ANSWERS, ClassFolder, ClassSettings, format_record
from quizgen.classes.generation import CHUNK, create_settings, generate_papers
from quizgen.classes.grading_run import grade_class
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.roster import RosterStudent
from quizgen.core.executor import InlineExecutor, open_executor
from quizgen.kinds.grade import show_key
from quizgen.kinds.rubric import RubricSpec
from quizgen.paper.answer_key import AnswerKey
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import ProgressCallback, silent

PROCESSES = 4
MOST_CPU, MOST_MEMORY = 0.3, 400
FIRST = CHUNK
"""Papers that warm a process."""
DRAWN = 100
"""Different papers where only marks are looked at."""
UNREAD = ("maybe 5", "12 mm", "x=3", "abc", "A")


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
    settings: ClassSettings,
    students: list[RosterStudent],
    executor: Executor,
    ahead: int,
    told: ProgressCallback = silent,
) -> str:
    """Make a class anew; digest of its folder."""
    folder = ClassFolder(home / "class")
    shutil.rmtree(folder.path, ignore_errors=True)
    folder.create(settings, students)
    plan = load_blueprint(settings.blueprint, builtin_bank())
    generate_papers(folder, students, plan, executor, ahead, told)
    return digest(folder.path)


def here(home: Path, settings: ClassSettings, students: list[RosterStudent]) -> str:
    """In this process: the digest."""
    marks: list[tuple[float, float]] = []
    name = made(
        home, settings, students, InlineExecutor(), 1, lambda _: marks.append((cpu(), memory()))
    )
    spent = (marks[-1][0] - marks[FIRST - 1][0]) / (len(marks) - FIRST)
    middle = marks[len(marks) // 2][1]
    print(f"1 process: {spent:.3f} CPU s a student after the first {FIRST} (<= {MOST_CPU}), "
          f"{middle:.0f} MB half way, {marks[-1][1]:.0f} at last (<= {MOST_MEMORY})")  # fmt: skip
    return name


def processes(
    home: Path, settings: ClassSettings, students: list[RosterStudent], count: int
) -> str:
    """In processes: the digest."""
    started, before = time.monotonic(), cpu()
    with open_executor(count) as (executor, ahead):
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


def on_a_cluster(home: Path, settings: ClassSettings, students: list[RosterStudent]) -> str:
    """On a cluster, one of whose workers is killed half way."""
    done: list[str] = []

    def tell(student: str) -> None:
        done.append(student)
        if len(done) == len(students) // 2:
            os.kill(numbers[0], signal.SIGKILL)

    started = time.monotonic()
    with cluster() as (address, numbers), open_executor(1, address) as (executor, ahead):
        name = made(home, settings, students, executor, ahead, tell)
    print(f"Dask, 2 workers, one killed half way: {time.monotonic() - started:.1f} s by the clock")
    return name


def answered(folder: ClassFolder, count: int) -> int:
    """Write a table of what students answered; how many answers are in it."""
    chance, number, keys = random.Random(1), 0, KeyIndex(folder)
    drawn = list(keys.places)
    first = keys.key(drawn[0])
    names = [part.id for question in first.questions for part in question.parts]
    typed = [_typed(keys.key(one)) for one in drawn]
    words = sorted({word for one in typed for text in one.values() if not isinstance(text, str)
                    for said in text for word in said.split()})  # fmt: skip
    (folder.path / ANSWERS).mkdir()
    with (folder.path / ANSWERS / "all.csv").open("w", encoding="utf-8", newline="") as stream:
        rows = csv.writer(stream)
        rows.writerow(["id", *names])
        for place in range(count):
            shown = typed[place % len(drawn)]
            row = [_answer(shown.get(name, ""), words, chance) for name in names]
            number += sum(map(bool, row))
            rows.writerow([10_000 + place, *row])
    return number


def _typed(key: AnswerKey) -> dict[str, str | list[str]]:
    """What is right in each part; of a sentence what may be said for each of its ideas."""
    parts = ((part.id, part.parse_spec()) for one in key.questions for part in one.parts)
    return {
        name: [text for one in spec.criteria.values() for text in one.accept]
        if isinstance(spec, RubricSpec)
        else show_key(spec)
        for name, spec in parts
    }


def _answer(right: str | list[str], words: list[str], chance: random.Random) -> str:
    way = chance.random()
    if isinstance(right, list):
        said = chance.sample(right, min(len(right), chance.randint(1, 3)))
        right = f"{', '.join(said)} {chance.choice(words)}."
    wrong = f"{chance.uniform(0, 50):.2f}" if way < 0.93 else chance.choice(UNREAD)
    return right if way < 0.6 else "" if way < 0.7 else wrong


def marks(home: Path, settings: ClassSettings, students: list[RosterStudent]) -> None:
    """Mark and analyse a class, in this process."""
    folder, plan = ClassFolder(home / "class"), load_blueprint(settings.blueprint, builtin_bank())
    folder.create(settings, students)
    with patch.object(made_by, "render_paper", lambda *_: b""):
        generate_papers(folder, students[:DRAWN], plan, InlineExecutor(), 1, silent)
    keys, heads = KeyIndex(folder), folder.heads()
    for place in range(DRAWN, len(students)):
        own, other = students[place].id, students[place % DRAWN].id
        head = msgspec.structs.replace(heads[other], id=own, code=f"{heads[other].code}{place}")
        folder.append([format_record(head, keys.key(other))])
    folder.write_roster(students)
    number = answered(folder, len(students))
    before = cpu()
    run = grade_class(folder, InlineExecutor(), 1)
    between = cpu()
    write_analysis_page(folder)
    print(f"{number} answers marked in {between - before:.1f} CPU s ({run.groups} groups to "
          f"decide), analysed in {cpu() - between:.1f}; {memory():.0f} MB")  # fmt: skip


def main(count: int, mode: str = "") -> None:
    """Print the table."""
    students = [RosterStudent(str(10_000 + number), f"Student {number}") for number in range(count)]
    with patch.object(made_by, "new_secret", lambda: "5" * 32):  # the same papers in every run
        settings = create_settings(
            "class", builtin_bank(), load_blueprint("mock", builtin_bank()), "en"
        )
    print(f"{count} students, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as temporary:
        home = Path(temporary)
        print(f"loop: {loop():.1f} ms")
        if mode:
            marks(home, settings, students)
            print(f"loop: {loop():.1f} ms")
            return
        names = [here(home, settings, students)]
        print(f"loop: {loop():.1f} ms")
        names.append(processes(home, settings, students, PROCESSES))
        names.append(on_a_cluster(home, settings, students))
    print("same bytes" if len(set(names)) == 1 else f"OTHER BYTES: {names}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 300, *sys.argv[2:3])
