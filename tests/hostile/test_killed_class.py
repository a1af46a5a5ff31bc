"""Commands in the folder of a class that are killed, or end with the power.

Each dies before one of its changes, which the number of the test chooses. Then the same command and
those after it are run, and all is as if nothing had happened.
``QUIZGEN_KILLS=100 uv run pytest -m slow tests/hostile/test_killed_class.py`` kills 100 times and
cuts the power 20 times.
"""

from __future__ import annotations

import csv
import os
import random
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "classes"))
from made import made, run

from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.rulings import read_rulings

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="what is synced is read from /proc"),
]

COMMAND = Path(__file__).parent / "power" / "class_command.py"
KILLS = int(os.environ.get("QUIZGEN_KILLS", "3"))
CUTS = max(2, KILLS // 5)
SENTENCE = "blur-and-light-factors/b"
STEPS = (
    ("mark", "first.csv"),
    ("decide",),
    ("rule", "drop", "normalise-from-8-bit-range/a", "--who", "me"),
    ("mark",),
    ("rule", "restore", "normalise-from-8-bit-range/a", "--who", "me"),
    ("rule", "give", "exposure-equivalence/b", "--who", "me"),
    ("mark", "second.csv"),
    ("grade", "--reports", "html"),
)


class Undisturbed(NamedTuple):
    """A class before each step, how often each changes something, and how it ends."""

    before: list[Path]
    changes: list[int]
    after: dict[str, object]


def words_of(step: tuple[str, ...], folder: Path) -> list[object]:
    """A step as a command."""
    name, *more = step
    return [
        "class",
        name,
        folder,
        *(folder.parent / one if one.endswith(".csv") else one for one in more),
    ]


def do(step: tuple[str, ...], folder: Path) -> None:
    """A step that nothing disturbs, after which another one may begin."""
    if step == ("decide",):
        decide(folder)
    else:
        assert run(*words_of(step, folder)) == 0


def decide(folder: Path) -> None:
    """Fill in points, as a person does in a spreadsheet."""
    path = folder / "decisions.csv"
    with path.open(encoding="utf-8-sig", newline="") as stream:
        head, *rows = csv.reader(stream)
    assert rows
    for row in rows:
        row[head.index("points")] = "0.5"
    with path.open("w", encoding="utf-8-sig", newline="") as stream:
        csv.writer(stream).writerows([head, *rows])


def start(
    folder: Path, left: Path, place: int, step: tuple[str, ...]
) -> subprocess.CompletedProcess[str]:
    """A step in a process that dies before a change."""
    words = [str(one) for one in (COMMAND, folder, left, place, *words_of(step, folder))]
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False)


def summary(folder: Path) -> dict[str, object]:
    """What a class has come to; a ruling that is there twice says the same."""
    with (folder / "changes.csv").open(encoding="utf-8", newline="") as stream:
        changes = [{**row, "when": ""} for row in csv.DictReader(stream)]
    rulings = [(one.who, one.what, one.item, one.value, one.group) for one in read_rulings(folder)]
    return {
        "marks": {one.student: one for one in GradingHistory(folder).current()},
        "runs": [path.read_bytes() for path in GradingHistory(folder).runs()],
        "changes": changes,
        "rulings": list(dict.fromkeys(rulings)),
        "grades": (folder / "results" / "grades.csv").read_bytes(),
        "reports": {path.name: path.read_bytes() for path in folder.glob("results/reports/*")},
        "answers": {
            path.name: path.read_bytes() for path in folder.glob("answers/*") if path.is_file()
        },
    }


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    root = tmp_path_factory.mktemp("class")
    folder = made(root, [(str(100 + n), f"Student {n}", "en") for n in range(4)])
    answers = {
        "first.csv": [("100", "0.5", "a little"), ("101", "0,25", "twice"), ("102", "", "never")],
        "second.csv": [("103", "0.5", "a little")],
    }
    for name, rows in answers.items():
        with (root / name).open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream).writerows([("id", "1a", "3b"), *rows])
    before, changes = [], []
    for number, step in enumerate(STEPS):
        before.append(shutil.copytree(folder, root / f"before-{number}" / "class"))
        for name in answers:
            shutil.copy(root / name, before[-1].parent)
        if step == ("decide",):
            decide(folder)
            changes.append(0)
            continue
        left = root / f"left-{number}"
        left.mkdir()
        done = start(folder, left, 0, step)
        assert done.returncode == 0, done.stderr
        changes.append(int(done.stdout.splitlines()[-1]))
    return Undisturbed(before, changes, summary(folder))


def cut_power(folder: Path, left: Path, before: dict[int, bytes], chance: random.Random) -> None:
    """Leave of each file what was synced, and some of what was added since.

    Names change in the order in which they were changed, as a file system with a journal has it.
    """
    for path in folder.rglob("*"):
        if path.is_file():
            number, now = path.stat().st_ino, path.read_bytes()
            kept = left / str(number)
            synced = kept.read_bytes() if kept.exists() else before.get(number, b"")
            more = now[len(synced) :] if now.startswith(synced) else b""
            path.write_bytes(synced + more[: chance.randrange(len(more) + 1)])


@pytest.mark.parametrize(("number", "power"), [
    *((number, False) for number in range(KILLS)), *((number, True) for number in range(CUTS)),
])  # fmt: skip
def test_a_killed_command_is_ended_by_the_next(undisturbed, tmp_path, number, power):
    chance = random.Random(number)
    place = chance.choices(range(len(STEPS)), undisturbed.changes)[0]
    at = chance.randint(1, undisturbed.changes[place] + power)
    for one in undisturbed.before[place].parent.iterdir():
        copy = shutil.copytree if one.is_dir() else shutil.copy
        copy(one, tmp_path / one.name)
    folder, left = tmp_path / "class", tmp_path / "left"
    left.mkdir()
    files = {path.stat().st_ino: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    done = start(folder, left, at, STEPS[place])
    is_over = at > undisturbed.changes[place]
    assert done.returncode == (0 if is_over else -signal.SIGKILL), done.stderr
    if power:
        cut_power(folder, left, files, chance)
    for step in STEPS[place + is_over :]:
        do(step, folder)
    assert summary(folder) == undisturbed.after
