"""The page: one self-contained HTML file in every language, without scripts."""

from __future__ import annotations

import json
import math
from functools import cache
from importlib.resources import files
from pathlib import Path

import jinja2
from markupsafe import Markup

from quizgen.files import write_all
from quizgen.locale import language, languages
from quizgen.render.fonts import bangla_uri
from quizgen.render.layouts import environment
from quizgen.tradeoff.data import as_data, markdown, words
from quizgen.tradeoff.knobs import Curve
from quizgen.tradeoff.measure import Measured, pareto
from quizgen.tradeoff.plot import (
    HEIGHT,
    PANEL,
    Mark,
    accuracy_panel,
    document,
    style,
    time_text,
    work_panel,
)
from quizgen.tradeoff.report import FamilyReport, Report

HALF_PIXEL = 0.5 / 255
_ROUNDING = 2.0**-53


def write(report: Report, folder: Path, command: str) -> list[Path]:
    """Write the page, its data, a short table and one SVG per plot; return their paths."""
    plots = {family.name: family_plot(family, "en") for family in report.families}
    plots |= {key: knob_plot(key, curves, "en") for key, curves in report.knobs}
    made = {f"{name}.svg": svg for name, svg in plots.items()}
    made["tradeoff.json"] = json.dumps(as_data(report, command), indent=1) + "\n"
    made["tradeoff.md"] = markdown(report, command)
    made["tradeoff.html"] = html(report, command)
    return write_all(folder, {name: text.encode() for name, text in made.items()})


def html(report: Report, command: str) -> str:
    """The whole page."""
    frame = (files("quizgen.tradeoff") / "pages" / "tradeoff.css").read_text("utf-8")
    page = _layouts().get_template("tradeoff.html.j2")
    there = {lang: language(lang) for lang in languages()}
    made = page.render(report=report, command=command, style=frame + style(), languages=there)
    return made + "\n"


def fragment(report: Report, command: str, lang: str) -> str:
    """What the page says in one language, to stand in another page; ``style`` goes with it."""
    page = _layouts().get_template("measured.html.j2")
    said = page.make_module({"report": report, "command": command})
    return str(said.body(lang, words(lang)))  # type: ignore[attr-defined]


@cache
def _layouts() -> jinja2.Environment:
    layouts = environment("quizgen.tradeoff")
    layouts.filters.update(time=time_text, count=count)
    layouts.globals.update(
        faces={weight: bangla_uri(name) for name, weight in (("Regular", 400), ("Bold", 700))},
        words=words,
        front=lambda rungs: _front(rungs, "hard"),
        family_plot=family_plot,
        knob_plot=knob_plot,
    )
    return layouts


def _front(rungs: tuple[Measured, ...], which: str) -> set[int]:
    """Places of the rungs that no other rung beats."""
    return set(pareto([(rung.nanoseconds, getattr(rung, which).max_bits) for rung in rungs]))


def family_plot(family: FamilyReport, lang: str) -> str:
    """Both panels of a family."""
    page = words(lang)["page"]
    rules = (
        (_bits(family.tolerance / 2), page["tolerance"]),
        (_bits(HALF_PIXEL), page["pixel"]),
    )
    panels = "".join(
        accuracy_panel(
            i * PANEL, page[which], _marks(family.rungs, which), rules, (page["x"], page["y"])
        )
        for i, which in enumerate(("exam", "hard"))
    )
    return document(panels, 2 * PANEL, HEIGHT, words(lang)["family"][family.name]["title"])


def _bits(relative: float) -> float:
    """Bits of error that a relative error amounts to."""
    return math.log2(relative / _ROUNDING)


def _marks(rungs: tuple[Measured, ...], which: str) -> list[Mark]:
    front = _front(rungs, which)
    return [
        Mark(
            i + 1,
            rung.nanoseconds,
            getattr(rung, which).max_bits,
            rung.kind == "scalar",
            i in front,
        )
        for i, rung in enumerate(rungs)
    ]


def count(steps: float) -> str | None:
    """A number of doubles, short; None where the way fails."""
    if math.isinf(steps):
        return None
    if steps < 10000:
        return f"{steps:.3g}" if steps < 1 else f"{steps:.0f}"
    leading, exponent = f"{steps:.0e}".split("e+")
    return Markup("{}·10<sup>{}</sup>").format(leading, int(exponent))


def knob_plot(key: str, curves: tuple[Curve, ...], lang: str) -> str:
    """Work-precision plot of one setting."""
    text = words(lang)["knob"][key]
    lines = [(c.label, [(p.label, p.seconds, p.error) for p in c.points]) for c in curves]
    return document(work_panel(lines, text["error"]), PANEL + 180, HEIGHT, text["title"])
