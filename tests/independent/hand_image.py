"""Images and pixels: quantisers, edits of grey levels, amounts of data."""

from __future__ import annotations

import re
from fractions import Fraction
from math import hypot, log2, sqrt
from typing import Any

from by_hand import solves
from printed_numbers import named, numbers, quantities
from printed_page import Page


@solves("quantiser-from-staircase", figure=True)
def staircase(page: Page) -> dict[str, Any]:
    """S21, X-A10: the treads tell the rule, the jumps the levels, both sides of a jump the error."""
    (listed,) = re.findall(r"I = ([\d., ]+\d)", page.figure)
    jumps = [float(one) for one in listed.split(", ")]
    tread, top = jumps[1] - jumps[0], len(jumps)
    ends = round(2 * jumps[0] / tread), round(2 * (1 - jumps[-1]) / tread)
    rule = {(1, 1): ("nearest", "কাছের"), (2, 0): ("-1), rounded down", "-1)-এর নিচের"),
            (2, 2): ("for I=1", "I=1 হলে"), (0, 2): ("rounded up", "উপরের")}[ends]  # fmt: skip
    x = float(named(page.parts["c"].text, "I"))
    level = sum(jump < x for jump in jumps)
    worst = max(abs(jump - side / top) for i, jump in enumerate(jumps) for side in (i, i + 1))
    said = page.parts["b"].those(
        lambda text: any(w in text.replace(" ", "") or w in text for w in rule)
    )
    return {"a": log2(top + 1), "b": said, "c": (level, level / top), "d": worst}


@solves("edit-from-photo-and-histogram", figure=True)
def grey_edits(page: Page) -> dict[str, Any]:
    """S21, X-A08, F12: bars, ends and spikes of the histograms tell the edits and their numbers."""
    seen = dict(re.findall(r"(\d): ([^;]*)", page.figure))
    looks = ("separate", "আলাদা"), ("dull", "ম্যাড়মেড়ে"), ("pale", "ফ্যাকাসে")
    places = [next(n for n, text in seen.items() if any(w in text for w in one)) for one in looks]
    (bars, *_), (*_, low, high), (added, *_) = (numbers(seen[place]) for place in places)
    before = named(page.parts["c"].text, "I")
    step = 255 / (bars - 1)
    coarse = min((k * step for k in range(int(bars))), key=lambda level: abs(level - before))
    squeezed = low + before * (high - low) / 255
    return {
        "a": places,
        "b": log2(bars),
        "c": (coarse, squeezed, min(before + added, Fraction(255))),
    }


@solves("data-rate-of-video")
def data_rate(page: Page) -> dict[str, Any]:
    """X-A12: one value per photosite, three channels of a byte per pixel."""
    width, height = numbers(page.stem)[:2]
    (rate,) = (value for value, unit in quantities(page.stem) if unit == "Hz")
    (depth,) = page.amounts("bit")
    raw = width * height * depth * rate
    speeds = [numbers(text)[-1] * 10**9 for text in page.parts["b"].options]
    slowest = min(place for place, speed in enumerate(speeds, 1) if speed >= raw)
    return {"a": raw, "b": {slowest}, "c": width * height * 3 * rate, "d": page["S"] * 8 / raw}


@solves("noise-and-rounding")
def converter(page: Page) -> dict[str, Any]:
    """X-C28: sqrt(sigma^2 + Delta^2/12)."""
    noise, step = float(page["σ"]), float(page["Δ"])
    both, finer = (hypot(noise, size / sqrt(12)) for size in (step, step / 2))
    word = ("yes", "হ্যাঁ") if finer < 0.95 * both else ("no", "না")
    return {
        "a": step / sqrt(12),
        "b": both,
        "c": finer,
        "d": page.parts["d"].those(word.__contains__),
    }
