"""The pinhole camera, its pixels and its approximations, from the textbook's formulas."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from by_hand import solves
from printed_numbers import numbers, points
from printed_page import Page


@solves("point-to-image-plane", "point-to-image-plane-fractions")
def image_plane(page: Page) -> dict[str, Any]:
    """Notes 4.1, F05: p' = f p / p_z."""
    x, y, z = page.point("p")
    return {"a": (page["f"] * x / z, page["f"] * y / z)}


@solves("point-to-pixel")
def to_pixel(page: Page) -> dict[str, Any]:
    """Notes 4.2, F08 and F09, with y downward in the camera frame too."""
    x, y, z = page.point("p")
    o_x, o_y = points(page.stem)[0]
    density = 1 / page["s"]
    return {"a": tuple(density * page["f"] * a / z + o for a, o in ((x, o_x), (y, o_y)))}


@solves("point-to-non-square-pixel")
def to_oblong_pixel(page: Page) -> dict[str, Any]:
    """Notes 4.2, F09; y is upward in the camera frame, so rows are subtracted (E28)."""
    x, y, z = page.point("p")
    o_x, o_y = points(page.stem)[0]
    u = o_x + page["f"] / page["s_x"] * x / z
    v = o_y - page["f"] / page["s_y"] * y / z
    width, height = page.amounts("px")[:2]
    beside, above = not 0 <= u < width, not 0 <= v < height
    said = {(False, False): ("inside", "ভেতরে"), (True, False): ("to the left or right", "বাঁয়ে"),
            (False, True): ("above", "উপরে"), (True, True): ("corner", "কোণার")}  # fmt: skip
    return {"a": (u, v), "b": page.parts["b"].saying(*said[beside, above])}


@solves("points-on-one-ray")
def one_ray(page: Page) -> dict[str, Any]:
    """Notes 4.1, F05 and F06: all points of a ray have one image."""
    p, moved = page.point("p"), points(page.parts["a"].text)[0]
    (focal,) = numbers(page.parts["a"].text.partition(")")[2].replace("p'", ""))[-1:]
    places = {
        k: Fraction(v) for k, v in ((0, page["f"] * p[0] / p[2]), (1, focal * moved[0] / moved[2]))
    }
    ratio = places[1] / places[0]
    words = (("opposite", "উল্টো"), ("nearer", "আরও কাছে"), ("same place", "একই জায়গায়"),
             ("farther", "আরও দূরে"))[(ratio > 0) + (ratio >= 1) + (ratio > 1)]  # fmt: skip
    on_ray = dict(zip(("q_x", "q_y", "q_z"), (Fraction(3) * one for one in p), strict=True))
    return {"a": page.parts["a"].saying(*words), "b": on_ray}


@solves("depth-is-lost")
def another_depth(page: Page) -> dict[str, Any]:
    """Notes 4.1, F05: a multiple of a point has its image, at another depth."""
    multiple = (Fraction(3) * one for one in page.point("p"))
    return {"a": dict(zip(("q_x", "q_y", "q_z"), multiple, strict=True))}


@solves("focal-length-size-and-distance")
def three_photographs(page: Page) -> dict[str, Any]:
    """Notes C14, F10: h/f = y/z."""
    f = page["h_1"] * page["z_1"] / page["y_1"]
    return {"a": f, "b": page["h_2"] * page["z_2"] / f, "c": f * page["y_3"] / page["h_3"]}


@solves("image-height-and-fill-distance")
def image_height(page: Page) -> dict[str, Any]:
    """Notes C14, F08 and F10."""
    height = page["f"] * page["p_y"] / page["p_z"]
    return {"a": height, "b": height / page["s"], "c": page["f"] * page["p_y"] / page["S"]}


@solves("image-scaling-laws")
def scaling(page: Page) -> dict[str, Any]:
    """Notes 4.1, F07: depth a, focal length b and size c scale the image by b c / a."""
    factor = page["b"] * page["c"] / page["a"]
    return {"a": factor, "b": page["h_0"] * factor}


@solves("weak-perspective-scale-error")
def weak_scale(page: Page) -> dict[str, Any]:
    """Notes D18, F43 and F44: one scale f/mean depth for f/z."""
    near, far = page["f"] / page["z_1"], page["f"] / page["z_2"]
    one = page["f"] / ((page["z_1"] + page["z_2"]) / 2)
    worst = max(abs(one - true) / true for true in (near, far))
    return {"a": (near, far), "b": one, "c": worst}


def formula(function: Callable[..., float]) -> Callable[..., float]:
    """A formula that takes all symbols of a question and needs some."""
    needed = function.__code__.co_varnames
    return lambda **symbols: function(**{n: v for n, v in symbols.items() if n in needed})


@solves("orthographic-and-weak-formulas")
def two_formulas(page: Page) -> dict[str, Any]:
    """Notes D18, F43: x' = p_x; x' = f p_x / Z."""
    assert page.says("rthographic")
    weak = formula(lambda f, p_x, Z: f * p_x / Z)  # noqa: N803
    return {"a": formula(lambda p_x: p_x), "b": weak}


@solves("gaussian-2d-formula-and-shapes")
def gaussian_formula(page: Page) -> dict[str, Any]:
    """Notes D16, F40 and F41; the long axis is the eigenvector of the larger eigenvalue."""

    def density(x: float, y: float, sigma_1: float, sigma_2: float) -> float:
        below = 2 * math.pi * sigma_1 * sigma_2
        return math.exp(-((x / sigma_1) ** 2 + (y / sigma_2) ** 2) / 2) / below

    shapes = page.parts["b"]
    pairs = {}
    for place, rows in enumerate(shapes.options):
        words = SHAPES[_long_axis(*points(rows))]
        (target,) = (n for n, text in enumerate(shapes.targets, 1) if text.endswith(words))
        pairs["ABCDEFGH"[place]] = target
    return {"a": density, "b": pairs}


SHAPES = {"": ("circles", "বৃত্ত"), "x": ("along x", "x বরাবর"), "y": ("along y", "y বরাবর"),
          "up": ("y=x", "y=x লাইন বরাবর"), "down": ("y=-x", "y=-x লাইন বরাবর")}  # fmt: skip


def _long_axis(first: tuple[Fraction, ...], second: tuple[Fraction, ...]) -> str:
    (a, b), (_, d) = first, second
    if b:
        assert a == d
        return "up" if b > 0 else "down"
    return "" if a == d else "x" if a > d else "y"
