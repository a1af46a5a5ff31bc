"""Reads a drawn figure: lines and areas by the names of their parts, labels, pictures."""

from __future__ import annotations

import base64
import io
import re
from xml.etree import ElementTree as ET

import numpy as np
from PIL import Image

_NUMBER = re.compile(r"[MLQCz]|-?\d*\.?\d+")
SVG = "{http://www.w3.org/2000/svg}"


def read_parts(figure):
    """Part name to its lines, each an array of points (n, 2) with y upwards, in points of print.

    Letters are left out; curves are given by their control points.
    """
    found: dict[str, list[np.ndarray]] = {}
    for element in ET.fromstring(figure.inline_svg).iter(f"{SVG}path"):
        if "transform" not in element.attrib and "data-part" in element.attrib:
            found.setdefault(element.attrib["data-part"], []).extend(_lines(element.attrib["d"]))
    return found


def _lines(data):
    lines, numbers = [], []
    for token in _NUMBER.findall(data):
        if token == "M":
            lines.append([])
        elif token not in "LQCz":
            numbers.append(float(token))
            if len(numbers) == 2:
                lines[-1].append((numbers[0], -numbers[1]))
                numbers = []
    return [np.array(line) for line in lines if line]


def read_pictures(figure):
    """Pixels of the pictures in a figure, in the order of drawing: arrays of 8 bits."""
    images = ET.fromstring(figure.inline_svg).iter(f"{SVG}image")
    return [np.asarray(Image.open(io.BytesIO(base64.b64decode(one.attrib["href"].split(",")[1])))
                       .convert("RGB")) for one in images]  # fmt: skip


def read_labels(figure):
    """Texts in a figure without the marks of formulas."""
    from quizgen.figures.alt_text import strip_mathtext

    return [strip_mathtext(label.text) for label in figure.labels]
