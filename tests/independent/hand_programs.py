"""Functions that are asked for, written value by value from what the page says they do."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
from by_hand import solves
from printed_page import Page


def each(change: Callable[..., float], *arrays: Any, dtype: str) -> Any:
    """A new array of values that are changed one by one, those at one place together."""
    flat = [array.ravel().tolist() for array in arrays]
    made = [change(*values) for values in zip(*flat, strict=True)]
    return np.array(made, dtype=dtype).reshape(arrays[0].shape)


def byte(value: float) -> int:
    """The nearest whole number, the even one of two, from 0 to 255."""
    return max(0, min(255, round(value)))


@solves("write-normalise-and-clamp")
def normalise(page: Page) -> dict[str, Any]:
    """F12, and notes 4.3: what lies outside is clamped."""
    low, high, first, last, level, becomes = page.amounts("")[-6:]
    assert becomes == first + (last - first) * (level - low) / (high - low)

    def function(image: Any, lo: float, hi: float, new_lo: float, new_hi: float) -> Any:
        def one(value: float) -> float:
            share = 0 if hi == lo else max(0.0, min(1.0, (value - lo) / (hi - lo)))
            return new_lo + share * (new_hi - new_lo)

        return each(one, image, dtype="float64")

    return {"a": function}


@solves("write-hue-shift")
def hue(page: Page) -> dict[str, Any]:
    """Notes 6.2: stored hues count two degrees each."""
    degrees, stored, becomes = page.amounts("")[-3:]
    assert 2 * becomes == 2 * stored + degrees

    def function(hues: Any, turned: int) -> Any:
        return each(lambda h: (2 * h + turned) % 360 // 2, hues, dtype="uint8")

    return {"a": function}


@solves("write-flat-field-correction")
def flat_field(page: Page) -> dict[str, Any]:
    """Notes 2.13 and 6.6: divide by what an even scene gives."""
    dead = 0 if page.says("become 0", "হয় 0") else 255

    def function(raw: Any, dark: Any, flat: Any) -> Any:
        gains = [f - d for f, d in zip(flat.ravel().tolist(), dark.ravel().tolist(), strict=True)]
        live = [gain for gain in gains if gain > 0]

        def one(r: int, d: int, f: int) -> int:
            if f <= d:
                return dead
            return byte(float(Fraction(r - d, f - d) * Fraction(sum(live), len(live))))

        return each(one, raw, dark, flat, dtype="uint8")

    return {"a": function}


@solves("write-green-at-a-site")
def green(page: Page) -> dict[str, Any]:
    """Notes 4.7: the mean of the nearest neighbours that exist."""
    beside, above, mean = page.amounts("")[-3:]
    assert mean == (2 * beside + 2 * above) / 4

    def function(raw: Any, x: int, y: int) -> float:
        rows = raw.tolist()
        near = [
            value
            for j, row in enumerate(rows)
            for i, value in enumerate(row)
            if abs(i - x) + abs(j - y) == 1
        ]
        return sum(near) / len(near)

    return {"a": function}


@solves("write-projection-of-points")
def project(page: Page) -> dict[str, Any]:
    """F05 and notes 6.3: similar triangles, then pixels."""
    (f,), (s,) = page.amounts("mm"), page.amounts("µm")
    column, middle = page.amounts("")[-1], page["o_x"]
    assert column == middle + f / s / 10

    def function(points: Any, f: float, s: float, o_x: float, o_y: float) -> Any:
        rows = [
            (o_x + f * x / z / s, o_y + f * y / z / s) if z > 0 else (math.nan, math.nan)
            for x, y, z in points.tolist()
        ]
        return np.array(rows, dtype="float64").reshape(-1, 2)

    return {"a": function}


@solves("write-salt-and-pepper")
def impulses(page: Page) -> dict[str, Any]:
    """Notes 4.4 and 6.4."""
    assert page.amounts("")[-1] * 2 == page["p"]

    def function(image: Any, u: Any, p: float) -> Any:
        def one(value: float, chance: float) -> float:
            return 0 if chance < p / 2 else 255 if 1 - chance < p / 2 else value

        chances = u if image.ndim == u.ndim else np.repeat(u, image.shape[-1]).reshape(image.shape)
        return each(one, image, chances, dtype="uint8")

    return {"a": function}


@solves("write-noise-in-floats")
def noisy(page: Page) -> dict[str, Any]:
    """Notes 6.4: floats, sum, round, clip."""
    level, noise, mean, total, top = page.amounts("")[-5:]
    assert total == level + noise + mean > top

    def function(image: Any, z: Any, sigma: float, mu: float) -> Any:
        return each(lambda value, n: byte(value + mu + sigma * n), image,
                    z.reshape(image.shape) if z.size == image.size else z, dtype="uint8")  # fmt: skip

    return {"a": function}


@solves("write-mean-in-linear-light")
def light(page: Page) -> dict[str, Any]:
    """F46: decode, add, encode."""
    assert page.amounts("")[-1] == Fraction(255, 2)

    def function(codes: Any, gamma: float) -> float:
        values = codes.ravel().tolist()
        shares = [math.exp(gamma * math.log(c / 255)) if c else 0.0 for c in values]
        mean = math.fsum(shares) / len(shares)
        return 255 * math.exp(math.log(mean) / gamma)

    return {"a": function}
