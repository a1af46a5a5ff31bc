"""A straight line over a grid with numbers."""

import numpy as np

from quizgen.figures.kit import SQUARE, Parameter, format_given

PARAMETERS = {
    "m": Parameter("", "slope"),
    "b": Parameter("", "height at 0"),
    "x": Parameter("", "place"),
}
SIZE = SQUARE


def draw(ax, values, *, quiz):
    x = np.array([-5, 5])
    ax.plot(x, values["m"] * x + values["b"], "blue")
    ax.set(xlim=(-5, 5), ylim=(-10, 10), xlabel="$x$", ylabel="$y$")
    ax.set(xticks=range(-5, 6), yticks=range(-10, 11, 2))
    ax.grid(color="rule")
    if not quiz:
        ax.plot(values["x"], values["m"] * values["x"] + values["b"], "o", color="red")


def mark(ax, values, marks):
    ax.plot(values["x"], marks["y"], "o", color="gold")


def alt(values, lang, *, quiz):
    low = format_given(-5 * values["m"] + values["b"])
    start = format_given(values["b"])
    return f"A straight line over a grid. It goes through (0, {start}) and (-5, {low})."
