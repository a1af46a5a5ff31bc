"""One scene clean, with Gaussian noise and with salt and pepper; detail and histogram below."""

from __future__ import annotations

from functools import cache
from itertools import permutations
from typing import TYPE_CHECKING

from quizgen.figures.kit import (
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Values,
    given,
    numbered,
    spoken,
    words_of,
)

if TYPE_CHECKING:
    from quizgen.camera.scene import Image

DARK = "keep"

PARAMETERS = {
    "sigma": Parameter("1", "standard deviation of the Gaussian noise, 1 = white", 0.08, 0.01, 0.3),
    "p": Parameter("1", "share of the impulses, half black, half white", 0.08, 0.01, 0.5),
    "order": Parameter(
        "", "permutation of (clean, Gaussian, impulse) at 1 to 3", 0.0, 0.0, 5.0, whole=True
    ),
    "seed": Parameter("", "seed of both noises", 1.0, 0.0, 9999.0, whole=True),
}

KINDS = ("clean", "gaussian", "impulse")
BINS = 52
_WIDE, _HIGH = 96, 72
_GAP, _CAPTION, _ZOOM, _HISTOGRAM, _TICKS = 6.0, 15.0, 48.0, 42.0, 13.0
_DETAIL = (slice(26, 38), slice(30, 54))


def noise_order(order: float) -> tuple[str, ...]:
    """Which picture has number 1, 2 and 3.

    Parameters
    ----------
    order : float
        Index into the permutations of ``KINDS`` in lexicographic order of positions.
    """
    return list(permutations(KINDS))[int(order)]


@cache
def scene() -> Image:
    """Four flat greys, shape (72, 96, 3): noise shows in the histogram as what it does to each."""
    from quizgen.camera import Camera, Length, Scene, Thing, simulate
    from quizgen.camera.filters import everywhere_alike

    def grey(level: float) -> tuple[float, float, float]:
        return (level, level, level)

    things = (
        Thing("box", y=Length(24), width=Length(96), height=Length(26), colour=grey(0.25)),
        Thing("disc", x=Length(-18), y=Length(-3), radius=Length(20), colour=grey(0.42)),
        Thing("box", x=Length(24), y=Length(6), width=Length(26), height=Length(38),
              colour=grey(0.8)),
    )  # fmt: skip
    with everywhere_alike():
        return simulate(Scene(_WIDE, _HIGH, things, background=grey(0.6)), Camera()).values


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show numbers without the noise."""
    from quizgen.camera import pictures

    wide = (WIDTH - 4 * _GAP) / 3
    high = wide * _HIGH / _WIDE
    pen = Pen(WIDTH, _TICKS + _HISTOGRAM + _ZOOM + high + 2 * _GAP + _CAPTION + 2)
    made = pictures.noisy(scene(), values["sigma"], values["p"], int(values["seed"]))
    for place, kind in enumerate(noise_order(values["order"])):
        left = _GAP + place * (wide + _GAP)
        _column(canvas, pen, made[KINDS.index(kind)], (left, wide, high))
        text = numbered(place + 1, _symbols(values, kind), quiz=quiz)
        pen.label((left + wide / 2, pen.height - 8), text, size=9.5)
    pen.onto(canvas, background="#ffffff")


def _column(canvas: Canvas, pen: Pen, image: Image, where: tuple[float, float, float]) -> None:
    from quizgen.camera import pictures
    from quizgen.figures.photographs import histogram, place

    left, wide, high = where
    codes = pictures.codes(image)[..., 0]
    low = _TICKS + _HISTOGRAM + _GAP
    place(canvas, pen, codes[_DETAIL].repeat(4, axis=0).repeat(4, axis=1), (left, low, wide, _ZOOM))
    place(canvas, pen, codes, (left, low + _ZOOM + _GAP, wide, high))
    histogram(pen, codes, BINS, (left, _TICKS, wide, _HISTOGRAM))


def _symbols(values: Values, kind: str) -> str:
    return {
        "clean": "σ = 0, p = 0",
        "gaussian": f"σ = {given(values['sigma'])}",
        "impulse": f"p = {given(values['p'])}",
    }[kind]


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, say what is seen, not which noise it is."""
    words = words_of(__file__, lang)
    told = []
    for number, kind in enumerate(noise_order(values["order"]), 1):
        seen = words[f"{kind} seen"] if quiz else f"{words[kind]}, {spoken(_symbols(values, kind))}"
        told.append(f"{number}: {seen}")
    return words["figure"] + " " + "; ".join(told) + words["stop"]
