"""Curves of equal density of Gaussians in the plane: one with its axes, or several."""

from __future__ import annotations

from functools import cache
from math import exp, pi, sqrt
from typing import Any

import numpy as np

from quizgen.figures.kit import (
    ABSENT,
    Parameter,
    Values,
    format_derived,
    format_given,
    load_alt_words,
    relation_sign,
    require,
)

SIZE = (312.0, 170.0)

PARAMETERS = {
    "covariances": Parameter("", "one row a Gaussian: variance of x, covariance, variance of y",
                             ((4.0, 0.0, 4.0), (4.0, 0.0, 1.0), (1.0, 0.0, 4.0), (2.0, 1.0, 2.0),
                              (2.0, -1.0, 2.0)), -1e6, 1e6, kind="table"),
    "x": Parameter("", "a point, if there is one Gaussian", ABSENT, -1e6, 1e6),
    "y": Parameter("", "its other coordinate", ABSENT, -1e6, 1e6),
}  # fmt: skip

_STEPS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0)


@cache
def _circle() -> Any:
    turns = np.linspace(0, 2 * pi, 73)
    return np.stack([np.cos(turns), np.sin(turns)])


def contour(covariance: tuple[float, float, float], k: float) -> Any:
    """Points (n, 2) where the quadratic form of the inverse matrix is k²."""
    xx, xy, yy = covariance
    root = np.linalg.cholesky(np.array([[xx, xy], [xy, yy]]))
    return (k * root @ _circle()).T


def quadratic_form(covariance: tuple[float, float, float], x: float, y: float) -> float:
    """Value q of the quadratic form of the inverse matrix."""
    xx, xy, yy = covariance
    return (yy * x * x - 2 * xy * x * y + xx * y * y) / (xx * yy - xy * xy)


def density_at(covariance: tuple[float, float, float], x: float, y: float) -> float:
    """Density of the Gaussian with mean 0."""
    xx, xy, yy = covariance
    return exp(-quadratic_form(covariance, x, y) / 2) / (2 * pi * sqrt(xx * yy - xy * xy))


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, several are numbered, and one has no curve through the point.

    Raises
    ------
    BankError
        If a row is no covariance matrix.
    """
    rows = values["covariances"]
    for row in rows:
        good = len(row) == 3 and row[0] > 0 and row[0] * row[2] > row[1] ** 2
        require("gaussian_contours", good, f"{row} is no variance, covariance, variance")
    if len(rows) == 1:
        _draw_one(fig, values, rows[0], quiz)
        return
    reach = 2.5 * max(max(row[0], row[2]) for row in rows) ** 0.5
    side = min(92.0, 440 / len(rows) - 10)
    for number, row in enumerate(rows):
        art, at = fig.sketch(), (number * (side + 10) + side / 2, 90.0)
        scale = side / 2 / reach
        for end in ((side / 2, 0), (0, side / 2)):
            art.arrow(
                (at[0] - end[0], at[1] - end[1]),
                (at[0] + end[0], at[1] + end[1]),
                "grey",
                0.6,
                size=5,
                part="axes",
            )
        for k, width in ((1, 1.3), (2, 0.9)):
            art.line(contour(row, k) * scale + at, "blue", width, part=f"contour-{number}")
        art.label((at[0] + side / 2, at[1] - 8), "$x$", "r")
        art.label((at[0] + 4, at[1] + side / 2 - 1), "$y$", "l")
        low = at[1] - side / 2 - 10
        if quiz:
            art.label((at[0], low), str(number + 1))
            continue
        for line, pair in enumerate((row[:2], row[1:])):
            art.label((at[0], low - 13 * line), "({}; {})".format(*map(format_given, pair)))


def _draw_one(fig: Any, values: Values, row: Any, quiz: bool) -> None:
    spread = sqrt(row[0]), sqrt(row[2])
    point = (values["x"], values["y"]) if "x" in values and "y" in values else None
    reach = 1.15 * max(2 * max(spread), *(abs(c) for c in point or (0.0,)))
    ax = fig.axes_in(40, 30, 136, 136)
    ax.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel="$x$", ylabel="$y$")
    step = next((s for s in _STEPS if reach / s < 4.5), reach / 2)
    ticks = step * np.arange(-int(reach / step), int(reach / step) + 1)
    names = [format_given(tick) for tick in ticks]
    ax.set_xticks(ticks, names)
    ax.set_yticks(ticks, names)
    art = fig.sketch(ax)
    for end in ((reach, 0), (0, reach)):
        art.line([(-end[0], -end[1]), end], "rule", 0.6, part="axes")
    for k, width in ((1, 1.4), (2, 1.0)):
        art.line(contour(row, k), "blue", width, part=f"contour-{k}")
    lines = [
        (rf"$\sigma_{n} = {format_given(s)}$", "ink") for n, s in ((1, spread[0]), (2, spread[1]))
    ]
    for n, end in ((1, (spread[0], 0)), (2, (0, spread[1]))):
        art.arrow((0, 0), end, "ink", 1.1, part=f"axis-{n}")
    if point:
        q = quadratic_form(row, *point)
        if not quiz:
            art.line(contour(row, sqrt(q)), "red", 1.0, dashes=(4, 2), part="through")
            g = density_at(row, *point)
            lines += [
                (f"$q$ {relation_sign(q)} {format_derived(q)}", "red"),
                (f"$g$ {relation_sign(g)} {format_derived(g)}", "red"),
            ]
        art.dot(point, 2.6, "red", part="point")
        lines.insert(2, (f"$(x; y)$ = ({format_given(point[0])}; {format_given(point[1])})", "red"))
    note = fig.sketch()
    for number, (text, fill) in enumerate(lines):
        note.label((192, 140 - 16 * number), text, "l", fill=fill)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without matrices, and without density and form."""
    words, rows = load_alt_words(__file__, lang), values["covariances"]
    if len(rows) > 1:
        text = words["several"].format(count=len(rows))
        if quiz:
            return text
        said = (
            words["matrix"].format(
                first="; ".join(map(format_given, row[:2])),
                second="; ".join(map(format_given, row[1:])),
                shape=words[_shape(row)],
            )
            for row in rows
        )
        return text + "".join(said)
    row = rows[0]
    text = words["one"].format(*(format_given(sqrt(row[i])) for i in (0, 2)))
    if "x" not in values or "y" not in values:
        return text
    x, y = values["x"], values["y"]
    text += words["point"].format(x=format_given(x), y=format_given(y))
    if quiz:
        return text
    found = quadratic_form(row, x, y), density_at(row, x, y)
    q, g = (f"{relation_sign(v)} {format_derived(v)}" for v in found)
    return text + words["answer"].format(q=q, g=g)


def _shape(row: tuple[float, float, float]) -> str:
    if row[1]:
        return "rising" if row[1] > 0 else "falling"
    return "circles" if row[0] == row[2] else "wide" if row[0] > row[2] else "tall"
