"""The page: one self-contained HTML file in every language, or its middle for the browser."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Any

import jinja2
import msgspec

from quizgen.figures.inks import write_theme_css
from quizgen.files import write_all
from quizgen.locale import language, languages, numbers_in
from quizgen.maths.notation import people
from quizgen.render.fonts import bangla_uri
from quizgen.render.layouts import environment
from quizgen.tradeoff.digits import ALL_DIGITS
from quizgen.tradeoff.formulas import FORMULAS
from quizgen.tradeoff.plot import ITERATED, draw_digits
from quizgen.tradeoff.questions import Cost
from quizgen.tradeoff.report import Report
from quizgen.tradeoff.rivals import Match
from quizgen.tradeoff.solving import ARITHMETICS
from quizgen.tradeoff.sweeps import EXAMS, PLACES, Sweep
from quizgen.tradeoff.texts import script, style_sheet, words

START = 2 * PLACES // 3
"""The place where the slider stands first: two thirds of the way to the hard end."""
LINES = ("exact", "float64", "float32", "stable")
"""Numbers below the slider, after what they are computed with."""
_UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (0.0, "ns"))

Pieces = tuple[str, str, str]


def write(report: Report, folder: Path, command: str) -> list[Path]:
    """Write the page, its plot, and all that was measured (seconds; what fails is null)."""
    made = {
        "digits.svg": draw_digits(report, words("en")["plot"]["alt"], "en").standalone_svg,
        "tradeoff.json": msgspec.json.format(msgspec.json.encode(report)) + b"\n",
        "tradeoff.html": whole_page(report, command).encode(),
    }
    return write_all(folder, made)


def whole_page(report: Report, command: str) -> str:
    """The page on its own, with all languages in it, of which one is seen."""
    known = {lang: language(lang) for lang in languages()}
    return _layouts().get_template("page.html.j2").render(
        languages=known, title=words("en")["page"]["title"], style=style_sheet(), script=script(),
        bodies={lang: fragment(report, command, lang) for lang in known},
        bangla=[lang for lang, one in known.items() if one.script == "Beng"],
        faces={400: bangla_uri(), 700: bangla_uri("Bold")}, theme=write_theme_css(),
    )  # fmt: skip


def fragment(report: Report, command: str, lang: str) -> str:
    """What is said in one language, for the frame of a page."""
    text = words(lang)
    return _layouts().get_template("measured.html.j2").render(
        text=text, lang=lang, start=START, lines=LINES, command=command, report=report,
        formulas=describe_formulas(report, lang), questions=describe_questions(report, lang),
        plot=draw_digits(report, text["plot"]["alt"], lang).inline_svg.decode(),
        digits_said=describe_digits(report, lang), arrays=describe_arrays(report, lang),
        measured=text["page"]["measured"].format(machine=report.machine, date=report.date),
    )  # fmt: skip


@cache
def _layouts() -> jinja2.Environment:
    return environment("quizgen.tradeoff")


# The slider


def describe_formulas(report: Report, lang: str) -> list[dict[str, Any]]:
    """What the slider shows of each of its formulas."""
    sweeps = {one.name: one for one in report.sweeps}
    return [
        {"name": one.name, **words(lang)["formula"][one.name], "printed": one.shown.printed,
         "stable": one.shown.stable,
         "places": _places(sweeps[one.name], f"{one.shown.symbol} = {{}} {one.shown.unit}", lang)}
        for one in FORMULAS if one.shown is not None
    ]  # fmt: skip


def _places(sweep: Sweep, moved: str, lang: str) -> list[list[Any]]:
    """Each position: where, whether an exam goes so far, in words, and the numbers in pieces."""
    text, sign = words(lang)["slider"], language(lang).decimal
    found = []
    for i, left in enumerate(sweep.left):
        at = numbers_in(lang, moved.format(short(sweep.moved[i])).strip())
        ways = [sweep.ways[way] for way in LINES[1:]]
        numbers = [pieces(sweep.right[i], ALL_DIGITS)]
        numbers += [pieces(way.values[i], way.digits[i], text["failed"]) for way in ways]
        said = text["inside" if left >= sweep.exam_left else "outside"]
        found.append([at, said, *([part.replace(".", sign) for part in one] for one in numbers)])
    return found


def pieces(value: float, right: float, failed: str = "–") -> Pieces:
    """A number of seventeen digits: those that are right, the rest, its power of ten.

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
    tail = f"·{people.power_of_ten(int(power))}" if int(power) else ""
    if right >= ALL_DIGITS:
        return mantissa, "", tail
    sign = len(mantissa) - 18
    kept = sign + int(right) + (1 if right >= 2 else 0) if right >= 1 else 0
    return mantissa[:kept], mantissa[kept:], tail


def short(value: float) -> str:
    """A number in three figures, as people write it.

    Examples
    --------
    >>> short(4.2512), short(0.00321), short(470000.0), short(3.2e-7)
    ('4.25', '0.00321', '4.7·10⁵', '3.2·10⁻⁷')
    """
    if 1e-3 <= abs(value) < 9999.5:
        return people.number(f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}")
    mantissa, power = f"{value:.1e}".split("e")
    return f"{mantissa}·{people.power_of_ten(int(power))}"


def time_text(seconds: float) -> str:
    r"""A time in two figures, with its unit on the same line.

    Examples
    --------
    >>> time_text(4.4e-6), time_text(1.86e-9), time_text(0.000123)
    ('4.4\xa0µs', '1.9\xa0ns', '120\xa0µs')
    """
    size, unit = next((size, unit) for size, unit in _UNITS if seconds >= size)
    return f"{_two(seconds / (size or 1e-9))}\N{NO-BREAK SPACE}{unit}"


def _two(value: float) -> str:
    """Two figures, written out."""
    return f"{float(f'{value:.2g}'):g}"


# Questions


def describe_questions(report: Report, lang: str) -> dict[str, Any]:
    """What a question costs in each arithmetic: sentences, and rows of a name, a remark, cells."""
    found, text = report.questions, words(lang)["questions"]
    counted, exact = found.counted, found.costs["exact"]
    careful = counted.wrong["rounded"]
    said = {
        "more": time_text(exact.more), "times": _two(exact.times),
        "exact": time_text(exact.seconds), "doubles": time_text(found.costs["float64"].seconds),
        "wrong": counted.questions("rounded"), "drawn": people.number(str(counted.drawn)),
        "hit": len(careful), "templates": counted.templates, "count": found.count,
        "date": counted.date,
    }  # fmt: skip
    rows = [
        (text[name], text[f"{name}_fails"], numbers_in(lang, time_text(found.costs[name].seconds)),
         numbers_in(lang, _ratio(found.costs[name])), _wrong(report, name))
        for name in ARITHMETICS
    ]  # fmt: skip
    return {
        "rows": rows,
        **{key: numbers_in(lang, text[key].format(**said)) for key in ("lead", "sentence", "how")},
    }


def _ratio(cost: Cost) -> str:
    if cost.high == cost.low:
        return "1"
    return f"{_two(cost.times)} ({_two(cost.low)} – {_two(cost.high)})"


def _wrong(report: Report, name: str) -> str:
    """Wrong keys, and of how many templates."""
    counted = report.questions.counted
    wrong, hit = counted.questions(name), len(counted.wrong[name])
    return f"{wrong} ({hit})" if wrong else "0"


# Digits and arrays


def describe_digits(report: Report, lang: str) -> str:
    """How many printed formulas keep how many digits in an exam."""
    kept, digits = report.kept
    left = next(int(one.exam_digits) for one in report.sweeps if one.name == ITERATED)
    said: str = words(lang)["plot"]["sentence"]
    return said.format(kept=kept, count=len(report.sweeps), digits=digits, left=left, exams=EXAMS)


def describe_arrays(report: Report, lang: str) -> dict[str, Any]:
    """Every formula's title with the rows of its ways, and what one value costs."""
    text, alone = words(lang)["arrays"], [one.least for one in report.questions.alone]
    return {
        "groups": [(words(lang)["formula"][match.formula]["title"], _rows(match, lang))
                   for match in report.matches],
        "alone": numbers_in(lang, text["alone"].format(
            least=time_text(min(alone)), most=time_text(max(alone)))),
    }  # fmt: skip


def _rows(match: Match, lang: str) -> list[tuple[str, ...]]:
    """Name, no remark, time with the median, times the first's, digits in an exam, hard ones."""
    names, first = words(lang)["way"], match.rivals[0].time.least
    return [
        (
            names.get(one.name, one.name), "",
            numbers_in(lang, f"{_two(1e9 * one.time.least)} ({_two(1e9 * one.time.median)})"),
            numbers_in(lang, _two(one.time.least / first)),
            _count(one.exam), _count(one.hard),
        )
        for one in match.rivals
    ]  # fmt: skip


def _count(digits: float) -> str:
    return str(min(int(digits), 16))
