"""Names used in the reference rows, and the array functions behind them."""

from __future__ import annotations

from quizgen.numerics import distortion, gamma, gaussian, hsv, luminosity

FUNCTIONS = {
    "gaussian.inverse_upper_tail": gaussian.inverse_upper_tail,
    "distortion.distort_x": lambda *args: distortion.distort(*args)[0],
    "distortion.fold_radius": distortion.fold_radius,
    "distortion.inverse_radius": distortion.inverse_radius,
    "gamma.srgb_decode": gamma.srgb_decode,
    "hsv.red": lambda *args: hsv.hsv_to_rgb(*args)[0],
    "hsv.green": lambda *args: hsv.hsv_to_rgb(*args)[1],
    "hsv.blue": lambda *args: hsv.hsv_to_rgb(*args)[2],
    "luminosity.luminous_efficiency": luminosity.luminous_efficiency,
}
"""By the name of the formula's family."""

COUNTS = {
    "distortion.distort_x": 4, "distortion.fold_radius": 2,
    "distortion.inverse_radius": 3, "hsv.red": 3, "hsv.green": 3, "hsv.blue": 3,
}  # fmt: skip
"""Arguments of the functions that take more than one."""


def function(name):
    """Callable for ``family.function``."""
    return FUNCTIONS[name]
