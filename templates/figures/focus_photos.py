"""Three photographs of three models by one lens: focused in turn on each, and once stopped down.

Of these four settings a permutation picks what stands at photos 1, 2 and 3; one is left over.
"""

from __future__ import annotations

from itertools import permutations
from typing import Any

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_given,
    load_alt_words,
    require,
)

from . import depth_of_field

PARAMETERS = {
    "f": Parameter("mm", "focal length", 85.0, 10.0, 200.0),
    "N_w": Parameter("", "f-number of the wide opening", 2.0, 1.0, 64.0),
    "N_s": Parameter("", "f-number when stopped down", 22.0, 1.0, 64.0),
    "z_1": Parameter("m", "distance of the left model, the house", 1.5, 0.3, 1000.0),
    "z_2": Parameter("m", "distance of the middle one, the balloon", 2.5, 0.3, 1000.0),
    "z_3": Parameter("m", "distance of the right one, the sun", 6.0, 0.3, 1000.0),
    "order": Parameter(
        "",
        "0-23: permutation of (focus on z_1, z_2, z_3, on z_2 stopped down)",
        0.0,
        0.0,
        23.0,
        whole=True,
    ),
}

_ORDERS = tuple(permutations(range(4)))
_PIXELS = 144
_WIDE, _HIGH, _GAP, _FOOT = 102.0, 68.0, 7.0, 12.0
SIZE = (3 * _WIDE + 2 * _GAP, _FOOT + _HIGH + 14)


def order_settings(values: Values) -> tuple[depth_of_field.Setting, ...]:
    """Distance in focus and f-number of photos 1, 2 and 3."""
    wide = [(values[f"z_{place}"], values["N_w"]) for place in (1, 2, 3)]
    every = [*wide, (values["z_2"], values["N_s"])]
    return tuple(every[which] for which in _ORDERS[int(values["order"])][:3])


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show their numbers without the settings."""
    from quizgen.figures.photographs import place_photo

    nearest = min(values[f"z_{place}"] for place in (1, 2, 3))
    require("focus_photos", 1000 * nearest > 2 * values["f"], "objects must be beyond 2 f")
    settings = order_settings(values)
    photos = depth_of_field.take_photos(values, _PIXELS, *settings)
    for place, (photo, (s, number)) in enumerate(zip(photos, settings, strict=True)):
        box = (place * (_WIDE + _GAP), _FOOT, _WIDE, _HIGH)
        told = "" if quiz else f"$s$ = {format_given(s)} m, $f$/{format_given(number)}"
        place_photo(fig, photo, box, number=place + 1, told=told)
        depth_of_field.write_distances(fig, values, box, 9)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, say what looks sharp instead of the settings."""
    words = load_alt_words(__file__, lang)
    depths = [values[f"z_{place}"] for place in (1, 2, 3)]
    told = [words["figure"].format(*map(format_given, depths))]
    for mark, (s, number) in enumerate(order_settings(values), 1):
        if not quiz:
            blur = depth_of_field.measure_discs({**values, "s": s}, number)
            sizes = map(format_derived, blur)
            told.append(
                words["setting"].format(mark, format_given(s), format_given(number), *sizes)
            )
        elif number == values["N_s"]:
            told.append(words["all"].format(mark))
        else:
            told.append(words["one"].format(mark, format_given(s)))
    return " ".join(told)
