"""Two kinds of plot as SVG text: accuracy against time, and work against precision.

Points carry numbers that the table repeats, so nothing rests on colour; colours are CSS classes
with fallbacks, so the same SVG serves light and dark pages and stands alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files

STYLE = """
.tp text{font:11px system-ui,"Hind Siliguri","QuizBangla",sans-serif;fill:currentColor}
.tp .axis{stroke:currentColor;stroke-width:1;fill:none}
.tp .grid{stroke:currentColor;stroke-width:.5;opacity:.18}
.tp .rule{stroke:currentColor;stroke-width:1;stroke-dasharray:5 3;opacity:.7}
.tp .front{stroke:#0b62c4;stroke-width:2;fill:none}
.tp .on{fill:#0b62c4;stroke:#0b62c4}.tp .off{fill:none;stroke:currentColor;opacity:.65}
.tp .second{stroke:#b3470a;fill:#b3470a}.tp .third{stroke:#3f7d20;fill:#3f7d20}
.tp .line{fill:none;stroke-width:1.6}.tp .small{font-size:10px}.tp .head{font-weight:600}
"""


def style() -> str:
    """The style of measurements on a page."""
    return (files("quizgen.tradeoff") / "pages" / "measured.css").read_text("utf-8") + STYLE


PANEL, HEIGHT, LEFT, TOP, BOTTOM = 430, 300, 52, 26, 44


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


def document(body: str, width: int, height: int, title: str) -> str:
    """Wrap elements in one SVG with its own style."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="tp" role="img" '
        f'viewBox="0 0 {width} {height}" width="{width}" height="{height}">'
        f"<title>{escape(title)}</title><style>{STYLE}</style>{body}</svg>"
    )


def time_text(nanoseconds: float) -> str:
    """A time with a unit that keeps it short."""
    for factor, unit in ((1e9, "s"), (1e6, "ms"), (1e3, "µs")):
        if nanoseconds >= factor:
            return f"{nanoseconds / factor:.3g} {unit}"
    return f"{nanoseconds:.3g} ns"


def _text(x: float, y: float, text: str, anchor: str = "middle", kind: str = "small") -> str:
    at = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" class="{kind}"'
    return f"<text {at}>{escape(text)}</text>"


def _line(x1: float, y1: float, x2: float, y2: float, kind: str) -> str:
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" class="{kind}"/>'


def _decades(scale: Scale) -> list[float]:
    first, last = math.ceil(math.log10(scale.low)), math.floor(math.log10(scale.high))
    stride = max(1, math.ceil((last - first) / 7))
    return [10.0**n for n in range(first, last + 1, stride)]


def _frame(x: Scale, y: Scale) -> str:
    points = f"{x.start},{y.end} {x.start},{y.start} {x.end},{y.start}"
    return f'<polyline points="{points}" class="axis"/>'


def accuracy_panel(
    offset: int,
    title: str,
    marks: Sequence[Mark],
    rules: Sequence[tuple[float, str]],
    axes: tuple[str, str],
) -> str:
    """One panel: time per value (log) against bits of error."""
    x = Scale(0.3, 3e7, offset + LEFT, offset + PANEL - 12, log=True)
    y = Scale(0.0, 66.0, HEIGHT - BOTTOM, TOP)
    parts = [_text(offset + PANEL / 2, 15, title, kind="head"), _frame(x, y)]
    parts.append(_text(x.end, HEIGHT - 8, axes[0], "end"))
    parts.append(_text(offset + 8, 15, axes[1], "start"))
    for at in (1.0, 1e2, 1e4, 1e6):
        parts.append(_line(x(at), y.start, x(at), y.end, "grid"))
        parts.append(_text(x(at), y.start + 15, time_text(at)))
    for at in (0, 16, 32, 48, 64):
        parts.append(_line(x.start, y(at), x.end, y(at), "grid"))
        parts.append(_text(x.start - 6, y(at) + 4, str(at), "end"))
    for (at, label), below in zip(rules, (False, True), strict=False):
        parts.append(_line(x.start, y(at), x.end, y(at), "rule"))
        parts.append(_text(x.end - 2, y(at) + (11 if below else -4), label, "end"))
    front = sorted((mark for mark in marks if mark.front), key=lambda mark: mark.x)
    path = " ".join(f"{x(mark.x):.1f},{y(mark.y):.1f}" for mark in front)
    parts.append(f'<polyline points="{path}" class="front"/>')
    parts += [_dot(x(mark.x), y(mark.y), mark) for mark in marks]
    return "".join(parts) + _numbers(x, y, marks)


def _dot(px: float, py: float, mark: Mark) -> str:
    kind = "on" if mark.front else "off"
    if mark.scalar:
        return f'<rect x="{px - 4:.1f}" y="{py - 4:.1f}" width="8" height="8" class="{kind}"/>'
    return f'<circle cx="{px:.1f}" cy="{py:.1f}" r="4.5" class="{kind}"/>'


_PLACES = ((0, -8), (11, 4), (-11, 4), (10, -9), (-10, -9), (0, -19), (11, -17), (-11, -17))
"""Where a number may stand beside its point, best place first."""


def _numbers(x: Scale, y: Scale, marks: Sequence[Mark]) -> str:
    """Numbers beside the points, moved apart where points lie close together."""
    taken = [(x(mark.x), y(mark.y) + 4) for mark in marks]
    parts = []
    for mark in sorted(marks, key=lambda mark: (mark.x, mark.y)):
        px, py = x(mark.x), y(mark.y)
        for dx, dy in _PLACES:
            spot = (px + dx, py + dy)
            if all(abs(spot[0] - a) > 9 or abs(spot[1] - b) > 9 for a, b in taken):
                break
        taken.append(spot)
        parts.append(_text(*spot, str(mark.number)))
    return "".join(parts)


def work_panel(curves: Sequence[tuple[str, Sequence[tuple[str, float, float]]]], unit: str) -> str:
    """Time (log) against error (log), one line per curve, each point with its setting."""
    points = [point for _, line in curves for point in line]
    seconds = [max(p[1], 1e-9) for p in points]
    errors = [p[2] for p in points if p[2] > 0]
    floor = max(min(errors) / 10, 1e-18)
    x = Scale(min(seconds) / 2, max(seconds) * 3, LEFT + 8, PANEL + 130, log=True)
    y = Scale(floor, max(errors) * 3, HEIGHT - BOTTOM, TOP, log=True)
    parts = [_frame(x, y), _text(x.start - 8, 15, unit, "start", "head")]
    for at in _decades(x):
        parts.append(_line(x(at), y.start, x(at), y.end, "grid"))
        parts.append(_text(x(at), y.start + 15, time_text(at * 1e9)))
    for at in _decades(y):
        parts.append(_line(x.start, y(at), x.end, y(at), "grid"))
        parts.append(_text(x.start - 6, y(at) + 4, f"{at:.0e}", "end"))
    kinds = ("on", "second", "third")
    for i, (kind, (label, line)) in enumerate(zip(kinds, curves, strict=False)):
        parts.append(_curve(x, y, kind, line))
        parts.append(_legend(x.end - 70, TOP + 8 + 15 * i, kind, label))
    return "".join(parts)


def _legend(px: float, py: float, kind: str, label: str) -> str:
    line = f'<polyline points="{px:.1f},{py:.1f} {px + 16:.1f},{py:.1f}" class="line {kind}"/>'
    return line + _text(px + 21, py + 4, label, "start", "head")


def _curve(x: Scale, y: Scale, kind: str, line: Sequence[tuple[str, float, float]]) -> str:
    """The settings joined by a line; the closed form stands alone."""
    at = [(name, x(seconds), y(error)) for name, seconds, error in line]
    path = " ".join(f"{px:.1f},{py:.1f}" for name, px, py in at if name != "=")
    parts = [f'<polyline points="{path}" class="line {kind}" style="fill:none"/>']
    for name, px, py in at:
        parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3" class="{kind}"/>')
        parts.append(_text(px + 5, py - 5, name, "start"))
    return "".join(parts)
