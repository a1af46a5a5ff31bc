"""What every figure becomes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Figure:
    """A finished figure.

    Attributes
    ----------
    svg : bytes
        One ``<svg>`` element in UTF-8, ready to stand inside an HTML page: no prolog, no ids,
        no style sheet, ``role="img"`` and the alt text as its ``<title>``.
    alt : str
        The same picture in words.
    width_pt, height_pt : float
        Natural size in points (1/72 inch).
    dark : str
        ``"invert"`` (a dark page inverts the picture) or ``"keep"``.
    """

    svg: bytes
    alt: str
    width_pt: float
    height_pt: float
    dark: str

    def __repr__(self) -> str:
        return f"<Figure {self.width_pt:g} x {self.height_pt:g} pt, {len(self.svg)} bytes of SVG>"

    def _repr_html_(self) -> str:
        """The figure as a notebook shows it."""
        return self.svg.decode()
