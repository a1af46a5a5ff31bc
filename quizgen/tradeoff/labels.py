"""Places for labels beside their points, so that no label covers another one or a point."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

ROOM = 0.62
"""Width of a character in sizes of the letters, generously."""
_RADII = (6, 10, 15, 21, 28, 36, 46, 58, 74, 94, 120)
_ANGLES = (-90, 0, 180, 90, -45, -135, 45, 135, -20, 200, 20, 160)
_FAR = 20.0
"""A label this far from its point is tied to it by a line."""


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangle of a picture."""

    left: float
    top: float
    right: float
    bottom: float

    def meets(self, other: Box) -> bool:
        """Whether they have area in common."""
        return (
            self.left < other.right
            and other.left < self.right
            and self.top < other.bottom
            and other.top < self.bottom
        )

    def within(self, other: Box) -> bool:
        """Whether it lies in another one."""
        across = other.left <= self.left and self.right <= other.right
        return across and other.top <= self.top and self.bottom <= other.bottom


@dataclass(frozen=True, slots=True)
class Placed:
    """A label, the middle of its line of letters, its box, and the point that it belongs to."""

    text: str
    x: float
    y: float
    box: Box
    point: tuple[float, float]

    @property
    def far(self) -> bool:
        """Whether a line must tie it to its point."""
        x, y = self.point
        return math.hypot(self.x - x, (self.box.top + self.box.bottom) / 2 - y) > _FAR


@dataclass
class Labels:
    """The labels of one picture, and what they must keep clear of."""

    bounds: Box
    size: float = 11.0
    taken: list[Box] = field(default_factory=list)

    def keep_clear(self, x: float, y: float, reach: float = 5.0) -> None:
        """Let no label cover a point."""
        self.taken.append(Box(x - reach, y - reach, x + reach, y + reach))

    def written(self, x: float, baseline: float, text: str, anchor: str) -> None:
        """Let no label cover a text that stands already."""
        width = self._width(text)
        left = {"start": x, "middle": x - width / 2, "end": x - width}[anchor]
        self.taken.append(Box(left, baseline - self.size, left + width, baseline + 3))

    def _width(self, text: str) -> float:
        return ROOM * self.size * len(text) + 2

    def place(self, text: str, x: float, y: float) -> Placed | None:
        """The nearest free place beside a point, or None if there is none."""
        half, high = self._width(text) / 2, self.size * 0.62
        for radius in _RADII:
            for angle in _ANGLES:
                across, along = math.cos(math.radians(angle)), math.sin(math.radians(angle))
                at_x, at_y = x + across * (radius + half), y + along * (radius + high)
                box = Box(at_x - half, at_y - high, at_x + half, at_y + high)
                if box.within(self.bounds) and not any(map(box.meets, self.taken)):
                    self.taken.append(box)
                    return Placed(text, at_x, at_y + 0.36 * self.size, box, (x, y))
        return None
