"""A figure in few bytes, for a file of its own: its labels are text, its photographs are packed.

It looks like ``Canvas.inside`` wherever there is a font as wide as Times, which labels are laid out
for; elsewhere each run of letters is squeezed into its room.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator
from functools import lru_cache
from html import escape
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from quizgen.figures._canvas import CLOSE, LINE, MOVE, Box, Canvas, Label, Stroke
from quizgen.figures._letters import Run, runs
from quizgen.png import compact

FONTS = "STIX Two Text,STIXGeneral,Times New Roman,Times,Liberation Serif,serif"
USUAL = 10.5
"""Size that most labels have."""
_BLANK = "\N{NO-BREAK SPACE}"
"""A blank that stays at the ends of a text and beside another one."""


def light(canvas: Canvas) -> bytes:
    """A file for an ``<img>``, which has the words for the figure."""
    wide, high, paper = canvas.width, canvas.height, canvas.background
    sheet = f'<path d="M0 0H{wide:g}V{high:g}H0z" fill="{paper}"/>'
    pictures = [_image(canvas, pixels, box) for pixels, box in canvas.pictures]
    strokes = [_path(canvas, stroke) for stroke in canvas.strokes]
    inside = "".join([sheet if paper else "", *pictures, *strokes, _texts(canvas)])
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide:g}pt" height="{high:g}pt"'
        f' viewBox="0 0 {wide:g} {high:g}" stroke-linejoin="round">{inside}</svg>'
    ).encode()


def _image(canvas: Canvas, pixels: bytes | NDArray[np.uint8], box: Box) -> str:
    left, low, wide, high = box
    png = pixels if isinstance(pixels, bytes) else compact(pixels)
    return (
        f'<image href="data:image/png;base64,{b64encode(png).decode()}" x="{left:.6g}"'
        f' y="{canvas.height - low - high:.6g}" width="{wide:.6g}" height="{high:.6g}"'
        ' preserveAspectRatio="none"/>'
    )


def _path(canvas: Canvas, stroke: Stroke) -> str:
    """A part as steps from point to point, in hundredths that are rounded where the points are."""
    points = np.rint(canvas.flipped(stroke.points) * 100).astype(np.int64)
    kept = _corners(points, stroke.codes)
    points, codes = points[kept], stroke.codes[kept]
    steps = np.diff(points, axis=0, prepend=0).tolist()
    rows = zip(codes.tolist(), steps, strict=True)
    data = "".join(_step(code, x, y) for code, (x, y) in rows)
    return f'<path d="{data}"{stroke.style.attribute()}/>'


def _step(code: int, x: int, y: int) -> str:
    if code == CLOSE:
        return "z"
    return ("m" if code == MOVE else "l") + _number(x) + _beside(_number(y))


def _corners(points: NDArray[np.int64], codes: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Which points are more than a stop on a straight line."""
    before, after = points[1:-1] - points[:-2], points[2:] - points[1:-1]
    turns = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    on = (before * after).sum(axis=1) > 0
    inner = (turns != 0) | ~on | (codes[1:-1] != LINE) | (codes[2:] != LINE)
    return np.concatenate(([True], inner, [True]))


@lru_cache(maxsize=4096)
def _number(hundredths: int) -> str:
    """A coordinate without what it can be read without."""
    text = f"{hundredths / 100:.2f}".rstrip("0").rstrip(".")
    return text.replace("0.", ".", 1) if abs(hundredths) < 100 and hundredths else text


def _beside(number: str) -> str:
    """A number behind another one."""
    return number if number.startswith("-") else f" {number}"


def _texts(canvas: Canvas) -> str:
    texts = "".join(text for label in canvas.labels for text in _label(canvas, label))
    return f'<g font-family="{FONTS}" font-size="{USUAL}">{texts}</g>' if texts else ""


def _label(canvas: Canvas, label: Label) -> Iterator[str]:
    """A text for each row of letters in one style."""
    found, _ = runs(label.text)
    for _, group in groupby(found, key=lambda run: (run.italic, run.size, run.at[1])):
        yield _text(canvas, label, list(group))


def _text(canvas: Canvas, label: Label, row: list[Run]) -> str:
    first, size = row[0], row[0].size * label.size
    x = label.at[0] + first.at[0] * label.size
    y = canvas.height - label.at[1] - first.at[1] * label.size
    wide = sum(run.width for run in row) * label.size
    style = f' font-size="{size:.4g}"' if size != USUAL else ""
    style += ' font-style="italic"' if first.italic else ""
    style += f' textLength="{wide:.4g}"' if len(row) > 1 else ""
    text = escape("".join(run.text for run in row), quote=False).replace(" ", _BLANK)
    return f'<text x="{x:.5g}" y="{y:.5g}"{style}>{text}</text>'
