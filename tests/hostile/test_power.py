"""What was acknowledged is there after a kill and after a power cut.

``QUIZGEN_KILLS=100 uv run pytest -m slow tests/hostile/test_power.py`` kills 100 times and cuts the
power 20 times.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest
from needed import absent
from sqlalchemy import event
from test_long_import import long_file

from quizgen.store import Store
from quizgen.store.archive import read_archive

HERE = Path(__file__).parent / "power"
FILE = "learning.sqlite3"
THREADS = 8
KILLS = int(os.environ.get("QUIZGEN_KILLS", "3"))
CUTS = max(2, KILLS // 5)


@pytest.fixture(scope="session")
def synced(tmp_path_factory):
    """A library that keeps each file of a database as it was last synced."""
    cc = shutil.which("cc")
    if not cc or sys.platform != "linux":
        absent("a C compiler", "gcc")
    made = tmp_path_factory.mktemp("synced") / "synced.so"
    subprocess.run([cc, "-shared", "-fPIC", "-o", made, HERE / "synced.c", "-ldl"], check=True)
    return made


def run(folder: Path, library: Path, seconds: float, *archive: Path) -> list[list[str]]:
    """Write for some time and be killed; what was acknowledged, and ``folder/synced``."""
    left = folder / "synced"
    left.mkdir()
    with (folder / "said").open("wb") as said:
        writer = subprocess.Popen(
            [sys.executable, HERE / "writer.py", folder / FILE, str(THREADS), *archive],
            stdout=said, env={**os.environ, "LD_PRELOAD": str(library), "SYNCED": str(left)},
        )  # fmt: skip
        while not (folder / "said").stat().st_size:
            time.sleep(0.01)
            assert writer.poll() is None
        time.sleep(seconds)
        writer.send_signal(signal.SIGKILL)
        writer.wait()
    return [line.split() for line in (folder / "said").read_text().splitlines()]


def lost(file: Path, acknowledged: list[list[str]]) -> list[list[str]]:
    """What of it the database does not hold."""
    with closing(sqlite3.connect(file)) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        saved = dict(database.execute("SELECT sitting, fields FROM answer"))
        handed = {name for (name,) in database.execute(
            "SELECT id FROM sitting WHERE handed IS NOT NULL")}  # fmt: skip
    return [
        line for line in acknowledged
        if (line[1] not in handed if line[0] == "handed"
            else int(line[2]) > int(saved.get(line[1], '["-1"]')[2:-2]))
    ]  # fmt: skip


def rounds(few: int, many: int):
    return [pytest.param(n, marks=[pytest.mark.slow] if n >= few else []) for n in range(many)]


def cut_power(folder: Path, chance: random.Random, *, torn: bool) -> Path:
    """The database as a power cut leaves it."""
    left = folder / "synced"
    log, now = left / f"{FILE}-wal", folder / f"{FILE}-wal"
    if torn and log.read_bytes() == now.read_bytes()[: log.stat().st_size]:
        # some of what was written after the last sync may have reached the disk
        with log.open("ab") as end:
            tail = now.read_bytes()[log.stat().st_size :]
            end.write(tail[: chance.randrange(len(tail) + 1)])
    return left / FILE


@pytest.mark.parametrize("number", rounds(2, KILLS))
def test_a_killed_server_has_lost_nothing(tmp_path, synced, number):
    acknowledged = run(tmp_path, synced, random.Random(number).uniform(0.05, 0.6))
    assert acknowledged
    assert lost(tmp_path / FILE, acknowledged) == []


@pytest.mark.parametrize("number", rounds(2, CUTS))
def test_a_power_cut_has_lost_nothing(tmp_path, synced, number):
    chance = random.Random(number)
    acknowledged = run(tmp_path, synced, chance.uniform(0.05, 0.6))
    assert acknowledged
    assert lost(cut_power(tmp_path, chance, torn=bool(number % 2)), acknowledged) == []


@pytest.mark.slow
@pytest.mark.parametrize(("number", "power"), [
    *((number, False) for number in range(KILLS)), *((number, True) for number in range(CUTS)),
])  # fmt: skip
def test_an_import_that_was_killed_has_left_nothing_half_and_is_ended_by_another(
    tmp_path, synced, number, power
):
    chance = random.Random(number)
    file = tmp_path / "me.json"
    file.write_bytes(long_file(1))
    acknowledged = run(tmp_path, synced, chance.uniform(0.05, 3.0), file)
    imported = ["imported"] in acknowledged
    saved = [line for line in acknowledged if line != ["imported"]]
    place = cut_power(tmp_path, chance, torn=bool(number % 2)) if power else tmp_path / FILE
    assert saved
    assert lost(place, saved) == []
    store, archive = Store(f"sqlite:///{place}"), read_archive(file.read_bytes())
    reader = store.learner("reader").id
    there = json.loads(store.archives.write(reader))
    whole = json.loads(file.read_bytes())
    assert all(len(one["answers"]) == len(whole["sittings"][0]["answers"])
               for one in there["sittings"])  # fmt: skip
    for name in ("attempts", "sittings"):
        assert {one["id"] for one in there[name]} <= {one["id"] for one in whole[name]}
    rows = len(archive.attempts) + len(archive.sittings)
    before = len(there["attempts"]) + len(there["sittings"])
    assert before == rows or not imported
    assert store.archives.import_archive(reader, archive) == rows - before
    again = json.loads(store.archives.write(reader))
    assert [len(again[name]) for name in ("attempts", "seen", "sittings")] == [
        len(whole[name]) for name in ("attempts", "seen", "sittings")]  # fmt: skip
    store.close()
    assert lost(place, saved) == []


def test_all_that_wait_are_committed_together(tmp_path):
    store = Store(f"sqlite:///{tmp_path / FILE}")
    me = store.learner().id
    sitting = store.sittings.begin(me, "mock-1-both-0a1b2c", None, pauses=False)
    commits = []
    event.listen(store.database._reader, "commit", commits.append)
    with ThreadPoolExecutor(THREADS) as threads:
        with store.database._turn:  # as while another commit is under way
            saved = [
                threads.submit(store.sittings.save, me, sitting.id, {f"{n}": ["x"]})
                for n in range(THREADS)
            ]
            while len(store.database._waiting) < THREADS:
                time.sleep(0.001)
        assert all(one.result()[1] for one in saved)
    assert len(commits) == 1
    assert len(store.sittings.answers(sitting)) == THREADS
    store.close()


def test_what_fails_in_a_group_takes_nothing_else_with_it(tmp_path):
    store = Store(f"sqlite:///{tmp_path / FILE}")
    me = store.learner().id
    sitting = store.sittings.begin(me, "mock-1-both-0a1b2c", None, pauses=False)
    with pytest.raises(ZeroDivisionError):
        store.database.write(me, lambda _: 1 / 0)
    assert store.sittings.save(me, sitting.id, {"1": ["x"]})[1]
    store.close()


def test_who_writes_alone_waits_for_its_turn_and_not_for_sqlite(tmp_path):
    store = Store(f"sqlite:///{tmp_path / FILE}")
    me = store.learner().id
    begun = []
    event.listen(store.database._reader, "begin", begun.append)
    with ThreadPoolExecutor(1) as threads:
        with store.database._turn:  # as while a commit is under way
            changed = threads.submit(store.update_settings, me, {"lang": "bn"})
            time.sleep(0.1)
            assert begun == []
        changed.result()
    assert len(begun) == 1
    assert store.learner().settings == {"lang": "bn"}
    store.close()
