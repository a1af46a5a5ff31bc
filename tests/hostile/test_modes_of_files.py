"""Who reads what a paper leaves on a machine of several people."""

from __future__ import annotations

import os
import stat
import sys

import pytest
from click.testing import CliRunner

from quizgen.cli.main import root_group


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no modes of files")
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
