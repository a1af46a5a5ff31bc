"""Gain of the ISO setting: twice the ISO, twice the signal, noise and all."""

from __future__ import annotations

from quizgen.camera.blocks import Work, times
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import Error, Facts
from quizgen.camera.settings import Setting, between
from quizgen.camera.values import number
from quizgen.camera.view import View

BASE_ISO = 100.0
ISO = Setting("iso", number, BASE_ISO, (between(1.0, 1e7),))
"""At ISO 100 a full well is white."""


def gain(view: View) -> float:
    """Factor between electrons and codes, 1 at ISO 100."""
    return view.camera[ISO] / BASE_ISO


def work(view: View, rung: str = "") -> Work:
    """Multiply what the photosites hold and the noise of reading them."""
    return times(gain(view))


def skipped(facts: Facts, view: View) -> Error:
    """Largest value times the missing factor."""
    return facts.amplified(abs(gain(view) - 1.0))


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Errors are amplified too."""
    return error.times(gain(view))


def after(facts: Facts, view: View) -> Facts:
    """Everything times the factor."""
    return facts.scaled(gain(view))


EFFECT = Effect(
    name="gain",
    stage="sensor",
    decides=("iso", "exposure", "noise", "snr"),
    settings=(ISO,),
    present=lambda view: gain(view) != 1.0,
    run=PointByPoint(work),
    cost=measured((0.0786, 18)),
    skipped=skipped,
    carried=carried,
    after=after,
)
