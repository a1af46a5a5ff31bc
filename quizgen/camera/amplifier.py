"""Effects that multiply the whole picture by one factor: signal, noise and errors alike."""

from __future__ import annotations

from collections.abc import Callable

from quizgen.camera.blocks import times
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.settings import AnySetting
from quizgen.camera.view import View


def amplifier(
    name: str,
    factor: Callable[[View], float],
    *,
    settings: tuple[AnySetting, ...],
    decides: tuple[str, ...],
) -> Effect:
    """An effect of the sensor that multiplies by a factor >= 0, absent where that is 1.

    Parameters
    ----------
    name : str
    factor : callable
        What a camera multiplies by.
    settings : tuple of Setting
        What the factor depends on.
    decides : tuple of str
        Kinds of question whose answer it is.
    """
    return Effect(
        name=name,
        stage="sensor",
        decides=decides,
        settings=settings,
        present=lambda view: factor(view) != 1.0,
        run=PointByPoint(lambda view, _: times(factor(view))),
        cost=measured((0.0786, 18)),
        skipped=lambda facts, view: facts.amplified(abs(factor(view) - 1.0)),
        carried=lambda error, _, view: error.amplified(factor(view), factor(view)),
        knows_where=True,
        after=lambda facts, view: facts.scaled(factor(view)),
    )
