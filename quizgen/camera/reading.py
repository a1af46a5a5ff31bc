"""Read scenes from TOML: quantities carry units, unknown keys are errors with file and line."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from quizgen.camera import codecs, effects
from quizgen.camera.camera import Camera
from quizgen.camera.codes import MEASURES
from quizgen.camera.raster.outlines import SHAPES, SIZES, TEXTURES
from quizgen.camera.scene import (
    PRECISIONS,
    Image,
    Length,
    Precision,
    Question,
    Reading,
    Scene,
    SceneError,
    SettingError,
    Thing,
)
from quizgen.camera.setup.settings import nearest
from quizgen.camera.setup.values import (
    Reader,
    colour,
    length,
    number,
    one_of,
    pair,
    quantity,
    several,
    truth,
    whole,
    words,
)
from quizgen.camera.view import View
from quizgen.core.untrusted import LARGEST_PICTURE, parse_toml, read_bytes, read_text
from quizgen.numerics.gamma import srgb_decode

MOST_THINGS = 1000
"""Things of a scene, corners of a polygon and blades of a propeller."""

Readers = Mapping[str, Reader[Any]]
"""Readers of the keys of one table; each gives the type of its own field."""


def _depth(value: object) -> float:
    depth = quantity("m")(value)
    if depth <= 0.0:
        raise ValueError("a depth must be positive")
    return depth


def _between(least: int, most: int) -> Reader[int]:
    """Reader of a whole number in a range."""

    def read(value: object) -> int:
        if not least <= whole(value) <= most:
            raise ValueError(f"expected {least} to {most}")
        return whole(value)

    return read


def _corners(value: object) -> tuple[tuple[float, float], ...]:
    corners = several(pair(number))(value)
    if len(corners) > MOST_THINGS:
        raise ValueError(f"expected at most {MOST_THINGS} corners")
    return corners


def _asks(value: object) -> tuple[str, ...]:
    kinds = several(one_of(*effects.questions()))([value] if isinstance(value, str) else value)
    if not kinds:
        raise ValueError("expected a kind of question")
    return kinds


def _reads(value: object) -> dict[str, Reading]:
    table = value if isinstance(value, dict) else {}
    if not table:
        raise ValueError("expected a table such as { corner = 3 }")
    return {name: _read_one(name, told) for name, told in table.items()}


def _read_one(name: str, told: object) -> Reading:
    """A tolerance, or a table with the key besides."""
    measure = one_of(*MEASURES)(name)
    table = told if isinstance(told, dict) else {"tolerance": told}
    if "tolerance" not in table or table.keys() - {"tolerance", "value"}:
        raise ValueError(f"{name}: expected a tolerance, and maybe a value")
    values = {key: number(part) for key, part in table.items()}
    if values["tolerance"] <= 0.0:
        raise ValueError(f"{name}: a tolerance must be positive")
    return Reading(measure, **values)


SIDES = 2, 2**15
"""Pixels of the shortest and the longest side: a mosaic has tiles of two."""

_SIDE = _between(*SIDES)

SCENE: Readers = {
    "title": words, "width": _SIDE, "height": _SIDE, "background": colour,
    "background_depth": _depth, "image": words, "depth": _depth, "depth_map": words,
    "depth_near": _depth, "depth_far": _depth, "seed": _between(0, 2**63),
    "precision": one_of(*PRECISIONS),
}  # fmt: skip

THING: Readers = {
    "shape": one_of(*SHAPES), "x": length(), "y": length(), "width": length(),
    "height": length(), "radius": length(), "cell": length(), "stroke": length(),
    "depth": _depth, "colour": colour, "other": colour, "texture": one_of(*TEXTURES),
    "angle": quantity("deg"), "velocity": pair(length("/s")), "spin": quantity("deg/s"),
    "count": _between(1, MOST_THINGS), "points": _corners,
}  # fmt: skip

QUESTION: Readers = {"asks": _asks, "reads": _reads}

TABLES = ("scene", "question", "camera", "thing")


def _readers(table: str) -> Readers:
    """Readers of one table; those of the camera come from the effects."""
    if table != "camera":
        return {"scene": SCENE, "question": QUESTION, "thing": THING}[table]
    named = {name: setting.read for name, setting in effects.settings().items()}
    return {"sensor_width": quantity("m"), "exif": truth, **named}


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
        text = read_text(path, SceneError)
        self.tables: dict[str, Any] = parse_toml(text, path, SceneError)
        self.lines = _lines(text)

    def fail(self, table: str, which: int, key: str, message: str) -> SceneError:
        line = self.lines.get((table, which, key)) or self.lines.get((table, which, ""), 1)
        return SceneError(f"{self.path}:{line}: {message}")

    def read(self, table: str, which: int, values: Mapping[str, object]) -> dict[str, Any]:
        known = _readers(table)
        return {key: self._value(table, which, key, value, known) for key, value in values.items()}

    def _value(self, table: str, which: int, key: str, value: object, known: Readers) -> object:
        if key not in known:
            hint = nearest(key, known)
            raise self.fail(table, which, key, f"unknown key {key!r} in {table}{hint}")
        try:
            return known[key](value)
        except (ValueError, OverflowError) as error:
            raise self.fail(table, which, key, f"{key}: {error}") from error

    def check_tables(self) -> None:
        for name in self.tables:
            if name not in TABLES:
                line = self.lines.get((name, 0, "")) or self.lines.get(("", 0, name), 1)
                hint = nearest(name, TABLES)
                raise SceneError(f"{self.path}:{line}: unknown table {name!r}{hint}")
        for name in ("scene", "question", "camera"):
            if not isinstance(self.tables.get(name, {}), dict):
                raise self.fail(name, 0, "", f"expected one table [{name}]")
        things = self.tables.get("thing", [])
        if not isinstance(things, list) or not all(isinstance(item, dict) for item in things):
            raise self.fail("thing", 0, "", "expected tables [[thing]]")
        if len(things) > MOST_THINGS:
            raise self.fail("thing", 0, "", f"more than {MOST_THINGS} things")


def load(path: str | Path, precision: Precision | None = None) -> tuple[Scene, Camera]:
    """Read a scene and its camera.

    Parameters
    ----------
    path : str or Path
        TOML with ``[scene]``, ``[question]``, ``[camera]`` and any number of ``[[thing]]``.
    precision : str, optional
        What the picture is computed in, whatever the file says.

    Raises
    ------
    SceneError
        With file and line.
    """
    file = _File(Path(path))
    file.check_tables()
    things = [
        _thing(file, which, table) for which, table in enumerate(file.tables.get("thing", []))
    ]
    scene = replace(_scene(file, tuple(things), precision), question=_question(file))
    values = file.read("camera", 0, file.tables.get("camera", {}))
    if values.pop("exif", False):
        scene = replace(scene, exif=_shot_with(file, values))
    camera = _camera(file, {**scene.exif, **values}, scene.width)
    _check_effects(file, View(scene, camera))
    return scene, camera


def _question(file: _File) -> Question | None:
    if "question" not in file.tables:
        return None
    values = file.read("question", 0, file.tables["question"])
    if "asks" not in values:
        raise file.fail("question", 0, "", "a question needs asks")
    return Question(**values)


def _shot_with(file: _File, given: Mapping[str, object]) -> dict[str, float]:
    """What a photograph's file says of its camera and the scene does not.

    An f-number needs to know the size of a pixel, and the ISO value of a metered picture has been
    made up for by its aperture and time.
    """
    name = file.tables.get("scene", {}).get("image")
    if name is None:
        raise file.fail("camera", 0, "exif", "exif needs an image")
    said = codecs.shot_with(read_bytes(file.path.parent / name, SceneError, LARGEST_PICTURE))
    sized = "pixel_pitch" in given or "sensor_width" in given
    needs = {"f_number": sized and "pinhole" not in given, "iso": "light_value" in given}
    taken = {key: x for key, x in said.items() if needs.get(key, True) and key not in given}
    if not said:
        raise file.fail("camera", 0, "exif", f"{name} does not say how it was taken")
    return taken


def _camera(file: _File, values: dict[str, Any], columns: int) -> Camera:
    if (width := values.pop("sensor_width", None)) is not None:
        if "pixel_pitch" in values:
            raise file.fail("camera", 0, "sensor_width", "give sensor_width or pixel_pitch")
        values["pixel_pitch"] = width / columns
    try:
        return Camera(**values)
    except SettingError as error:
        raise file.fail("camera", 0, error.setting, str(error)) from error


def _check_effects(file: _File, view: View) -> None:
    """Name the line of what cannot be computed."""
    for effect in effects.present(view):
        try:
            effect.check(view)
        except SceneError as error:
            given = (item.name for item in effect.settings if item.name in view.camera.given)
            raise file.fail("camera", 0, next(given, ""), str(error)) from error


def _thing(file: _File, which: int, table: Mapping[str, object]) -> Thing:
    values = file.read("thing", which, table)
    thing = Thing(**values)
    for size in SIZES[thing.shape]:
        given = getattr(thing, size)
        if not given or (isinstance(given, Length) and given.value <= 0.0):
            raise file.fail("thing", which, "", f"a {thing.shape} needs {size}")
    if thing.cell.value <= 0.0:
        raise file.fail("thing", which, "", "cell must be positive")
    return thing


def _scene(file: _File, things: tuple[Thing, ...], precision: Precision | None) -> Scene:
    values = file.read("scene", 0, file.tables.get("scene", {}))
    kind = values["precision"] = precision or values.get("precision", Scene.precision)
    pixels = values.get("width", Scene.width) * values.get("height", Scene.height)
    if pixels > codecs.MOST_MEGAPIXELS * 1_000_000:
        raise file.fail("scene", 0, "width", f"more than {codecs.MOST_MEGAPIXELS} megapixels")
    near, far = values.pop("depth_near", 1.0), values.pop("depth_far", math.inf)
    for key in ("image", "depth_map"):
        if key in values:
            values[key] = _picture(file, key, values[key])
    if "image" in values:
        values["image"] = _linear(values["image"], kind)
        values["height"], values["width"] = values["image"].shape[:2]
    if (nearness := values.pop("depth_map", None)) is not None:
        shape = (values.get("height"), values.get("width"))
        if nearness.shape[:2] != shape:
            raise file.fail("scene", 0, "depth_map", "a depth map needs an image of its size")
        values["depth"] = _depths(nearness, near, far, kind)
    return Scene(things=things, file=file.path, **values)


_ROWS = 64


def _depths(nearness: codecs.Codes, near: float, far: float, precision: Precision) -> Image:
    """White is near, black is far, linear in 1/z; looked up for every code."""
    top = int(np.iinfo(nearness.dtype).max)
    share = np.arange(top + 1) / top
    inverse = share / near + (1.0 - share) / far
    table = np.asarray(1.0 / np.maximum(inverse, 1e-9), precision)
    return _looked_up(table, nearness[..., 0])


def _linear(codes: codecs.Codes, precision: Precision) -> Image:
    """Radiance of every code, looked up."""
    top = int(np.iinfo(codes.dtype).max)
    table = np.asarray(srgb_decode(np.arange(top + 1) / top), precision)
    return _looked_up(table, codes)


def _looked_up(table: Image, codes: codecs.Codes) -> Image:
    """A value for every code; some rows at once, as codes become larger numbers for it."""
    found = np.empty(codes.shape, table.dtype)
    for start in range(0, len(codes), _ROWS):
        found[start : start + _ROWS] = table[codes[start : start + _ROWS]]
    return found


def _picture(file: _File, key: str, name: str) -> codecs.Codes:
    """Codes, shape (H, W, 3)."""
    path = file.path.parent / name
    try:
        pixels = codecs.decode(read_bytes(path, SceneError, LARGEST_PICTURE))
        if min(pixels.shape[:2]) < SIDES[0]:
            raise ValueError(f"a picture has at least {SIDES[0]} rows and columns")
    except SceneError as error:
        raise file.fail("scene", 0, key, str(error)) from error
    except ValueError as error:
        raise file.fail("scene", 0, key, f"{name}: {error}") from error
    if pixels.shape[2] >= 3:
        return pixels[..., :3]
    return pixels[..., :1].repeat(3, axis=2)
