"""Sets of files appear together or not at all, whatever moment a run is killed at."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest
from sweep import spread

from quizgen.core.errors import RenderError
from quizgen.core.files import STALE, write_all

CALLS = [(os, "rename"), (os, "replace"), (os, "unlink")]
"""What others see of a set that is being written: the moments to be killed at."""
INSIDE = [*CALLS, (Path, "mkdir"), (Path, "open")]
forks = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
NAMES = ("a.html", "media/b.svg", "key.json")


def killed_at(step: int, folder, contents, calls=CALLS) -> bool:
    """Write in a process that ends, as by kill -9, at one of the calls."""
    left = step

    def dying(call):
        def counted(*arguments, **options):
            nonlocal left
            if left == 0:
                os._exit(9)
            left -= 1
            return call(*arguments, **options)

        return counted

    child = os.fork()
    if child == 0:
        for owner, name in calls:
            setattr(owner, name, dying(getattr(owner, name)))
        write_all(folder, contents)
        os._exit(0)
    return os.waitpid(child, 0)[1] != 0


def found(folder) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in NAMES if (folder / name).exists()}


@forks
def test_a_new_folder_appears_whole_wherever_the_run_is_killed(tmp_path):
    steps = 0
    new = dict.fromkeys(NAMES, b"new")
    while killed_at(steps, tmp_path / str(steps), new, INSIDE):
        assert found(tmp_path / str(steps)) in ({}, new)
        steps += 1
    assert steps > 6
    assert found(tmp_path / str(steps)) == new


@forks
def test_the_last_file_never_stands_beside_others_of_another_set(tmp_path):
    steps = 0
    while True:
        folder = tmp_path / str(steps)
        write_all(folder, dict.fromkeys(NAMES, b"old"))
        if not killed_at(steps, folder, dict.fromkeys(NAMES, b"new"), INSIDE):
            break
        now = found(folder)
        assert "key.json" not in now or len({*now.values()}) == 1
        steps += 1
    assert steps > 8
    assert found(folder) == dict.fromkeys(NAMES, b"new")


def test_what_killed_runs_left_behind_is_swept_when_it_is_old(tmp_path):
    folder = tmp_path / "o"
    write_all(folder, {"a": b""})
    mark = "12-0123abcd.part"
    old, young, other = (folder / name for name in (f".x.{mark}", f".y.{mark}", ".notes.part"))
    for path in (old, young, other):
        path.mkdir()
        (path / "file").write_bytes(b"")
    for path in (old, other):
        os.utime(path, (0, 0))
    write_all(folder, {"a": b""})
    assert STALE >= 600
    assert not old.exists()
    assert young.exists()
    assert other.exists()


INTERRUPTED = """
import signal, sys
from pathlib import Path
from quizgen.core.files import write_all
signal.signal(signal.SIGINT, signal.default_int_handler)
before = Path.replace
def step(self, target):
    signal.raise_signal(signal.SIGINT)
    return before(self, target)
Path.replace = step
try:
    write_all(Path(sys.argv[1]), {"a": b"new", "b": b"new"})
except KeyboardInterrupt:
    sys.exit(130)
"""


def test_ctrl_c_waits_until_all_files_stand_where_they_belong(tmp_path):
    folder = tmp_path / "o"
    write_all(folder, {"a": b"old", "b": b"old"})
    done = subprocess.run([sys.executable, "-c", INTERRUPTED, str(folder)], check=False)
    assert done.returncode == 130
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == {"a": b"new", "b": b"new"}


@pytest.mark.parametrize("formats", ["tsv", "apkg,tsv,csv"])
def test_cards_and_their_pictures_are_one_set(tmp_path, monkeypatch, formats):
    from click.testing import CliRunner

    from quizgen.cli.cards import cards
    from quizgen.core import files

    sets = []
    monkeypatch.setattr(
        files, "write_all", lambda _folder, contents: sets.append(list(contents)) or []
    )
    options = [
        "--kind",
        "figure",
        "--topic",
        "distortion",
        "--format",
        formats,
        "--out",
        str(tmp_path),
    ]
    done = CliRunner().invoke(cards, options)
    assert done.exit_code == 0, done.output
    (names,) = sets
    assert names[-1].startswith("quizgen.")
    assert any(name.startswith("media/") for name in names)


def kept(folder) -> dict[str, bytes]:
    """What stands in a folder, but for what a killed run left behind."""
    files = (path for path in folder.rglob("*") if path.is_file())
    names = {path: path.relative_to(folder).as_posix() for path in files}
    return {name: path.read_bytes() for path, name in names.items() if ".part" not in name}


SETS = {
    "key.json": ["exam", "--blueprint", "sensor.10", "--seed", "1", "--format", "html"],
    "quizgen.csv": ["cards", "--kind", "figure", "--topic", "distortion", "--format", "tsv,csv"],
    "tradeoff.html": ["tradeoff"],
}
"""Last file of a set to the command that writes it."""


@forks
@pytest.mark.parametrize("seal", spread(SETS, 1))
def test_a_command_killed_between_two_renames_leaves_a_whole_set_or_none(
    tmp_path, monkeypatch, seal
):
    """The last file of a set stands only beside the others of its set."""
    after = written_by(SETS[seal], tmp_path, monkeypatch)
    before = dict.fromkeys([*after, "older.txt"], b"old")
    monkeypatch.setattr(os, "fsync", lambda _: None)
    assert list(after)[-1] == seal
    assert len(after) >= 3
    step = 0
    while killed_at(step, tmp_path / f"new{step}", after):
        assert kept(tmp_path / f"new{step}") in ({}, after)
        step += 1
    step = 0
    while killed_at(step, renewed(tmp_path / f"old{step}", before), after):
        found = kept(tmp_path / f"old{step}")
        assert seal not in found or found in (before, {**before, **after})
        step += 1
    assert step > len(after)
    assert kept(tmp_path / f"old{step}") == {**before, **after}


def renewed(folder, contents):
    """A folder with a set in it."""
    write_all(folder, contents)
    return folder


def written_by(words, folder, monkeypatch) -> dict[str, bytes]:
    """The one set of files that a command writes, their contents shortened."""
    from click.testing import CliRunner

    from quizgen.cli.main import root_group
    from quizgen.core import files
    from quizgen.tradeoff import page

    sets = []
    for module in (files, page):
        monkeypatch.setattr(module, "write_all", lambda _, made, **_how: sets.append(made) or [])
    done = CliRunner().invoke(root_group, [*words, "--out", str(folder / "none")])
    assert done.exit_code == 0, done.output
    (only,) = sets
    return {name: hashlib.sha256(data).digest() for name, data in only.items()}


def test_a_folder_that_cannot_be_written_is_named_as_it_was_asked_for(tmp_path, monkeypatch):
    def refused(path, *_args, **_options):
        raise PermissionError(13, "Permission denied", f"{path}")

    monkeypatch.setattr("quizgen.core.files._write_staged_files", refused)
    for folder in (tmp_path / "paper", tmp_path):
        with pytest.raises(RenderError) as found:
            write_all(folder, {"exam.html": b"x"})
        assert str(found.value).replace("/:", ":") == f"{folder}: Permission denied"
