"""Figures and axes of the house: matplotlib's own, with ticks that are drawn in one go.

matplotlib makes five artists a tick, which is four fifths of the time of an empty plot. The axes
here draw all ticks as one path and their labels, as long as an author has not styled single ticks
or moved spines; from then on that axis draws in matplotlib's own way. Everything else is untouched.
"""

from __future__ import annotations

import re
from typing import Any

import quizgen.figures.font_list  # noqa: F401 - before all that sets text

# isort: split
import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import XAxis, YAxis
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.ticker import FixedFormatter, FixedLocator, NullLocator
from matplotlib.transforms import Affine2D, IdentityTransform

from quizgen.figures.sketch import Sketch
from quizgen.figures.svg import house_font

_IN_POINTS = IdentityTransform()
_settings: Any = mpl.rcParams
_TOP_GAP = 8.0  # between the highest tick and the name of an upright axis, in points

_IN_NUMBERS = re.compile(r"\\mathdefault|\\times|[${}^]")
_IS_NUMBER = re.compile(r"[-−+]?\d[\d.,\s%°−-]*").fullmatch

# What an author may set without leaving the lean way: all ticks alike, at the left and below.
_LEAN = {"size", "width", "pad", "labelsize", "gridOn", "tick1On", "tick2On", "label1On",
         "label2On"}  # fmt: skip


class _TickPathAxis:
    """An axis that draws all its ticks as one path, unless somebody has styled them."""

    styled = False
    axes: Any
    axis_name: str
    major: Any
    minor: Any

    def set_tick_params(self, which: str = "major", reset: bool = False, **kwargs: Any) -> None:
        """Store the settings; matplotlib makes ticks from them only when it must."""
        unmade = [name for name in ("majorTicks", "minorTicks") if name not in self.__dict__]
        for name in unmade:
            setattr(self, name, [])
        super().set_tick_params(which, reset, **kwargs)  # type: ignore[misc]
        for name in unmade:
            self.__dict__.pop(name, None)
        here: Any = self
        settings = {**here._major_tick_kw, **here._minor_tick_kw}
        elsewhere = settings.get("tick2On") or settings.get("label2On")
        self.styled = bool(settings.keys() - _LEAN) or bool(elsewhere)

    def set_clip_path(self, path: Any, transform: Any = None) -> None:
        """Clip the axis without making ticks, as matplotlib would."""
        Artist.set_clip_path(self, path, transform)  # type: ignore[arg-type]

    def set_ticks(
        self, ticks: Any, labels: Any = None, *, minor: bool = False, **kwargs: Any
    ) -> Any:
        """Set the positions and labels of ticks, without making an artist of each."""
        here: Any = self
        if kwargs or self.styled:
            return super().set_ticks(ticks, labels, minor=minor, **kwargs)  # type: ignore[misc]
        places = [float(tick) for tick in here.convert_units(ticks)]
        kind = "minor" if minor else "major"
        getattr(here, f"set_{kind}_locator")(FixedLocator(places))
        if labels is not None:
            getattr(here, f"set_{kind}_formatter")(FixedFormatter([str(text) for text in labels]))
        if places:
            low, high = here.get_view_interval()
            here.set_view_interval(min(low, high, *places), max(low, high, *places))
        return []

    def reset_ticks(self) -> None:
        """Forget ticks that were made."""
        for name in ("majorTicks", "minorTicks"):
            self.__dict__.pop(name, None)

    def draw(self, renderer: Any) -> None:
        """Draw ticks, grid, labels and the axis' name."""
        here: Any = self
        if not here.get_visible():
            return
        spine = here.axes.spines["bottom" if here.axis_name == "x" else "left"]
        made = {"majorTicks", "minorTicks"} & set(self.__dict__)
        moved = spine._position not in (None, ("outward", 0.0))
        if self.styled or made or moved or not hasattr(renderer, "labels"):
            super().draw(renderer)  # type: ignore[misc]
            ticks = (label for tick in here.majorTicks for label in (tick.label1, tick.label2))
            self._count_unnamed(renderer, [text.get_text() for text in ticks if text.get_visible()])
            return
        renderer.open_group("axis", here.get_gid() or "axis")
        gc, reach = renderer.new_gc(), 0.0
        for kind in ("minor", "major"):
            reach = max(reach, self._draw_ticks(renderer, gc, kind, spine))
        self._draw_name(renderer, gc, reach)
        gc.restore()
        renderer.close_group("axis")
        here.stale = False

    def _locate_ticks(self, kind: str) -> Any:
        """Return the positions of major or minor ticks inside the view, in data units."""
        here: Any = self
        ticks = getattr(here, kind)
        if isinstance(ticks.locator, NullLocator):
            return np.empty(0)
        found = np.asarray(ticks.locator() if kind == "major" else here.get_minorticklocs(), float)
        low, high = sorted(here.get_view_interval())
        slack = 1e-9 * (high - low)
        return found[(found >= low - slack) & (found <= high + slack)]

    def _draw_ticks(self, renderer: Any, gc: Any, kind: str, spine: Any) -> float:
        """Draw major or minor ticks; return how far their labels reach from the axes, in points."""
        here: Any = self
        places = self._locate_ticks(kind)
        if not len(places):
            return 0.0
        across, name, box = here.axis_name == "x", here.axis_name, here.axes.bbox
        settings = getattr(here, f"_{kind}_tick_kw")
        size, width, pad = (
            settings.get(key, _settings[f"{name}tick.{kind}.{key}"])
            for key in ("size", "width", "pad")
        )
        size *= settings.get("tick1On", True)
        points = np.zeros((len(places), 2))
        view = here.axes.viewLim
        points[:, 0 if across else 1] = places
        points[:, 1 if across else 0] = view.y0 if across else view.x0
        at = here.axes.transData.transform(points)[:, 0 if across else 1]
        edge = box.y0 if across else box.x0
        if settings.get("gridOn"):
            gc.set_foreground(_settings["grid.color"])
            gc.set_linewidth(_settings["grid.linewidth"])
            self._draw_bars(renderer, gc, at, edge, box.y1 if across else box.x1)
        gc.set_foreground("ink")
        if spine.get_visible() and size:
            gc.set_linewidth(width)
            self._draw_bars(renderer, gc, at, edge - size, edge)
        if not settings.get("label1On", True):
            return float(size)
        font = house_font(settings.get("labelsize", _settings[f"{name}tick.labelsize"]))
        texts = getattr(here, kind).formatter.format_ticks(places)
        self._count_unnamed(renderer, texts)
        return self._draw_labels(renderer, gc, font, zip(at, texts, strict=True), size + pad)

    def _draw_labels(self, renderer: Any, gc: Any, font: Any, labels: Any, gap: float) -> float:
        """Draw labels ``gap`` points from the axes; return how far they reach, in points."""
        here: Any = self
        across, box, reach = here.axis_name == "x", here.axes.bbox, gap
        for place, label in labels:
            below = gap
            for text in str(label).replace(r"\mathdefault", "").split("\n"):
                if not text:
                    continue
                maths = "$" in text
                wide, tall, deep = renderer.get_text_width_height_descent(text, font, maths)
                if across:
                    x, y = place - wide / 2, box.y0 - below - tall + deep
                    below += tall + 3
                    reach = max(reach, below - 3)
                else:
                    x, y = box.x0 - gap - wide, place - (tall - deep) / 2
                    reach = max(reach, gap + wide)
                renderer.draw_text(gc, x, renderer.height - y, text, font, 0, maths)
        return float(reach)

    def _draw_bars(self, renderer: Any, gc: Any, places: Any, start: float, end: float) -> None:
        """Draw a bar across the axis at each place, from start to end, in points."""
        along = 0 if self.axis_name == "x" else 1
        points = np.empty((2 * len(places), 2))
        points[:, along] = np.repeat(places, 2)
        points[0::2, 1 - along], points[1::2, 1 - along] = start, end
        codes = np.tile(np.array([1, 2], np.uint8), len(places))
        renderer.draw_path(gc, Path(points, codes), _IN_POINTS)

    def _count_unnamed(self, renderer: Any, texts: Any) -> None:
        """Count an axis that has numbers but no name that says of what."""
        here: Any = self
        named = here.label.get_visible() and here.label.get_text()
        if not named and any(_IS_NUMBER(_IN_NUMBERS.sub("", str(text))) for text in texts):
            renderer.unnamed_axes = getattr(renderer, "unnamed_axes", 0) + 1

    def _draw_name(self, renderer: Any, gc: Any, reach: float) -> None:
        """Draw the name at the axis' end, level, as textbooks do.

        ``reach`` is that of its labels.
        """
        here: Any = self
        text, factor, box = here.label.get_text(), here.major.formatter.get_offset(), here.axes.bbox
        text = f"{text}  ({factor})" if factor and text else text or factor
        if not text or not here.label.get_visible():
            return
        font = house_font(_settings["axes.labelsize"])
        wide, tall, deep = renderer.get_text_width_height_descent(text, font, "$" in text)
        if here.axis_name == "x":
            x, y = box.x1 - wide, box.y0 - reach - 5 - tall + deep
        else:
            x, y = box.x0 - min(reach, 20), box.y1 + _TOP_GAP
        gc.set_foreground(here.label.get_color())
        renderer.draw_text(gc, x, renderer.height - y, text, font, 0, "$" in text)


class _HorizontalAxis(_TickPathAxis, XAxis):
    """The x axis, with ticks drawn as one path."""


class _VerticalAxis(_TickPathAxis, YAxis):
    """The y axis, with ticks drawn as one path."""


class HouseAxes(Axes):
    """Axes in quizgen's style, on which everything of matplotlib works."""

    name = "house"

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        for spine in self.spines.values():
            spine.get_position()  # matplotlib settles it when it makes a tick
        axes: Any = (self.xaxis, self.yaxis)
        for axis in axes:
            axis.styled = False

    def _init_axis(self) -> None:
        """Give the axes quizgen's own x and y axis; matplotlib calls this."""
        self.xaxis, self.yaxis = (
            _HorizontalAxis(self, clear=False),
            _VerticalAxis(self, clear=False),
        )
        sides = {"bottom": self.xaxis, "top": self.xaxis, "left": self.yaxis, "right": self.yaxis}
        for side, axis in sides.items():
            self.spines[side].register_axis(axis)

    def grid(
        self, visible: bool | None = True, which: Any = "major", axis: Any = "both", **kwargs: Any
    ) -> None:
        """Switch the grid on or off; with other styles, matplotlib's own grid."""
        if kwargs:
            super().grid(visible, which, axis, **kwargs)
            return
        for one in (self.xaxis, self.yaxis):
            if axis in ("both", one.axis_name):
                for kind in ("major", "minor") if which == "both" else (which,):
                    getattr(one, f"_{kind}_tick_kw")["gridOn"] = visible is not False


class Sheet(Figure):
    """A figure of matplotlib measured in points, whose plain axes are `HouseAxes`.

    Parameters
    ----------
    width, height : float
        In points. What is drawn may reach farther: the picture ends where the ink ends.
    """

    def __init__(self, width: float, height: float) -> None:
        super().__init__(figsize=(width / 72, height / 72), dpi=72)
        FigureCanvasBase(self)
        self.patch.set_visible(False)

    def add_subplot(self, *args: Any, **kwargs: Any) -> Any:
        """Return new axes as matplotlib does, `HouseAxes` unless they have a projection."""
        if "projection" not in kwargs and not kwargs.get("polar"):
            kwargs.setdefault("axes_class", HouseAxes)
        return super().add_subplot(*args, **kwargs)

    def add_axes(self, *args: Any, **kwargs: Any) -> Any:
        """Return new or given axes as matplotlib does, `HouseAxes` unless with a projection."""
        made = args and isinstance(args[0], Axes)
        if "projection" not in kwargs and not kwargs.get("polar") and not made:
            kwargs.setdefault("axes_class", HouseAxes)
        return super().add_axes(*args, **kwargs)

    def axes_in(self, left: float, low: float, width: float, height: float) -> Any:
        """Return new axes in a box in points, from the lower left corner."""
        w, h = self.get_size_inches() * 72
        return self.add_axes((left / w, low / h, width / w, height / h))

    def sketch(self, on: Any = None, **kwargs: Any) -> Sketch:
        """Return a new sketch, in points of the figure or, with axes ``on``, in their units."""
        added = Sketch(on.transData if on is not None else _IN_POINTS, **kwargs)
        added.set_figure(self)
        (self if on is None else on).add_artist(added)
        added.set_transform(_IN_POINTS)
        return added

    def picture(self, pixels: Any, box: Any, palette: Any = None, gid: str = "") -> Picture:
        """Return pixels added in a box (left, low, width, height) in points.

        They are never resampled.
        """
        added = Picture(pixels, box, palette)
        added.set_gid(gid)
        added.set_figure(self)
        self.add_artist(added)
        return added


class Picture(Artist):
    """Pixels in a box in points: (H, W, 3) or (H, W) of 8 bits, or indices of a palette."""

    def __init__(self, pixels: Any, box: Any, palette: Any = None) -> None:
        super().__init__()
        self.pixels, self.box, self.palette = pixels, box, palette
        self.set_zorder(0)

    def draw(self, renderer: Any) -> None:
        """Draw the pixels on a renderer, last row first, as matplotlib counts them."""
        renderer.open_group("picture", self.get_gid())
        left, low, width, height = self.box
        pixels, named = self.pixels[::-1], {}
        if self.palette is not None and hasattr(renderer, "labels"):
            named["palette"] = self.palette
        else:
            if self.palette is not None:  # a renderer of matplotlib knows none
                pixels = np.asarray(self.palette, np.uint8)[pixels]
            if pixels.ndim == 2:
                pixels = np.repeat(pixels[..., None], 3, axis=2)
            pixels = np.dstack([pixels, np.full(pixels.shape[:2], 255, np.uint8)])
        place = Affine2D().scale(width, height)
        renderer.draw_image(renderer.new_gc(), left, low, pixels, place, **named)
        renderer.close_group("picture")
