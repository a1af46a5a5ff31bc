"""Read scenes from TOML: quantities carry units, unknown keys are errors with file and line."""

# ruff: noqa: TRY004 - a wrong value in a file is a ValueError, whatever its type

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from quizgen.camera import png
from quizgen.camera.draw import SHAPES, SIZES, TEXTURES
from quizgen.camera.effects import QUESTIONS
from quizgen.camera.power import decode
from quizgen.camera.scene import Camera, Image, Length, Scene, SceneError, Thing
from quizgen.errors import FormulaError
from quizgen.maths.units import Dimension, unit

Parser = Callable[[Any], Any]

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?:/\d+)?"
_QUANTITY = re.compile(rf"\s*(?P<number>{_NUMBER})\s*(?P<unit>.*?)\s*")
_MAX_PIXELS = 50_000_000


def _measure(text: Any) -> tuple[float, Dimension]:
    """Number in base units and its dimension; degrees become radians."""
    if not isinstance(text, str):
        raise ValueError("expected a quantity with its unit in quotes")
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise ValueError(f"cannot read {text!r}; expected a number and a unit")
    try:
        found = unit(match["unit"])
        value = float(Fraction(match["number"]) * found.factor)
    except (FormulaError, ZeroDivisionError) as error:
        raise ValueError(str(error)) from error
    turn = math.pi / 180.0 if ("deg", 1) in found.dimension else 1.0
    return value * turn, found.dimension


def quantity(name: str) -> Parser:
    """Reader of a number with a unit of the same dimension as ``name``."""
    expected = unit(name).dimension

    def read(text: Any) -> float:
        if text == "inf" and expected == unit("m").dimension:
            return math.inf
        value, dimension = _measure(text)
        if dimension != expected:
            raise ValueError(f"expected a unit like {name!r}")
        return value

    return read


def _length(per: str = "") -> Parser:
    def read(text: Any) -> Length:
        value, dimension = _measure(text)
        for metric in (True, False):
            if dimension == unit(("m" if metric else "px") + per).dimension:
                return Length(value, metric)
        raise ValueError(f"expected a length in px{per} or m{per}")

    return read


def number(value: Any) -> float:
    """A plain number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError("expected a number")
    return float(value)


def _f_number(value: Any) -> float:
    text = value.removeprefix("f/") if isinstance(value, str) else value
    return number(float(text) if isinstance(text, str) else text)


def whole(value: Any) -> int:
    """A whole number."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError("expected a whole number")
    return value


def truth(value: Any) -> bool:
    """True or false."""
    if not isinstance(value, bool):
        raise ValueError("expected true or false")
    return value


def words(value: Any) -> str:
    """Text."""
    if not isinstance(value, str):
        raise ValueError("expected text in quotes")
    return value


def one_of(*allowed: str) -> Parser:
    """Reader of one of the given words."""

    def read(value: Any) -> str:
        if value not in allowed:
            raise ValueError(f"expected one of {', '.join(allowed)}")
        return str(value)

    return read


def several(part: Parser, count: int | None = None) -> Parser:
    """Reader of a list."""

    def read(value: Any) -> tuple[Any, ...]:
        if not isinstance(value, list) or count not in (None, len(value)):
            raise ValueError(f"expected a list of {count or 'several'} values")
        return tuple(part(item) for item in value)

    return read


def colour(value: Any) -> tuple[float, float, float]:
    """``#rrggbb`` in sRGB, or three linear radiances."""
    if isinstance(value, str) and re.fullmatch(r"#[0-9a-fA-F]{6}", value):
        codes = [int(value[place : place + 2], 16) / 255.0 for place in (1, 3, 5)]
        red, green, blue = (float(decode(np.array(code))) for code in codes)
        return red, green, blue
    red, green, blue = several(number, 3)(value)
    if min(red, green, blue) < 0.0:
        raise ValueError("radiance cannot be negative")
    return red, green, blue


def _gamma(value: Any) -> str | float:
    return str(value) if value in ("srgb", "linear") else number(value)


def _depth(value: Any) -> float:
    depth = float(quantity("m")(value))
    if depth <= 0.0:
        raise ValueError("a depth must be positive")
    return depth


def _side(value: Any) -> int:
    side = whole(value)
    if not 2 <= side <= 2**15:
        raise ValueError("expected 2 to 32768")
    return side


SCENE: dict[str, Parser] = {
    "title": words, "width": _side, "height": _side, "background": colour,
    "background_depth": _depth, "image": words, "depth": _depth, "depth_map": words,
    "depth_near": _depth, "depth_far": _depth, "seed": whole,
    "question": several(one_of(*QUESTIONS)),
}  # fmt: skip

THING: dict[str, Parser] = {
    "shape": one_of(*SHAPES), "x": _length(), "y": _length(), "width": _length(),
    "height": _length(), "radius": _length(), "cell": _length(), "stroke": _length(),
    "depth": _depth, "colour": colour, "other": colour, "texture": one_of(*TEXTURES),
    "angle": quantity("deg"), "velocity": several(_length("/s"), 2), "spin": quantity("deg/s"),
    "count": whole, "points": several(several(number, 2)),
}  # fmt: skip

CAMERA: dict[str, Parser] = {
    "focal_length": quantity("m"), "pixel_pitch": quantity("m"), "sensor_width": quantity("m"),
    "f_number": _f_number, "focus_distance": quantity("m"), "k1": number, "k2": number,
    "lateral_colour": quantity("px"), "natural_vignetting": truth,
    "mechanical_vignetting": number, "shutter": quantity("s"),
    "velocity": several(quantity("px/s"), 2), "row_time": quantity("s"),
    "exposure": quantity("stop"), "full_well": quantity("e-"), "shot_noise": truth,
    "read_noise": quantity("e-"), "dark_current": quantity("e-/s"), "hot_pixels": quantity("%"),
    "blooming": truth, "smear": quantity("%"), "bit_depth": whole,
    "mosaic": one_of("RGGB", "BGGR", "GRBG", "GBRG"), "flat_field": truth,
    "white_balance": several(number, 3), "gamma": _gamma, "hue": quantity("deg"),
    "saturation": number, "value": number, "gaussian_noise": number,
    "impulse_noise": quantity("%"), "normalise": several(number, 4),
}  # fmt: skip

TABLES = {"scene": SCENE, "camera": CAMERA, "thing": THING}

_HEADER = re.compile(r"\s*\[\[?\s*([\w-]+)\s*\]\]?")
_KEY = re.compile(r"\s*([\w-]+)\s*=")


def _lines(text: str) -> dict[tuple[str, int, str], int]:
    """Line of every key: (table, which of its kind, key) to a line from 1."""
    found: dict[tuple[str, int, str], int] = {}
    table, counts = "", dict[str, int]()
    for line, content in enumerate(text.splitlines(), start=1):
        if header := _HEADER.match(content):
            table = header[1]
            counts[table] = counts.get(table, -1) + 1
            found.setdefault((table, counts[table], ""), line)
        elif key := _KEY.match(content):
            found.setdefault((table, counts.get(table, 0), key[1]), line)
    return found


class _File:
    """A scene file: its tables, and where each key stands."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            text = path.read_text("utf-8")
            self.tables = tomllib.loads(text)
        except OSError as error:
            raise SceneError(f"{path}: {error.strerror or error}") from error
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise SceneError(f"{path}: {error}") from error
        self.lines = _lines(text)

    def fail(self, table: str, which: int, key: str, message: str) -> SceneError:
        line = self.lines.get((table, which, key)) or self.lines.get((table, which, ""), 1)
        return SceneError(f"{self.path}:{line}: {message}")

    def read(self, table: str, which: int, values: Mapping[str, Any]) -> dict[str, Any]:
        known = TABLES[table]
        return {key: self._value(table, which, key, value, known) for key, value in values.items()}

    def _value(
        self, table: str, which: int, key: str, value: Any, known: Mapping[str, Parser]
    ) -> Any:
        if key not in known:
            hint = _nearest(key, known)
            raise self.fail(table, which, key, f"unknown key {key!r} in {table}{hint}")
        try:
            return known[key](value)
        except (ValueError, OverflowError) as error:
            raise self.fail(table, which, key, f"{key}: {error}") from error

    def check_tables(self) -> None:
        for name in self.tables:
            if name not in TABLES:
                line = self.lines.get((name, 0, "")) or self.lines.get(("", 0, name), 1)
                hint = _nearest(name, TABLES)
                raise SceneError(f"{self.path}:{line}: unknown table {name!r}{hint}")
        for name in ("scene", "camera"):
            if not isinstance(self.tables.get(name, {}), dict):
                raise self.fail(name, 0, "", f"expected one table [{name}]")
        things = self.tables.get("thing", [])
        if not isinstance(things, list) or not all(isinstance(item, dict) for item in things):
            raise self.fail("thing", 0, "", "expected tables [[thing]]")


def _nearest(key: str, known: Mapping[str, Any]) -> str:
    close = get_close_matches(key, known, 1)
    return f"; did you mean {close[0]!r}?" if close else ""


def load(path: str | Path) -> tuple[Scene, Camera]:
    """Read a scene and its camera.

    Parameters
    ----------
    path : str or Path
        TOML with ``[scene]``, ``[camera]`` and any number of ``[[thing]]``.

    Raises
    ------
    SceneError
        With file and line.
    """
    file = _File(Path(path))
    file.check_tables()
    camera = _camera(file)
    things = [
        _thing(file, which, table) for which, table in enumerate(file.tables.get("thing", []))
    ]
    return _scene(file, tuple(things)), camera


def _camera(file: _File) -> Camera:
    values = file.read("camera", 0, file.tables.get("camera", {}))
    if (width := values.pop("sensor_width", None)) is not None:
        if "pixel_pitch" in values:
            raise file.fail("camera", 0, "sensor_width", "give sensor_width or pixel_pitch")
        columns = file.tables.get("scene", {}).get("width", Scene.width)
        values["pixel_pitch"] = width / columns
    try:
        return Camera(**values)
    except SceneError as error:
        raise file.fail("camera", 0, "", str(error)) from error


def _thing(file: _File, which: int, table: Mapping[str, Any]) -> Thing:
    values = file.read("thing", which, table)
    thing = Thing(**values)
    for size in SIZES[thing.shape]:
        given = getattr(thing, size)
        if not given or (isinstance(given, Length) and given.value <= 0.0):
            raise file.fail("thing", which, "", f"a {thing.shape} needs {size}")
    if thing.cell.value <= 0.0 or thing.count < 1:
        raise file.fail("thing", which, "", "cell and count must be positive")
    return thing


def _scene(file: _File, things: tuple[Thing, ...]) -> Scene:
    values = file.read("scene", 0, file.tables.get("scene", {}))
    near, far = values.pop("depth_near", 1.0), values.pop("depth_far", math.inf)
    for key in ("image", "depth_map"):
        if key in values:
            values[key] = _picture(file, key, values[key])
    if "image" in values:
        values["image"] = decode(values["image"]).astype(np.float32)
        values["height"], values["width"] = values["image"].shape[:2]
    if (nearness := values.pop("depth_map", None)) is not None:
        shape = (values.get("height"), values.get("width"))
        if nearness.shape[:2] != shape:
            raise file.fail("scene", 0, "depth_map", "a depth map needs an image of its size")
        values["depth"] = _depths(nearness, near, far)
    return Scene(things=things, **values)


def _depths(nearness: Image, near: float, far: float) -> Image:
    """White is near, black is far, linear in 1/z."""
    inverse = nearness[..., 0] / near + (1.0 - nearness[..., 0]) / far
    return (1.0 / np.maximum(inverse, 1e-9)).astype(np.float32)


def _picture(file: _File, key: str, name: str) -> Any:
    """Values in [0, 1], shape (H, W, 3)."""
    path = file.path.parent / name
    try:
        pixels = png.decode(path.read_bytes())
    except OSError as error:
        raise file.fail("scene", 0, key, f"{name}: {error.strerror or error}") from error
    except ValueError as error:
        raise file.fail("scene", 0, key, f"{name}: {error}") from error
    if pixels.shape[0] * pixels.shape[1] > _MAX_PIXELS:
        raise file.fail("scene", 0, key, f"{name}: more than 50 megapixels")
    values = pixels / float(np.iinfo(pixels.dtype).max)
    return np.repeat(values[..., :1], 3, axis=2) if values.shape[2] < 3 else values[..., :3]
