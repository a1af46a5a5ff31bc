"""Layers are photographed one by one, and only where something is: the picture is the same."""

import numpy as np

from quizgen.camera import Camera, Length, PreparedScene, Scene, SceneObject, View
from quizgen.camera.padding import crop_layer
from quizgen.camera.pixels.kernels import disc_kernel
from quizgen.camera.raster import layers
from quizgen.camera.raster.rasterizer import Layer, composite_layers, rasterize
from quizgen.camera.simulation import run_plan

CAMERA = Camera(
    0.05, 1e-4, f_number=2.0, focus_distance=2.0, k1=-0.05, lateral_colour=1.5, shutter=0.02,
    row_time=1e-5, velocity=(30.0, 0.0), gamma="srgb",
)  # fmt: skip


def px(value):
    return Length(float(value))


def scene(*more):
    """A wall, a lamp near the border and a propeller, 300 x 260 px: several tiles and bands."""
    lamp = SceneObject("disc", px(-120), px(-90), radius=px(14), depth=9.0, colour=(4.0, 3.0, 1.0))
    blades = SceneObject(
        "blades", px(40), px(30), radius=px(70), stroke=px(9), depth=2.0, spin=20.0,
        colour=(0.1, 0.5, 0.2),
    )  # fmt: skip
    wall = SceneObject("full", texture="checker", cell=px(20), depth=12.0, other=(0.2, 0.2, 0.3))
    return Scene(300, 260, (*more, wall, lamp, blades), background_depth=14.0)


def one_after_another(prepared):
    """Every effect on the whole stack."""
    stack = prepared.stack
    for effect, view in zip(prepared.present, prepared.views, strict=True):
        stack = effect.run(tuple(crop_layer(layer, view) for layer in stack), view)
    return composite_layers(tuple(crop_layer(layer, prepared.view) for layer in stack))


def test_a_layer_at_a_time_is_the_whole_stack_at_once():
    prepared = PreparedScene(scene(), CAMERA)
    expected = one_after_another(prepared)
    drawn = [layer.colour.copy() for layer in prepared.stack]
    assert np.array_equal(run_plan(prepared).values, expected)
    assert all(map(np.array_equal, drawn, (layer.colour for layer in prepared.stack)))
    assert np.array_equal(run_plan(prepared, last=True).values, expected)
    assert "stack" not in vars(prepared)


def test_what_stands_behind_a_wall_is_not_drawn():
    behind = SceneObject("disc", radius=px(50), depth=13.0)
    hidden, seen = (PreparedScene(scene(*more), CAMERA) for more in ((behind,), ()))
    assert len(hidden.stack) == len(seen.stack) == 3
    assert np.array_equal(run_plan(hidden).values, run_plan(seen).values)


def test_a_wall_that_moves_does_not_hide_what_comes_after():
    """Without a lens nothing but motion keeps layers apart."""
    wall = SceneObject("full", velocity=(px(9), px(0)), depth=5.0, colour=(0.0, 0.0, 1.0))
    disc_before = SceneObject("disc", radius=px(5), depth=3.0, colour=(1.0, 0.0, 0.0))
    stack = rasterize(View(Scene(20, 16, (wall, disc_before)), Camera()))
    assert [layer.cover is None for layer in stack] == [True, False]
    assert composite_layers(stack)[8, 10].tolist() == [1.0, 0.0, 0.0]
    assert composite_layers(stack)[0, 0].tolist() == [0.0, 0.0, 1.0]


def test_an_empty_layer_stays_empty():
    empty = Layer(np.zeros((20, 30, 3), np.float32), np.zeros((20, 30, 1), np.float32))
    for layer in (
        layers.blur_layer(empty, disc_kernel(5.0)),
        layers.rotate_layer(empty, [0.3], 4.0),
    ):
        assert not layer.colour.any()
        assert not layer.cover.any()
