"""Tone curves in single precision from multiplications and additions only.

Library powers differ in the last bit between processors, and a last bit can flip an 8-bit level.
Splitting off the binary exponent leaves a polynomial that gives the same bits everywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.float32]

SRGB_KNEE = 0.0031308
SRGB_LINEAR = 0.04045
_DEGREE = 7
_PART = 1 << 14


@cache
def _tables(exponent: float) -> tuple[list[np.float32], Image]:
    """Polynomial of (1 + t)^exponent on [0, 1], highest power first, and 2^(exponent n)."""
    nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
    fitted = np.polyfit(nodes - 0.5, (1.0 + nodes) ** exponent, _DEGREE)
    powers = np.exp2(exponent * np.minimum(np.arange(256) - 127.0, 0.0))
    powers[0] = 0.0
    return [np.float32(value) for value in fitted], powers.astype(np.float32)


def power(values: Image, exponent: float) -> Image:
    """Raise values in [0, 1] to a power in (0, 1], within 3e-7 of the true value.

    Parameters
    ----------
    values : numpy.ndarray
        float32, any shape; clipped to [0, 1] first. Subnormal values count as 0.
    exponent : float
        In (0, 1].
    """
    return _in_parts(values, lambda part: _power_part(part, exponent))


def _in_parts(values: Image, work: Callable[[Image], Image]) -> Image:
    """Clip and work on pieces that stay in the processor's cache."""
    flat = np.ascontiguousarray(values, np.float32).reshape(-1)
    result = np.empty_like(flat)
    for start in range(0, flat.size, _PART):
        part = slice(start, start + _PART)
        result[part] = work(np.clip(flat[part], np.float32(0.0), np.float32(1.0)))
    return result.reshape(values.shape)


def _power_part(values: Image, exponent: float) -> Image:
    terms, powers = _tables(exponent)
    bits = values.view(np.int32)
    scale = powers.take(bits >> np.int32(23))
    fraction = ((bits & np.int32(0x7FFFFF)) | np.int32(0x3F800000)).view(np.float32)
    fraction -= np.float32(1.5)
    result = fraction * terms[0]
    for term in terms[1:-1]:
        result += term
        result *= fraction
    result += terms[-1]
    result *= scale
    return result


def _srgb_part(values: Image) -> Image:
    curve = _power_part(values, 1.0 / 2.4)
    curve *= np.float32(1.055)
    curve -= np.float32(0.055)
    dark = values <= np.float32(SRGB_KNEE)
    if dark.any():
        np.multiply(values, np.float32(12.92), out=curve, where=dark)
    return curve


def encode(values: Image, gamma: str | float) -> Image:
    """Encode linear light for display.

    Parameters
    ----------
    values : numpy.ndarray
        Linear, clipped to [0, 1] first.
    gamma : str or float
        ``srgb`` (IEC 61966-2-1: 12.92 x below 0.0031308, else 1.055 x^(1/2.4) - 0.055), or an
        exponent g >= 1 for x^(1/g).
    """
    if gamma == "linear":
        return np.clip(values, np.float32(0.0), np.float32(1.0))
    if gamma == "srgb":
        return _in_parts(values, _srgb_part)
    return power(values, 1.0 / float(gamma))


TABLE = 65535
"""Steps of the tone table over [0, 1]."""


@cache
def _tone_table(gamma: str | float) -> Image:
    return encode((np.arange(TABLE + 1) / TABLE).astype(np.float32), gamma)


def encode_by_table(values: Image, gamma: str | float) -> Image:
    """`encode` after rounding the linear values to 16 bits: a third of the time."""
    table, top = _tone_table(gamma), np.float32(TABLE)

    def work(part: Image) -> Image:
        part *= top
        part += np.float32(0.5)
        return table.take(part.astype(np.int32), mode="clip")

    return _in_parts(values, work)


def decode(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear light of sRGB values in [0, 1] (double precision, for colours and small pictures)."""
    values = np.asarray(values, np.float64)
    curve = ((np.maximum(values, SRGB_LINEAR) + 0.055) / 1.055) ** 2.4
    return np.where(values <= SRGB_LINEAR, values / 12.92, curve)


def encode_number(value: float, gamma: str | float) -> float:
    """`encode` of one number in double precision, as the bounds need it."""
    value = min(max(value, 0.0), 1.0)
    if gamma == "linear":
        return value
    if gamma != "srgb":
        return float(value ** (1.0 / float(gamma)))
    return 12.92 * value if value <= SRGB_KNEE else 1.055 * value ** (1.0 / 2.4) - 0.055
