"""A small PNG encoder for pictures with a palette, whose bytes depend on nothing but the picture.

zlib's output differs between its implementations and versions, and a paper must be the same on
every machine. Runs are coded with the fixed Huffman table of deflate (RFC 1951), which suits flat
pictures well.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from struct import pack
from typing import TYPE_CHECKING
from zlib import adler32, crc32

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_LENGTH_BASE = (
    3,
    4,
    5,
    6,
    7,
    8,
    9,
    10,
    11,
    13,
    15,
    17,
    19,
    23,
    27,
    31,
    35,
    43,
    51,
    59,
    67,
    83,
    99,
    115,
    131,
    163,
    195,
    227,
    258,
)
_LENGTH_BITS = (0,) * 8 + (1,) * 4 + (2,) * 4 + (3,) * 4 + (4,) * 4 + (5,) * 4 + (0,)
_LONGEST = 258
_DISTANCE_ONE = "00000"


@cache
def _symbol(code: int) -> str:
    """Bits of a literal or length symbol in the fixed table, in the order they are written."""
    if code < 144:
        return f"{0x30 + code:08b}"
    if code < 256:
        return f"{0x190 + code - 144:09b}"
    return f"{code - 256:07b}" if code < 280 else f"{0xC0 + code - 280:08b}"


@cache
def _repeat(length: int) -> str:
    """Bits that repeat the last byte 3 to 258 times."""
    code = max(i for i, base in enumerate(_LENGTH_BASE) if base <= length)
    bits = _LENGTH_BITS[code]
    extra = f"{length - _LENGTH_BASE[code]:0{bits}b}"[::-1] if bits else ""
    return _symbol(257 + code) + extra + _DISTANCE_ONE


@cache
def _run(byte: int, count: int) -> str:
    """Bits of one byte repeated."""
    bits, count = [_symbol(byte)], count - 1
    while count >= 3:
        step = min(count, _LONGEST)
        bits.append(_repeat(step))
        count -= step
    return "".join(bits) + _symbol(byte) * count


def deflate(data: NDArray[np.uint8]) -> bytes:
    """Compress bytes into a zlib stream.

    Parameters
    ----------
    data : ndarray of uint8, shape (n,)
        At least one byte.

    Returns
    -------
    bytes
        A stream that any inflate reads (RFC 1950).
    """
    import numpy as np

    starts = np.flatnonzero(np.diff(data, prepend=data[0] ^ 1))
    counts = np.diff(starts, append=len(data))
    runs = zip(data[starts].tolist(), counts.tolist(), strict=True)
    bits = "110" + "".join(_run(byte, count) for byte, count in runs) + _symbol(256)
    packed = int(bits[::-1], 2).to_bytes((len(bits) + 7) // 8, "little")
    return b"\x78\x01" + packed + pack(">I", adler32(data.tobytes()))


def pixels(indices: NDArray[np.uint8]) -> bytes:
    """Compress the pixels of a picture; palettes may be put to them later.

    Parameters
    ----------
    indices : ndarray of uint8, shape (height, width)
        Index of the colour of each pixel.
    """
    import numpy as np

    return deflate(np.pad(indices, ((0, 0), (1, 0))).ravel())


def png(shape: tuple[int, int], data: bytes, palette: Sequence[tuple[int, int, int]]) -> bytes:
    """Put a picture together.

    Parameters
    ----------
    shape : tuple of int
        Height and width in pixels.
    data : bytes
        From ``pixels``.
    palette : sequence of tuple of int
        Up to 256 colours as (red, green, blue), 0 to 255.

    Returns
    -------
    bytes
        A PNG file.
    """
    height, width = shape
    colours = b"".join(bytes(colour) for colour in palette)
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        (
            _chunk(b"IHDR", pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)),
            _chunk(b"PLTE", colours),
            _chunk(b"IDAT", data),
            _chunk(b"IEND", b""),
        )
    )


def _chunk(kind: bytes, content: bytes) -> bytes:
    return pack(">I", len(content)) + kind + content + pack(">I", crc32(kind + content))
