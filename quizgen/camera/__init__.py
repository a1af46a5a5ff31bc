"""A camera that simulates only what the scene calls for.

``scene`` holds plain values, ``effects`` one function per effect, ``plan`` decides, ``simulate``
runs. Pictures are float32 arrays (H, W, 3), linear until ``gamma``; importing needs NumPy only.
"""

from quizgen.camera.plan import Plan, everything, plan
from quizgen.camera.scene import Camera, Length, Scene, SceneError, Thing, View
from quizgen.camera.simulate import Photo, simulate, simulate_everything

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
    "plan",
    "simulate",
    "simulate_everything",
]
