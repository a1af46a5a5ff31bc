"""Who reads what a paper leaves on a machine of several people."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from quizgen.cli.main import root_group

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no modes of files")

ONE = '[title]\nen = "One"\n[[slot]]\ntemplates = ["rods-cones-and-peaks"]\n'


def run(*words: object) -> None:
    """Run a command where new files are for everybody."""
    before = os.umask(0)
    try:
        done = CliRunner().invoke(root_group, [str(word) for word in words])
    finally:
        os.umask(before)
    assert done.exit_code == 0, (done.output, done.exception)


def modes(folder: Path) -> dict[str, int]:
    """What is open to others in a folder, and the folder itself."""
    return {
        str(path): stat.S_IMODE(path.stat().st_mode)
        for path in (folder, *folder.rglob("*"))
        if stat.S_IMODE(path.stat().st_mode) & 0o077
    }


def test_nobody_else_looks_into_the_folder_of_a_class(tmp_path):
    """Nor into one that was empty and open, nor into one that was opened since."""
    (tmp_path / "one.toml").write_text(ONE, encoding="utf-8")
    (tmp_path / "roster.csv").write_text("id,name\n104,Ada\n", encoding="utf-8")
    folder, apart = tmp_path / "class", tmp_path / "apart.txt"
    folder.mkdir(0o755)
    make = ("class", "make", tmp_path / "roster.csv", "--out", folder)
    run(*make, "--blueprint", tmp_path / "one.toml")
    assert modes(folder) == {}
    apart.touch()
    apart.chmod(0o644)
    (folder / "answers").mkdir(exist_ok=True)
    (folder / "answers" / ".link").symlink_to(apart)
    for commands in (("mark", folder), ("rule", folder, "drop", "rods-cones-and-peaks/a")):
        for path in (folder, *folder.rglob("*")):
            if not path.is_symlink():
                path.chmod(0o755 if path.is_dir() else 0o644)
        run("class", *commands)
        (folder / "answers" / ".link").unlink(missing_ok=True)
        assert modes(folder) == {}
    assert stat.S_IMODE(apart.stat().st_mode) == 0o644


def test_a_key_that_others_could_read_is_theirs_no_more(tmp_path):
    words = ("exam", "--blueprint", "trial", "--seed", "1", "--format", "html", "--out", tmp_path)
    run(*words)
    for name in ("key.json", "solutions.html"):
        (tmp_path / name).chmod(0o644)
    run(*words)
    assert not {"key.json", "solutions.html"} & {Path(one).name for one in modes(tmp_path)}


def test_only_its_owner_reads_the_key_and_the_solutions_of_a_paper(tmp_path):
    before = os.umask(0o022)
    try:
        arguments = ["exam", "--blueprint", "trial", "--seed", "1", "--format", "html", "--out"]
        done = CliRunner().invoke(root_group, [*arguments, str(tmp_path / "paper")])
    finally:
        os.umask(before)
    assert done.exit_code == 0, done.output
    modes = {
        path.name: stat.S_IMODE(path.stat().st_mode) for path in (tmp_path / "paper").iterdir()
    }
    assert modes.pop("key.json") == modes.pop("solutions.html") == 0o600
    assert set(modes.values()) == {0o644}
