"""Mean and variance of images with any offset.

Source: two passes, the second around the first mean, with the remaining mean taken out again
(Chan, Golub & LeVeque, Am. Stat. 37 (1983) 242); blocks are summed pairwise in double precision
and the block sums exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt

from .domain import BLOCK, Array, DomainError

_LARGE = 2.0**480
_SMALL = 2.0**-480


def _pieces(image: npt.NDArray[np.generic]) -> Iterator[Array]:
    flat = image.reshape(-1)
    for start in range(0, flat.size, BLOCK):
        yield flat[start : start + BLOCK].astype(np.float64)


def _total(image: npt.NDArray[np.generic], of: Callable[[Array], Array]) -> float:
    return math.fsum(float(np.sum(of(piece))) for piece in _pieces(image))


def _read(image: npt.ArrayLike) -> tuple[npt.NDArray[np.generic], int]:
    """The image, and the power of two that brings its largest value near 1 when it is extreme."""
    values = np.asarray(image)
    if values.size == 0:
        raise DomainError("empty")
    top = max(float(np.max(np.abs(piece))) for piece in _pieces(values))
    if not math.isfinite(top):
        raise DomainError("not-finite")
    if top == 0 or _SMALL < top < _LARGE:
        return values, 0
    shift = math.frexp(top)[1]
    return np.ldexp(values.astype(np.float64), -shift), shift


def _centre(values: npt.NDArray[np.generic]) -> tuple[float, float]:
    """A first mean and what is left of the mean around it."""
    first = _total(values, lambda piece: piece) / values.size
    return first, _total(values, lambda piece: piece - first) / values.size


def mean(image: npt.ArrayLike) -> float:
    """Mean of all values.

    Parameters
    ----------
    image : array_like
        Any shape and number type.

    Returns
    -------
    float
        Unit of the values.

    Raises
    ------
    DomainError
        ``empty``, ``not-finite``.
    """
    with np.errstate(all="ignore"):
        values, shift = _read(image)
        first, rest = _centre(values)
        return _scaled(first + rest, shift)


def variance(image: npt.ArrayLike, *, ddof: int = 1) -> float:
    """Variance of all values, sum of squared deviations over (n - ddof).

    Parameters
    ----------
    image : array_like
        Any shape and number type.
    ddof : int
        1 for the sample variance, 0 for the population variance.

    Returns
    -------
    float
        Squared unit of the values, accurate for any offset.

    Raises
    ------
    DomainError
        ``empty``, ``not-finite``, ``too-few`` (not more values than ddof).
    """
    with np.errstate(all="ignore"):
        values, shift = _read(image)
        if values.size <= ddof:
            raise DomainError("too-few")
        first, rest = _centre(values)
        squares = _total(values, lambda piece: (piece - first) ** 2)
        return _scaled((squares - values.size * rest * rest) / (values.size - ddof), 2 * shift)


def _scaled(value: float, shift: int) -> float:
    try:
        return math.ldexp(value, shift)
    except OverflowError:
        return math.copysign(math.inf, value)
