"""Means of neighbouring Bayer sites, with the rounding rule stated.

Source: bilinear interpolation takes the mean of two to four neighbours of one colour. Sums are
exact integers (four bytes do not fit one byte); what happens to the fraction is the caller's
choice, because libraries differ.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from quizgen.arrays.aliases import Counts, Result
from quizgen.arrays.domain import DomainError

RULES = ("exact", "half-up", "half-even", "down")
"""Keep the fraction; round ties up (OpenCV); round ties to even (NumPy); drop the fraction."""


def neighbour_mean(*sites: npt.ArrayLike, rule: str = "exact") -> Result:
    """Mean of the values at two to four neighbouring sites.

    Parameters
    ----------
    *sites : array_like of int
        Raw values of the neighbours, same shape.
    rule : str
        One of ``RULES``.

    Returns
    -------
    float or int or array
        Floats for ``exact``, otherwise integers.

    Raises
    ------
    DomainError
        ``no-sites``; ``not-a-count`` when a value is not a whole number; ``unknown-rule``.
    """
    if rule not in RULES:
        raise DomainError("unknown-rule")
    result: Result
    total, count = _sum(sites), len(sites)
    if rule == "exact":
        result = total / count
    elif rule == "down":
        result = total // count
    elif rule == "half-up":
        result = (2 * total + count) // (2 * count)
    else:
        result = _half_even(total, count)
    return result.item() if np.ndim(result) == 0 else result


def _sum(sites: tuple[npt.ArrayLike, ...]) -> Counts:
    if not sites:
        raise DomainError("no-sites")
    arrays = [np.asarray(site) for site in sites]
    if not all(np.issubdtype(array.dtype, np.integer) for array in arrays):
        raise DomainError("not-a-count")
    return np.sum(np.stack([array.astype(np.int64) for array in arrays]), axis=0)


def _half_even(total: Counts, count: int) -> npt.NDArray[np.int64]:
    down, rest = np.divmod(total, count)
    up = (2 * rest > count) | ((2 * rest == count) & (down % 2 == 1))
    return down + up
