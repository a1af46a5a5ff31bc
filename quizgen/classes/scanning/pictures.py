"""Files of a scanner or a phone as grey pictures, one at a time.

A file that cannot be read is a ``ScanFileError`` with its name; what would not fit into memory is
refused before it is unpacked.
"""

from __future__ import annotations

import hashlib
import math
import stat
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from quizgen.core.errors import ClassError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

SUFFIXES = (".pdf", ".jpg", ".jpeg", ".png", ".tif", ".tiff", ".webp", ".bmp")
FORMATS = ("JPEG", "PNG", "TIFF", "WEBP", "BMP")
MOST_PIXELS = 120_000_000
"""Of a picture in a file: more is no scan of a page."""
MOST_PAGES = 20_000
SHARP = 8.0
"""Pixels a millimetre at which pages of a PDF file are drawn: 203 dpi."""
LONGEST = 3600
"""Pixels of the longer side of a picture that is worked with; larger ones are made smaller."""
FEWEST_GREYS = 0.03
"""Of a picture that is black and white alone: pixels between, for each dark one."""


_PDFIUM = RLock()
"""Held while a PDF file is open: pdfium must not be used by two threads at a time."""


class ScanFileError(ClassError):
    """A file of a scanner cannot be read."""


class ScannedPicture(NamedTuple):
    """A picture in grey, 0 is black, and whether it has no greys: light pencil is not in it."""

    grey: NDArray[np.uint8]
    bilevel: bool


def compute_file_digest(path: Path) -> str:
    """Return 16 hexadecimal digits of what a file holds.

    Raises
    ------
    ScanFileError
        If it is no file that can be read.
    """
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise ScanFileError("is no file", rule="QG610", file=path)
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()[:16]
    except OSError as error:
        raise ScanFileError(f"{error.strerror}", rule="QG610", file=path) from None


def count_pictures(path: Path) -> int:
    """Return how many pages a file has.

    Raises
    ------
    ScanFileError
        If it is none that can be read.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        said = f"is no picture of a page ({', '.join(SUFFIXES)})"
        raise ScanFileError(said, rule="QG610", file=path)
    if suffix == ".pdf":
        with open_pdf(path) as document:
            count = len(document)
    else:
        with _open_image(path) as image:
            count = image.n_frames if image.format == "TIFF" else 1
    if not 0 < count <= MOST_PAGES:
        raise ScanFileError(f"has {count} pages", rule="QG610", file=path)
    return count


def iter_pictures(
    path: Path, numbers: Sequence[int]
) -> Iterator[tuple[int, ScannedPicture | ScanFileError]]:
    """Yield the pages of a file by their numbers from 0, each as a picture or why it is none.

    Raises
    ------
    ScanFileError
        If the file cannot be read at all.
    """
    if path.suffix.lower() == ".pdf":
        with open_pdf(path) as document:
            for number in numbers:
                yield number, _try_picture(path, lambda n=number: _draw_page(document[n]))
        return
    with _open_image(path) as image:
        for number in numbers:
            yield number, _try_picture(path, lambda n=number: _decode_frame(image, n))


def _try_picture(path: Path, make: Any) -> ScannedPicture | ScanFileError:
    """Return a picture, or the error that says why there is none."""
    try:
        return make()
    except ScanFileError as error:
        error.file = path
        return error
    except (OSError, ValueError, SyntaxError, RuntimeError, EOFError, MemoryError) as error:
        what = str(error).strip() or type(error).__name__
        return ScanFileError(f"is damaged ({what[:100]})", rule="QG610", file=path)


@contextmanager
def open_pdf(path: Path) -> Iterator[Any]:
    """Give a PDF file as pdfium opens it.

    Raises
    ------
    ScanFileError
        If it is damaged or locked by a password.
    """
    import pypdfium2

    with _PDFIUM:
        try:
            document = pypdfium2.PdfDocument(path)
        except (pypdfium2.PdfiumError, OSError) as error:
            locked = "password" in str(error).lower() and not _is_opened(path)
            said = "is locked by a password" if locked else "is no sound PDF"
            raise ScanFileError(said, rule="QG610", file=path) from None
        try:
            yield document
        finally:
            document.close()


def _is_opened(path: Path) -> bool:
    """Return whether pdfium opens a file: of one without pages it says the error of another."""
    from pypdfium2 import raw

    document = raw.FPDF_LoadDocument(f"{path}\0".encode(errors="surrogateescape"), None)
    if document:
        raw.FPDF_CloseDocument(document)
    return bool(document)


def draw_blank_page(page: Any) -> NDArray[np.uint8]:
    """Return a printed page at ``SHARP``, as it is before anybody writes on it."""
    return _render_grey(page, SHARP * 25.4 / 72)


def _draw_page(page: Any) -> ScannedPicture:
    """Return a page of a PDF file as a picture."""
    from pypdfium2 import raw

    bilevel = False
    for one in page.get_objects(filter=[raw.FPDF_PAGEOBJ_IMAGE]):
        width, height = one.get_px_size()
        _check_size(width, height)
        about = one.get_metadata()
        bilevel = bilevel or (about.bits_per_pixel == 1 and width * height > 400_000)
    width, height = page.get_size()
    if not (0 < width < 1e5 and 0 < height < 1e5):
        raise ScanFileError("has a page without a size", rule="QG611")
    scale = min(SHARP * 25.4 / 72, LONGEST / max(width, height))
    grey = _render_grey(page, scale)
    return ScannedPicture(grey, bilevel)


def _render_grey(page: Any, scale: float) -> NDArray[np.uint8]:
    """Return a page in grey."""
    drawn = page.render(scale=scale, grayscale=True).to_numpy()
    return np.ascontiguousarray(drawn.reshape(drawn.shape[:2]))


@contextmanager
def _open_image(path: Path) -> Iterator[Any]:
    """Give a picture as Pillow opens it, not yet unpacked; ``ScanFileError`` if it is none."""
    from PIL import Image, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            image = Image.open(path, formats=FORMATS)
    except Image.DecompressionBombError:
        raise _describe_size_error(path) from None
    except UnidentifiedImageError:
        raise ScanFileError("is no sound picture", rule="QG610", file=path) from None
    except (OSError, ValueError, SyntaxError, RuntimeError, EOFError) as error:
        said = f"is damaged ({str(error)[:100]})"
        raise ScanFileError(said, rule="QG610", file=path) from None
    with image:
        yield image


def _decode_frame(image: Any, number: int) -> ScannedPicture:
    """Return one page of a picture file in grey, made smaller if it is large."""
    from PIL import Image

    image.seek(number)
    _check_size(*image.size)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if image.format in {"JPEG", "MPO"}:  # decodes grey alone, and large ones at half the size
            image.draft("L", (LONGEST // 2, LONGEST // 2))
        bilevel = image.mode == "1"
        if image.mode.startswith("I"):
            values = np.asarray(image)
            deep = values.max(initial=0) > 255
            grey = Image.fromarray((values // 256 if deep else values).astype(np.uint8))
        else:
            grey = image.convert("L")
    made = np.asarray(grey)
    bilevel = bilevel or has_no_greys(made)
    ratio = LONGEST / max(made.shape)
    if ratio < 1:
        import cv2

        size = (math.ceil(made.shape[1] * ratio), math.ceil(made.shape[0] * ratio))
        made = cv2.resize(made, size, interpolation=cv2.INTER_AREA)
    return ScannedPicture(np.ascontiguousarray(made), bilevel)


def has_no_greys(grey: NDArray[np.uint8]) -> bool:
    """Return whether a picture is black and white alone, as fax machines and some copiers make."""
    counts = np.bincount(grey[::2].ravel(), minlength=256)
    return bool(counts[64:192].sum() < FEWEST_GREYS * counts[:64].sum())


def _check_size(width: int, height: int) -> None:
    """Raise ``ScanFileError`` for a picture that is too large."""
    if width * height > MOST_PIXELS:
        raise _describe_size_error(None)


def _describe_size_error(path: Path | None) -> ScanFileError:
    """Return that a picture has too many pixels."""
    said = f"has a picture of more than {MOST_PIXELS // 10**6} million pixels"
    return ScanFileError(said, rule="QG611", file=path)
