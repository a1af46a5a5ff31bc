"""PNG files: small ones whose bytes depend on nothing but the picture, photographs, and reading.

zlib's output differs between its implementations and versions, and a paper must be the same on
every machine: `encode` and `indexed` code runs with the fixed Huffman table of deflate (RFC 1951),
which suits flat pictures well. A photograph that goes into a file of its own is packed by Pillow
(`compact`), smaller and faster, or as small as it gets (`small`); its pixels never vary, its bytes
may.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from functools import cache
from io import BytesIO
from struct import pack, unpack
from typing import TYPE_CHECKING
from zlib import adler32, crc32

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from PIL.Image import Exif
    from PIL.PngImagePlugin import PngImageFile

    Codes = NDArray[np.uint8] | NDArray[np.uint16]

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_GREY, _RGB, _PALETTE, _RGBA = 0, 2, 3, 6

_LENGTH_BASE = (
    3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131,
    163, 195, 227, 258,
)  # fmt: skip
_LENGTH_BITS = (0,) * 8 + (1,) * 4 + (2,) * 4 + (3,) * 4 + (4,) * 4 + (5,) * 4 + (0,)
_SHORTEST, _LONGEST = 3, 258
_DISTANCE_ONE = "00000"
_HEADER, _END = "110", "0000000"
"""Bits before and after all symbols: one block, the last, with the fixed table."""


# Written with bytes that never vary


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


_SHIFT = 27
"""A byte and what repeats it take no more bits; behind them stands how many it are."""


@cache
def _table() -> NDArray[np.uint32]:
    """Bits of a byte and what repeats it, as numbers, and in the highest bits how many it are.

    Row 259 b + n is byte b with n repeats, row 259 (256 + b) + n its n repeats alone.
    """
    import numpy as np

    literals, wide = _numbers([_symbol(code) for code in range(256)])
    values = np.zeros((2, 256, _ROW), np.uint32)
    lengths = np.zeros(values.shape, np.uint32)
    values[1, :, 1], lengths[1, :, 1] = literals, wide
    values[1, :, 2], lengths[1, :, 2] = literals | literals << wide, 2 * wide
    repeats = [_repeat(length) for length in range(_SHORTEST, _LONGEST + 1)]
    values[1, :, _SHORTEST:], lengths[1, :, _SHORTEST:] = _numbers(repeats)
    values[0] = literals[:, None] | values[1] << wide[:, None]
    lengths[0] = wide[:, None] + lengths[1]
    return np.asarray(values | lengths << _SHIFT, np.uint32).ravel()


_ROW = _LONGEST + 1


def _numbers(codes: list[str]) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    import numpy as np

    numbers = [int(code[::-1], 2) for code in codes], [*map(len, codes)]
    return np.array(numbers[0], np.uint32), np.array(numbers[1], np.uint32)


def _runs(data: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Rows of the table, one for each run; a run that is too long takes more."""
    import numpy as np

    ends = np.append((data[1:] != data[:-1]).nonzero()[0], len(data) - 1)
    repeats = ends.copy()
    repeats[1:] -= ends[:-1] + 1
    rows = data[ends].astype(np.intp) * _ROW
    long = (repeats > _LONGEST).nonzero()[0]
    if not long.size:
        return rows + repeats
    full, left = np.divmod(repeats[long] - _LONGEST, _LONGEST)
    alone = rows[long] + 256 * _ROW
    pieces = np.repeat(alone + _LONGEST, full + 1)
    pieces[np.cumsum(full + 1) - 1] = alone + left
    return np.insert(rows + np.minimum(repeats, _LONGEST), np.repeat(long + 1, full + 1), pieces)


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

    found = _table()[_runs(data)]
    lengths = found >> _SHIFT
    at = np.cumsum(lengths, dtype=np.intp)
    size = (len(_HEADER) + int(at[-1]) + len(_END) + 7) // 8
    at -= lengths
    at += len(_HEADER)
    values = (found & ((1 << _SHIFT) - 1)).astype(np.uint64)
    values <<= (at & 15).view(np.uint64)
    # Bits of different runs never meet, so that adding joins them; up to 15 + 27 bits from the
    # start of a word on, which floats add exactly.
    joined = np.bincount(at >> 4, values, size // 2 + 3)
    words = joined.astype(np.uint64)
    words[0] += int(_HEADER[::-1], 2)
    stream = words.copy()
    for place in (1, 2):
        stream[place:] |= words[:-place] >> np.uint64(16 * place)
    return b"\x78\x01" + stream.astype("<u2").tobytes()[:size] + pack(">I", adler32(data.data))


def index_data(indices: NDArray[np.uint8]) -> bytes:
    """Compress the pixels of a picture; palettes may be put to them later.

    Parameters
    ----------
    indices : ndarray of uint8, shape (height, width)
        Index of the colour of each pixel.
    """
    return deflate(_led(indices, 0).ravel())


def indexed(shape: tuple[int, int], data: bytes, palette: Sequence[tuple[int, int, int]]) -> bytes:
    """Put a picture with a palette together.

    Parameters
    ----------
    shape : tuple of int
        Height and width in pixels.
    data : bytes
        From `index_data`.
    palette : sequence of tuple of int
        Up to 256 colours as (red, green, blue), 0 to 255.

    Returns
    -------
    bytes
        A PNG file, the same with every version of zlib.
    """
    colours = b"".join(bytes(colour) for colour in palette)
    return _file(shape, _PALETTE, (b"PLTE", colours), (b"IDAT", data))


def encode(codes: NDArray[np.uint8]) -> bytes:
    """Encode 8-bit codes.

    Parameters
    ----------
    codes : ndarray of uint8, shape (H, W), (H, W, 3) or, with opacity, (H, W, 4)
        Three equal channels without opacity are stored as one.

    Returns
    -------
    bytes
        A PNG file, the same with every version of zlib.
    """
    codes = _one_if_alike(codes)
    height, width = codes.shape[:2]
    rows = codes.reshape(height, -1)
    filtered = _led(rows, 2)
    filtered[1:, 1:] -= rows[:-1]  # flat areas become runs of zeros
    kind = _GREY if codes.ndim == 2 else _RGB if codes.shape[2] == 3 else _RGBA
    return _file((height, width), kind, (b"IDAT", deflate(filtered.ravel())))


def _one_if_alike(codes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Three equal channels as one."""
    import numpy as np

    def alike(rows: NDArray[np.uint8]) -> bool:
        return all(np.array_equal(rows[..., 0], rows[..., at]) for at in (1, 2))

    if codes.ndim == 3 and codes.shape[2] == 3 and alike(codes[len(codes) // 2]) and alike(codes):
        return codes[..., 0]
    return codes


def _led(rows: NDArray[np.uint8], way: int) -> NDArray[np.uint8]:
    """Rows with the number of their filter before each."""
    import numpy as np

    led = np.empty((len(rows), rows.shape[1] + 1), np.uint8)
    led[:, 0], led[:, 1:] = way, rows
    return led


def _file(shape: tuple[int, int], kind: int, *chunks: tuple[bytes, bytes]) -> bytes:
    height, width = shape
    header = pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    whole = ((b"IHDR", header), *chunks, (b"IEND", b""))
    return _SIGNATURE + b"".join(_chunk(name, content) for name, content in whole)


def _chunk(kind: bytes, content: bytes) -> bytes:
    return pack(">I", len(content)) + kind + content + pack(">I", crc32(kind + content))


# Photographs, by Pillow

_FAST, _RUNS = 1, 3
"""Effort of packing, and zlib's way of looking for runs only: after the difference from the pixel
beside nothing else repeats in a photograph, and looking for it takes most of the time."""


def compact(codes: NDArray[np.uint8]) -> bytes:
    """Encode 8-bit codes of a photograph, shape (H, W) or (H, W, C) with C = 3 or 4."""
    from PIL import Image

    stream = BytesIO()
    Image.fromarray(codes).save(stream, "PNG", compress_level=_FAST, compress_type=_RUNS)
    return stream.getvalue()


def small(codes: NDArray[np.uint8]) -> bytes:
    """Encode 8-bit codes of a picture of some thousand pixels, shape (H, W) or (H, W, 3).

    The shortest of some ways: few colours as a palette, three equal channels as one, and each row
    as it is or as its difference from what is to the left or above.
    """
    import numpy as np

    codes = _one_if_alike(codes)
    if codes.ndim == 2:
        return _filtered(codes, _GREY)
    colours, indices = np.unique(codes @ np.array([1 << 16, 1 << 8, 1]), return_inverse=True)
    if len(colours) > 256:
        return _filtered(codes, _RGB)
    table = (b"PLTE", b"".join(colour.to_bytes(3) for colour in colours.tolist()))
    return _filtered(indices.reshape(codes.shape[:2]).astype(np.uint8), _PALETTE, table)


def _filtered(codes: NDArray[np.uint8], kind: int, *chunks: tuple[bytes, bytes]) -> bytes:
    import numpy as np

    beside = np.diff(codes, axis=1, prepend=codes[:, :1] * 0)
    above = np.diff(codes, axis=0, prepend=codes[:1] * 0)
    rows = [one.reshape(len(codes), -1) for one in (codes, beside, above)]
    data = [_led(row, way).tobytes() for way, row in enumerate(rows)]
    best = min(data, key=lambda one: len(zlib.compress(one, 1)))
    height, width = codes.shape[:2]
    return _file((height, width), kind, *chunks, (b"IDAT", zlib.compress(best, 9)))


MOST_MEGAPIXELS = 24
_BROKEN = (OSError, SyntaxError, ArithmeticError, LookupError, struct.error, zlib.error)
"""What Pillow raises for broken files, beside ValueError."""


def decode(data: bytes) -> Codes:
    """Pixels of a PNG.

    Returns
    -------
    ndarray of uint8 or uint16, shape (H, W, C)
        C = 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha.

    Raises
    ------
    ValueError
        If the file is none, broken or larger than `MOST_MEGAPIXELS`.
    """
    if not data.startswith(_SIGNATURE):
        raise ValueError("not a PNG or JPEG file")
    width, height = unpack(">II", data[16:24].ljust(8, b"\0"))
    bounded(width, height)
    try:
        return _decoded(data).reshape(height, width, -1)
    except _BROKEN as error:
        raise ValueError("a broken PNG file") from error


def bounded(width: int, height: int) -> None:
    """Refuse a picture that would take too much memory.

    Raises
    ------
    ValueError
        If it has more than `MOST_MEGAPIXELS`.
    """
    if width * height > MOST_MEGAPIXELS * 1_000_000:
        raise ValueError(f"more than {MOST_MEGAPIXELS} megapixels")


def exif(data: bytes) -> Exif:
    """What the camera wrote into a PNG file that can be decoded."""
    return _opened(data).getexif()


def _decoded(data: bytes) -> Codes:
    import numpy as np

    file = _opened(data)
    packing = str(file.tile[0].args) if file.tile else ""
    if packing not in _WAYS:
        return np.asarray(file.convert(_PLAIN.get(file.mode, "RGBA")))
    first, *second = (_unpacked(data, way) for way in _WAYS[packing])
    if second:
        return first.astype(np.uint16) * 256 + second[0]
    return first.view(">u2").astype(np.uint16) if packing == "LA;16B" else first


def _opened(data: bytes) -> PngImageFile:
    from PIL.PngImagePlugin import PngImageFile

    return PngImageFile(BytesIO(data))


def _unpacked(data: bytes, way: str) -> Codes:
    import numpy as np

    file = _opened(data)
    file.tile = [tile._replace(args=way) for tile in file.tile]
    return np.asarray(file)


_PLAIN = {"1": "L", "L": "L"}
"""Few bits become eight; a palette becomes its colours, with alpha."""

_WAYS = {
    **{raw: (raw,) for raw in ("L", "LA", "RGB", "RGBA", "I;16B")},
    "RGB;16B": ("RGB;16B", "RGB;16L"),
    "RGBA;16B": ("RGBA;16B", "RGBA;16L"),
    "LA;16B": ("RGBA",),
}
"""How Pillow is to unpack the pixels. Of colours of 16 bits it keeps the leading byte, which is the
first; asked for the other order of bytes, it keeps the second. Grey and alpha of 16 bits come as
four bytes."""
