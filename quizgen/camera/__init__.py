"""A camera that simulates what a question asks about.

In: a scene and a camera, as plain values or as a TOML file, and what is asked, or a budget in grey
levels. Out: a picture, and what ran, what was left out and why, and what was measured. Must never
know: templates, languages, figures.

``setup`` holds plain values, ``effects`` one module per effect, ``planner`` decides,
``simulation`` runs, ``question_photo`` measures. Pictures are arrays (H, W, 3) of the scene's
precision, linear until ``gamma``; importing needs NumPy only.
"""

from quizgen.camera.camera import Camera
from quizgen.camera.planner import Plan, PreparedScene, plan_budget, plan_question
from quizgen.camera.question_photo import simulate_question
from quizgen.camera.setup.scene import Length, Scene, SceneError, SceneObject
from quizgen.camera.setup.view import View
from quizgen.camera.simulation import Photo, run_plan

__all__ = [
    "Camera",
    "Length",
    "Photo",
    "Plan",
    "PreparedScene",
    "Scene",
    "SceneError",
    "SceneObject",
    "View",
    "plan_budget",
    "plan_question",
    "run_plan",
    "simulate_question",
]
