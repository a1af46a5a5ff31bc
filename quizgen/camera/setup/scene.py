"""What stands before the camera: plain values in base units (m, s, px, rad).

Positions count from the centre of the picture, x to the right and y down.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cache, cached_property
from pathlib import Path
from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from quizgen.core.errors import QuizgenError

Image = NDArray[np.floating]
Colour = tuple[float, float, float]
Precision = Literal["float32", "float64"]
"""What a picture is computed in, from drawing to the last effect."""
PRECISIONS: tuple[Precision, ...] = get_args(Precision)


class SceneError(QuizgenError):
    """Raised if a scene or a camera is wrong; the message names the file, the line or the field."""


class SettingError(SceneError):
    """Raised if a setting of the camera is wrong.

    Parameters
    ----------
    setting : str
        Its key, so that the reader of a file can name the line.
    message : str
    """

    def __init__(self, setting: str, message: str) -> None:
        super().__init__(message)
        self.setting = setting


class Length(NamedTuple):
    """A length on the sensor (px) or, if ``metric``, in the world (m)."""

    value: float
    metric: bool = False


NONE, CELL, STROKE = Length(0.0), Length(16.0), Length(2.0)


@dataclass(frozen=True, slots=True)
class SceneObject:
    """One thing to be drawn: shape, size, place, colours and motion.

    Parameters
    ----------
    shape : str
        A key of `quizgen.camera.raster.shapes.SHAPES`.
    x, y, width, height, radius, cell, stroke : Length
        Place and size in px, or in m at the object's depth.
    depth : float
        Distance along the axis in m, > 0, may be infinite.
    colour, other : (float, float, float)
        Linear radiance, 1 = white; lamps may exceed 1. ``other`` is the texture's second colour.
    texture : str
        A key of `quizgen.camera.raster.shapes.TEXTURES`.
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
    def is_metric(self) -> bool:
        """Whether any length is in metres, so that the object must be projected."""
        return any(one.metric for one in (*self.lengths().values(), *self.velocity))

    def lengths(self) -> dict[str, Length]:
        """Return every length of the object by the name of its field."""
        return {name: getattr(self, name) for name in length_fields()}


@cache
def length_fields() -> tuple[str, ...]:
    """Return the names of the fields of an object that are lengths."""
    return tuple(item.name for item in fields(SceneObject) if isinstance(item.default, Length))


PictureMeasure = Callable[[NDArray[np.floating]], float]
"""Reads a number off the grey levels of a picture, shape (H, W, 3)."""


@dataclass(frozen=True)
class Reading:
    """A value that is read off a picture, and how it is marked.

    Parameters
    ----------
    measure : str or callable
        A name in `quizgen.camera.pixels.codes.MEASURES`, or a function of the grey levels.
    tolerance : float
        How far what is read may be from the key.
    value : float or None
        The key, by formula; None if it is what the picture shows.
    """

    measure: str | PictureMeasure
    tolerance: float
    value: float | None = None


@dataclass(frozen=True)
class PictureQuestion:
    """What is asked about a picture.

    Parameters
    ----------
    asks : tuple of str
        Kinds of question.
    reads : mapping of str to Reading
        What is read off it.
    """

    asks: tuple[str, ...]
    reads: Mapping[str, Reading] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Scene:
    """What the camera looks at: drawn things, or a picture with a depth (one number or a map).

    Parameters
    ----------
    width, height : int
        Size in px.
    things : tuple of SceneObject
        In any order; farther things are drawn first.
    background : (float, float, float)
        Linear radiance where no thing is.
    background_depth : float
        Its distance in m.
    image : numpy.ndarray or None
        Shape (height, width, 3), linear radiance; replaces the background.
    depth : float or numpy.ndarray
        Distance of the picture in m, shape (height, width) if a map.
    question : PictureQuestion or None
        What is asked about the picture.
    seed : int
        Seed of every random effect.
    title : str
        Shown by the command line.
    exif : mapping of str to float
        Settings of the camera that were read from the picture's file, in base units.
    precision : str
        What the picture is computed in: random effects draw the same numbers in either.
    file : pathlib.Path or None
        What it was read from: errors that show only when it is photographed name it.
    """

    width: int = 640
    height: int = 480
    things: tuple[SceneObject, ...] = ()
    background: Colour = (0.0, 0.0, 0.0)
    background_depth: float = math.inf
    image: Image | None = None
    depth: float | Image = math.inf
    question: PictureQuestion | None = None
    seed: int = 0
    title: str = ""
    exif: Mapping[str, float] = field(default_factory=dict)
    precision: Precision = "float32"
    file: Path | None = None

    @cached_property
    def is_metric(self) -> bool:
        """Whether anything is given in metres."""
        return any(thing.is_metric for thing in self.things)

    @cached_property
    def radiance_range(self) -> tuple[float, float]:
        """The smallest and the largest radiance that can occur, from the colours or the picture."""
        seen = [thing.other for thing in self.things if thing.texture != "plain"]
        seen.extend(thing.colour for thing in self.things)
        colours = [level for colour in seen for level in colour]
        return min((*colours, *self._background_radiance)), max(
            (*colours, *self._background_radiance)
        )

    @cached_property
    def _background_radiance(self) -> tuple[float, ...]:
        """The radiances of the background colour, or smallest and largest of the picture."""
        if self.image is None:
            return self.background
        return float(self.image.min()), float(self.image.max())
