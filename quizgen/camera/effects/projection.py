"""Projection: lengths in metres become pixels, x = v X/Z at image distance v."""

from __future__ import annotations

import math
from dataclasses import replace

from quizgen.camera.effect import Effect
from quizgen.camera.setup.scene import Length, Scene, SceneError, SceneObject
from quizgen.camera.setup.view import View


def project_scene(scene: Scene, view: View) -> Scene:
    """Return the scene with all lengths in metres, each at its depth, as px on the sensor.

    Parameters
    ----------
    scene : Scene
        Things with lengths in m; a length in px stays.
    view : View
        Camera with focal length and pixel pitch.
    """
    return replace(
        scene, things=tuple(_project_thing(thing, view.image_distance) for thing in scene.things)
    )


def _project_thing(thing: SceneObject, distance: float) -> SceneObject:
    """Return a thing with its metric lengths times ``distance`` (to the sensor, px) over depth."""

    def on_sensor(length: Length) -> Length:
        """Return a length in px; one that is in px stays."""
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
    answers=("projection", "geometry", "artefacts"),
    is_present=lambda view: view.scene.is_metric,
    prepare=project_scene,
    run=lambda stack, _: stack,  # all is done once the scene is drawn
    always="lengths in metres",
)
