"""Questions that are drawn: every point of the lines, from the numbers on the page."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Any

import numpy as np
from by_hand import solves
from printed_numbers import points
from printed_page import Page

Line = list[tuple[float, float]]
SMALLER, LARGER = ("smaller", "ছোট"), ("larger", "বড়")


@solves("draw-rays-through-a-lens")
def lens(page: Page) -> dict[str, Any]:
    """F42, 1/f = 1/g + 1/b: what comes in parallel leaves through the focal point."""
    g, h, f = map(float, page.amounts(""))
    b = 1 / (1 / f - 1 / g)
    low = -h * b / g
    rays = [[(-g, h), (0, h)], [(0, h), (b, low)], [(-g, h), (0, 0)], [(0, 0), (b, low)],
            [(-g, h), (0, low)], [(0, low), (b, low)]]  # fmt: skip
    words = SMALLER if g > 2 * f else LARGER if g < 2 * f else ("as large", "সমান")
    return {"a": [*rays, [(b, 0), (b, low)]], "b": page.parts["b"].saying(*words)}


@solves("draw-image-through-a-pinhole")
def pinhole(page: Page) -> dict[str, Any]:
    """Notes 4.1: sizes are as distances, upside down."""
    far, h, f = map(float, page.amounts(""))
    tip = (f, -h * f / far)
    return {"a": [[(-far, h), (0, 0)], [(0, 0), tip], [(f, 0), tip]]}


@solves("draw-normalised-histogram")
def histogram(page: Page) -> dict[str, Any]:
    """F12: the smallest level becomes 0, the largest 255, and no pixel is lost."""
    found = [*map(float, page.amounts(""))]
    levels, counts = found[:4], found[4:8]
    low, high = min(levels), max(levels)
    places = [255 * (level - low) / (high - low) for level in levels]
    return {"a": [[(x, 0), (x, y)] for x, y in zip(places, counts, strict=True)]}


@solves("draw-distortion-to-scale")
def grid(page: Page) -> dict[str, Any]:
    """F20 to F22: a point moves to 1 + k r² times its distance."""
    k = float(page["k_1"])
    ((a, _),) = points(page.parts["a"].text)
    side = float(a)

    def out(x: float, y: float) -> tuple[float, float]:
        return x * (1 + k * (x * x + y * y)), y * (1 + k * (x * x + y * y))

    run = [side * t / 4 for t in range(-4, 5)]
    lines: list[Line] = [[out(t, s) for t in run] for s in (side, -side)]
    lines += [[out(s, t) for t in run] for s in (side, -side)]
    middle = [[out(-side, 0), out(side, 0)], [out(0, -side), out(0, side)]]
    return {"a": out(side, side), "b": [*lines, *middle]}


CIE_1924 = {400: 0.0004, 420: 0.004, 440: 0.023, 460: 0.06, 480: 0.139, 500: 0.323, 507: 0.444,
            530: 0.862, 555: 1, 580: 0.87, 600: 0.631, 620: 0.381, 640: 0.175, 660: 0.061,
            680: 0.017, 690: 0.0082, 700: 0.0041}  # fmt: skip
CIE_1951 = {400: 0.0093, 420: 0.0966, 440: 0.3281, 460: 0.567, 480: 0.793, 500: 0.982, 507: 1,
            530: 0.811, 555: 0.402, 580: 0.1212, 600: 0.0332, 620: 0.0074, 640: 0.0015,
            660: 0.0003, 680: 0.0001, 690: 0, 700: 0}  # fmt: skip


@solves("draw-curve-of-the-eye")
def eye(page: Page) -> dict[str, Any]:
    """Notes 3.2: the tables of V and V'."""
    table = (
        CIE_1924
        if any(word in page.parts["a"].text for word in ("daylight", "দিনের"))
        else CIE_1951
    )
    return {"a": [[(float(x), float(y)) for x, y in table.items()]]}


@solves("draw-blur-against-distance")
def blur_against_distance(page: Page) -> dict[str, Any]:
    """F33 and F42: the disc of a point at z behind a lens that is focused at s."""
    (number,), (f,) = page.f_numbers(), page.amounts("mm")
    s = page.amounts("m")[0]
    sensor = 1 / (1 / f - 1 / s)
    top = 1.5 * float(f / number * (sensor / f - 1)) * 1000

    def disc(z: Fraction) -> float:
        sharp = 1 / (1 / f - 1 / z)
        return 1000 * float(f / number * abs(sensor - sharp) / sharp)

    shares = ("0.45", "0.5", "0.55", "0.6", "0.65", "0.7", "0.8", "0.9", "1", "1.15", "1.3", "1.5",
              "1.75", "2", "2.5", "3", "3.5")  # fmt: skip
    places = [s * Fraction(share) for share in shares]
    assert all(disc(z) < top for z in places)
    return {"a": [[(float(z), disc(z)) for z in places]]}


@solves("draw-histogram-after-brightening")
def brightened(page: Page) -> dict[str, Any]:
    """Notes 4.3: each level moves, what is above 255 becomes 255, and no pixel is lost."""
    levels = list(map(int, page.amounts("")[1:6]))
    counts = list(map(int, page.amounts("")[6:11]))
    edit = page.amounts("")[11]
    new: dict[float, int] = {}
    for level, count in zip(levels, counts, strict=True):
        moved = min(255.0, float(level * edit if edit < 2 else level + edit))
        new[moved] = new.get(moved, 0) + count
    return {"a": [[(x, 0), (x, y)] for x, y in new.items()]}


@solves("draw-gaussian-of-another-width")
def another_gaussian(page: Page) -> dict[str, Any]:
    """Notes 4.4: the density, point by point."""
    mean, wide = float(page.amounts("")[0]), float(page.amounts("")[-1])
    steps = [-3, -2.5, *(step / 4 for step in range(-8, 9)), 2.5, 3]
    places = [mean + wide * step for step in steps]
    return {"a": [[(x, math.exp(-0.5 * ((x - mean) / wide) ** 2) / wide / math.sqrt(2 * math.pi))
                   for x in places]]}  # fmt: skip


@solves("draw-pole-under-rolling-shutter")
def pole(page: Page) -> dict[str, Any]:
    """Notes B10b: what is read later has moved on."""
    (time,), (speed,) = page.amounts("ms"), page.amounts("px/s")
    high = page.amounts("")[1]
    moved = float(speed * time * high / 1080)
    moved = moved if page.says("moves to the right", "ডান দিকে") else -moved
    top = float(high)
    return {"a": [[(-2, top), (moved - 2, 0)], [(2, top), (moved + 2, 0)]]}


@solves("draw-level-lines")
def level_lines(page: Page) -> dict[str, Any]:
    """Notes D16: half axes are the roots of the variances."""
    (x_var, y_var), both = points(page.stem)[1], page.amounts("")[-1]
    turns = [2 * math.pi * step / 32 for step in range(33)]

    def around(place: float, across: float, up: float) -> Line:
        return [(place + across * math.cos(t), up * math.sin(t)) for t in turns]

    (first, _), (second, _) = page.point("μ_1"), page.point("μ_2")
    radius = math.sqrt(both)
    return {"a": [around(float(first), math.sqrt(x_var), math.sqrt(y_var)),
                  around(float(second), radius, radius)]}  # fmt: skip


@solves("draw-fall-off-of-light")
def falls_off(page: Page) -> dict[str, Any]:
    """Curriculum X-C15: the fourth power of the cosine of the angle whose tangent is r/f."""
    f, end = 1000 * float(page["f"]), 1000 * float(page["R"])
    places = [end * step / 12 for step in range(13)]
    return {"a": [[(r, math.cos(math.atan(r / f)) ** 4) for r in places]]}


@solves("draw-field-of-view")
def field_of_view(page: Page) -> dict[str, Any]:
    """Notes 4.1: the sensor and what it shows of the wall are seen from the hole at one angle."""
    f, sensor, far = map(float, page.amounts(""))
    end = sensor / 2 / f * far
    rays = [[(-f, side * sensor / 2), (0, 0), (far, -side * end)] for side in (-1, 1)]
    halves = [half for ray in rays for half in (ray[:2], ray[1:])]
    ways = {("doubled", "দ্বিগুণ"): ("half as wide", "অর্ধেক চওড়া"), ("halved", "অর্ধেক"): ("twice as wide", "দ্বিগুণ চওড়া"),
            ("four times as long", "length চার গুণ"): ("a quarter as wide", "চার ভাগের এক ভাগ চওড়া"),
            ("a quarter as long", "চার ভাগের এক ভাগ"): ("four times as wide", "চার গুণ চওড়া")}  # fmt: skip
    part = page.parts["b"]
    said = part.text.replace(")", "")
    (words,) = [
        seen
        for told, seen in ways.items()
        if any(f" {one} " in f" {said} ".replace(".", " ") for one in told)
    ]
    return {"a": [*halves, [(far, -end), (far, end)]], "b": part.saying(*words)}


@solves("draw-light-from-a-surface", figure=True)
def comes_back(page: Page) -> dict[str, Any]:
    """F02: at each wavelength the share that the surface sends back of what arrives."""
    corners = [float(value) for value in re.findall(r"\d00 nm: (\d(?:\.\d+)?)", page.figure)]
    steps = range(400, 701, 50)
    lamp, surface = (np.interp(steps, range(400, 701, 100), part)
                     for part in (corners[:4], corners[4:]))  # fmt: skip
    both = (lamp * surface).tolist()
    named = both[1], both[3], both[5]
    words = (("blue", "নীল"), ("green", "সবুজ"), ("red", "লাল"))[named.index(max(named))]
    curve = list(zip(map(float, steps), both, strict=True))
    return {"a": named, "b": [curve], "c": page.parts["c"].saying(*words)}
