"""The shell around every command: interrupts, exit codes, colours, harmless messages, help."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from click.testing import CliRunner
from sweep import together

from quizgen.cli.main import COMMANDS, root_group

STOPPED = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
import {module} as module
def stopped(*arguments, **options):
    {how}
    raise AssertionError("went on")
{place} = stopped
from quizgen.cli.main import main
main({arguments})
"""
"""A run that is interrupted where a function is called (a background job ignores SIGINT)."""

RAISED = "signal.raise_signal(signal.SIGINT)"
SWALLOWED = """try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        raise ValueError("Invalid affine transformation matrix")"""

PLACES = [
    ("quizgen.bank.bank", "module.Bank.rules", ["templates"]),
    ("quizgen.lint.template_checks", "module.lint_template", ["lint", "--only", "rgb-to-hsv"]),
    ("quizgen.bank.bank", "module.Bank.template", ["preview", "rgb-to-hsv"]),
    ("quizgen.lint.doctor", "module.run_checks", ["doctor"]),
    ("quizgen.tradeoff.report", "module.measure_tradeoff", ["tradeoff"]),
    ("quizgen.camera.scene_file", "module.load_scene", ["simulate", "flat"]),
    ("quizgen.paper.answer_key", "module.read_answer_key", ["check", "key.json", "answers.toml"]),
    ("quizgen.cards", "module.build_deck", ["cards"]),
    ("quizgen.kinds.grade", "module.grade_answer", ["mark", "{}", "1"]),
]


def run(code, cwd):
    return subprocess.run([sys.executable, "-c", code], cwd=cwd, capture_output=True,
                          text=True, check=False)  # fmt: skip


STOPS = [
    pytest.param(
        *place, how, id=f"{place[2][0]}-{name}",
        marks=[pytest.mark.slow] * (place[2][0] != "templates"),
    )
    for place in PLACES for name, how in (("raised", RAISED), ("as another error", SWALLOWED))
]  # fmt: skip


@pytest.mark.parametrize(("module", "place", "arguments", "how"), STOPS)
def test_an_interrupt_is_one_line_and_status_130(tmp_path, module, place, arguments, how):
    code = STOPPED.format(module=module, place=place, arguments=arguments, how=how)
    done = run(code, tmp_path)
    assert (done.returncode, done.stderr.strip()) == (130, "quizgen: interrupted")
    assert not list(tmp_path.iterdir())


def test_an_interrupt_while_commands_are_still_loaded_is_one_line(tmp_path):
    code = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
class Slow:
    def find_spec(self, name, *others):
        if name == "quizgen.cli.main":
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Slow())
from quizgen.__main__ import main
main()
"""
    done = run(code, tmp_path)
    assert (done.returncode, done.stderr) == (130, "quizgen: interrupted\n")


@pytest.mark.parametrize(("own", "threads"), [(None, "1"), ("2", "2")])
def test_no_threads_are_begun_for_matrices_unless_somebody_wants_them(tmp_path, own, threads):
    code = """
import os, sys
from quizgen.__main__ import main
sys.argv = ["quizgen", "templates", "--topic", "eye"]
main()
import numpy
tasks = "/proc/self/task"
print(os.environ["OPENBLAS_NUM_THREADS"], len(os.listdir(tasks)) if os.path.isdir(tasks) else 0)
"""
    home = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    given = home if own is None else {**home, "OPENBLAS_NUM_THREADS": own}
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=given,
                          capture_output=True, text=True, check=True)  # fmt: skip
    wanted, tasks = done.stdout.split()[-2:]
    assert wanted == threads
    assert int(tasks) <= int(threads)


@pytest.mark.parametrize(
    "arguments",
    [["exam", "--topic", "\x1b]0;x\x07"], ["preview", "\x1b[31m"], ["mark", "\x1b[2J"],
     ["check", "\x1b[2J", "b"], ["lint", "\x9b31m"]],
)  # fmt: skip
def test_control_characters_in_messages_are_named(tmp_path, arguments):
    done = subprocess.run([sys.executable, "-m", "quizgen", *arguments], cwd=tmp_path,
                          capture_output=True, text=True, check=False)  # fmt: skip
    assert done.returncode == 2
    assert not {c for c in done.stderr if c != "\n" and (ord(c) < 32 or 127 <= ord(c) < 160)}


@together("name", COMMANDS)
def test_help_fits_80_columns(name):
    done = CliRunner().invoke(root_group, [name, "--help"], terminal_width=80)
    assert done.exit_code == 0
    assert max(map(len, done.output.splitlines())) <= 80


def test_the_version_names_what_decides_bytes(capsys):
    from importlib.metadata import version

    from quizgen.cli.main import main

    main(["--version"])
    said = capsys.readouterr().out
    assert said.startswith(f"quizgen {version('quizgen')} (")
    for name in ("matplotlib", "typst", "fontpkg-hind-siliguri"):
        assert f"{name} {version(name)}" in said
