"""What an effect is: one function, and what the planner may know about it."""

# ruff: noqa: ARG001 - every effect and every bound takes the same arguments

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from quizgen.camera.facts import NO_ERROR, Error, Facts
from quizgen.camera.scene import View

Bound = Callable[[Facts, View], Error]


def _anything(facts: Facts, view: View) -> Error:
    """Nothing is known: skipping may change everything."""
    return Error(float("inf"))


def same_error(error: Error, facts: Facts, view: View) -> Error:
    """Differences pass through unchanged (averages, shifts, additions)."""
    return error


def same_facts(facts: Facts, view: View) -> Facts:
    """The picture's range and steps do not grow."""
    return facts


def no_bound(facts: Facts, view: View) -> Error:
    """Absent: nothing to lose."""
    return NO_ERROR


@dataclass(frozen=True, slots=True)
class Rung:
    """A cheaper way to compute an effect: its name and how far it is from the exact way."""

    name: str
    error: Bound


@dataclass(frozen=True, slots=True)
class Effect:
    """One row of the table of effects.

    Parameters
    ----------
    name : str
    stage : str
        ``optics`` works on the stack of layers, the others on one picture.
    decides : tuple of str
        Kinds of question whose answer is this effect.
    present : callable
        Whether the camera's parameters differ from the identity.
    run : callable
        ``run(state, view, rung) -> state``.
    skipped : callable
        Error of leaving it out, from the facts of its input (1 = white).
    carried : callable
        What becomes of an error that is already there.
    after : callable
        Facts of the output.
    cheaper : tuple of Rung
        From dear to cheap.
    pair : str
        Effects with the same pair run together or not at all.
    """

    name: str
    stage: str
    decides: tuple[str, ...]
    present: Callable[[View], bool]
    run: Callable[[Any, View, str], Any]
    skipped: Bound = _anything
    carried: Callable[[Error, Facts, View], Error] = same_error
    after: Callable[[Facts, View], Facts] = same_facts
    cheaper: tuple[Rung, ...] = ()
    pair: str = ""


def stream(view: View, effect: str) -> np.random.Generator:
    """Random numbers of one effect: SFC64 from the scene's seed and the effect's name.

    Adding, skipping or reordering other effects changes nothing here.
    """
    words = np.frombuffer(effect.encode().ljust(32, b"\0")[:32], "<u4")
    seeds = np.random.SeedSequence([view.scene.seed, *(int(word) for word in words)])
    return np.random.Generator(np.random.SFC64(seeds))
