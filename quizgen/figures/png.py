"""Small PNG files whose bytes depend on nothing but the picture.

Pictures stand in papers, and a paper has the same bytes on every machine. What zlib writes differs
between its implementations and versions, so Pillow cannot write them: its one setting that leaves
zlib no choice, level 0, makes a mock exam with photographs 1.6 times as large. So runs are coded
here with the fixed Huffman table of deflate (RFC 1951), which suits flat pictures well.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from struct import pack
from zlib import adler32, crc32

import numpy as np
from numpy.typing import NDArray

_GREY, _RGB, _PALETTE, _RGBA = 0, 2, 3, 6
_UNFILTERED, _UP = 0, 2

_LENGTH_BASE = (
    3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131,
    163, 195, 227, 258,
)  # fmt: skip
_LENGTH_BITS = (0,) * 8 + (1,) * 4 + (2,) * 4 + (3,) * 4 + (4,) * 4 + (5,) * 4 + (0,)
_SHORTEST, _LONGEST = 3, 258
_DISTANCE_ONE = "00000"
# Bits before and after all symbols: one block, the last one, with the fixed table.
_HEADER, _END = "110", "0000000"


def encode_png(
    codes: NDArray[np.uint8], palette: Sequence[tuple[int, int, int]] | None = None
) -> bytes:
    """Return a PNG file, the same bytes with every version of zlib.

    Parameters
    ----------
    codes : ndarray of uint8, shape (H, W), (H, W, 3) or, with opacity, (H, W, 4)
        8-bit codes, at least one pixel. Three equal channels without opacity are stored as one.
    palette : sequence of tuple of int, optional
        Up to 256 colours as (red, green, blue), 0 to 255; ``codes`` (H, W) are then their indices.
    """
    if palette is not None:
        colours = b"".join(bytes(colour) for colour in palette)
        return _write_file(codes, _PALETTE, _UNFILTERED, (b"PLTE", colours))
    if codes.ndim == 3 and codes.shape[2] == 3 and (codes[..., :1] == codes).all():
        codes = codes[..., 0]
    kind = _GREY if codes.ndim == 2 else _RGB if codes.shape[2] == 3 else _RGBA
    return _write_file(codes, kind, _UP)


def _write_file(
    codes: NDArray[np.uint8], kind: int, row_filter: int, *chunks: tuple[bytes, bytes]
) -> bytes:
    height, width = codes.shape[:2]
    pixels = codes.reshape(height, -1)
    rows = np.empty((height, pixels.shape[1] + 1), np.uint8)
    rows[:, 0], rows[:, 1:] = row_filter, pixels
    if row_filter == _UP:
        rows[1:, 1:] -= pixels[:-1]  # flat areas become runs of zeros
    header = pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    data = (b"IDAT", _compress_runs(rows.ravel()))
    parts = ((b"IHDR", header), *chunks, data, (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_write_chunk(*part) for part in parts)


def _write_chunk(name: bytes, content: bytes) -> bytes:
    return pack(">I", len(content)) + name + content + pack(">I", crc32(name + content))


def _compress_runs(data: NDArray[np.uint8]) -> bytes:
    """Return a zlib stream (RFC 1950) in which every run of equal bytes is one byte, repeated."""
    ends = np.append((data[1:] != data[:-1]).nonzero()[0], len(data) - 1)
    repeats = np.diff(ends, prepend=-1) - 1
    symbols = map(_run_bits, data[ends].tolist(), repeats.tolist())
    bits = "".join([_HEADER, *symbols, _END])
    # The first bit of the stream is the lowest of its first byte.
    stream = int(bits[::-1], 2).to_bytes((len(bits) + 7) // 8, "little")
    return b"\x78\x01" + stream + pack(">I", adler32(data.data))


@lru_cache(1 << 16)
def _run_bits(byte: int, repeats: int) -> str:
    """Bits of a byte and its repeats; what is too short for a length is written out."""
    full, left = divmod(repeats, _LONGEST)
    rest = _repeat_bits(left) if left >= _SHORTEST else _symbol_bits(byte) * left
    return _symbol_bits(byte) + _repeat_bits(_LONGEST) * full + rest


def _repeat_bits(length: int) -> str:
    """Bits that repeat the last byte 3 to 258 times."""
    code = max(i for i, base in enumerate(_LENGTH_BASE) if base <= length)
    bits = _LENGTH_BITS[code]
    extra = f"{length - _LENGTH_BASE[code]:0{bits}b}"[::-1] if bits else ""
    return _symbol_bits(257 + code) + extra + _DISTANCE_ONE


def _symbol_bits(code: int) -> str:
    """Bits of a literal or length symbol in the fixed table, in the order they are written."""
    if code < 144:
        return f"{0x30 + code:08b}"
    if code < 256:
        return f"{0x190 + code - 144:09b}"
    return f"{code - 256:07b}" if code < 280 else f"{0xC0 + code - 280:08b}"
