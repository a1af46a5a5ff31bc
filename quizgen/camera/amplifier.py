"""Effects that multiply the whole picture by one factor: signal, noise and errors alike."""

from __future__ import annotations

from collections.abc import Callable

from quizgen.camera.blocks import times
from quizgen.camera.effect import Effect, PointByPoint, Size
from quizgen.camera.settings import AnySetting
from quizgen.camera.view import View


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
