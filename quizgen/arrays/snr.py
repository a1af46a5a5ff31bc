"""Signal-to-noise ratio of photon counts with read noise.

Source: variance N of a Poisson count plus sigma**2 of the read-out; SNR = N/sqrt(N + sigma**2).
"""

from __future__ import annotations

import numpy as np

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import NONNEGATIVE, POSITIVE
from quizgen.arrays.kernel import Kernel, Short, extreme, filled

_REACH = 2.0**300
_LEAST = 5e-324


def _snr(N: Array, sigma: Array) -> Array:
    value = _snr_short(N, sigma)
    odd = extreme((N, sigma), _REACH)
    if odd is not None:
        value = np.where(odd, N / np.maximum(np.hypot(np.sqrt(N), sigma), _LEAST), value)
    return value


def _snr_short(N: Array, sigma: Array) -> Array:
    value = N / np.sqrt(N + sigma * sigma)
    return np.where(N == 0, 0.0, value) if N.min() == 0 else value


def _loss(N: Array, sigma: Array) -> Array:
    return -np.expm1(-0.5 * np.log1p(sigma * (sigma / N)))


def _photons(snr: Array, sigma: Array) -> Array:
    half = snr / 2
    root = np.sqrt(half * half + sigma * sigma)
    odd = extreme((snr, sigma), _REACH)
    if odd is not None:
        root = np.where(odd, np.hypot(half, sigma), root)
    return snr * (half + root)


_SNR = Kernel(
    _snr,
    (NONNEGATIVE, NONNEGATIVE),
    short=Short(filled(_snr_short), _REACH),
)
_LOSS = Kernel(_loss, (POSITIVE, NONNEGATIVE))
_PHOTONS = Kernel(_photons, (NONNEGATIVE, NONNEGATIVE))


def snr(N: Numbers, sigma: Numbers = 0.0) -> Result:
    """Signal-to-noise ratio N/sqrt(N + sigma**2).

    Parameters
    ----------
    N : array_like
        Mean number of photons (electrons), >= 0.
    sigma : array_like
        Standard deviation of the read noise in electrons, >= 0.

    Returns
    -------
    float or array
        Pure number; 0 without photons.
    """
    return _SNR(N, sigma)


def snr_loss(N: Numbers, sigma: Numbers) -> Result:
    """Share of the shot-noise limit sqrt(N) lost to read noise, 1 - SNR/sqrt(N).

    Parameters
    ----------
    N : array_like
        Mean number of photons, > 0.
    sigma : array_like
        Read noise, >= 0.

    Returns
    -------
    float or array
        Between 0 and 1, accurate when it is tiny.
    """
    return _LOSS(N, sigma)


def photons_for(snr: Numbers, sigma: Numbers = 0.0) -> Result:
    """Photons needed for a signal-to-noise ratio, S (S/2 + sqrt(S**2/4 + sigma**2)).

    Parameters
    ----------
    snr : array_like
        Wanted ratio S, >= 0.
    sigma : array_like
        Read noise, >= 0.

    Returns
    -------
    float or array
        Mean number of photons.
    """
    return _PHOTONS(snr, sigma)
