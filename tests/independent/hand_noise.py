"""Noise, normalisation and stored values, from the textbook's formulas."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Any

from by_hand import solves
from printed_numbers import numbers, quantities
from printed_page import Page


def density(x: float, sigma: float) -> float:
    """Notes 4.4, F15: the normal density around 0."""
    return math.exp(-((x / sigma) ** 2) / 2) / (math.sqrt(2 * math.pi) * sigma)


def outside(limit: float, sigma: float) -> float:
    """Notes 4.4, F18: the share beyond a limit on both sides."""
    return math.erfc(limit / (sigma * math.sqrt(2)))


@solves("compare-two-gaussian-noises")
def two_noises(page: Page) -> dict[str, Any]:
    """Notes 4.4, S16: peaks go like 1/sigma, the area is 1."""
    first, second = page["σ_1"], page["σ_2"]
    true = {("areas under both", "ক্ষেত্রফল সমান"): True,
            ("the wider density", "যে density বেশি চওড়া"): False,
            ("beyond one standard", "এক standard deviation-এর"): True,
            ("neither noise", "কোনো noise-এই"): True, ("the stronger noise", "বেশি জোরালো"): False,
            ("the same for both", "অংশ দুটোতেই সমান"): first == second,
            ("first density", "প্রথম density-র"): first < second,
            ("second density", "দ্বিতীয় density-র"): first > second,
            ("first camera", "প্রথম ক্যামেরায়"): first > second,
            ("second camera", "দ্বিতীয় ক্যামেরায়"): first < second}  # fmt: skip

    def holds(text: str) -> bool:
        return next(true for words, true in true.items() if any(w in text for w in words))

    return {"a": second / first, "b": page.parts["b"].those(holds)}


@solves("gaussian-2d-peak-and-axes")
def plane_density(page: Page) -> dict[str, Any]:
    """Notes D16, F41: a product of two normal densities."""
    first, second = page["σ_1"], page["σ_2"]
    g = density(float(page["x"]), float(first)) * density(float(page["y"]), float(second))
    peak = density(0, float(first)) * density(0, float(second))
    return {"a": ((first * second) ** 2, peak), "b": g, "c": first / second}


@solves("gaussian-density-values")
def values_of_density(page: Page) -> dict[str, Any]:
    """Notes 4.4, F15."""
    places = re.findall(r"(?<!\w)n\s*=\s*(-?[\d.]*\d)", page.stem)
    return {"a": tuple(density(float(n), float(page["σ"])) for n in places)}


@solves("gaussian-far-tail-in-float64")
def far_tail(page: Page) -> dict[str, Any]:
    """Notes 4.4, F18; what float64 makes of 1 - erf is tried out."""
    k = float(page["k"])
    share, printed = outside(k, 1), 1 - math.erf(k / math.sqrt(2))
    words = ("exactly 0", "0: ") if printed == 0 else ("only some digits", "কয়েকটা অঙ্ক")
    assert abs(printed / share - 1) > 1e-14
    return {"a": share, "b": page.parts["b"].saying(*words)}


@solves("gaussian-peak-and-tail-shares")
def peak_and_tails(page: Page) -> dict[str, Any]:
    """Notes C13, F16, F18, F19."""
    sigma = float(page["σ"])
    beyond, off = (numbers(page.parts[part].text)[-1] for part in "bc")
    (pixels,) = [v for v, unit in quantities(page.parts["c"].text) if unit == "Mpx"][:1]
    return {"a": density(0, sigma), "b": outside(float(beyond), sigma),
            "c": float(pixels) * outside(float(off), sigma)}  # fmt: skip


@solves("photon-snr-and-decibels")
def photon_snr(page: Page) -> dict[str, Any]:
    """Notes D19, F45: mean over standard deviation of a Poisson count."""
    dark, bright = (math.sqrt(n) for n in numbers(page.stem))
    return {"a": (dark, bright), "b": 20 * math.log10(bright)}


@solves("photon-snr-formula-and-model")
def snr_formula(page: Page) -> dict[str, Any]:
    """Notes D19, F45: N over the root of the variance N."""
    assert "N" in page.stem

    def snr(**symbols: float) -> float:
        (n,) = symbols.values()
        return n / math.sqrt(n)

    return {"a": snr}


@solves("salt-and-pepper-counts")
def impulses(page: Page) -> dict[str, Any]:
    """Notes 6.4, S23: half of those that are hit become black."""
    width, height = numbers(page.stem)[:2]
    pixels, p = width * height, page["p"]
    return {"a": (pixels * p / 2, pixels * p / 2, pixels * (1 - p))}


@solves("normalise-and-clamp")
def clamped(page: Page) -> dict[str, Any]:
    """Notes 4.3, F12 and F13."""
    (low, high), (new, top) = page.ranges()[:2]
    value = (page["I"] - low) / (high - low) * (top - new) + new
    return {"a": value, "b": min(max(value, new), top)}


@solves("normalise-from-8-bit-range")
def from_bytes(page: Page) -> dict[str, Any]:
    """Notes 4.3, F11."""
    return _normalised(page, *page.ranges()[0])


@solves("normalise-from-offset-range")
def from_range(page: Page) -> dict[str, Any]:
    """Notes 4.3, F11, the range being given in words."""
    low, high = [n for n in numbers(page.stem) if n != page["I"]][:2]
    return _normalised(page, low, high)


def _normalised(page: Page, low: Fraction, high: Fraction) -> dict[str, Any]:
    share = (page["I"] - low) / (high - low)
    to = {part: page.ranges(part)[0] for part in "ab"}
    return {part: share * (top - new) + new for part, (new, top) in to.items()}


CHANNELS = [("alpha", 2), ("RGBA", 4), ("RGB-D", 4), ("CMYK", 4), ("RGB", 3), ("HSV", 3),
            ("Lab", 3), ("raw", 1), ("mask", 1), ("grey", 1), ("ধূসর", 1)]  # fmt: skip


@solves("channel-counts")
def channels(page: Page) -> dict[str, Any]:
    """Notes A1: one letter one channel; a raw mosaic and a mask have one."""
    lines = [line.partition(":")[2] for line in page.stem.split("\n") if line.startswith("n_")]
    return {"a": tuple(_channels(line) for line in lines)}


def _channels(line: str) -> int:
    bands = numbers(line)
    return int(bands[0]) if bands else _by_name(line)


def _by_name(line: str) -> int:
    return next(count for word, count in CHANNELS if word in line)


@solves("floats-or-uint8")
def bytes_wrap(page: Page) -> dict[str, Any]:
    """Notes B8, F36 and F01."""
    a, b, c, d = numbers(page.parts["b"].text.replace("- ", "").replace("uint8", ""))
    width, height = numbers(page.parts["c"].text)[:2]
    return {"b": ((a + b) % 256, (c - d) % 256), "c": width * height * 3 * 4}


@solves("pixel-index-and-shape")
def index_and_shape(page: Page) -> dict[str, Any]:
    """Notes 2.2, S02: rows first; Python counts negative numbers from the end."""
    width, height, count = map(int, numbers(page.stem))
    where = (int(page["y"]), int(page["x"]))
    (line,) = page.programs
    row, column = map(int, numbers(line.partition("[")[2]))
    if not -height <= row < height:
        words = ("no such row", "সারিটা নেই")
    elif not -width <= column < width:
        words = ("no such column", "column-টা নেই")
    else:
        words = (
            ("opposite edge", "উল্টো কিনারা") if min(row, column) < 0 else ("upper left", "উপরের বাঁ")
        )
    return {"a": str(where), "b": str((height, width, count)), "c": page.parts["c"].saying(*words)}


@solves("quantisation-levels-and-error")
def quantised(page: Page) -> dict[str, Any]:
    """Notes 2.13, F01, X-A10: levels spread over both ends."""
    bits = numbers(page.stem)[2]
    levels = 2 ** int(bits)
    step = Fraction(1, levels - 1)
    level = math.floor(page["x"] / step + Fraction(1, 2))
    return {"a": (levels, step), "b": level, "c": step / 2}


@solves("stored-values-and-bytes")
def stored(page: Page) -> dict[str, Any]:
    """Notes 2.1, F01: width, height, channels, bits."""
    width, height, bits = numbers(page.stem)[:3]
    values = width * height * _by_name(page.stem)
    return {"a": values, "b": values * bits / 8}


@solves("value-range-and-type")
def value_range(page: Page) -> dict[str, Any]:
    """Notes 2.3, S03, F36."""
    bits = int(numbers(page.stem)[0])
    size = next(one for one in (1, 2, 4) if 8 * one >= bits)
    more = numbers(page.parts["b"].text)[-1]
    return {"a": (2**bits, 2**bits - 1, size), "b": (2**bits - 1 + more) % 2**bits}


@solves("salt-and-pepper-mean-and-psnr")
def impulses_on_grey(page: Page) -> dict[str, Any]:
    """X-C20: averages over the three things that can become of a pixel."""
    grey, share = float(page["v"]), float(page["p"])
    fates = [(grey, 1 - share), (0, share / 2), (255, share / 2)]
    mean = sum(level * chance for level, chance in fates)
    error = sum((level - grey) ** 2 * chance for level, chance in fates)
    words = ("brighter", "উজ্জ্বল হয়") if mean > grey else ("darker", "অন্ধকার হয়")
    return {"a": mean, "b": error, "c": 10 * math.log10(255**2 / error),
            "d": 10 * math.log10(page["m"]), "e": page.parts["e"].saying(*words)}  # fmt: skip
