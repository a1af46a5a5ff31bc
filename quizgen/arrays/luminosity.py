"""Luminous flux of lines and bands, the energy of photons and the light of black bodies.

Sources: CIE 018 (V(lambda), V'(lambda), linear between table points, zero outside; Km = 683 lm/W);
SI Brochure 2019 (h, c, e, k exact); Planck, Ann. Phys. 309 (1901) 553.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from quizgen.arrays import cie1951
from quizgen.arrays.aliases import Array, Indices, Limits, Numbers, Result
from quizgen.arrays.cie1924 import FIRST_NM, STEP_NM, V
from quizgen.arrays.domain import NONNEGATIVE, POSITIVE, Rule
from quizgen.arrays.double_double import Pair, split, two_product, two_sum
from quizgen.arrays.gaussian import pdf
from quizgen.arrays.kernel import Exactly, Kernel, Short
from quizgen.arrays.rational import nearest

KM = 683.0
"""Lumens per watt at the peak."""

_HC_EV_NM = 1239.8419843320025
_HC = 1.9864458571489286e-25
_TABLE = np.array(V)
_EDGES = FIRST_NM + STEP_NM * np.arange(_TABLE.size)
_LAST_NM = float(_EDGES[-1])
_NIGHT = dict(
    zip(cie1951.FIRST_NM + cie1951.STEP_NM * np.arange(len(cie1951.V)), cie1951.V, strict=True)
)
_NIGHT_NM, _NIGHT_V = np.array(sorted({**_NIGHT, cie1951.PEAK_NM: 1.0}.items())).T
_SIGMA = 0.42466090014400953
_SIGMA_LOST = -1.2979732052298702e-17
"""Standard deviation of a line of unit full width at half maximum, 1/sqrt(8 ln 2)."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_FALL = 4.0
"""Twelve nodes integrate a fall by exp(4) to all digits."""

_FALLS = _FALL * np.arange(12)
"""A piece counts until the line has fallen by exp(44)."""


def _between(i: int | Indices, t: Array) -> Array:
    """V at t nm beyond table point i: two positive terms, exact factors."""
    value: Array = (_TABLE[i] * (STEP_NM - t) + _TABLE[i + 1] * t) / STEP_NM
    return value


def _photopic(wavelength: Array) -> Array:
    # Differences of whole numbers and wavelengths are exact; a quotient by the step is not.
    above = np.clip(wavelength, FIRST_NM, _LAST_NM) - FIRST_NM
    i = np.minimum((above / STEP_NM).astype(np.intp), _TABLE.size - 2)
    i -= above < i * STEP_NM
    inside = (wavelength >= FIRST_NM) & (wavelength <= _LAST_NM)
    return np.where(inside, _between(i, above - i * STEP_NM), 0.0)


def _scotopic(wavelength: Array) -> Array:
    return np.interp(wavelength, _NIGHT_NM, _NIGHT_V, left=0.0, right=0.0)


def _band(low: Array, high: Array) -> Array:
    """Mean of V over a band; the midpoint rule is exact on each straight piece."""
    low, high = np.broadcast_arrays(low, high)
    total, lost = np.zeros(low.shape), np.zeros(low.shape)
    for i, start in enumerate(_EDGES[:-1]):
        left, right = (np.clip(end, start, start + STEP_NM) - start for end in (low, high))
        if not np.any(right > left):
            continue
        total, rest = two_sum(total, (right - left) * _between(i, (left + right) / 2))
        lost += rest
    empty = low == high
    mean = (total + lost) / np.where(empty, 1.0, high - low)
    return np.where(empty, _photopic(low), mean)


def _line(centre: Array, fwhm: Array) -> Array:
    centre, fwhm = np.broadcast_arrays(centre, fwhm)
    return np.array([_one_line(float(c), float(w)) for c, w in zip(centre, fwhm, strict=True)])


def _one_line(centre: float, fwhm: float) -> float:
    """Mean of V under a normalised Gaussian line.

    Each straight piece of V is integrated from its end next to the centre outwards, in steps
    over which the line falls by exp(4), so that nothing cancels and tails keep their digits.
    """
    sigma, lost = two_product(fwhm, _SIGMA) if fwhm < _HUGE else (fwhm * _SIGMA, 0.0)
    if not sigma > 0 or math.isinf(1 / sigma):
        return float(_photopic(np.array([centre]))[0])
    i, near, far = _pieces(centre)
    height = pdf(near, centre, sigma)
    seen = height > 0
    i, near, far, height = i[seen], near[seen], far[seen], height[seen]
    away = np.abs(near - centre) / sigma
    height *= 1 + (away * away - 1) * ((lost + fwhm * _SIGMA_LOST) / sigma)
    piece, start, stop = _steps(away, np.abs(far - near) / sigma)
    row = piece[:, None]
    half = 0.5 * (stop - start)[:, None]
    s = start[:, None] + half * (1 + _NODES)
    at = (near - _EDGES[i])[row] + sigma * s * np.sign(far - near)[row]
    parts = np.exp(-s * (away[row] + 0.5 * s)) * _between(i[row], at) * (half * _WEIGHTS)
    return math.fsum(height[piece] * (parts.sum(axis=1) * sigma))


def _steps(away: Array, length: Array) -> tuple[Indices, Array, Array]:
    """Steps over which a line falls by exp(4): their piece, and from where to where in sigma.

    Pieces begin ``away`` standard deviations from the centre and are ``length`` long.
    """
    ends = 2 * _FALLS / (np.sqrt(away[:, None] ** 2 + 2 * _FALLS) + away[:, None] + _LEAST)
    ends = np.minimum(ends, length[:, None])
    piece, step = np.nonzero(np.diff(ends) > 0)
    return piece, ends[piece, step], ends[piece, step + 1]


_LEAST, _HUGE = 1e-300, 1e150


def _pieces(centre: float) -> tuple[Indices, Array, Array]:
    """Straight pieces of V on one side of the centre: index, end next to it, other end."""
    i = np.arange(_TABLE.size - 1)
    start, stop = _EDGES[:-1], _EDGES[1:]
    before = stop <= centre
    near, far = np.where(before, stop, start), np.where(before, start, stop)
    split = np.flatnonzero((start < centre) & (centre < stop))
    near[split] = centre
    return np.append(i, i[split]), np.append(near, near[split]), np.append(far, start[split])


def _planck(wavelength: Array, temperature: Array) -> Array:
    """1/(exp(x) - 1) with x = c2/(wavelength temperature) to twice the working precision."""
    x = _C2 / (Pair(wavelength) * Pair(temperature))
    high = np.minimum(x.high, _DARK)
    less_one = np.expm1(np.minimum(high, _STEEP))
    less_one += (less_one + 1) * x.low
    steep = np.exp(-high)
    steep -= steep * x.low
    return np.where(high < _STEEP, 1 / less_one, steep)


def _planck_short(wavelength: Array, temperature: Array, out: Array) -> None:
    """With E = exp(-x) below 1/2 it is E/(1 - E).

    x = h + y with h in 26 bits, so that its products with halves of the wavelength are exact, and
    a short series for exp(-y).
    """
    rate = _C2 / Pair(temperature)
    inverse = 1 / wavelength
    h = inverse * rate.high
    h += _FINE
    h -= _FINE
    upper, lower = (half * h for half in split(wavelength))
    y = rate.high - upper
    y -= lower
    y += rate.low
    y *= inverse
    np.exp(np.negative(h, out=h), out=h)
    np.multiply(y, 0.5, out=upper)
    upper -= 1
    y *= upper
    y *= h
    h += y
    np.subtract(1, h, out=y)
    np.divide(h, y, out=out)


_FINE = 1.5 * 2.0**32
"""Adding and taking away this rounds a number below 64 to a multiple of 2**-20."""


def _is_dark(wavelength: Limits, temperature: Limits) -> bool:
    """Whether x stays between 0.7 and 63."""
    return (
        wavelength[1] * temperature[1] < _C2.high / 0.7
        and wavelength[0] * temperature[0] > _C2.high / 63
    )


def _planck_far(wavelength: Fraction, temperature: Fraction) -> float:
    """The same for magnitudes whose product leaves the range of doubles."""
    x = _C2_EXACT / (wavelength * temperature)
    if x > _DARK:
        return 0.0
    if x < _FLAT:
        return nearest(1 / x)
    high = float(x)
    low = float(x - Fraction(high))
    if high < _STEEP:
        return 1 / (math.expm1(high) + math.exp(high) * low)
    return math.exp(-high) * (1 - low)


_C2_EXACT = Fraction(272115870842319, 18913000)
_FLAT = Fraction(1, 2**60)
_C2 = Pair(14387768.775039338, 4.460310775877047e-10)
"""Second radiation constant h c/k in nanometre kelvin."""

_STEEP, _DARK = 40.0, 760.0
_PHOTOPIC = Kernel(_photopic, (NONNEGATIVE,))
_SCOTOPIC = Kernel(_scotopic, (NONNEGATIVE,))
_BAND = Kernel(_band, (NONNEGATIVE,) * 2, (Rule("reversed", lambda low, high: high < low),))
_LINE = Kernel(_line, (NONNEGATIVE, NONNEGATIVE))


def _over_wavelength(constant: float) -> Kernel:
    def divide(wavelength: Array, out: Array) -> None:
        np.divide(constant, wavelength, out=out)

    return Kernel(
        lambda wavelength: constant / wavelength,
        (POSITIVE,),
        short=Short(divide, math.inf, tiny=True),
    )


_ENERGY, _ENERGY_EV = _over_wavelength(_HC), _over_wavelength(_HC_EV_NM)
_PLANCK = Kernel(
    lambda *args: (_planck(*args), None),
    (POSITIVE, POSITIVE),
    exact=Exactly(_planck_far),
    short=Short(_planck_short, fits=_is_dark),
)


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
    """
    return _PHOTOPIC(wavelength)


def scotopic(wavelength: Numbers) -> Result:
    """Luminous efficiency of the eye at night V'(lambda), CIE 1951.

    Parameters
    ----------
    wavelength : array_like
        Nanometres, >= 0.

    Returns
    -------
    float or array
        0 to 1; linear between table points 5 nm apart and the peak at 507 nm, 0 outside 380 to
        780 nm.
    """
    return _SCOTOPIC(wavelength)


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
        ``reversed`` (high < low).
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
        Lumens; every straight piece of V(lambda) is integrated from its end next to the centre, so
        no line falls between grid points. Shares of the power below 1e-300 lose digits.
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
    """
    return _ENERGY_EV(wavelength)


def planck_factor(wavelength: Numbers, temperature: Numbers) -> Result:
    """Photons per mode of a black body, 1/(exp(h c/(lambda k T)) - 1).

    Parameters
    ----------
    wavelength : array_like
        Nanometres, > 0.
    temperature : array_like
        Kelvin, > 0.

    Returns
    -------
    float or array
        Pure number; 0 where it is below the smallest double (lambda T < 19000 nm K).
    """
    return _PLANCK(wavelength, temperature)
