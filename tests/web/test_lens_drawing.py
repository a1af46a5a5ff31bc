"""Signs of the subject are drawn as what they stand for."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import pytest

from quizgen.web.lens_drawing import BLADES, RADIUS, draw_aperture, draw_lens_scale


@pytest.mark.parametrize("share", [0.25, 1.0])
def test_an_aperture_is_a_regular_polygon_as_open_as_the_share(share):
    opening = re.search('points="([^"]*)"', draw_aperture(share))[1]
    corners = [tuple(map(float, corner.split(","))) for corner in opening.split()]
    side = 2 * RADIUS * math.sqrt(share) * math.sin(math.pi / BLADES)
    sides = [math.dist(*pair) for pair in pairwise([*corners, corners[0]])]
    assert sides == pytest.approx([side] * BLADES, abs=0.15)  # points have one decimal


def test_a_scale_has_a_small_tick_at_every_quarter_between_large_ones():
    drawn = draw_lens_scale(20, 5, 15, None, ["0", "10", "20"])
    small, large = (
        [float(x) for x in re.findall(f'class="{name}" d="M([0-9.]+) ', drawn)]
        for name in ("tick", "tick large")
    )
    assert small[::4] == large
    assert [b - a for a, b in pairwise(small)] == [80.0] * 8
