"""The photon transfer curve: variance against mean of evenly lit pictures, to full photosites."""

from __future__ import annotations

from typing import Any

from quizgen.figures.kit import Parameter, Values, format_derived, format_given, load_alt_words

PARAMETERS = {
    "v_0": Parameter("", "variance in the dark", None, 0.0),
    "mu_s": Parameter("", "mean at which photosites are full", None, 1.0),
    "v_s": Parameter("", "variance just below that", None, 0.0),
    "top": Parameter("", "end of the axis of variances", None, 1.0),
}
SIZE = (230.0, 150.0)
_COUNT = 8


def draw(ax: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure, in a solution with the straight line and where it begins."""
    full, low, high = values["mu_s"], values["v_0"], values["v_s"]
    means = [full * step / _COUNT for step in range(_COUNT + 1)]
    variances = [low + (high - low) * step / _COUNT for step in range(_COUNT + 1)]
    ax.set(xlim=(0, full * 1.25), ylim=(0, values["top"]), xlabel=r"$\mu$")
    ax.set_ylabel(r"$\sigma^2$", rotation=0, va="bottom", y=1.03)
    ax.set_xticks([full * step / 4 for step in range(6)])
    ax.set_yticks([values["top"] * step / 10 for step in range(11)])
    ax.grid(visible=True, color="rule", linewidth=0.4)
    fallen = [(full * 1.03, high / 2), (full * 1.05, 0.04 * high), (full * 1.12, 0)]
    ax.plot(means, variances, "o", color="blue", markersize=3.4, gid="points", clip_on=False)
    ax.plot(*zip(*fallen, strict=True), "o", color="blue", markersize=3.4, clip_on=False)
    if not quiz:
        ax.plot([0, full], [low, high], "red", linewidth=1.2, gid="line")
        ax.annotate(format_derived(low), (0, low), (6, -2), textcoords="offset points", va="top")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the points in words."""
    words, steps = load_alt_words(__file__, lang), (0, 2, 4, 6, 8)
    low, high, full = values["v_0"], values["v_s"], values["mu_s"]
    read = "; ".join(
        f"{format_given(full * step / 8)}: {format_given(low + (high - low) * step / 8)}"
        for step in steps
    )
    told = words["figure"].format(read=read)
    return told if quiz else told + words["line"].format(low=format_derived(low))
