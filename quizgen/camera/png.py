"""PNG files with the standard library: written deterministically, read without interlacing."""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}
_COLOUR_TYPE = {1: 0, 3: 2, 4: 6}


def encode(pixels: Bytes) -> bytes:
    """PNG bytes of a picture.

    Parameters
    ----------
    pixels : numpy.ndarray
        uint8, shape (H, W) or (H, W, C) with C = 1, 3 or 4.
    """
    if pixels.dtype != np.uint8 or pixels.ndim not in (2, 3) or 0 in pixels.shape:
        raise ValueError("a PNG needs uint8 pixels of shape (H, W) or (H, W, 1|3|4)")
    planes = np.ascontiguousarray(pixels).reshape(*pixels.shape[:2], -1)
    height, width, channels = planes.shape
    header = struct.pack(">IIBBBBB", width, height, 8, _COLOUR_TYPE[channels], 0, 0, 0)
    data = zlib.compress(_filtered(planes), 9)
    return _SIGNATURE + _chunk(b"IHDR", header) + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, data: bytes) -> bytes:
    checksum = zlib.crc32(kind + data)
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", checksum)


def _filtered(planes: Bytes) -> bytes:
    """Each row as it is, minus its left or minus its upper neighbour: the smallest sum wins."""
    left, above = np.zeros_like(planes), np.zeros_like(planes)
    left[:, 1:], above[1:] = planes[:, :-1], planes[:-1]
    ways = np.stack([planes, planes - left, planes - above]).reshape(3, planes.shape[0], -1)
    sizes = np.abs(ways.view(np.int8).astype(np.int16)).sum(axis=2)
    best = sizes.argmin(axis=0)
    rows = ways[best, np.arange(planes.shape[0])]
    return np.concatenate([best[:, None].astype(np.uint8), rows], axis=1).tobytes()


def decode(data: bytes) -> NDArray[Any]:
    """Pixels of a PNG, uint8 or uint16, shape (H, W, C).

    Raises
    ------
    ValueError
        If the file is broken, interlaced, has a palette or fewer than 8 bits.
    """
    if not data.startswith(_SIGNATURE):
        raise ValueError("not a PNG file")
    try:
        return _decode(data)
    except (struct.error, zlib.error, KeyError, IndexError) as error:
        raise ValueError("a broken PNG file") from error


def _decode(data: bytes) -> NDArray[Any]:
    chunks = _chunks(data)
    width, height, bits, kind, _, _, interlaced = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    if interlaced or kind not in _CHANNELS or bits not in (8, 16):
        raise ValueError("only PNG files of 8 or 16 bits without palette or interlacing")
    channels = _CHANNELS[kind]
    pitch = channels * bits // 8
    raw = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8)
    if raw.size != height * (1 + width * pitch):
        raise ValueError("a broken PNG file")
    rows = _unfiltered(raw.reshape(height, 1 + width * pitch), pitch)
    pixels = rows if bits == 8 else rows.reshape(-1).view(">u2").astype(np.uint16)
    return pixels.reshape(height, width, channels)


def _chunks(data: bytes) -> dict[bytes, bytes]:
    found: dict[bytes, bytes] = {}
    position = len(_SIGNATURE)
    while position + 8 <= len(data):
        (length,) = struct.unpack_from(">I", data, position)
        kind = data[position + 4 : position + 8]
        body = data[position + 8 : position + 8 + length]
        found[kind] = found.get(kind, b"") + body
        position += 12 + length
    return found


def _unfiltered(rows: Bytes, pitch: int) -> Bytes:
    result = np.zeros((rows.shape[0] + 1, rows.shape[1] - 1), np.uint8)
    for number, row in enumerate(rows):
        result[number + 1] = _unfilter(int(row[0]), row[1:], result[number], pitch)
    return np.ascontiguousarray(result[1:])


def _unfilter(kind: int, row: Bytes, above: Bytes, pitch: int) -> Bytes:
    if kind == 0:
        return row
    if kind == 1:
        return np.cumsum(row.reshape(-1, pitch), axis=0, dtype=np.uint8).reshape(-1)
    if kind == 2:
        return row + above
    if kind > 4:
        raise ValueError("a broken PNG file")
    return _predicted(kind, row, above, pitch)


def _predicted(kind: int, row: Bytes, above: Bytes, pitch: int) -> Bytes:
    result = [0] * pitch + row.tolist()
    upper = [0] * pitch + above.tolist()
    for place in range(pitch, len(result)):
        left, top, corner = result[place - pitch], upper[place], upper[place - pitch]
        guess = (left + top) // 2 if kind == 3 else _paeth(left, top, corner)
        result[place] = (result[place] + guess) & 255
    return np.array(result[pitch:], np.uint8)


def _paeth(left: int, top: int, corner: int) -> int:
    target = left + top - corner
    return min((left, top, corner), key=lambda value: abs(target - value))
