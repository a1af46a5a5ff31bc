"""Hands that draw: smooth, shaky, with few points, in pieces; told nothing of how marking works.

A line is a list of points in the coordinates of its field, which ``WIDE`` is the width of.
"""

from __future__ import annotations

import math
from itertools import pairwise
from random import Random

Line = list[tuple[float, float]]


def along(line: Line, count: int) -> Line:
    """Points at equal distances along a line."""
    legs = [math.dist(a, b) for a, b in pairwise(line)]
    total, found, done, leg = sum(legs), [], 0.0, 0
    for i in range(count):
        wanted = total * i / (count - 1)
        while leg < len(legs) - 1 and done + legs[leg] < wanted:
            done += legs[leg]
            leg += 1
        share = (wanted - done) / legs[leg]
        (x, y), (to_x, to_y) = line[leg], line[leg + 1]
        found.append((x + share * (to_x - x), y + share * (to_y - y)))
    return found


def smooth(line: Line, rng: Random, wide: float) -> Line:
    """A steady hand with a mouse: many points, slow small waves, a little beside the place."""
    shift, size = (
        [rng.uniform(-0.012, 0.012) * wide for _ in "xy"],
        rng.uniform(0.002, 0.005) * wide,
    )
    waves, phase = rng.uniform(1, 3), rng.uniform(0, 6)
    drawn = [
        (
            x + shift[0] + size * math.sin(waves * i / 8 + phase),
            y + shift[1] + size * math.cos(waves * i / 8),
        )
        for i, (x, y) in enumerate(along(line, rng.randint(25, 60)))
    ]
    return drawn[::-1] if rng.random() < 0.5 else drawn


def shaky(line: Line, rng: Random, wide: float) -> Line:
    """A trembling finger."""
    size = 0.006 * wide
    return [(x + rng.gauss(0, size), y + rng.gauss(0, size)) for x, y in smooth(line, rng, wide)]


def few(line: Line, rng: Random, wide: float) -> Line:
    """Control points that are typed, or set by keys on a grid."""
    grid = wide / 100
    if len(line) == 3:
        return [(round(x / grid) * grid, round(y / grid) * grid) for x, y in line]
    count = 2 if len(line) == 2 else rng.choice([3, 4, 5]) if len(line) < 30 else rng.choice([8, 9])
    return [(round(x / grid) * grid, round(y / grid) * grid) for x, y in along(line, count)]


def pieces(line: Line, rng: Random, wide: float) -> list[Line]:
    """A line that is put together from strokes which overlap."""
    drawn = smooth(line, rng, wide)
    cut = rng.randint(len(drawn) // 3, 2 * len(drawn) // 3)
    return [drawn[: cut + 2], drawn[cut - 2 :]]


def beyond(line: Line, rng: Random, wide: float) -> Line:
    """A quick hand that does not stop where it should."""
    drawn = smooth(line, rng, wide)
    (x, y), (back_x, back_y) = drawn[-1], drawn[-4]
    more = rng.uniform(0.01, 0.025) * wide / max(math.dist(drawn[-1], drawn[-4]), 1e-9)
    return [*drawn, (x + more * (x - back_x), y + more * (y - back_y))]


def waved(line: Line, size: float, waves: float) -> Line:
    """A line with waves across: an S with one of them, a zigzag with many."""
    (x, y), (to_x, to_y) = line[0], line[-1]
    run = math.dist(line[0], line[-1])
    across = (-(to_y - y) / run, (to_x - x) / run)
    return [
        (a + across[0] * size * math.sin(2 * math.pi * waves * i / 60),
         b + across[1] * size * math.sin(2 * math.pi * waves * i / 60))
        for i, (a, b) in enumerate(along(line, 61))
    ]  # fmt: skip


def turned(line: Line, degrees: float) -> Line:
    """A line turned around the origin."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [(c * x - s * y, s * x + c * y) for x, y in line]


def moved(line: Line, by: tuple[float, float]) -> Line:
    """A line elsewhere."""
    return [(x + by[0], y + by[1]) for x, y in line]


def text(lines: list[Line]) -> str:
    """Lines as a page sends them."""
    return "; ".join(" ".join(f"{x:.2f},{y:.2f}" for x, y in line) for line in lines)


def drawings(lines: list[Line], seed: int, wide: float) -> str:
    """One hand draws all lines, in any order."""
    rng = Random(seed)
    kind = ("smooth", "shaky", "few", "pieces", "beyond")[seed % 5]
    if kind == "pieces":
        drawn = [piece for line in lines for piece in pieces(line, rng, wide)]
    else:
        hand = {"smooth": smooth, "shaky": shaky, "few": few, "beyond": beyond}[kind]
        drawn = [hand(line, rng, wide) for line in lines]
    rng.shuffle(drawn)
    return text(drawn)
