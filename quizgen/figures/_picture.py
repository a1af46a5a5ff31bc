"""A finished PNG as an artist of a matplotlib figure, put into an SVG as it is."""

from __future__ import annotations

from base64 import b64encode
from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.artist import Artist


class Picture(Artist):
    """A PNG file in a box.

    matplotlib's own images are resampled and encoded again, which takes most of 65 ms a figure.

    Parameters
    ----------
    png : bytes
        The file.
    box : tuple of float
        Left, bottom, width and height in points.
    """

    def __init__(self, png: bytes, box: tuple[float, float, float, float]) -> None:
        super().__init__()
        self.png = png
        self.box = box

    def draw(self, renderer: Any) -> None:
        """Draw into an SVG, or into any renderer that takes pixels."""
        if not self.get_visible():
            return
        writer = getattr(renderer, "writer", None)
        if writer is None:
            self._draw_pixels(renderer)
            return
        left, low, wide, high = self.box
        writer.element(
            "image",
            x=f"{left:.2f}",
            y=f"{renderer.height - low - high:.2f}",
            width=f"{wide:.2f}",
            height=f"{high:.2f}",
            preserveAspectRatio="none",
            attrib={"xlink:href": "data:image/png;base64," + b64encode(self.png).decode()},
        )

    def _draw_pixels(self, renderer: Any) -> None:
        from matplotlib.image import imread

        left, low, wide, high = (edge * renderer.points_to_pixels(1) for edge in self.box)
        pixels = (imread(BytesIO(self.png)) * 255).round().astype(np.uint8)
        rows = np.linspace(0, len(pixels) - 1, max(1, round(high))).astype(int)[::-1]
        columns = np.linspace(0, pixels.shape[1] - 1, max(1, round(wide))).astype(int)
        scaled = pixels[rows][:, columns, :3]
        rgba = np.dstack([scaled, np.full(scaled.shape[:2], 255, np.uint8)])
        renderer.draw_image(renderer.new_gc(), round(left), round(low), rgba)
