"""Estimates: the assumptions of a good student, who need not make those of the key."""

from __future__ import annotations

import math
import re
import statistics
from fractions import Fraction
from typing import Any

import numpy as np
from by_hand import solves
from printed_numbers import quantities
from printed_page import Page

PLANCK, LIGHT, GREEN, LUMENS = 6.626e-34, 2.998e8, 555e-9, 683
"""J s, m/s, m, and lumens of a watt at that wavelength."""


@solves("estimate-photons-of-a-pixel")
def photons(page: Page) -> dict[str, Any]:
    """Notes D19: a grey wall, a perfect lens, one photon of green light after the other."""
    (number,), (side,) = page.f_numbers(), page.amounts("µm")
    lux = Fraction(next(word for word in page.stem.split("(")[1].split()))
    time = page.amounts("s")[0]
    per_lux = 1 / LUMENS / (PLANCK * LIGHT / GREEN)
    count = Fraction(per_lux * 0.18 * float(lux / (4 * number**2) * side**2 * time))
    return {"a": count, "b": Fraction(math.sqrt(count))}


@solves("estimate-megapixels")
def megapixels(page: Page) -> dict[str, Any]:
    """Notes 2.13: two pixels for each period; 80 line pairs per mm are good film."""
    film = [value * 1000 for value, unit in quantities(page.parts["a"].text) if unit == "mm"][:2]
    page_sides = [value for value, unit in quantities(page.parts["b"].text) if unit == "mm"]
    dots = next(v for v, unit in quantities(page.parts["b"].text) if not unit and v >= 200)
    per_metre = dots / Fraction("0.0254")
    pixels = [side * per_metre for side in page_sides[:2]]
    million = 10**6
    return {"a": film[0] * film[1] * (2 * 80) ** 2 / million, "b": pixels[0] * pixels[1] / million}


@solves("estimate-video-of-a-day")
def video(page: Page) -> dict[str, Any]:
    """Notes 2.1: a byte for each channel of each pixel."""
    wide, high, *_, frames, hours = page.amounts("")
    raw = wide * high * 3 * frames * hours * 3600
    return {"a": raw, "b": raw / 120}


TALL = {"full moon": None, "চাঁদ": None, "person": 1.75, "মানুষ": 1.75, "car": 1.45, "bus": 3.1}


@solves("estimate-size-in-pixels")
def size(page: Page) -> dict[str, Any]:
    """F05: similar triangles."""
    tall = next(value for word, value in TALL.items() if word in page.stem)
    ratio = (math.tan(math.radians(0.52)) if tall is None
             else tall / float(page.amounts("m")[0]))  # fmt: skip
    (side,) = page.amounts("µm")
    return {"a": Fraction(float(page["f"]) * ratio / float(side))}


@solves("estimate-gain-and-read-noise")
def transfer(page: Page) -> dict[str, Any]:
    """EMVA 1288: a straight line through all four points, by least squares."""
    points = [tuple(map(float, row)) for row in page.rows if row[0].isdigit()]
    mean = [sum(values) / len(points) for values in zip(*points, strict=True)]
    slope = (sum((x - mean[0]) * (y - mean[1]) for x, y in points)
             / sum((x - mean[0]) ** 2 for x, _ in points))  # fmt: skip
    dark = math.sqrt(mean[1] - slope * mean[0])
    return {"a": Fraction(slope), "b": (Fraction(dark), Fraction(dark / slope))}


@solves("aliasing-of-a-fine-pattern")
def aliasing(page: Page) -> dict[str, Any]:
    """Notes 2.13: the samples of a cosine are those of a slower one; which, is tried."""
    (pitch,), (pattern,) = page.amounts("µm"), page.amounts("lp/mm")
    samples = [math.cos(2 * math.pi * float(pattern * pitch) * i) for i in range(200)]

    def differ(tried: Fraction) -> float:
        return max(abs(math.cos(2 * math.pi * float(tried * pitch) * i) - y)
                   for i, y in enumerate(samples))  # fmt: skip

    limit = 1 / (2 * pitch)
    false = min((Fraction(n * 250) for n in range(int(limit / 250) + 1)), key=differ)
    return {"a": limit, "b": false, "c": 1 / (false * pitch)}


@solves("camera-matrix-after-edits")
def edited_camera(page: Page) -> dict[str, Any]:
    """F06: matrices that move and scale pixels, one after the other."""
    f, *_, left, top, high = (v for v in page.amounts("px"))
    factor = next(v for v in page.amounts("")[::-1] if v)
    matrix = [[f, 0, page["o_x"]], [0, f, page["o_y"]], [0, 0, 1]]
    crop = [[1, 0, -left], [0, 1, -top], [0, 0, 1]]
    resize = [[factor, 0, 0], [0, factor, 0], [0, 0, 1]]
    turn = [[1, 0, 0], [0, -1, factor * high], [0, 0, 1]]

    def times(a: list[list[Any]], b: list[list[Any]]) -> list[list[Any]]:
        return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]

    cropped = times(crop, matrix)
    small = times(resize, cropped)
    return {
        "a": (cropped[0][2], cropped[1][2]),
        "b": (small[0][0], small[0][2], small[1][2]),
        "c": times(turn, small)[1][2],
    }


@solves("gain-and-read-noise-from-plot", figure=True)
def transfer_curve(page: Page) -> dict[str, Any]:
    """EMVA 1288: a straight line through the points, by least squares, until the sites are full."""
    read = re.findall(r"([\d.]+): ([\d.]+)", page.figure.replace("\u202f", ""))
    means, variances = np.array([[float(x), float(y)] for x, y in read]).T
    slope, dark = np.polyfit(means, variances, 1)
    noise = math.sqrt(dark)
    return {"a": Fraction(slope), "b": (Fraction(noise), Fraction(noise / slope)),
            "c": Fraction(means[-1] / slope)}  # fmt: skip


@solves("noise-and-gain-of-nine-pixels")
def nine_pixels(page: Page) -> dict[str, Any]:
    """EMVA 1288: the variance that the dark has not, over the mean above the dark level."""
    levels = [float(cell) for row in page.rows for cell in row if cell.isdigit()]
    assert len(levels) == 9
    signal = statistics.mean(levels) - float(page["b"])
    spread = statistics.stdev(levels)
    gain = (spread**2 - float(page["v_d"])) / signal
    return {"a": (Fraction(statistics.mean(levels)), Fraction(spread)),
            "b": Fraction(signal / spread), "c": Fraction(gain)}  # fmt: skip


@solves("camera-matrix-with-centred-pixels")
def centred_camera(page: Page) -> dict[str, Any]:
    """E27: where the middle of the whole picture lies, counted from corners and then from centres."""
    f, *_, left, top = page.amounts("px")
    factor = page.amounts("")[-1]
    wide, high = page.amounts("")[:2]
    corner = (wide / 2 - left, high / 2 - top)
    resized = tuple(factor * place for place in corner)
    half = Fraction(1, 2)
    return {
        "a": tuple(place - half for place in corner),
        "b": (factor * f, *(place - half for place in resized)),
        "c": resized,
    }
