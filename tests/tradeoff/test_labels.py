"""No label of a plot covers another one, a point, or leaves its panel."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from quizgen.tradeoff.labels import Box, Labels

BOUNDS = Box(0, 0, 400, 250)


def apart(boxes):
    return all(
        a.right <= b.left or b.right <= a.left or a.bottom <= b.top or b.bottom <= a.top
        for a, b in itertools.combinations(boxes, 2)
    )


@pytest.mark.parametrize("spread", [0.0, 3.0, 40.0])
def test_labels_of_crowded_points_stand_apart(spread):
    rng = np.random.default_rng(7)
    labels, placed = Labels(BOUNDS), []
    points = [(200 + spread * a, 120 + spread * b) for a, b in rng.normal(size=(14, 2))]
    for x, y in points:
        labels.keep_clear(x, y)
    for number, (x, y) in enumerate(points):
        placed.append(labels.place(f"N = {number}", x, y))
    boxes = [one.box for one in placed if one is not None]
    assert len(boxes) == 14
    assert apart(boxes)
    for box in boxes:
        assert 0 <= box.left < box.right <= 400
        assert 0 <= box.top < box.bottom <= 250
        assert not any(box.left < x < box.right and box.top < y < box.bottom for x, y in points)


def test_a_label_without_a_free_place_is_left_out():
    labels = Labels(Box(0, 0, 20, 10))
    assert labels.place("much too long for that", 10, 5) is None


def test_a_label_far_from_its_point_is_tied_to_it():
    labels = Labels(BOUNDS)
    assert not labels.place("1", 100, 100).far
    for _ in range(30):
        last = labels.place("1", 100, 100)
    assert last.far
