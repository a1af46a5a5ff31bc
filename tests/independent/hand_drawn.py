"""Questions that are drawn: every point of the lines, from the numbers on the page."""

from __future__ import annotations

from typing import Any

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
