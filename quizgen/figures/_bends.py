"""The points of a line that are seen to bend it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import sqrt

Point = Sequence[float]


def bends(points: Sequence[Point], unseen: float) -> list[Point]:
    """A line without points that lie on it as well as anybody sees.

    Parameters
    ----------
    points : sequence of (float, float)
        At least two.
    unseen : float
        How far from the line a point may lie that is left out.

    Returns
    -------
    list of (float, float)
        From one on, as many as can be are left out while the line neither leaves them nor turns
        back; the first and the last point stay.
    """
    if len(points) == 2:
        return [*points]
    kept, view = [points[0]], _View(unseen)
    for before, (x, y) in pairwise(points):
        if not view.holds(x - kept[-1][0], y - kept[-1][1]):
            kept.append(before)
            view = _View(unseen)
        view.narrow(x - kept[-1][0], y - kept[-1][1])
    return [*kept, points[-1]]


class _View:
    """The directions from a point in which a line passes all that was left out since."""

    def __init__(self, unseen: float) -> None:
        self.unseen = unseen
        self.far = 0.0
        self.right: tuple[float, float] | None = None
        self.left = (0.0, 0.0)

    def holds(self, x: float, y: float) -> bool:
        """Whether a line may go on to here."""
        if x * x + y * y < self.far:
            return False
        right, left = self.right, self.left
        return right is None or (right[0] * y >= right[1] * x and x * left[1] >= y * left[0])

    def narrow(self, x: float, y: float) -> None:
        """Pass this point as well."""
        self.far = x * x + y * y
        if self.far <= self.unseen**2:
            return
        sine = self.unseen / sqrt(self.far)
        cosine = sqrt(1 - sine * sine)
        right = (x * cosine + y * sine, y * cosine - x * sine)
        left = (x * cosine - y * sine, y * cosine + x * sine)
        if self.right is None:
            self.right, self.left = right, left
        if self.right[0] * right[1] > self.right[1] * right[0]:
            self.right = right
        if left[0] * self.left[1] > left[1] * self.left[0]:
            self.left = left
