"""Three photographs of three objects by one lens: focused in turn on each, and once stopped down.

Of these four settings a permutation picks what stands at photos 1, 2 and 3; one is left over.
"""

from __future__ import annotations

from itertools import permutations

from quizgen.figures.kit import (
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Values,
    derived,
    given,
    numbered,
    require,
    words_of,
)

from . import depth_of_field

DARK = "keep"

PARAMETERS = {
    "f": Parameter("mm", "focal length", 85.0, 10.0, 200.0),
    "N_w": Parameter("", "f-number of the wide opening", 2.0, 1.0, 64.0),
    "N_s": Parameter("", "f-number when stopped down", 22.0, 1.0, 64.0),
    "z_1": Parameter("m", "distance of the left object", 1.5, 0.3, 1000.0),
    "z_2": Parameter("m", "distance of the middle object", 2.5, 0.3, 1000.0),
    "z_3": Parameter("m", "distance of the right object", 6.0, 0.3, 1000.0),
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
_WIDE = 96
_GAP, _TOP, _BELOW = 6.0, 15.0, 14.0


def settings(values: Values) -> tuple[depth_of_field.Setting, ...]:
    """Distance in focus and f-number of photos 1, 2 and 3."""
    wide = [(values[f"z_{place}"], values["N_w"]) for place in (1, 2, 3)]
    every = [*wide, (values["z_2"], values["N_s"])]
    return tuple(every[which] for which in _ORDERS[int(values["order"])][:3])


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show their numbers without the settings."""
    from quizgen.figures.photographs import place as put

    nearest = min(values[f"z_{place}"] for place in (1, 2, 3))
    require("focus_photos", 1000 * nearest > 2 * values["f"], "objects must be beyond 2 f")
    wide = (WIDTH - 4 * _GAP) / 3
    high = wide * 2 / 3
    pen = Pen(WIDTH, _BELOW + high + _TOP + 2)
    photos = depth_of_field.photos_of(values, _WIDE, *settings(values))
    for place, (photo, (s, number)) in enumerate(zip(photos, settings(values), strict=True)):
        left = _GAP + place * (wide + _GAP)
        put(canvas, pen, photo, (left, _BELOW, wide, high))
        told = f"{given(s)} {{m,}} f{{/{given(number)}}}"
        pen.label((left + wide / 2, pen.height - 8), numbered(place + 1, told, quiz=quiz))
        depth_of_field.distances(pen, values, left, wide, 8.5)
    pen.onto(canvas, background="#ffffff")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, say what looks sharp instead of the settings."""
    words = words_of(__file__, lang)
    depths = [values[f"z_{place}"] for place in (1, 2, 3)]
    told = [words["figure"].format(*map(given, depths))]
    for mark, (s, number) in enumerate(settings(values), 1):
        if not quiz:
            blur = depth_of_field.discs({**values, "s": s}, number)
            told.append(words["setting"].format(mark, given(s), given(number), *map(derived, blur)))
        elif number == values["N_s"]:
            told.append(words["all"].format(mark))
        else:
            told.append(words["one"].format(mark, given(s)))
    return " ".join(told)
