"""Printed sheets as students and scanners leave them: pens, corrections, stains, copiers, phones.

Shares nothing with the code that reads them but the places of the fields; drawn with Pillow.
"""

from __future__ import annotations

import io
import math
import random
import subprocess
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

DPI = 200
PER_MM = DPI / 25.4
FINE = 3
"""Strokes are drawn so much larger, then made smaller, so that their edges are soft."""

STROKES = {
    "0": ["0.5,0 0.1,0.2 0,0.6 0.3,1 0.8,0.9 1,0.5 0.8,0.1 0.5,0"], "1": ["0.2,0.25 0.6,0 0.6,1"],
    "2": ["0,0.2 0.4,0 0.9,0.2 0.8,0.5 0,1 1,1"], "3": ["0,0.1 0.6,0 0.9,0.25 0.4,0.45 1,0.7 0.6,1 0,0.9"],
    "4": ["0.6,0 0,0.6 1,0.6", "0.7,0.3 0.7,1"], "5": ["0.9,0 0.2,0 0.1,0.45 0.7,0.4 1,0.7 0.6,1 0,0.9"],
    "6": ["0.8,0 0.2,0.4 0.1,0.8 0.5,1 0.9,0.75 0.5,0.5 0.15,0.7"], "7": ["0,0 1,0 0.4,1", "0.2,0.5 0.8,0.5"],
    "8": ["0.5,0.45 0.1,0.2 0.5,0 0.9,0.2 0.5,0.45 0.05,0.75 0.5,1 0.95,0.75 0.5,0.45"],
    "9": ["0.9,0.3 0.5,0.5 0.1,0.25 0.5,0 0.9,0.3 0.7,1"], "-": ["0,0.55 0.9,0.5"], ".": ["0.3,0.97 0.42,1"],
    "n": ["0,0.5 0.05,1 0.1,0.6 0.5,0.45 0.8,0.6 0.85,1"], "e": ["0,0.7 0.9,0.65 0.5,0.4 0.05,0.7 0.4,1 0.9,0.9"],
    "l": ["0.4,1 0.3,0.5 0.6,0 0.7,0.2 0.3,1 0.7,0.95"], "t": ["0.5,0.1 0.45,0.9 0.8,1", "0.1,0.4 0.9,0.35"],
}  # fmt: skip


class Pen:
    """A student's hand: how thick, dark, shaky and large, and what a cross looks like."""

    def __init__(self, seed: object) -> None:
        self.random = r = random.Random(str(seed))
        self.width = r.uniform(0.32, 0.75)
        self.dark = r.choice([0.95, 0.9, 0.8, 0.7, 0.6, 0.5])
        if r.random() < 0.05:
            self.dark = r.uniform(0.3, 0.4)
        self.shape = r.choice(
            ["cross", "cross", "cross", "cross", "hook", "hook", "plus", "zigzag"]
        )
        self.shaky, self.size = r.uniform(0.03, 0.12), r.uniform(0.75, 1.15)
        self.slant = r.uniform(-0.2, 0.3)

    def draw(self, page: Image.Image, strokes, width=None, dark=None) -> Image.Image:
        """Draw strokes, in millimetres, over a page."""
        r, width = self.random, width or self.width
        dark = self.dark if dark is None else dark
        xs = [x for stroke in strokes for x, _ in stroke]
        ys = [y for stroke in strokes for _, y in stroke]
        left, top = math.floor((min(xs) - 2) * PER_MM), math.floor((min(ys) - 2) * PER_MM)
        right, bottom = math.ceil((max(xs) + 2) * PER_MM), math.ceil((max(ys) + 2) * PER_MM)
        layer = Image.new("L", ((right - left) * FINE, (bottom - top) * FINE))
        pen = ImageDraw.Draw(layer)
        for stroke in strokes:
            points = [
                ((x * PER_MM - left) * FINE, (y * PER_MM - top) * FINE)
                for x, y in bend(stroke, self.shaky * 0.8, r)
            ]
            press = r.uniform(0.75, 1)
            for a, b in pairwise(points):
                press = min(1, max(0.55, press + r.gauss(0, 0.05)))
                half = width * PER_MM * FINE * (0.75 + 0.25 * press) / 2
                pen.line([a, b], fill=round(255 * press), width=max(1, round(2 * half)))
                pen.ellipse(
                    [b[0] - half, b[1] - half, b[0] + half, b[1] + half], fill=round(255 * press)
                )
        ink = (
            np.asarray(layer.resize((right - left, bottom - top), Image.Resampling.BOX), np.float32)
            / 255
            * dark
        )
        if dark < 0.45:
            ink *= (
                np.random.default_rng(r.randrange(1 << 30))
                .uniform(0.6, 1.1, ink.shape)
                .astype(np.float32)
            )
        place = (left, top, right, bottom)
        under = np.asarray(page.crop(place), np.float32)
        page.paste(
            Image.fromarray((under * (1 - np.clip(ink, 0, 1))).astype(np.uint8)), (left, top)
        )
        return page

    def strokes_of(self, shape: str, x: float, y: float, size: float):
        """The strokes of a mark around a place, ``size`` mm large."""
        r = self.random

        def at(a: float, b: float) -> tuple[float, float]:
            return x + size * (a + r.gauss(0, self.shaky)), y + size * (b + r.gauss(0, self.shaky))

        if shape == "cross":
            return [[at(-0.5, -0.5), at(0.5, 0.5)], [at(0.5, -0.5), at(-0.5, 0.5)]]
        if shape == "plus":
            return [[at(-0.5, 0), at(0.5, 0)], [at(0, -0.5), at(0, 0.5)]]
        if shape == "hook":
            return [[at(-0.45, -0.05), at(-0.1, 0.42), at(0.75, -0.75)]]
        if shape == "slash":
            return [[at(0.5, -0.5), at(-0.5, 0.5)]]
        turns = r.randint(3, 4)
        return [[at(-0.42 + 0.84 * n / turns, -0.45 if n % 2 else 0.45) for n in range(turns + 1)]]

    def mark(self, page: Image.Image, box: dict, kind: str) -> None:
        """Leave a mark of some kind in or near a box."""
        r, side = self.random, box["w"]
        x, y = (
            box["x"] + side / 2 + r.gauss(0, 0.05) * side,
            box["y"] + side / 2 + r.gauss(0, 0.05) * side,
        )
        size = side * self.size
        if kind == "empty":
            return
        if kind in {"cross", "light", "small", "big", "slash"}:
            scale = {"small": r.uniform(0.45, 0.6), "big": r.uniform(1.4, 1.9)}.get(kind, 1.0)
            shape = "slash" if kind == "slash" else self.shape
            dark = r.uniform(0.22, 0.35) if kind == "light" else None
            self.draw(page, self.strokes_of(shape, x, y, size * scale), dark=dark)
        elif kind == "outside":
            a, b = r.choice([(-1.1, 0), (1.05, 0), (0, -0.95), (0, 0.95)])
            self.draw(page, self.strokes_of(self.shape, x + a * side, y + b * side, size * 0.8))
        elif kind in {"filled", "crossed and filled", "badly filled"}:
            if kind == "crossed and filled":
                self.draw(page, self.strokes_of(self.shape, x, y, size))
            turns = r.randint(6, 7) if kind == "badly filled" else r.randint(10, 14)
            lines = [
                (
                    x + side * (-0.48 + 0.96 * n / turns),
                    y + side * (r.uniform(0.42, 0.5) * (1 if n % 2 else -1)),
                )
                for n in range(turns + 1)
            ]
            self.draw(
                page,
                [lines],
                self.width * (1.1 if kind == "badly filled" else 1.5),
                max(self.dark, 0.5),
            )
            if kind != "badly filled":
                across = [(x + b - y, y + a - x) for a, b in lines]
                self.draw(page, [across], self.width * 1.5, max(self.dark, 0.5))
        elif kind == "erased":
            self.draw(page, self.strokes_of(self.shape, x, y, size), dark=r.uniform(0.04, 0.1))
        elif kind == "dot":
            self.draw(page, [[(x + 0.5, y + 0.3), (x + 0.7, y + 0.5)]])
        elif kind == "stray":
            turn = r.uniform(0, 2 * math.pi)
            self.draw(
                page,
                [
                    [
                        (x + side * far * math.cos(turn), y + side * far * math.sin(turn))
                        for far in (2.0, 1.1, r.uniform(0.3, 0.42))
                    ]
                ],
            )

    def write(self, page: Image.Image, line: dict, text: str) -> None:
        """Write on a line."""
        r = self.random
        high = r.uniform(3.0, 4.5)
        x, base = line["x"] + r.uniform(0.5, 4), line["y"] + line["h"] - r.uniform(0.2, 1.2)
        for sign in text:
            wide = high * 0.55
            self.write_sign(page, sign, x, base, (wide, high))
            x += wide * r.uniform(1.25, 1.5) if sign != "." else wide * 0.7

    def write_in_cells(self, page: Image.Image, field: dict, text: str, cells: int) -> None:
        """Write a sign in each cell of a field, about in its middle."""
        r, cell = self.random, field["w"] / cells
        high, base = r.uniform(3.0, 4.5), field["y"] + field["h"] - r.uniform(0.7, 1.4)
        high = min(high, field["h"] - 2.2)
        wide, drift = min(high * 0.55, cell * 0.72), r.gauss(0, 0.25)
        for place, sign in enumerate(text):
            x = field["x"] + place * cell + (cell - wide) / 2 + drift + r.gauss(0, 0.2)
            self.write_sign(page, sign, x, base + r.gauss(0, 0.15), (wide, high))

    def write_sign(self, page: Image.Image, sign: str, x: float, base: float, size) -> None:
        """Write a sign of a width and height above a line."""
        r, (wide, high) = self.random, size
        for stroke in STROKES[sign]:
            points = [
                (
                    x + wide * (a + self.slant * (1 - b)) + r.gauss(0, 0.05),
                    base - high * (1 - b) + r.gauss(0, 0.05),
                )
                for a, b in (map(float, one.split(",")) for one in stroke.split())
            ]
            self.draw(page, [points])


def bend(points, shaky: float, r: random.Random):
    """A smooth stroke through points, with a wobble."""
    where = np.array(points, float)
    count = 8 * len(points)
    at = np.linspace(0, len(where) - 1, count)
    path = np.stack([np.interp(at, range(len(where)), where[:, axis]) for axis in (0, 1)], axis=1)
    phase = [r.uniform(0, 6.3) for _ in range(2)]
    along = np.linspace(0, 5, count)
    path[:, 0] += shaky * np.sin(along + phase[0])
    path[:, 1] += shaky * np.sin(along + phase[1])
    return path


def pick(r: random.Random, kinds: dict[str, float], usual: str) -> str:
    """One of some kinds by their probability, else the usual one."""
    left = r.random()
    for kind, share in kinds.items():
        if left < share:
            return kind
        left -= share
    return usual


CROSSES = {"light": 0.02, "small": 0.02, "slash": 0.02, "big": 0.03, "outside": 0.002}
EMPTIES = {"erased": 0.004, "dot": 0.003, "stray": 0.004}
FILLS = {"crossed and filled": 0.4, "badly filled": 0.05}


def fill_sheet(
    pages: list[Image.Image],
    fields: list[dict],
    kinds: dict[str, str],
    pen: Pen,
    *,
    usual: bool = False,
):
    """Fill in a sheet; return the answer meant by part (None where something is written), and
    the kind of mark by place in ``fields``; with ``usual``, nothing is odd."""
    r = pen.random
    odd = [{}, {}, {}] if usual else [CROSSES, FILLS, EMPTIES]
    meant: dict[str, str | None] = {}
    marks: dict[int, str] = {}
    parts: dict[str, list[int]] = {}
    for place, one in enumerate(fields):
        if one["kind"] != "points":
            parts.setdefault(one["part"], []).append(place)
    for part, places in parts.items():
        kind = {fields[place]["kind"] for place in places}
        if "box" not in kind:
            written = r.random() < 0.85
            for place in places if written else ():
                write_field(pages[fields[place]["page"] - 1], fields[place], pen)
            meant[part] = None if written else ""
            continue
        places = [place for place in places if fields[place]["kind"] == "box"]  # noqa: PLW2901
        options = [fields[place].get("option", "") for place in places]
        if ":" in options[0]:
            rows = sorted({one.partition(":")[0] for one in options})
            chosen = [
                r.choice([one for one in options if one.startswith(f"{row}:")])
                for row in rows
                if r.random() < 0.95
            ]
        elif kinds[part] == "multi":
            chosen = [one for one in options if r.random() < 0.4]
        else:
            chosen = [r.choice(options)] if r.random() < 0.92 else []
        left = [one for one in options if one not in chosen]
        taken = r.choice(left) if left and r.random() < 0.06 else ""
        for place, option in zip(places, options, strict=True):
            kind = (
                pick(r, odd[0], "cross")
                if option in chosen
                else pick(r, odd[1], "filled")
                if option == taken
                else pick(r, odd[2], "empty")
            )
            pen.mark(pages[fields[place]["page"] - 1], fields[place], kind)
            marks[place] = kind
        meant[part] = ", ".join(one for one in options if one in chosen)
    return meant, marks


def write_field(page: Image.Image, field: dict, pen: Pen) -> None:
    """Write something on a line, or several lines of it where there is room."""
    r = pen.random
    rows = 2 if field["h"] > 20 else 1
    for row in range(rows):
        most = max(1, min(5, int(field["w"] / 4)))
        text = "".join(r.choice("0123456789-.netl") for _ in range(r.randint(1, most)))
        text = text if text.strip(".") else f"5{text}"[:most]
        line = field | {"h": min(field["h"], 8.0), "y": field["y"] + 9.0 * row}
        pen.write(page, line, text)


def rasterise(pdf: Path) -> list[Image.Image]:
    """The pages of a printed sheet in grey, by poppler."""
    done = subprocess.run(
        ["pdftoppm", "-r", str(DPI), "-gray", str(pdf)], check=True, capture_output=True
    )
    stream, pages = io.BytesIO(done.stdout), []
    while stream.tell() < len(done.stdout):
        stream.readline()
        width, height = map(int, stream.readline().split())
        stream.readline()
        pages.append(Image.frombytes("L", (width, height), stream.read(width * height)))
    return pages


def spoil(page: Image.Image, how: str, r: random.Random) -> Image.Image:
    """What happens to a sheet before it is scanned."""
    grey = np.asarray(page, np.float32).copy()
    high, wide = grey.shape
    if how == "stain":
        for _ in range(r.randint(1, 2)):
            layer = Image.new("L", (wide, high))
            x, y, radius = r.randrange(wide), r.randrange(high), r.randint(110, 220)
            pen = ImageDraw.Draw(layer)
            pen.ellipse([x - radius, y - radius, x + radius, y + radius], fill=90)
            pen.ellipse(
                [x - radius, y - radius, x + radius, y + radius],
                outline=255,
                width=r.randint(8, 20),
            )
            grey *= (
                1
                - r.uniform(0.2, 0.4)
                * np.asarray(layer.filter(ImageFilter.GaussianBlur(5)), np.float32)
                / 255
            )
    elif how == "fold":
        for at in (high // 3 + r.randint(-40, 40), 2 * high // 3 + r.randint(-40, 40)):
            grey[at : at + 3] *= r.uniform(0.6, 0.85)
            grey[at + 3 : at + 40] *= np.linspace(0.88, 1, 37, dtype=np.float32)[:, None]
            gone = r.randint(1, 3)
            grey[at : high - gone] = grey[at + gone : high].copy()
    elif how == "punch":
        for at in (high // 2 - 315, high // 2 + 315):
            rows, columns = np.ogrid[:high, :wide]
            grey[(rows - at) ** 2 + (columns - 92) ** 2 < 24**2] = r.choice([30, 255, 80])
    elif how == "staple":
        size = r.randint(60, 110)
        rows, columns = np.ogrid[:high, :wide]
        grey[rows + columns < size] = r.uniform(60, 180)
    return Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8))


def scan(page: Image.Image, how: str, r: random.Random) -> Image.Image:
    """A sheet as a copier or a phone sees it."""
    dpi = {"300": 300, "200": 200}.get(how, 150)
    wide, high = page.size
    scale = dpi / DPI
    turn = math.radians(r.uniform(-5, 5) if how == "skew" else r.gauss(0, 0.7))
    corners = [
        (-wide / 2, -high / 2),
        (wide / 2, -high / 2),
        (wide / 2, high / 2),
        (-wide / 2, high / 2),
    ]
    out = (round(wide * scale * 1.02), round(high * scale * 1.02))
    if how == "phone":
        scale, out = 1.25, (round(wide * 1.4), round(high * 1.4))
        corners_out = [
            (x * scale * r.uniform(0.94, 1.03), y * scale * r.uniform(0.94, 1.03))
            for x, y in corners
        ]
    else:
        corners_out = [(x * scale, y * scale) for x, y in corners]
    turned = [
        (
            out[0] / 2 + x * math.cos(turn) - y * math.sin(turn),
            out[1] / 2 + x * math.sin(turn) + y * math.cos(turn),
        )
        for x, y in corners_out
    ]
    flat = [(x + wide / 2, y + high / 2) for x, y in corners]
    matrix = find_perspective(turned, flat)
    paper = 90 if how == "phone" else 250
    seen = page.transform(
        out, Image.Transform.PERSPECTIVE, matrix, Image.Resampling.BICUBIC, fillcolor=paper
    )
    seen = seen.filter(
        ImageFilter.GaussianBlur(
            r.uniform(0.4, 0.8) * (1.6 if how == "phone" else 1) * max(scale, 0.7)
        )
    )
    grey = np.asarray(seen, np.float32)
    random_values = np.random.default_rng(r.randrange(1 << 30))
    if how == "phone":
        across = np.linspace(r.uniform(0.6, 0.9), r.uniform(0.8, 1), out[0], dtype=np.float32)[
            None, :
        ]
        along = np.linspace(r.uniform(0.75, 1), r.uniform(0.75, 1), out[1], dtype=np.float32)[
            :, None
        ]
        grey = grey * across * along
    black, white = r.uniform(0, 25), r.uniform(232, 254)
    grey = (
        black
        + grey / 255 * (white - black)
        + random_values.normal(0, r.uniform(1.5, 4), grey.shape)
    )
    return Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8))


def find_perspective(source, target) -> list[float]:
    """The eight coefficients by which Pillow takes four points to four others."""
    rows, values = [], []
    for (x, y), (u, v) in zip(source, target, strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        values += [u, v]
    return list(np.linalg.solve(np.array(rows), np.array(values)))


QUALITY = {"300": 75, "200": 60}


def save_scan(page: Image.Image, path: Path, how: str, *, upside_down: bool = False) -> None:
    """Save a picture as a scanner would, as JPEG, or black and white as PNG."""
    shown = page.rotate(180) if upside_down else page
    if how == "bilevel":
        shown.point(lambda grey: 255 * (grey > 140)).convert("1").save(path.with_suffix(".png"))
    else:
        shown.save(path.with_suffix(".jpg"), quality=QUALITY.get(how, 40))
