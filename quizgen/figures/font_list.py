"""Give matplotlib a finished list of its own fonts. Import this before anything that sets text.

It spares the first process on a machine a scan of 0.2 to 0.7 s, and keeps a STIX of the system,
which has other outlines, from deciding the bytes of a figure.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl

FONTS = Path(__file__).parent / "fonts"


def _install_font_list() -> None:
    """Have matplotlib read the list in ``fonts`` in place of scanning the machine for fonts.

    The file is named after the version of the list's form. Another matplotlib looks for another
    name, finds none here, and would write its own there: then it may scan as usual.
    """
    files = sorted(FONTS.glob("fontlist-*.json"))
    if not files or not mpl.__version__.startswith("3.11."):
        return
    if "matplotlib.font_manager" in sys.modules:
        # Somebody plots in this process, too, and keeps the fonts of the system; of equal ones the
        # first counts.
        from matplotlib import font_manager

        ours = font_manager.json_load(files[0])
        font_manager.fontManager.ttflist[:0] = ours.ttflist
        font_manager.fontManager._findfont_cached.cache_clear()  # type: ignore[attr-defined]  # noqa: SLF001
        return
    own, mpl.get_cachedir = mpl.get_cachedir, lambda: str(FONTS)
    try:
        from matplotlib import font_manager
    finally:
        mpl.get_cachedir = own


_install_font_list()
