"""One scene clean, with Gaussian noise and with salt and pepper; detail and histogram below."""

from __future__ import annotations

from functools import cache, lru_cache
from itertools import permutations
from typing import TYPE_CHECKING, Any

from quizgen.figures.kit import Parameter, Values, format_given, load_alt_words, strip_mathtext

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.camera.setup.scene import Image

PARAMETERS = {
    "sigma": Parameter("1", "standard deviation of the Gaussian noise, 1 = white", 0.08, 0.01, 0.3),
    "p": Parameter("1", "share of the impulses, half black, half white", 0.08, 0.01, 0.5),
    "order": Parameter(
        "", "permutation of (clean, Gaussian, impulse) at 1 to 3", 0.0, 0.0, 5.0, whole=True
    ),
    "seed": Parameter("", "seed of both noises", 1.0, 0.0, 9999.0, whole=True),
}

KINDS = ("clean", "gaussian", "impulse")
BINS = 64
_PIXELS = (96, 72)
_DETAIL = (slice(26, 38), slice(30, 54))
_WIDE, _HIGH, _GAP = 92.0, 69.0, 18.0
_FOOT, _BARS, _BETWEEN, _ZOOM = 14.0, 42.0, 18.0, 46.0
SIZE = (3 * _WIDE + 2 * _GAP, _FOOT + _BARS + _BETWEEN + _ZOOM + 9 + _HIGH + 14)


def order_noises(order: float) -> tuple[str, ...]:
    """Which picture has number 1, 2 and 3.

    Parameters
    ----------
    order : float
        Index into the permutations of ``KINDS`` in lexicographic order of positions.
    """
    return list(permutations(KINDS))[int(order)]


@cache
def take_photo() -> Image:
    """Four flat greys, shape (72, 96, 3): noise shows in the histogram as what it does to each."""
    from quizgen.camera import Camera, Length, Scene, SceneObject, simulate_question
    from quizgen.camera.pixels.filters import numpy_only

    def grey(level: float) -> tuple[float, float, float]:
        return (level, level, level)

    things = (
        SceneObject("box", y=Length(24), width=Length(96), height=Length(26), colour=grey(0.25)),
        SceneObject("disc", x=Length(-18), y=Length(-3), radius=Length(20), colour=grey(0.42)),
        SceneObject("box", x=Length(24), y=Length(6), width=Length(26), height=Length(38),
              colour=grey(0.8)),
    )  # fmt: skip
    with numpy_only():
        return simulate_question(Scene(*_PIXELS, things, background=grey(0.6)), Camera()).values


@lru_cache(maxsize=32)
def _take_noisy(sigma: float, p: float, seed: int) -> dict[str, NDArray[np.uint8]]:
    from quizgen.camera import picture_sets
    from quizgen.figures.photographs import check_seen

    made = picture_sets.make_noisy(take_photo(), sigma, p, seed)
    photos = {
        kind: picture_sets.to_codes(one)[..., 0] for kind, one in zip(KINDS, made, strict=True)
    }
    for kind in KINDS[1:]:
        check_seen(photos[kind], photos["clean"], f"{kind} noise", speckles=True)
    return photos


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show numbers without the noise."""
    from quizgen.figures.photographs import place_photo, plot_histogram

    photos = _take_noisy(values["sigma"], values["p"], int(values["seed"]))
    art = fig.sketch()
    for place, kind in enumerate(order_noises(values["order"])):
        left, low, codes = place * (_WIDE + _GAP), _FOOT, photos[kind]
        plot_histogram(fig, codes, BINS, (left, low, _WIDE, _BARS))
        low += _BARS + _BETWEEN
        place_photo(fig, codes[_DETAIL], (left, low, _WIDE, _ZOOM))
        up = low + _ZOOM + 9
        told = "" if quiz else _write_noise(values, kind)
        box = (left, up, _WIDE, _HIGH)
        place_photo(fig, codes, box, number=place + 1, told=told)
        _frame_detail(art, box, low + _ZOOM)
    art.set_zorder(4)


def _frame_detail(art: Any, box: tuple[float, float, float, float], top: float) -> None:
    """Mark in a photograph what stands enlarged below it."""
    left, low, wide, high = box
    step = wide / _PIXELS[0]
    rows, columns = _DETAIL
    west, east = left + step * columns.start, left + step * columns.stop
    foot, head = low + high - step * rows.stop, low + high - step * rows.start
    art.area([(west, foot), (east, foot), (east, head), (west, head)], None, "red", 0.7,
             part="detail")  # fmt: skip
    for start, end in ((west, left), (east, left + wide)):
        art.line([(start, foot), (end, top)], "red", 0.5, part="detail")


def _write_noise(values: Values, kind: str) -> str:
    return {
        "clean": "$σ$ = 0, $p$ = 0",
        "gaussian": f"$σ$ = {format_given(values['sigma'])}",
        "impulse": f"$p$ = {format_given(values['p'])}",
    }[kind]


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, say what is seen, not which noise it is."""
    words = load_alt_words(__file__, lang)
    told = []
    for number, kind in enumerate(order_noises(values["order"]), 1):
        amount = strip_mathtext(_write_noise(values, kind))
        told.append(f"{number}: " + (words[f"{kind} seen"] if quiz else f"{words[kind]}, {amount}"))
    return words["figure"] + " " + "; ".join(told) + words["stop"]
