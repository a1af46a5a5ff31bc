"""What an effect leaves alone shows one colour as far as it could look; the picture is the same."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.ndimage import maximum_filter, minimum_filter
from sweep import spread, together

from quizgen.camera import Camera, Length, PreparedScene, Scene, SceneObject
from quizgen.camera.effects import get_effect
from quizgen.camera.pixels.kernels import disc_kernel, motion_kernel
from quizgen.camera.raster import detail_regions, layers
from quizgen.camera.raster.detail_regions import regions_changed_by_blur, sampled_regions
from quizgen.camera.raster.rasterizer import Layer, composite_layers
from quizgen.camera.simulation import run_plan

EFFECTS = (
    "distortion",
    "lateral colour",
    "axial colour",
    "defocus",
    "motion blur",
    "rolling shutter",
)
CAMERA = Camera(
    0.05, 1e-4, f_number=2.0, focus_distance=2.0, k1=-0.03, lateral_colour=1.5, axial_colour=4e-4,
    shutter=0.02, row_time=1e-4, velocity=(200.0, 90.0),
)  # fmt: skip


def px(value):
    return Length(float(value))


def patches(source, *, covered):
    """A few even boxes, also at the border and where squares begin; often nothing at all."""
    height, width = source.integers(1, 150, 2)
    colour = np.full((height, width, 3), 0.0 if covered else 0.4, np.float32)
    cover = np.zeros((height, width, 1), np.float32)
    for _ in range(source.integers(0, 4)):
        top, left = (source.choice([0, 31, 32, 33, 64, n // 2]) for n in (height, width))
        part = tuple(slice(at, at + source.choice([1, 7, 32, 64])) for at in (top, left))
        share = source.choice([0.5, 1.0])
        colour[part], cover[part] = source.random(3) * share, share
    return Layer(colour, cover if covered else None)


def range_nearby(values, rows, columns):
    """Largest minus smallest value so near to each pixel; edges repeat."""
    size = (2 * rows + 1, 2 * columns + 1, 1)
    most, least = (f(values, size, mode="nearest") for f in (maximum_filter, minimum_filter))
    return (most - least).max(axis=2)


@together("covered", [False, True])
@together("seed", spread(range(60), 12))
def test_elsewhere_a_layer_is_even_as_far_as_an_effect_looks(seed, covered):
    source = np.random.default_rng([seed, covered])
    layer = patches(source, covered=covered)
    rows, columns = source.integers(0, 9, 2) * source.choice([1, 5])
    if seed % 2:
        where = regions_changed_by_blur(layer, np.ones((2 * rows + 1, 2 * columns + 1)))
    else:
        where = sampled_regions(layer, (float(columns), float(rows)))
    assert where.reach >= min(rows, len(layer.colour))
    alone = np.ones(layer.colour.shape[:2], bool)
    for box in where.boxes:
        assert all(part.start < part.stop for part in box)
        alone[box] = False
    images = [layer.colour] if layer.cover is None else [layer.colour, layer.cover]
    assert not any(range_nearby(image, rows, columns)[alone].any() for image in images)


def test_a_thing_in_a_wide_picture_is_found_where_it_is():
    """Of a disc the outline, which is 3770 px long, with squares of 32 px around."""
    y, x = np.mgrid[:1500, :2000]
    far = np.hypot(y - 750, x - 1000)
    colour = np.repeat((far < 600)[..., None], 3, axis=2).astype(np.float32)
    near = np.zeros(far.shape, bool)
    for box in regions_changed_by_blur(Layer(colour), disc_kernel(9.0)).boxes:
        near[box] = True
    assert near[abs(far - 600) < 5].all()
    assert near.sum() < 3770 * 6 * 32


def scene():
    """A striped wall, a lamp across the border of the frame, an even box and a propeller."""
    lamp = SceneObject("disc", px(-140), px(-90), radius=px(24), depth=9.0, colour=(4.0, 3.0, 1.0))
    box = SceneObject("box", px(60), px(50), width=px(110), height=px(90), depth=5.0)
    blades = SceneObject(
        "blades", px(-40), px(30), radius=px(50), stroke=px(9), depth=2.0, spin=20.0,
        colour=(0.1, 0.5, 0.2),
    )  # fmt: skip
    wall = SceneObject(
        "box", width=px(200), height=px(80), texture="stripes", cell=px(20), depth=12.0
    )
    return Scene(300, 260, (wall, lamp, box, blades), background_depth=14.0)


@pytest.mark.parametrize("effect", EFFECTS)
@pytest.mark.parametrize("square", [4, 32, 100])
def test_what_is_left_alone_would_not_have_changed(effect, square, monkeypatch):
    prepared = PreparedScene(scene(), CAMERA)
    view = dict(zip((one.name for one in prepared.present), prepared.views, strict=True))[effect]
    view = replace(view, margin=prepared.views[0].margin)
    monkeypatch.setattr(detail_regions, "SQUARE", 4096)
    whole = get_effect(effect).run(prepared.stack, view)
    monkeypatch.setattr(detail_regions, "SQUARE", square)
    parts = get_effect(effect).run(prepared.stack, view)
    for one, other in zip(parts, whole, strict=True):
        assert np.abs(one.colour - other.colour).max() < 1e-5
        if one.cover is not None:
            assert np.abs(one.cover - other.cover).max() < 1e-6


@pytest.mark.parametrize("effect", EFFECTS)
def test_what_nobody_else_needs_is_written_over(effect, monkeypatch):
    """Rows are made while those above them still wait to be written."""
    monkeypatch.setattr(layers, "_ROWS", 16)
    prepared = PreparedScene(scene(), CAMERA)
    view = prepared.views[0]
    kept = [layer.colour.copy() for layer in prepared.stack]
    expected = get_effect(effect).run(prepared.stack, view)
    assert all(map(np.array_equal, kept, (layer.colour for layer in prepared.stack)))
    copies = tuple(
        replace(
            one,
            colour=one.colour.copy(),
            cover=None if one.cover is None else one.cover.copy(),
            own=True,
        )
        for one in prepared.stack
    )
    for one, other in zip(get_effect(effect).run(copies, view), expected, strict=True):
        assert np.array_equal(one.colour, other.colour)
        assert one.cover is None or np.array_equal(one.cover, other.cover)


def test_a_layer_of_one_colour_is_handed_on():
    layer = Layer(np.full((90, 70, 3), 0.3, np.float32))
    assert layers.blur_layer(layer, motion_kernel(8.0, 3.0)) is layer


def test_a_thing_that_begins_where_a_square_does_is_blurred_along_its_edge():
    """Seen from the square above it, its edge is the only change, and the blur does not cross it."""
    colour, cover = np.zeros((160, 200, 3), np.float32), np.zeros((160, 200, 1), np.float32)
    colour[32:96, 32:128], cover[32:96, 32:128] = 0.6, 1.0
    moved = layers.blur_layer(Layer(colour, cover), motion_kernel(8.0, 0.0))
    assert np.array_equal(moved.colour[32:96], np.broadcast_to(moved.colour[32], (64, 200, 3)))
    assert moved.colour[50, 127, 0] == pytest.approx(0.6 * 4.5 / 8, abs=0.01)
    assert not moved.colour[:32].any()
    assert not moved.colour[96:].any()


def test_a_sky_of_stars_is_looked_at_as_a_whole():
    """Where boxes are so many that handing them over takes longer than the rest, there is one."""
    colour = np.zeros((640, 960, 3), np.float32)
    colour[16::64, 16::64] = 1.0
    assert len(regions_changed_by_blur(Layer(colour), disc_kernel(9.0)).boxes) == 1
    colour[:] = 0.0
    colour[16::320, 16::320] = 1.0
    assert len(regions_changed_by_blur(Layer(colour), disc_kernel(9.0)).boxes) == 6


def test_a_run_leaves_the_drawn_layers_alone():
    prepared = PreparedScene(scene(), CAMERA)
    kept = [layer.colour.copy() for layer in prepared.stack]
    first = run_plan(prepared).values
    assert all(map(np.array_equal, kept, (layer.colour for layer in prepared.stack)))
    assert np.array_equal(run_plan(prepared, last=True).values, first)


def test_a_turning_thing_at_the_border_comes_in_from_outside():
    """The edge is repeated outward: what touches it may turn into any corner."""
    colour = np.zeros((80, 90, 3), np.float32)
    colour[:5, 30:60] = 1.0
    layer = Layer(
        colour, colour[..., :1].copy(), motion=replace(Layer(colour).motion, pivot=(45.0, 40.0))
    )
    turned = layers.rotate_layer(layer, [0.7], 200.0)
    assert (
        np.abs(
            composite_layers((turned,))
            - layers._turn_images([colour], detail_regions.full_box((80, 90)), layer.motion, [0.7])[
                0
            ]
        ).max()
        < 1e-6
    )
