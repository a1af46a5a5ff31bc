"""What Python's floats need beside ``math``: the operators that it lacks or types differently."""

from __future__ import annotations

import math
from struct import pack, unpack


def sign(a: float) -> float:
    """-1, 0 or 1."""
    return 0.0 if a == 0 else math.copysign(1.0, a)


def floor(a: float) -> float:
    """Round down, as a float."""
    return float(math.floor(a))


def ceil(a: float) -> float:
    """Round up, as a float."""
    return float(math.ceil(a))


def round_float_half_away(a: float) -> float:
    """Round half away from zero, as the stems promise."""
    return math.copysign(math.floor(abs(a) + 0.5), a)


def pi() -> float:
    """Half the length of the unit circle."""
    return math.pi


def round_to_float32(x: float) -> float:
    """Round to float32."""
    return float(unpack("f", pack("f", x))[0])
