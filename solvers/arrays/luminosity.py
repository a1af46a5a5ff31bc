"""Luminous flux of lines and bands, and the energy of photons.

Sources: CIE 018 (V(lambda), linear between table points, zero outside; Km = 683 lm/W);
SI Brochure 2019 (h, c, e exact).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from .cie1924 import FIRST_NM, STEP_NM, V
from .domain import NONNEGATIVE, POSITIVE, Array, Kernel, Numbers, Result, Rule
from .gaussian import interval, pdf

KM = 683.0
"""Lumens per watt at the peak."""

_HC_EV_NM = 1239.8419843320025
_HC = 1.9864458571489286e-25
_TABLE = np.array(V)
_EDGES = FIRST_NM + STEP_NM * np.arange(_TABLE.size)
_LAST_NM = float(_EDGES[-1])
_PER_FWHM = 1 / (2 * math.sqrt(2 * math.log(2)))
_NARROW = STEP_NM / 4
_WIDE = STEP_NM * 2


def _photopic(wavelength: Array) -> Array:
    position = (np.clip(wavelength, FIRST_NM, _LAST_NM) - FIRST_NM) / STEP_NM
    index = np.minimum(position.astype(np.intp), _TABLE.size - 2)
    share = position - index
    inside = (wavelength >= FIRST_NM) & (wavelength <= _LAST_NM)
    # A sum of two positive terms keeps its digits; v + share (w - v) would not.
    return np.where(inside, _TABLE[index] * (1 - share) + _TABLE[index + 1] * share, 0.0)


def _band(low: Array, high: Array) -> Array:
    """Mean of V over a band; the midpoint rule is exact on each straight piece."""
    low, high = np.broadcast_arrays(low, high)
    total = np.zeros(low.shape)
    for start in _EDGES[:-1]:
        left, right = np.maximum(low, start), np.minimum(high, start + STEP_NM)
        width = np.maximum(right - left, 0.0)
        total += width * np.where(width > 0, _photopic((left + right) / 2), 0.0)
    empty = low == high
    return np.where(empty, _photopic(low), total / np.where(empty, 1.0, high - low))


def _quadrature(nodes: int) -> tuple[Array, Array]:
    """Wavelengths and weights times V for Gauss quadrature on every straight piece."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    points = (_EDGES[:-1, None] + STEP_NM * (0.5 + 0.5 * x)).ravel()
    weights = np.tile(0.5 * STEP_NM * w, _EDGES.size - 1)
    return points, weights * _photopic(points)


_FEW, _MANY = _quadrature(6), _quadrature(20)


def _line(centre: Array, fwhm: Array) -> Array:
    centre, sigma = np.broadcast_arrays(centre, fwhm * _PER_FWHM)
    return np.array([_one_line(float(c), float(s)) for c, s in zip(centre, sigma, strict=True)])


def _one_line(centre: float, sigma: float) -> float:
    """Mean of V under a normalised Gaussian line."""
    if sigma == 0 or math.isinf(1 / sigma):
        return float(_photopic(np.array([centre]))[0])
    if sigma >= _NARROW:
        points, weights = _FEW if sigma >= _WIDE else _MANY
        t = (points - centre) / sigma
        return float(np.sum(weights * np.exp(-t * t / 2)) / sigma) / math.sqrt(2 * math.pi)
    return _narrow_line(centre, sigma)


def _narrow_line(centre: float, sigma: float) -> float:
    """Closed form on the pieces within reach of a line much narrower than they are."""
    total = 0.0
    for i, start in enumerate(_EDGES[:-1]):
        if start - 40 * sigma > centre or start + STEP_NM + 40 * sigma < centre:
            continue
        a, b = (start - centre) / sigma, (start + STEP_NM - centre) / sigma
        slope = (V[i + 1] - V[i]) / STEP_NM
        at_centre = V[i] * (start + STEP_NM - centre) / STEP_NM
        at_centre += V[i + 1] * (centre - start) / STEP_NM
        part = at_centre * interval(a, b) + slope * sigma * (pdf(a) - pdf(b))
        total += max(part, 0.0)
    return total


_PHOTOPIC = Kernel(_photopic, (NONNEGATIVE,))
_BAND = Kernel(_band, (NONNEGATIVE,) * 2, (Rule("reversed", lambda low, high: high < low),))
_LINE = Kernel(_line, (NONNEGATIVE, NONNEGATIVE))
_ENERGY = Kernel(lambda wavelength: _HC / wavelength, (POSITIVE,))
_ENERGY_EV = Kernel(lambda wavelength: _HC_EV_NM / wavelength, (POSITIVE,))


def photopic(wavelength: Numbers) -> Result:
    """Luminous efficiency V(lambda), CIE 1924.

    Parameters
    ----------
    wavelength : array_like
        Nanometres, >= 0.

    Returns
    -------
    float or array
        0 to 1; linear between table points 5 nm apart, 0 outside 360 to 830 nm.

    Raises
    ------
    DomainError
        ``negative``, ``not-finite`` (arrays: masked).
    """
    return _PHOTOPIC(wavelength)


def band_flux(power: Numbers, low: Numbers, high: Numbers) -> Result:
    """Luminous flux of power spread evenly over a band.

    Parameters
    ----------
    power : array_like
        Radiant power in watts.
    low, high : array_like
        Ends of the band in nanometres, low <= high (equal: a line).

    Returns
    -------
    float or array
        Lumens.

    Raises
    ------
    DomainError
        ``reversed``, ``negative``, ``not-finite`` (arrays: masked).
    """
    return _scaled(power, _BAND, low, high)


def line_flux(power: Numbers, centre: Numbers, fwhm: Numbers = 0.0) -> Result:
    """Luminous flux of a Gaussian spectral line.

    Parameters
    ----------
    power : array_like
        Radiant power in watts.
    centre, fwhm : array_like
        Wavelength and full width at half maximum in nanometres, >= 0.

    Returns
    -------
    float or array
        Lumens; the integral under V(lambda) is closed form for narrow lines and Gauss quadrature
        on each straight piece for wide ones, so no line falls between grid points.

    Raises
    ------
    DomainError
        ``negative``, ``not-finite`` (arrays: masked).
    """
    return _scaled(power, _LINE, centre, fwhm)


def _scaled(power: Numbers, kernel: Callable[..., Any], *args: Numbers) -> Result:
    return _FLUX(power, kernel(*args))


_FLUX = Kernel(lambda power, share: power * (KM * share), (NONNEGATIVE, NONNEGATIVE))


def photon_energy(wavelength: Numbers) -> Result:
    """Energy of one photon, h c/lambda.

    Parameters
    ----------
    wavelength : array_like
        Metres, > 0.

    Returns
    -------
    float or array
        Joules.

    Raises
    ------
    DomainError
        ``not-positive``, ``not-finite`` (arrays: masked).
    """
    return _ENERGY(wavelength)


def photon_energy_ev(wavelength: Numbers) -> Result:
    """Energy of one photon in electron volts.

    Parameters
    ----------
    wavelength : array_like
        Nanometres, > 0.

    Returns
    -------
    float or array
        Electron volts: 1239.84.../lambda.

    Raises
    ------
    DomainError
        ``not-positive``, ``not-finite`` (arrays: masked).
    """
    return _ENERGY_EV(wavelength)
