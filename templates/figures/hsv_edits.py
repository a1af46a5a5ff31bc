"""One scene four times: unchanged, value scaled, saturation scaled, hue turned."""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING, Any

from quizgen.figures.kit import Parameter, Values, format_given, load_alt_words, strip_mathtext

if TYPE_CHECKING:
    from ._scene import Colour

PARAMETERS = {
    "a": Parameter("1", "factor on the value V", low=0.0, high=1.0),
    "b": Parameter("1", "factor on the saturation S", low=0.0, high=1.0),
    "delta": Parameter("deg", "turn of the hue H", low=-360.0, high=360.0),
    "order": Parameter(
        "",
        "which permutation of (original, V, S, H) stands at 1 to 4, as order_edits says",
        0.0,
        0.0,
        23.0,
        whole=True,
    ),
    "scene": Parameter("", "variant of the scene", 0.0, 0.0, 7.0, whole=True),
}

COLOUR = True

EDITS = ("original", "V", "S", "H")
_WIDE, _HIGH, _GAP, _ROW = 152.0, 70.5, 8.0, 92.0
SIZE = (2 * _WIDE + _GAP, 2 * _ROW)


def order_edits(order: float) -> tuple[str, ...]:
    """Which edit has number 1, 2, 3 and 4.

    Parameters
    ----------
    order : float
        A whole number from 0 to 23: index into the permutations of ``EDITS`` in lexicographic
        order of positions; 0 leaves them as they are, 23 turns them round.

    Returns
    -------
    tuple of str
        Four names from ``EDITS``.
    """
    return list(permutations(EDITS))[int(order)]


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show numbers without the edits."""
    import numpy as np

    from quizgen.figures.photographs import check_seen, place_photo

    from ._scene import paint_scene

    pixels, palette = paint_scene(int(values["scene"]))
    palettes = _edit_palette(palette, values)
    some = pixels[::4, ::4]  # what differs in a whole picture differs in a sixteenth of it
    original, *edited = (np.array(palettes[edit], np.uint8)[some] for edit in EDITS)
    for photo, edit in zip(edited, EDITS[1:], strict=True):
        check_seen(photo, original, f"the edit of {edit}", grey=not COLOUR)
    for place, edit in enumerate(order_edits(values["order"])):
        box = (place % 2 * (_WIDE + _GAP), (1 - place // 2) * _ROW, _WIDE, _HIGH)
        told = "" if quiz else _write_edit(values, edit)
        place_photo(fig, pixels, box, palette=palettes[edit], number=place + 1, told=told)


def _write_edit(values: Values, edit: str) -> str:
    sign = "+" if values["delta"] >= 0 else "−"
    return {
        "original": "$H$, $S$, $V$",
        "V": f"$V$ × {format_given(values['a'])}",
        "S": f"$S$ × {format_given(values['b'])}",
        "H": f"$H$ {sign} {format_given(abs(values['delta']))}°",
    }[edit]


def _edit_palette(palette: tuple[Colour, ...], values: Values) -> dict[str, Any]:
    """The scene's colours under each edit, by the camera's own editing step."""
    import numpy as np

    from quizgen.camera import picture_sets
    from quizgen.camera.pixels.filters import numpy_only

    colours = np.asarray(palette, np.float32)[None] / np.float32(255.0)
    with numpy_only():
        made = picture_sets.make_hsv_edits(colours, values["a"], values["b"], values["delta"])
    return {
        edit: picture_sets.to_codes(image)[0].tolist()
        for edit, image in zip(EDITS, made, strict=True)
    }


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out which edit made which picture."""
    words = load_alt_words(__file__, lang)
    if quiz:
        return words["figure"] + words["quiz"]
    captions = []
    for number, edit in enumerate(order_edits(values["order"]), 1):
        original = edit == "original"
        what = words["original"] if original else strip_mathtext(_write_edit(values, edit))
        captions.append(f"{number}: {what}")
    return words["figure"] + " " + "; ".join(captions) + words["stop"]
