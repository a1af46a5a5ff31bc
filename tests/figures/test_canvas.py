"""What a figure is drawn on, beside the SVG that matplotlib writes of the same paths."""

from __future__ import annotations

import random
import re
from io import StringIO

import matplotlib as mpl
import numpy as np
import pytest
from figure_cases import outline
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from quizgen.figures._canvas import Canvas, Label, Style

PATH = re.compile(r'<path d="([^"]*)"(?: style="([^"]*)")?/>')
WIDE, HIGH = 312.0, 170.0


@mpl.rc_context({"path.simplify": False, "lines.scale_dashes": False})
def peer(style, points, codes):
    figure, out = Figure(figsize=(WIDE / 72, HIGH / 72), dpi=72), StringIO()
    figure.patch.set_visible(False)
    painted = {"fc": "none", "ec": style.colour, "lw": style.width}
    painted |= {"ls": (0, style.dashes)} if style.dashes else {}
    if not style.width:
        painted = {"fc": style.colour, "ec": "none"}
    path = Path(np.round(points, 2), codes)
    transform = Affine2D().scale(1 / 72) + figure.dpi_scale_trans
    figure.add_artist(
        PathPatch(path, transform=transform, capstyle="butt", joinstyle="round", **painted)
    )
    figure.savefig(out, format="svg")
    return found(out.getvalue().split("</defs>")[1])


def found(svg):
    ((data, style),) = PATH.findall(re.sub(r'"\s*/>', '"/>', svg.replace(' "', '"')))
    return data.split(), style


def drawn(style, points, codes):
    canvas = Canvas()
    canvas.size(WIDE, HIGH, None)
    canvas.path("part", style, points, bytes(codes))
    return found(canvas.inside)


STYLES = [
    Style(),
    Style(colour="#d2d2d2"),
    Style(1.0),
    Style(0.7, "#a0a0a0"),
    Style(0.9, dashes=(4.0, 2.5)),
]


@pytest.mark.parametrize("style", STYLES, ids=str)
def test_polygons_and_polylines_are_those_of_matplotlib(style):
    source = random.Random(3)
    for _ in range(40):
        corners = [(source.uniform(1, WIDE - 1), source.uniform(1, HIGH - 1)) for _ in range(5)]
        points = [*corners, corners[0], *corners[:3]]
        codes = [1, 2, 2, 2, 2, 79, 1, 2, 2]
        assert drawn(style, points, codes) == peer(style, points, codes)


def corners(data):
    """The commands of a path, and where they lead; where a letter starts is no corner."""
    at, start, letters, places = np.zeros(2), np.zeros(2), "", []
    for letter, numbers in re.findall(r"([MLCZmlcz])([^MLCZlcz]*?)(?=[a-zA-Z]|$)", data):
        ways = np.array(re.findall(r"-?[\d.]+", numbers), float).reshape(-1, 2)
        ends = ways + at if letter.islower() else ways
        if letter == "m":  # goes on from the M before it
            letters, places = (
                letters.removesuffix("M"),
                places[: len(places) - letters.endswith("M")],
            )
        at = start if letter in "zZ" else ends[-1]
        start = at if letter in "mM" else start
        letters += letter.upper()
        places += [*ends]
    return letters, np.array(places)


@pytest.mark.parametrize("text", ["p'_y = 6.25 {mm} σ", "{Bild 10 %}", "k_{12} ≈ −0.05 × 8°"])
def test_letters_are_those_of_matplotlib(text):
    canvas = Canvas()
    canvas.size(WIDE, HIGH, None)
    canvas.labels.append(Label(text, (40.003, 80.004), 10.5))
    ((data, _),) = PATH.findall(canvas.inside)
    shape, codes, _ = outline(text)
    points = [(x * 10.5 + 40.003, y * 10.5 + 80.004) for x, y in shape]
    letters, places = corners(" ".join(peer(Style(), points, list(codes))[0]))
    ours, reached = corners(data)
    assert ours == letters
    assert np.abs(reached - places).max() < 0.0151


def test_pictures_lie_under_what_is_drawn():
    canvas = Canvas()
    canvas.size(40, 20, "#ffffff")
    canvas.path("frame", Style(1.0), [(0.0, 0.0), (4.0, 2.0)], b"\x01\x02")
    canvas.picture(b"PNG", (1, 2, 30, 10))
    assert canvas.inside == (
        '<g><g><path d="M 0 20 L 40 20 L 40 0 L 0 0 z" style="fill: #ffffff"/></g>'
        '<image xlink:href="data:image/png;base64,UE5H" x="1.00" y="8.00" width="30.00"'
        ' height="10.00" preserveAspectRatio="none"/>'
        '<g data-part="frame"><path d="M 0 20 L 4 18" style="fill: none; stroke: #000000"/></g></g>'
    )
