"""What a figure is drawn on: painted paths and pictures, written as the inside of an SVG.

Figures are drawn in points from the lower left; SVG counts from the upper left.
"""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

MOVE, LINE, CURVE, CLOSE = (np.uint8(code) for code in (1, 2, 3, 79))
"""Codes of the points of a path, as fonts have them; a curve has its control point first."""
_CONTROL: Final = np.uint8(4)
"""The control point of a curve, told from its end."""
_FORMS: Final = {1: "M %g %g", 2: "L %g %g", 3: "%g %g", 4: "Q %g %g"}
BLACK: Final = "#000000"

Box = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Style:
    """How a part is painted: line width in points (0 fills instead), colour, dashes."""

    width: float = 0.0
    colour: str = BLACK
    dashes: tuple[float, ...] = ()

    def attribute(self) -> str:
        """The same for SVG, without what holds anyway."""
        if self.width == 0:
            rules = [] if self.colour == BLACK else [f"fill: {self.colour}"]
        else:
            rules = ["fill: none", *self._dashed(), f"stroke: {self.colour}"]
            rules += [] if self.width == 1 else [f"stroke-width: {self.width:g}"]
        return f' style="{"; ".join(rules)}"' if rules else ""

    def _dashed(self) -> tuple[str, ...]:
        lengths = ",".join(f"{length:g}" for length in self.dashes)
        return (f"stroke-dasharray: {lengths}", "stroke-dashoffset: 0") if lengths else ()


class Canvas:
    """A figure in the making: pictures lie under everything else."""

    def __init__(self) -> None:
        self.width = self.height = 0.0
        self.labels: tuple[str, ...] = ()
        self._background: str | None = None
        self._pictures: list[tuple[bytes, Box]] = []
        self._paths: list[str] = []

    def size(self, width: float, height: float, background: str | None) -> None:
        """Size it in points and paint the paper; it is transparent without a colour."""
        self.width, self.height, self._background = width, height, background

    def picture(self, png: bytes, box: Box) -> None:
        """Put a PNG file into a box: left, bottom, width and height in points."""
        self._pictures.append((png, box))

    def path(
        self, part: str, style: Style, points: NDArray[np.float64], codes: NDArray[np.uint8]
    ) -> None:
        """Paint a part of the figure, which is sized before."""
        flipped = np.round((0.0, self.height) + np.round(points, 2) * (1.0, -1.0), 2) + 0.0
        data = _commands(flipped, codes, closed=style.width > 0)
        self._paths.append(f'<g data-part="{part}"><path d="{data}"{style.attribute()}/></g>')

    def inside(self) -> str:
        """Elements without ids; each part is a group with ``data-part``."""
        pictures = [self._image(png, box) for png, box in self._pictures]
        return f"<g>{''.join([self._paper(), *pictures, *self._paths])}</g>"

    def _paper(self) -> str:
        if self._background is None:
            return ""
        wide, high, paint = self.width, self.height, Style(colour=self._background)
        corners = f"M 0 {high:g} L {wide:g} {high:g} L {wide:g} 0 L 0 0 z"
        return f'<g><path d="{corners}"{paint.attribute()}/></g>'

    def _image(self, png: bytes, box: Box) -> str:
        left, low, wide, high = box
        return (
            f'<image xlink:href="data:image/png;base64,{b64encode(png).decode()}"'
            f' x="{left:.2f}" y="{self.height - low - high:.2f}" width="{wide:.2f}"'
            f' height="{high:.2f}" preserveAspectRatio="none"/>'
        )


def _commands(points: NDArray[np.float64], codes: NDArray[np.uint8], *, closed: bool) -> str:
    """Drawing commands of SVG; an outline that closes goes back to its start first."""
    curves = codes == CURVE
    kinds = np.where(curves & (np.cumsum(curves) % 2 == 1), _CONTROL, codes)
    closing = codes == CLOSE
    if closed:
        starts = np.maximum.accumulate(np.where(codes == MOVE, np.arange(len(codes)), 0))
        points = points[np.where(closing, starts, np.arange(len(codes)))]
    else:
        points = points[~closing]
    forms = {**_FORMS, int(CLOSE): "L %g %g z" if closed else "z"}
    return " ".join([forms[kind] for kind in kinds.tolist()]) % tuple(points.ravel().tolist())
