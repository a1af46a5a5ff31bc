"""Photographs for questions: what is asked can be seen, and what is read off is right.

Nothing is believed that can be measured: the photograph is taken with and without what is asked,
and where something else runs, with and without that. A picture that does not show what it asks
about is an error that says by how much it fails.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Collection, Hashable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from quizgen.camera import effects
from quizgen.camera.camera import Camera
from quizgen.camera.pixels.codes import GREY_LEVELS, MEASURES
from quizgen.camera.pixels.filters import load_opencv
from quizgen.camera.pixels.tiles import split_range
from quizgen.camera.planner import (
    NO_SELECTION,
    EffectSelection,
    Plan,
    PreparedScene,
    describe_size,
    plan_budget,
    plan_question,
)
from quizgen.camera.setup.scene import Image, PictureQuestion, Reading, Scene, SceneError
from quizgen.camera.setup.view import View
from quizgen.camera.simulation import Photo, ignore_progress, run_plan
from quizgen.core.untrusted import error_context

LEAST_LEVELS = 8.0
"""Grey levels from which on two pictures beside each other are seen to differ at a place."""
LEAST_SHARE = 1e-3
"""Share of the pixels that must differ so much: 14 of 144 x 96."""
LEAST_SPREAD = 2.0
"""Grey levels (root mean square) from which on noise is seen."""
LEAST_SPECKS = 4, 32.0
"""Single pixels, and their grey levels, that are seen however little they spread all."""

# Rec. 601, by which PDF and printers turn colours to grey (ISO 32000-1, 10.3.3).
_LUMA = np.array([0.3, 0.59, 0.11], np.float32)


class InvisibleEffectError(SceneError):
    """Raised if what a picture is asked about cannot be seen in it."""


class MovedReadingError(SceneError):
    """Raised if a value read off a picture is not the key's, or another effect moves it."""


@dataclass(frozen=True)
class Visibility:
    """How an effect shows in a picture, measured against the same picture without it.

    Parameters
    ----------
    kind : str
        What is asked, or the effect.
    levels : float
        Largest difference of any channel, in grey levels.
    share : float
        Of the pixels, where it is at least `LEAST_LEVELS`.
    mean : float
        Mean difference there, in grey levels.
    spread : float
        Root mean square of the differences of all pixels, in grey levels.
    says : tuple of str
        What the effects do in their own terms.
    too_small : str
        Why its own measure is too small; empty where it is large enough.
    speckles : bool
        Whether it is seen by the spread of single pixels.
    specks : int
        Pixels that differ by the grey levels of `LEAST_SPECKS`.
    grey : Visibility or None
        The same in a greyscale print.
    """

    kind: str
    levels: float
    share: float
    mean: float
    spread: float
    says: tuple[str, ...] = ()
    too_small: str = ""
    speckles: bool = False
    specks: int = 0
    grey: Visibility | None = None

    @property
    def is_visible(self) -> bool:
        """Whether somebody who looks at both pictures sees the difference."""
        if self.too_small:
            return False
        if self.speckles and (self.spread >= LEAST_SPREAD or self.specks >= LEAST_SPECKS[0]):
            return True
        return self.share >= LEAST_SHARE

    @property
    def needs_colour(self) -> bool:
        """Whether it is seen in colour but not in a greyscale print."""
        return self.is_visible and self.grey is not None and not self.grey.is_visible

    def explain(self) -> str:
        """Return one sentence: what the effects do, then how far the two pictures differ."""
        does = " and ".join(says.replace(" ", "s ", 1) for says in self.says)  # blur: it blurs
        does += "; " if does else ""
        if self.too_small:
            return f"{does}{self.too_small}"
        if self.speckles:
            return f"{does}spreads grey levels by {self.spread:.2g}"
        if self.share:
            percent = 100.0 * self.share
            share = f"{percent:.{2 if percent < 99.5 else 3}g} % of the pixels"
            return f"{does}changes {share} by {self.mean:.0f} grey levels"
        return f"{does}changes no pixel by more than {self.levels:.2g} grey levels"


@dataclass(frozen=True)
class QuestionPhoto:
    """A photograph that was measured to show what is asked.

    Parameters
    ----------
    photo : Photo
    plan : Plan
        What ran, what was left out and why.
    seen : tuple of Visibility
        Of every kind that is asked.
    readings : dict of str to float
        What was read off the picture.
    take_without : callable
        Takes the same photograph without what is asked.
    """

    photo: Photo
    plan: Plan
    seen: tuple[Visibility, ...]
    readings: dict[str, float]
    take_without: Callable[[], Photo]

    @cached_property
    def without(self) -> Photo:
        """The same photograph without the effects that are asked about."""
        return self.take_without()

    @property
    def needs_colour(self) -> bool:
        """Whether something that is asked is not seen in a greyscale print."""
        return any(one.needs_colour for one in self.seen)


def measure_visibility(
    shown: Image | NDArray[np.uint8], plain: Image | NDArray[np.uint8], kind: str = "", *,
    speckles: bool = False,
) -> Visibility:  # fmt: skip
    """Return how two pictures differ, in colour and in grey.

    Parameters
    ----------
    shown, plain : numpy.ndarray
        Shape (H, W), (H, W, 1) or (H, W, 3): values (1 = white), or 8-bit codes.
    kind : str
        What is asked.
    speckles : bool
        Whether noise is looked for.
    """
    found, gray = _Differences(), _Differences()
    for start, stop in split_range(len(shown), _ROWS):
        apart = _to_grey_levels(shown[start:stop]) - _to_grey_levels(plain[start:stop])
        found.add(np.abs(apart))
        if apart.shape[2] > 1:
            gray.add(np.abs(apart @ _LUMA)[..., None])
    seen = found.summarise(kind, speckles)
    return replace(seen, grey=gray.summarise(kind, speckles) if gray.count else seen)


_ROWS, _MEGAPIXEL = 64, 1e6
"""Rows looked at at once, so that large pictures are not held twice."""


def _to_grey_levels(image: Image | NDArray[np.uint8]) -> NDArray[np.floating]:
    """Return a picture in grey levels, shape (H, W, 1) or (H, W, 3), from values or 8-bit codes."""
    levels = np.asarray(image, np.float32)
    levels = levels if image.dtype == np.uint8 else np.clip(levels * GREY_LEVELS, 0.0, GREY_LEVELS)
    return levels.reshape(*levels.shape[:2], -1)


class _Differences:
    """Running sums over the differences of two pictures, added band by band."""

    def __init__(self) -> None:
        self.count = self.there = self.specks = 0
        self.most = self.sum = self.squares = 0.0

    def add(self, apart: NDArray[np.float64]) -> None:
        """Add the differences of some pixels, in grey levels."""
        most = np.maximum.reduce([apart[..., place] for place in range(apart.shape[2])])
        there = most[most >= LEAST_LEVELS]
        self.count += most.size
        self.there += there.size
        self.specks += int((there >= LEAST_SPECKS[1]).sum())
        self.most = max(self.most, float(most.max()))
        self.sum += float(there.sum())
        self.squares += float(np.square(apart).mean()) * most.size

    def summarise(self, kind: str, speckles: bool) -> Visibility:
        """Return the measured visibility of all pixels added."""
        mean, spread = self.sum / max(self.there, 1), math.sqrt(self.squares / self.count)
        share = self.there / self.count
        return Visibility(
            kind, self.most, share, mean, spread, speckles=speckles, specks=self.specks
        )


def check_visible(seen: Visibility, *, grey: bool = False) -> None:
    """Raise an error if a measured effect cannot be seen.

    Parameters
    ----------
    seen : Visibility
    grey : bool
        Whether it must be seen in a greyscale print, too.

    Raises
    ------
    InvisibleEffectError
        With what it does, and how little of that is seen.
    """
    if not seen.is_visible:
        what = f"{seen.kind} cannot be seen: {seen.explain()}"
        raise InvisibleEffectError(what, rule="QG146")
    if grey and seen.needs_colour and seen.grey is not None:
        what = f"{seen.kind} cannot be seen in grey: {seen.grey.explain()}"
        raise InvisibleEffectError(what, rule="QG146")


def photograph_question(  # noqa: PLR0913 - figures, page and terminal need some each
    scene: Scene,
    camera: Camera,
    asks: str | Iterable[str] = (),
    reads: Mapping[str, Reading] | None = None,
    *,
    grey: bool = False,
    chosen: EffectSelection = NO_SELECTION,
    on_effect: Callable[[str], None] = ignore_progress,
) -> QuestionPhoto:
    """Return a photograph for a question, measured to show what is asked.

    Pictures of scenes that are drawn are kept, the last 64 of them.

    Parameters
    ----------
    scene : Scene
    camera : Camera
    asks : str or iterable of str
        Kinds of question (`quizgen.camera.effects.question_kinds`); by default the scene's own.
    reads : mapping of str to Reading, optional
        What is read off the picture; by default the scene's own.
    grey : bool
        Whether what is asked must also be seen in a greyscale print.
    chosen : EffectSelection
        Effects that are chosen by name.
    on_effect : callable
        Gets the names of effects before they run.

    Raises
    ------
    InvisibleEffectError
        If what is asked cannot be seen.
    MovedReadingError
        If another effect moves what is read by more than its tolerance, or it is not the value
        that it should have.
    """
    with error_context(scene.file):
        taken = take_question_photo(scene, camera, asks, reads, chosen=chosen, on_effect=on_effect)
        for seen in taken.seen:
            check_visible(seen, grey=grey)
    return taken


def take_question_photo(
    scene: Scene,
    camera: Camera,
    asks: str | Iterable[str] = (),
    reads: Mapping[str, Reading] | None = None,
    *,
    chosen: EffectSelection = NO_SELECTION,
    on_effect: Callable[[str], None] = ignore_progress,
) -> QuestionPhoto:
    """Return what `photograph_question` does, but do not refuse what cannot be seen.

    Parameters
    ----------
    scene, camera, asks, reads, chosen, on_effect
        As for `photograph_question`.
    """
    own = scene.question or PictureQuestion(())
    kinds = (asks,) if isinstance(asks, str) else tuple(asks)
    asked = PictureQuestion(kinds or own.asks, own.reads if reads is None else reads)
    key = _find_key(scene, camera, asked, chosen)
    if key is None:
        return _take_photo(scene, camera, asked, chosen, on_effect)
    if key not in _KEPT:
        _KEPT[key] = _take_photo(scene, camera, asked, chosen, on_effect)
        while len(_KEPT) > _MOST_KEPT:
            _KEPT.popitem(last=False)
    return _KEPT[key]


_KEPT: OrderedDict[Hashable, QuestionPhoto] = OrderedDict()
_MOST_KEPT, _MOST_PIXELS = 64, 1 << 16


def _find_key(
    scene: Scene, camera: Camera, asked: PictureQuestion, chosen: EffectSelection
) -> Hashable | None:
    """Return what a picture is cached under; None if it is large or from a file."""
    if scene.image is not None or scene.width * scene.height > _MOST_PIXELS:
        return None
    drawn = scene.things, scene.background, scene.background_depth, scene.width, scene.height
    rest = scene.seed, scene.precision, load_opencv() is None
    return drawn, rest, camera, asked.asks, tuple(asked.reads.items()), chosen


def _take_photo(
    scene: Scene,
    camera: Camera,
    asked: PictureQuestion,
    chosen: EffectSelection,
    on_effect: Callable[[str], None],
) -> QuestionPhoto:
    """Return the photograph of a question, measured against the one without what is asked."""
    whole = PreparedScene(scene, camera)
    plan = plan_question(whole, asked.asks, chosen)
    prepared = PreparedScene(scene, camera, plan.names)
    large = scene.width * scene.height > 2 * _MEGAPIXEL  # layers are let go and drawn again

    def run_without(names: Collection[str]) -> Photo:
        """Return the photograph without some effects."""
        rest = [name for name in plan.names if name not in names]
        again = PreparedScene(scene, camera, plan.names) if large else prepared
        return run_plan(again, rest, on_effect, last=large)

    groups = _group_asked(plan, asked.asks, chosen)
    plain = {kind: run_without(names) for kind, names in groups.items()} if not large else {}
    thin = {kind: _subsample(run_without(names).values) for kind, names in groups.items() if large}
    photo = run_plan(prepared, on_effect=on_effect, last=large and not asked.reads)
    readings = {}
    for name, reading in asked.reads.items():
        if added := _find_needed(whole, plan, photo, reading):
            return _take_photo(
                scene, camera, asked, replace(chosen, plus=(*chosen.plus, added)), on_effect
            )
        readings[name] = _check_reading(prepared, plan, photo, name, reading)
    shown, seen = _subsample(photo.values), []
    for kind, names in groups.items():
        other = thin[kind] if large else _subsample(plain[kind].values)
        seen.append(_measure_kind(kind, names, prepared.view, shown, other))
    alone = plain[next(iter(plain))] if len(plain) == 1 else None
    return QuestionPhoto(
        photo, plan, tuple(seen), readings, lambda: alone or run_without(plan.asked)
    )


def _subsample(values: Image) -> Image:
    """Return about a megapixel of a picture, which tells as much as all of a large one."""
    every = max(1, round(math.sqrt(values.shape[0] * values.shape[1] / _MEGAPIXEL)))
    return values[::every, ::every].copy() if every > 1 else values


def _group_asked(
    plan: Plan, kinds: tuple[str, ...], chosen: EffectSelection
) -> dict[str, tuple[str, ...]]:
    """Return the effects that answer each kind of question; one chosen by name is its own kind."""
    if chosen.only:
        return {name: (name,) for name in plan.asked}
    answers = {name: effects.get_effect(name).answers for name in plan.asked}
    return {kind: tuple(name for name in answers if kind in answers[name]) for kind in kinds}


def _measure_kind(
    kind: str, names: Collection[str], view: View, shown: Image, plain: Image
) -> Visibility:
    """Return the visibility of one kind of question: shown with, plain without its effects."""
    asked = [effects.get_effect(name) for name in names]
    says = tuple(filter(None, (describe_size(one, view) for one in asked)))
    small = [one.size for one in asked if one.size and one.size.of(view) < one.size.least]
    too_small = f"{small[0].least:g} would be seen" if small and len(small) == len(asked) else ""
    speckles = all(one.speckles for one in asked)
    seen = measure_visibility(shown, plain, kind, speckles=speckles)
    grey = None if seen.grey is None else replace(seen.grey, too_small=too_small, says=says)
    return replace(seen, says=says, too_small=too_small, grey=grey)


# What is read off a picture


def read_value(image: Image, reading: Reading) -> float:
    """Return the value that a measure reads off a finished picture."""
    levels, measure = _to_grey_levels(image), reading.measure
    levels = np.broadcast_to(levels, (*levels.shape[:2], 3))
    if isinstance(measure, str):
        return MEASURES[measure](levels)
    return float(measure(levels))


def _find_needed(whole: PreparedScene, plan: Plan, photo: Photo, reading: Reading) -> str:
    """Return the name of an effect left out without which a reading is wrong, or ""."""
    if _is_right(photo, reading):
        return ""
    others = (choice.effect for choice in plan.left_out if choice.why == "not asked")
    right = (one for one in others if _is_right(run_plan(whole, (*plan.names, one)), reading))
    return next(right, "")


def _is_right(photo: Photo, reading: Reading) -> bool:
    """Return whether what is read off a photograph is within the tolerance of its value."""
    value = reading.value
    return value is None or abs(read_value(photo.values, reading) - value) <= reading.tolerance


def _check_reading(
    prepared: PreparedScene, plan: Plan, photo: Photo, name: str, reading: Reading
) -> float:
    """Return what is read off a photograph.

    Raises `MovedReadingError` if it is wrong, or moved by an effect that is not asked about.
    """
    value = read_value(photo.values, reading)
    if not _is_right(photo, reading):
        raise MovedReadingError(
            f"{name} is read as {value:.4g}, not as {reading.value:.4g} ± {reading.tolerance:g}"
        )
    for step in plan.steps:
        if step.why != "wanted" or reading.value is not None:
            continue
        others = [other for other in plan.names if other != step.effect]
        moved = abs(read_value(run_plan(prepared, others).values, reading) - value)
        if moved > reading.tolerance:
            raise MovedReadingError(
                f"{step.effect} moves {name} by {moved:.3g}, more than {reading.tolerance:g}"
            )
    return value


# Without a question


def simulate_question(scene: Scene, camera: Camera, budget: str | float = 0.5) -> Photo:
    """Return a photograph without the effects that no value shows by more than a budget.

    Parameters
    ----------
    scene : Scene
    camera : Camera
    budget : float or str
        Grey levels, see `quizgen.camera.planner.plan_budget`.
    """
    prepared = PreparedScene(scene, camera)
    return run_plan(prepared, plan_budget(prepared, budget).names, last=True)
