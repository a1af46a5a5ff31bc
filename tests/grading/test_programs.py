"""Programs of strangers: what may run, what each kind of mistake is told, and what is impossible."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from fractions import Fraction

import pytest

from quizgen.core.errors import KeyFileError
from quizgen.grading import programs
from quizgen.grading.program_runner import OF_NUMPY, RefusedError, read_program
from quizgen.kinds.grade import grade_answer, load_spec, show_key

FENCE = "```"
SPEC = {
    "kind": "program",
    "function": "halve",
    "parameters": "image, by",
    "solution": "def halve(image, by):\n    return (image.astype(float) / by).astype(np.uint8)\n",
    "traps": {
        "rounded": "def halve(image, by):\n    return np.rint(image / by).astype(np.uint8)\n"
    },
    "notes": {"en": {"rounded": "This rounds."}},
    "why": {"en": {"odd": "Look at odd numbers.", "inputs": "Work on a copy."}},
    "keeps": 1,
    "cases": {
        "even": {"args": [{"uint8": [[2, 4], [6, 8]]}, 2]},
        "odd": {"args": [{"uint8": [[3, 7, 11]]}, 2], "worth": 2},
    },
}
linux = pytest.mark.skipif(not programs.can_run_programs(), reason="no process can be locked here")


def refusal(text: str) -> str:
    """The note on a program that does not run; empty if it does."""
    try:
        read_program(text, "f", "x")
    except RefusedError as error:
        return error.note
    return ""


def body(line: str) -> str:
    return f"def f(x):\n    {line}\n"


@pytest.mark.parametrize(
    "line",
    [
        "import os",
        "from os import system",
        "return __import__('os').system('id')",
        "return ().__class__.__base__.__subclasses__()",
        "return x.__class__",
        "return x.dtype.__reduce__()",
        "return np.__dict__",
        "return np.load('/etc/passwd')",
        "return np.fromfile('/etc/passwd')",
        "return np.genfromtxt('/etc/passwd')",
        "return np.memmap('/tmp/x')",
        "return np.lib.npyio",
        "return np.ctypeslib",
        "return np.f2py",
        "return np.testing",
        "return np.core",
        "return np.frompyfunc(f, 1, 1)",
        "return np.vectorize(f)",
        "return np.save('/tmp/x', x)",
        "return np.random.seed(1)",
        "return x.tofile('/tmp/x')",
        "return x.dump('/tmp/x')",
        "return x.ctypes",
        "return x.data",
        "return x.base",
        "return x.setfield(0, 0)",
        "x.shape = (1, 1)",
        "np.pi = 3",
        "np = x",
        "for np in x: pass",
        "return [np for np in x]",
        "return open('/etc/passwd').read()",
        "return eval('1')",
        "return exec('1')",
        "return compile('1', '', 'eval')",
        "return getattr(x, 'shape')",
        "return globals()",
        "return vars()",
        "return type(x)",
        "return object()",
        "return (lambda: 1)()",
        "return f.__code__",
        "return x.astype('O')",
        "return '{0.__class__}'.format(x)",
        "return f'{x.__class__}'",
        "return 'a' * 3",
        "return b'1'",
        "return {1: 2}",
        "return {1, 2}",
        "return [*x]",
        "return f(*x)",
        "return f(**x)",
        "return np.sum(x, like=x)",
        "return sorted(x, key=f)",
        "while True: pass",
        "try:\n        return 1\n    except Exception: pass",
        "with x: pass",
        "raise ValueError",
        "assert x",
        "del x",
        "global y",
        "yield x",
        "async def g(): pass",
        "class A: pass",
        "return (y := x)",
        "match x:\n        case 1: pass",
        "_y = 1",
        "__builtins__ = 1",
        "return x[0]()",
        "return (x or f)(1)",
    ],
)
def test_what_is_not_listed_never_runs(line):
    assert refusal(body(line)) in {"program-refused", "program-syntax"}, line


@pytest.mark.parametrize(
    "text",
    [
        "@f\ndef f(x):\n    return x\n",
        "def f(x, **more):\n    return x\n",
        "def np(x):\n    return x\ndef f(x):\n    return x\n",
        "def f(np):\n    return np\n",
        "def __f(x):\n    return x\ndef f(x):\n    return x\n",
        "def f(x, y=open('/etc/passwd')):\n    return x\n",
        "def f(x):\n    def g(z=np.load):\n        return z\n    return g()\n",
        "import os\ndef f(x):\n    return x\n",
        "import numpy as np, os\ndef f(x):\n    return x\n",
        "import numpy as numpy\ndef f(x):\n    return x\n",
        "from numpy import *\ndef f(x):\n    return x\n",
    ],
)
def test_no_definition_brings_anything_along(text):
    assert refusal(text)


@pytest.mark.parametrize(
    "text",
    [
        "(" * 4000,
        body("return " + "(" * 90 + "x" + ")" * 90),
        body("return " + "-" * 3000 + "1"),
        body("return " + "not " * 900 + "x"),
        body("return x" + "+1" * 1900),
        body("return x" + ".T" * 1900),
        body("return x" + "[0]" * 1300),
        "def f(x):\n" + "".join(" " * i + "if x:\n" for i in range(1, 88)),
        "\x00",
        "def f(x):\n\treturn x\n        return x",
        "def f(x):\nreturn x",
        "a" * 5000,
        "def f(x, x):\n    return",
    ],
)
def test_no_text_breaks_the_reader(text):
    refusal(text)


@pytest.mark.parametrize(
    ("text", "note"),
    [
        ("def g(x):\n    return x\n", "program-function"),
        ("def f(x, y):\n    return x\n", "program-parameters"),
        ("def f(x):\n    print(x)\n", "program-prints"),
        ("def f(x):\n    return x\nf(3)\n", "program-outside"),
        ("x + 1", "program-outside"),
        ("def f(x) return x", "program-syntax"),
    ],
)
def test_what_is_missing_is_said(text, note):
    assert refusal(text) == note


@pytest.mark.parametrize(
    "text",
    [
        "import numpy as np\n\ndef f(x: np.ndarray) -> np.ndarray:\n    '''A text: __import__.'''\n    y: int = 1\n    return x\n",
        "def g(x):\n    return 2 * x\n\ndef f(x):\n    return g(x)\n",
        "def f(x):\n    out = x.copy()\n    out[x > 3] = 0\n    out[..., ::-1] += 1\n    return out\n",
        "def f(x):\n    for _ in range(3):\n        if not x.any():\n            continue\n    return sum([v for row in x for v in row if v])\n",
        "def f(x):\n    a, b = x.shape\n    return np.zeros((a, b), dtype='uint8') if a < b else None\n",
        "def f(*args):\n    return args[0]\n",
        "def f(x, y=np.float64(2)):\n    return x\n",
    ],
)
def test_ordinary_programs_may_run(text):
    assert refusal(text) in {"", "program-parameters"}


@linux
@pytest.mark.parametrize(
    ("text", "note", "credit"),
    [
        (SPEC["solution"], "", 1),
        (f"{FENCE}python\n{SPEC['solution']}{FENCE}", "", 1),
        ("def halve(image, by):\n    return image // by\n", "", 1),
        (">>> def halve(image, by):\n...     return image // by\n", "", 1),
        (SPEC["traps"]["rounded"], "trap:rounded", Fraction(1, 2)),
        ("def halve(image, by):\n    return image / by\n", "program-dtype", Fraction(1, 4)),
        (
            "def halve(image, by):\n    return np.uint16(image // by)\n",
            "program-dtype",
            Fraction(1, 4),
        ),
        ("def halve(image, by):\n    return image[0] // by\n", "program-shape", Fraction(1, 4)),
        ("def halve(image, by):\n    return image\n", "program-values", Fraction(1, 4)),
        ("def halve(image, by):\n    return 3\n", "program-no-array", Fraction(1, 4)),
        ("def halve(image, by):\n    image // by\n", "program-nothing", Fraction(1, 4)),
        ("def halve(image, by):\n    return image[9]\n", "program-raises", Fraction(1, 4)),
        ("def halve(image, by=1/0):\n    return image\n", "program-raises", Fraction(1, 4)),
        ("def halve(image, by):\n    return 10**40\n", "program-no-array", Fraction(1, 4)),
        ("def halve(image, by):\n    return halve(image, by)\n", "program-raises", Fraction(1, 4)),
        ("def halve(image, by):\n    return np.ones(10**11)\n", "program-raises", Fraction(1, 4)),
        (
            "def halve(image, by):\n    image //= by\n    return image\n",
            "program-inputs",
            Fraction(3, 4),
        ),
        ("def halve(image, by):\n    break\n", "program-syntax", 0),
    ],
)
def test_a_program_is_judged_by_what_it_does(text, note, credit):
    verdict = grade_answer(SPEC, text)
    assert (verdict.note, verdict.credit) == (note, credit), verdict
    assert verdict.verdict == ("unreadable" if note == "program-syntax" else verdict.verdict)
    assert "return (image" not in verdict.message, "no message gives the solution away"


def test_invisible_characters_in_a_program_are_named():
    verdict = grade_answer(SPEC, "def halve(image, by):\n    return \u202eimage")
    assert (verdict.verdict, verdict.note) == ("unreadable", "bad-character")


@linux
def test_the_first_thing_that_is_wrong_is_shown_and_named():
    wrong = grade_answer(SPEC, "def halve(image, by):\n    return np.zeros_like(image) + 1\n")
    assert wrong.message == (
        "1 of 3 checks are right. halve([[2, 4], [6, 8]] (uint8), 2) gives [[1, 1], [1, 1]] (uint8); "
        "3 of its values are wrong, the first one at [0, 1]."
    )
    german = grade_answer(SPEC, "def halve(image, by):\n    return image / 2.5\n", lang="de")
    assert "2.5" not in german.message
    assert "float64" in german.message


@linux
@pytest.mark.slow
@pytest.mark.parametrize("line", ["for i in range(10**12): by = i", "return 9**9**9**9"])
def test_a_program_that_never_ends_is_ended(line):
    verdict = grade_answer(SPEC, f"def halve(image, by):\n    {line}\n")
    assert (verdict.verdict, verdict.note) == ("wrong", "program-time")


@linux
def test_a_process_that_is_locked_can_do_nothing():
    """Behind the list there are the limits of the system: tried from within, without the list."""
    tries = {
        "file": "open('/etc/passwd')",
        "socket": "__import__('socket').socket()",
        "process": "os.posix_spawn('/bin/true', ['true'], {})",
        "memory": "bytearray(2**30)",
    }
    script = (
        "import ctypes, json, os, sys, socket\n"
        f"sys.path.insert(0, {str(programs.RUNNER.parent)!r})\n"
        "import program_runner\n"
        "def attack(np, job):\n"
        "    program_runner.lock()\n"
        "    done = []\n"
        f"    for name, text in {tries!r}.items():\n"
        "        try:\n            eval(text)\n        except (OSError, MemoryError):\n"
        "            continue\n"
        "        done.append(name)\n"
        "    for number in range(64):\n"
        "        try:\n            os.fstat(number)\n        except OSError:\n"
        "            continue\n"
        "        done.append(number)\n"
        "    gained = ctypes.CDLL(None).prctl(39, 0, 0, 0, 0) == 0\n"
        "    return [*done, *['privileges'] * gained]\n"
        "program_runner.judge_job = attack\n"
        "print(program_runner.fork_job(None, b'').decode())\n"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-c", script], capture_output=True, env={}, check=True
    )
    assert json.loads(done.stdout) == [1], "only the pipe to its parent is open"


@linux
def test_programs_go_on_after_the_process_that_runs_them_has_ended():
    right = SPEC["solution"]
    assert grade_answer(SPEC, f"{right}\n# one").credit == 1
    (runner,) = programs._IDLE
    os.kill(runner._process.pid, signal.SIGKILL)
    runner._process.wait()
    assert grade_answer(SPEC, f"{right}\n# two").credit == 1
    assert grade_answer(SPEC, f"{right}\n# three").credit == 1
    (other,) = programs._IDLE
    assert other is not runner


@linux
def test_every_listed_function_of_numpy_is_there_in_the_locked_process():
    lines = "\n".join(f"    np.{name}" for name in sorted(OF_NUMPY - {"newaxis"}))
    methods = "np.median(image), image.mean(), image.std(), np.var(image), image.round(1)"
    text = f"def halve(image, by):\n{lines}\n    {methods}\n    return image // by\n"
    assert grade_answer(SPEC, text).credit == 1


def test_where_nothing_can_be_locked_a_person_decides(monkeypatch):
    monkeypatch.setattr(programs.sys, "platform", "win32")
    verdict = grade_answer(SPEC, SPEC["solution"])
    assert (verdict.verdict, verdict.note) == ("ambiguous", "unchecked")
    assert verdict.needs_self_marking


def test_the_solution_is_the_key_that_is_shown():
    assert show_key(SPEC) == SPEC["solution"]


def test_a_key_that_is_none_is_refused():
    with pytest.raises(KeyFileError):
        load_spec({**SPEC, "cases": {"one": {"args": 3}}})


@pytest.mark.parametrize("typed", ["", "  \n ", "```\n```"])
def test_nothing_written_is_no_answer(typed):
    assert grade_answer(SPEC, typed).note == "no-answer"
