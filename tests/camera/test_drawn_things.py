"""What is drawn, against counting sub-pixels."""

import numpy as np
import pytest
from sweep import together

from quizgen.camera import Camera, Length, Scene, SceneObject, View
from quizgen.camera.raster import rasterizer
from quizgen.camera.raster.rasterizer import rasterize

CORNERS = ((-9.0, -6.0), (8.0, -3.0), (3.0, 7.0))


def drawn(*things, width=40, height=30):
    (layer,) = rasterize(View(Scene(width, height, things), Camera()))
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
    closed = drawn(SceneObject("polygon", points=corners))
    assert np.isfinite(closed).all()
    if len(corners) != 5 or corners[0] == corners[-1]:
        assert np.array_equal(closed, drawn(SceneObject("polygon", points=CORNERS)))


SHAPES = {
    "box": {"width": Length(17.0), "height": Length(5.0)},
    "disc": {"radius": Length(6.3)},
    "ellipse": {"width": Length(30.0), "height": Length(0.2)},
    "grid": {"cell": Length(9.0), "stroke": Length(1.5)},
    "blades": {"radius": Length(11.0), "stroke": Length(4.0)},
    "polygon": {"points": CORNERS},
    "full": {},
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("place", [(0.0, 0.0), (7.3, -4.6), (-45.0, 20.0), (1e9, -1e9)])
def test_nothing_is_drawn_outside_of_where_it_is_looked_for(monkeypatch, shape, count, place):
    """In its box alone and on the whole frame: not a bit differs, also of what is seen in part."""
    where = {"x": Length(place[0]), "y": Length(place[1])}
    for angle in (0.0, 0.4, 2.1):
        thing = SceneObject(
            shape, **where, **SHAPES[shape], count=count, angle=angle, texture="stripes"
        )
        near = drawn(thing, height=150)
        with monkeypatch.context() as everywhere:
            everywhere.setattr(rasterizer, "_extent", lambda _: (np.inf, np.inf))
            assert np.array_equal(near, drawn(thing, height=150))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_bands_leave_no_seams(monkeypatch, shape, angle):
    """In one piece and in bands of four rows: the same bits."""
    thing = SceneObject(
        shape, **SHAPES[shape], angle=angle, texture="rings", colour=(0.3, 0.2, 0.1)
    )
    upon = SceneObject("box", Length(3.0), width=Length(12.0), height=Length(14.0), depth=3.0)
    whole = drawn(thing, upon)
    monkeypatch.setattr(rasterizer, "_BAND", 160)
    assert np.array_equal(drawn(thing, upon), whole)


def test_the_very_middle_of_an_ellipse_is_covered():
    thing = SceneObject("ellipse", width=Length(30.0), height=Length(20.0))
    assert drawn(thing, width=41, height=31)[15, 20] == 1


def test_rasterizer_upon_a_photograph_leaves_it_alone():
    image = np.full((30, 40, 3), 0.5, np.float32)
    view = View(Scene(40, 30, (SceneObject("disc", radius=Length(5.0)),), image=image), Camera())
    assert rasterize(view)[0].colour[15, 20, 0] == 1
    assert (image == 0.5).all()


def plainly(points, x, y):
    """Distance to the nearest side, and inside by the number of sides to the right."""
    distance, inside = np.full(x.shape, np.inf), np.zeros(x.shape, bool)
    for a, b in zip(np.array(points), np.roll(np.array(points), -1, axis=0), strict=True):
        side, to = b - a, np.stack([x, y], axis=-1) - a
        along = np.clip(to @ side / (side @ side), 0, 1)[..., None]
        distance = np.minimum(distance, np.linalg.norm(to - along * side, axis=-1))
        if a[1] != b[1]:
            at = (y - a[1]) / (b[1] - a[1])
            inside ^= (at > 0) & (at < 1) & (x < a[0] + at * side[0])
    return np.where(inside, -distance, distance)


@together("seed", range(12))
def test_polygons_are_what_their_sides_say(seed):
    """Also twisted ones, turned ones and ones larger than the picture, half covered at the edge."""
    source = np.random.default_rng(seed)
    points = source.normal(0, (8, 40)[seed % 2], (int(source.integers(3, 9)), 2))
    angle = float(source.uniform(0, 6)) if seed % 3 else 0.0
    thing = SceneObject("polygon", points=tuple(map(tuple, points.tolist())), angle=angle)
    y, x = np.mgrid[0:150, 0:90] - np.array([149 / 2, 89 / 2])[:, None, None]
    turned = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    expected = np.clip(0.5 - plainly(points, *turned), 0, 1)
    assert drawn(thing, width=90, height=150) == pytest.approx(expected, abs=1e-6)
