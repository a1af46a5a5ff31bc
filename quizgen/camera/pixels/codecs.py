"""Photographs in files: PNG and JPEG, read the right way up and written by the file's ending."""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Callable
from io import BytesIO
from typing import TYPE_CHECKING, SupportsFloat

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.pixels.filters import load_opencv

if TYPE_CHECKING:
    from PIL.Image import Exif
    from PIL.JpegImagePlugin import JpegImageFile
    from PIL.PngImagePlugin import PngImageFile

Codes = NDArray[np.uint8] | NDArray[np.uint16]

MOST_MEGAPIXELS = 24
_JPEG = b"\xff\xd8\xff"
_PNG = b"\x89PNG\r\n\x1a\n"
# How Pillow is to unpack the pixels of a PNG file. Of colours of 16 bits it keeps the leading
# byte, which is the first; asked for the other order of bytes, it keeps the second. Grey and alpha
# of 16 bits come as four bytes.
_UNPACKINGS = {
    **{raw: (raw,) for raw in ("L", "LA", "RGB", "RGBA", "I;16B")},
    "RGB;16B": ("RGB;16B", "RGB;16L"),
    "RGBA;16B": ("RGBA;16B", "RGBA;16L"),
    "LA;16B": ("RGBA",),
}
# Zlib's effort, and its way of looking for runs only: after the difference from the pixel to the
# left nothing else repeats in a photograph, and looking for it takes most of the time.
_FAST, _RUNS = 1, 3
_ORIENTATION = 0x0112
_TURNED: dict[object, Callable[[Codes], Codes]] = {
    2: lambda pixels: pixels[:, ::-1],
    3: lambda pixels: pixels[::-1, ::-1],
    4: lambda pixels: pixels[::-1],
    5: lambda pixels: pixels.swapaxes(0, 1),
    6: lambda pixels: pixels.swapaxes(0, 1)[:, ::-1],
    7: lambda pixels: pixels[::-1, ::-1].swapaxes(0, 1),
    8: lambda pixels: pixels.swapaxes(0, 1)[::-1],
}
"""What brings pixels upright, by EXIF's number for how the camera was held."""
_SHOT = 0x8769
_SHOT_WITH = {
    "shutter": (0x829A, 1.0),
    "f_number": (0x829D, 1.0),
    "focal_length": (0x920A, 1e-3),
    "iso": (0x8827, 1.0),
}
"""Settings of a camera by EXIF's numbers, and what makes base units of their values."""
_QUALITY = 95
# What Pillow raises for broken files, except for ValueError.
_BROKEN = (
    OSError, SyntaxError, ArithmeticError, LookupError, struct.error, TypeError, zlib.error,
)  # fmt: skip


def decode_photo(data: bytes) -> Codes:
    """Return the pixels of a PNG or JPEG file, turned upright by its EXIF.

    Returns
    -------
    ndarray of uint8 or uint16, shape (H, W, C)
        C = 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha.

    Raises
    ------
    ValueError
        If the file is neither, broken or larger than `MOST_MEGAPIXELS`.
    """
    if not data.startswith((_JPEG, _PNG)):
        raise ValueError("not a PNG or JPEG file")
    kind = "JPEG" if data.startswith(_JPEG) else "PNG"
    try:
        file = _open_file(data)
        if math.prod(file.size) > MOST_MEGAPIXELS * 1_000_000:
            raise ValueError(f"more than {MOST_MEGAPIXELS} megapixels")
        pixels = _decode_jpeg(file) if kind == "JPEG" else _decode_png(data)
        return _apply_orientation(pixels.reshape(*file.size[::-1], -1), _open_file(data).getexif())
    except _BROKEN as error:
        raise ValueError(f"a broken {kind} file") from error


def _open_file(data: bytes) -> JpegImageFile | PngImageFile:
    """Return Pillow's reader of a JPEG or PNG file."""
    # Loaded for photographs only: most scenes are drawn.
    from PIL.JpegImagePlugin import JpegImageFile
    from PIL.PngImagePlugin import PngImageFile

    return (JpegImageFile if data.startswith(_JPEG) else PngImageFile)(BytesIO(data))


def _decode_jpeg(file: JpegImageFile | PngImageFile) -> Codes:
    """Return grey or RGB pixels of a JPEG file."""
    return np.asarray(file if file.mode == "L" else file.convert("RGB"))


def _decode_png(data: bytes) -> Codes:
    """Return the pixels of a PNG file at their full 8 or 16 bits, which Pillow would cut."""
    file = _open_file(data)
    packing = str(file.tile[0].args) if file.tile else ""
    if packing not in _UNPACKINGS:  # few bits become eight; a palette its colours, with alpha
        return np.asarray(file.convert("L" if file.mode in {"1", "L"} else "RGBA"))
    first, *second = (_decode_raw(data, way) for way in _UNPACKINGS[packing])
    if second:
        return first.astype(np.uint16) * 256 + second[0]
    return first.view(">u2").astype(np.uint16) if packing == "LA;16B" else first


def _decode_raw(data: bytes, way: str) -> Codes:
    """Return the pixels of a PNG file, unpacked in one of Pillow's raw modes."""
    file = _open_file(data)
    file.tile = [tile._replace(args=way) for tile in file.tile]
    return np.asarray(file)


def read_exif_settings(data: bytes) -> dict[str, float]:
    """Return the camera settings that a photograph's EXIF names, in base units.

    Parameters
    ----------
    data : bytes
        Of a file that `decode_photo` can read.
    """
    try:
        said = _open_file(data).getexif().get_ifd(_SHOT)
    except _BROKEN:
        return {}
    found = {
        name: _parse_positive(said.get(tag)) * unit for name, (tag, unit) in _SHOT_WITH.items()
    }
    return {name: value for name, value in found.items() if value}


def _parse_positive(value: object) -> float:
    """Return a number > 0, or 0 for anything else."""
    if not isinstance(value, SupportsFloat):
        return 0.0
    try:
        number = float(value)
    except ZeroDivisionError:
        return 0.0
    return number if 0.0 < number < math.inf else 0.0


def _apply_orientation(pixels: Codes, exif: Exif) -> Codes:
    """Return pixels turned and mirrored as the EXIF orientation says."""
    turn = _TURNED.get(exif.get(_ORIENTATION))
    return pixels if turn is None else turn(pixels)


def encode_photo(codes: NDArray[np.uint8]) -> bytes:
    """Return a PNG file of a photograph; its pixels never vary, its bytes do with zlib.

    Parameters
    ----------
    codes : ndarray of uint8, shape (H, W), (H, W, 3) or (H, W, 4)
    """
    from PIL import Image

    stream = BytesIO()
    Image.fromarray(codes).save(stream, "PNG", compress_level=_FAST, compress_type=_RUNS)
    return stream.getvalue()


def _encode_png(codes: NDArray[np.uint8]) -> bytes:
    """Return a PNG file, by OpenCV in half the time, else by Pillow."""
    cv2 = load_opencv()
    if cv2 is None:
        return encode_photo(codes)
    return bytes(cv2.imencode(".png", cv2.cvtColor(codes, cv2.COLOR_RGB2BGR))[1])


def _encode_jpeg(codes: NDArray[np.uint8]) -> bytes:
    """Return a JPEG file, without subsampled colours."""
    from PIL import Image

    stream = BytesIO()
    Image.fromarray(codes).save(stream, "JPEG", quality=_QUALITY, subsampling=0)
    return stream.getvalue()


WRITERS: dict[str, Callable[[NDArray[np.uint8]], bytes]] = {
    ".png": _encode_png,
    ".jpg": _encode_jpeg,
    ".jpeg": _encode_jpeg,
}
"""Ending of a file to what encodes 8-bit codes, shape (H, W, 3), for it."""
