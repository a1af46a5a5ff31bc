"""Gain of the ISO setting: twice the ISO, twice the signal, noise and all."""

from __future__ import annotations

from collections.abc import Callable

from quizgen.camera.blocks import times
from quizgen.camera.effects.effect import Effect, PointByPoint, Size
from quizgen.camera.setup.settings import AnySetting, Setting, between
from quizgen.camera.setup.values import number
from quizgen.camera.view import View

BASE_ISO = 100.0
ISO = Setting("iso", number, BASE_ISO, (between(1.0, 1e7),))
"""At ISO 100 a full well is white."""


def gain(view: View) -> float:
    """Factor between electrons and codes, 1 at ISO 100."""
    return view.camera[ISO] / BASE_ISO


def amplifier(
    name: str,
    factor: Callable[[View], float],
    *,
    settings: tuple[AnySetting, ...],
    answers: tuple[str, ...],
) -> Effect:
    """An effect of the sensor that multiplies by a factor >= 0, absent where that is 1.

    Parameters
    ----------
    name : str
    factor : callable
        What a camera multiplies by.
    settings : tuple of Setting
        What the factor depends on.
    answers : tuple of str
        Kinds of question whose answer it is.
    """
    return Effect(
        name=name,
        stage="sensor",
        answers=answers,
        settings=settings,
        is_present=lambda view: factor(view) != 1.0,
        run=PointByPoint(lambda view: times(factor(view))),
        omission_bound=lambda signal, view: abs(factor(view) - 1.0) * signal.size,
        carry_error=lambda error, _, view: error * factor(view),
        range_after=lambda signal, view: signal.scaled(factor(view), factor(view)),
        size=Size(factor, "make the picture {:.3g} times as bright"),
        always="brightness",
    )


EFFECT = amplifier("gain", gain, settings=(ISO,), answers=("iso", "exposure", "noise", "snr"))
