"""Readers of a scene file's values: text with a unit, numbers, words, colours."""

# ruff: noqa: TRY004 - a wrong value in a file is a ValueError, whatever its type

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import TypeVar

from quizgen.camera.setup.scene import Colour, Length
from quizgen.core.errors import FormulaError
from quizgen.maths.numbers import parse_written_number
from quizgen.maths.units import Dimension, get_unit
from quizgen.numerics.gamma import srgb_decode

T = TypeVar("T")
ValueParser = Callable[[object], T]
"""Takes what TOML gives; raises ValueError with what was expected."""

LARGEST = 1e12
"""Magnitude of the largest number, in base units: nobody means more, and products stay finite."""
BRIGHTEST = 1e6
"""Largest radiance, 1 = white."""

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?:/\d+)?"
_QUANTITY = re.compile(rf"\s*(?P<number>{_NUMBER})\s*(?P<unit>.*?)\s*")


def _check_magnitude(value: float) -> float:
    """Return a value in base units; raise ``ValueError`` if it is larger than `LARGEST`."""
    if abs(value) > LARGEST:
        raise ValueError(f"expected at most {LARGEST:g} in base units")
    return value


def _parse_quantity(text: object) -> tuple[float, Dimension]:
    """Return number in base units and dimension of a text such as ``5 mm``.

    Degrees become radians.
    """
    if not isinstance(text, str):
        raise ValueError("expected a quantity with its unit in quotes")
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise ValueError(f"cannot read {text!r}; expected a number and a unit")
    try:
        found = get_unit(match["unit"])
        value = _check_magnitude(float(parse_written_number(match["number"]) * found.factor))
    except (FormulaError, OverflowError) as error:
        raise ValueError(str(error)) from error
    turn = math.pi / 180.0 if ("deg", 1) in found.dimension else 1.0
    return value * turn, found.dimension


def quantity_parser(name: str) -> ValueParser[float]:
    """Return a parser of quantities with the dimension of the unit ``name``, to base units."""
    expected = get_unit(name).dimension

    def read(text: object) -> float:
        """Return the value in base units, or raise ``ValueError``."""
        if text == "inf" and expected == get_unit("m").dimension:
            return math.inf
        value, dimension = _parse_quantity(text)
        if dimension != expected:
            raise ValueError(f"expected a unit like {name!r}")
        return value

    return read


def length_parser(per: str = "") -> ValueParser[Length]:
    """Return a parser of lengths in px or m; with ``per`` (such as ``/s``) of one per time."""

    def read(text: object) -> Length:
        """Return the length, or raise ``ValueError``."""
        value, dimension = _parse_quantity(text)
        for metric in (True, False):
            if dimension == get_unit(("m" if metric else "px") + per).dimension:
                return Length(value, metric)
        raise ValueError(f"expected a length in px{per} or m{per}")

    return read


def parse_plain_number(value: object) -> float:
    """Return a finite number without a unit; raise ``ValueError`` for anything else."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError("expected a number")
    return _check_magnitude(float(value))


def parse_integer(value: object) -> int:
    """Return a whole number; raise ``ValueError`` for anything else."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError("expected a whole number")
    return value


def parse_bool(value: object) -> bool:
    """Return true or false; raise ``ValueError`` for anything else."""
    if not isinstance(value, bool):
        raise ValueError("expected true or false")
    return value


def parse_text(value: object) -> str:
    """Return a text; raise ``ValueError`` for anything else."""
    if not isinstance(value, str):
        raise ValueError("expected text in quotes")
    return value


def choice_parser(*allowed: str) -> ValueParser[str]:
    """Return a parser that takes one of the given words."""

    def read(value: object) -> str:
        """Return the word, or raise ``ValueError``."""
        if value not in allowed:
            raise ValueError(f"expected one of {', '.join(allowed)}")
        return str(value)

    return read


def list_parser(part: ValueParser[T], count: int | None = None) -> ValueParser[tuple[T, ...]]:
    """Return a parser of a list, each item by ``part``; ``count`` None allows any length."""

    def read(value: object) -> tuple[T, ...]:
        """Return the items, or raise ``ValueError``."""
        if not isinstance(value, list) or count not in (None, len(value)):
            raise ValueError(f"expected a list of {count or 'several'} values")
        return tuple(part(item) for item in value)

    return read


def pair_parser(part: ValueParser[T]) -> ValueParser[tuple[T, T]]:
    """Return a parser of a list of two, each item by ``part``."""

    def read(value: object) -> tuple[T, T]:
        """Return both items, or raise ``ValueError``."""
        first, second = list_parser(part, 2)(value)
        return first, second

    return read


def parse_triple(value: object) -> Colour:
    """Return three numbers, for red, green and blue; raise ``ValueError`` for anything else."""
    red, green, blue = list_parser(parse_plain_number, 3)(value)
    return red, green, blue


def parse_colour(value: object) -> Colour:
    """Return linear radiances of ``#rrggbb`` in sRGB, or of three numbers."""
    if isinstance(value, str) and re.fullmatch(r"#[0-9a-fA-F]{6}", value):
        codes = [int(value[place : place + 2], 16) / 255.0 for place in (1, 3, 5)]
        red, green, blue = (float(light) for light in srgb_decode(codes))
        return red, green, blue
    red, green, blue = parse_triple(value)
    if min(red, green, blue) < 0.0:
        raise ValueError("radiance cannot be negative")
    if max(red, green, blue) > BRIGHTEST:
        raise ValueError(f"expected a radiance of at most {BRIGHTEST:g}")
    return red, green, blue
