"""Questions that a figure answers: curves are read off the drawing, pictures are measured."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from fractions import Fraction
from itertools import permutations
from typing import Any

import numpy as np
from by_hand import solves
from matplotlib.colors import rgb_to_hsv
from numpy.typing import NDArray
from printed_figure import Line, lines, pictures, ticks
from printed_numbers import APERTURE, numbers, points
from printed_page import Page

Curve = Callable[[Fraction], float]
FIRST_TICK, TICK = 400, 50
"""Wavelengths in nm that stand below the axis, as outlines of digits; heights go from 0 to 1."""


def curve(page: Page, name: str) -> Curve:
    """A curve over wavelengths, read off the drawing with its ticks for a scale."""
    across, up = ticks(page.drawing)
    xs, ys = zip(*lines(page.drawing, name)[0], strict=True)

    def height(light: Fraction) -> float:
        steps = (float(light * 10**9) - FIRST_TICK) / TICK
        x = across[0] + steps * (across[1] - across[0])
        return (float(np.interp(x, xs, ys)) - up[0]) / (up[-1] - up[0])

    return height


def for_the_dark(text: str) -> bool:
    """Whether an eye used to the dark is asked about."""
    return any(word in text for word in ("dark", "অন্ধকারে"))


@solves("two-lasers-from-curves", figure=True)
def lasers_on_curves(page: Page) -> dict[str, Any]:
    """Notes 2.6: the solid curve by day, the dashed one by night."""
    night = for_the_dark(page.parts["a"].text)
    seen = curve(page, "night" if night else "day")
    beam = ("first", "প্রথম") if seen(page["λ_1"]) > seen(page["λ_2"]) else ("second", "দ্বিতীয়")
    told = ("dashed", "ভাঙা") if night else ("solid", "টানা")
    return {"a": page.parts["a"].saying(*beam), "b": page.parts["b"].saying(*told)}


@solves("two-lamps-by-day-and-by-night", figure=True)
def lamps_at_dusk(page: Page) -> dict[str, Any]:
    """Notes 2.6 and 4.9, F03: V by day, V' by night; the ratio of fluxes decides."""
    lights = page["λ_1"], page["λ_2"]
    heights = [curve(page, name)(light) for name in ("day", "night") for light in lights]
    power = float(page["P_1"] / page["P_2"])
    day, night = power * heights[0] / heights[1], power * heights[2] / heights[3]
    told = {(True, True): ("lamp 1, by day", "দুই সময়েই বাতি 1"), (True, False): ("1 by day", "দিনে বাতি 1"),
            (False, True): ("2 by day", "দিনে বাতি 2"), (False, False): ("lamp 2, by day", "দুই সময়েই বাতি 2")}  # fmt: skip
    said = page.parts["c"].saying(*told[day > 1, night > 1])
    return {"a": tuple(heights), "b": (day, night), "c": said}


@solves("power-for-equal-brightness", figure=True)
def equal_brightness(page: Page) -> dict[str, Any]:
    """Notes 4.9, F03: K_m P V by day, K'_m P V' by night."""
    night = for_the_dark(page.stem.rpartition("mW")[2])
    seen, constant = curve(page, "night" if night else "day"), page["K'_m" if night else "K_m"]
    first, second, third = (seen(page[name]) for name in ("λ_1", "λ_2", "λ_3"))
    grid = [Fraction(nm, 10**9) for nm in range(380, 781)]
    peak = max(grid, key=seen)
    beyond = [light for light in grid if (light > peak) != (page["λ_3"] > peak)]
    alike = min(beyond, key=lambda light: abs(seen(light) - third))
    return {"a": float(constant * page["P_1"]) * first, "b": float(page["P_1"]) * first / second,
            "c": alike}  # fmt: skip


@solves("recognise-and-sketch-distortion", figure=True)
def grid(page: Page) -> dict[str, Any]:
    """Notes 4.5: whether a corner moves in or out against the middle of an edge."""
    before, after = (lines(page.drawing, name)[0] for name in ("undistorted", "distorted"))
    cross = [place for line in lines(page.drawing, "principal-point") for place in line]
    centre = tuple(sum(way) / len(cross) for way in zip(*cross, strict=True))

    def drawn_out(line: Line) -> float:
        """How far a corner lies off against the middle of its upright edge."""
        xs, ys = zip(*sorted(line, key=lambda place: place[1]), strict=True)
        middle = float(np.interp(centre[1], ys, xs)), centre[1]
        return math.dist(line[0], centre) / math.dist(middle, centre)

    bend = drawn_out(after) / drawn_out(before)
    words = (("none;", "কোনো") if abs(bend - 1) < 0.002 else ("barrel",) if bend < 1
             else ("pincushion",))  # fmt: skip
    inward = any(name in page.parts["b"].text for name in ("barrel",))
    camera = ("fisheye",) if inward else ("telephoto",)
    return {
        "a": page.parts["a"].saying(*words),
        "b": _sketched(-0.15 if inward else 0.15),
        "c": page.parts["c"].saying(*camera),
    }


@solves("sketch-barrel-or-pincushion")
def square(page: Page) -> dict[str, Any]:
    """F22: a point moves to 1 + k r² times its distance; telephoto lenses have k > 0."""
    words = ("pushes points away", "telephoto", "bow inward", "বাইরে ঠেলে", "ভেতরের দিকে")
    outward = page.says(*words) or re.search(r"k_?1 ?> ?0", page.text) is not None
    return {"a": _sketched(0.15 if outward else -0.15)[:4]}


def _sketched(k: float) -> list[Line]:
    """A square of sides 2 and the lines through its middle, points moved as F22 says."""
    sides = [[(t / 4, 1) for t in range(-4, 5)], [(t / 4, -1) for t in range(-4, 5)],
             [(-1, t / 4) for t in range(-4, 5)], [(1, t / 4) for t in range(-4, 5)],
             [(-1, 0), (1, 0)], [(0, -1), (0, 1)]]  # fmt: skip
    return [[(x * (1 + k * (x * x + y * y)), y * (1 + k * (x * x + y * y))) for x, y in side]
            for side in sides]  # fmt: skip


@solves("normalisation-from-histograms", figure=True)
def two_histograms(page: Page) -> dict[str, Any]:
    """Notes 4.3, F12 and F13: what is clamped stands up at an end of the axis."""
    at = [line[0][0] for line in lines(page.drawing, "ticks")]
    left, right = at[len(at) // 2], at[-1]
    outline = [
        place
        for line in lines(page.drawing, "histogram")
        for place in line
        if left <= place[0] <= right
    ]
    floor = min(y for _, y in outline)
    filled = [(x - left) / (right - left) for x, y in outline if y > floor + 0.5]
    inner = max(y for x, y in outline if 0.1 < (x - left) / (right - left) < 0.9)
    low, high = (any(y > 1.15 * inner + -0.15 * floor and near(x) for x, y in outline)
                 for near in (lambda x: x < left + 5, lambda x: x > right - 5))  # fmt: skip
    if low or high:
        words = (("narrow", "সরু") if low and high else ("I_min too large", "I_min খুব বড়") if low
                 else ("I_max too small", "I_max খুব ছোট"))  # fmt: skip
    else:
        words = ("wider", "চওড়া") if min(filled) > 0.05 else ("exactly", "ঠিক")
    back = ("no, some", "না, কিছু") if low or high else ("yes", "হ্যাঁ")
    return {"a": page.parts["a"].saying(*words), "b": page.parts["b"].saying(*back)}


def hsv(picture: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Hue, saturation and value of each pixel."""
    return rgb_to_hsv(picture / 255)


def _changes(one: NDArray[np.float64], other: NDArray[np.float64]) -> tuple[float, float, float]:
    """How much hue, saturation and value differ, hue where both have colour."""
    off = np.abs(one - other)
    off[..., 0] = np.minimum(off[..., 0], 1 - off[..., 0])
    off[..., 0] *= (
        np.minimum(one[..., 1], other[..., 1]) * np.minimum(one[..., 2], other[..., 2]) > 0.05
    )
    return tuple(off.reshape(-1, 3).mean(axis=0))


@solves("hsv-edit-from-pictures", figure=True)
def which_edit(page: Page) -> dict[str, Any]:
    """Notes A2: the original is the picture from which each other one differs in one channel."""
    images = [hsv(one) for one in pictures(page.drawing)]

    def left_over(order: tuple[int, ...]) -> float:
        """What differs besides V, S and H of the three pictures in this order."""
        off = [_changes(images[place], images[order[3]]) for place in order[:3]]
        return sum(sum(one) - one[channel] for one, channel in zip(off, (2, 1, 0), strict=True))

    best = min(permutations(range(4)), key=left_over)
    return {"a": [str(place + 1) for place in best[:3]]}


@solves("recognise-noise-from-histograms", figure=True)
def noisy(page: Page) -> dict[str, Any]:
    """Notes 2.13, figure 5: four grey levels, these and the ends, or many."""
    kinds = [_noise(one[..., 0]) for one in pictures(page.drawing)[:3]]
    assert sorted(kinds) == ["clean", "gaussian", "impulse"]
    asked = {"clean": ("no noise", "noise নেই"), "gaussian": ("Gaussian",),
             "impulse": ("salt", "সল্ট")}  # fmt: skip
    text = page.parts["a"].text
    wanted = next(kind for kind, words in asked.items() if any(w in text for w in words))
    return {"a": page.parts["a"].saying(str(kinds.index(wanted) + 1))}


def _noise(grey: NDArray[np.uint8]) -> str:
    values, counts = np.unique(grey, return_counts=True)
    if np.sort(counts)[-4:].sum() < grey.size / 2:
        return "gaussian"
    return "impulse" if {0, 255} <= set(values.tolist()) else "clean"


@solves("lines-that-stay-straight", figure=True)
def straight_lines(page: Page) -> dict[str, Any]:
    """Errata E02: only lines through the principal point stay straight; F20 for the others."""
    cross = next(one for one in points(page.stem) if any(one))
    before, after = (lines(page.drawing, name) for name in ("undistorted", "distorted"))
    centre = _middle(lines(page.drawing, "principal-point"))
    pairs = [
        (one[end], two[end]) for one, two in zip(before, after, strict=True) for end in (0, -1)
    ]
    far, moved = max(pairs, key=lambda pair: math.dist(pair[0], centre))
    barrel = math.dist(moved, centre) < math.dist(far, centre)
    bow = ("away from", "উল্টো") if barrel else ("towards", "ক্রসের দিকে")
    size = ("smaller", "ছোট") if barrel else ("larger", "বড়")
    straight = page.parts["a"].those(lambda text: _passes(text, cross))
    return {"a": straight, "b": page.parts["b"].saying(*bow), "c": page.parts["c"].saying(*size)}


def _middle(strokes: list[Line]) -> tuple[float, ...]:
    places = [place for line in strokes for place in line]
    return tuple(sum(way) / len(places) for way in zip(*places, strict=True))


def _passes(line: str, place: tuple[Fraction, ...]) -> bool:
    """Whether a line, named by two points or an equation, passes through a place."""
    x, y = place
    if "y=x" in line:
        return x == y
    if "=" in line:
        return numbers(line)[0] == (x if line.strip().startswith("x") else y)
    (a, b), (c, d) = points(line)
    return (c - a) * (y - b) == (d - b) * (x - a)


@solves("sharp-zone-from-plot", figure=True)
def sharp_zone(page: Page) -> dict[str, Any]:
    """Curriculum X-C03, F33: the disc read off the plot; it goes with 1/N."""
    metres, high = (
        numbers(one)[-1] for one in re.findall(r"0 (?:to|থেকে) \d+|আর 0 থেকে \d+", page.figure)[:2]
    )
    lattice = lines(page.drawing, "grid")
    left, floor = (places[0] for places in ticks(page.drawing))
    right, top = max(line[0][0] for line in lattice), max(y for line in lattice for _, y in line)

    def place(line: Line) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        xs, ys = np.array(line).T
        return (xs - left) / (right - left) * float(metres), (ys - floor) / (top - floor) * float(
            high
        )

    drawn = [place(line) for line in lines(page.drawing, "curves")]
    (z,) = page.amounts("m", "c")
    told = re.search(r"(?:Curve|লাইন) 1[^.।]*", page.figure)
    assert told
    far, disc = map(float, numbers(told[0])[-2:])
    first, second = sorted(drawn, key=lambda one: abs(np.interp(far, *one) - disc))
    xs, ys = first
    fine = np.linspace(xs[0], xs[-1], 20000)
    sharp = fine[np.interp(fine, xs, ys) <= float(page["c"]) * 1e6]
    discs = [float(np.interp(float(z), *one)) for one in (first, second)]
    n = float(APERTURE.findall(page.parts["d"].text)[0]) * discs[0] / discs[1]
    return {"a": fine[np.argmin(np.interp(fine, xs, ys))], "b": (sharp[0], sharp[-1]),
            "c": discs[0] / 1e6, "d": n}  # fmt: skip


@solves("vignetting-from-a-profile", figure=True)
def profile(page: Page) -> dict[str, Any]:
    """Curriculum X-C15: cos^4 of the angle whose tangent is r/f; the curve begins at 1."""
    xs, ys = np.array(lines(page.drawing, "curve")[0]).T
    floor = ticks(page.drawing)[1][0]
    mark = lines(page.drawing, "marks")[0][0][0]
    read = (float(np.interp(mark, xs, ys)) - floor) / (ys[0] - floor)
    law = math.cos(math.atan(page["r"] / page["f"])) ** 4
    words = ("Yes", "হ্যাঁ") if abs(read - law) < 0.05 else ("No", "না,")
    stops = -math.log2(law)
    return {"a": read, "b": law, "c": page.parts["c"].saying(*words), "d": (stops, 1 / law)}
