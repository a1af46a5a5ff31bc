"""Marking says the same from any number of threads and at any precision of the process."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import flint
import pytest

from quizgen.kinds.grade import grade_answer, show_key
from quizgen.maths.precision import working_precision

pytestmark = pytest.mark.slow
TABLES = sorted((Path(__file__).parent / "answers").glob("*.toml"))


def tasks() -> list[tuple[dict, str, str]]:
    """Every answer of the marking tables: specification, text, decimal sign."""
    groups = [group for path in TABLES for group in tomllib.loads(path.read_text("utf-8"))["group"]]
    return [(g["spec"], row[0], g.get("decimal", "auto")) for g in groups for row in g["rows"]]


def said(task: tuple[dict, str, str]) -> tuple[str, ...]:
    """What is said to one answer, and what the key looks like."""
    spec, typed, decimal = task
    verdict = grade_answer(spec, typed, decimal=decimal)
    with working_precision():
        values = tuple(map(str, verdict.values))
    return (verdict.verdict, str(verdict.credit), verdict.read_as, verdict.note, verdict.message,
            show_key(spec), *values)  # fmt: skip


@pytest.fixture
def precision():
    """The precision of the process, put back after a test has disturbed it."""
    before = flint.ctx.prec
    yield
    flint.ctx.prec = before


@pytest.fixture(scope="module")
def expected() -> list[tuple[str, ...]]:
    return [said(task) for task in tasks()]


@pytest.mark.parametrize("bits", [20, 1000])
def test_a_disturbed_precision_changes_no_verdict(bits, expected, precision):
    flint.ctx.prec = bits
    assert [said(task) for task in tasks()] == expected
    assert flint.ctx.prec == bits


def test_six_threads_say_what_one_says(expected, precision):
    everything = tasks()

    def disturbed(index: int) -> tuple[str, ...]:
        return said(everything[index])

    with ThreadPoolExecutor(6) as pool:
        found = list(pool.map(disturbed, range(len(everything))))
    assert found == expected


ODD = """
import flint
flint.ctx.prec = {bits}
from quizgen.kinds.grade import grade_answer
specs = [
    ({{"kind": "number", "value": "100*pi", "decimals": 20}}, "314.15926535897932384626"),
    ({{"kind": "number", "value": "sqrt(2)", "decimals": 30}}, "√2"),
    ({{"kind": "angle", "value": "90"}}, "1.5707963"),
    ({{"kind": "angle", "value": "180", "abs": "1/10000000000000000"}}, "3.14159265358979323846264338 rad"),
    ({{"kind": "witness", "predicate": "x > pi*10^20", "symbols": ["x"]}}, "314159265358979323846.2644"),
]
print([(v.verdict, v.note, v.fields.get("factor")) for v in (grade_answer(*spec) for spec in specs)])
"""


@pytest.mark.parametrize("bits", [10, 53, 2000])
def test_a_precision_set_before_the_first_import_changes_nothing(bits):
    run = subprocess.run(
        [sys.executable, "-c", ODD.format(bits=bits)], capture_output=True, text=True, check=True
    )
    assert run.stdout.strip() == str(
        [
            ("correct", "", None),
            ("correct", "", None),
            ("wrong", "radians", None),
            ("correct", "", None),
            ("correct", "", None),
        ]
    )
