"""Thin lens: where the image is, how far from the focal plane, and how large.

Source: Gaussian lens formula 1/f = 1/z + 1/z', distances positive for real object and image.
"""

from __future__ import annotations

import numpy as np

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import POSITIVE
from quizgen.arrays.kernel import Kernel, Short


def _image_distance(f: Array, z: Array) -> Array:
    # z - f is exact near the focal plane, and larger/(z - f) neither overflows nor underflows.
    return np.minimum(f, z) * (np.maximum(f, z) / _from_focus(f, z))


def _focus_shift(f: Array, z: Array) -> Array:
    return f * (f / _from_focus(f, z))


def _magnification(f: Array, z: Array) -> Array:
    return f / _from_focus(f, z)


def _from_focus(f: Array, z: Array) -> Array:
    """Distance z - f, where equal values give a positive zero: the pole is plus infinity."""
    return z - f


def _image_distance_near(f: Array, z: Array, out: Array) -> None:
    np.divide(z, z - f, out=out)
    out *= f


_IMAGE_DISTANCE = Kernel(
    _image_distance, (POSITIVE, POSITIVE), short=Short(_image_distance_near, 2.0**400)
)
_FOCUS_SHIFT = Kernel(_focus_shift, (POSITIVE, POSITIVE))
_MAGNIFICATION = Kernel(_magnification, (POSITIVE, POSITIVE))


def image_distance(f: Numbers, z: Numbers) -> Result:
    """Distance z' = f z/(z - f) of the image behind the lens.

    Parameters
    ----------
    f : array_like
        Focal length, > 0, any unit of length.
    z : array_like
        Object distance, > 0, same unit.

    Returns
    -------
    float or array
        Same unit; negative for a virtual image (z < f), infinity at the pole z = f.
        At most 2 units in the last place from the true value.
    """
    return _IMAGE_DISTANCE(f, z)


def focus_shift(f: Numbers, z: Numbers) -> Result:
    """Distance z' - f = f**2/(z - f) of the image from the focal plane.

    Parameters
    ----------
    f, z : array_like
        Focal length and object distance, > 0, same unit.

    Returns
    -------
    float or array
        Same unit; infinity at the pole z = f.
    """
    return _FOCUS_SHIFT(f, z)


def magnification(f: Numbers, z: Numbers) -> Result:
    """Image size over object size, m = z'/z = f/(z - f).

    Parameters
    ----------
    f, z : array_like
        Focal length and object distance, > 0, same unit.

    Returns
    -------
    float or array
        Pure number; positive for a real (upside-down) image, infinity at the pole z = f.
    """
    return _MAGNIFICATION(f, z)
