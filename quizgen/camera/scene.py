"""What stands before the camera, and the camera: plain values in base units (m, s, e-, px, rad).

Every default is the identity: a parameter that is not given costs nothing and changes nothing.
Positions count from the centre of the picture, x to the right and y down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quizgen.errors import QuizgenError

Image = NDArray[np.float32]
Colour = tuple[float, float, float]


class SceneError(QuizgenError):
    """A scene or a camera is wrong; the message names the file, the line or the field."""


class Length(NamedTuple):
    """A length on the sensor (px) or in the world (m)."""

    value: float
    metric: bool = False


NONE, CELL, STROKE = Length(0.0), Length(16.0), Length(2.0)


@dataclass(frozen=True, slots=True)
class Thing:
    """One drawn object.

    Parameters
    ----------
    shape : str
        A key of `quizgen.camera.draw.SHAPES`.
    x, y, width, height, radius, cell, stroke : Length
        Place and size in px, or in m at the object's depth.
    depth : float
        Distance along the axis in m, > 0, may be infinite.
    colour, other : (float, float, float)
        Linear radiance, 1 = white; lamps may exceed 1. ``other`` is the texture's second colour.
    texture : str
        A key of `quizgen.camera.draw.TEXTURES`.
    angle : float
        Rotation in rad, clockwise as seen.
    velocity : (Length, Length)
        Movement per second along x and y.
    spin : float
        Rotation in rad/s about (x, y).
    count : int
        Number of blades.
    points : tuple of (float, float)
        Corners of a polygon in px from (x, y).
    """

    shape: str = "box"
    x: Length = NONE
    y: Length = NONE
    width: Length = NONE
    height: Length = NONE
    radius: Length = NONE
    cell: Length = CELL
    stroke: Length = STROKE
    depth: float = math.inf
    colour: Colour = (1.0, 1.0, 1.0)
    other: Colour = (0.0, 0.0, 0.0)
    texture: str = "plain"
    angle: float = 0.0
    velocity: tuple[Length, Length] = (NONE, NONE)
    spin: float = 0.0
    count: int = 3
    points: tuple[tuple[float, float], ...] = ()

    @property
    def metric(self) -> bool:
        """Whether any length is in metres, so that the object must be projected."""
        return any(value.metric for value in self.lengths().values()) or any(
            part.metric for part in self.velocity
        )

    def lengths(self) -> dict[str, Length]:
        """Every length field by name."""
        named = {item.name: getattr(self, item.name) for item in fields(self)}
        return {name: value for name, value in named.items() if isinstance(value, Length)}


@dataclass(frozen=True, eq=False)
class Scene:
    """Drawn things, or a picture with a depth (one number or a map).

    Parameters
    ----------
    width, height : int
        Size in px.
    things : tuple of Thing
        In any order; farther things are drawn first.
    background : (float, float, float)
        Linear radiance behind everything.
    background_depth : float
        Its distance in m.
    image : numpy.ndarray or None
        Shape (height, width, 3), float32, linear radiance; replaces the background.
    depth : float or numpy.ndarray
        Distance of the picture in m, shape (height, width) if a map.
    question : tuple of str
        Kinds of question asked about the scene.
    seed : int
        Seed of every random effect.
    title : str
        Shown by the command line.
    """

    width: int = 640
    height: int = 480
    things: tuple[Thing, ...] = ()
    background: Colour = (0.0, 0.0, 0.0)
    background_depth: float = math.inf
    image: Image | None = None
    depth: float | Image = math.inf
    question: tuple[str, ...] = ()
    seed: int = 0
    title: str = ""

    @property
    def metric(self) -> bool:
        """Whether anything is given in metres."""
        return any(thing.metric for thing in self.things)

    @cached_property
    def range(self) -> tuple[float, float]:
        """Smallest and largest radiance that can occur, from the colours or the picture."""
        seen = [thing.other for thing in self.things if thing.texture != "plain"]
        seen.extend(thing.colour for thing in self.things)
        colours = [level for colour in seen for level in colour]
        return min((*colours, *self._behind)), max((*colours, *self._behind))

    @cached_property
    def _behind(self) -> tuple[float, ...]:
        if self.image is None:
            return self.background
        return float(self.image.min()), float(self.image.max())


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera; every default is absent, not multiplied by one.

    Parameters
    ----------
    focal_length, pixel_pitch : float or None
        m.
    f_number : float or None
        None is a pinhole.
    focus_distance : float
        Distance in perfect focus, m, may be infinite.
    k1, k2 : float
        Radial distortion, undistorted to distorted, radius in focal lengths: k1 < 0 is barrel.
    lateral_colour : float
        Shift of red outward and blue inward at the picture's corner, px.
    natural_vignetting : bool
        cos^4 fall-off.
    mechanical_vignetting : float
        Shift of the lens rim at the corner in aperture diameters, 0 to below 1.
    shutter : float
        Exposure time, s.
    velocity : (float, float)
        Movement of the picture over the sensor, px/s.
    row_time : float
        Delay from row to row of a rolling shutter, s.
    exposure : float
        Stops; +1 doubles.
    full_well : float or None
        Electrons at signal 1; None counts no electrons.
    shot_noise : bool
        Whether electrons arrive at random (needs a full well).
    read_noise, dark_current : float
        e- and e-/s.
    hot_pixels : float
        Share of photosites stuck at full well.
    blooming : bool
        Whether charge above the full well spills along the column.
    smear : float
        Share of a column's mean that a CCD adds to the column while shifting it.
    bit_depth : int or None
        Bits of the converter; None is analog.
    mosaic : str
        Colours of the 2x2 tile, rows first: RGGB, BGGR, GRBG, GBRG, or empty.
    flat_field : bool
        Whether vignetting is divided out of the linear raw data.
    white_balance : (float, float, float)
        Gains.
    gamma : str or float
        ``linear``, ``srgb`` or an exponent.
    hue, saturation, value : float
        HSV edit: rad added, factors.
    gaussian_noise : float
        Standard deviation added to the finished picture, 1 = white.
    impulse_noise : float
        Share of pixels turned black or white (half each).
    normalise : (float, float, float, float) or None
        min, max, new min, new max; 1 = white.
    """

    focal_length: float | None = None
    pixel_pitch: float | None = None
    f_number: float | None = None
    focus_distance: float = math.inf
    k1: float = 0.0
    k2: float = 0.0
    lateral_colour: float = 0.0
    natural_vignetting: bool = False
    mechanical_vignetting: float = 0.0
    shutter: float = 0.0
    velocity: tuple[float, float] = (0.0, 0.0)
    row_time: float = 0.0
    exposure: float = 0.0
    full_well: float | None = None
    shot_noise: bool = True
    read_noise: float = 0.0
    dark_current: float = 0.0
    hot_pixels: float = 0.0
    blooming: bool = False
    smear: float = 0.0
    bit_depth: int | None = None
    mosaic: str = ""
    flat_field: bool = False
    white_balance: Colour = (1.0, 1.0, 1.0)
    gamma: str | float = "linear"
    hue: float = 0.0
    saturation: float = 1.0
    value: float = 1.0
    gaussian_noise: float = 0.0
    impulse_noise: float = 0.0
    normalise: tuple[float, float, float, float] | None = None

    def __post_init__(self) -> None:
        for test, what in self._rules():
            if not test:
                raise SceneError(what)

    def _rules(self) -> list[tuple[bool, str]]:
        needs_lens = self.f_number is not None or self.k1 or self.k2 or self.natural_vignetting
        electrons = self.read_noise or self.dark_current or self.hot_pixels or self.blooming
        positive = (self.focal_length, self.pixel_pitch, self.f_number, self.full_well)
        return [
            (all(x is None or 0 < x < math.inf for x in positive), _POSITIVE),
            (not needs_lens or self.has_lens, "the lens needs focal_length and pixel_pitch"),
            (not (electrons or self.smear) or self.full_well is not None, _ELECTRONS),
            (self.focus_distance > (self.focal_length or 0.0), _FOCUS),
            (self.bit_depth is None or 1 <= self.bit_depth <= 16, "bit_depth must be 1 to 16"),
            (0 <= self.mechanical_vignetting < 1, "mechanical_vignetting must be in [0, 1)"),
            (0 <= self.hot_pixels <= 1 and 0 <= self.impulse_noise <= 1, "shares lie in [0, 1]"),
            (self.mosaic in ("", "RGGB", "BGGR", "GRBG", "GBRG"), "unknown mosaic"),
            (self.normalise is None or self.normalise[0] < self.normalise[1], _NORMALISE),
            (self.gamma in ("linear", "srgb") or _at_least_one(self.gamma), _GAMMA),
            (min(self._not_negative()) >= 0.0, "noise, times, factors and gains must be >= 0"),
        ]

    def _not_negative(self) -> tuple[float, ...]:
        noise = (self.read_noise, self.dark_current, self.gaussian_noise, self.smear)
        times = (self.shutter, self.row_time)
        return (*noise, *times, self.saturation, self.value, *self.white_balance)

    @property
    def has_lens(self) -> bool:
        """Whether angles can be turned into pixels."""
        return self.focal_length is not None and self.pixel_pitch is not None


_POSITIVE = "focal_length, pixel_pitch, f_number and full_well must be positive and finite"
_ELECTRONS = "read noise, dark current, hot pixels, blooming and smear need full_well"
_FOCUS = "focus_distance must exceed focal_length"
_NORMALISE = "normalise needs min < max"
_GAMMA = "gamma must be 'linear', 'srgb' or a number >= 1"


def _at_least_one(gamma: str | float) -> bool:
    return not isinstance(gamma, str) and 1.0 <= gamma < math.inf


@dataclass(frozen=True, slots=True)
class View:
    """A camera looking at a scene: what effects and bounds need to know, in px.

    Parameters
    ----------
    scene : Scene
    camera : Camera
    """

    scene: Scene
    camera: Camera

    @property
    def width(self) -> int:
        """Columns."""
        return self.scene.width

    @property
    def height(self) -> int:
        """Rows."""
        return self.scene.height

    @property
    def megapixels(self) -> float:
        """Pixels in millions."""
        return self.width * self.height / 1e6

    @property
    def focal(self) -> float:
        """Focal length in px."""
        if self.camera.focal_length is None or self.camera.pixel_pitch is None:
            raise SceneError("lengths in metres need focal_length and pixel_pitch")
        return self.camera.focal_length / self.camera.pixel_pitch

    @property
    def centre(self) -> tuple[float, float]:
        """Principal point (x, y), counted from the centre of the first pixel (errata E27)."""
        return (self.width - 1) / 2.0, (self.height - 1) / 2.0

    @property
    def corner(self) -> float:
        """Distance from the principal point to the farthest pixel centre, px."""
        return math.hypot(*self.centre)

    def blur_diameter(self, depth: Any) -> Any:
        """Signed circle of confusion, px: positive behind the plane of focus.

        Parameters
        ----------
        depth : float or numpy.ndarray
            Distance in m, > 0, may be infinite. With f, N, s: c = f^2/(N (s-f)) (1 - s/z), and
            f^2/(N z) negative when focused at infinity.
        """
        camera = self.camera
        if camera.f_number is None or camera.focal_length is None or camera.pixel_pitch is None:
            return np.zeros_like(depth) if isinstance(depth, np.ndarray) else 0.0
        scale = camera.focal_length**2 / (camera.f_number * camera.pixel_pitch)
        if math.isinf(camera.focus_distance):
            return -scale / depth
        behind = camera.focus_distance - camera.focal_length
        return scale / behind * (1.0 - camera.focus_distance / depth)


def with_image(scene: Scene, image: Image) -> Scene:
    """The same scene with another picture."""
    return replace(scene, image=image, width=image.shape[1], height=image.shape[0])
