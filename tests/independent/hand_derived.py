"""Derivations: what is true of the letters of a page, from the textbook's formulas.

A solver gives the derived quantities as functions of the free ones; each line of the key must hold
for them at many places, and each known mistake must not.
"""

from __future__ import annotations

import colorsys
import math
import re
from collections.abc import Callable, Mapping
from typing import Any

from by_hand import solves
from printed_numbers import numbers, points
from printed_page import Page

Values = Mapping[str, Any]
Truth = Callable[[Values], dict[str, Any]]


@solves("derive-perspective-projection")
def perspective(page: Page) -> dict[str, Any]:
    """Notes 4.1, F05; behind the hole the picture stands upside down."""
    axis = "x" if "p_x" in page.stem else "y"
    way = -1 if page.says("physical") else 1
    return {"a": lambda v: {f"p'_{axis}": way * v["f"] * v[f"p_{axis}"] / v["p_z"]}}


@solves("derive-blur-disc")
def blur_disc(_page: Page) -> dict[str, Any]:
    """Notes 4.8, F33."""
    return {"a": lambda v: {"c": v["D"] * abs(v["z'_s"] - v["z'_p"]) / v["z'_p"]}}


@solves("derive-pixel-coordinates")
def pixel_coordinates(page: Page) -> dict[str, Any]:
    """Notes 4.2, F08 and F09; with y upward rows are subtracted (E28)."""
    dense = "m_x" in page.stem
    way = -1 if page.says("up, against", "উপরের দিকে") else 1

    def density(v: Values, axis: str) -> Any:
        return v[f"m_{axis}"] if dense else 1 / v[f"s_{axis}"]

    def column(v: Values) -> dict[str, Any]:
        image = v["f"] * v["p_x"] / v["p_z"]
        return {"p'_x": image, "u": v["o_x"] + image * density(v, "x")}

    def row(v: Values) -> dict[str, Any]:
        return {"v": v["o_y"] + way * v["f"] * v["p_y"] / v["p_z"] * density(v, "y")}

    return {"a": column, "b": row}


@solves("show-shot-noise-snr")
def shot_noise(page: Page) -> dict[str, Any]:
    """Notes 4.9, F45: a Poisson count has the root of its mean as its standard deviation."""
    times = float(numbers(page.parts["b"].text)[0])
    return {
        "a": lambda v: {"sigma": math.sqrt(v["N"]), "SNR": v["N"] / math.sqrt(v["N"])},
        "b": lambda _: {"q": math.sqrt(times)},
    }


@solves("show-lens-becomes-pinhole")
def lens(page: Page) -> dict[str, Any]:
    """Notes D17, F42, in millimetres."""
    focal = float(page["f"] * 1000)
    return {"a": lambda v: {"f": focal, "z'": 1 / (1 / focal - 1 / v["z"])}}


@solves("derive-weak-perspective-error")
def weak_perspective(page: Page) -> dict[str, Any]:
    """Notes D18, F44 and E41."""
    way = -1 if page.says("near end", "কাছের প্রান্তের") else 1
    to_true = page.says("over the true scale", "ভাগ true scale")

    def error(f: float, mean: float, off: float) -> tuple[float, float, float]:
        true, weak = f / (mean + way * off), f / mean
        return true, weak, (true - weak) / (true if to_true else weak)

    depth, half = map(float, page.amounts("m", "b"))
    return {
        "a": lambda v: dict(zip("swe", error(v["f"], v["Z"], v["d"]), strict=True)),
        "b": lambda _: {"e": error(1.0, depth, half)[2]},
    }


@solves("show-isotropic-case")
def density_in_the_plane(page: Page) -> dict[str, Any]:
    """Notes D16, F41: a product of two normal densities."""
    diagonal = "σ_1" in page.stem

    def density(v: Values) -> dict[str, Any]:
        first, second = (v["sigma_1"], v["sigma_2"]) if diagonal else (v["sigma"], v["sigma"])
        way = (v["x"] / first) ** 2 + (v["y"] / second) ** 2
        both = math.exp(-((v["x"] / first) ** 2) / 2) * math.exp(-((v["y"] / second) ** 2) / 2)
        return {"k": (first * second) ** 2, "q": way, "p": both / (2 * math.pi * first * second)}

    found = re.search(r"(\d) (?:and|ও) (\d)", page.parts["b"].text)
    first, second = (int(one) for one in found.groups()) if found else (0, 0)
    return {"a": density, "b": lambda _: {"p_0": 1 / (2 * math.pi * first * second)}}


@solves("derive-normalisation")
def normalisation(page: Page) -> dict[str, Any]:
    """Notes 4.3, F11."""
    low, high, bottom, top = map(float, numbers(page.stem)[:4])
    slope = (top - bottom) / (high - low)
    return {"a": lambda v: {"a": slope, "b": bottom - slope * low,
                            "N": bottom + (v["I"] - low) * slope}}  # fmt: skip


@solves("derive-stops-and-time")
def stops(page: Page) -> dict[str, Any]:
    """Notes 4.8, F31, F34 and F35."""
    first, second = map(float, page.f_numbers()[:2])
    times = (second / first) ** 2
    return {"a": lambda v: {"D_1": v["f"] / first, "D_2": v["f"] / second, "q": times,
                            "n": math.log2(times)}}  # fmt: skip


@solves("show-a-line-bends")
def bent_line(page: Page) -> dict[str, Any]:
    """Notes 4.5, F20 and F21."""
    found = re.search(r"([xy]) = ", page.stem)
    held = found[1] if found else ""
    along, place, k = "y" if held == "x" else "x", float(page[held]), float(page["k_1"])

    def moved(other: float) -> float:
        return place * (1 + k * (place**2 + other**2))

    return {
        "a": lambda v: {"r": math.hypot(place, v[along]), f"{held}'": moved(v[along])},
        "b": lambda _: {"q_0": moved(0), "q_1": moved(0.5), "q_2": moved(1)},
    }


@solves("show-gamma-mismatch")
def gamma(page: Page) -> dict[str, Any]:
    """Notes D20, F46."""
    found = re.search(r"(?:are|মান দুটো) ([\d.]+) (?:and|ও) ([\d.]+)", page.stem)
    one, other = (float(text) for text in found.groups()) if found else (0.0, 0.0)
    encoded = [light ** (1 / 2.2) for light in (one, other)]
    return {"a": lambda _: {"g": ((one + other) / 2) ** (1 / 2.2), "m": sum(encoded) / 2}}


@solves("prove-hsv-not-linear")
def value_of_sums(page: Page) -> dict[str, Any]:
    """Notes 4.6, F23 and F27."""
    one, other = page.point("a"), page.point("b")
    both = max(a + b for a, b in zip(one, other, strict=True))
    return {"a": lambda _: {"V_a": float(max(one)), "V_b": float(max(other)), "V_s": float(both)}}


@solves("derive-even-powers")
def even_powers(page: Page) -> dict[str, Any]:
    """Notes 4.5, F20 and E29: what is left of a smooth factor that is the same on both sides."""
    quartic = "a_4" in page.stem

    def factor(v: Values) -> dict[str, Any]:
        left = 1 + v["a_2"] * v["r"] ** 2 + (v["a_4"] * v["r"] ** 4 if quartic else 0)
        return {"a_1": 0, "a_3": 0, "L": left, "M": left, "x'": v["x"] * left}

    return {"a": factor}


@solves("derive-width-of-gaussian")
def width_of_bell(page: Page) -> dict[str, Any]:
    """Notes 4.4, F15: where the bell has fallen to a share of its peak, by halving an interval."""
    shares = {"half": 2, "quarter": 4, "tenth": 10, "twentieth": 20,
              "অর্ধেক": 2, "চার ভাগ": 4, "দশ ভাগ": 10, "বিশ ভাগ": 20}  # fmt: skip
    share = next(1 / parts for word, parts in shares.items() if word in page.stem)

    def place(sigma: float) -> float:
        low, high = 0.0, 10 * sigma
        for _ in range(200):
            middle = (low + high) / 2
            above = math.exp(-((middle / sigma) ** 2) / 2) > share
            low, high = (middle, high) if above else (low, middle)
        return low

    spread = float(numbers(page.parts["b"].text.split("=")[1])[0])
    return {"a": lambda v: {"x": place(v["sigma"])}, "b": lambda _: {"w": 2 * place(spread)}}


@solves("show-radial-line-stays-straight")
def radial_line(page: Page) -> dict[str, Any]:
    """Notes 4.5, F20 and E02: both coordinates times the same factor."""
    slope = float(page["y"])

    def moved(v: Values) -> dict[str, Any]:
        x, y = v["x"], slope * v["x"]
        r = math.hypot(x, y)
        factor = 1 + v["k_1"] * r**2
        return {"y": y, "r": r, "x'": x * factor, "y'": y * factor}

    return {"a": moved}


@solves("derive-distance-from-two-pictures")
def two_pictures(page: Page) -> dict[str, Any]:
    """Notes 4.1, F05 and F10: depth times height in the picture is the same twice."""
    way = 1 if page.says("away from it", "পেছনে") else -1
    step, tall, small = (float(page[name]) for name in ("d", "h_1", "h_2"))

    def heights(v: Values) -> dict[str, Any]:
        return {"h_1": v["f"] * v["Y"] / v["Z"], "h_2": v["f"] * v["Y"] / (v["Z"] + way * v["d"])}

    return {"a": heights, "b": lambda _: {"Z": small * way * step / (tall - small)}}


@solves("derive-dolly-zoom")
def dolly_zoom(page: Page) -> dict[str, Any]:
    """Notes 4.1, F05 and F07: sizes are focal length over depth."""
    times = float(numbers(page.stem)[0])
    behind = float((*numbers(page.parts["b"].text), 1)[0])  # *hangs Z behind the actor*

    def actor(v: Values) -> dict[str, Any]:
        height = v["f"] * v["Y"] / v["Z"]
        return {"h_1": height, "h_2": height, "f_2": height * times * v["Z"] / v["Y"]}

    def poster(v: Values) -> dict[str, Any]:
        depth = (1 + behind) * v["Z"]
        before = v["f"] * v["W"] / depth
        after = times * v["f"] * v["W"] / (depth + (times - 1) * v["Z"])
        return {"f_2": times * v["f"], "w_1": before, "w_2": after, "m": after / before}

    return {"a": actor, "b": poster}


@solves("derive-flat-field")
def flat_field(page: Page) -> dict[str, Any]:
    """F39 and E31: the share that gets through is the same for wall and scene."""
    raw, flat, dark, wall = (float(page[name]) for name in ("R", "W", "D", "L_0"))
    return {
        "a": lambda v: {"R": v["D"] + v["v"] * v["L"], "W": v["D"] + v["v"] * v["L_0"]},
        "b": lambda _: {"L": (raw - dark) / ((flat - dark) / wall)},
    }


@solves("show-saturation-under-light")
def saturation(page: Page) -> dict[str, Any]:
    """Notes 4.6, F23, by the standard library's own conversion for the pixel."""
    added = page.says("added to all three", "একই সংখ্যা w যোগ")
    found = points(page.parts["b"].text)[0]
    by = float(numbers(page.parts["b"].text.split(")")[1])[0])
    after = [float(one) + by if added else float(one) * by for one in found]

    def both(v: Values) -> dict[str, Any]:
        pair = [v["M"] + v["w"], v["m"] + v["w"]] if added else [v["k"] * v["M"], v["k"] * v["m"]]
        return {"S": 1 - v["m"] / v["M"], "S'": 1 - pair[1] / pair[0]}

    return {"a": both, "b": lambda _: {"S'": colorsys.rgb_to_hsv(*after)[1]}}


@solves("derive-noise-of-a-mean")
def mean_of_noise(page: Page) -> dict[str, Any]:
    """Notes 2.13, X-C09: variances of independent values add up."""
    block = page.says("blocks of", "block গড়")
    times = float(numbers(page.parts["b"].text)[0])

    def of_mean(v: Values) -> dict[str, Any]:
        count = v["n"] ** 2 if block else v["n"]
        return {"V": count * v["sigma"] ** 2, "s": v["sigma"] * count**-0.5}

    return {"a": of_mean, "b": lambda _: {"n": times if block else times * times}}


@solves("derive-quantisation-error")
def rounding_error(page: Page) -> dict[str, Any]:
    """Notes 2.13, X-A10: half the distance of two of 2^b levels."""
    volts, bits = (float(one) for one in numbers(page.parts["b"].text)[:2])

    def error(top: float, count: float) -> dict[str, Any]:
        step = top / (2**count - 1)
        return {"n": 2**count, "d": step, "e": step / 2}

    return {"a": lambda v: error(v["A"], v["b"]),
            "b": lambda _: {"e": 1000 * error(volts, bits)["e"]}}  # fmt: skip
