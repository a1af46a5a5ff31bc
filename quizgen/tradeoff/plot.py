"""Plots as SVG text: correct digits against time, work against precision, digits against an input.

Points carry numbers that the table repeats, so nothing rests on colour; colours are CSS classes
with fallbacks, so the same SVG serves light and dark pages and stands alone. Every panel is as wide
as a phone.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files

from quizgen.tradeoff.digits import ALL_DIGITS
from quizgen.tradeoff.labels import Box, Labels, Placed

STYLE = """
.tp text{font:12px system-ui,"Hind Siliguri","QuizBangla",sans-serif;fill:currentColor}
.tp .axis{stroke:currentColor;stroke-width:1;fill:none}
.tp .grid{stroke:currentColor;stroke-width:.5;opacity:.18}
.tp .rule{stroke:currentColor;stroke-width:1;stroke-dasharray:5 3;opacity:.7}
.tp .tie{stroke:currentColor;stroke-width:.6;opacity:.6}
.tp .front{stroke:#0b62c4;stroke-width:2;fill:none}
.tp .on{fill:#0b62c4;stroke:#0b62c4}.tp .off{fill:none;stroke:currentColor;opacity:.65}
.tp .second{stroke:#b3470a;fill:#b3470a}.tp .third{stroke:#3f7d20;fill:#3f7d20}
.tp polyline.line{fill:none}.tp .line{stroke-width:1.6}
.tp .small{font-size:11px}
.tp .head{font-weight:600;paint-order:stroke;stroke:Canvas;stroke-width:3px;stroke-linejoin:round}
.tp .float64{stroke-dasharray:7 3}.tp .float32{stroke-dasharray:2 3}
.tp .cursor{stroke:currentColor;stroke-width:1.5;opacity:.8}
.tp .thin{stroke-width:.8;opacity:.45;fill:none}.tp .arrow{stroke-width:2.6;fill:none}
"""


def script() -> str:
    """What moves the sliders."""
    return (files("quizgen.tradeoff") / "pages" / "tradeoff.js").read_text("utf-8")


def style() -> str:
    """The style of measurements on a page."""
    return (files("quizgen.tradeoff") / "pages" / "measured.css").read_text("utf-8") + STYLE


PANEL, HEIGHT, LEFT, TOP, BOTTOM = 420, 300, 40, 30, 46
RIGHT = PANEL - 20
BOUNDS = Box(LEFT + 1, TOP - 8, PANEL - 1, HEIGHT - BOTTOM - 1)
"""Where labels of a panel may stand."""


@dataclass(frozen=True)
class Mark:
    """A point of an accuracy plot."""

    number: int
    x: float
    y: float
    scalar: bool
    front: bool


@dataclass(frozen=True)
class Scale:
    """A linear or logarithmic axis in page units."""

    low: float
    high: float
    start: float
    end: float
    log: bool = False

    def __call__(self, value: float) -> float:
        """Position of a value, clipped to the axis."""
        low, high, at = self.low, self.high, value
        if self.log:
            low, high, at = math.log10(low), math.log10(high), math.log10(max(value, 1e-300))
        share = min(max((at - low) / (high - low), 0.0), 1.0)
        return self.start + share * (self.end - self.start)


TIMES = Scale(0.3, 3e7, LEFT, RIGHT, log=True)
DIGITS = Scale(0.0, ALL_DIGITS, HEIGHT - BOTTOM, TOP)


def document(panels: Sequence[str], title: str, height: int = HEIGHT) -> str:
    """One SVG with its own style: panels beside each other."""
    width = PANEL * len(panels)
    body = "".join(
        f'<g transform="translate({i * PANEL},0)">{panel}</g>' if i else panel
        for i, panel in enumerate(panels)
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="tp" role="img" '
        f'viewBox="0 0 {width} {height}" width="{width}" height="{height}">'
        f"<title>{escape(title)}</title><style>{STYLE}</style>{body}</svg>"
    )


def time_text(nanoseconds: float) -> str:
    """A time with a unit that keeps it short.

    Examples
    --------
    >>> time_text(0.4567), time_text(999.4), time_text(999.6), time_text(12.5e6)
    ('0.457 ns', '999 ns', '1 µs', '12.5 ms')
    """
    for factor, unit in ((1e9, "s"), (1e6, "ms"), (1e3, "µs")):
        if nanoseconds >= 0.9995 * factor:  # what rounds to a thousand has the next unit
            return f"{nanoseconds / factor:.3g} {unit}"
    return f"{nanoseconds:.3g} ns"


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def raised(power: int) -> str:
    """An exponent as it is written above the line."""
    return str(power).translate(_RAISED)


def power_text(value: float) -> str:
    """A power of ten: written out from 0.01 to 1000, else as 10⁻⁵."""
    if 1e-2 <= value <= 1e3:
        return f"{value:g}"
    return "10" + raised(round(math.log10(value)))


def text(x: float, y: float, said: str, anchor: str = "middle", kind: str = "small") -> str:
    """A text element."""
    at = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" class="{kind}"'
    return f"<text {at}>{escape(said)}</text>"


def line(x1: float, y1: float, x2: float, y2: float, kind: str) -> str:
    """A line element."""
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" class="{kind}"/>'


def path(points: Iterable[tuple[float, float]], kind: str) -> str:
    """A line through points."""
    return f'<polyline points="{joined(points)}" class="{kind}"/>'


def joined(points: Iterable[tuple[float, float]]) -> str:
    """Points as an element takes them."""
    return " ".join(f"{px:.1f},{py:.1f}" for px, py in points)


def label(placed: Placed | None, kind: str = "small") -> str:
    """A label where it was placed, tied to its point if that is far."""
    if placed is None:
        return ""
    said = text(placed.x, placed.y, placed.text, kind=kind)
    if not placed.far:
        return said
    (x, y), box = placed.point, placed.box
    near_x, near_y = min(max(x, box.left), box.right), min(max(y, box.top), box.bottom)
    return line(x, y, near_x, near_y, "tie") + said


def decades(scale: Scale) -> list[float]:
    """Powers of ten on an axis; where it has fewer than two, its ends."""
    first, last = math.ceil(math.log10(scale.low)), math.floor(math.log10(scale.high))
    stride = max(1, math.ceil((last - first) / 6))
    return [10.0**n for n in range(first, last + 1, stride)]


def frame(x: Scale, y: Scale) -> str:
    """Both axes."""
    return path([(x.start, y.end), (x.start, y.start), (x.end, y.start)], "axis")


def digit_axis(y: Scale, x: Scale, name: str, every: str) -> str:
    """Lines of correct digits across a panel; the highest is called by ``every``."""
    parts = [text(4, 15, name, "start")]
    for at in (0, 4, 8, 12, 16, ALL_DIGITS):
        parts.append(line(x.start, y(at), x.end, y(at), "grid"))
        if at != 16:
            said = every if at == ALL_DIGITS else str(at)
            parts.append(text(x.start - 5, y(at) + 4, said, "end"))
    return "".join(parts)


def time_axis(x: Scale, y: Scale, name: str) -> str:
    """Lines of times across a panel."""
    parts = [text(x.end, HEIGHT - 8, name, "end")]
    for at in (1.0, 1e2, 1e4, 1e6):
        parts.append(line(x(at), y.start, x(at), y.end, "grid"))
        parts.append(text(x(at), y.start + 15, time_text(at)))
    return "".join(parts)


@dataclass(frozen=True)
class Axes:
    """What stands at the axes: time, digits, and how "all digits" is called."""

    time: str
    digits: str
    every: str


def accuracy_panel(
    title: str, marks: Sequence[Mark], rules: Sequence[tuple[float, str]], axes: Axes
) -> str:
    """One panel: time per value (log) against correct digits."""
    x, y = TIMES, DIGITS
    labels = Labels(BOUNDS)
    parts = [text(x.end, 15, title, "end", "head"), frame(x, y)]
    parts += [digit_axis(y, x, axes.digits, axes.every), time_axis(x, y, axes.time)]
    for (at, said), below in zip(rules, (False, True), strict=False):
        parts.append(line(x.start, y(at), x.end, y(at), "rule"))
        where = x.end - 2, y(at) + (13 if below else -4)
        parts.append(text(*where, said, "end"))
        labels.written(*where, said, "end")
    for mark in marks:
        labels.keep_clear(x(mark.x), y(mark.y))
    front = sorted((mark for mark in marks if mark.front), key=lambda mark: mark.x)
    parts.append(path([(x(mark.x), y(mark.y)) for mark in front], "front"))
    parts += [dot(x(mark.x), y(mark.y), mark) for mark in marks]
    ordered = sorted(marks, key=lambda mark: (mark.x, mark.y))
    parts += [label(labels.place(str(m.number), x(m.x), y(m.y))) for m in ordered]
    return "".join(parts)


def dot(px: float, py: float, mark: Mark) -> str:
    """A way over whole arrays is a circle, one of single values a square; the best are filled."""
    kind = "on" if mark.front else "off"
    return _point(px, py, kind, square=mark.scalar)


def _point(px: float, py: float, kind: str, *, square: bool) -> str:
    if square:
        return f'<rect x="{px - 4:.1f}" y="{py - 4:.1f}" width="8" height="8" class="{kind}"/>'
    return circle(px, py, kind, 4.5)


def circle(px: float, py: float, kind: str, radius: float = 3.5) -> str:
    """A round point."""
    return f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{radius:g}" class="{kind}"/>'


Setting = tuple[str, float, float]
"""Label, seconds and error of a setting."""
KINDS = ("on", "second", "third")


def work_panel(curves: Sequence[tuple[str, Sequence[Setting]]], unit: str, time: str) -> str:
    """Time (log) against error (log), one line per curve, each point with its setting."""
    x, y, axes = _work_axes([point for _, settings in curves for point in settings], unit, time)
    return axes + _curves(x, y, curves)


@dataclass(frozen=True)
class Choices:
    """Settings of one thing: which of them no other one beats, and what each was computed in."""

    name: str
    settings: Sequence[Setting]
    best: Collection[int]
    precisions: Sequence[str]


def front_panel(choices: Choices, unit: str, time: str) -> str:
    """The same of one curve: a line joins the best; the second precision has squares."""
    settings, best = choices.settings, choices.best
    kinds = list(dict.fromkeys(choices.precisions))
    x, y, axes = _work_axes(settings, unit, time)
    labels = Labels(BOUNDS)
    places = [(x(spent), y(off)) for _, spent, off in settings]
    front = sorted(places[i] for i in best)
    parts = [axes, text(RIGHT, TOP + 6, choices.name, "end", "head"), path(front, "front")]
    labels.written(RIGHT, TOP + 6, choices.name, "end")
    for i, kind in enumerate(kinds):
        at = x.start + 12 + 90 * i, TOP + 2
        parts += [_point(*at, "off", square=i > 0), text(at[0] + 8, at[1] + 4, kind, "start")]
        labels.written(at[0] - 8, at[1] + 4, f"## {kind}", "start")
    for i, (px, py) in enumerate(places):
        square = choices.precisions[i] != kinds[0]
        parts.append(_point(px, py, "on" if i in best else "off", square=square))
        labels.keep_clear(px, py)
    parts += [
        label(labels.place(said, *at)) for (said, _, _), at in zip(settings, places, strict=True)
    ]
    return "".join(parts)


def _work_axes(points: Sequence[Setting], unit: str, time: str) -> tuple[Scale, Scale, str]:
    """Axes that hold all settings."""
    seconds = [max(p[1], 1e-9) for p in points]
    errors = [p[2] for p in points if p[2] > 0] or [1.0]
    floor = max(min(errors) / 10, 1e-18)
    x = Scale(_below(min(seconds) / 1.5), _above(max(seconds) * 1.5), LEFT + 8, RIGHT - 8, log=True)
    y = Scale(floor, max(errors) * 3, HEIGHT - BOTTOM, TOP + 14, log=True)
    parts = [frame(x, y), text(4, 15, unit, "start", "head")]
    parts.append(text(x.end, HEIGHT - 8, time, "end"))
    for at in decades(x):
        parts.append(line(x(at), y.start, x(at), y.end, "grid"))
        parts.append(text(x(at), y.start + 15, time_text(at * 1e9)))
    for at in decades(y):
        parts.append(line(x.start, y(at), x.end, y(at), "grid"))
        parts.append(text(x.start - 5, y(at) + 4, power_text(at), "end"))
    return x, y, "".join(parts)


def _below(value: float) -> float:
    """The power of ten below a time, so that an axis has two of them."""
    return float(10.0 ** math.floor(math.log10(value)))


def _above(value: float) -> float:
    return float(10.0 ** math.ceil(math.log10(value)))


def _curves(x: Scale, y: Scale, curves: Sequence[tuple[str, Sequence[Setting]]]) -> str:
    labels = Labels(BOUNDS)
    parts, start = [], x.start + 8
    for kind, (name, _) in zip(KINDS, curves, strict=False):
        if len(curves) > 1:
            parts.append(line(start, TOP + 2, start + 16, TOP + 2, f"line {kind}"))
            parts.append(text(start + 20, TOP + 6, name, "start", "head"))
            labels.written(start, TOP + 6, name + "###", "start")
            start += 40 + 8 * len(name)
    places = [(name, x(spent), y(off)) for _, row in curves for name, spent, off in row]
    for _, px, py in places:
        labels.keep_clear(px, py, 3.5)
    for kind, (_, settings) in zip(KINDS, curves, strict=False):
        at = [(name, x(spent), y(off)) for name, spent, off in settings]
        whole = joined((px, py) for name, px, py in at if name != "=")
        parts.append(f'<polyline points="{whole}" class="line {kind}" style="fill:none"/>')
        parts += [circle(px, py, kind, 3) for _, px, py in at]
    seen: dict[tuple[str, int, int], None] = {}
    for name, px, py in places:
        if (name, round(px / 12), round(py / 12)) not in seen:  # the same said once
            seen[name, round(px / 12), round(py / 12)] = None
            parts.append(label(labels.place(name, px, py)))
    return "".join(parts)
