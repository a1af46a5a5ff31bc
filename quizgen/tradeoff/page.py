"""The page: one self-contained HTML file in every language, or its middle for the browser."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from itertools import accumulate
from pathlib import Path
from typing import Any

import jinja2
import msgspec

from quizgen.core.files import write_all
from quizgen.figures import Figure, plot_figure
from quizgen.locale import get_language, list_languages, localise_numbers
from quizgen.maths.notation import pretty
from quizgen.render.fonts import bangla_uri
from quizgen.render.layouts import jinja_environment
from quizgen.render.page_look import write_page_look
from quizgen.tradeoff.formulas import FORMULAS
from quizgen.tradeoff.questions import Cost
from quizgen.tradeoff.report import TradeoffReport
from quizgen.tradeoff.rivals import Match
from quizgen.tradeoff.solving import ARITHMETICS
from quizgen.tradeoff.sweeps import EXAMS, PLACES, FormulaSweep
from quizgen.tradeoff.texts import script, tradeoff_css, words
from quizgen.tradeoff.truth import ALL_DIGITS, MOST_DIGITS

START = 2 * PLACES // 3
"""The place where the slider stands first: two thirds of the way to the hard end."""
LINES = ("exact", "float64", "float32", "stable")
"""Numbers below the slider, after what they are computed with."""
_UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (0.0, "ns"))

Pieces = tuple[str, str, str]


def write_page(report: TradeoffReport, folder: Path, command: str) -> list[Path]:
    """Write the page, its plot and all measurements (seconds; a failure is null).

    Return the files.
    """
    made = {
        "digits.svg": draw_digits(report, words("en")["plot"]["alt"], "en").standalone_svg,
        "tradeoff.json": msgspec.json.format(msgspec.json.encode(report)) + b"\n",
        "tradeoff.html": whole_page(report, command).encode(),
    }
    return write_all(folder, made)


def whole_page(report: TradeoffReport, command: str) -> str:
    """Return the page on its own, with all languages in it; one is shown."""
    known = {lang: get_language(lang) for lang in list_languages()}
    return _build_environment().get_template("page.html.j2").render(
        languages=known, title=words("en")["page"]["title"], style=tradeoff_css(), script=script(),
        bodies={lang: render_tradeoff_fragment(report, command, lang) for lang in known},
        faces={400: bangla_uri(), 700: bangla_uri("Bold")}, look=write_page_look(),
    )  # fmt: skip


def render_tradeoff_fragment(report: TradeoffReport, command: str, lang: str) -> str:
    """Return the content of the page in one language, for a page that frames it."""
    text = words(lang)
    return _build_environment().get_template("measured.html.j2").render(
        text=text, lang=lang, start=START, lines=LINES, command=command, report=report,
        formulas=describe_formulas(report, lang), questions=describe_questions(report, lang),
        plot=draw_digits(report, text["plot"]["alt"], lang).inline_svg.decode(),
        digits_said=describe_digits(report, lang), arrays=describe_arrays(report, lang),
        measured=text["page"]["measured"].format(machine=report.machine, date=report.date),
    )  # fmt: skip


@cache
def _build_environment() -> jinja2.Environment:
    """Return Jinja's environment for the layouts of this page."""
    return jinja_environment("quizgen.tradeoff")


# The slider


def describe_formulas(report: TradeoffReport, lang: str) -> list[dict[str, Any]]:
    """Return what the slider shows of each of its formulas."""
    sweeps = {one.name: one for one in report.sweeps}
    return [
        {
            "name": one.name,
            **words(lang)["formula"][one.name],
            "printed": one.shown.printed,
            "stable": one.shown.stable,
            "places": _build_slider_positions(
                sweeps[one.name], f"{one.shown.symbol} = {{}} {one.shown.unit}", lang
            ),
        }
        for one in FORMULAS
        if one.shown is not None
    ]


def _build_slider_positions(sweep: FormulaSweep, moved: str, lang: str) -> list[list[Any]]:
    """Return for each position: its value, whether exams go so far, a text, and the results."""
    text, sign = words(lang)["slider"], get_language(lang).decimal
    found = []
    for i, left in enumerate(sweep.left):
        at = localise_numbers(lang, moved.format(short(sweep.moved[i])).strip())
        ways = [sweep.ways[way] for way in LINES[1:]]
        numbers = [pieces(sweep.right[i], ALL_DIGITS)]
        numbers += [pieces(way.values[i], way.digits[i], text["failed"]) for way in ways]
        said = text["inside" if left >= sweep.exam_left else "outside"]
        found.append([at, said, *([part.replace(".", sign) for part in one] for one in numbers)])
    return found


def pieces(value: float, right: float, failed: str = "–") -> Pieces:
    """Return a number of 17 digits in pieces: those that are right, the rest, its power of ten.

    Examples
    --------
    >>> pieces(0.5, 17.0), pieces(-1.25, 3.0)
    (('5.0000000000000000', '', '·10⁻¹'), ('-1.25', '00000000000000', ''))
    """
    if not math.isfinite(value):
        return "", "", failed
    if value == 0:
        return ("0", "", "") if right >= ALL_DIGITS else ("", "0", "")
    mantissa, power = f"{value:.16e}".split("e")
    tail = f"·{pretty.format_power_of_ten(int(power))}" if int(power) else ""
    if right >= ALL_DIGITS:
        return mantissa, "", tail
    sign = len(mantissa) - 18
    kept = sign + int(right) + (1 if right >= 2 else 0) if right >= 1 else 0
    return mantissa[:kept], mantissa[kept:], tail


def short(value: float) -> str:
    """Return a number in three figures, as people write it.

    Examples
    --------
    >>> short(4.2512), short(0.00321), short(470000.0), short(3.2e-7)
    ('4.25', '0.00321', '4.7·10⁵', '3.2·10⁻⁷')
    """
    if 1e-3 <= abs(value) < 9999.5:
        return pretty.format_number(f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}")
    mantissa, power = f"{value:.1e}".split("e")
    return f"{mantissa}·{pretty.format_power_of_ten(int(power))}"


def time_text(seconds: float) -> str:
    r"""Return a time in two figures, with its unit on the same line.

    Examples
    --------
    >>> time_text(4.4e-6), time_text(1.86e-9), time_text(0.000123)
    ('4.4\xa0µs', '1.9\xa0ns', '120\xa0µs')
    """
    size, unit = next((size, unit) for size, unit in _UNITS if seconds >= size)
    return f"{_format_two_figures(seconds / (size or 1e-9))}\N{NO-BREAK SPACE}{unit}"


def _format_two_figures(value: float) -> str:
    """Return a number in two figures, without a power of ten."""
    return f"{float(f'{value:.2g}'):g}"


# Questions


def describe_questions(report: TradeoffReport, lang: str) -> dict[str, Any]:
    """Return what a question costs in each arithmetic: sentences, and rows of a table."""
    found, text = report.questions, words(lang)["questions"]
    counted, exact = found.counted, found.costs["exact"]
    careful = counted.wrong["rounded"]
    said = {
        "more": time_text(exact.more), "times": _format_two_figures(exact.times),
        "exact": time_text(exact.seconds), "doubles": time_text(found.costs["float64"].seconds),
        "wrong": counted.questions("rounded"), "drawn": pretty.format_number(str(counted.drawn)),
        "hit": len(careful), "templates": counted.templates, "count": found.count,
        "date": counted.date,
    }  # fmt: skip
    rows = [
        (
            text[name],
            text[f"{name}_fails"],
            localise_numbers(lang, time_text(found.costs[name].seconds)),
            localise_numbers(lang, _format_cost_ratio(found.costs[name])),
            _format_wrong_keys(report, name),
        )
        for name in ARITHMETICS
    ]
    return {
        "rows": rows,
        **{
            key: localise_numbers(lang, text[key].format(**said))
            for key in ("lead", "sentence", "how")
        },
    }


def _format_cost_ratio(cost: Cost) -> str:
    """Return how many times as long as float64 an arithmetic takes, with its quartiles."""
    if cost.high == cost.low:
        return "1"
    return (
        f"{_format_two_figures(cost.times)} ({_format_two_figures(cost.low)}"
        f" – {_format_two_figures(cost.high)})"
    )


def _format_wrong_keys(report: TradeoffReport, name: str) -> str:
    """Return the number of wrong keys of an arithmetic, and of how many templates."""
    counted = report.questions.counted
    wrong, hit = counted.questions(name), len(counted.wrong[name])
    return f"{wrong} ({hit})" if wrong else "0"


# Digits and arrays


def describe_digits(report: TradeoffReport, lang: str) -> str:
    """Return a sentence: how many printed formulas keep how many digits in an exam."""
    kept, digits = report.formulas_keeping_digits
    left = next(int(one.exam_digits) for one in report.sweeps if one.name == ITERATED)
    said: str = words(lang)["plot"]["sentence"]
    return said.format(kept=kept, count=len(report.sweeps), digits=digits, left=left, exams=EXAMS)


def describe_arrays(report: TradeoffReport, lang: str) -> dict[str, Any]:
    """Return every formula's title with the rows of its ways, and what one value costs."""
    text, alone = words(lang)["arrays"], [one.least for one in report.questions.alone]
    return {
        "groups": [
            (words(lang)["formula"][match.formula]["title"], _build_rival_rows(match, lang))
            for match in report.matches
        ],
        "alone": localise_numbers(
            lang, text["alone"].format(least=time_text(min(alone)), most=time_text(max(alone)))
        ),
    }


def _build_rival_rows(match: Match, lang: str) -> list[tuple[str, ...]]:
    """Return rows of a table, one for each way to compute a formula.

    Name, empty remark, time with its median, times the first's, digits in an exam, digits of hard
    inputs.
    """
    names, first = words(lang)["way"], match.rivals[0].time.least
    return [
        (
            names.get(one.name, one.name),
            "",
            localise_numbers(
                lang,
                f"{_format_two_figures(1e9 * one.time.least)} "
                f"({_format_two_figures(1e9 * one.time.median)})",
            ),
            localise_numbers(lang, _format_two_figures(one.time.least / first)),
            _format_digit_count(one.exam),
            _format_digit_count(one.hard),
        )
        for one in match.rivals
    ]


def _format_digit_count(digits: float) -> str:
    """Return the number of right digits as text."""
    return str(min(int(digits), 16))


SIZE = (380.0, 170.0)
ITERATED = "inverse-distortion"  # loses its digits by its steps, not by a subtraction


def draw_digits(report: TradeoffReport, alt: str, lang: str) -> Figure:
    """Return the plot of right digits: printed formulas with exam inputs, and stable forms."""

    def draw(ax: Any) -> None:
        """Draw the curves and points."""
        ax.set_xscale("log")
        ax.set_xlim(1, 1e-15)
        ax.set_ylim(0, MOST_DIGITS + 0.6)
        ax.set_xticks([10.0**-n for n in range(0, 16, 3)])
        ax.set_yticks(range(0, MOST_DIGITS + 1, 4))
        ax.minorticks_off()
        ax.tick_params(labelsize=10)
        ax.grid(True)
        ax.axvspan(1, report.exam, color="pale-gold", linewidth=0, zorder=0)
        for one in report.sweeps:
            colour, width = ("red", 1.6) if one.name == ITERATED else ("blue", 0.7)
            if "stable" in one.ways:
                stable = _compute_running_minimum(one.ways["stable"].digits)
                ax.plot(one.left, stable, color="teal", linewidth=0.8, linestyle="-")
            printed = _compute_running_minimum(one.ways["float64"].digits)
            ax.plot(one.left, printed, color=colour, linewidth=width, linestyle="-")
            ax.plot([one.exam_left], [one.exam_digits], "o", color=colour, markersize=4)

    return plot_figure(draw, alt, lang, SIZE)


def _compute_running_minimum(digits: Sequence[float]) -> list[float]:
    """Return the fewest digits up to each place: a result right by chance is no promise."""
    return list(accumulate((min(count, MOST_DIGITS) for count in digits), min))
