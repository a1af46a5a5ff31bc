"""A matplotlib figure as one SVG element that can stand anywhere in an HTML page.

What is taken out of matplotlib's SVG, and why: the prolog and document type (not allowed inside
HTML), the metadata (time and version would change the bytes), the style sheet (it would apply to
the whole page) and every id (two figures on one page would share them).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from html import escape
from io import StringIO
from threading import Lock
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

_SETTINGS: dict[Any, Any] = {
    # Everything a user's matplotlibrc could change in these drawings.
    "figure.autolayout": False,
    "figure.constrained_layout.use": False,
    "figure.dpi": 72,
    "lines.scale_dashes": False,
    "path.effects": [],
    "path.simplify": False,
    "path.sketch": None,
    "savefig.bbox": None,
    "savefig.dpi": "figure",
    "savefig.edgecolor": "none",
    "savefig.facecolor": "auto",
    "savefig.transparent": False,
    "svg.fonttype": "path",
    "svg.hashsalt": "quizgen",
    "svg.id": None,
}
_NO_METADATA = dict.fromkeys(("Creator", "Date", "Format", "Type"))
_LOCK = Lock()
"""matplotlib's settings are global: one figure at a time changes them."""

_HEAD = re.compile(r".*?</defs>\s*", re.DOTALL)
_ID = re.compile(r'<g id="(?:part-([^"]*)|[^"]*)">')
_GAP = re.compile(r">\s+<")


def body(draw: Callable[[Figure], None]) -> tuple[str, float, float]:
    """Draw a figure and return the inside of its SVG element.

    Parameters
    ----------
    draw : callable
        Draws on the empty figure it is given.

    Returns
    -------
    inside : str
        Elements without ids; each part of the drawing is a group with ``data-part``.
    width, height : float
        Size in points.
    """
    out = StringIO()
    with _LOCK, mpl.rc_context(_SETTINGS):
        figure = Figure()
        draw(figure)
        figure.savefig(out, format="svg", metadata=_NO_METADATA)
    width, height = figure.get_size_inches() * 72
    return _inside(out.getvalue()), round(float(width), 2), round(float(height), 2)


def _inside(svg: str) -> str:
    inside = _HEAD.sub("", svg, count=1).rstrip().removesuffix("</svg>")
    inside = _GAP.sub("><", _ID.sub(_group, inside))
    return inside.replace(" \n", " ").replace("\n", " ").replace(' "', '"').strip()


def _group(match: re.Match[str]) -> str:
    return f'<g data-part="{match[1]}">' if match[1] else "<g>"


def with_title(inside: str, width: float, height: float, title: str, lang: str) -> bytes:
    """Wrap the inside of a figure into its SVG element, titled in one language.

    Parameters
    ----------
    inside : str
        From ``body``.
    width, height : float
        Size in points.
    title, lang : str
        Alt text and its language.

    Returns
    -------
    bytes
        UTF-8, from ``<svg`` to ``</svg>``.
    """
    links = ' xmlns:xlink="http://www.w3.org/1999/xlink"' if "xlink:" in inside else ""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg"{links} width="{width:g}pt" height="{height:g}pt"'
        f' viewBox="0 0 {width:g} {height:g}" role="img" lang="{lang}"'
        f' stroke-linejoin="round" stroke-linecap="butt"><title>{escape(title, quote=False)}'
        f"</title>{inside}</svg>"
    ).encode()
