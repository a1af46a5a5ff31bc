"""Names used in the reference rows, and the array functions behind them."""

from __future__ import annotations

import importlib

_PARTS = {
    "distortion.distort_x": ("distortion", lambda m, *args: m.distort(*args)[0]),
    "projection.project_x": ("projection", lambda m, f, x, z: m.project(f, x, 0.0, z).x),
    "hsv.red": ("hsv", lambda m, *args: m.to_rgb(*args)[0]),
    "hsv.green": ("hsv", lambda m, *args: m.to_rgb(*args)[1]),
    "hsv.blue": ("hsv", lambda m, *args: m.to_rgb(*args)[2]),
}


def function(name):
    """Callable for ``family.function``."""
    family, short = name.split(".")
    if name in _PARTS:
        family, call = _PARTS[name]
        module = importlib.import_module(f"quizgen.arrays.{family}")
        return lambda *args: call(module, *args)
    return getattr(importlib.import_module(f"quizgen.arrays.{family}"), short)
