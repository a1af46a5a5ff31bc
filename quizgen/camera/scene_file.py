"""Read scenes from TOML: quantities carry units, unknown keys are errors with file and line."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from quizgen.camera import effects
from quizgen.camera.camera import Camera
from quizgen.camera.pixels import codecs
from quizgen.camera.pixels.codes import MEASURES
from quizgen.camera.raster.shapes import SHAPES, SIZES, TEXTURES
from quizgen.camera.setup.scene import (
    PRECISIONS,
    Image,
    Length,
    PictureQuestion,
    Precision,
    Reading,
    Scene,
    SceneError,
    SceneObject,
    SettingError,
    length_fields,
)
from quizgen.camera.setup.settings import suggest_setting
from quizgen.camera.setup.value_parsers import (
    ValueParser,
    choice_parser,
    length_parser,
    list_parser,
    pair_parser,
    parse_bool,
    parse_colour,
    parse_integer,
    parse_plain_number,
    parse_text,
    quantity_parser,
)
from quizgen.camera.setup.view import View
from quizgen.core.positions import Place, find_span
from quizgen.core.untrusted import LARGEST_PICTURE, parse_toml, read_bytes, read_text
from quizgen.numerics.gamma import srgb_decode

MOST_THINGS = 1000
"""Things of a scene, corners of a polygon and blades of a propeller."""

TableParsers = Mapping[str, ValueParser[Any]]
"""Readers of the keys of one table; each gives the type of its own field."""


def _parse_depth(value: object) -> float:
    """Return a depth > 0 in m; raise ``ValueError`` for anything else."""
    depth = quantity_parser("m")(value)
    if depth <= 0.0:
        raise ValueError("a depth must be positive")
    return depth


def _integer_parser(least: int, most: int) -> ValueParser[int]:
    """Return a parser of whole numbers from least to most."""

    def read(value: object) -> int:
        """Return the number, or raise ``ValueError``."""
        if not least <= parse_integer(value) <= most:
            raise ValueError(f"expected {least} to {most}")
        return parse_integer(value)

    return read


def _parse_corners(value: object) -> tuple[tuple[float, float], ...]:
    """Return the corners of a polygon in px."""
    corners = list_parser(pair_parser(parse_plain_number))(value)
    if len(corners) > MOST_THINGS:
        raise ValueError(f"expected at most {MOST_THINGS} corners")
    return corners


def _parse_asks(value: object) -> tuple[str, ...]:
    """Return the kinds of question of ``asks``: one text or a list of them."""
    kinds = list_parser(choice_parser(*effects.question_kinds()))(
        [value] if isinstance(value, str) else value
    )
    if not kinds:
        raise ValueError("expected a kind of question")
    return kinds


def _parse_reads(value: object) -> dict[str, Reading]:
    """Return the readings of ``reads``, by the measure that each names.

    A value there is a tolerance, or a table with the key as well.
    """
    table = value if isinstance(value, dict) else {}
    if not table:
        raise ValueError("expected a table such as { corner = 3 }")
    found = {}
    for name, given in table.items():  # a tolerance, or a table with the key as well
        measure = choice_parser(*MEASURES)(name)
        fields = given if isinstance(given, dict) else {"tolerance": given}
        if "tolerance" not in fields or fields.keys() - {"tolerance", "value"}:
            raise ValueError(f"{name}: expected a tolerance, and maybe a value")
        values = {key: parse_plain_number(part) for key, part in fields.items()}
        if values["tolerance"] <= 0.0:
            raise ValueError(f"{name}: a tolerance must be positive")
        found[name] = Reading(measure, **values)
    return found


SIDES = 2, 2**15
"""Pixels of the shortest and the longest side: a mosaic has tiles of two."""

_KEYS: Mapping[str, TableParsers] = {"scene": {
    **dict.fromkeys(("title", "image", "depth_map"), parse_text),
    **dict.fromkeys(("width", "height"), _integer_parser(*SIDES)),
    **dict.fromkeys(("background_depth", "depth", "depth_near", "depth_far"), _parse_depth),
    "background": parse_colour, "seed": _integer_parser(0, 2**63),
    "precision": choice_parser(*PRECISIONS),
}, "question": {"asks": _parse_asks, "reads": _parse_reads}, "thing": {
    **dict.fromkeys(length_fields(), length_parser()),
    "shape": choice_parser(*SHAPES), "depth": _parse_depth,
    "colour": parse_colour, "other": parse_colour,
    "texture": choice_parser(*TEXTURES), "angle": quantity_parser("deg"),
    "velocity": pair_parser(length_parser("/s")), "spin": quantity_parser("deg/s"),
    "count": _integer_parser(1, MOST_THINGS), "points": _parse_corners,
}}  # fmt: skip
TABLES = (*_KEYS, "camera")


def _table_parsers(table: str) -> TableParsers:
    """Return the parser of every key of one table; those of the camera come from the effects."""
    if table != "camera":
        return _KEYS[table]
    named = {name: setting.read for name, setting in effects.all_settings().items()}
    return {"sensor_width": quantity_parser("m"), "exif": parse_bool, **named}


class _SceneFile:
    """A scene file and its tables."""

    def __init__(self, path: Path) -> None:
        self.path = path
        text = read_text(path, SceneError)
        self.tables: dict[str, Any] = parse_toml(text, path, SceneError)

    def fail(self, table: str, which: int, key: str, message: str) -> SceneError:
        """Return an error that names the file and the line of a key."""
        place: Place = (table, which) if table == "thing" else (table,)
        span = find_span(self.path, (*place, key) if key else place)
        return SceneError(f"{self.path}:{span.line if span else 1}: {message}")

    def read(self, table: str, which: int, values: Mapping[str, object]) -> dict[str, Any]:
        """Return the parsed values of one table; raise `SceneError` at the first wrong one."""
        known, found = _table_parsers(table), {}
        for key, value in values.items():
            if key not in known:
                hint = suggest_setting(key, known)
                raise self.fail(table, which, key, f"unknown key {key!r} in {table}{hint}")
            try:
                found[key] = known[key](value)
            except (ValueError, OverflowError) as error:
                raise self.fail(table, which, key, f"{key}: {error}") from error
        return found

    def check_tables(self) -> None:
        """Raise `SceneError` for unknown tables, those of the wrong kind, and too many things."""
        for name in self.tables:
            if name not in TABLES:
                hint = suggest_setting(name, TABLES)
                raise self.fail(name, 0, "", f"unknown table {name!r}{hint}")
        for name in ("scene", "question", "camera"):
            if not isinstance(self.tables.get(name, {}), dict):
                raise self.fail(name, 0, "", f"expected one table [{name}]")
        things = self.tables.get("thing", [])
        if not isinstance(things, list) or not all(isinstance(item, dict) for item in things):
            raise self.fail("thing", 0, "", "expected tables [[thing]]")
        if len(things) > MOST_THINGS:
            raise self.fail("thing", 0, "", f"more than {MOST_THINGS} things")


def load_scene(path: str | Path, precision: Precision | None = None) -> tuple[Scene, Camera]:
    """Return the scene and the camera of a TOML file.

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
    file = _SceneFile(Path(path))
    file.check_tables()
    things = [
        _read_thing(file, which, table) for which, table in enumerate(file.tables.get("thing", []))
    ]
    scene = replace(_read_scene(file, tuple(things), precision), question=_read_question(file))
    values = file.read("camera", 0, file.tables.get("camera", {}))
    if values.pop("exif", False):
        scene = replace(scene, exif=_read_exif(file, values))
    camera = _read_camera(file, {**scene.exif, **values}, scene.width)
    _check_effects(file, View(scene, camera))
    return scene, camera


def _read_question(file: _SceneFile) -> PictureQuestion | None:
    """Return what the file asks about the picture, or None."""
    if "question" not in file.tables:
        return None
    values = file.read("question", 0, file.tables["question"])
    if "asks" not in values:
        raise file.fail("question", 0, "", "a question needs asks")
    return PictureQuestion(**values)


def _read_exif(file: _SceneFile, given: Mapping[str, object]) -> dict[str, float]:
    """Return the settings that the photograph's EXIF gives and the scene does not.

    An f-number needs to know the size of a pixel, and the ISO value of a metered picture has been
    made up for by its aperture and time.
    """
    name = file.tables.get("scene", {}).get("image")
    if name is None:
        raise file.fail("camera", 0, "exif", "exif needs an image")
    said = codecs.read_exif_settings(
        read_bytes(file.path.parent / name, SceneError, LARGEST_PICTURE)
    )
    sized = "pixel_pitch" in given or "sensor_width" in given
    needs = {"f_number": sized and "pinhole" not in given, "iso": "light_value" in given}
    taken = {key: x for key, x in said.items() if needs.get(key, True) and key not in given}
    if not said:
        raise file.fail("camera", 0, "exif", f"{name} does not say how it was taken")
    return taken


def _read_camera(file: _SceneFile, values: dict[str, Any], columns: int) -> Camera:
    """Return the camera; ``columns`` turn a sensor's width into the pitch of its pixels."""
    if (width := values.pop("sensor_width", None)) is not None:
        if "pixel_pitch" in values:
            raise file.fail("camera", 0, "sensor_width", "give sensor_width or pixel_pitch")
        values["pixel_pitch"] = width / columns
    try:
        return Camera(**values)
    except SettingError as error:
        raise file.fail("camera", 0, error.setting, str(error)) from error


def _check_effects(file: _SceneFile, view: View) -> None:
    """Raise `SceneError` with the line of a setting that an effect cannot be computed for."""
    for effect in effects.present_effects(view):
        try:
            effect.check_camera(view)
        except SceneError as error:
            given = (item.name for item in effect.settings if item.name in view.camera.given)
            raise file.fail("camera", 0, next(given, ""), str(error)) from error


def _read_thing(file: _SceneFile, which: int, table: Mapping[str, object]) -> SceneObject:
    """Return one thing to be drawn, with all sizes that its shape needs."""
    values = file.read("thing", which, table)
    thing = SceneObject(**values)
    for size in SIZES[thing.shape]:
        given = getattr(thing, size)
        if not given or (isinstance(given, Length) and given.value <= 0.0):
            raise file.fail("thing", which, "", f"a {thing.shape} needs {size}")
    if thing.cell.value <= 0.0:
        raise file.fail("thing", which, "", "cell must be positive")
    return thing


def _read_scene(
    file: _SceneFile, things: tuple[SceneObject, ...], precision: Precision | None
) -> Scene:
    """Return the scene with its pictures loaded, but without its question."""
    values = file.read("scene", 0, file.tables.get("scene", {}))
    kind = values["precision"] = precision or values.get("precision", Scene.precision)
    pixels = values.get("width", Scene.width) * values.get("height", Scene.height)
    if pixels > codecs.MOST_MEGAPIXELS * 1_000_000:
        raise file.fail("scene", 0, "width", f"more than {codecs.MOST_MEGAPIXELS} megapixels")
    near, far = values.pop("depth_near", 1.0), values.pop("depth_far", math.inf)
    for key in ("image", "depth_map"):
        if key in values:
            values[key] = _read_picture(file, key, values[key])
    if "image" in values:
        values["image"] = _map_codes(srgb_decode, values["image"], kind)  # linear radiance
        values["height"], values["width"] = values["image"].shape[:2]
    if (nearness := values.pop("depth_map", None)) is not None:
        shape = (values.get("height"), values.get("width"))
        if nearness.shape[:2] != shape:
            raise file.fail("scene", 0, "depth_map", "a depth map needs an image of its size")
        values["depth"] = _map_codes(
            # white is near, black is far, linear in 1/z
            lambda share: 1.0 / np.maximum(share / near + (1.0 - share) / far, 1e-9),
            nearness[..., 0], kind,
        )  # fmt: skip
    return Scene(things=things, file=file.path, **values)


_ROWS = 64


def _map_codes(value: Callable[[Any], Any], codes: codecs.Codes, precision: Precision) -> Image:
    """Return ``value`` of the share of white (0 to 1) of every code, from a table of all codes.

    A few rows at once: indexing makes larger numbers of the codes.
    """
    top = int(np.iinfo(codes.dtype).max)
    table = np.asarray(value(np.arange(top + 1) / top), precision)
    found = np.empty(codes.shape, table.dtype)
    for start in range(0, len(codes), _ROWS):
        found[start : start + _ROWS] = table[codes[start : start + _ROWS]]
    return found


def _read_picture(file: _SceneFile, key: str, name: str) -> codecs.Codes:
    """Return the codes of a picture file, shape (H, W, 3)."""
    path = file.path.parent / name
    try:
        pixels = codecs.decode_photo(read_bytes(path, SceneError, LARGEST_PICTURE))
        if min(pixels.shape[:2]) < SIDES[0]:
            raise ValueError(f"a picture has at least {SIDES[0]} rows and columns")  # noqa: TRY301
    except SceneError as error:
        raise file.fail("scene", 0, key, str(error)) from error
    except ValueError as error:
        raise file.fail("scene", 0, key, f"{name}: {error}") from error
    if pixels.shape[2] >= 3:
        return pixels[..., :3]
    return pixels[..., :1].repeat(3, axis=2)
