"""Points shared out over the parts of a question."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

LEAST = Fraction(1, 4)
"""Points that a part has at least, and that marks are told in."""


def share_points(total: Fraction, weights: Sequence[Fraction]) -> tuple[Fraction, ...]:
    """Return marks shared out in quarters by weight, a quarter at least to each.

    The sum is the total, unless that is less than a quarter for each.
    """
    whole = sum(weights)
    spare = total - LEAST * len(weights)
    if spare <= 0:
        return (LEAST,) * len(weights)
    exact = [spare * weight / whole for weight in weights]
    found = [share // LEAST * LEAST for share in exact]
    order = sorted(range(len(weights)), key=lambda i: (found[i] - exact[i], i))
    for place in order[: int((spare - sum(found)) / LEAST)]:
        found[place] += LEAST
    found[order[-1]] += spare - sum(found)
    return tuple(LEAST + share for share in found)


def rescale_points(points: Sequence[Fraction], total: Fraction) -> tuple[Fraction, ...]:
    """Return points of parts that add up to another total, each to each as near as quarters allow.

    Where there is less than a quarter for each, or quarters come out by themselves, they are exact.
    """
    scale = total / sum(points)
    exact = tuple(one * scale for one in points)
    in_quarters = all(one % LEAST == 0 for one in exact)
    return exact if in_quarters or total < LEAST * len(points) else share_points(total, points)
