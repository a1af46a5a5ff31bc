"""Photographs in files: PNG and JPEG, read the right way up and written by the file's ending."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from io import BytesIO
from typing import TYPE_CHECKING, SupportsFloat

import numpy as np
from numpy.typing import NDArray

from quizgen import png
from quizgen.camera.pixels.filters import load_opencv

if TYPE_CHECKING:
    from PIL.Image import Exif
    from PIL.JpegImagePlugin import JpegImageFile

_JPEG = b"\xff\xd8\xff"
_ORIENTATION = 0x0112
_TURNED: dict[object, Callable[[png.Codes], png.Codes]] = {
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
_BROKEN = (OSError, SyntaxError, ArithmeticError, LookupError, struct.error, TypeError)


def decode_photo(data: bytes) -> png.Codes:
    """Pixels of a PNG or JPEG file, upright.

    Returns
    -------
    ndarray of uint8 or uint16, shape (H, W, C)
        C = 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha.

    Raises
    ------
    ValueError
        If the file is neither, broken or larger than `png.MOST_MEGAPIXELS`.
    """
    if not data.startswith(_JPEG):
        return _upright(png.decode(data), png.exif(data))
    try:
        file = _jpeg(data)
        png.bounded(*file.size)
        pixels = np.asarray(file if file.mode == "L" else file.convert("RGB"))
        return _upright(pixels.reshape(*pixels.shape[:2], -1), file.getexif())
    except _BROKEN as error:
        raise ValueError("a broken JPEG file") from error


def read_exif_settings(data: bytes) -> dict[str, float]:
    """Settings of the camera that took a photograph, in base units, as far as its EXIF says.

    Parameters
    ----------
    data : bytes
        Of a file that `decode_photo` can read.
    """
    try:
        exif = _jpeg(data).getexif() if data.startswith(_JPEG) else png.exif(data)
        said = exif.get_ifd(_SHOT)
    except _BROKEN:
        return {}
    found = {name: _positive(said.get(tag)) * unit for name, (tag, unit) in _SHOT_WITH.items()}
    return {name: value for name, value in found.items() if value}


def _positive(value: object) -> float:
    """A number > 0, or 0 for what is none."""
    if not isinstance(value, SupportsFloat):
        return 0.0
    try:
        number = float(value)
    except ZeroDivisionError:
        return 0.0
    return number if 0.0 < number < math.inf else 0.0


def _jpeg(data: bytes) -> JpegImageFile:
    from PIL.JpegImagePlugin import JpegImageFile

    return JpegImageFile(BytesIO(data))


def _upright(pixels: png.Codes, exif: Exif) -> png.Codes:
    turn = _TURNED.get(exif.get(_ORIENTATION))
    return pixels if turn is None else turn(pixels)


def _png_file(codes: NDArray[np.uint8]) -> bytes:
    """By OpenCV, which takes half the time, or else by Pillow."""
    cv2 = load_opencv()
    if cv2 is None:
        return png.compact(codes)
    return bytes(cv2.imencode(".png", cv2.cvtColor(codes, cv2.COLOR_RGB2BGR))[1])


def _jpeg_file(codes: NDArray[np.uint8]) -> bytes:
    from PIL import Image

    stream = BytesIO()
    Image.fromarray(codes).save(stream, "JPEG", quality=_QUALITY, subsampling=0)
    return stream.getvalue()


WRITERS: dict[str, Callable[[NDArray[np.uint8]], bytes]] = {
    ".png": _png_file,
    ".jpg": _jpeg_file,
    ".jpeg": _jpeg_file,
}
"""Ending of a file to what encodes 8-bit codes, shape (H, W, 3), for it."""
