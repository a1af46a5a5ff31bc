"""A figure as one SVG element that can stand anywhere in an HTML page.

It has no prolog and no document type (not allowed inside HTML), no style sheet (it would apply to
the whole page) and no id (two figures on one page would share it).
"""

from __future__ import annotations

from html import escape


def with_title(inside: str, width: float, height: float, title: str, lang: str) -> bytes:
    """Wrap the inside of a figure into its SVG element, titled in one language.

    Parameters
    ----------
    inside : str
        From ``Canvas.inside``.
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
