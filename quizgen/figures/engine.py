"""Drawing by matplotlib: one figure at a time, in the house's style, kept once it is finished.

matplotlib's settings and its parser of formulas belong to the process: without a lock 10 to 17 of
96 figures fail in 16 threads. Drawing is Python all through, so the lock costs nothing.
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable
from functools import cache, lru_cache
from pathlib import Path
from threading import RLock
from typing import Any, ClassVar

import matplotlib as mpl
import msgspec
import numpy as np
from cycler import cycler
from matplotlib.colors import get_named_colors_mapping

import quizgen.figures.font_list  # noqa: F401 - before all that sets text
from quizgen.core.cache import compute_digest, read_cached, write_cached
from quizgen.core.decoding import prepare_type
from quizgen.figures.axes import Sheet
from quizgen.figures.contract import FigureModule, first_parameter, parameters_of
from quizgen.figures.inks import INKS
from quizgen.figures.kit import COLUMN
from quizgen.figures.svg import Drawing, SvgRenderer

_LOCK = RLock()
if hasattr(os, "register_at_fork"):
    # A worker forked while a thread draws would inherit a lock that nobody gives back.
    os.register_at_fork(
        before=_LOCK.acquire, after_in_parent=_LOCK.release, after_in_child=_LOCK.release
    )

_KIND = "figures"
_PACKAGE = Path(__file__).parent.parent
_CODE = ("figures", "camera", "numerics")
"""Folders of quizgen that decide what is drawn."""

Items = tuple[tuple[str, Any], ...]
Draw = Callable[[Any], object]


def draw_sheet(
    draw: Draw, size: tuple[float, float], decimal: str, *, axes: bool, fixed: bool = False
) -> Drawing:
    """Return the drawing that a function makes on a new sheet.

    Parameters
    ----------
    draw : callable
        Draws on axes, or on a figure of matplotlib whose unit is the point.
    size : tuple of float
        Width and height of the axes or the figure in points.
    decimal : str
        Decimal sign.
    axes : bool
        Whether ``draw`` takes axes.
    fixed : bool
        Keep the size of the figure, whatever is drawn.
    """
    with _LOCK, HouseStyle():
        sheet = pickle.loads(_empty_axes(*size)) if axes else Sheet(*size)  # noqa: S301 - our own
        draw(sheet.axes[0] if axes else sheet)
        renderer = SvgRenderer(sheet.bbox.height, decimal)
        sheet.draw(renderer)
        return renderer.write(size if fixed else None)


@lru_cache(32)
def _empty_axes(width: float, height: float) -> bytes:
    """Return a pickled sheet with empty axes: a copy takes half the time of a new one."""
    sheet = Sheet(width, height)
    sheet.add_axes((0, 0, 1, 1))
    return pickle.dumps(sheet)


def draw_module(
    module: FigureModule, items: Items, *, quiz: bool, lang: str, decimal: str, marks: Items = ()
) -> Drawing:
    """Return the drawing of a figure's module, from the cache if it was drawn before.

    A drawing is kept under the digest of all that decides its bytes: the figure's code and its
    neighbours', the engine, the camera, the versions of matplotlib and NumPy, and the values.
    """
    wants_lang = "lang" in parameters_of(module.draw)
    told = msgspec.json.encode((items, quiz, lang if wants_lang else "", decimal, marks))
    name = str(module.__file__)  # type: ignore[attr-defined]
    key = compute_digest(_digest_engine(), _digest_folder(module), name.encode(), told)
    if (found := read_cached(_KIND, key)) is not None:
        return _make_drawing_decoder().decode(found)
    extra = {"lang": lang} if wants_lang else {}

    def draw(place: Any) -> None:
        """Draw the figure, and a learner's marks if there are any."""
        values = dict(items)
        module.draw(place, values, quiz=quiz, **extra)
        if marks:
            module.mark(place, values, dict(marks))  # type: ignore[attr-defined]

    size = getattr(module, "SIZE", COLUMN)
    drawing = draw_sheet(draw, size, decimal, axes=first_parameter(module.draw) == "ax")
    write_cached(_KIND, key, msgspec.msgpack.encode(drawing))
    return drawing


@cache
def _make_drawing_decoder() -> msgspec.msgpack.Decoder[Drawing]:
    """Return the decoder of cached drawings."""
    prepare_type(Drawing)
    return msgspec.msgpack.Decoder(Drawing)


@cache
def _digest_engine() -> bytes:
    """Return a digest of quizgen's drawing code and of the libraries that it draws with."""
    files = [file for name in _CODE for file in _list_python_files(_PACKAGE / name)]
    versions = f"{mpl.__version__} {np.__version__}".encode()
    return compute_digest(versions, *(file.read_bytes() for file in files)).encode()


@lru_cache(256)
def _digest_folder(module: FigureModule) -> bytes:
    """Return a digest of a figure's code and of the modules in its folder."""
    folder = Path(str(module.__file__)).parent  # type: ignore[attr-defined]
    return compute_digest(*(file.read_bytes() for file in sorted(folder.glob("*.py")))).encode()


def _list_python_files(place: Path) -> list[Path]:
    """Return the Python files below a folder, sorted."""
    return sorted(place.rglob("*.py"))


_LIGHT = {name: light for name, (light, _) in INKS.items()}
_DASHES = ("-", (0, (5, 2)), (0, (1.2, 1.6)), (0, (6, 2, 1.2, 2)))
_SETTINGS: dict[str, Any] = {
    "figure.dpi": 72, "figure.facecolor": "none", "figure.edgecolor": "none",
    "font.family": ["STIXGeneral"], "font.size": 10, "mathtext.fontset": "stix",
    "axes.facecolor": "none", "axes.edgecolor": "ink", "axes.linewidth": 0.7,
    "axes.labelcolor": "ink", "text.color": "ink", "xtick.color": "ink", "ytick.color": "ink",
    "axes.spines.top": False, "axes.spines.right": False, "axes.titley": 1.0,
    "axes.labelsize": 10, "axes.labelpad": 3, "axes.titlesize": 10.5, "axes.axisbelow": True,
    "axes.xmargin": 0.03, "axes.ymargin": 0.06, "axes.unicode_minus": True,
    "figure.subplot.hspace": 0.55, "figure.subplot.wspace": 0.3,
    "axes.formatter.use_mathtext": True, "axes.formatter.limits": (-4, 5),
    # Colours and dashes change together: lines differ on grey paper, too.
    "axes.prop_cycle": cycler(color=["blue", "red", "teal", "gold"]) + cycler(linestyle=_DASHES),
    "grid.color": "rule", "grid.linewidth": 0.4, "grid.linestyle": "-",
    "xtick.direction": "out", "ytick.direction": "out",
    "xtick.major.size": 3, "ytick.major.size": 3, "xtick.minor.size": 1.8, "ytick.minor.size": 1.8,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4, "ytick.minor.width": 0.4,
    "xtick.labelsize": 9, "ytick.labelsize": 9, "xtick.major.pad": 2.5, "ytick.major.pad": 3,
    "lines.linewidth": 1.3, "lines.markersize": 4, "lines.scale_dashes": False,
    "patch.linewidth": 0.8, "patch.facecolor": "shade", "patch.edgecolor": "ink",
    "patch.force_edgecolor": False, "hatch.linewidth": 0.5,
    "legend.frameon": False, "legend.fontsize": 9, "legend.handlelength": 1.8,
    "image.interpolation": "none", "image.cmap": "gray",
    "boxplot.medianprops.color": "red", "boxplot.medianprops.linewidth": 1.6,
    "boxplot.boxprops.linewidth": 0.9, "boxplot.whiskerprops.linewidth": 0.8,
    "boxplot.capprops.linewidth": 0.8, "boxplot.flierprops.markersize": 3.5,
    "path.simplify": True, "path.simplify_threshold": 0.06, "path.sketch": None,
    "backend": "agg",  # boxplot() asks for it, and pyplot would be loaded to decide on one
    "svg.fonttype": "path", "svg.hashsalt": "quizgen", "text.hinting": "none",
}  # fmt: skip
# None of these decides what is drawn; asking the process for its backend would load pyplot.
_NOT_DRAWN = ("backend", "webagg", "savefig", "animation", "keymap", "tk.", "interactive",
              "toolbar", "timezone", "macosx", "date")  # fmt: skip


def _complete_settings() -> dict[str, Any]:
    """Return all settings a drawing depends on, whatever the machine's matplotlibrc says."""
    usual = {k: v for k, v in mpl.rcParamsDefault.items() if not k.startswith(_NOT_DRAWN)}
    with HouseColours():
        return dict(mpl.RcParams({**usual, **_SETTINGS}).items())


class HouseColours:
    """A ``with`` block in which colour names mean quizgen's inks: ``red`` is ours there alone."""

    _cache: ClassVar[dict[Any, Any]] = {}

    def __enter__(self) -> None:
        """Replace matplotlib's colours of these names."""
        names: Any = get_named_colors_mapping()
        self._before = {name: dict.get(names, name) for name in _LIGHT}
        self._cache_before, names.cache = names.cache, self._cache
        dict.update(names, _LIGHT)

    def __exit__(self, *_: object) -> None:
        """Restore matplotlib's colours."""
        names: Any = get_named_colors_mapping()
        names.cache = self._cache_before
        for name, before in self._before.items():
            if before is None:
                dict.pop(names, name)
            else:
                dict.__setitem__(names, name, before)


class HouseStyle(HouseColours):
    """A ``with`` block with quizgen's settings and colours of matplotlib.

    ``matplotlib.rc_context`` does the same in 0.44 ms, as it validates each value; these were
    validated once. The caller holds the lock of the engine: settings belong to the process.
    """

    def __enter__(self) -> None:
        """Replace matplotlib's settings."""
        super().__enter__()
        now: Any = mpl.rcParams
        self._settings = {key: dict.__getitem__(now, key) for key in _COMPLETE}
        dict.update(now, _COMPLETE)

    def __exit__(self, *_: object) -> None:
        """Restore matplotlib's settings."""
        now: Any = mpl.rcParams
        dict.update(now, self._settings)
        super().__exit__()


_COMPLETE = _complete_settings()
