"""Projection: lengths in metres become pixels, x = v X/Z at image distance v."""

from __future__ import annotations

import math
from dataclasses import replace

from quizgen.camera.effects.effect import (
    Effect,
    keep_stack,
)
from quizgen.camera.scene import Length, Scene, SceneError, Thing
from quizgen.camera.view import View


def project(scene: Scene, view: View) -> Scene:
    """Turn lengths in metres at a depth into pixels.

    Parameters
    ----------
    scene : Scene
        Things with lengths in m; a length in px stays.
    view : View
        Camera with focal length and pixel pitch.
    """
    return replace(
        scene, things=tuple(_project(thing, view.image_distance) for thing in scene.things)
    )


def _project(thing: Thing, distance: float) -> Thing:
    def on_sensor(length: Length) -> Length:
        if not length.metric:
            return length
        if math.isinf(thing.depth):
            raise SceneError(f"a {thing.shape} in metres needs a finite depth")
        return Length(distance * length.value / thing.depth)

    lengths = {name: on_sensor(length) for name, length in thing.lengths().items()}
    velocity = on_sensor(thing.velocity[0]), on_sensor(thing.velocity[1])
    return replace(thing, velocity=velocity, **lengths)  # type: ignore[arg-type]


EFFECT = Effect(
    name="projection",
    stage="scene",
    answers=("projection", "geometry", "artefacts"),
    is_present=lambda view: view.scene.metric,
    prepare=project,
    run=keep_stack,
    always="lengths in metres",
)
