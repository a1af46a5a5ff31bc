"""Commands where Python lacks what only Unix has, as on Windows: a machine we do not have."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow

WITHOUT = """
import os, signal, sys, asyncio, multiprocessing, subprocess, tempfile, platformdirs
for name in ("fcntl", "resource", "pwd", "grp", "termios", "readline"):
    sys.modules[name] = None
for name in ("getuid", "geteuid", "getgid", "killpg", "setsid", "fork", "sched_getaffinity"):
    if hasattr(os, name):
        delattr(os, name)
for name in ("SIGALRM", "SIGHUP", "SIGKILL", "SIGPROF", "setitimer", "ITIMER_REAL", "ITIMER_PROF"):
    if hasattr(signal, name):
        delattr(signal, name)
from quizgen.__main__ import main
sys.argv = ["quizgen", *{arguments!r}]
main()
"""


def types(folder, *arguments):
    program = WITHOUT.replace("{arguments!r}", repr(list(arguments)))
    done = subprocess.run([sys.executable, "-c", program], cwd=folder, capture_output=True,
                          text=True, check=False)  # fmt: skip
    assert done.returncode == 0, f"{arguments}\n{done.stdout}{done.stderr}"
    return done.stdout


def test_the_commands_of_a_student_and_an_author(tmp_path):
    types(tmp_path, "exam", "--blueprint", "trial", "--out", "tonight", "--format", "html")
    types(tmp_path, "check", "tonight/key.json", "tonight/answers.toml")
    types(tmp_path, "new", "bank", "physics")
    types(tmp_path, "lint", "--bank", "physics", "--trust", "--seeds", "5")
    types(tmp_path, "cards", "--topic", "noise", "--kind", "vocab")
    types(tmp_path, "doctor")


def test_the_modules_of_the_server_and_of_classes_load(tmp_path):
    program = WITHOUT.partition("from quizgen")[0] + (
        "import quizgen.web.server, quizgen.web.app, quizgen.classes.lock\n"
        "import quizgen.grading.programs, quizgen.lint.cpu_limit, quizgen.core.cache\n"
    )
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True,
                          text=True, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
