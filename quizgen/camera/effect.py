"""What an effect is: one module with its settings, its work, its bound and its cost."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import msgspec

from quizgen.camera.blocks import Work, in_turn
from quizgen.camera.draw import Layer, Stack, composite
from quizgen.camera.facts import NO_ERROR, Error, Facts
from quizgen.camera.scene import Image, Scene
from quizgen.camera.settings import AnySetting
from quizgen.camera.view import View

Stage = Literal["scene", "optics", "sensor", "processing", "edit"]
Run = Callable[[Stack, View, str], Stack]
Bound = Callable[[Facts, View], Error]
Carry = Callable[[Error, Facts, View], Error]
After = Callable[[Facts, View], Facts]
Cost = Callable[[View, str, bool], float]
Check = Callable[[View], None]
Has = Callable[[View], bool]
Outside = Callable[[View], tuple[float, float]]


def _anything(facts: Facts, view: View) -> Error:
    """Nothing is known: skipping may change everything."""
    return Error(float("inf"))


def _possible(view: View) -> None:
    """Nothing can be wrong with it."""


def same_error(error: Error, facts: Facts, view: View) -> Error:
    """Differences pass through unchanged (averages, shifts, additions)."""
    return error


def same_facts(facts: Facts, view: View) -> Facts:
    """The picture's range and steps do not grow."""
    return facts


def no_bound(facts: Facts, view: View) -> Error:
    """Nothing to lose."""
    return NO_ERROR


def nothing_outside(view: View) -> tuple[float, float]:
    """Every pixel comes from inside the picture."""
    return 0.0, 0.0


def same_stack(stack: Stack, view: View, rung: str) -> Stack:
    """Nothing is left to do once the scene is drawn."""
    return stack


def on_picture(work: Callable[[Image, View, str], Image]) -> Run:
    """Work on one picture: the layers are laid over each other first."""

    def run(stack: Stack, view: View, rung: str) -> Stack:
        return (Layer(work(composite(stack), view, rung)),)

    return run


class LayerByLayer(msgspec.Struct, frozen=True):
    """A run that takes averages of each layer's values, and looks at no other layer.

    Such effects in a row are finished for one layer before the next is looked at, and an even
    layer, whose averages are all the same, is left as it is.

    Parameters
    ----------
    work : callable
        ``work(layer, view, rung)`` gives the layer afterwards.
    """

    work: Callable[[Layer, View, str], Layer]

    def __call__(self, stack: Stack, view: View, rung: str = "") -> Stack:
        """Run it alone."""
        return tuple(self.work(layer, view, rung) for layer in stack)


class PointByPoint(msgspec.Struct, frozen=True):
    """A run in which every value depends on its own pixel alone.

    Such effects in a row share one pass over the picture.

    Parameters
    ----------
    work : callable
        ``work(view, rung)`` gives what changes a piece in place, see `quizgen.camera.blocks`.
    """

    work: Callable[[View, str], Work]

    def __call__(self, stack: Stack, view: View, rung: str = "") -> Stack:
        """Run it alone."""
        return (Layer(in_turn(composite(stack), [self.work(view, rung)])[0]),)


class Rung(msgspec.Struct, frozen=True):
    """A cheaper way to compute an effect: its name and how far it is from the exact way."""

    name: str
    error: Bound


class Effect(msgspec.Struct, frozen=True, kw_only=True):
    """All that the camera knows of an effect.

    Parameters
    ----------
    name : str
        The field's term; the module is called so too, and the stream of its random numbers.
    stage : str
        Up to ``optics`` layers are kept apart; what a ``sensor`` limit never meets costs nothing.
    decides : tuple of str
        Kinds of question whose answer is this effect.
    settings : tuple of Setting
        Keys of ``[camera]`` that belong to it alone.
    present : callable
        Whether the camera's settings differ from the identity.
    run : callable
        ``run(stack, view, rung) -> stack``; see `on_picture` and `PointByPoint`.
    cost : callable
        ``cost(view, rung, opencv_used)``, predicted time in ms of a view in px.
    skipped : callable
        Error of leaving it out, from the facts of its input (1 = white). By default anything, so
        that it is never skipped.
    carried : callable
        What becomes of an error that is already there.
    knows_where : bool
        Whether ``carried`` says what becomes of errors beyond 0 and 1 and of those in the light
        alone; otherwise they count as if they were everywhere.
    after : callable
        Facts of the output.
    rungs : tuple of Rung
        Cheaper ways, from dear to cheap.
    pair : str
        Effects with the same pair run together or not at all.
    random : bool
        Whether it draws random numbers.
    outside : callable
        How far outside a view the light of its pixels can come from, across and down, px.
    looks : int, optional
        How far around a pixel everything lies that its value is made of, px, where that is known
        of an effect that does not go point by point.
    check : callable
        Raises `SceneError` if it cannot be computed for a camera before a picture of this size.
    prepare : callable, optional
        ``prepare(scene, view) -> scene``, before anything is drawn.
    reason : str
        Why it runs whatever the budget; empty where the budget decides.
    needs : str
        What its settings do nothing without.
    """

    name: str
    stage: Stage
    decides: tuple[str, ...]
    settings: tuple[AnySetting, ...] = ()
    present: Has
    run: Run
    cost: Cost
    skipped: Bound = _anything
    carried: Carry = same_error
    knows_where: bool = False
    after: After = same_facts
    rungs: tuple[Rung, ...] = ()
    pair: str = ""
    random: bool = False
    outside: Outside = nothing_outside
    looks: int | None = None
    check: Check = _possible
    prepare: Callable[[Scene, View], Scene] | None = None
    reason: str = ""
    needs: str = ""

    @property
    def around(self) -> int | None:
        """How far around a pixel it looks, px; None where that may be anywhere."""
        return 0 if isinstance(self.run, PointByPoint) else self.looks
