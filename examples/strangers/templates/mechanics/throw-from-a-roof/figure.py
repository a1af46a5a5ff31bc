"""A ball that is thrown from a building."""

import numpy as np

from quizgen.figures.kit import Parameter, format_given

PARAMETERS = {
    "h": Parameter("m", "height of the roof"),
    "v": Parameter("m/s", "initial speed"),
    "alpha": Parameter("°", "angle above the horizontal"),
}
SIZE = (250, 150)


def draw(fig, values, *, quiz):
    art = fig.sketch()
    art.area([(10, 15), (60, 15), (60, 85), (10, 85)], "shade", "ink")
    for column in (18, 41):
        for row in (25, 45, 65):
            art.area(
                [(column, row), (column + 10, row), (column + 10, row + 12), (column, row + 12)],
                "paper",
                "grey",
            )
    art.line([(0, 15), (245, 15)], "ink", 1)
    x = np.linspace(0, 160, 40)
    art.line(
        [
            (60 + a, 85 + 0.75 * a - 0.0075 * a * a)
            for a in x
            if 85 + 0.75 * a - 0.0075 * a * a > 15
        ],
        "grey",
        0.8,
    )
    art.arrow((60, 85), (94, 111), "blue", 1.4)
    art.dot((60, 85), 3.5)
    art.label((97, 118), f"{format_given(values['v'])} m/s", "lm")
    art.label((95, 93), f"{format_given(values['alpha'])}°", "lm")
    art.line([(60, 85), (92, 85)], "grey", 0.6)
    art.measure((4, 15), (4, 85), "")
    art.label((14, 96), f"{format_given(values['h'])} m", "lm")


def alt(values, lang, *, quiz):
    h, v, alpha = (format_given(values[name]) for name in ("h", "v", "alpha"))
    start = f"at {v} m/s and {alpha}° above the horizontal"
    return f"A ball is thrown from a roof {h} m high, {start}, and falls to the ground."
