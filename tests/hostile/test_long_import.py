"""A long file that one learner takes in holds up nobody's answers."""

from __future__ import annotations

import json
import threading
import time

import pytest

from quizgen.store import Store
from quizgen.store.archive import read_archive

LONGEST = 0.25
"""Seconds that an answer may wait."""


def long_file(megabytes: int) -> bytes:
    """A file of some megabytes, about as many questions as somebody practises in years."""
    state = {"parts": {"1": {"state": {"typed": "1", "tries": 1, "hints": 0, "wrong": "2",
                                       "note": "sign", "outcome": None}, "values": ["x" * 100]}}}  # fmt: skip
    attempt = {"template": "rgb-to-hsv", "seed": "7", "level": "exam", "wish": {}, "begun": 1.0,
               "ended": None, "state": state}  # fmt: skip
    seen = {"template": "x", "topic": "c", "part": "a", "note": "", "right": True, "first": True}
    answers = [{"part": str(number), "fields": ["x" * 200], "at": 1.0} for number in range(60)]
    sitting = {"limit": None, "pauses": False, "rested": 0.0, "resting": None, "begun": 1.0,
               "handed": 2.0, "marks": {}, "answers": answers, "flags": []}  # fmt: skip
    count = megabytes * 1_000_000 // 600
    whole = {
        "format": "quizgen learning", "version": 1, "settings": {}, "cards": [],
        "attempts": [{**attempt, "id": f"attempt-{n}"} for n in range(count)],
        "seen": [{**seen, "at": float(n)} for n in range(count)],
        "sittings": [{**sitting, "id": f"sitting-{n}", "code": f"trial-{n}-both-000000"}
                     for n in range(count // 100)],
    }  # fmt: skip
    return json.dumps(whole).encode()


@pytest.fixture
def store(tmp_path):
    made = Store(f"sqlite:///{tmp_path / 'learning.sqlite3'}")
    yield made
    made.close()


def test_a_file_is_written_in_slices_between_which_others_write(store, monkeypatch):
    """Counted, not timed: between two slices somebody else's answer is on the disk."""
    archive = read_archive(long_file(1))
    mine, other = store.learner("mine").id, store.learner("other").id
    sitting = store.sittings.begin(other, "mock-1-both-0a1b2c", None, pauses=False)
    saved = []

    def save(_: float) -> None:
        number = str(len(saved))
        saved.append(store.sittings.save(other, sitting.id, {number: ["x"]})[1])

    monkeypatch.setattr("quizgen.store.archive.time.sleep", save)
    rows = len(archive.attempts) + len(archive.sittings)
    assert store.archives.import_archive(mine, archive) == rows
    assert len(saved) > 15
    assert all(saved)


def test_what_was_interrupted_is_brought_by_taking_it_in_again(store, monkeypatch):
    archive = read_archive(long_file(1))
    mine = store.learner("mine").id
    slices = []

    def interrupt(_: float) -> None:
        slices.append(1)
        if len(slices) == 7:
            raise KeyboardInterrupt

    monkeypatch.setattr("quizgen.store.archive.time.sleep", interrupt)
    with pytest.raises(KeyboardInterrupt):
        store.archives.import_archive(mine, archive)
    rows = len(archive.attempts) + len(archive.sittings)
    assert 0 < store.archives.import_archive(mine, archive) < rows
    assert store.archives.import_archive(mine, archive) == 0
    again = json.loads(store.archives.write(mine))
    assert [len(again[name]) for name in ("attempts", "seen", "sittings")] == [
        len(archive.attempts), len(archive.seen), len(archive.sittings)]  # fmt: skip


@pytest.mark.slow
def test_answers_wait_for_no_long_file(store):
    """11 MB, while an answer is saved every 20 ms."""
    archive = read_archive(long_file(11))
    mine, other = store.learner("mine").id, store.learner("other").id
    sitting = store.sittings.begin(other, "mock-1-both-0a1b2c", None, pauses=False)
    bringing = threading.Thread(target=store.archives.import_archive, args=(mine, archive))
    waited = []
    bringing.start()
    while bringing.is_alive():
        began = time.perf_counter()
        assert store.sittings.save(other, sitting.id, {"1": [str(began)]})[1]
        waited.append(time.perf_counter() - began)
        time.sleep(0.02)
    assert len(waited) > 20
    longest = sorted(waited)[-3:]
    print(f"{len(waited)} answers, the longest waited {longest} s")
    assert max(waited) < LONGEST
