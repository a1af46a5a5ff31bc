"""A camera that simulates only what the scene calls for.

In: a scene and a camera, as plain values or as a TOML file, and a budget in grey levels. Out: a
picture, and a plan that says what ran, what was left out, why, and by how much that can matter.
Must never know: questions, languages, figures.

``scene`` holds plain values, ``effects`` one module per effect, ``plan`` decides, ``simulate``
runs. Pictures are arrays (H, W, 3) of the scene's precision, linear until ``gamma``; importing
needs NumPy only.
"""

from quizgen.camera.camera import Camera
from quizgen.camera.decision import Plan
from quizgen.camera.plan import everything, plan
from quizgen.camera.scene import Length, Scene, SceneError, Thing
from quizgen.camera.simulate import Photo, photographs, simulate, simulate_everything
from quizgen.camera.view import View

__all__ = [
    "Camera",
    "Length",
    "Photo",
    "Plan",
    "Scene",
    "SceneError",
    "Thing",
    "View",
    "everything",
    "photographs",
    "plan",
    "simulate",
    "simulate_everything",
]
