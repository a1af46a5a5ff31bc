"""The page: one self-contained HTML file in every language."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path

import jinja2
import msgspec
from markupsafe import Markup

from quizgen.files import write_all
from quizgen.locale import language, languages
from quizgen.maths.notation import people
from quizgen.render.fonts import bangla_uri
from quizgen.render.layouts import environment
from quizgen.render.typ import png
from quizgen.tradeoff import overview
from quizgen.tradeoff.data import (
    as_csv,
    as_data,
    digits_said,
    markdown,
    product_csv,
    sentence,
    steps_text,
    verdict_text,
    words,
)
from quizgen.tradeoff.measure import Measured, Timing, pareto
from quizgen.tradeoff.numbers import in_places, in_prose, short
from quizgen.tradeoff.plot import (
    Axes,
    Choices,
    Mark,
    Setting,
    accuracy_panel,
    document,
    front_panel,
    script,
    style,
    time_text,
    work_panel,
)
from quizgen.tradeoff.product import ROUND, Counted, Product
from quizgen.tradeoff.report import FamilyReport, Peer, Report
from quizgen.tradeoff.slider import ORDER, lost, places, sweep_panel
from quizgen.tradeoff.solving import FAULTS
from quizgen.tradeoff.work import Curve, Point

HALF_PIXEL = 0.5 / 255


def write(report: Report, folder: Path, command: str) -> list[Path]:
    """Write the page, its data and tables, one SVG per plot and the overview as PNG as well."""
    plots = {family.name: document(family_panels(family, "en"), family.name)
             for family in report.families}  # fmt: skip
    plots |= {f"{family.name}-input": document([input_panel(family, "en")], family.name)
              for family in report.families}  # fmt: skip
    plots |= {key: document(knob_panels(key, curves, "en"), words("en")["knob"][key]["title"])
              for key, curves in report.knobs}  # fmt: skip
    plots["each"] = document([each_panel(report, "en")], words("en")["overview"]["each"],
                             overview.lanes_height(report))  # fmt: skip
    plots["overview"] = document(overview_panels(report, "en"), words("en")["overview"]["title"])
    made = {f"{name}.svg": svg for name, svg in plots.items()}
    made["tradeoff.json"] = json.dumps(as_data(report, command), indent=1) + "\n"
    made["tradeoff.csv"] = as_csv(report)
    made["tradeoff.md"] = markdown(report, command)
    if report.product is not None:
        made["product.csv"] = product_csv(report.product)
        made["counted.json"] = counts_json(report.product.counted)
    page = {"tradeoff.html": html(report, command).encode()}
    pictures = {"overview.png": png(plots["overview"].encode(), 560)}
    texts = {name: text.encode() for name, text in made.items()}
    return write_all(folder, texts | pictures | page)


def counts_json(counted: Counted) -> str:
    """What was counted, as it is recorded."""
    return msgspec.json.format(msgspec.json.encode(counted)).decode() + "\n"


def html(report: Report, command: str) -> str:
    """The whole page."""
    frame = (files("quizgen.tradeoff") / "pages" / "tradeoff.css").read_text("utf-8")
    page = _layouts().get_template("tradeoff.html.j2")
    there = {lang: language(lang) for lang in languages()}
    made = page.render(
        report=report, command=command, style=frame + style(), script=script(), languages=there
    )
    return made + "\n"


def fragment(report: Report, command: str, lang: str) -> str:
    """What the page says in one language, to stand in another page; ``style`` goes with it."""
    page = _layouts().get_template("measured.html.j2")
    said = page.make_module({"report": report, "command": command})
    return in_prose(str(said.body(lang, words(lang))), lang)  # type: ignore[attr-defined]


@cache
def _layouts() -> jinja2.Environment:
    layouts = environment("quizgen.tradeoff")
    layouts.filters.update(
        time=time_text,
        count=count,
        short=short,
        grouped=_grouped,
        spread=spread_text,
        in_prose=_in_prose,
    )
    layouts.globals.update(
        faces={weight: bangla_uri(name) for name, weight in (("Regular", 400), ("Bold", 700))},
        words=words,
        front=lambda rungs: _front(rungs, "hard"),
        alone=lambda panel, title, *height: document([panel], title, *height),
        lanes_height=overview.lanes_height,
        overview_panels=overview_panels,
        sentence=sentence,
        steps_text=steps_text,
        verdict_text=verdict_text,
        digits=digits_said,
        slower=slower,
        family_panels=family_panels,
        faults=FAULTS,
        input_panel=input_panel,
        places=lambda family, lang: in_places(
            places(family.sweep, words(lang)["sweep"], words(lang)["page"]["failed"]), lang
        ),
        start=start,
        order=ORDER,
        lost=lost,
        counted=counted,
        product_sentence=product_sentence,
        knob_panels=knob_panels,
        each_panel=each_panel,
    )
    return layouts


def _grouped(number: int) -> str:
    return people.number(str(number))


def _in_prose(page: Markup, lang: str) -> Markup:
    return Markup(in_prose(str(page), lang))  # noqa: S704 (markup before, and no more after)


def _front(rungs: tuple[Measured, ...], which: str) -> set[int]:
    """Places of the rungs that no other rung beats."""
    return set(pareto([(rung.nanoseconds, getattr(rung, which).max_bits) for rung in rungs]))


def slower(way: Measured | Peer, family: FamilyReport) -> str:
    """How many times the printed formula in float64 a way takes."""
    printed = next(rung for rung in family.rungs if rung.key == "float64")
    return f"× {overview.factor_text(way.time.median / printed.time.median)}"


def _axes(lang: str) -> Axes:
    page = words(lang)["page"]
    return Axes(page["x"], page["y"], words(lang)["overview"]["every"])


def overview_panels(report: Report, lang: str) -> list[str]:
    """All formulas: on exam inputs, on hard inputs."""
    text = words(lang)
    return [
        overview.panel(report, which, text["page"][which], _axes(lang), text["overview"])
        for which in overview.INPUTS
    ]


def each_panel(report: Report, lang: str) -> str:
    """Every formula on a line of its own, hard inputs, each step with what it costs and brings."""
    text = words(lang)
    return overview.lanes(report, text["overview"], text["page"]["x"])


def counted(found: Counted, system: str, fault: str) -> str:
    """How many of ``ROUND`` questions have a fault; marked where it is extrapolated."""
    many = people.number(str(found.of_round(system, fault)))
    return many if found.drawn >= ROUND else f"≈ {many}"


def product_sentence(product: Product, lang: str) -> str:
    """Why the product computes exactly, in numbers."""
    rows = {row.system: row for row in product.rows}
    exact, doubles = (rows[name].phases["solving"].median for name in ("exact", "float64"))
    whole = rows["exact"].whole.median
    said: str = words(lang)["product"]["sentence"].format(
        exact=time_text(1e9 * exact),
        doubles=time_text(1e9 * doubles),
        whole=time_text(1e9 * whole),
        share=f"{100 * (exact - doubles) / whole:.1f}",
        rejected=counted(product.counted, "float64", "rejected"),
        digit=counted(product.counted, "float64", "digit"),
        accepted=counted(product.counted, "rounded", "accepted"),
    )
    return said


def family_panels(family: FamilyReport, lang: str) -> list[str]:
    """Both panels of a family: exam inputs, hard inputs."""
    page = words(lang)["page"]
    rules = (
        (-math.log10(HALF_PIXEL), page["pixel"]),
        (-math.log10(family.tolerance / 2), page["tolerance"]),
    )
    return [
        accuracy_panel(page[which], _marks(family.rungs, which), rules, _axes(lang))
        for which in overview.INPUTS
    ]


def start(family: FamilyReport) -> int:
    """The place where a slider stands first: two thirds of the way to the hard end."""
    return 2 * len(family.sweep.places) // 3


def input_panel(family: FamilyReport, lang: str) -> str:
    """Digits against the input."""
    return sweep_panel(family.sweep, _axes(lang), words(lang)["sweep"], start(family))


def _marks(rungs: tuple[Measured, ...], which: str) -> list[Mark]:
    front = _front(rungs, which)
    return [
        Mark(
            i + 1,
            rung.nanoseconds,
            getattr(rung, which).digits,
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


def spread_text(spent: Timing) -> str:
    """The quartiles around a median."""
    return f"{time_text(1e9 * spent.low)} – {time_text(1e9 * spent.high)}"


def knob_panels(key: str, curves: tuple[Curve, ...], lang: str) -> list[str]:
    """Work-precision plot of one setting; of the camera, one for each scene that has effects."""
    unit, time = words(lang)["knob"][key]["error"], words(lang)["table"]["work"]
    lines = [(c.label, [(p.label, p.time.median, p.error) for p in c.points]) for c in curves]
    if key != "camera":
        return [work_panel(lines, unit, time)]
    return [
        front_panel(_choices(curve.label, points, curve.points), unit, time)
        for curve, (_, points) in zip(curves, lines, strict=True)
        if any(point.time.median > 0.0 for point in curve.points)
    ]


def _choices(name: str, settings: Sequence[Setting], points: Sequence[Point]) -> Choices:
    best = pareto([(spent, off) for _, spent, off in settings])
    return Choices(name, settings, best, [point.precision for point in points])
