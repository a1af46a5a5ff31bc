"""A light figure shows what the exact one does: lines as resvg paints them, pixels and words."""

from __future__ import annotations

import base64
import re
from io import BytesIO
from math import dist
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import typst
from figure_cases import FIGURES, REFERENCE, render
from PIL import Image

from quizgen.figures._bends import bends

SVG = "{http://www.w3.org/2000/svg}"
LINK = "{http://www.w3.org/1999/xlink}href"
BOTH = [(name, quiz) for name in FIGURES for quiz in (False, True)]


@pytest.fixture(scope="module", params=BOTH)
def figure(request):
    name, quiz = request.param
    return render(name, REFERENCE[name], quiz=quiz, lang="en")


def lines(svg: bytes) -> bytes:
    """The same without pictures and labels."""
    root = ET.fromstring(svg)
    for parent in list(root.iter()):
        for one in list(parent):
            if one.tag in {f"{SVG}image", f"{SVG}text"} or one.get("data-part") == "labels":
                parent.remove(one)
    return ET.tostring(root)


def painted(tmp_path, svg: bytes):
    """Grey levels, two pixels to a point."""
    (tmp_path / "figure.svg").write_bytes(svg)
    page = '#set page(width: auto, height: auto, margin: 0pt, fill: white)\n#image("figure.svg")'
    data = typst.compile(page.encode(), root=tmp_path, format="png", ppi=144)
    return np.asarray(Image.open(BytesIO(data)).convert("L")).astype(int)


def test_lines_are_the_same(figure, tmp_path):
    """No pixel of a fine screen differs by more than one of resvg's four steps of an edge."""
    exact, light = (painted(tmp_path, lines(svg)) for svg in (figure.svg, figure.light))
    assert exact.shape == light.shape
    assert np.abs(exact - light).max() <= 64
    assert np.abs(exact - light).mean() < 0.5


def pixels(svg: bytes):
    for image in ET.fromstring(svg).iter(f"{SVG}image"):
        data = image.get("href", image.get(LINK)).removeprefix("data:image/png;base64,")
        yield np.asarray(Image.open(BytesIO(base64.b64decode(data))).convert("RGB")).astype(int)


def test_pictures_are_the_same_but_for_steps_in_their_noise(figure):
    for one, other in zip(pixels(figure.svg), pixels(figure.light), strict=True):
        times = len(one) // len(other)
        shown = other.repeat(times, axis=0).repeat(times, axis=1)
        noise = np.median(np.abs(np.diff(one[::times, ::times], axis=1)))
        assert np.abs(one - shown).max() <= noise / 4


def test_labels_are_the_same(figure):
    light = ET.fromstring(figure.light)
    told = "".join("".join(text.itertext()) for text in light.iter(f"{SVG}text"))
    wanted = "".join(re.sub(r"[{}_]", "", label.text) for label in figure.canvas.labels)
    assert sorted(told.replace("\u00a0", " ").replace("′", "'")) == sorted(wanted)
    assert len(figure.light) < len(figure.svg)


def far(point, line) -> float:
    """Distance of a point from a polyline."""
    a, b = np.array(line[:-1] or line), np.array(line[1:] or line)
    along, p = b - a, np.array(point)
    share = np.clip(((p - a) * along).sum(1) / np.maximum((along**2).sum(1), 1e-12), 0, 1)
    return float(np.hypot(*(a + share[:, None] * along - p).T).min())


@pytest.mark.parametrize("seed", range(40))
def test_a_line_keeps_every_bend(seed):
    """Wherever it goes: no point is left out that is farther than that from the line."""
    source = np.random.default_rng(seed)
    steps = source.normal(0, [3, 0.4, 0.02][seed % 3], (60, 2)) + [[0.5, 0], [0, 0]][seed % 2]
    line = [*map(tuple, np.cumsum(steps, axis=0).tolist())]
    kept = bends(line, 0.5)
    assert [kept[0], kept[-1]] == [line[0], line[-1]]
    assert set(kept) <= set(line)
    assert max(far(point, kept) for point in line) <= 0.5 + 1e-9


def test_a_line_needs_no_more_points_than_it_bends():
    circle = [(100 * np.cos(t), 100 * np.sin(t)) for t in np.linspace(0, 2 * np.pi, 721)]
    kept = bends(circle, 0.5)
    sagitta = 100 * (1 - np.cos(np.pi / (len(kept) - 1)))
    assert 0.1 < sagitta < 0.5
    there_and_back = [(0, 0), (5, 0), (9, 0), (3, 0), (0, 4)]
    assert bends(there_and_back, 0.1) == [(0, 0), (9, 0), (3, 0), (0, 4)]
    assert dist(*bends([(0, 0), (0, 0), (7, 0), (7, 0)], 0.1)[:2]) == 7
