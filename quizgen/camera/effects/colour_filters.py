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


def _kelvin(value: object) -> float:
    match = _KELVIN.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        raise ValueError("expected a colour temperature such as '2856 K'")
    return parse_plain_number(float(match[1]))


LIGHT = Setting[float | None]("light", _kelvin, None, (in_range(1000.0, 25000.0, "K"),))
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


def _line(*points: tuple[float, float]) -> Curve:
    """Straight between points (nm, value), level beyond them."""
    at, values = zip(*points, strict=True)
    return np.interp(WAVELENGTHS, at, values)


def _dye(centre: float, width: float, opens: float) -> Curve:
    """A bell, and transparent again in the infrared, 120 nm after it opens."""
    bell = np.exp(-0.5 * ((WAVELENGTHS - centre) / width) ** 2)
    return np.maximum(bell, _line((opens, 0.0), (opens + 120.0, 1.0)))


def lamp_spectrum(temperature: float) -> Curve:
    """Planck's law at `WAVELENGTHS`, of the luminous flux 1 (any unit)."""
    power = WAVELENGTHS**-5.0 / np.expm1(_PLANCK / (WAVELENGTHS * temperature))
    return np.asarray(power / (power * luminous_efficiency(WAVELENGTHS)).sum())


@lru_cache(maxsize=1)
def _curves() -> tuple[Curve, Curve, Curve]:
    """Sensitivity of red, green and blue sites; filter; reflectance that each value stands for."""
    silicon = WAVELENGTHS * _line((650.0, 1.0), (1100.0, 0.0))  # photons, not joules, are counted
    red = _line((570.0, 0.0), (610.0, 1.0))
    dyes = np.stack([red, _dye(_GREEN, 40.0, 690.0), _dye(_BLUE, 35.0, 720.0)])
    infrared = _line((630.0, 1.0), (680.0, 0.0))
    bands = np.stack([
        _line((_GREEN, 0.0), (_RED, 1.0)),
        _line((_BLUE, 0.0), (_GREEN, 1.0), (_RED, 0.0)),
        _line((_BLUE, 1.0), (_GREEN, 0.0)),
    ])  # fmt: skip
    return dyes * silicon, infrared, bands


@lru_cache(maxsize=64)
def mixing_matrix(temperature: float, *, infrared_filter: bool) -> Curve:
    """What each site (row) makes of the scene's red, green and blue: 3 x 3, none negative.

    White under `DAYLIGHT`, behind the filter against infrared, makes 1 in every row.
    """
    sites, infrared, bands = _curves()
    white = (sites * infrared * lamp_spectrum(DAYLIGHT)).sum(axis=1)
    seen = sites * lamp_spectrum(temperature) * (infrared if infrared_filter else 1.0)
    return np.asarray((seen[:, None, :] * bands).sum(axis=2) / white[:, None])


def _mixture(view: View) -> Curve:
    camera = view.camera
    return mixing_matrix(camera[LIGHT] or DAYLIGHT, infrared_filter=camera[INFRARED_FILTER])


def operation(view: View) -> TileOperation:
    """Mix the colours of every pixel."""
    weights = _mixture(view).astype(view.precision)

    def mix_channels(part: Image, _: Tile) -> None:
        scene = [part[channel::3].copy() for channel in range(3)]
        for channel, row in enumerate(weights):
            terms = [colour * weight for colour, weight in zip(scene, row, strict=True) if weight]
            part[channel::3] = sum(terms[1:], terms[0])

    return mix_channels


def omission_bound(signal: Signal, view: View) -> float:
    """Largest value of a row's difference from the identity over all colours in the range."""
    apart = _mixture(view) - np.eye(3)
    up, down = np.maximum(apart, 0.0).sum(axis=1), np.minimum(apart, 0.0).sum(axis=1)
    ends = up * signal.high + down * signal.low, up * signal.low + down * signal.high
    return float(np.abs(ends).max())


def range_after(signal: Signal, view: View) -> Signal:
    """Between the smallest and the largest sum of a row."""
    rows = _mixture(view).sum(axis=1)
    return signal.scale_range(float(rows.min()), float(rows.max()))


EFFECT = Effect(
    name="colour filters",
    answers=("colour filters", "infrared"),
    settings=(LIGHT, INFRARED_FILTER),
    is_present=lambda view: view.camera[LIGHT] is not None,
    run=PointByPoint(operation),
    omission_bound=omission_bound,
    carry_error=lambda error, _, view: error * float(_mixture(view).sum(axis=1).max()),
    range_after=range_after,
    needs="light",
)
