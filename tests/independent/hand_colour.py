"""Colour, the eye and the sensor's mosaic, from the textbook's formulas and CIE's tables."""

from __future__ import annotations

import colorsys
import math
import re
from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise, product
from typing import Any

from by_hand import solves
from printed_numbers import named, numbers, points, quantities
from printed_page import Page, Part

GRID = [*range(380, 790, 10)]
DAY = """0.000039 0.00012 0.000396 0.00121 0.004 0.0116 0.023 0.038 0.06 0.09098 0.13902 0.20802
0.323 0.503 0.71 0.862 0.954 0.99495 0.995 0.952 0.87 0.757 0.631 0.503 0.381 0.265 0.175 0.107
0.061 0.032 0.017 0.00821 0.004102 0.002091 0.001047 0.00052 0.000249 0.00012 0.00006 0.00003
0.000015"""
NIGHT = """0.000589 0.002209 0.00929 0.03484 0.0966 0.1998 0.3281 0.455 0.567 0.676 0.793 0.904
0.982 0.997 0.935 0.811 0.65 0.481 0.3288 0.2076 0.1212 0.0655 0.03315 0.01593 0.00737 0.003335
0.001497 0.000677 0.000313 0.000148 0.0000715 0.0000353 0.0000178 0.00000914 0.00000478 0.00000255
0.00000138 0.00000076 0.000000425 0.000000241 0.000000139"""
V_DAY = dict(zip(GRID, map(float, DAY.split()), strict=True))
"""Luminous efficiency by day, CIE 1924, and by night, CIE 1951."""
V_NIGHT = dict(zip(GRID, map(float, NIGHT.split()), strict=True))


def seen(table: dict[int, float], length: Fraction) -> float:
    """The value of a curve at a wavelength in metres, between neighbours on a straight line."""
    nm = float(length * 10**9)
    low = int(nm // 10 * 10)
    share = (nm - low) / 10
    return table[low] * (1 - share) + table.get(low + 10, 0) * share


@solves("apparent-colour-of-surface")
def apparent(page: Page) -> dict[str, Any]:
    """Notes 2.5, S05: band by band, light times reflectance."""
    light, surface = page.point("L"), page.point("R")
    return {"a": tuple(a * b for a, b in zip(light, surface, strict=True))}


@solves("hsv-edit-effects")
def edits(page: Page) -> dict[str, Any]:
    """Notes A2, F23 to F26, by the standard library's colorsys."""
    h, s, v = colorsys.rgb_to_hsv(*map(float, points(page.stem)[0]))
    asked = [numbers(page.parts[part].text)[-1] for part in "bcd"]
    made = [(h, s, v * float(asked[0])), (h, s * float(asked[1]), v),
            ((h + float(asked[2]) / 360) % 1, s, v)]  # fmt: skip
    return {part: colorsys.hsv_to_rgb(*one) for part, one in zip("bcd", made, strict=True)}


@solves("hsv-edit-from-pixel")
def which_edit(page: Page) -> dict[str, Any]:
    """Notes A2: which of H, S and V is another one."""
    before, after = points(page.stem)
    (h, s, v), (h_1, s_1, v_1) = (colorsys.rgb_to_hsv(*map(float, one)) for one in (before, after))
    same = [abs(a - b) < 1e-9 for a, b in ((s, s_1), (v, v_1))]
    turned = min((h - h_1) % 1, (h_1 - h) % 1) > 1e-9
    words = ("H", "H-") if turned else ("V", "V-") if same[0] else ("S", "S-")
    if all(abs(a + b - 1) < Fraction(1, 10**9) for a, b in zip(before, after, strict=True)):
        words = ("negative", "নেগেটিভ")
    way = ("same", "একই") if same[1] else ("smaller", "কমেছে") if v_1 < v else ("larger", "বেড়েছে")
    edit = page.parts["a"].those(lambda text: text.startswith(words) or words[0] + " was" in text)
    if words[0] == "negative":
        edit = page.parts["a"].saying(*words)
    return {"a": edit, "b": page.parts["b"].saying(*way)}


@solves("hsv-nonlinearity-counterexample")
def not_additive(page: Page) -> dict[str, Any]:
    """Notes C15, F27: V is not additive where the largest channels differ."""
    colour = points(page.parts["a"].text)[0]
    least = colour.index(min(colour))
    names = ("b_1", "b_2", "b_3")
    room = (1 - colour[least]) / 2
    return {"a": {n: room if i == least else Fraction(0) for i, n in enumerate(names)}}


@solves("hsv-to-rgb")
def to_rgb(page: Page) -> dict[str, Any]:
    """Notes 4.6, F25 and F26."""
    return {"a": colorsys.hsv_to_rgb(float(page["H"]) / 360, float(page["S"]), float(page["V"]))}


@solves("rgb-to-hsv")
def to_hsv(page: Page) -> dict[str, Any]:
    """Notes C15, F23 and F24."""
    colour = [page[name] for name in "RGB"]
    hue, saturation, value = colorsys.rgb_to_hsv(*map(float, colour))
    return {"a": (value, max(colour) - min(colour), saturation), "b": hue * 360}


@solves("hue-near-grey-in-float32")
def near_grey(page: Page) -> dict[str, Any]:
    """Notes 4.6, F24, with red as the largest channel."""
    return {"a": 60 * (page["v"] - 0) / page["u"] % 360}


@solves("white-balance-and-chromaticity")
def white_balance(page: Page) -> dict[str, Any]:
    """X-D12: the card must become grey at its green value; shares of X, Y and Z."""
    gains = tuple(page["G_c"] / page[name] for name in ("R_c", "B_c"))
    pixel = tuple(gain * page[name] for gain, name in zip(gains, ("R_p", "B_p"), strict=True))
    measured = [page[name] for name in "XYZ"]
    return {"a": gains, "b": pixel, "c": tuple(one / sum(measured) for one in measured[:2])}


@solves("lab-distance-and-lightness")
def lab_distance(page: Page) -> dict[str, Any]:
    """X-D16: the longer way through Lab, and CIE's cube root."""
    first, second = (one for one in points(page.stem) if len(one) == 3)
    ways = math.dist(first, second), math.hypot(*page.amounts("", "b"))
    wider = ("first", "প্রথম") if ways[0] > ways[1] else ("other pair", "অন্য জোড়া")
    lightness = 116 * math.cbrt(page["Y"]) - 16
    return {"a": ways[0], "b": page.parts["b"].saying(*wider), "c": lightness}


@solves("luminous-flux-over-bands")
def flux(page: Page) -> dict[str, Any]:
    """Notes 2.5 and 4.9, F02 as a sum: K_m times L R V times the width of a band."""
    rows = [[quantities(cell)[0][0] for cell in row[1:]] for row in page.rows[1:]]
    return {"a": page["K_m"] * page["w"] * sum(light * r * v for light, r, v in rows)}


@solves("metamers-under-two-lamps")
def metamers(page: Page) -> dict[str, Any]:
    """Notes 2.5, F04, X-C26: neighbouring bands of lamp times reflectance, added up."""
    p, q = (one for one in points(page.stem) if len(one) == 4)
    white, second = (points(page.parts[part].text)[0] for part in "ac")

    def responses(lamp: tuple[Fraction, ...], cloth: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
        band = [a * b for a, b in zip(lamp, cloth, strict=True)]
        return tuple(a + b for a, b in pairwise(band))

    first = responses(second, q)[0] - responses(second, p)[0]
    return {"a": responses(white, p), "c": first}


@solves("order-wavelengths-by-brightness")
def brightest_first(page: Page) -> dict[str, Any]:
    """Notes 2.6, S08: by day V, by night V'."""
    lights = page.parts["a"].options
    values = {
        mark: seen(V_DAY, quantities(one)[0][0])
        for mark, one in zip("ABCDEFGH", lights, strict=False)
    }
    return {"a": sorted(values, key=lambda mark: -values[mark]),
            "b": brighter(page.parts["b"], V_NIGHT)}  # fmt: skip


def brighter(part: Part, table: dict[int, float]) -> set[int]:
    """The option whose wavelength has the largest value of a curve."""
    found = [quantities(one) for one in part.options]
    values = [seen(table, one[0][0]) if one else 0 for one in found]
    return {values.index(max(values)) + 1}


@solves("two-lasers-flux-ratio")
def lasers(page: Page) -> dict[str, Any]:
    """Notes 4.9, F03: flux is power times V."""
    first, second = page.amounts("mW")
    ratio = first * page["V_1"] / (second * page["V_2"])
    return {"a": ratio, "b": ratio * second}


BANDS = {("gamma",): (1e5, 1e6), ("X-ray",): (2e4, 1.5e5),
         ("ultraviolet",): (3.27, 100), ("visible", "দৃশ্যমান"): (1.59, 3.27),
         ("infrared",): (0.001, 1.59)}  # fmt: skip
"""Energies of photons in eV where images are made; gamma rays and X-rays overlap."""


@solves("photon-energy-and-band")
def photon(page: Page) -> dict[str, Any]:
    """Notes 2.7, X-A04: E = hc / wavelength."""
    light = named(re.sub(r"(?<=λ)=.*?/λ", "", page.stem), "λ")
    (constant,) = re.findall(r"([\d.]+) eV·nm", page.stem)
    energy = Fraction(constant) / (light * 10**9)
    bands = [word for words, (low, high) in BANDS.items() if low < energy < high for word in words]
    enough = {True: ("yes", "হ্যাঁ"), False: ("no", "না")}[energy >= page["E_g"]]
    limit = Fraction(constant) / page["E_g"] / 10**9
    return {"a": energy, "b": page.parts["b"].saying(*bands), "c": limit,
            "d": page.parts["d"].those(lambda text: text in enough)}  # fmt: skip


PATTERNS = ("RGGB", "BGGR", "GRBG", "GBRG")
COLOURS = {"R": ("red", "লাল"), "G": ("green", "সবুজ"), "B": ("blue", "নীল")}


def mosaic(page: Page) -> dict[tuple[int, int], str]:
    """The colour of a site by the remainders of its column and row."""
    pattern = next(one for one in PATTERNS if one in page.stem)
    return dict(zip(((0, 0), (1, 0), (0, 1), (1, 1)), pattern, strict=True))


@solves("bayer-colour-at-site")
def site(page: Page) -> dict[str, Any]:
    """Notes 4.7 and B6, F28 to F30: where the nearest sites of a colour lie."""
    tile, (x, y) = mosaic(page), (int(page["x"]), int(page["y"]))
    text = page.parts["b"].text
    wanted = next(c for c, words in COLOURS.items() if any(w in text for w in words))
    near = {(dx, dy) for dx, dy in product((-1, 0, 1), repeat=2)
            if tile[(x + dx) % 2, (y + dy) % 2] == wanted}  # fmt: skip
    own = tile[x % 2, y % 2]
    if own == wanted:
        words = ("photosite itself", "এই photosite থেকেই")
    elif len(near) == 4:
        words = ("share an edge", "কিনারা") if (0, 1) in near else ("corners", "কোণার")
    else:
        words = (
            ("above and below", "উপরের আর নিচের")
            if (0, 1) in near
            else ("left and right", "বাঁ আর ডান")
        )
    return {"a": page.parts["a"].saying(*COLOURS[own]), "b": page.parts["b"].saying(*words)}


@solves("bayer-site-counts")
def site_counts(page: Page) -> dict[str, Any]:
    """Notes B6: sites are counted one by one."""
    columns, rows = (int(one) for one in numbers(page.stem)[:2])
    tile = mosaic(page)
    sites = [tile[x % 2, y % 2] for x, y in product(range(columns), range(rows))]
    return {"a": tuple(sites.count(colour) for colour in "RGB")}


@solves("demosaic-blue-and-green-site")
def demosaic(page: Page) -> dict[str, Any]:
    """Notes 4.7, F28 to F30: the means of the four, four and two nearest neighbours."""
    cells = {}
    for y, row in enumerate(page.rows[1:]):
        for x, cell in enumerate(row[1:]):
            colour, value = cell.split()
            cells[x, y] = colour, Fraction(value)

    def mean(colour: str, x: int, y: int) -> Fraction:
        found = {k: v for k, (c, v) in cells.items() if c == colour and k != (x, y)}
        away = {k: (k[0] - x) ** 2 + (k[1] - y) ** 2 for k in found}
        values = [found[k] for k in found if away[k] == min(away.values())]
        return sum(values, Fraction(0)) / len(values)

    (marked,) = numbers(page.parts["b"].text)
    place = next(k for k, (c, v) in cells.items() if c == "G" and v == marked)
    return {"a": (mean("G", 1, 1), mean("R", 1, 1)), "b": mean("R", *place)}


@solves("gamma-encoded-average")
def gamma_means(page: Page) -> dict[str, Any]:
    """Notes D20, F46: the encoded mean and the mean of the encoded."""
    power = 1 / float(named(page.text, "γ"))
    a, b = map(float, numbers(page.stem)[-2:])
    mixed = (a**power + b**power) / 2
    return {"a": (((a + b) / 2) ** power, mixed), "b": mixed ** (1 / power)}


@solves("gamma-linearity-counterexample")
def not_linear(page: Page) -> dict[str, Any]:
    """Notes D20: a concave curve is additive nowhere but at 0."""
    assert page["γ"] > 1
    return {"b": {"a": Fraction(1, 4), "b": Fraction(1, 4)}}


LUMA = {601: (0.299, 0.587, 0.114), 709: (0.2126, 0.7152, 0.0722)}
"""Weights of red, green and blue: ITU-R BT.601 and BT.709."""


def luma(standard: int, colour: Iterable[float]) -> float:
    """The weighted sum of the channels."""
    return sum(w * c for w, c in zip(LUMA[standard], colour, strict=True))


@solves("luma-before-and-after-turn")
def turned_luma(page: Page) -> dict[str, Any]:
    """X-A07; the turn of the hue by colorsys."""
    colour = tuple(float(page[name]) for name in "RGB")
    h, s, v = colorsys.rgb_to_hsv(*colour)
    (angle,) = (float(value) for value, unit in quantities(page.parts["b"].text) if unit == "°")
    before, after = luma(709, colour), luma(709, colorsys.hsv_to_rgb((h + angle / 360) % 1, s, v))
    words = ("lighter", "বেশি উজ্জ্বল") if after > before else ("darker", "কম উজ্জ্বল")
    return {"a": (luma(601, colour), before), "b": after, "c": page.parts["c"].saying(*words)}


@solves("rgb-to-cmyk")
def inks(page: Page) -> dict[str, Any]:
    """X-A06: the grey in all three inks becomes black."""
    plain = [1 - page[name] for name in "RGB"]
    black = min(plain)
    left = [(ink - black) / (1 - black) for ink in plain]
    names = (("cyan",), ("magenta",), ("yellow", "হলুদ"))
    spare = page.parts["c"].saying(*names[left.index(0)])
    return {"a": plain, "b": [*left, black], "c": spare, "d": sum(plain) - sum(left) - black}
