"""Signs of the subject: an aperture that opens with what is known, and a scale on a lens."""

from __future__ import annotations

import math

from markupsafe import Markup

BLADES, RADIUS = 7, 20.0
"""Of the aperture: its radius when wide open, of a picture of 48."""
SCALE_LEFT, SCALE_WIDE = 40.0, 640.0
"""Where the scale on the lens begins, and how long it is, of a picture of 720."""


def draw_aperture(share: float) -> Markup:
    """Return a picture of an aperture whose open area is a share of the whole, 0 to 1."""
    opening = RADIUS * math.sqrt(min(max(share, 0.02), 1.0))
    corners = [_corner(opening, turn) for turn in range(BLADES)]
    rims = [_corner(RADIUS, turn + 1.6) for turn in range(BLADES)]
    blades = " ".join(
        f"M{x:.1f} {y:.1f}L{to_x:.1f} {to_y:.1f}"
        for (x, y), (to_x, to_y) in zip(corners, rims, strict=True)
    )
    outline = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
    return Markup(
        '<svg class="aperture" viewBox="0 0 48 48" width="40" height="40" aria-hidden="true">'
        '<circle class="rim" cx="24" cy="24" r="22"/><path class="blades" d="{}"/>'
        '<polygon class="opening" points="{}"/></svg>'
    ).format(blades, outline)


def _corner(radius: float, turn: float) -> tuple[float, float]:
    """Return a point on a circle around the middle, a number of blades on from the right."""
    angle = 2 * math.pi * turn / BLADES + 0.3
    return 24 + radius * math.cos(angle), 24 + radius * math.sin(angle)


def draw_lens_scale(
    of: float, low: float, high: float, expected: float | None, labels: list[str]
) -> Markup:
    """Return a lens barrel with a scale of points; brackets hold the range, a mark the estimate.

    Parameters
    ----------
    of : float
        Points at the right end.
    low, high : float
        Ends of the range.
    expected : float, optional
        Where the mark is; none before there is evidence.
    labels : list of str
        Numbers of the large ticks, evenly from 0 to ``of``.
    """

    def across(points: float) -> float:
        return round(SCALE_LEFT + SCALE_WIDE * points / of, 1)

    large = len(labels) - 1
    small = Markup().join(
        Markup('<path class="tick" d="M{} 62v7"/>').format(across(of * k / (4 * large)))
        for k in range(4 * large + 1)
    )
    ticks = Markup().join(
        Markup('<path class="tick large" d="M{0} 60v14"/><text x="{0}" y="50">{1}</text>').format(
            across(of * k / large), label
        )
        for k, label in enumerate(labels)
    )
    grip = Markup().join(
        Markup('<rect class="grip" x="{}" y="0" width="7" height="16" rx="2"/>').format(x)
        for x in range(4, 720, 14)
    )
    mark = (
        Markup('<path class="mark" d="M{0} 76v14l-8 12 8 12 8-12-8-12"/>').format(across(expected))
        if expected is not None
        else Markup()
    )
    return Markup(
        '<svg class="barrel" viewBox="0 0 720 128" aria-hidden="true">'
        '<rect class="body" width="720" height="128" rx="20"/>{}'
        '<path class="groove" d="M0 88H720"/>{}{}'
        '<path class="range" d="M{} 96v10q0 6 6 6H{}q6 0 6-6V96"/>{}</svg>'
    ).format(grip, small, ticks, across(low), across(high) - 6, mark)
