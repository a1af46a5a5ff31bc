"""A directed graph on four nodes."""

import numpy as np

from quizgen.figures.kit import Parameter

PARAMETERS = {"e": Parameter("", "sixteen entries, row after row", kind="list")}
SIZE = (160, 150)
PLACES = np.array([(30, 120), (130, 120), (130, 30), (30, 30)])


def draw(fig, values, *, quiz):
    art, edges = fig.sketch(), np.reshape(values["e"], (4, 4))
    for i, start in enumerate(PLACES):
        for j, stop in enumerate(PLACES):
            if edges[i, j]:
                step = 13 * (stop - start) / np.linalg.norm(stop - start)
                art.arrow(tuple(start + step), tuple(stop - step))
        art.arc(tuple(start), 12, 0, 360)
        art.label(tuple(start), str(i + 1), "cm")


def alt(values, lang, *, quiz):
    edges = np.reshape(values["e"], (4, 4))
    listed = ", ".join(f"{i + 1} to {j + 1}" for i in range(4) for j in range(4) if edges[i, j])
    return f"A directed graph on the nodes 1 to 4. Arrows: {listed}."
