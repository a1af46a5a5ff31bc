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
from typing import Any

import matplotlib as mpl
import msgspec
import numpy as np

from quizgen.core.cache import compute_digest, read_cached, write_cached
from quizgen.core.decoding import prepare_type
from quizgen.figures.axes import Sheet
from quizgen.figures.contract import FigureModule, first_parameter, parameters_of
from quizgen.figures.kit import COLUMN
from quizgen.figures.style import HouseStyle
from quizgen.figures.svg import Drawing, SvgRenderer

_LOCK = RLock()
if hasattr(os, "register_at_fork"):
    # A worker forked while a thread draws would inherit a lock that nobody gives back.
    os.register_at_fork(
        before=_LOCK.acquire, after_in_parent=_LOCK.release, after_in_child=_LOCK.release
    )

_KIND = "figures"
_PACKAGE = Path(__file__).parent.parent
_CODE = ("figures", "camera", "arrays")  # of quizgen, that decides what is drawn

Items = tuple[tuple[str, Any], ...]
Draw = Callable[[Any], object]


def draw_sheet(
    draw: Draw, size: tuple[float, float], decimal: str, *, axes: bool, fixed: bool = False
) -> Drawing:
    """Draw on a new sheet.

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
    """A sheet with empty axes, pickled: a fresh copy takes half the time of making it."""
    sheet = Sheet(width, height)
    sheet.add_axes((0, 0, 1, 1))
    return pickle.dumps(sheet)


def draw_module(
    module: FigureModule, items: Items, *, quiz: bool, lang: str, decimal: str, marks: Items = ()
) -> Drawing:
    """Draw a figure's module, or take what was kept of it.

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
    prepare_type(Drawing)
    return msgspec.msgpack.Decoder(Drawing)


@cache
def _digest_engine() -> bytes:
    """Digest of quizgen's code that draws, and of the libraries it draws with."""
    files = [file for name in _CODE for file in _python_files(_PACKAGE / name)]
    versions = f"{mpl.__version__} {np.__version__}".encode()
    return compute_digest(versions, *(file.read_bytes() for file in files)).encode()


@lru_cache(256)
def _digest_folder(module: FigureModule) -> bytes:
    """Digest of a figure's code and of what it may import from beside it."""
    folder = Path(str(module.__file__)).parent  # type: ignore[attr-defined]
    return compute_digest(*(file.read_bytes() for file in sorted(folder.glob("*.py")))).encode()


def _python_files(place: Path) -> list[Path]:
    return sorted(place.rglob("*.py"))
