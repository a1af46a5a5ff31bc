"""The way back from a distorted picture and the fall of light, from the textbook's formulas."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from by_hand import solves
from printed_figure import lines, ticks
from printed_numbers import points
from printed_page import Page


def factor(radius: float, *k: float) -> float:
    """Notes 4.5, F20: 1 + k_1 r^2 + k_2 r^4."""
    return 1 + sum(one * radius ** (2 * place) for place, one in enumerate(k, 1))


@solves("undistort-by-iteration")
def step_by_step(page: Page) -> dict[str, Any]:
    """Curriculum X-C12; the limit by bisection."""
    k, far = float(page["k_1"]), float(page["r_d"])
    steps = [far]
    for _ in range(3):
        steps.append(far / factor(steps[-1], k))
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if middle * factor(middle, k) < far else (low, middle)
    x, y = points(page.parts["c"].text)[0]
    return {"a": tuple(steps[1:]), "b": low, "c": (float(x) * low / far, float(y) * low / far)}


@solves("fold-over-radius")
def fold_over(page: Page) -> dict[str, Any]:
    """Curriculum X-D07, E03: the largest of many values of r (1 + k_1 r^2)."""
    k, corner = float(page["k_1"]), float(page["r_c"])
    radii = np.linspace(0, 2.5, 250_001)
    moved = radii * (1 + k * radii**2)
    top = int(moved.argmax())
    said = ("beyond", "বাইরে") if corner > radii[top] else ("within", "ভেতরে")
    answers = {"a": float(radii[top]), "b": float(moved[top]), "c": corner * factor(corner, k)}
    return {**answers, "d": page.parts["d"].saying(*said)}


@solves("coefficients-from-measured-points")
def coefficients(page: Page) -> dict[str, Any]:
    """Curriculum X-C13: two linear equations in k_1 and k_2."""
    near, far = float(page["r_1"]), float(page["r_2"])
    moved = float(page["d_1"]), float(page["d_2"])
    rows = [[r**2, r**4] for r in (near, far)]
    changes = [d / r - 1 for d, r in zip(moved, (near, far), strict=True)]
    k_1, k_2 = np.linalg.solve(rows, changes)
    kinds = {(True, True): ("barrel:",), (False, False): ("pincushion:",)}
    said = kinds.get((bool(k_1 < 0), moved[1] < far), ("one kind", "এক ধরন"))
    alone = changes[0] / near**2
    return {"a": alone, "b": (float(k_1), float(k_2)), "c": page.parts["c"].saying(*said)}


@solves("vignetting-from-a-profile", figure=True)
def fall_off(page: Page) -> dict[str, Any]:
    """Curriculum X-C15: cos^4 of the angle with tangent r/f; the curve is read at the mark."""
    share = math.cos(math.atan(float(page["r"] / page["f"]))) ** 4
    (curve,), (mark,) = (lines(page.drawing, one) for one in ("curve", "marks"))
    floor = ticks(page.drawing)[1][0]
    read = np.interp(mark[0][0], [x for x, _ in curve], [y - floor for _, y in curve])
    seen = float(read) / (curve[0][1] - floor)
    said = ("No,", "না,") if seen < 0.9 * share else ("Yes,", "হ্যাঁ,")
    answers = {"a": seen, "b": share, "c": page.parts["c"].saying(*said)}
    return {**answers, "d": (math.log2(1 / share), 1 / share)}
