"""A lean SVG renderer of matplotlib: few bytes, the same on every machine, colours of the page.

In: what matplotlib's artists draw. Out: the inside of an ``<svg>``, its extent, and the labels with
their boxes. It differs from ``backend_svg``: numbers have two digits, neighbouring strokes of one
style become one path, letters are outlines in whole fiftieths of a point kept a glyph each, inks of
the house are CSS variables, nothing has an id but odd clips and hatches, the picture is as large as
what was drawn. Warm it takes 2 to 5 ms a figure where ``backend_svg`` takes 10 to 55.

Text is outlines, as a page, Typst and Anki have different fonts and would break the layout.
"""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from hashlib import sha256
from html import escape
from importlib.util import find_spec
from math import ceil, cos, floor, inf, radians, sin
from pathlib import Path as FilePath
from struct import pack
from typing import Any
from zlib import adler32, crc32

import msgspec
import numpy as np
from matplotlib import _path as _untyped_path
from matplotlib._text_helpers import layout
from matplotlib.backend_bases import RendererBase
from matplotlib.colors import to_hex
from matplotlib.font_manager import FontProperties, findfont, get_font
from matplotlib.ft2font import Kerning, LoadFlags
from matplotlib.mathtext import MathTextParser
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Bbox
from numpy.typing import NDArray

import quizgen.figures.font_list  # noqa: F401 - before all that sets text
from quizgen.core.errors import BankError
from quizgen.figures.inks import PAINTS

FINE = 50
"""Steps of an outline in a point."""
LARGEST = 1200.0
"""Points: a picture that is wider or higher has something far outside."""
_path: Any = _untyped_path
_open_font: Any = get_font
_COMMANDS = [b"M", b"L", b"Q", b"C", b"z"]
# Moves everything by less than anybody sees, so that no number lies halfway between two roundings
# and falls to either side with the last bit of another processor.
_OFF_TIES = 1e-7
_SEAM = 0.5  # width of a line that closes the seam between two areas of a mesh
_EM = 100  # size in points that letters are measured at
_SUBSCRIPT = 0.7  # how large mathtext sets an index


class Label(msgspec.Struct, frozen=True):
    """A text in a figure: its words, its smallest letters and its box, in points from above.

    ``angle`` is what it is turned by, in degrees counterclockwise.
    """

    text: str
    size: float
    left: float
    top: float
    right: float
    bottom: float
    angle: float = 0.0


class Drawing(msgspec.Struct, frozen=True):
    """A drawing before it is described: the elements of an ``<svg>``, its view box and labels."""

    body: str
    width: float
    height: float
    origin: tuple[float, float]
    labels: tuple[Label, ...]
    outside: int
    unnamed_axes: int


_SENTENCE = re.compile(r"(?<=[.।])\s+")


def write_svg(drawing: Drawing, alt: str, lang: str) -> bytes:
    """Return a drawing as one ``<svg>``, described in a language.

    The first sentence of ``alt`` is its title, which a screen reader says at once; the rest is its
    description.
    """
    title, *rest = _SENTENCE.split(alt.strip(), maxsplit=1)
    words = f"<title>{escape(title, quote=False)}</title>"
    words += "".join(f"<desc>{escape(text, quote=False)}</desc>" for text in rest)
    wide, high, (left, top) = drawing.width, drawing.height, drawing.origin
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide:g}pt" height="{high:g}pt"'
        f' viewBox="{left:g} {top:g} {wide:g} {high:g}" role="img" lang="{escape(lang)}"'
        f' fill="none" stroke-linejoin="round">{words}{drawing.body}</svg>'
    ).encode()


# Letters


@lru_cache(64)
def house_font(size: float) -> FontProperties:
    """Return the font of labels in a size (points); it is shared, so nobody may change it."""
    return FontProperties(family="STIXGeneral", size=size)


def _format_step(dx: int, dy: int) -> str:
    """Return a relative line of an SVG path, as short as possible."""
    return f"{dx}{dy}" if dy < 0 else f"{dx} {dy}"


@lru_cache(16384)
def _load_glyph_outline(file: str, index: int, size: float) -> tuple[int, int, str] | None:
    """Return where a glyph's outline starts (x, y) and its relative path; None without ink.

    All in steps of the SVG's grid, at a font size in points.
    """
    font = _open_font(file)
    font.set_size(_EM, 72)
    font.load_glyph(index, flags=LoadFlags.NO_HINTING)
    vertices, codes = font.get_path()
    if not len(codes):
        return None
    scale = size / _EM * FINE * np.array([1, -1])
    points = [(int(x), int(y)) for x, y in np.rint(vertices * scale + _OFF_TIES)]
    first = start = at = points[0]
    commands, place = [], 1
    while place < len(points):
        code = codes[place]
        if code == Path.CLOSEPOLY:
            commands.append("z")
            at, place = start, place + 1
            continue
        count = {Path.MOVETO: 1, Path.LINETO: 1, Path.CURVE3: 2, Path.CURVE4: 3}[code]
        steps = [_format_step(x - at[0], y - at[1]) for x, y in points[place : place + count]]
        spaced = [s if s[0] == "-" or not i else f" {s}" for i, s in enumerate(steps)]
        commands.append(" mlqc"[code] + "".join(spaced))
        at, place = points[place + count - 1], place + count
        start = at if code == Path.MOVETO else start
    return *first, "".join(commands)


_MATHTEXT: Any = MathTextParser("path")
_PRIME_WITH_INDEX = re.compile(r"'_(?:\{([^}]*)\}|(\w))")

# file, glyph, size as a share, x and y of its origin, all at the size of _EM
_Glyph = tuple[str, int, float, float, float]


@dataclass(frozen=True, slots=True)
class _TextRun:
    """A piece of a label at the size of ``_EM``: width, height, depth, glyphs and bars."""

    width: float
    height: float
    depth: float
    glyphs: list[_Glyph]
    bars: list[tuple[float, float, float, float]]


@lru_cache(4096)
def _lay_out_formula(text: str, font: FontProperties) -> _TextRun:
    """Return a formula laid out by matplotlib's mathtext."""
    font = font.copy()
    font.set_size(_EM)
    # Its own prime is tiny, and pushes an index away; a real one has the index below it.
    text = _PRIME_WITH_INDEX.sub(r"'_{\\!\1\2}", text).replace("'", "\u2032")
    width, height, depth, glyphs, bars = _MATHTEXT.parse(text, 72, font)
    found = [(face.fname, index, size / _EM, x, y) for face, size, _, index, x, y in glyphs]
    return _TextRun(width, height - depth, depth, found, bars)


@lru_cache(2048)
def _load_glyph_metrics(file: str, character: str) -> tuple[int, float]:
    """Return glyph index and advance width of a character."""
    font = _open_font(file)
    font.set_size(_EM, 72)
    found = font.load_char(ord(character), flags=LoadFlags.NO_HINTING)
    return font.get_char_index(ord(character)), found.linearHoriAdvance / 65536


@lru_cache(8192)
def _load_kerning(file: str, left: int, right: int) -> float:
    """Return the kerning between two glyphs of a font."""
    font = _open_font(file)
    font.set_size(_EM, 72)
    return font.get_kerning(left, right, Kerning.UNFITTED) / 64


# Latin, Greek, Cyrillic and signs stand side by side; other scripts join and reorder letters.
_SIMPLE = re.compile(
    "[ -~\u00a0-\u024f\u0370-\u04ff\u2010-\u2044\u2070-\u209c\u2190-\u22ff]*"
).fullmatch
_HEIGHT = 66.0  # of capitals and digits at the size of _EM


@lru_cache(4096)
def _lay_out_words(text: str, font: FontProperties) -> _TextRun:
    """Return words laid out with kerning; joining scripts go to `_shape_words`."""
    file = findfont(font)
    if not _SIMPLE(text):
        return _shape_words(text, str(file))
    x, before, glyphs = 0.0, 0, list[_Glyph]()
    for character in text:
        index, width = _load_glyph_metrics(file, character)
        x += _load_kerning(file, before, index) if before else 0.0
        glyphs.append((file, index, 1.0, x, 0.0))
        before, x = index, x + width
    return _TextRun(x, _HEIGHT, 0.0, glyphs, [])


@cache
def _bangla_font() -> str:
    """Return the file of Hind Siliguri, as matplotlib brings no Bangla letters."""
    spec = find_spec("fontpkg_hind_siliguri")
    places = spec.submodule_search_locations if spec else None
    for folder in places or ():
        return str(next(FilePath(folder).rglob("*Regular*.ttf")))
    raise BankError("font package 'fontpkg_hind_siliguri' is not installed; reinstall quizgen")


def _shape_words(text: str, file: str) -> _TextRun:
    """Return words of a script whose letters join, shaped by HarfBuzz."""
    font = _open_font((file, _bangla_font()))
    font.set_size(_EM, 72)
    items: Any = list(layout(text, font))
    glyphs = [(i.ft_object.fname, i.glyph_index, 1.0, i.x, i.y) for i in items]
    font.set_text(text, 0.0, flags=LoadFlags.NO_HINTING)
    return _TextRun(font.get_width_height()[0] / 64, _HEIGHT, 0.0, glyphs, [])


_POINT = re.compile(r"(?<=\d)\.(?=\d)")
_FORMULA = re.compile(r"(?<!\\)(\$[^$]+\$)")


class LabelShape:
    """A line of text laid out: size in points, and outlines relative to its baseline's start.

    Formulas and words of a label are laid out apart, so that each stays kept when the other
    changes: ``$z'$ = 66.67 mm`` parses ``$z'$`` once in a process.
    """

    __slots__ = ("data", "depth", "height", "least", "width")

    def __init__(self, text: str, font: FontProperties, size: float) -> None:
        x, height, depth, least = 0.0, _HEIGHT, 0.0, 1.0
        scale, outlines = size / _EM, []
        for part in filter(None, _FORMULA.split(text)):
            if is_formula := part[0] == "$" == part[-1] and len(part) > 2:
                run = _lay_out_formula(part, font)
            else:
                run = _lay_out_words(part.replace(r"\$", "$"), font)
            for file, index, share, dx, dy in run.glyphs:
                least = min(least, share) if is_formula else least
                if found := _load_glyph_outline(file, index, share * size):
                    left = round((x + dx) * scale * FINE) + found[0]
                    top = round(-dy * scale * FINE) + found[1]
                    outlines.append(f"M{_format_step(left, top)}{found[2]}")
            for dx, dy, wide, high in run.bars:
                box = [round(v * scale * FINE) for v in (x + dx, -dy - high, wide, high)]
                outlines.append(f"M{_format_step(*box[:2])}h{box[2]}v{max(box[3], 1)}h{-box[2]}z")
            x += run.width
            if is_formula and run.depth > 30:
                height, depth = max(height, run.height), max(depth, run.depth)
        self.width, self.height, self.depth = (float(v * scale) for v in (x, height, depth))
        self.least = max(least, _SUBSCRIPT**2) * size
        self.data = "".join(outlines)


@lru_cache(4096)
def shape_label(text: str, font: FontProperties, size: float) -> LabelShape:
    """Return a line of text laid out; formulas stand between dollar signs."""
    return LabelShape(text, font, size)


# Drawing


@lru_cache(1024)
def write_paint(colour: tuple[float, ...], attribute: str) -> str:
    """Return an SVG attribute for a colour.

    One of quizgen's inks becomes a variable of the page.
    """
    found = to_hex((colour[0], colour[1], colour[2]))
    text = f' {attribute}="{PAINTS.get(found, found)}"'
    opaque = len(colour) < 4 or colour[3] >= 1
    return text if opaque else f'{text} {attribute}-opacity="{colour[3]:.3g}"'


class SvgRenderer(RendererBase):
    """A renderer of matplotlib that collects SVG elements.

    Parameters
    ----------
    height : float
        Of the figure in points; matplotlib counts from below, SVG from above.
    decimal : str
        Decimal sign of the language.
    """

    def __init__(self, height: float, decimal: str = ".") -> None:
        super().__init__()
        self.height, self.decimal = height, decimal
        self.flip = Affine2D().scale(1, -1).translate(_OFF_TIES, height + _OFF_TIES)
        self.labels: list[Label] = []
        self.outside = 0  # markers that fall outside their axes, and so are not drawn
        self.unnamed_axes = 0  # that have numbers, and nothing that says of what
        self._elements: list[str] = []
        self._parts: list[str] = []
        self._defined = set[str]()  # ids
        self._style: tuple[str, str] | None = None
        self._run: list[str] = []
        self._left, self._top, self._right, self._foot = inf, inf, -inf, -inf

    # What matplotlib asks of a renderer

    def get_canvas_width_height(self) -> tuple[float, float]:
        """Return the size of the canvas in points; matplotlib asks for it."""
        return 1e4, self.height

    def points_to_pixels(self, points: Any) -> Any:
        """Return points as they are: this renderer's pixels are points."""
        return points

    def option_image_nocomposite(self) -> bool:
        """Return True: matplotlib must not merge several pictures into one."""
        return True

    def option_scale_image(self) -> bool:
        """Return True: pictures are scaled by their viewer and never resampled."""
        return True

    def open_group(self, s: str, gid: str | None = None) -> None:
        """Name what follows: the ``gid`` of an artist becomes ``data-part``."""
        self._parts.append(escape(gid) if gid else self._parts[-1] if self._parts else "")

    def close_group(self, s: str) -> None:
        """End a named group."""
        self._parts.pop()

    def get_text_width_height_descent(self, s: str, prop: Any, ismath: Any) -> Any:
        """Return width, height and depth of a text in points."""
        shape = self._shape_text(s, prop)
        return shape.width, shape.height + shape.depth, shape.depth

    # Paths

    def draw_path(self, gc: Any, path: Path, transform: Any, rgbFace: Any = None) -> None:  # noqa: N803
        """Add a path; equal styles in a row share one element."""
        filled = rgbFace is not None and (len(rgbFace) < 4 or rgbFace[3] > 0)
        width = gc.get_linewidth()
        stroked = width > 0 and gc.get_rgb()[3] > 0
        if not (filled or stroked or gc.get_hatch()) or not len(np.asarray(path.vertices)):
            return
        transform = transform + self.flip
        points = transform.transform(path.vertices)
        if path.codes is not None:
            points = points[path.codes != Path.CLOSEPOLY]
        points = points[np.isfinite(points).all(axis=1)]
        if not len(points):
            return
        low, high = points.min(axis=0), points.max(axis=0)
        clip = None
        sides = self._clip_rectangle(gc)
        if sides is not None and ((low < sides[0] - 0.05).any() or (high > sides[1] + 0.05).any()):
            low, high = np.maximum(low, sides[0]), np.minimum(high, sides[1])
            if (low > high).any():
                return
            path, transform = _clip_path_to_box(path, transform, Bbox(sides), filled=filled)
            clip = None if filled else tuple(sides.ravel())
        half = width / 2 if stroked else 0
        self._extend_bounds(*(low - half).tolist(), *(high + half).tolist())
        simple = clip is not None or (path.should_simplify and not filled)
        data = _path.convert_to_string(path, transform, clip, simple, None, 2, _COMMANDS, False)
        data = data.decode("ascii")
        if "Q" not in data and "C" not in data:
            data = data.replace("\nL", "")  # after a move SVG takes more points as lines
        data = data.replace(" \n", "").replace("\n", "")
        paint = write_paint(_apply_alpha(gc, rgbFace), "fill") if filled else ""
        self._add_path_data(
            gc, data, paint + self._write_stroke(gc, width, stroked=stroked), join=not filled
        )
        if gc.get_hatch():
            self._fill_with_hatch(gc, data)

    def draw_path_collection(
        self, gc: Any, master_transform: Any, paths: Any, all_transforms: Any, offsets: Any,
        offset_trans: Any, facecolors: Any, edgecolors: Any, linewidths: Any, linestyles: Any,
        *args: Any, **kwargs: Any,
    ) -> None:  # fmt: skip
        """Add many paths; lines that look alike become one path.

        All else goes matplotlib's usual way.
        """
        styles = max(map(len, (edgecolors, linewidths, linestyles)))
        moved = len(all_transforms) or len(offsets) > 1 or np.any(offsets)
        if styles > 1 or len(facecolors) or moved or len(paths) < 2:
            super().draw_path_collection(
                gc, master_transform, paths, all_transforms, offsets, offset_trans, facecolors,
                edgecolors, linewidths, linestyles, *args, **kwargs,
            )  # fmt: skip
            return
        gc.set_foreground(edgecolors[0], isRGBA=True)
        gc.set_linewidth(linewidths[0])
        gc.set_dashes(*linestyles[0])
        self.draw_path(gc, Path.make_compound_path(*paths), master_transform)

    def draw_markers(
        self, gc: Any, marker_path: Path, marker_trans: Any, path: Path, trans: Any,
        rgbFace: Any = None,  # noqa: N803
    ) -> None:  # fmt: skip
        """Add all markers of a line as one path; those outside the axes are only counted."""
        shape = marker_trans.transform_path(marker_path)
        places = trans.transform(path.vertices)
        places = places[np.isfinite(places).all(axis=1)]
        box = gc.get_clip_rectangle()
        if box is not None:
            inside = ((places > box.min - 0.01) & (places < box.max + 0.01)).all(axis=1)
            self.outside += int((~inside).sum())
            places = places[inside]
        if not len(places):
            return
        codes = shape.codes
        if codes is None:
            codes = np.full(len(shape.vertices), Path.LINETO, np.uint8)
            codes[0] = Path.MOVETO
        points = (places[:, None] + shape.vertices).reshape(-1, 2)
        gc.set_clip_rectangle(None)
        self.draw_path(gc, Path(points, np.tile(codes, len(places))), Affine2D(), rgbFace)
        gc.set_clip_rectangle(box)

    def draw_quad_mesh(self, gc: Any, *args: Any) -> None:
        """Add the cells of a mesh.

        Those without edges get thin ones of their own colour: viewers would show seams.
        """
        *others, edgecolors = args
        if not len(edgecolors):
            gc.set_linewidth(_SEAM)
        draw: Any = super().draw_quad_mesh  # its stub lacks arguments
        draw(gc, *others, edgecolors if len(edgecolors) else None)

    def draw_gouraud_triangles(
        self, gc: Any, triangles_array: Any, colors_array: Any, transform: Any
    ) -> None:
        """Add each triangle filled with its corners' mean, as SVG has no such shading."""
        gc.set_linewidth(_SEAM)
        for corners, colours in zip(triangles_array, colors_array, strict=True):
            colour = tuple(colours.mean(axis=0))
            gc.set_foreground(colour, isRGBA=True)
            self.draw_path(gc, Path(corners, closed=False), transform, colour)

    def _clip_rectangle(self, gc: Any) -> Any:
        """Return left, top, right and foot of the clipping rectangle; None without one."""
        box = gc.get_clip_rectangle()
        if box is None:
            return None
        return np.array([[box.x0, self.height - box.y1], [box.x1, self.height - box.y0]])

    def _write_stroke(self, gc: Any, width: float, *, stroked: bool) -> str:
        """Return the SVG attributes of a line; ``width`` is in points."""
        if not stroked:
            return ""
        text = write_paint(tuple(gc.get_rgb()), "stroke")
        text += "" if width == 1 else f' stroke-width="{width:.3g}"'
        offset, dashes = gc.get_dashes()
        if dashes is not None and len(dashes):
            text += f' stroke-dasharray="{" ".join(f"{d:.3g}" for d in dashes)}"'
            text += f' stroke-dashoffset="{offset:.3g}"' if offset else ""
        cap, join = gc.get_capstyle(), gc.get_joinstyle()
        if cap != "butt":
            text += f' stroke-linecap="{"square" if cap == "projecting" else cap}"'
        return text + ("" if join == "round" else f' stroke-linejoin="{join}"')

    def _fill_with_hatch(self, gc: Any, data: str) -> None:
        """Add a shape filled with a pattern, whose id is a digest of it."""
        from matplotlib.hatch import get_path

        size, lines = 12, get_path(gc.get_hatch(), 1)
        scaled = Affine2D().scale(size)
        found = _path.convert_to_string(lines, scaled, None, False, None, 2, _COMMANDS, False)
        stroke = found.decode("ascii").replace("\n", "")
        ink = write_paint(tuple(gc.get_hatch_color()), "stroke")
        ink += f' stroke-width="{gc.get_hatch_linewidth():g}"'
        shape = f'width="{size}" height="{size}" patternUnits="userSpaceOnUse"'
        name = self._define_element("pattern", f'<path d="{stroke}"{ink}/>', shape)
        self._add_path_data(gc, data, f' fill="url(#{name})"', join=False)

    def _define_element(self, tag: str, inside: str, attributes: str = "") -> str:
        """Add an element to the definitions once, and return its id, a digest of its content."""
        name = tag[0] + sha256(inside.encode()).hexdigest()[:8]
        if name not in self._defined:
            self._defined.add(name)
            self._flush_path()
            start = f'{tag} id="{name}" {attributes}'.strip()
            self._elements.append(f"<{start}>{inside}</{tag}>")
        return name

    def _add_path_data(self, gc: Any, data: str, style: str, *, join: bool) -> None:
        """Add path data in a style, to the last element if ``join`` and both look the same."""
        key = (self._parts[-1] if self._parts else "", style + self._write_clip(gc))
        if key != self._style or not join:
            self._flush_path()
            self._style = key
        self._run.append(data)

    def _write_clip(self, gc: Any) -> str:
        """Return the attribute for a clip that is no rectangle; its id is a digest of it."""
        shape, transform = gc.get_clip_path()
        if shape is None:
            return ""
        whole = transform + self.flip
        found = _path.convert_to_string(shape, whole, None, False, None, 2, _COMMANDS, False)
        outline = found.decode("ascii").replace("\n", "")
        name = self._define_element("clipPath", f'<path d="{outline}"/>')
        return f' clip-path="url(#{name})"'

    def _flush_path(self) -> None:
        """Write the element that path data was added to."""
        if self._run and self._style:
            name = f' data-part="{self._style[0]}"' if self._style[0] else ""
            self._elements.append(f'<path{name} d="{"".join(self._run)}"{self._style[1]}/>')
        self._run, self._style = [], None

    def _extend_bounds(self, left: float, top: float, right: float, foot: float) -> None:
        """Extend the view box; plain numbers, as this runs for everything drawn."""
        self._left, self._top = min(self._left, left), min(self._top, top)
        self._right, self._foot = max(self._right, right), max(self._foot, foot)

    # Labels and pictures

    def _shape_text(self, text: str, font: Any) -> LabelShape:
        """Return a text laid out in a font of matplotlib."""
        return shape_label(self._localise_label(text), font, font.get_size_in_points())

    def _localise_label(self, text: str) -> str:
        """Return a label with the decimal sign of the language.

        A comma in a formula is braced, as a bare one would add space.
        """
        if self.decimal == ".":
            return text
        parts = _FORMULA.split(text)
        signs = (self.decimal, f"{{{self.decimal}}}")
        return "".join(_POINT.sub(signs[i % 2], part) for i, part in enumerate(parts))

    def draw_text(
        self, gc: Any, x: float, y: float, s: str, prop: Any, angle: float, ismath: Any = False,
        mtext: Any = None,
    ) -> None:  # fmt: skip
        """Add a label at (x, y) in points, turned by degrees."""
        shape = self._shape_text(s, prop)
        if not shape.data:
            return
        left, top, right, foot = _turn_box(shape, float(x), float(y), float(angle))
        self._extend_bounds(left, top, right, foot + 0.2 * shape.height)  # room for g and y
        text = self._localise_label(s)
        self.labels.append(Label(text, shape.least, left, top, right, foot, float(angle)))
        self._flush_path()
        name = self._parts[-1] if self._parts and self._parts[-1] else "labels"
        turn = f"rotate({round(-angle, 2):g})" if angle else ""
        self._elements.append(
            f'<path data-part="{name}"'
            f' transform="translate({x + _OFF_TIES:.2f} {y + _OFF_TIES:.2f}){turn}'
            f'scale({1 / FINE:g})" d="{shape.data}"{write_paint(tuple(gc.get_rgb()), "fill")}/>'
        )

    def draw_image(
        self, gc: Any, x: float, y: float, im: Any, transform: Any = None, palette: Any = None
    ) -> None:
        """Add pixels, shape (H, W, 4), last row first; with a palette, (H, W) of its indices."""
        if im.size == 0:
            return
        high, wide = im.shape[:2]
        self._flush_path()
        placed = Affine2D().scale(1 / wide, 1 / high) + (transform or Affine2D().scale(wide, high))
        placed += Affine2D().translate(x, y) + self.flip
        corners = placed.transform([(0, 0), (wide, 0), (0, high), (wide, high)])
        low, top = corners.min(axis=0), corners.max(axis=0)
        (x0, y0), (x1, y1) = corners[0], corners[3]
        w, h = top - low
        clip = self._write_clip(gc) or self._clip_image(gc, low, top)
        more = ""
        if w > 1.5 * wide:
            more += ' style="image-rendering:pixelated"'  # Typst knows no such attribute
        if transform is not None and gc.get_alpha() != 1:  # else it is in the pixels
            more += f' opacity="{gc.get_alpha():.3g}"'
        if np.abs(corners[1] - corners[0])[1] < 0.01 > np.abs(corners[2] - corners[0])[0]:
            im = im[:: 1 if y1 >= y0 else -1, :: 1 if x1 >= x0 else -1]
            place = f'x="{low[0]:.2f}" y="{low[1]:.2f}" width="{w:.2f}" height="{h:.2f}"'
        else:
            numbers = (*(corners[1] - corners[0]), *(corners[2] - corners[0]), x0, y0)
            matrix = " ".join(f"{number:.2f}" for number in numbers)
            place = f'width="1" height="1" transform="matrix({matrix})"'
        file = b64encode(_write_png(im, palette)).decode()
        name = self._parts[-1] if self._parts else ""
        image = (
            f'<image data-part="{name}" {place} preserveAspectRatio="none"{more}'
            f' href="data:image/png;base64,{file}"/>'
        )
        # Around it: its own transform would move the clip, too.
        self._elements.append(f"<g{clip}>{image}</g>" if clip else image)

    def _clip_image(self, gc: Any, low: Any, top: Any) -> str:
        """Return the attribute for a picture that reaches out of its axes.

        Others extend the view.
        """
        sides = self._clip_rectangle(gc)
        if sides is not None and ((low < sides[0] - 0.05).any() or (top > sides[1] + 0.05).any()):
            self._extend_bounds(
                *np.maximum(low, sides[0]).tolist(), *np.minimum(top, sides[1]).tolist()
            )
            (x, y), (w, h) = sides[0], sides[1] - sides[0]
            box = f'<rect x="{x:.2f}" y="{y:.2f}" width="{w:.2f}" height="{h:.2f}"/>'
            return f' clip-path="url(#{self._define_element("clipPath", box)})"'
        self._extend_bounds(*low.tolist(), *top.tolist())
        return ""

    def write(self, size: tuple[float, float] | None = None) -> Drawing:
        """Return the drawing, as large as its ink or of a fixed size in points.

        Raises
        ------
        BankError
            If nothing is drawn, or something far outside.
        """
        self._flush_path()
        if size is None and self._left > self._right:
            raise BankError("the figure is empty: draw() draws nothing")
        pad = 2.0
        left, top, right, foot = 0.0, 0.0, *(size or (0.0, 0.0))
        if size is None:
            left, top = floor(self._left - pad), floor(self._top - pad)
            right, foot = ceil(self._right + pad), ceil(self._foot + pad)
        wide, high = right - left, foot - top
        if max(wide, high) > LARGEST:
            raise BankError(
                f"something is drawn far outside: the picture would be {wide:g} by {high:g} pt"
            )
        body = "".join(self._elements)
        counted = self.outside, self.unnamed_axes
        return Drawing(body, wide, high, (left, top), tuple(self.labels), *counted)


def _turn_box(
    shape: LabelShape, x: float, y: float, angle: float
) -> tuple[float, float, float, float]:
    """Return left, top, right and foot of a label turned by degrees about its start."""
    if not angle:
        return x, y - shape.height, x + shape.width, y + shape.depth
    c, s = cos(radians(angle)), sin(radians(angle))
    corners = [(a, b) for a in (0.0, shape.width) for b in (-shape.depth, shape.height)]
    across = [x + a * c - b * s for a, b in corners]
    down = [y - a * s - b * c for a, b in corners]
    return min(across), min(down), max(across), max(down)


def _clip_path_to_box(path: Path, transform: Any, box: Bbox, *, filled: bool) -> tuple[Path, Any]:
    """Return a path that leaves a box: areas cut, curves as lines, which are cut when written."""
    if filled:
        return transform.transform_path(path).clip_to_bbox(box), Affine2D()
    if path.codes is not None and (np.asarray(path.codes) > Path.LINETO).any():
        lines = transform.transform_path(path).to_polygons(closed_only=False)
        return Path.make_compound_path(*map(Path, lines)), Affine2D()
    return path, transform


def _apply_alpha(gc: Any, colour: Any) -> tuple[float, ...]:
    """Return a fill colour with the opacity that its artist forces on everything."""
    if gc.get_forced_alpha():
        return (*colour[:3], gc.get_alpha())
    return tuple(colour)


def _write_png(pixels: Any, palette: Any = None) -> bytes:
    """Return a PNG file independent of the version of zlib; few colours become a palette.

    ``pixels`` have shape (H, W, 4), or (H, W) with a palette of (red, green, blue), 0 to 255.
    """
    if palette is not None:
        return encode_png(pixels, [(int(r), int(g), int(b)) for r, g, b in palette])
    pixels = np.ascontiguousarray(pixels)
    if (pixels[..., 3] < 255).any():
        return encode_png(pixels)
    rgb = np.ascontiguousarray(pixels[..., :3])
    return _encode_colours(rgb.shape, rgb.tobytes())


@lru_cache(64)
def _encode_colours(shape: tuple[int, ...], data: bytes) -> bytes:
    """Return a PNG file, cached: a question and its solution show the same photographs."""
    rgb = np.frombuffer(data, np.uint8).reshape(shape)
    codes = rgb.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)
    ordered = np.sort(codes, axis=None)  # a tenth of the time of unique()
    if np.count_nonzero(np.diff(ordered)) > 255 or (rgb[..., :1] == rgb).all():
        return encode_png(rgb)
    known, indices = np.unique(codes, return_inverse=True)
    colours = [(int(c) >> 16, int(c) >> 8 & 255, int(c) & 255) for c in known]
    return encode_png(indices.reshape(codes.shape).astype(np.uint8), colours)


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
    """Return a PNG file of filtered rows; ``kind`` is its colour type, ``chunks`` precede them."""
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
    """Return one chunk of a PNG file: length, name, content and checksum."""
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
    """Return the bits of a byte and its repeats; runs too short for a length are written out."""
    full, left = divmod(repeats, _LONGEST)
    rest = _repeat_bits(left) if left >= _SHORTEST else _symbol_bits(byte) * left
    return _symbol_bits(byte) + _repeat_bits(_LONGEST) * full + rest


def _repeat_bits(length: int) -> str:
    """Return the bits that repeat the last byte 3 to 258 times."""
    code = max(i for i, base in enumerate(_LENGTH_BASE) if base <= length)
    bits = _LENGTH_BITS[code]
    extra = f"{length - _LENGTH_BASE[code]:0{bits}b}"[::-1] if bits else ""
    return _symbol_bits(257 + code) + extra + _DISTANCE_ONE


def _symbol_bits(code: int) -> str:
    """Return the bits of a literal or length symbol in deflate's fixed table, in writing order."""
    if code < 144:
        return f"{0x30 + code:08b}"
    if code < 256:
        return f"{0x190 + code - 144:09b}"
    return f"{code - 256:07b}" if code < 280 else f"{0xC0 + code - 280:08b}"
