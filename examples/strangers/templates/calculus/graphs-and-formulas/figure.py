"""Four curves, numbered, out of six."""

import numpy as np

from quizgen.figures.kit import Parameter

PARAMETERS = {"order": Parameter("", "which curves, 0 to 5", kind="list")}
SIZE = (260, 230)
CURVES = (np.exp, np.sin, lambda x: x**2 - 1, lambda x: x**3 - x, lambda x: 1 / (1 + x**2), np.abs)


def draw(fig, values, *, quiz):
    x = np.linspace(-2, 2, 101)
    for number, (ax, which) in enumerate(
        zip(fig.subplots(2, 2).flat, values["order"], strict=True), 1
    ):
        ax.plot(x, CURVES[int(which)](x))
        ax.set(ylim=(-2.5, 4), xticks=(-2, -1, 0, 1, 2), yticks=(-2, 0, 2), title=str(number))
        ax.set(xlabel="$x$", ylabel="$y$")


def alt(values, lang, *, quiz):
    shapes = (
        "rises ever more steeply and is never 0",
        "is a wave through the origin",
        "is a bowl with its lowest point at height -1",
        "rises, falls a little around the origin, and rises",
        "is a hill of height 1",
        "is a V with its corner at the origin",
    )
    listed = "; ".join(f"{n} {shapes[int(k)]}" for n, k in enumerate(values["order"], 1))
    return f"Four curves between -2 and 2: {listed}."
