"""Figures: whether they can be drawn from what a template gives, read, and give nothing away.

A figure gives an answer away if its number stands in the labels or the words of the figure in every
draw in which the question does not state that number itself.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from quizgen.bank.variant import Variant, leading_digits
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.errors import QuizgenError
from quizgen.figures import Figure
from quizgen.figures.inks import INKS
from quizgen.kinds.contract import asked_quantities
from quizgen.question.figure import describe_question_figure, draw_question_figure

if TYPE_CHECKING:
    from quizgen.figures.svg import Label

DRAWN = 6
"""Draws whose figure is drawn, in the quiz and in the solution."""
FEWEST = 3
"""Different answers that are needed to tell a secret from a coincidence."""

_NUMBER = re.compile(r"\d[\d\u2009\u202f\u00a0]*(?:[.,]\d+)?")
_SPACES = re.compile(r"[\u2009\u202f\u00a0]")


def check_figures(draws: Sequence[Variant]) -> Iterator[Diagnostic]:
    """Yield what is wrong with a template's figure, in the first ``DRAWN`` of its variants.

    A figure must be drawable, legible, and give no answer away.
    """
    template = draws[0].template
    rule = template.rules.figure
    if rule is None:
        return
    shown = [(one, set[str]()) for one in draws[:DRAWN]]
    for one, numbers in shown:
        for lang in template.languages:
            for quiz in (True, False):
                try:
                    said = figure_text(one, lang, quiz=quiz, drawn=lang == template.languages[0])
                except QuizgenError as error:
                    yield error.diagnostic(template.file)
                    return
                numbers.update(_iter_numbers(said) if quiz else ())
    if rule.quiz:
        yield from _find_given_away_answers(shown)
        yield from _find_unreadable(shown, rule.reads)
    for code, what in look_problems(_iter_figures(draws[:DRAWN])):
        yield diagnose(code, template.file, what, ("figure",))


def _iter_figures(draws: Sequence[Variant]) -> Iterator[Figure]:
    """Yield each variant's figure as question and as solution show it.

    They were drawn before and are cached.
    """
    for one in draws:
        for quiz in (True, False):
            figure = draw_question_figure(one, one.template.languages[0], quiz=quiz)
            if figure is not None:
                yield figure


def figure_text(one: Variant, lang: str, *, quiz: bool, drawn: bool = True) -> str:
    """Return the description of a figure and, if the bank draws it, its labels.

    Parameters
    ----------
    one : Variant
    lang : str
    quiz : bool
        As the question shows it, not the solution.
    drawn : bool
        Whether to draw it, for its labels.
    """
    figure = draw_question_figure(one, lang, quiz=quiz) if drawn and one.template.figure else None
    if figure is None:
        return describe_question_figure(one, lang, quiz=quiz) or ""
    return " ; ".join([figure.alt, *(label.text for label in figure.labels)])


def _iter_numbers(text: str) -> Iterator[str]:
    """Yield the numbers of a text with four significant digits, to be compared as text."""
    for found in _NUMBER.findall(text):
        yield f"{float(_SPACES.sub('', found).replace(',', '.')):.4g}"


def _find_given_away_answers(shown: Sequence[tuple[Variant, set[str]]]) -> Iterator[Diagnostic]:
    """Yield an answer that the figure shows in every variant, and the question never states.

    ``shown`` pairs each variant with the numbers in its figure.
    """
    template = shown[0][0].template
    for place, part in enumerate(template.rules.part, 1):
        for name in asked_quantities(part.answer):
            secret = [
                (leading_digits(one.shown_values[name]), numbers)
                for one, numbers in shown
                if leading_digits(one.shown_values[name]) not in _collect_stated_numbers(one)
            ]
            different = {answer for answer, _ in secret}
            if len(different) >= FEWEST and all(answer in seen for answer, seen in secret):
                example = secret[0][0]
                what = f"shows {name} = {example} in the question, where part {place} asks it"
                yield diagnose("QG401", template.file, f"figure: {what}", ("figure",))


def _find_unreadable(
    shown: Sequence[tuple[Variant, set[str]]], reads: Sequence[str]
) -> Iterator[Diagnostic]:
    """Yield quantities that ``reads`` lists and whose numbers the figure does not show."""
    file = shown[0][0].template.file
    for index, name in enumerate(reads):
        lacking = [one for one, numbers in shown if leading_digits(one.shown[name]) not in numbers]
        if lacking:
            number = leading_digits(lacking[0].shown[name])
            what = f"figure: has no {name} = {number}, which reads says is read in it"
            yield diagnose("QG402", file, what, ("figure", "reads", index))


def _collect_stated_numbers(one: Variant) -> set[str]:
    """Return the numbers that the question states, rounded as those of a figure."""
    return {leading_digits(value) for value in one.shown.values()}


COLUMN = 480.0
"""Points that a page has for a figure: any wider one is made smaller, and its letters with it."""
SMALLEST, SMALLEST_INDEX = 7.0, 6.0
"""Points of the smallest letters, and of those raised or lowered."""
TOUCHING = 0.5
"""Points by which two labels may overlap: boxes have some air."""
CONTRAST = {"stroke": 3.0, "fill": 1.5}
"""Least contrast with white paper, as in WCAG 2, of lines and letters, and of areas."""
APART = 8.0
"""Least difference in lightness L* of two lines that differ in colour alone."""
MOST_COLOURS = 6
"""More than these are a scale, in which neighbours look alike."""
_HOUSE = {light for light, _ in INKS.values()}

_PATH = re.compile(r"<path [^>]*>")
_ATTRIBUTE = re.compile(r' ([a-z-]+)="([^"]*)"')


class Stroke(NamedTuple):
    """How a line is drawn: its colour as #rrggbb and its SVG dash pattern."""

    colour: str
    dashes: str


def look_problems(figures: Iterable[Figure]) -> Iterator[tuple[str, str]]:
    """Yield code and message of each legibility problem, for the first figure that has it."""
    left = list(_LOOKS)
    for figure in figures:
        for code, look in [*left]:
            said = next(look(figure), None)
            if said:
                left.remove((code, look))
                yield code, f"figure: {said}"


def _find_overlaps(figure: Figure) -> Iterator[str]:
    """Yield labels that overlap by more than ``TOUCHING`` points."""
    level = [label for label in figure.labels if label.angle % 90 == 0]
    for one, other in combinations(level, 2):
        across = min(one.right, other.right) - max(one.left, other.left)
        down = min(one.bottom, other.bottom) - max(one.top, other.top)
        if min(across, down) > TOUCHING:
            yield f"labels {one.text!r} and {other.text!r} overlap by {min(across, down):.1f} pt"


def _find_small_letters(figure: Figure) -> Iterator[str]:
    """Yield labels in letters below the smallest legible size."""
    for label in figure.labels:
        least = SMALLEST_INDEX if _has_index(label) else SMALLEST
        if label.size < least - 0.01:
            yield f"letters of {label.text!r} are {label.size:.1f} pt, less than {least:g} pt"


def _has_index(label: Label) -> bool:
    """Return whether a label has raised or lowered letters, which may be smaller."""
    return any(sign in label.text for sign in "_^") and "$" in label.text


def _find_excess_width(figure: Figure) -> Iterator[str]:
    """Yield a message if a figure is wider than the column of a page."""
    if figure.width_pt > COLUMN:
        yield f"is {figure.width_pt:g} pt wide, more than the {COLUMN:g} pt of a page"


def _find_clipped_markers(figure: Figure) -> Iterator[str]:
    """Yield a message if markers lie outside the axes."""
    if figure.outside:
        yield f"markers that lie outside the axes are clipped: {figure.outside}"


def _find_unnamed_axes(figure: Figure) -> Iterator[str]:
    """Yield a message if an axis with numbers has no name."""
    if figure.unnamed_axes:
        yield "an axis has numbers and no name"


def _find_pale_colours(figure: Figure) -> Iterator[str]:
    """Yield colours with too little contrast to white paper.

    Not those of the palette, which were chosen with care, nor those of a colour scale, which has
    pale ends.
    """
    if b"<image" in figure.inline_svg or figure.needs_colour:
        return
    paths = list(_iter_path_attributes(figure))
    if len({path.get("fill") for path in paths}) > MOST_COLOURS:
        return
    for path in paths:
        letters = "scale(" in path.get("transform", "")
        kind = "stroke" if letters or "stroke" in path else "fill"
        colour = path.get("fill" if letters else kind, "none")
        if colour.startswith("#") and colour not in _HOUSE:
            contrast = 1.05 / (_compute_luminance(colour) + 0.05)
            if contrast < CONTRAST[kind]:
                what = "letters" if letters else "a line" if kind == "stroke" else "an area"
                yield f"{what} in {colour} can hardly be seen on white (contrast {contrast:.1f})"


def _find_alike_greys(figure: Figure) -> Iterator[str]:
    """Yield pairs of coloured lines that cannot be told apart in a grey print."""
    strokes = {
        Stroke(p["stroke"], p.get("stroke-dasharray", ""))
        for p in _iter_path_attributes(figure)
        if p.get("stroke", "").startswith("#")
    }
    coloured = sorted(stroke for stroke in strokes if _is_coloured(stroke.colour))
    if figure.needs_colour or len({stroke.colour for stroke in coloured}) > MOST_COLOURS:
        return
    for one, other in combinations(coloured, 2):
        gap = abs(_compute_lightness(one.colour) - _compute_lightness(other.colour))
        if one.dashes == other.dashes and one.colour != other.colour and gap < APART:
            yield f"lines in {one.colour} and {other.colour} look alike on grey paper"


_LOOKS: tuple[tuple[str, Callable[[Figure], Iterator[str]]], ...] = (
    ("QG403", _find_overlaps),
    ("QG404", _find_small_letters),
    ("QG405", _find_excess_width),
    ("QG406", _find_clipped_markers),
    ("QG407", _find_unnamed_axes),
    ("QG408", _find_pale_colours),
    ("QG409", _find_alike_greys),
)


def _iter_path_attributes(figure: Figure) -> Iterator[dict[str, str]]:
    """Yield the attributes of each SVG path, without its points."""
    svg = figure.standalone_svg.decode()
    for found in _PATH.findall(svg):
        yield {name: value for name, value in _ATTRIBUTE.findall(found) if name != "d"}


def _parse_channels(colour: str) -> list[float]:
    """Return red, green and blue of #rrggbb, each 0 to 1."""
    return [int(colour[place : place + 2], 16) / 255 for place in (1, 3, 5)]


def _is_coloured(colour: str) -> bool:
    """Return whether a colour differs visibly from grey."""
    channels = _parse_channels(colour)
    return max(channels) - min(channels) > 0.15


def _compute_luminance(colour: str) -> float:
    """Return the relative luminance of an sRGB colour (IEC 61966-2-1), 0 to 1."""
    red, green, blue = (
        c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in _parse_channels(colour)
    )
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def _compute_lightness(colour: str) -> float:
    """Return the lightness L* of a colour (CIELAB), 0 to 100."""
    share = _compute_luminance(colour)
    return 116 * share ** (1 / 3) - 16 if share > 0.008856 else 903.3 * share
