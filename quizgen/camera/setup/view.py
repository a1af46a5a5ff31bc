"""A camera looking at a scene: what effects and bounds need to know, in px."""

from __future__ import annotations

import math
from typing import overload

import msgspec
import numpy as np
from numpy.typing import NDArray

from quizgen.camera.setup.scene import Image, Precision, Scene, SceneError
from quizgen.camera.setup.settings import (
    FOCAL_LENGTH,
    FOCUS_DISTANCE,
    PINHOLE,
    PIXEL_PITCH,
    CameraSettings,
    aperture_diameter,
)


class View(msgspec.Struct, frozen=True):
    """A camera looking at a scene, with all that follows from both: sizes and distances in px.

    Parameters
    ----------
    scene : Scene
    camera : CameraSettings
    margin : (int, int)
        Columns and rows seen beyond the frame on each side, see `quizgen.camera.padding`.
    """

    scene: Scene
    camera: CameraSettings
    margin: tuple[int, int] = (0, 0)

    @property
    def width(self) -> int:
        """Columns, margin included."""
        return self.scene.width + 2 * self.margin[0]

    @property
    def height(self) -> int:
        """Rows, margin included."""
        return self.scene.height + 2 * self.margin[1]

    @property
    def precision(self) -> Precision:
        """The type of number that the picture is computed in."""
        return self.scene.precision

    @property
    def focal(self) -> float:
        """Focal length in px."""
        length, pitch = self.camera[FOCAL_LENGTH], self.camera[PIXEL_PITCH]
        if length is None or pitch is None:
            raise SceneError("lengths in metres need focal_length and pixel_pitch")
        return length / pitch

    @property
    def image_distance(self) -> float:
        """Distance from the aperture to the sensor in px: v = f s/(s - f) (thin lens)."""
        length, distance = self.camera[FOCAL_LENGTH], self.camera[FOCUS_DISTANCE]
        if length is None or math.isinf(distance):
            return self.focal
        return self.focal * (distance / (distance - length))

    @property
    def f_number(self) -> float:
        """Focal length over aperture; infinite for a point."""
        length, opening = self.camera[FOCAL_LENGTH], aperture_diameter(self.camera)
        return math.inf if length is None or opening is None else length / opening

    @property
    def centre(self) -> tuple[float, float]:
        """Principal point (x, y), counted from the centre of the first pixel (errata E27)."""
        return (self.width - 1) / 2.0, (self.height - 1) / 2.0

    @property
    def corner(self) -> float:
        """Distance from the principal point to the farthest pixel centre, margin included, px."""
        return math.hypot(*self.centre)

    @property
    def frame_corner(self) -> float:
        """Distance from the principal point to the frame's farthest pixel, without margin, px."""
        return math.hypot((self.scene.width - 1) / 2.0, (self.scene.height - 1) / 2.0)

    @property
    def has_depth_map(self) -> bool:
        """Whether the picture has a distance of its own at every pixel."""
        return isinstance(self.scene.depth, np.ndarray)

    @overload
    def blur_diameter(self, depth: float) -> float: ...
    @overload
    def blur_diameter(self, depth: Image) -> NDArray[np.floating]: ...
    def blur_diameter(self, depth: float | Image) -> float | NDArray[np.floating]:
        """Return the signed circle of confusion, px: positive farther than the plane of focus.

        Parameters
        ----------
        depth : float or numpy.ndarray
            Distance in m, > 0, may be infinite. With f, N, s: c = f^2/(N (s-f)) (1 - s/z), and
            f^2/(N z) negative when focused at infinity. Through a hole of diameter d without a
            lens d (1 + f/z), never sharp.
        """
        length, pitch = self.camera[FOCAL_LENGTH], self.camera[PIXEL_PITCH]
        opening, distance = aperture_diameter(self.camera), self.camera[FOCUS_DISTANCE]
        if opening is None or length is None or pitch is None:
            return np.zeros_like(depth) if isinstance(depth, np.ndarray) else 0.0
        if self.camera[PINHOLE] is not None:
            return opening / pitch * (1.0 + length / depth)
        scale = length * opening / pitch
        if math.isinf(distance):
            return -scale / depth
        return scale / (distance - length) * (1.0 - distance / depth)


class Signal(msgspec.Struct, frozen=True):
    """The range in which every value of a picture lies, noise and rounding included.

    Parameters
    ----------
    low, high : float
        1 = white.
    """

    low: float
    high: float

    @property
    def span(self) -> float:
        """Largest minus smallest value, 1 = white."""
        return self.high - self.low

    @property
    def size(self) -> float:
        """Largest magnitude of any value, 1 = white."""
        return max(abs(self.low), abs(self.high))

    def with_margins(self, down: float, up: float) -> Signal:
        """Return the range, wider by so much below and above."""
        return Signal(self.low - down, self.high + up)

    def scale_range(self, least: float, most: float) -> Signal:
        """Return the range of values times factors between two that are >= 0."""
        return Signal(
            min(self.low * least, self.low * most), max(self.high * least, self.high * most)
        )

    def including(self, low: float, high: float) -> Signal:
        """Return the range, wide enough for two more values."""
        return Signal(min(self.low, low), max(self.high, high))

    def clip_range(self, low: float, high: float) -> Signal:
        """Return the range of values clipped to [low, high]."""
        return Signal(min(max(self.low, low), high), max(min(self.high, high), low))

    def outside(self, low: float, high: float) -> float:
        """Return how far any value can lie outside [low, high]."""
        return max(self.high - high, low - self.low, 0.0)
