"""Aperture, thin lens, blur, distortion and the errors of a camera, from the textbook's formulas."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Any

from by_hand import solves
from printed_numbers import named, numbers, points
from printed_page import Page, Part


def nearest(part: Part, value: Fraction) -> set[int]:
    """The option whose number comes nearest to a value, as a ratio."""
    away = [abs(math.log(numbers(text)[0] / value)) for text in part.options]
    return {away.index(min(away)) + 1}


@solves("blur-and-light-factors")
def blur_and_light(page: Page) -> dict[str, Any]:
    """Notes 4.8, F31 to F35: blur follows the diameter f/N, light its square."""
    before, after = page.f_numbers()
    ratio = max(before, after) / min(before, after)
    (old,) = page.amounts("s", "e")
    return {"a": ratio, "c": ratio**2, "e": old * (after / before) ** 2}


@solves("diameter-stops-and-exposure-time")
def aperture_in_numbers(page: Page) -> dict[str, Any]:
    """Notes 4.8, F31, F34, F35: D = f/N, stops = log2 of the ratio of light."""
    before, after = page.f_numbers()
    light = (max(before, after) / min(before, after)) ** 2
    (old,) = page.amounts("s", "d")
    diameters = (page["f"] / before, page["f"] / after)
    stops = round(math.log2(light))
    return {"a": diameters, "b": light, "c": stops, "d": old * (after / before) ** 2}


@solves("stopping-down-or-opening-effects")
def stops_of_light(page: Page) -> dict[str, Any]:
    """Notes 4.8: each stop halves or doubles the light; the time makes up for it."""
    (stops,) = page.amounts("")
    light = Fraction(2) ** int(stops if page.says("opened", "বড় করা হলো") else -stops)
    alike = {"twice": "2 times", "just as much": "1 times", "ঠিক আগের সমান": "1"}
    told = Part("", "", tuple(next((n for w, n in alike.items() if w in one), one)
                              for one in page.parts["b"].options), ())  # fmt: skip
    (old,) = page.amounts("s", "c")
    return {"b": nearest(told, light), "c": nearest(page.parts["c"], old / light)}


@solves("blur-disc-diameter")
def blur_disc(page: Page) -> dict[str, Any]:
    """Notes 4.8, F33: c = D |z_s - z_p| / z_p with D = f/N."""
    sharp, sensor = page["z'_p"], page["z'_s"]
    first, second = (page["f"] / page[n] * abs(sensor - sharp) / sharp for n in ("N_1", "N_2"))
    return {"a": first, "b": second, "c": first / page["p"]}


@solves("thin-lens-image-distance")
def thin_lens(page: Page) -> dict[str, Any]:
    """Notes D17, F42: 1/f = 1/z + 1/z'."""
    image = 1 / (1 / page["f"] - 1 / page["z"])
    return {"a": image, "b": image / page["z"], "c": image - page["f"]}


@solves("magnification-and-object-distance")
def close_up(page: Page) -> dict[str, Any]:
    """Notes F42, X-A14: the lens equation before and after, with m = z'/z."""
    f, z = page["f"], page["z"]
    image = 1 / (1 / f - 1 / z)
    (times,) = page.amounts("", "c")
    larger = times * image / z
    return {"a": image / z, "b": image, "c": (larger + 1) / larger * f}


@solves("source-near-focus-in-float32")
def near_focus(page: Page) -> dict[str, Any]:
    """Notes D17, F42, for an object just outside the focus."""
    z = page["f"] + page["d"]
    return {"a": 1 / (1 / page["f"] - 1 / z)}


@solves("thin-lens-limits")
def lens_limits(page: Page) -> dict[str, Any]:
    """Notes D17, F42: the image of an object at a multiple of f, and its size."""
    limit, object_at = page.parts["b"], page.parts["c"]
    near = multiple_of_f(re.findall(r"\(z ([^()]*)\)", limit.text)[-1])
    image = abs(1 / (1 - 1 / near)) if near not in {0, 1} else Fraction(0) if near == 0 else None
    f = named(object_at.text, "f")
    z = sum(page.amounts("mm", "c")) - f
    return {"b": limit.those(lambda text: multiple_of_f(text) == image),
            "c": object_at.saying("neither", "কোনো image-ই") if z == f else _image_said(object_at, f / (z - f))}  # fmt: skip


def multiple_of_f(text: str) -> Fraction | None:
    """The coefficient of f in a text, 0 for a bare nought."""
    found = re.search(r"(?<![A-Za-z])(\d*)f(?:/(\d+))?(?![A-Za-z])|(?<!\w)0(?!\w)", text)
    if not found:
        return None
    return Fraction(int(found[1] or 1), int(found[2] or 1)) if "f" in found[0] else Fraction(0)


def _image_said(part: Part, size: Fraction) -> set[int]:
    nature = ("virtual,", "অবাস্তব (") if size < 0 else ("real,", "বাস্তব (real)")
    sizes = ("larger", "বড়"), ("as large", "সমান"), ("smaller", "ছোট")
    return part.saying(*nature) & part.saying(*sizes[(abs(size) <= 1) + (abs(size) < 1)])


@solves("which-effects-to-simulate")
def effects(page: Page) -> dict[str, Any]:
    """Notes 4.5, 4.8, X-C03, X-C10: each effect in pixels or steps; an estimate decides."""
    f, z, s, pitch = page["f"], page["z"], page["s"], page["p"]
    disc = f**2 * abs(z - s) / (page["N"] * z * (s - f)) / pitch
    moved = abs(page["k_1"]) * (page["R"] * pitch / f) ** 2 * page["R"]
    skew = page["v"] * page["H"] * page["t_r"] * f / (z * pitch)
    spread = re.search(r"σ\D{1,4}([\d.]*\d)", page.stem)
    assert spread
    noise = Fraction(spread[1]) * 255 / page["F"]
    changes = {("shutter",): page["G"] * skew, ("noise",): 4 * noise,
               ("defocus",): page["G"] * disc,
               ("distortion",): page["G"] * moved}  # fmt: skip
    small = [word for words, change in changes.items() if change <= 2 for word in words]
    return {"a": disc, "b": moved, "c": skew, "d": noise, "e": page.parts["e"].saying(*small)}


def distorted(
    x: Fraction, y: Fraction, k_1: Fraction, k_2: Fraction = Fraction(0)
) -> tuple[Fraction, Fraction]:
    """Notes 4.5, F20: a point times 1 + k_1 r^2 + k_2 r^4."""
    square = x * x + y * y
    factor = 1 + k_1 * square + k_2 * square**2
    return x * factor, y * factor


@solves("radial-point-off-axis")
def off_axis(page: Page) -> dict[str, Any]:
    """Notes 4.5, F20 and F22."""
    x, y = points(page.stem)[-1]
    u, v = distorted(x, y, page["k_1"], page["k_2"])
    share = math.hypot(u, v) / math.hypot(x, y) - 1
    kind = ("barrel",) if share < 0 else ("pincushion",)
    return {"a": (u, v), "b": share, "c": page.parts["c"].saying(*kind)}


@solves("radial-points-and-line-bow")
def points_and_line(page: Page) -> dict[str, Any]:
    """Notes C12, F20; the bow of a line replaces the argument of the notes (E02)."""
    a, b = page.point("A"), page.point("B")
    k_1, k_2 = page["k_1"], page["k_2"]
    on_a, on_b = distorted(*a, k_1, k_2), distorted(*b, k_1, k_2)
    above = next(one for one in points(page.parts["e"].text) if one[0] == a[0] and one[1])
    bow = distorted(*above, k_1, k_2)[0] - on_a[0]
    kind, way = (BARREL, OUTWARDS) if bow < 0 else (PINCUSHION, INWARDS)
    share = (on_b[0] - on_a[0]) / (b[0] - a[0])
    said = {"c": page.parts["c"].saying(*kind), "f": page.parts["f"].saying(*way)}
    return {"a": on_a, "b": on_b, "d": share, "e": bow, **said}


BARREL = ("barrel", "picture in", "smaller", "ভেতরে আসে", "ছোট হয়")
PINCUSHION = ("pincushion", "picture out", "larger", "বাইরে যায়", "বড় হয়")
OUTWARDS = ("outwards", "nearer", "বাইরের দিকে", "axis-এর কাছে")
INWARDS = ("inwards", "farther", "ভেতরের দিকে", "axis থেকে দূরে")


@solves("recognise-distortion-from-numbers")
def square_in_numbers(page: Page) -> dict[str, Any]:
    """Notes 4.5: where the corners go against the middle of an edge."""
    asked = {"barrel": ("barrel",), "pincushion": ("pincushion",),
             "scale": ("change of scale", "মাপের"), "turned": ("rotation", "ঘূর্ণন"),
             "tilt": ("tilted", "হেলানো")}  # fmt: skip
    question = page.text.rpartition("\n1; 0")[2]
    kind = next(name for name, words in asked.items() if any(w in question for w in words))
    return {"a": page.parts["a"].those(lambda text: _kind(points(text)) == kind)}


def _kind(places: list[tuple[Fraction, ...]]) -> str:
    (x, y), low, edge = places
    if low == (x, -y) and x == y:
        bend = math.hypot(x, y) / math.sqrt(2) - abs(edge[0])
        return "scale" if abs(bend) < 1e-12 else "barrel" if bend < 0 else "pincushion"
    return "turned" if low == (y, -x) else "tilt"


@solves("straight-line-counterexample")
def bent_line(page: Page) -> dict[str, Any]:
    """Errata E02: only lines through the centre stay straight, so one beside it will do."""
    names = ("A_x", "A_y", "B_x", "B_y", "C_x", "C_y")
    half = Fraction(1, 2)
    return {"a": dict(zip(names, (half, Fraction(0), half, half, half, Fraction(1)), strict=True))}
