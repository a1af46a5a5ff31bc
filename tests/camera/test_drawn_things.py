"""What is drawn, against counting sub-pixels."""

import numpy as np
import pytest

from quizgen.camera import Camera, Scene, Thing, View
from quizgen.camera.draw import draw

CORNERS = ((-9.0, -6.0), (8.0, -3.0), (3.0, 7.0))


def drawn(*things, width=40, height=30):
    (layer,) = draw(View(Scene(width, height, things), Camera()))
    return layer.colour[..., 0]


@pytest.mark.parametrize(
    "corners",
    [
        (*CORNERS, CORNERS[0]),
        (CORNERS[0], *CORNERS, CORNERS[0], CORNERS[0]),
        ((-9.0, -6.0), (-9.0 + 1e-200, -6.0), *CORNERS[1:]),
        ((-1e-170, -6.0), (0.0, -6.0), *CORNERS[1:], (-9.0, -6.0)),
    ],
)
def test_a_corner_given_twice_changes_nothing(corners):
    closed = drawn(Thing("polygon", points=corners))
    assert np.isfinite(closed).all()
    if len(corners) != 5 or corners[0] == corners[-1]:
        assert np.array_equal(closed, drawn(Thing("polygon", points=CORNERS)))
