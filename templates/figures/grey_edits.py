"""One grey photograph four times with histograms: unchanged, fewer levels, squeezed, brightened."""

from __future__ import annotations

from functools import cache
from itertools import permutations
from typing import TYPE_CHECKING, Any

from quizgen.figures.kit import Parameter, Values, format_given, load_alt_words, require

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

PARAMETERS = {
    "n": Parameter("", "levels left by the coarse edit", low=2.0, high=32.0, whole=True),
    "low": Parameter("", "grey level that black becomes", low=0.0, high=255.0),
    "high": Parameter("", "grey level that white becomes", low=0.0, high=255.0),
    "s": Parameter("", "grey levels added, then clamped at 255", low=0.0, high=255.0),
    "order": Parameter(
        "", "permutation of (original, n, squeezed, s) at 1 to 4", 0.0, 0.0, 23.0, whole=True
    ),
}

EDITS = ("original", "coarse", "squeezed", "brightened")
BINS = 128
_PIXELS = (192, 104)
_WIDE, _HIGH, _GAP, _ROW = 144.0, 78.0, 20.0, 164.0
_BARS, _FOOT, _BETWEEN = 34.0, 14.0, 18.0
SIZE = (2 * _WIDE + _GAP, 2 * _ROW)


def order_edits(order: float) -> tuple[str, ...]:
    """Which edit has number 1, 2, 3 and 4: an index into the permutations of ``EDITS``."""
    return list(permutations(EDITS))[int(order)]


def edit_levels(edit: str, before: NDArray[np.float64], values: Values) -> NDArray[np.float64]:
    """Grey levels that an edit makes of ones from 0 to 255, not yet rounded to 8 bits."""
    import numpy as np

    gaps = values["n"] - 1
    if edit == "coarse":
        return np.floor(before / 255 * gaps + 0.5) * 255 / gaps
    if edit == "squeezed":
        return values["low"] + (values["high"] - values["low"]) * before / 255
    return np.minimum(255.0, before + (values["s"] if edit == "brightened" else 0.0))


@cache
def take_photo() -> NDArray[np.uint8]:
    """Soft shades from black to white: a sky, a field, a ball and a wall, shape (104, 192)."""
    from quizgen.camera import Camera, Length, Scene, SceneObject, picture_sets, simulate_question
    from quizgen.camera.pixels.filters import numpy_only

    size = _PIXELS[0] / 144

    def shade(shape: str, place: tuple[float, float], sides: tuple[float, float],
              first: float, last: float) -> SceneObject:  # fmt: skip
        x, y, wide, high = (Length(size * value) for value in (*place, *sides))
        return SceneObject(shape, x=x, y=y, width=wide, height=high, radius=Length(wide.value / 2),
                     texture="ramp", colour=(first,) * 3, other=(last,) * 3)  # fmt: skip

    things = (
        shade("box", (0, -13), (144, 52), 0.3, 1.0),
        shade("box", (0, 26), (144, 26), 0.5, 0.0),
        shade("disc", (-34, 6), (44, 44), 1.0, 0.05),
        shade("box", (38, 8), (44, 32), 0.65, 0.1),
    )
    with numpy_only():
        photo = simulate_question(Scene(*_PIXELS, things), Camera())
    return picture_sets.to_codes(photo.values)[..., 0]


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show numbers without the edits."""
    from quizgen.figures.photographs import check_seen, place_photo, plot_histogram

    require("grey_edits", values["low"] < values["high"], "high must be larger than low")
    for place, edit in enumerate(order_edits(values["order"])):
        codes = _edit_photo(edit, values)
        if edit != "original":
            check_seen(codes, take_photo(), f"the edit {edit}")
        left, low = place % 2 * (_WIDE + _GAP), (1 - place // 2) * _ROW + _FOOT
        plot_histogram(fig, codes, BINS, (left, low, _WIDE, _BARS))
        box = (left, low + _BARS + _BETWEEN, _WIDE, _HIGH)
        told = "" if quiz else _write_edit(values, edit)
        place_photo(fig, codes, box, number=place + 1, told=told)


def _edit_photo(edit: str, values: Values) -> NDArray[np.uint8]:
    import numpy as np

    from quizgen.camera import picture_sets

    table = edit_levels(edit, np.arange(256.0), values) / 255
    return picture_sets.to_codes(table.astype(np.float32)).take(take_photo())


def _write_edit(values: Values, edit: str) -> str:
    return {
        "original": "$I$",
        "coarse": f"$n$ = {format_given(values['n'])}",
        "squeezed": f"{format_given(values['low'])} … {format_given(values['high'])}",
        "brightened": f"$I$ + {format_given(values['s'])} ≤ 255",
    }[edit]


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words: what is seen in a quiz, else which edit it is."""
    words = load_alt_words(__file__, lang)
    fill = {name: format_given(values[name]) for name in ("n", "low", "high", "s")}
    told = [
        f"{number}: {words[edit + ' seen' if quiz else edit].format(**fill)}"
        for number, edit in enumerate(order_edits(values["order"]), 1)
    ]
    return words["figure"] + " " + "; ".join(told) + words["stop"]
