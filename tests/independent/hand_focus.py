"""Depth of field, exposure, diffraction and the sensor, from the textbook's formulas."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Any

from by_hand import solves
from printed_numbers import APERTURE, numbers, points, quantities
from printed_page import Page


def f_number(text: str) -> Fraction:
    """The only f-number of a text."""
    (found,) = set(APERTURE.findall(text))
    return Fraction(found)


@solves("exposure-equivalence")
def equal_exposure(page: Page) -> dict[str, Any]:
    """Curriculum X-A13, F35: time goes with N squared and against ISO."""
    before, after = page.f_numbers()
    slow, fast = page.amounts("")
    (old,) = page.amounts("s")
    longer = (after / before) ** 2
    return {"a": longer, "b": old * longer * slow / fast}


@solves("best-pinhole-diameter")
def best_pinhole(page: Page) -> dict[str, Any]:
    """Curriculum X-C30: d = k sqrt(f lambda), then F31 and F35."""
    d = float(page["k"]) * math.sqrt(page["f"] * page["λ"])
    n = float(page["f"]) / d
    (old,), lens = page.amounts("s", "c"), f_number(page.parts["c"].text)
    depths = {("four times", "চার গুণ"): "times-two", ("twice", "দ্বিগুণ"): "times-root",
              ("quarter", "চার ভাগের"): "by-two", ("half", "অর্ধেক"): "by-root"}  # fmt: skip
    told = {"times-two": ("twice as wide", "ব্যাস দ্বিগুণ"), "times-root": ("becomes sqrt(2) times", "ব্যাস sqrt(2) গুণ"),
            "by-two": ("half as wide", "ব্যাস অর্ধেক"), "by-root": ("becomes 1/sqrt(2)", "1/sqrt(2) গুণ")}  # fmt: skip
    asked = page.parts["d"].text
    case = next(case for words, case in depths.items() if any(w in asked for w in words))
    said = page.parts["d"].saying(*told[case])
    return {"a": d, "b": n, "c": float(old) * (n / float(lens)) ** 2, "d": said}


def sharp_zone(page: Page) -> tuple[Fraction, Fraction, Fraction]:
    """Hyperfocal distance and the ends of the zone, where the lens equation gives a disc of c."""
    f, s, c = page["f"], page["s"], page["c"]
    sensor, hole = f * s / (s - f), f / f_number(page.stem)
    tip = [sensor * hole / (hole + way * c) for way in (-1, 1)]
    near, far = (f * image / (image - f) for image in tip)
    return f * hole / c + f, near, far


@solves("depth-of-field-limits")
def depth_of_field(page: Page) -> dict[str, Any]:
    """Curriculum X-C01."""
    hyperfocal_at, near, far = sharp_zone(page)
    return {"a": hyperfocal_at, "b": near, "c": far, "d": far - near}


SHARES = {Fraction(1, 4): ("quarter", "চার ভাগের এক"), Fraction(1, 3): ("third", "তিন ভাগের এক"),
          Fraction(1, 2): ("half", "অর্ধেক"), Fraction(3, 5): ("three fifths", "পাঁচ ভাগের তিন"),
          Fraction(4, 5): ("four fifths", "পাঁচ ভাগের চার"), Fraction(1): ("itself", "ঠিক H")}  # fmt: skip


@solves("depth-of-field-split")
def split_of_zone(page: Page) -> dict[str, Any]:
    """Curriculum X-D09; from b/a = (H + s)/(H - s) follows s = H (q - 1)/(q + 1)."""
    hyperfocal_at, near, far = sharp_zone(page)
    front, behind = page["s"] - near, far - page["s"]
    wanted = numbers(page.parts["d"].text)[0]
    said = page.parts["d"].saying(*SHARES[(wanted - 1) / (wanted + 1)])
    return {"a": hyperfocal_at, "b": (front, behind), "c": behind / front, "d": said}


@solves("which-photo-which-focus")
def focus_photos(page: Page) -> dict[str, Any]:
    """Curriculum X-C03, from the lens equation: the cone of z cut where s is sharp."""
    asked, f = page.parts["b"].text, page["f"]
    told = page.amounts("m", "b")
    z, s = told if "How large" in asked else reversed(told)
    tip, sensor = f * z / (z - f), f * s / (s - f)
    return {"b": f / f_number(asked) * abs(sensor - tip) / tip}


@solves("hyperfocal-distance")
def hyperfocal(page: Page) -> dict[str, Any]:
    """Curriculum X-C02: H = f^2/(N c) + f; sharp from H/2."""
    f, c = page["f"], page["c"]
    (near,) = page.amounts("m", "c")
    asked = page.parts["b"].text.partition("(")[0]
    begins = "H/3" if "H/2" in asked else "2/3⋅H" if "2H" in asked else "H"
    sharp = page.parts["b"].those(
        lambda text: f"from {begins} " in text or text.startswith(f"{begins} ")
    )
    return {
        "a": f * f / (f_number(page.stem) * c) + f,
        "b": sharp,
        "c": f * f / (c * (2 * near - f)),
    }


@solves("diffraction-and-pixel-pitch")
def diffraction(page: Page) -> dict[str, Any]:
    """Curriculum X-C29: the disc is k lambda N wide."""
    per_stop = page["k"] * page["λ"]
    disc = per_stop * f_number(page.stem)
    wide = disc > 2 * page["p"]
    words = (("in focus more", "finer pixels", "focus-এ থাকা", "আরও ছোট pixel-এর") if wide
             else ("The pixels limit", "before diffraction", "সীমিত হচ্ছে", "চোখে পড়ার আগে"))  # fmt: skip
    return {"a": disc, "b": disc / page["p"], "c": page.parts["c"].saying(*words),
            "d": 2 * page["p"] / per_stop}  # fmt: skip


@solves("field-of-view")
def field_of_view(page: Page) -> dict[str, Any]:
    """Curriculum X-A11: 2 atan(S/2f)."""
    width, height, f = page["W"], page["H"], page["f"]
    (wall,) = page.amounts("m", "c")
    angles = [
        2 * math.degrees(math.atan(size / (2 * f))) for size in (width, math.hypot(width, height))
    ]
    return {"a": angles[0], "b": angles[1], "c": width * wall / f}


@solves("motion-blur-in-pixels")
def motion_blur(page: Page) -> dict[str, Any]:
    """Curriculum X-C11: b = f v t / Z."""
    speed = page["f"] * page["v"] / page["Z"]
    return {"a": speed * page["t"], "b": 1 / speed}


@solves("pixel-back-to-ray")
def back_to_ray(page: Page) -> dict[str, Any]:
    """Curriculum X-C22: F09 solved for the direction."""
    u, v = page.point("(u, v)")
    o_x, o_y = points(page.stem)[0]
    x, y, depth = (u - o_x) / page["f_x"], (v - o_y) / page["f_y"], page["Z"]
    return {"a": (x, y), "b": (x * depth, y * depth), "c": math.hypot(x, y, 1) * float(depth)}


@solves("vanishing-point-of-a-line")
def vanishing_point(page: Page) -> dict[str, Any]:
    """Curriculum X-C14: where the direction itself is imaged; parallel lines share it."""
    d = page.point("d")
    o_x, o_y = points(page.stem)[0]

    def parallel(text: str) -> bool:
        other = points(text)[-1]
        return all(d[i] * other[j] == d[j] * other[i] for i in range(3) for j in range(i))

    place = (o_x + page["f"] * d[0] / d[2], o_y + page["f"] * d[1] / d[2])
    return {"a": place, "b": page.parts["b"].those(parallel)}


@solves("dynamic-range-of-sensor")
def dynamic_range(page: Page) -> dict[str, Any]:
    """Curriculum X-C07 and E25; n bits make 2^n - 1 steps."""
    full, noise = page.amounts("")[0], page["σ_r"]
    ratio = full / noise
    bits = next(n for n in range(1, 40) if full / (2**n - 1) <= noise)
    return {"a": (ratio, math.log2(ratio)), "b": 20 * math.log10(ratio), "c": bits}


@solves("flat-field-two-pixels")
def flat_field(page: Page) -> dict[str, Any]:
    """Curriculum X-C17, E31: (raw - dark)/(flat - dark) times the mean."""
    (dark,) = numbers(re.split(r"\|", page.stem)[0])[:1]
    pairs = [(page[f"r_{i}"], page[f"f_{i}"]) for i in (1, 2)]
    done = tuple((raw - dark) / (flat - dark) * page["m"] for raw, flat in pairs)
    raw, flat = pairs[1]
    return {"a": done, "b": raw / flat * page["m"]}


@solves("rolling-shutter-skew")
def skew(page: Page) -> dict[str, Any]:
    """Curriculum X-C10: v t_row rows, at the angle atan(v t_row)."""
    (row,), (speed,) = page.amounts("µs"), page.amounts("px/s")
    rows = next(n for n in page.amounts("") if n > 1)
    return {"a": speed * row * rows, "b": math.degrees(math.atan(speed * row))}


@solves("snr-of-one-pixel")
def pixel_snr(page: Page) -> dict[str, Any]:
    """Curriculum X-C08: variances add up."""
    parts = {
        ("light", "আলো"): page["S"],
        ("dark",): page["D"],
        ("read-out", "রিড"): page["σ_r"] ** 2,
    }
    noise = math.sqrt(sum(parts.values()))
    most = max(parts, key=lambda words: parts[words])
    return {"a": noise, "b": float(page["S"]) / noise, "c": page.parts["c"].saying(*most)}


@solves("veiling-glare-and-contrast")
def veiling_glare(page: Page) -> dict[str, Any]:
    """Two pixels of a hundred: what strays is pooled and shared out, share by share."""
    white, astray = page["w"], page["q"]
    pooled = astray * (white * page["a"] + (1 - white) * page["b"])
    bright, dark = (page[name] - astray * page[name] + pooled for name in "ab")
    return {"a": pooled / astray, "b": dark, "c": bright / dark}


@solves("axial-colour-blur")
def axial_colour(page: Page) -> dict[str, Any]:
    """A red ray at the rim of the aperture, straight to the red focus: its height at the sensor."""
    rim = page["f"] / f_number(page.stem) / 2
    focus = page["f"] + page["e"]
    height = rim - rim / focus * page["f"]
    pixels = 2 * height / page["p"]
    return {"a": 2 * height, "b": pixels, "c": f_number(page.stem) * pixels}


@solves("binning-and-noise")
def binning(page: Page) -> dict[str, Any]:
    """One photosite's ratio times the root of their number; then one read-out for all."""
    sites = page["k"] ** 2
    single = float(page["S"]) / math.sqrt(page["S"] + page["σ_r"] ** 2)
    block = sites * page["S"]
    once = float(block) / math.sqrt(block + page["σ_r"] ** 2)
    return {"a": single * math.sqrt(sites), "b": once, "c": 2 * page["k"] * page["p"]}


@solves("infrared-leak")
def infrared(page: Page) -> dict[str, Any]:
    """Both rows of the table multiplied out, from the cells."""
    green, dark = (math.prod(quantities(cell)[0][0] for cell in row[1:]) for row in page.rows[1:])
    whole = green + dark
    return {"a": whole, "b": dark / whole, "c": page["T_1"] * green / whole}


@solves("lateral-colour-shift")
def lateral_colour(page: Page) -> dict[str, Any]:
    """Both images of the point, and the distance between them."""
    green = page["x"], page["y"]
    red = [place * (1 + page["q"]) for place in green]
    return {
        "a": math.dist(map(float, red), map(float, green)),
        "b": red[0] - green[0],
        "c": 1 / page["q"],
    }


@solves("ccd-streak-and-overflow")
def ccd_overflow(page: Page) -> dict[str, Any]:
    """The column as a whole holds what fell on the lamp's photosites; then so many steps under it."""
    full, lit = page["F"], page["h"]
    spilt = lit * page["Q"] - lit * full
    per_second = page["Q"] / page["t"]
    return {"a": spilt / (full - page["b"]), "b": per_second * page["t_r"] * lit}
