"""What stands beside the frame shows at its edge: a picture is the middle of a larger one."""

import numpy as np
import pytest
from sweep import together

from quizgen.camera import Camera, Length, PreparedScene, Scene, SceneObject
from quizgen.camera.simulation import run_plan

WIDTH, HEIGHT, BESIDE = 120, 90, 60


def px(value):
    return Length(float(value))


def wall(**changes):
    return SceneObject("full", texture="checker", cell=px(13), other=(0.2, 0.5, 0.1), **changes)


def taken(camera, *things, beside=0):
    scene = Scene(WIDTH + 2 * beside, HEIGHT + 2 * beside, things or (wall(depth=5.0),))
    values = run_plan(PreparedScene(scene, camera)).values
    return values[beside : beside + HEIGHT, beside : beside + WIDTH]


def a_corner_larger(side):
    """How much farther the corner of a larger sensor is from the middle."""
    wide = np.hypot(WIDTH - 1 + 2 * side, HEIGHT - 1 + 2 * side)
    return float(wide / np.hypot(WIDTH - 1, HEIGHT - 1))


CAMERA = Camera(0.05, 0.05 / 200)
CAMERAS = {
    "barrel": CAMERA.replace(k1=-0.2),
    "moustache": CAMERA.replace(k1=-0.5, k2=0.6),
    "defocus": CAMERA.replace(f_number=2.0, focus_distance=2.0),
    "axial colour": CAMERA.replace(f_number=4.0, focus_distance=3.0, axial_colour=1e-3),
    "diffraction": CAMERA.replace(f_number=200.0, wavelength=5.5e-6),
    "panning": CAMERA.replace(shutter=0.02, velocity=(700.0, 300.0)),
    "shear": CAMERA.replace(row_time=1e-4, velocity=(1500.0, 200.0)),
}


@together("name", CAMERAS)
def test_a_larger_sensor_sees_the_same_in_its_middle(name):
    """Lens, blur and movement do not know how large the sensor is."""
    camera = CAMERAS[name]
    larger = taken(camera, beside=BESIDE)
    assert np.abs(taken(camera) - larger).max() < 2e-5


def test_lateral_colour_of_a_larger_sensor():
    """It is given at the corner: a corner farther out gets more of it."""
    camera, more = (
        CAMERA.replace(lateral_colour=4.0 * by) for by in (1.0, a_corner_larger(BESIDE))
    )
    assert np.abs(taken(camera) - taken(more, beside=BESIDE)).max() < 2e-5


def test_what_turns_outside_comes_in():
    blades = SceneObject("blades", px(50), radius=px(70), stroke=px(9), spin=30.0, depth=4.0)
    camera = CAMERA.replace(shutter=0.004, row_time=1e-4)
    things = wall(depth=5.0), blades
    assert np.abs(taken(camera, *things) - taken(camera, *things, beside=BESIDE)).max() < 2e-5


def test_all_together():
    """A barrel is continued beyond the corner of the frame, from where blur brings little in."""
    camera = CAMERA.replace(
        k1=-0.15,
        f_number=8.0,
        focus_distance=3.0,
        shutter=0.01,
        velocity=(500.0, 0.0),
        row_time=2e-5,
    )
    larger = taken(camera, beside=BESIDE)
    assert np.abs(taken(camera) - larger).max() < 2e-2
    assert np.abs(taken(camera) - larger)[20:-20, 20:-20].max() < 2e-5


def test_a_thing_beside_the_frame_is_drawn_in_by_a_barrel():
    """In focal lengths of 200 px: 61 px from the middle come to 61 (1 - 0.2 * 0.305^2) = 59.9 px."""
    box = SceneObject("box", px(61), width=px(2), height=px(40))
    camera = CAMERAS["barrel"]
    right = taken(camera, box)[HEIGHT // 2, -1]  # 59.5 px from the middle
    assert right.min() > 0.8
    assert taken(CAMERA, box).max() == 0.0


def views(camera, *things):
    return PreparedScene(Scene(WIDTH, HEIGHT, things), camera).views


def test_margins_are_as_wide_as_what_is_seen_of_them():
    """The corner at 0.3715 focal lengths comes from 0.3827, 3.02 %: 1.8 and 1.3 px at the sides."""
    barrel, panning = CAMERAS["barrel"], CAMERAS["panning"]
    assert views(barrel, wall())[0].margin == (2, 2)
    assert views(panning, wall())[0].margin == (8, 4)  # half of 14 and 6 px, and one
    both = views(barrel.replace(shutter=0.02, velocity=(700.0, 300.0)), wall())
    assert [view.margin for view in both] == [(11, 6), (8, 4)]  # 8 + 0.0302 * (59.5 + 8) px


def test_margins_are_not_wider_than_a_quarter():
    assert views(CAMERA.replace(shutter=1.0, velocity=(700.0, 30.0)), wall())[0].margin == (30, 16)


@pytest.mark.parametrize(
    "thing",
    [
        SceneObject("disc", px(20), radius=px(30)),
        SceneObject("disc", px(20), radius=px(30), width=px(90), height=px(90)),
        SceneObject("full"),
        SceneObject("box", px(-40), width=px(30)),
    ],
)
def test_what_is_even_outside_needs_no_margin(thing):
    assert views(CAMERAS["barrel"], thing)[0].margin == (0, 0)


def test_an_image_has_no_outside():
    image = np.random.default_rng(3).random((HEIGHT, WIDTH, 3)).astype(np.float32)
    prepared = PreparedScene(Scene(WIDTH, HEIGHT, (wall(),), image=image), CAMERAS["panning"])
    assert prepared.views[0].margin == (0, 0)


def test_what_is_left_out_leaves_the_frame():
    """However many effects a plan skips, the picture is as large as it should be."""
    prepared = PreparedScene(Scene(WIDTH, HEIGHT, (wall(),)), CAMERAS["barrel"])
    whole = run_plan(prepared)
    bare = run_plan(
        prepared, [one.name for one in PreparedScene(prepared.given.scene, CAMERA).present]
    )
    assert whole.values.shape == bare.values.shape == (HEIGHT, WIDTH, 3)
    assert np.array_equal(bare.values, taken(CAMERA, wall()))


def test_what_was_drawn_is_not_written_over():
    """Layers that are photographed twice keep what they show."""
    prepared = PreparedScene(Scene(WIDTH, HEIGHT, (wall(depth=5.0),)), CAMERAS["shear"])
    first, again = (run_plan(prepared).values for _ in range(2))
    assert np.array_equal(first, again)
