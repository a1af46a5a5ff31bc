"""Light, reflectance and their product, which comes back, in three bands of wavelengths."""

from __future__ import annotations

from typing import Any

from quizgen.figures.kit import Parameter, Values, format_derived, format_given, load_alt_words

SIZE = (312.0, 120.0)

_BANDS = {"b": ("blue", "pale-blue"), "g": ("teal", "pale-teal"), "r": ("red", "pale-red")}
PARAMETERS = {
    f"{letter}_{band}": Parameter("", f"{meaning} in {name}", None, 0.0, 1.0)
    for letter, meaning in (("L", "strength of the light"), ("R", "reflectance"))
    for band, name in (("r", "red"), ("g", "green"), ("b", "blue"))
}

_LOW, _HIGH, _WIDE, _NEXT = 28.0, 66.0, 81.0, 116.0


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, with a question mark for what comes back."""
    art, low, high = fig.sketch(), _LOW, _LOW + _HIGH
    for place, name in enumerate(("$L$", "$R$", "$L·R$")):
        left = 18 + _NEXT * place
        for number, (band, (line, fill)) in enumerate(_BANDS.items()):
            x, wide = left + number * _WIDE / 3, _WIDE / 3
            sent, kept = values[f"L_{band}"], values[f"R_{band}"]
            value = (sent, kept, sent * kept)[place]
            art.label((x + wide / 2, low - 8), f"${band}$", fill=line)
            if place == 2 and quiz:
                continue
            top = low + value * _HIGH
            corners = [(x, low), (x, top), (x + wide, top), (x + wide, low)]
            art.area(corners, fill, None, part=f"{band}-{place}")
            art.line(corners, line, 1.0, part=f"outline-{place}")
            art.label((x + wide / 2, top + 3), format_derived(value), "cb", 9)
        art.arrow((left, low), (left + _WIDE + 9, low), "ink", 0.7, size=5.5, part="axes")
        art.arrow((left, low), (left, high + 19), "ink", 0.7, size=5.5, part="axes")
        art.line([(left - 3, high), (left, high)], "ink", 0.6, part="axes")
        art.label((left - 5, high), "1", "r", 9)
        art.label((left + 6, high + 19), name, "l")
        for number in range(4):
            x = left + number * _WIDE / 3
            art.line([(x, low), (x, low - 3)], "ink", 0.6, part="axes")
            art.label((x, low - 16), str(400 + 100 * number), "ct", 8)
        art.label((left + _WIDE + 9, low - 30), r"$\lambda$ / nm", "rt", 9)
    for place, sign in ((0, "×"), (1, "=")):
        art.label((18 + _NEXT * place + _WIDE + 16, low + _HIGH / 2), sign, size=13)
    if quiz:
        art.label((18 + 2 * _NEXT + _WIDE / 2, low + _HIGH / 2), "?", size=20, fill="grey")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without what comes back."""
    words = load_alt_words(__file__, lang)
    text = words["figure"].format(**{name: format_given(value) for name, value in values.items()})
    if quiz:
        return text + words["quiz"]
    back = {band: format_derived(values[f"L_{band}"] * values[f"R_{band}"]) for band in _BANDS}
    return text + words["answer"].format(**back)
