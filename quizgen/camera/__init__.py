"""A camera that simulates what a question asks about.

In: a scene and a camera, as plain values or as a TOML file, and what is asked, or a budget in grey
levels. Out: a picture, and what ran, what was left out and why, and what was measured. Must never
know: templates, languages, figures.

``scene`` holds plain values, ``effects`` one module per effect, ``planning`` decides, ``simulate``
runs, ``question`` measures. Pictures are arrays (H, W, 3) of the scene's precision, linear until
``gamma``; importing needs NumPy only.
"""

from quizgen.camera.camera import Camera
from quizgen.camera.planning import Plan, plan_budget, plan_everything, plan_question
from quizgen.camera.prepared import Prepared
from quizgen.camera.question import simulate
from quizgen.camera.scene import Length, Scene, SceneError, Thing
from quizgen.camera.simulate import Photo, photographs, run, simulate_everything
from quizgen.camera.view import View

__all__ = [
    "Camera",
    "Length",
    "Photo",
    "Plan",
    "Prepared",
    "Scene",
    "SceneError",
    "Thing",
    "View",
    "photographs",
    "plan_budget",
    "plan_everything",
    "plan_question",
    "run",
    "simulate",
    "simulate_everything",
]
