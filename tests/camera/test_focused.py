"""Things kept as they were drawn are photographed as the whole simulator photographs them."""

import random
from dataclasses import replace

import numpy as np
from sweep import together

from quizgen.camera import Camera, Length, PreparedScene, Scene, SceneObject, run_plan
from quizgen.camera.picture_sets import make_focused
from quizgen.camera.pixels.filters import numpy_only


def things(rng):
    """Three that stand inside a frame of 60 x 40 pixels and touch when they are blurred."""
    for place in (-18.0, 0.0, 18.0):
        yield SceneObject(
            rng.choice(["disc", "box"]),
            x=Length(place),
            y=Length(rng.uniform(-3, 3)),
            width=Length(rng.uniform(6, 17)),
            height=Length(rng.uniform(6, 30)),
            radius=Length(rng.uniform(3, 8)),
            cell=Length(rng.uniform(2, 6)),
            texture=rng.choice(["plain", "checker", "stripes"]),
            colour=(rng.random(), rng.random(), rng.random()),
            other=(rng.random(), rng.random(), rng.random()),
        )


def lens(rng):
    return Camera(
        0.05, 0.6e-3, rng.choice([1.4, 2.8, 22.0]), rng.choice([1.0, 2.0, 4.0]),
        gamma=rng.choice(["srgb", "linear", 2.2]),
    )  # fmt: skip


@together("precision", ["float32", "float64"])
@together("seed", range(12))
def test_they_are_the_pixels_of_the_simulator(seed, precision):
    rng = random.Random(seed)
    scene = Scene(60, 40, tuple(things(rng)), (0.1, 0.2, 0.3), precision=precision)
    cameras = [lens(rng) for _ in range(3)]
    for _ in range(2):
        depths = [rng.choice([0.5, 1.0, 2.0, 4.0, 30.0]) for _ in scene.things]
        stand = zip(scene.things, depths, strict=True)
        whole = replace(scene, things=tuple(replace(one, depth=depth) for one, depth in stand))
        with numpy_only():
            expected = [run_plan(PreparedScene(whole, camera)).pixels() for camera in cameras]
        for photo, wanted in zip(make_focused(scene, depths, *cameras), expected, strict=True):
            np.testing.assert_array_equal(photo, wanted)
