"""Mean and variance of images with any offset.

Sources: two passes, the second around the first mean, with the remaining mean taken out again
(Chan, Golub & LeVeque, Am. Stat. 37 (1983) 242); sums carry what their additions round off
(Ogita, Rump & Oishi, SIAM J. Sci. Comput. 26 (2005) 1955).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator

import numpy as np
import numpy.typing as npt

from quizgen.arrays.aliases import Array
from quizgen.arrays.domain import DomainError
from quizgen.arrays.double_double import two_sum
from quizgen.arrays.kernel import BLOCK

_LARGE = 2.0**480
_SMALL = 2.0**-480


def _pieces(image: npt.NDArray[np.generic]) -> Iterator[Array]:
    flat = image.reshape(-1)
    for start in range(0, flat.size, BLOCK):
        yield flat[start : start + BLOCK].astype(np.float64, copy=False)


def _total(image: npt.NDArray[np.generic], of: Callable[[Array], Iterable[float]]) -> float:
    return math.fsum(part for piece in _pieces(image) for part in of(piece))


def _sums(values: Array) -> Iterator[float]:
    """Numbers whose sum is that of the values to twice the working precision."""
    while values.size > 1:
        half = values.size // 2
        if values.size % 2:
            yield float(values[-1])
        values, lost = two_sum(values[:half], values[half : 2 * half])
        yield float(lost.sum())
    yield float(values[0])


def _read(image: npt.ArrayLike) -> tuple[npt.NDArray[np.generic], int, bool]:
    """The image, a power of two that tames its values, and whether its sum cancels."""
    values = np.asarray(image)
    if values.size == 0:
        raise DomainError("empty")
    limits = [(float(piece.min()), float(piece.max())) for piece in _pieces(values)]
    low, high = min(low for low, _ in limits), max(high for _, high in limits)
    if not all(math.isfinite(end) for limit in limits for end in limit):
        raise DomainError("not-finite")
    top = max(high, -low)
    if top == 0 or _SMALL < top < _LARGE:
        return values, 0, low < 0 < high
    shift = math.frexp(top)[1]
    return np.ldexp(values.astype(np.float64), -shift), shift, low < 0 < high


def _plain_mean(values: npt.NDArray[np.generic]) -> float | None:
    """The mean of an ordinary image: nothing is negative, so that nothing cancels."""
    if values.size == 0 or not values.min() >= 0:
        return None
    sums = [float(piece.sum()) for piece in _pieces(values)]
    return math.fsum(sums) / values.size if max(sums) < _LARGE else None


def _plain(piece: Array) -> tuple[float]:
    return (float(piece.sum()),)


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
        plain = _plain_mean(np.asarray(image))
        if plain is not None:
            return plain
        values, shift, cancels = _read(image)
        return _scaled(_total(values, _sums if cancels else _plain) / values.size, shift)


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
        values, shift, _ = _read(image)
        if values.size <= ddof:
            raise DomainError("too-few")
        first = _total(values, _plain) / values.size
        rest = _total(values, lambda piece: _plain(piece - first)) / values.size
        squares = _total(values, lambda piece: _plain((piece - first) ** 2))
        return _scaled((squares - values.size * rest * rest) / (values.size - ddof), 2 * shift)


def _scaled(value: float, shift: int) -> float:
    try:
        return math.ldexp(value, shift)
    except OverflowError:
        return math.copysign(math.inf, value)
