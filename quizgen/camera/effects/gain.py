"""Gain of the ISO setting: twice the ISO, twice the signal, noise and all."""

from __future__ import annotations

from collections.abc import Callable

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.tiles import multiply_by
from quizgen.camera.setup.settings import AnySetting, Setting, in_range
from quizgen.camera.setup.value_parsers import parse_plain_number
from quizgen.camera.setup.view import View

BASE_ISO = 100.0
ISO = Setting("iso", parse_plain_number, BASE_ISO, (in_range(1.0, 1e7),))
"""At ISO 100 a full well is white."""


def gain_factor(view: View) -> float:
    """Return the factor from electrons to codes, 1 at ISO 100."""
    return view.camera[ISO] / BASE_ISO


def make_gain_effect(
    name: str, factor: Callable[[View], float], settings: tuple[AnySetting, ...], *answers: str
) -> Effect:
    """Return an effect that multiplies by a factor >= 1 and is absent where that is 1.

    Parameters
    ----------
    name : str
    factor : callable
        What a camera multiplies by.
    settings : tuple of AnySetting
        What the factor depends on.
    *answers : str
        Kinds of question whose answer it is.
    """
    return Effect(
        name=name,
        answers=answers,
        settings=settings,
        is_present=lambda view: factor(view) != 1.0,
        run=PointByPoint(lambda view: multiply_by(factor(view))),
        omission_bound=lambda signal, view: abs(factor(view) - 1.0) * signal.size,
        carry_error=lambda error, _, view: error * factor(view),
        range_after=lambda signal, view: signal.scale_range(factor(view), factor(view)),
        size=EffectSize(factor, "make the picture {:.3g} times as bright"),
        always="brightness",
    )


EFFECT = make_gain_effect("gain", gain_factor, (ISO,), "iso", "exposure", "noise", "snr")
