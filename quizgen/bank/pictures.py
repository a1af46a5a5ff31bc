"""Pictures from files beside a template's words, made safe to show on any page.

A bank may be a stranger's, and a picture ends up in browsers, readers of cards and course systems:
PNG and JPEG are packed again, which drops places, names and whatever hides behind the pixels; of an
SVG stays what only draws.
"""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterator, Mapping
from functools import cached_property
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import msgspec

from quizgen.bank.compile_cache import CompileCache
from quizgen.bank.markdown import LanguageFile
from quizgen.core.errors import BankError
from quizgen.core.positions import TEXT
from quizgen.core.untrusted import is_identifier, read_bytes
from quizgen.typeset.prose import PictureLink, PlainText

if TYPE_CHECKING:
    from PIL.Image import Image

SUFFIXES = (".png", ".jpg", ".jpeg", ".svg")
"""What a file with a picture ends in."""
MOST_BYTES = 10_000_000
MOST_PIXELS = 40_000_000
FINEST = 1600
"""Pixels of the longer side that are kept: 240 to an inch across a page."""
LARGEST = (480.0, 340.0)
"""Width and height in points: no picture is shown larger, so that a page has room for its words."""
MOST_ELEMENTS = 20_000
DEEPEST = 50
"""Groups within each other."""
_DPI = 96  # of a file that names none


class PictureFile(msgspec.Struct, frozen=True, dict=True):
    """A picture that is safe to show.

    Parameters
    ----------
    data : bytes
        The file's content: packed again, or with nothing left in it that does more than draw.
    kind : str
        ``png``, ``jpeg`` or ``svg+xml``, as media types name them.
    width_pt, height_pt : float
        Natural size in points.
    """

    data: bytes
    kind: str
    width_pt: float
    height_pt: float

    @cached_property
    def file(self) -> str:
        """Return the file name of the picture, the same for the same picture."""
        return f"qg_{sha256(self.data).hexdigest()[:16]}.{self.kind.removesuffix('+xml')}"

    @property
    def uri(self) -> str:
        """Return the picture as a ``data:`` address, for pages that bring everything along."""
        return f"data:image/{self.kind};base64,{b64encode(self.data).decode()}"

    @property
    def svg(self) -> str:
        """Return the picture as an SVG, for Typst, which is given texts alone."""
        if self.kind == "svg+xml":
            return self.data.decode()
        wide, high = f"{self.width_pt:g}", f"{self.height_pt:g}"
        return (
            f'<svg xmlns="{_SVG}" width="{wide}pt" height="{high}pt" viewBox="0 0 {wide} {high}">'
            f'<image width="{wide}" height="{high}" href="{self.uri}"/></svg>'
        )


_PICTURES = CompileCache("pictures", PictureFile, "PIL")


def pictures_beside(folder: Path) -> list[Path]:
    """Return the picture files in a template's folder."""
    return sorted(path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES)


def read_pictures(folder: Path, texts: Mapping[str, LanguageFile]) -> dict[str, PictureFile]:
    """Return the pictures that the words of a template show, by file name.

    Parameters
    ----------
    folder : pathlib.Path
        Of the template.
    texts : mapping of str to LanguageFile
        Language to its words.

    Returns
    -------
    dict of str to PictureFile
        By the name that the words give.

    Raises
    ------
    BankError
        Naming the language's file, its line and what is wrong.
    """
    found: dict[str, PictureFile] = {}
    for lang, text in texts.items():
        for link in text.pictures:
            try:
                _check_words(link)
                if link.file not in found:
                    found[link.file] = read_picture(folder, link.file)
            except BankError as error:
                place = (TEXT, f"({link.file})")
                file = folder / f"{lang}.md"
                raise BankError(error.message, rule="QG156", file=file, place=place) from error
    return found


def _check_words(link: PictureLink) -> None:
    """Raise ``BankError`` if a picture has no description for those who cannot see it."""
    if not any(not isinstance(part, PlainText) or part.text.strip() for part in link.alt):
        raise BankError(
            f"picture {link.file!r} has no words: describe the picture in words for those who "
            f"cannot see it, ![words]({link.file})"
        )


def read_picture(folder: Path, name: str) -> PictureFile:
    """Return one picture file, made safe to show.

    Raises
    ------
    BankError
        If the name leads out of the folder, or the file is none that can be shown.
    """
    path = folder / name
    if not is_identifier(name) or path.suffix.lower() not in SUFFIXES:
        raise BankError(
            f"picture {name!r}: not the name of a file beside the words that ends in "
            f"{', '.join(SUFFIXES)} (letters A-Z, digits, '_', '.' and '-')"
        )
    if path.resolve().parent != folder.resolve():
        raise BankError(f"picture {name!r} is a link out of the folder; put the file itself there")
    if not path.is_file():
        there = ", ".join(one.name for one in pictures_beside(folder)) or "none"
        raise BankError(f"there is no picture {name!r} beside the words (there are {there})")
    data = read_bytes(path, BankError, MOST_BYTES)
    pack = _pack_svg if path.suffix.lower() == ".svg" else _pack_pixels
    try:
        return _PICTURES.get(data) or _PICTURES.store_compiled(pack(data), data)
    except BankError as error:
        raise BankError(f"picture {name!r}: {error.message}") from error


def _fit_picture(data: bytes, kind: str, width: float, height: float) -> PictureFile:
    """Return a picture in its natural size in points, made smaller to fit on a page."""
    if not 0 < min(width, height) <= max(width, height) < 1e6:
        raise BankError("its size is not positive")
    share = min(1.0, LARGEST[0] / width, LARGEST[1] / height)
    return PictureFile(data, kind, round(width * share, 2), round(height * share, 2))


# PNG and JPEG


def _pack_pixels(data: bytes) -> PictureFile:
    """Return a PNG or JPEG as a safe picture, in the size that its resolution gives.

    It is written anew: nothing survives but its pixels. Raises ``BankError`` if it is no such
    picture or has too many pixels.
    """
    from PIL import Image, ImageOps

    try:
        with Image.open(BytesIO(data), formats=("PNG", "JPEG")) as opened:
            if opened.width * opened.height > MOST_PIXELS:
                raise BankError(f"has more than {MOST_PIXELS // 10**6} million pixels")
            kind = "png" if opened.format == "PNG" else "jpeg"
            dpi = float(opened.info.get("dpi", (_DPI, _DPI))[0])
            picture = ImageOps.exif_transpose(opened)
            picture.load()
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise BankError(f"cannot be read as PNG or JPEG ({error})") from None
    to_points = 72 / (dpi if 30 <= dpi <= 2400 else _DPI)
    size = picture.width * to_points, picture.height * to_points
    return _fit_picture(_reencode_pixels(picture, kind), kind, *size)


def _reencode_pixels(picture: Image, kind: str) -> bytes:
    """Return the pixels as a file, no more of them than a page shows, and nothing else."""
    if kind == "jpeg" and picture.mode not in {"L", "RGB"}:
        picture = picture.convert("RGB")
    if max(picture.size) > FINEST:
        if picture.mode in {"1", "P", "I", "I;16"}:
            picture = picture.convert("RGBA" if picture.has_transparency_data else "RGB")
        picture.thumbnail((FINEST, FINEST))
    told = ("transparency",)  # which belongs to the pixels, where all else is about them
    picture.info = {name: picture.info[name] for name in told if name in picture.info}
    file = BytesIO()
    picture.save(file, kind, **({"quality": 90} if kind == "jpeg" else {}))
    return file.getvalue()


# SVG

_SVG = "http://www.w3.org/2000/svg"
_HREF = ("href", "{http://www.w3.org/1999/xlink}href")
_SPACE = "{http://www.w3.org/XML/1998/namespace}space"
_ELEMENTS = frozenset(
    "svg g defs symbol use switch path rect circle ellipse line polyline polygon text tspan "  # noqa: SIM905 - better read so
    "textPath title desc linearGradient radialGradient stop clipPath mask pattern marker image "
    "style".split()
)
_ATTRIBUTES = frozenset(
    "id class style x y x1 y1 x2 y2 cx cy r rx ry fx fy fr d points width height viewBox transform "  # noqa: SIM905
    "preserveAspectRatio gradientTransform gradientUnits spreadMethod offset patternUnits "
    "patternTransform patternContentUnits clipPathUnits maskUnits maskContentUnits markerWidth "
    "markerHeight markerUnits refX refY orient dx dy rotate textLength lengthAdjust startOffset "
    "fill fill-opacity fill-rule stroke stroke-width stroke-opacity stroke-linecap stroke-linejoin "
    "stroke-miterlimit stroke-dasharray stroke-dashoffset opacity color stop-color stop-opacity "
    "font-family font-size font-weight font-style font-variant text-anchor text-decoration "
    "dominant-baseline alignment-baseline baseline-shift letter-spacing word-spacing display "
    "visibility overflow clip-path clip-rule mask marker-start marker-mid marker-end "
    "vector-effect paint-order shape-rendering text-rendering image-rendering type".split()
)
_OWN_PLACE = re.compile(r"url\(\s*['\"]?#[\w.:-]+['\"]?\s*\)")
# What styles reach other files by, or hide such a thing with.
_REACHES_OUT = re.compile(r"url\(|image|import|expression|script:|@|\\|/\*|<", re.IGNORECASE)
_SHOWN_BY = re.compile(r"#[\w.:-]+").fullmatch
_INSIDE = re.compile(r"data:image/(?:png|jpeg);base64,[A-Za-z0-9+/=\s]+").fullmatch
_LENGTH = re.compile(r"\s*(\d*\.?\d+)(?:e0)?\s*(px|pt|mm|cm|in|pc)?\s*")
_POINTS = {"px": 0.75, "": 0.75, "pt": 1, "mm": 72 / 25.4, "cm": 720 / 25.4, "in": 72, "pc": 12}


def _pack_svg(data: bytes) -> PictureFile:
    """Return an SVG as a safe picture that holds only what draws.

    Raises ``BankError`` if it cannot be read, defines entities (a few lines of them unfold to
    gigabytes), or is too costly to draw.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise BankError("is not UTF-8; save it as UTF-8") from None
    if "<!ENTITY" in text:
        raise BankError("defines entities; save it as plain SVG")
    try:
        root = ET.fromstring(text)  # noqa: S314 - without entities
    except ET.ParseError as error:
        raise BankError(f"cannot be read as SVG ({error})") from None
    if root.tag != f"{{{_SVG}}}svg":
        raise BankError("cannot be read as SVG (its first element is no svg)")
    _check_cost(root)
    drawing = _copy_drawing(root, 0)
    width, height = _read_svg_size(root)
    drawing.attrib.setdefault("viewBox", f"0 0 {width / 0.75:g} {height / 0.75:g}")
    packed = _fit_picture(b"", "svg+xml", width, height)
    drawing.attrib |= {
        "xmlns": _SVG, "width": f"{packed.width_pt:g}pt", "height": f"{packed.height_pt:g}pt"
    }  # fmt: skip
    return msgspec.structs.replace(packed, data=ET.tostring(drawing))


def _check_cost(root: ET.Element) -> None:
    """Raise ``BankError`` for an SVG that is small to read and endless to draw."""
    if sum(1 for _ in root.iter()) > MOST_ELEMENTS:
        raise BankError(f"has more than {MOST_ELEMENTS} elements")
    uses = root.findall(f".//{{{_SVG}}}use")
    used = {use.get(name, "").removeprefix("#") for use in uses for name in _HREF} - {""}
    for element in root.iter():
        if element.get("id") in used and element.find(f".//{{{_SVG}}}use") is not None:
            raise BankError("uses a shape that uses shapes itself; save it as plain SVG")


def _copy_drawing(element: Any, depth: int) -> Any:
    """Return a copy of an element with only those of its children that draw."""
    if depth > DEEPEST:
        raise BankError(f"has more than {DEEPEST} groups within each other")
    name = element.tag.removeprefix(f"{{{_SVG}}}")
    made = ET.Element(name, dict(_iter_safe_attributes(element, name)))
    made.text, made.tail = element.text, element.tail
    for child in element:
        inside = isinstance(child.tag, str) and child.tag.removeprefix(f"{{{_SVG}}}")
        if inside in _ELEMENTS and (inside != "style" or _is_self_contained(child.text or "")):
            made.append(_copy_drawing(child, depth + 1))
    return made


def _iter_safe_attributes(element: Any, name: str) -> Iterator[tuple[str, str]]:
    """Yield the attributes that draw; one that refers outside the file is set to ``none``."""
    for key, value in element.attrib.items():
        if key in _HREF:
            if _SHOWN_BY(value) or (name == "image" and _INSIDE(value)):
                yield "href", value
        elif key in _ATTRIBUTES or key == _SPACE:
            yield key, value if _is_self_contained(value) else "none"


def _is_self_contained(style: str) -> bool:
    """Return whether a style refers to nothing outside its own file."""
    return not _REACHES_OUT.search(_OWN_PLACE.sub("", style))


def _read_svg_size(root: ET.Element) -> tuple[float, float]:
    """Return the natural size in points: what the file says, else its view box in CSS pixels."""
    found = [_LENGTH.fullmatch(root.get(name, "")) for name in ("width", "height")]
    if all(found):
        width, height = (float(one[1]) * _POINTS[one[2] or ""] for one in found if one)
        return width, height
    box = re.split(r"[\s,]+", root.get("viewBox", "").strip())
    try:
        _, _, width, height = map(float, box)
    except ValueError:
        raise BankError("says no size: give its svg a width and a height, or a viewBox") from None
    return width * 0.75, height * 0.75
