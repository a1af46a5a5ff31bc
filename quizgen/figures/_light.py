"""A figure in few bytes, for a file of its own: its labels are text, its photographs are packed.

It looks like ``Canvas.inside`` wherever there is a font as wide as Times, which labels are laid out
for; elsewhere each run of letters is squeezed into its room. Points lie on a grid as fine as a
fifteenth of a pixel of a page, and one that is not seen to bend its line is left out.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator, Sequence
from html import escape
from itertools import groupby, pairwise
from math import dist
from typing import TYPE_CHECKING, NamedTuple

from quizgen.figures._bends import Point, bends
from quizgen.figures._canvas import CLOSE, MOVE, Box, Canvas, Label, Stroke, Style
from quizgen.figures._letters import runs
from quizgen.png import small

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FONTS = "STIX Two Text,STIXGeneral,Times New Roman,Times,Liberation Serif,serif"
FINE = 20
"""Steps of the grid in a point of print."""
UNSEEN = 0.6
"""How far from its line a point may lie to be left out, in steps of the grid."""
HIDES = 2
"""How many steps of grey the usual difference of two neighbours has at least."""
BLOCKS = (4, 2)
"""How often a pixel may stand side by side, in a detail."""
ROUND = 25
"""Points of a disc as a pen draws it, with the one that closes it."""
_BLANK = "\N{NO-BREAK SPACE}"
"""A blank that stays at the ends of a text and beside another one."""

Step = tuple[int, int]


def light(canvas: Canvas) -> bytes:
    """A file for an ``<img>``, which has the words for the figure."""
    wide, high = canvas.width * FINE, canvas.height * FINE
    sheet = Style(colour=canvas.background or "")
    paper = f'<path d="M0 0H{wide:g}V{high:g}H0z"{_paint(sheet)}/>' if sheet.colour else ""
    pictures = [_image(canvas, pixels, box) for pixels, box in canvas.pictures]
    strokes = [_path(canvas, stroke) for stroke in canvas.strokes]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{canvas.width:g}pt"'
        f' height="{canvas.height:g}pt" viewBox="0 0 {wide:g} {high:g}" fill="none" stroke="#000"'
        f' stroke-width="{FINE}" stroke-linejoin="round">'
        f"{''.join([paper, *pictures, *strokes, _texts(canvas)])}</svg>"
    ).encode()


def _image(canvas: Canvas, pixels: bytes | NDArray[np.uint8], box: Box) -> str:
    left, low, wide, high = box
    sharp = ""
    if not isinstance(pixels, bytes):
        single, times = _single(pixels)
        pixels = small(_coarse(single))
        sharp = ' image-rendering="pixelated"' if times > 1 else ""
    place = (left, canvas.height - low - high, wide, high)
    x, y, across, down = (f"{one * FINE:.6g}" for one in place)
    return (
        f'<image href="data:image/png;base64,{b64encode(pixels).decode()}" x="{x}" y="{y}"'
        f' width="{across}" height="{down}" preserveAspectRatio="none"{sharp}/>'
    )


def _single(codes: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], int]:
    """A picture whose pixels all stand side by side several times with each once; how often."""
    import numpy as np

    for times in BLOCKS:
        one = codes[::times, ::times]
        if np.array_equal(one.repeat(times, axis=0).repeat(times, axis=1), codes):
            return one, times
    return codes, 1


def _coarse(codes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A grey picture in steps that its own noise hides, if it has any."""
    import numpy as np

    noise = np.median(np.abs(np.diff(codes.astype(np.int16), axis=1))) if codes.ndim == 2 else 0
    step = 1 << max(int(noise) // HIDES, 1).bit_length() - 1
    return codes // step * step + step // 2


def _paint(style: Style) -> str:
    """How a path is painted, where that is not as the whole figure says."""
    colour = style.colour
    if colour[1::2] == colour[2::2]:
        colour = f"#{colour[1::2]}"
    if style.width == 0:
        return f' fill="{colour}" stroke="none"'
    rules = [f' stroke="{colour}"'] if colour != "#000" else []
    rules += [f' stroke-width="{style.width * FINE:g}"'] if style.width != 1 else []
    lengths = " ".join(f"{length * FINE:g}" for length in style.dashes)
    rules += [f' stroke-dasharray="{lengths}"'] if lengths else []
    return "".join(rules)


def _path(canvas: Canvas, stroke: Stroke) -> str:
    """A part as steps on the grid, each line from where the one before it ended."""
    points = [(x * FINE, y * FINE) for x, y in canvas.flipped(stroke.points)]
    starts = [place for place, code in enumerate(stroke.codes) if code == MOVE]
    at, data = (0, 0), ""
    for start, end in pairwise([*starts, len(points)]):
        row, closed = points[start:end], stroke.codes[end - 1] == CLOSE
        kept = [_rounded(point) for point in bends(row, UNSEEN)]
        data += "m" + _pair(kept[0][0] - at[0], kept[0][1] - at[1])
        if closed:
            at = kept[0]
            data += (_disc(row) or _lines(kept[:-1])) + "z"
        else:
            at = kept[-1]
            data += _lines(kept)
    return f'<path d="{data}"{_paint(stroke.style)}/>'


def _rounded(point: Point) -> Step:
    return round(point[0]), round(point[1])


def _lines(kept: Sequence[Step]) -> str:
    """Steps from each point to the next; behind ``m`` or another ``l`` no letter says so."""
    data, before = "", "l"
    for (x, y), (to_x, to_y) in pairwise(kept):
        step = (to_x - x, to_y - y)
        if step == (0, 0):
            continue
        letter = "l" if all(step) else "h" if step[0] else "v"
        text = _pair(*step) if letter == "l" else str(sum(step))
        data += _beside(text) if letter == before == "l" else letter + text
        before = letter
    return data


def _pair(x: int, y: int) -> str:
    return f"{x}{_beside(str(y))}"


def _beside(number: str) -> str:
    """A number behind another one."""
    return number if number.startswith("-") else f" {number}"


def _disc(row: Sequence[Point]) -> str:
    """A line as two arcs, if it goes round a centre as a pen draws a disc."""
    first, opposite = row[0], row[len(row) // 2]
    radius = abs(first[0] - opposite[0]) / 2
    centre = ((first[0] + opposite[0]) / 2, first[1])
    if len(row) != ROUND or any(abs(dist(one, centre) - radius) > UNSEEN for one in row):
        return ""
    across, arc = round(2 * radius), f"{radius:.3g} {radius:.3g} 0 0 0 "
    return f"a{arc}{-across} 0 {arc}{across} 0"


class Row(NamedTuple):
    """Letters of one style on one line: where they start, and how wide they are together."""

    text: str
    italic: bool
    size: float
    at: tuple[float, float]
    width: float


def _texts(canvas: Canvas) -> str:
    """The labels, gathered by how they are written."""
    rows = sorted((row for label in canvas.labels for row in _rows(canvas, label)), key=_manner)
    texts = "".join(_alike(how, list(group)) for how, group in groupby(rows, _manner))
    return f'<g fill="#000" stroke="none" font-family="{FONTS}">{texts}</g>' if texts else ""


def _rows(canvas: Canvas, label: Label) -> Iterator[Row]:
    found, _ = runs(label.text)
    for _, group in groupby(found, key=lambda run: (run.italic, run.size, run.at[1])):
        row = list(group)
        first, size = row[0], label.size
        x = label.at[0] + first.at[0] * size
        y = canvas.height - label.at[1] - first.at[1] * size
        wide = sum(run.width for run in row) * size
        yield Row("".join(run.text for run in row), first.italic, first.size * size, (x, y), wide)


def _manner(row: Row) -> tuple[bool, float]:
    return row.italic, row.size


def _alike(manner: tuple[bool, float], rows: list[Row]) -> str:
    """Rows of one style; letters that stand alone are one text, each with its place."""
    italic, size = manner
    single = [row for row in rows if len(row.text) == 1]
    texts = [_text(single)] if single else []
    texts += [_text([row]) for row in rows if len(row.text) > 1]
    slanted = ' font-style="italic"' if italic else ""
    return f'<g font-size="{size * FINE:.4g}"{slanted}>{"".join(texts)}</g>'


def _text(rows: list[Row]) -> str:
    x = " ".join(f"{row.at[0] * FINE:.0f}" for row in rows)
    y = " ".join(f"{row.at[1] * FINE:.0f}" for row in rows)
    wide = f' textLength="{rows[0].width * FINE:.0f}"' if len(rows[0].text) > 1 else ""
    text = escape("".join(row.text for row in rows), quote=False).replace(" ", _BLANK)
    return f'<text x="{x}" y="{y}"{wide}>{text}</text>'
