"""A camera over a page that curls, from the side."""

from __future__ import annotations

from typing import Any

import numpy as np

from quizgen.figures.kit import Parameter, Values, format_given, load_alt_words

SIZE = (230.0, 150.0)
PARAMETERS = {
    "room": Parameter("mm", "most that lens and page are apart", 600, 100, 2000),
    "c": Parameter("mm", "how far pages curl up and down", 10, 1, 50),
}

_MIDDLE, _PAGE, _LENS, _SENSOR = 104.0, 22.0, 112.0, 140.0


def draw(fig: Any, values: Values, *, quiz: bool) -> None:  # noqa: ARG001 - it shows no result
    """Draw sensor, lens, page and the distances."""
    art = fig.sketch()
    half, image = 80.0, 80.0 * (_SENSOR - _LENS) / (_LENS - _PAGE)
    for wide, height in ((half, _PAGE), (image, _SENSOR)):
        cone = [(_MIDDLE - wide, height), (_MIDDLE, _LENS), (_MIDDLE + wide, height)]
        art.area(cone, "pale-gold", part="field")
    ends = [(_MIDDLE + side * (image + 3), _SENSOR) for side in (-1, 1)]
    art.line(ends, "ink", 2.4, part="sensor")
    art.arrow((_MIDDLE - 34, _LENS), (_MIDDLE + 34, _LENS), both=True, part="lens")
    xs = np.linspace(-half, half, 61)
    page = [(float(_MIDDLE + x), float(_PAGE + 5 * np.sin(3 * np.pi * x / half))) for x in xs]
    art.line(page, "blue", 1.4, part="page")
    plane = [(_MIDDLE - half, _PAGE), (_MIDDLE + half, _PAGE)]
    art.line(plane, "grey", 0.6, dashes=(3, 2), part="plane")
    art.measure((_MIDDLE + half + 12, _PAGE), (_MIDDLE + half + 12, _LENS),
                f"$z$ ≤ {format_given(values['room'])} mm")  # fmt: skip
    art.label((_MIDDLE - half, _PAGE - 12), f"± {format_given(values['c'])} mm", "lm")
    art.label((_MIDDLE + 40, _LENS), "$f$, $N$", "lm", halo=True)


def alt(values: Values, lang: str, *, quiz: bool) -> str:  # noqa: ARG001 - it shows no result
    """Return the camera and its page in words."""
    shown = {name: format_given(values[name]) for name in PARAMETERS}
    return load_alt_words(__file__, lang)["figure"].format(**shown)
