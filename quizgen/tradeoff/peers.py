"""Other libraries, called as a user would call them, where they are installed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress

import numpy as np

from quizgen.tradeoff.rung import Column

Peer = Callable[..., Sequence[float] | Column]
"""Takes columns, returns the results."""


def _gaussian() -> dict[str, Peer]:
    from scipy import special

    return {
        "SciPy 2 ndtr(-k)": lambda k: 2 * special.ndtr(-k),
        "SciPy erfc(k/sqrt 2)": lambda k: special.erfc(k / 2**0.5),
    }


def _inverse() -> dict[str, Peer]:
    import cv2

    def undistort(r_d: Column, k1: Column, k2: Column) -> Column:
        points = np.stack([r_d, np.zeros_like(r_d)], axis=-1)[:, None, :]
        lens = np.array([k1[0], k2[0], 0.0, 0.0])
        return cv2.undistortPoints(points, np.eye(3), lens)[:, 0, 0]

    return {"OpenCV undistortPoints": undistort}


def _hue_skimage() -> dict[str, Peer]:
    from skimage.color import rgb2hsv

    def hue(R: Column, G: Column, B: Column) -> Column:
        return 360 * rgb2hsv(np.stack([R, G, B], axis=-1)[None])[0, :, 0]

    return {"scikit-image rgb2hsv": hue}


def _hue_standard() -> dict[str, Peer]:
    import colorsys

    def hue(*rgb: Column) -> list[float]:
        return [360 * colorsys.rgb_to_hsv(*map(float, one))[0] for one in zip(*rgb, strict=True)]

    return {"colorsys": hue}


def _hue_opencv() -> dict[str, Peer]:
    import cv2

    def hue(R: Column, G: Column, B: Column) -> Column:
        picture = np.stack([R, G, B], axis=-1)[None].astype(np.float32)
        return cv2.cvtColor(picture, cv2.COLOR_RGB2HSV)[0, :, 0].astype(np.float64)

    return {"OpenCV float32": hue}


def _poisson() -> dict[str, Peer]:
    from scipy.stats import poisson

    return {"SciPy stats.poisson.pmf": poisson.pmf}


def _normalise() -> dict[str, Peer]:
    from skimage.exposure import rescale_intensity

    def rescale(*columns: Column) -> list[float]:
        rows = zip(*columns, strict=True)
        return [
            rescale_intensity(np.array([value]), in_range=(low, high), out_range=(a, b))[0]
            for value, low, high, a, b in rows
        ]

    return {"scikit-image rescale_intensity": rescale}


_SOURCES: dict[str, tuple[Callable[[], dict[str, Peer]], ...]] = {
    "gaussian-tail": (_gaussian,),
    "inverse-distortion": (_inverse,),
    "hue": (_hue_skimage, _hue_standard, _hue_opencv),
    "poisson": (_poisson,),
    "normalisation": (_normalise,),
}


_SLOW_TO_LOAD = {_poisson}


def peers(family: str, *, slow: bool = True) -> dict[str, Peer]:
    """Name to function for every installed library that has this family.

    Parameters
    ----------
    family : str
    slow : bool
        Also libraries that take half a second to load.
    """
    found: dict[str, Peer] = {}
    for source in _SOURCES.get(family, ()):
        if source in _SLOW_TO_LOAD and not slow:
            continue
        with suppress(ImportError):
            found |= source()
    return found
