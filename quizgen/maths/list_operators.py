"""What operators on lists do, the same for exact rationals as for floats.

Sums, means, variances, medians and quantiles of
rationals are rationals; only a standard deviation and a correlation need a root, which each number
system takes in its own way.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from flint import fmpq

from quizgen.core.errors import MathError
from quizgen.maths.numbers import to_float
from quizgen.maths.values import AnyNumber, NumberList


def _require_list(values: AnyNumber, least: int = 1) -> NumberList:
    """Return a list of at least so many values; ``MathError`` if it is none."""
    if not isinstance(values, NumberList):
        raise MathError("a number stands where a list is needed")
    if len(values) < least:
        raise MathError(f"a list of {len(values)} values, where {least} are needed")
    return values


def _require_pairs(first: AnyNumber, second: AnyNumber) -> tuple[NumberList, NumberList]:
    """Return two lists of the same length, at least 2; ``MathError`` otherwise."""
    one, other = _require_list(first, 2), _require_list(second, 2)
    if len(one) != len(other):
        raise MathError(f"lists of {len(one)} and of {len(other)} values cannot be paired")
    return one, other


def add_values(values: AnyNumber) -> AnyNumber:
    """Return the sum."""
    first, *rest = _require_list(values)
    return sum(rest, first)


def compute_mean(values: AnyNumber) -> AnyNumber:
    """Return the arithmetic mean."""
    return add_values(values) / len(values)


def _sum_products(one: NumberList, other: NumberList) -> AnyNumber:
    """Return the sum of the products of what two lists differ from their means."""
    left, right = compute_mean(one), compute_mean(other)
    return add_values(NumberList((a - left) * (b - right) for a, b in zip(one, other, strict=True)))


def compute_variance(values: AnyNumber) -> AnyNumber:
    """Return the variance of a sample, by n - 1."""
    listed = _require_list(values, 2)
    return _sum_products(listed, listed) / (len(listed) - 1)


def compute_population_variance(values: AnyNumber) -> AnyNumber:
    """Return the variance of a population, by n."""
    listed = _require_list(values)
    return _sum_products(listed, listed) / len(listed)


def compute_covariance(first: AnyNumber, second: AnyNumber) -> AnyNumber:
    """Return the covariance of a sample of pairs, by n - 1."""
    one, other = _require_pairs(first, second)
    return _sum_products(one, other) / (len(one) - 1)


def compute_slope(first: AnyNumber, second: AnyNumber) -> AnyNumber:
    """Return the slope of the line of least squares, ``second`` over ``first``."""
    one, other = _require_pairs(first, second)
    return _sum_products(one, other) / _sum_products(one, one)


def compute_quantile(values: AnyNumber, share: AnyNumber) -> AnyNumber:
    """Return the quantile of method 7, linear between ordered values, as R and NumPy have it.

    Source: Hyndman and Fan, Sample quantiles in statistical packages, 1996.
    """
    ordered = sort_values(values)
    if isinstance(share, tuple) or not 0 <= share <= 1:
        raise MathError("a quantile needs a share from 0 to 1")
    place = share * (len(ordered) - 1)
    below = int(place.floor()) if isinstance(place, fmpq) else math.floor(place)
    if below + 1 >= len(ordered):
        return ordered[-1]
    return ordered[below] + (place - below) * (ordered[below + 1] - ordered[below])


def compute_median(values: AnyNumber) -> AnyNumber:
    """Return the value in the middle, or the mean of the two there."""
    ordered = sort_values(values)
    low, high = ordered[(len(ordered) - 1) // 2], ordered[len(ordered) // 2]
    return (low + high) / 2


def sort_values(values: AnyNumber) -> NumberList:
    """Return the values, smallest first."""
    return NumberList(sorted(_require_list(values)))


def pick_value(values: AnyNumber, place: AnyNumber) -> AnyNumber:
    """Return the value at a place, counted from 1.

    Raises
    ------
    MathError
        If there is no such place.
    """
    listed = _require_list(values)
    if isinstance(place, tuple) or place != (index := int(float(to_float(place)))):
        raise MathError("a place in a list is a whole number")
    if not 1 <= index <= len(listed):
        raise MathError(f"no place {index} in a list of {len(listed)} values (the first is 1)")
    return listed[index - 1]


def _pick_least(values: AnyNumber) -> AnyNumber:
    """Return the least value of a list; a number is its own minimum."""
    return min(_require_list(values)) if isinstance(values, tuple) else values


def _pick_largest(values: AnyNumber) -> AnyNumber:
    """Return the largest value of a list; a number is its own maximum."""
    return max(_require_list(values)) if isinstance(values, tuple) else values


def build_list_functions(
    square_root: Callable[[AnyNumber], AnyNumber], number: Callable[[int], AnyNumber]
) -> dict[str, Callable[..., AnyNumber]]:
    """Return each operator on lists by its name in the table of operators.

    Parameters
    ----------
    square_root : callable
        How roots are taken in the number system.
    number : callable
        How a whole number is made there.
    """

    def correlate(first: AnyNumber, second: AnyNumber) -> AnyNumber:
        """Return Pearson's correlation coefficient of two lists, -1 to 1."""
        one, other = _require_pairs(first, second)
        spread = _sum_products(one, one) * _sum_products(other, other)
        return _sum_products(one, other) / square_root(spread)

    return {
        "mean": compute_mean,
        "var": compute_variance,
        "sd": lambda values: square_root(compute_variance(values)),
        "pvar": compute_population_variance,
        "psd": lambda values: square_root(compute_population_variance(values)),
        "median": compute_median,
        "quantile": compute_quantile,
        "len": lambda values: number(len(_require_list(values, 0))),
        "sort": sort_values,
        "cov": compute_covariance,
        "corr": correlate,
        "slope": compute_slope,
        "at": pick_value,
        "list_sum": add_values,
        "list_min": _pick_least,
        "list_max": _pick_largest,
    }
