"""How far a sweep goes: little by default, more with ``-m slow``, and all of it if one says so.

``QUIZGEN_SEEDS`` says how many draws, ``QUIZGEN_SWEEP=full`` takes every item of every list, and as many
draws as a sweep names for it.
"""

from __future__ import annotations

import functools
import inspect
import os
from collections.abc import Callable, Iterable
from typing import Any

import pytest

IS_FULL = os.environ.get("QUIZGEN_SWEEP") == "full"


def draws(usual: int, full: int | None = None) -> int:
    """Return how many draws a sweep takes: as many as CI does, ``full``, or ``QUIZGEN_SEEDS``."""
    return int(os.environ.get("QUIZGEN_SEEDS", full if IS_FULL and full else usual))


def spread(items: Iterable[Any], usual: int, slow: int | None = None) -> list[Any]:
    """Return the parameters of a sweep: ``usual`` of the items by default, the others slow.

    Those of the default are spread evenly, so that neighbours, which are much alike, take turns.
    With ``slow`` so many of the others, spread as well, are enough unless all are asked for.
    """
    every = list(items)
    chosen = _choose(len(every), usual)
    others = [place for place in range(len(every)) if place not in chosen]
    if slow is not None and not IS_FULL:
        others = [others[place] for place in sorted(_choose(len(others), slow))]
    return [
        every[place]
        if place in chosen
        else pytest.param(*_values(every[place]), marks=pytest.mark.slow)
        for place in sorted({*chosen, *others})
    ]


def sample(items: Iterable[Any], usual: int) -> list[Any]:
    """Return so many of the items, spread evenly; all of them where all are asked for."""
    every = list(items)
    return every if IS_FULL else [every[place] for place in sorted(_choose(len(every), usual))]


def _choose(count: int, wanted: int) -> set[int]:
    """Places spread evenly over so many."""
    return {place * count // wanted for place in range(wanted)}


def _values(item: Any) -> tuple[Any, ...]:
    return item if isinstance(item, tuple) else (item,)


CASES_OF_A_SLOW_TEST = 20
"""How many slow cases ``together`` makes one test of, so that all cores have their share."""


def together(names: str | tuple[str, ...], cases: Iterable[Any]) -> Callable[[Any], Any]:
    """Check many cases in one test: for those that differ in data alone and take no time.

    It is written as ``pytest.mark.parametrize`` is, and tells every case that fails. Each test
    costs pytest several milliseconds, more than most cases. What lasts as long as a test, such as
    ``tmp_path``, is the same for all cases.
    """
    listed = [name.strip() for name in names.split(",")] if isinstance(names, str) else [*names]
    usual, slow = [], []
    for case in cases:
        marked = isinstance(case, type(pytest.param()))
        values = case.values if marked else (case,) if len(listed) == 1 else tuple(case)
        (slow if marked and case.marks else usual).append(dict(zip(listed, values, strict=True)))
    groups = [pytest.param(usual, id=f"{len(usual)} cases")] if usual else []
    for first in range(0, len(slow), CASES_OF_A_SLOW_TEST):
        some = slow[first : first + CASES_OF_A_SLOW_TEST]
        groups.append(pytest.param(some, id=f"slow {first}", marks=pytest.mark.slow))
    several = f"cases_of_{listed[0]}"

    def decorate(check: Any) -> Any:
        @functools.wraps(check)
        def check_all(*own: Any, **given: Any) -> None:
            failures = []
            for case in given.pop(several):
                try:
                    check(*own, **case, **given)
                except Exception as failure:  # noqa: BLE001
                    failure.add_note(f"with {case}"[:500])
                    failures.append(failure)
            if len(failures) == 1:
                raise failures[0]
            if failures:
                raise ExceptionGroup(f"{len(failures)} cases fail", failures)

        signature = inspect.signature(check)
        kept = [one for name, one in signature.parameters.items() if name not in listed]
        kept.append(inspect.Parameter(several, inspect.Parameter.KEYWORD_ONLY))
        check_all.__signature__ = signature.replace(parameters=kept)
        return pytest.mark.parametrize(several, groups)(check_all)

    return decorate
