"""What is drawn in a figure of a page: its lines by name, and its pictures from left to right."""

from __future__ import annotations

import base64
import io
import math
import re
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray
from PIL import Image

Line = list[tuple[float, float]]
HREF = "href"


def lines(figure: Element, name: str) -> list[Line]:
    """The straight lines of a part of the drawing, with y upward."""
    paths = [one.get("d") or "" for one in figure.iter() if one.get("data-part") == name]
    strokes = [stroke for path in paths for stroke in path.split("M")[1:]]
    return [
        [(float(x), -float(y)) for x, y in re.findall(r"(-?[\d.]+) (-?[\d.]+)", stroke)]
        for stroke in strokes
    ]


def ticks(figure: Element) -> tuple[list[float], list[float]]:
    """Where short strokes stand at the axes: along x, and along y, with y upward."""
    short = [line for line in lines(figure, "axis") if len(line) == 2 and math.dist(*line) < 4]
    across = sorted({x for (x, _), (end, _) in short if x == end})
    return across, sorted({y for (_, y), (_, end) in short if y == end})


def pictures(figure: Element) -> list[NDArray[np.uint8]]:
    """The pictures of a figure, by rows from the top and in a row from the left."""
    found = [one for one in figure.iter() if one.get(HREF)]
    found.sort(key=lambda one: (float(one.get("y") or 0), float(one.get("x") or 0)))
    return [_decoded((one.get(HREF) or "").partition(",")[2]) for one in found]


def _decoded(text: str) -> NDArray[np.uint8]:
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(text))).convert("RGB"))
