"""Spectrum of a lamp and reflectance of a surface, as two curves of straight pieces."""

from __future__ import annotations

from typing import Any

from quizgen.figures.kit import Parameter, Values, format_given, load_alt_words

_PLACES = (400, 500, 600, 700)
PARAMETERS = {
    f"{letter}_{place}": Parameter("", f"{meaning} at {place} nm", None, 0.0, 1.0)
    for letter, meaning in (("L", "strength of the lamp"), ("R", "reflectance of the surface"))
    for place in _PLACES
}
SIZE = (250.0, 130.0)


def draw(ax: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure, in a solution with the product of both curves."""
    ax.set(xlim=(395, 705), ylim=(0, 1.05), xlabel=r"$\lambda$ / nm", ylabel="$L$, $R$")
    ax.set_xticks(range(400, 701, 50))
    ax.set_yticks([tenth / 5 for tenth in range(6)])
    ax.grid(visible=True, color="rule", linewidth=0.4)
    lamp, surface = ([values[f"{letter}_{place}"] for place in _PLACES] for letter in "LR")
    ax.plot(_PLACES, lamp, "blue", label="$L$", gid="lamp")
    ax.plot(_PLACES, surface, "red", linestyle=(0, (4, 2)), label="$R$", gid="surface")
    if not quiz:
        steps = range(400, 701, 10)
        sent, kept = (_follow(curve, steps) for curve in (lamp, surface))
        both = [one * other for one, other in zip(sent, kept, strict=True)]
        ax.plot(steps, both, "ink", linewidth=2.2, label="$L·R$", gid="product")
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _follow(curve: list[float], steps: range) -> list[float]:
    """Return the heights of a curve of straight pieces at steps of wavelength."""
    heights = []
    for step in steps:
        piece, along = divmod(step - _PLACES[0], 100)
        right = curve[min(piece + 1, len(curve) - 1)]
        heights.append(curve[piece] + (right - curve[piece]) * along / 100)
    return heights


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe both curves at their corners."""
    words = load_alt_words(__file__, lang)
    read = {
        letter: "; ".join(f"{p} nm: {format_given(values[f'{letter}_{p}'])}" for p in _PLACES)
        for letter in "LR"
    }
    return words["figure"].format(lamp=read["L"], surface=read["R"]) + words["product"] * (not quiz)
