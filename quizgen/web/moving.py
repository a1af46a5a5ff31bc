"""Figures that move: what can be moved in each, and where it stands for a question.

The modules that draw them are ``static/moving/*.js``; a formula of the bank's ``formulas.toml``
names the one that shows it (``moves``). A moving figure computes what questions ask, so a question
shows it only once nothing of it is open; the formula sheet shows it with numbers of no question.
"""

from __future__ import annotations

import colorsys
import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.formulas import MovingName, read_formulas
from quizgen.bank.variant import Variant
from quizgen.locale import fallback_language, get_language, load_words
from quizgen.maths.numbers import to_float
from quizgen.question.html import inlines_to_html
from quizgen.typeset.prose import name_inline

NUMBERS = (1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0, 22.0, 32.0)
"""F-numbers of a ring, each a stop from the next."""
DISTANCES = (0.5, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0,
             20.0, 30.0, 50.0, 100.0)  # fmt: skip
"""Metres on the ring of the focus."""

Given = Mapping[tuple[str, str], float]
"""Quantities of a question as they are shown, by name and unit."""


@dataclass(frozen=True)
class Quantity:
    """A value that a figure is drawn from.

    It begins at that of a question, if one of ``letters`` (by default its own name) is a quantity
    there in ``unit`` between ``least`` and ``most``; otherwise at ``at``. It has a slider in steps
    of ``step`` or from one of ``stops`` to the next, or is a switch, or else is fixed.
    """

    at: float
    least: float
    most: float
    unit: str = ""
    letters: tuple[str, ...] = ()
    step: float = 0.0
    stops: tuple[float, ...] = ()
    shown: str = "{}"
    """What its value is written into."""
    stretches: bool = False
    """Whether a figure with numbers of another size stretches it."""
    is_switch: bool = False
    """Whether it is on at 1 and off at 0."""

    @property
    def has_slider(self) -> bool:
        """Whether it has a slider."""
        return bool(self.step or self.stops)

    def find(self, name: str, given: Given) -> float | None:
        """Return its value in a question; None where there is none that the figure has room for."""
        for letter in self.letters or (name,):
            value = given.get((letter, self.unit), math.nan)
            if self.least <= value <= self.most:
                return value
        return None

    def stretch(self, scale: float) -> Quantity:
        """Return it for numbers of another size; steps get finer and never coarser."""
        if not self.stretches:
            return self
        ends = {name: scale * getattr(self, name) for name in ("at", "least", "most")}
        return replace(self, step=self.step * min(1.0, scale), **ends)


@dataclass(frozen=True)
class MovingFigure:
    """A figure that moves, and its quantities by name.

    ``scales`` are the sizes of numbers that it can be drawn for: the first that has room for the
    question's numbers is taken.
    """

    quantities: Mapping[str, Quantity]
    scales: tuple[float, ...] = (1.0,)

    def fit(self, given: Given) -> tuple[float, Mapping[str, Quantity]]:
        """Return the scale for the numbers of a question, and the quantities in that size."""
        sized = [
            (scale, {name: one.stretch(scale) for name, one in self.quantities.items()})
            for scale in self.scales
        ]
        return max(sized, key=lambda pair: _count_matches(pair[1], given))


def _count_matches(quantities: Mapping[str, Quantity], given: Given) -> int:
    """Return for how many quantities the question gives a number that the figure can begin at."""
    return sum(one.find(name, given) is not None for name, one in quantities.items())


FIGURES: dict[MovingName, MovingFigure] = {
    "aperture-ring": MovingFigure(
        {
            "N": Quantity(8, 0.5, 1000, letters=("N_2", "N"), stops=NUMBERS, shown="f/{}"),
            "N_1": Quantity(2.8, 0.5, 1000),
            "f": Quantity(50, 1, 1000, "mm"),
            "r": Quantity(125, 0.01, 10000),
            "keep": Quantity(1, 0, 1, is_switch=True),
        }
    ),
    "clamped-histogram": MovingFigure(
        {
            "I": Quantity(280, -130, 420, step=1, stretches=True),
            "I_min": Quantity(16, 0, 256, step=1, stretches=True),
            "I_max": Quantity(235, 0, 256, step=1, stretches=True),
            "N_min": Quantity(0, -1e6, 1e6),
            "N_max": Quantity(1, -1e6, 1e6),
            "clamp": Quantity(1, 0, 1, is_switch=True),
        },
        scales=(1.0, 4.0, 16.0),
    ),
    "distortion-grid": MovingFigure(
        {
            "k_1": Quantity(-0.2, -0.4, 0.4, letters=("k_1", "k"), step=0.01),
            "k_2": Quantity(0, -0.1, 0.1, step=0.01),
            "x": Quantity(0.75, -1, 1),
            "y": Quantity(0.5, -1, 1),
        }
    ),
    "eye-and-filter": MovingFigure(
        {
            "lambda": Quantity(
                650, 400, 700, "nm", ("lambda", "lambda_1", "l_1"), 5, shown="{}\u00a0nm"
            ),
            "width": Quantity(60, 0, 200, "nm", step=10, shown="{}\u00a0nm"),
            "night": Quantity(0, 0, 1, letters=("night", "dark"), is_switch=True),
        }
    ),
    "focus-distance": MovingFigure(
        {
            "s": Quantity(4, 0.5, 100, "m", stops=DISTANCES, shown="{}\u00a0m"),
            "N": Quantity(2.8, 0.5, 64, letters=("N", "N_1"), stops=NUMBERS, shown="f/{}"),
            "f": Quantity(50, 10, 200, "mm", step=1, shown="{}\u00a0mm"),
            "c": Quantity(30, 1, 200, "um"),
        }
    ),
    "gaussian-tails": MovingFigure(
        {
            "sigma": Quantity(2, 0.5, 10, "", ("sigma", "sigma_1"), 0.1, stretches=True),
            "k": Quantity(2, 0, 6, "", ("k", "k_1"), 0.1),
            "M": Quantity(1, 0.01, 1000, "Mpx"),
        },
        scales=(1.0, 0.1),
    ),
    "hsv-sliders": MovingFigure(
        {
            "H": Quantity(318, 0, 360, "deg", step=1, shown="{}°"),
            "S": Quantity(0.66, 0, 1, step=0.01),
            "V": Quantity(0.86, 0, 1, step=0.01),
        }
    ),
    "pinhole-point": MovingFigure(
        {
            "p_y": Quantity(10, -15, 15, step=0.5),
            "p_z": Quantity(8, -6, 12, step=0.5),
            "f": Quantity(4, 1, 6, step=0.5),
        }
    ),
}


class SliderView(msgspec.Struct, frozen=True):
    """A slider as the page has it; ``stops`` are what its places stand for."""

    name: str
    words: str
    letter: str
    least: float
    most: float
    step: float
    at: float
    shown: str
    stops: str


class MovingView(msgspec.Struct, frozen=True):
    """A figure that moves as the page has it; ``values`` and ``words`` are JSON for its module."""

    name: str
    id: str
    decimal: str
    open: str
    back: str
    picture: str
    sliders: list[SliderView]
    switches: list[tuple[str, str, bool]]
    """Name, words and place of each switch."""
    rows: list[tuple[str, str]]
    """Name and words of each value that is shown."""
    values: str
    words: str


def find_moving_figure(bank: Bank, template: str, variant: Variant, lang: str) -> MovingView | None:
    """Return the figure that moves of a question, standing at its numbers; None if it has none.

    It is that of the first formula that the template covers and that moves.
    """
    moves = {entry.id: entry.moves for entry in read_formulas(bank) if entry.moves}
    names = [moves[item] for item in bank.rules(template).covers if item in moves]
    return _view_figure(names[0], "moving", _read_quantities(variant), lang) if names else None


def view_formula_figure(formula: str, moves: MovingName, lang: str) -> MovingView:
    """Return the figure that moves of a formula, standing at numbers of no question."""
    return _view_figure(moves, f"moving-{formula}", {}, lang)


def _read_quantities(variant: Variant) -> Given:
    """Return the quantities of a question as they are shown, and those that follow from them.

    A colour has a hue, and a number of stops leads from f/4 to another number of the ring.
    """
    found: dict[tuple[str, str], float] = {}
    for name, value in variant.shown_values.items():
        with suppress(OverflowError):  # larger than any float, and than any figure
            found[name, variant.template.units.get(name, "")] = to_float(value)
    rgb = [found.get((letter, ""), math.nan) for letter in "RGB"]
    if all(0 <= channel <= 1 for channel in rgb):
        hue, saturation, value = colorsys.rgb_to_hsv(*rgb)
        found |= {("H", "deg"): 360 * hue, ("S", ""): saturation, ("V", ""): value}
    stops, begin = found.get(("stops", ""), 0.0), NUMBERS.index(4)
    if stops in range(1, begin + 1):
        way = -1 if found.get(("opening", "")) else 1
        found = {("N_1", ""): 4.0, ("N_2", ""): NUMBERS[begin + way * int(stops)], **found}
    return found


def _view_figure(name: MovingName, place: str, given: Given, lang: str) -> MovingView:
    """Return a figure with its words, beginning at the quantities of a question."""
    figure, known = FIGURES[name], load_words(fallback_language(lang), "moving")
    words: dict[str, str] = known[name]
    scale, quantities = figure.fit(given)
    found = {key: one.find(key, given) for key, one in quantities.items()}
    begin = {key: quantities[key].at if value is None else value for key, value in found.items()}
    switches = [key for key, one in quantities.items() if one.is_switch]
    values = {**begin, **{key: bool(begin[key]) for key in switches}, "scale": scale}
    said = {key: text for key, text in words.items() if key.startswith("said")}
    return MovingView(
        name=name,
        id=place,
        decimal=get_language(fallback_language(lang)).decimal,
        open=known["words"]["open"],
        back=known["words"]["back"],
        picture=words["picture"],
        sliders=[
            _view_slider(key, one, begin[key], words[f"set_{key}"], lang)
            for key, one in quantities.items()
            if one.has_slider
        ],
        switches=[(key, words[f"set_{key}"], bool(begin[key])) for key in switches],
        rows=[(key[4:], text) for key, text in words.items() if key.startswith("out_")],
        values=msgspec.json.encode(values).decode(),
        words=msgspec.json.encode(said).decode(),
    )


def _view_slider(name: str, one: Quantity, at: float, words: str, lang: str) -> SliderView:
    """Return a slider at a value, which becomes a stop of its own where it is none."""
    letter = "" if name == "width" else str(inlines_to_html((name_inline(name),), lang))
    ends = (one.least, one.most, one.step, at)
    stops = sorted({*one.stops, at}) if one.stops else []
    if stops:
        ends = (0, len(stops) - 1, 1, stops.index(at))
    return SliderView(name, words, letter, *ends, one.shown, " ".join(map(str, stops)))
