"""Layers are remade band by band, in place where nobody else needs them: nothing is lost."""

import numpy as np
import pytest
from msgspec.structs import replace

from quizgen.camera import Camera, Length, PreparedScene, Scene, SceneObject
from quizgen.camera.effects import get_effect
from quizgen.camera.pixels.kernels import motion_kernel
from quizgen.camera.raster import layers
from quizgen.camera.raster.rasterizer import Layer, composite_layers, full_box
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


def test_a_thing_is_blurred_along_its_motion_alone():
    colour, cover = np.zeros((160, 200, 3), np.float32), np.zeros((160, 200, 1), np.float32)
    colour[32:96, 32:128], cover[32:96, 32:128] = 0.6, 1.0
    moved = layers.blur_layer(Layer(colour, cover), motion_kernel(8.0, 0.0))
    assert np.array_equal(moved.colour[32:96], np.broadcast_to(moved.colour[32], (64, 200, 3)))
    assert moved.colour[50, 127, 0] == pytest.approx(0.6 * 4.5 / 8, abs=0.01)
    assert not moved.colour[:32].any()
    assert not moved.colour[96:].any()


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
            - layers._turn_images([colour], full_box((80, 90)), layer.motion, [0.7])[0]
        ).max()
        < 1e-6
    )
