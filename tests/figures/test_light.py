"""A light figure shows what the exact one does: the same lines, pixels and words."""

from __future__ import annotations

import base64
import re
from io import BytesIO
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from figure_cases import REFERENCE
from PIL import Image

from quizgen.figures import render
from quizgen.figures._table import FIGURES

SVG = "{http://www.w3.org/2000/svg}"
LINK = "{http://www.w3.org/1999/xlink}href"
BOTH = [(name, quiz) for name in FIGURES for quiz in (False, True)]


def pixels(root):
    for image in root.iter(f"{SVG}image"):
        data = image.get("href", image.get(LINK)).removeprefix("data:image/png;base64,")
        yield np.asarray(Image.open(BytesIO(base64.b64decode(data))).convert("RGB"))


def absolute(data: str) -> list[list[tuple[float, float]]]:
    """Polylines of a path with capital letters."""
    lines = []
    for command, x, y in re.findall(r"([ML]) (\S+) (\S+)", data):
        if command == "M":
            lines.append([])
        lines[-1].append((float(x), float(y)))
    return lines


def relative(data: str) -> list[list[tuple[float, float]]]:
    """Polylines of a path with small letters."""
    lines, x, y = [], 0.0, 0.0
    for command, rest in re.findall(r"([mlz])([^mlz]*)", data):
        if command == "z":
            x, y = lines[-1][0]
            lines[-1].append((x, y))
            continue
        dx, dy = re.findall(r"-?(?:\d+\.\d+|\.\d+|\d+)", rest)
        x, y = x + float(dx), y + float(dy)
        if command == "m":
            lines.append([])
        lines[-1].append((x, y))
    return lines


def far(point, line) -> float:
    """Distance of a point from a polyline."""
    a, b = np.array(line[:-1] or line), np.array(line[1:] or line)
    along, p = b - a, np.array(point)
    share = np.clip(((p - a) * along).sum(1) / np.maximum((along**2).sum(1), 1e-12), 0, 1)
    return float(np.hypot(*(a + share[:, None] * along - p).T).min())


@pytest.mark.parametrize(("name", "quiz"), BOTH)
def test_lines_pictures_and_labels_are_the_same(name, quiz):
    figure = render(name, REFERENCE[name], quiz=quiz, lang="en")
    exact, light = ET.fromstring(figure.svg), ET.fromstring(figure.light)
    assert exact.get("viewBox") == light.get("viewBox")
    for one, other in zip(pixels(exact), pixels(light), strict=True):
        assert np.array_equal(one, other)
    drawn = [path for group in exact.iter(f"{SVG}g") if group.get("data-part") != "labels"
             for path in group if path.tag == f"{SVG}path"]  # fmt: skip
    paper = figure.dark == "keep"
    others = list(light.iter(f"{SVG}path"))[paper:]
    for one, other in zip(drawn[paper:], others, strict=True):
        assert one.get("style") == other.get("style")
        for line, short in zip(absolute(one.get("d")), relative(other.get("d")), strict=True):
            assert max(far(point, short) for point in line) < 0.006
            assert max(far(point, line) for point in short) < 0.006
    told = "".join("".join(text.itertext()) for text in light.iter(f"{SVG}text"))
    wanted = "".join(re.sub(r"[{}_]", "", label.text) for label in figure.canvas.labels)
    assert sorted(told.replace("\u00a0", " ").replace("′", "'")) == sorted(wanted)
    assert len(figure.light) < len(figure.svg)
