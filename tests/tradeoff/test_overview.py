"""The words at the two thick arrows: each is read as what its own arrow costs and brings."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from types import SimpleNamespace

import pytest

from quizgen.tradeoff import overview
from quizgen.tradeoff.data import words
from quizgen.tradeoff.plot import PANEL, Axes, document

PRINTED = [
    (9.54, 14, 0), (1.26, 15, 2), (5.0, 11, 0), (3.18, 15, 1), (2.14, 15, 2), (4.4, 6, 1),
    (9.57, 15, 15), (1.19, 14, 2), (0.678, 13, 6), (1.56, 14, 2), (3.75, 12, 0), (10.6, 12, 2),
    (9.44, 13, 0), (1.74, 13, 0),
]  # fmt: skip
"""Nanoseconds and digits of the printed formulas, as they were measured once."""
TIMES = [
    (22.7, 7450), (0.78, 2420), (2.16, 6280), (6.27, 5830), (2.83, 4700), (64.3, 4720),
    (9.57, 21200), (1.67, 3610), (1.93, 2410), (0.6, 3070), (3.02, 6000), (7.8, 4020),
    (26.2, 11000), (7.61, 3610),
]  # fmt: skip
"""Nanoseconds of the stable and of the proven ways."""


def rung(key, nanoseconds, exam, hard):
    exam, hard = SimpleNamespace(digits=exam), SimpleNamespace(digits=hard)
    return SimpleNamespace(key=key, nanoseconds=nanoseconds, exam=exam, hard=hard)


@pytest.fixture(scope="module")
def told():
    families = [
        SimpleNamespace(rungs=[rung("float64", *printed), rung("stable", stable, 15.6, 15.6),
                               rung("exact", proven, 17, 17)])
        for printed, (stable, proven) in zip(PRINTED, TIMES, strict=True)
    ]  # fmt: skip
    return SimpleNamespace(families=families)


def drawn(report, inputs, lang):
    """Boxes of the words at arrows, and the arrows, of one panel."""
    axes = Axes("time", "digits", "all")
    panel = overview.panel(report, inputs, "title", axes, words(lang)["overview"])
    picture = ET.fromstring(document([panel], "all"))
    sign = "{http://www.w3.org/2000/svg}"
    lines = [node.get("points") for node in picture.iter(f"{sign}polyline")
             if node.get("class") == "front arrow"]  # fmt: skip
    arrows = [[tuple(map(float, at.split(","))) for at in line.split()] for line in lines]
    boxes = {node.text: box(node) for node in picture.iter(f"{sign}text")
             if node.get("class") == "head" and re.search(r"\d", node.text)}  # fmt: skip
    return boxes, arrows


def box(node):
    """Where a text of letters of ordinary width stands: left, top, right, bottom."""
    width, x, y = 0.55 * 12 * len(node.text), float(node.get("x")), float(node.get("y"))
    left = {"middle": x - width / 2, "end": x - width}[node.get("text-anchor")]
    return left, y - 10, left + width, y + 3


def distance(area, arrow):
    """From an arrow to a box."""
    (x1, y1), (x2, y2) = arrow
    return min(
        math.hypot(max(area[0] - x, x - area[2], 0), max(area[1] - y, y - area[3], 0))
        for x, y in ((x1 + s / 200 * (x2 - x1), y1 + s / 200 * (y2 - y1)) for s in range(201))
    )


@pytest.mark.parametrize("lang", ["en", "bn", "de"])
@pytest.mark.parametrize("inputs", overview.INPUTS)
def test_words_stand_at_their_own_arrow(told, inputs, lang):
    boxes, (first, second) = drawn(told, inputs, lang)
    proven = next(text for text in boxes if words(lang)["overview"]["every"] in text)
    (stable,) = boxes.keys() - {proven}
    assert distance(boxes[proven], second) < 20
    assert distance(boxes[proven], first) > distance(boxes[proven], second)
    assert distance(boxes[stable], second) > 40
    assert distance(boxes[stable], first) < distance(boxes[stable], second)
    for area in boxes.values():
        assert min(distance(area, first), distance(area, second)) > 1
        assert area[0] > 0
        assert area[2] < PANEL
