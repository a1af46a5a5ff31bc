"""Threads of one process, from a cold start, make what one alone makes."""

from __future__ import annotations

import multiprocessing
import subprocess
import sys
from pathlib import Path

import pytest
from sweep import draws

TOGETHER = str(Path(__file__).with_name("together.py"))
BEGUN = str(Path(__file__).with_name("begun.py"))
USUAL, HASTY = "0.005", "1e-5"
"""Seconds after which threads take turns: as Python has it, and so that they meet everywhere."""


def made(threads, papers, interval, *formats):
    """Digest of all papers, pages, keys and marks; the arithmetic's precision afterwards."""
    done = subprocess.run(
        [sys.executable, TOGETHER, str(threads), str(papers), interval, *formats],
        capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    digest, precision = done.stdout.split()
    return digest, int(precision)


@pytest.mark.slow
def test_threads_that_begin_together_make_what_one_makes():
    papers = draws(4, full=200)
    alone = made(1, papers, USUAL, "html")
    assert alone[1] == 53
    assert made(8, papers, HASTY, "html") == alone


@pytest.mark.slow
def test_typesetting_in_threads_is_what_it_is_in_one():
    assert made(8, 6, HASTY, "html", "pdf") == made(1, 6, USUAL, "html", "pdf")


@pytest.mark.slow
def test_cold_starts_do_not_crash():
    alone = made(1, 4, USUAL, "html")
    starts = min(draws(1, full=20), 20)
    assert [made(4, 4, HASTY, "html") for _ in range(starts)] == [alone] * starts


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "outputs", "said"),
    [
        ("fork", ["html"], "same"),
        ("fork", ["pdf"], 'multiprocessing.get_context("spawn") or "forkserver"'),
        ("forkserver", ["html", "pdf"], "same"),
        ("spawn", ["html", "pdf"], "same"),
    ],
)
def test_processes_begun_after_a_pdf_make_the_same_or_say_how(method, outputs, said):
    if method not in multiprocessing.get_all_start_methods():
        pytest.skip(f"no {method} here")
    done = subprocess.run([sys.executable, BEGUN, method, *outputs], capture_output=True,
                          text=True, check=True, timeout=120)  # fmt: skip
    assert done.stdout.rstrip().endswith(said)
    assert done.stdout.count("\n") == 1
