"""Colour filters: light of a lamp's spectrum through the dyes over the photosites.

A surface reflects its blue, green and red value at 455, 535 and 610 nm, in between linearly, and
beyond as at the last of them: in the infrared as in red. Curves of filters are straight lines and
bells of the usual kind, not those of one maker.
"""

from __future__ import annotations

import re
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import Setting, in_range
from quizgen.camera.setup.value_parsers import parse_bool, parse_plain_number
from quizgen.camera.setup.view import Signal, View
from quizgen.numerics.luminosity import luminous_efficiency

Curve = NDArray[np.float64]

_KELVIN = re.compile(r"\s*(\d+(?:\.\d*)?)\s*K\s*")


def _parse_kelvin(value: object) -> float:
    """Return the colour temperature in K of a text such as ``2856 K``."""
    match = _KELVIN.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        raise ValueError("expected a colour temperature such as '2856 K'")
    return parse_plain_number(float(match[1]))


LIGHT = Setting[float | None]("light", _parse_kelvin, None, (in_range(1000.0, 25000.0, "K"),))
"""Colour temperature of the light, K; it is as bright to the eye as daylight would be."""
INFRARED_FILTER = Setting("infrared_filter", parse_bool, identity=True)
"""Whether a filter before the sensor holds the infrared back."""

DAYLIGHT = 5500.0
"""Colour temperature in K of the light under which white is white."""
_PLANCK = 1.438776877e7
"""h c/k in nm K (CODATA 2018)."""

WAVELENGTHS = np.arange(380.0, 1101.0)
"""nm: silicon sees no farther than 1100."""
_BLUE, _GREEN, _RED = 455.0, 535.0, 610.0


def _interpolate_curve(*points: tuple[float, float]) -> Curve:
    """Return a spectral curve: straight between points (nm, value), level beyond them."""
    at, values = zip(*points, strict=True)
    return np.interp(WAVELENGTHS, at, values)


def _build_dye(centre: float, width: float, opens: float) -> Curve:
    """Return a dye's transmittance: a bell (nm), open again in the infrared from ``opens``."""
    bell = np.exp(-0.5 * ((WAVELENGTHS - centre) / width) ** 2)
    return np.maximum(bell, _interpolate_curve((opens, 0.0), (opens + 120.0, 1.0)))


def lamp_spectrum(temperature: float) -> Curve:
    """Return Planck's spectrum at `WAVELENGTHS` for K, scaled to the luminous flux 1."""
    power = WAVELENGTHS**-5.0 / np.expm1(_PLANCK / (WAVELENGTHS * temperature))
    return np.asarray(power / (power * luminous_efficiency(WAVELENGTHS)).sum())


@lru_cache(maxsize=1)
def _sensor_curves() -> tuple[Curve, Curve, Curve]:
    """Return the spectra of the three sites, the infrared filter and the reflectances.

    The last are those that a red, a green and a blue value stand for.
    """
    silicon = WAVELENGTHS * _interpolate_curve(
        (650.0, 1.0), (1100.0, 0.0)
    )  # photons, not joules, are counted
    red = _interpolate_curve((570.0, 0.0), (610.0, 1.0))
    dyes = np.stack([red, _build_dye(_GREEN, 40.0, 690.0), _build_dye(_BLUE, 35.0, 720.0)])
    infrared = _interpolate_curve((630.0, 1.0), (680.0, 0.0))
    bands = np.stack([
        _interpolate_curve((_GREEN, 0.0), (_RED, 1.0)),
        _interpolate_curve((_BLUE, 0.0), (_GREEN, 1.0), (_RED, 0.0)),
        _interpolate_curve((_BLUE, 1.0), (_GREEN, 0.0)),
    ])  # fmt: skip
    return dyes * silicon, infrared, bands


@lru_cache(maxsize=64)
def mixing_matrix(temperature: float, *, infrared_filter: bool) -> Curve:
    """Return the 3 x 3 matrix from the scene's red, green, blue to what each site (row) sees.

    No entry is negative. White under `DAYLIGHT`, seen through the infrared filter, makes 1 in every
    row.
    """
    sites, infrared, bands = _sensor_curves()
    white = (sites * infrared * lamp_spectrum(DAYLIGHT)).sum(axis=1)
    seen = sites * lamp_spectrum(temperature) * (infrared if infrared_filter else 1.0)
    return np.asarray((seen[:, None, :] * bands).sum(axis=2) / white[:, None])


def _camera_matrix(view: View) -> Curve:
    """Return the `mixing_matrix` of the camera's light and filter."""
    camera = view.camera
    return mixing_matrix(camera[LIGHT] or DAYLIGHT, infrared_filter=camera[INFRARED_FILTER])


def operation(view: View) -> TileOperation:
    """Return what replaces the colours of a tile by those that the sites see under the light."""
    weights = _camera_matrix(view).astype(view.precision)

    def mix_channels(part: Image, _: Tile) -> None:
        """Mix the colours of a tile in place."""
        scene = [part[channel::3].copy() for channel in range(3)]
        for channel, row in enumerate(weights):
            terms = [colour * weight for colour, weight in zip(scene, row, strict=True) if weight]
            part[channel::3] = sum(terms[1:], terms[0])

    return mix_channels


def omission_bound(signal: Signal, view: View) -> float:
    """Return the largest change of any value: matrix minus identity over all colours in range."""
    apart = _camera_matrix(view) - np.eye(3)
    up, down = np.maximum(apart, 0.0).sum(axis=1), np.minimum(apart, 0.0).sum(axis=1)
    ends = up * signal.high + down * signal.low, up * signal.low + down * signal.high
    return float(np.abs(ends).max())


def range_after(signal: Signal, view: View) -> Signal:
    """Return the signal's range times the smallest and the largest sum of a row of the matrix."""
    rows = _camera_matrix(view).sum(axis=1)
    return signal.scale_range(float(rows.min()), float(rows.max()))


EFFECT = Effect(
    name="colour filters",
    answers=("colour filters", "infrared"),
    settings=(LIGHT, INFRARED_FILTER),
    is_present=lambda view: view.camera[LIGHT] is not None,
    run=PointByPoint(operation),
    omission_bound=omission_bound,
    carry_error=lambda error, _, view: error * float(_camera_matrix(view).sum(axis=1).max()),
    range_after=range_after,
    needs="light",
)
