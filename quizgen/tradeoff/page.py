"""The page: one self-contained HTML file in every language, without scripts."""

from __future__ import annotations

import json
import math
from html import escape
from pathlib import Path
from typing import Any

from quizgen.locale import language, languages, table
from quizgen.tradeoff.knobs import Curve
from quizgen.tradeoff.measure import Accuracy, Measured, pareto
from quizgen.tradeoff.plot import (
    HEIGHT,
    PANEL,
    STYLE,
    Mark,
    accuracy_panel,
    document,
    time_text,
    work_panel,
)
from quizgen.tradeoff.report import EXACT, FamilyReport, Report

HALF_PIXEL = 0.5 / 255
_ROUNDING = 2.0**-53

CSS = """
:root{color-scheme:light dark}
body{font:16px/1.5 system-ui,"Hind Siliguri","Noto Sans Bengali",sans-serif;max-width:62rem;
margin:0 auto;padding:1rem;color:#1a1a1a;background:#fff}
h1{font-size:1.6rem;line-height:1.25}h2{font-size:1.2rem;margin:2.2rem 0 .3rem}
section{border-top:1px solid #8886}
figure{margin:.6rem 0;overflow-x:auto}svg{max-width:none;height:auto;color:inherit}
table{border-collapse:collapse;font-size:.86rem;margin:.5rem 0;display:block;overflow-x:auto}
th,td{padding:.25rem .55rem;text-align:right;border-bottom:1px solid #8885;white-space:nowrap}
th{font-weight:600;vertical-align:bottom;white-space:normal;min-width:4.5rem}
td.words,th.words{text-align:left}td.words{white-space:normal;min-width:9rem}
tr.front td{font-weight:600}
code{font-size:.88em;overflow-wrap:anywhere}.note{font-size:.86rem;opacity:.85}
.verdict{border-left:4px solid #0b62c4;padding:.3rem .8rem;font-weight:600}
label{margin-right:1rem;cursor:pointer}ul{columns:2;padding-left:1.2rem}
@media(prefers-color-scheme:dark){
body{color:#e8e8e8;background:#14171a}a{color:#8ab8ff}
.tp circle.on,.tp rect.on{fill:#6aa9ff!important}
.tp .on,.tp .front{stroke:#6aa9ff!important}
.tp .second{stroke:#ff9d5c!important}.tp circle.second{fill:#ff9d5c!important}
.tp .third{stroke:#8ad05f!important}.tp circle.third{fill:#8ad05f!important}}
@media print{label,input{display:none}}
@media(max-width:40rem){ul{columns:1}}
"""


def words(lang: str) -> dict[str, Any]:
    """All sentences of the page in one language."""
    return table(lang, "tradeoff")


def write(report: Report, folder: Path, command: str) -> list[Path]:
    """Write the page, its data, a short table and one SVG per plot; return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    plots = {family.name: family_plot(family, "en") for family in report.families}
    plots |= {key: knob_plot(key, curves, "en") for key, curves in report.knobs}
    made = {f"{name}.svg": svg for name, svg in plots.items()}
    made["tradeoff.json"] = json.dumps(as_data(report, command), indent=1) + "\n"
    made["tradeoff.html"] = html(report, command)
    made["tradeoff.md"] = markdown(report, command)
    paths = []
    for name, text in made.items():
        paths.append(folder / name)
        paths[-1].write_text(text, encoding="utf-8")
    return paths


def as_data(report: Report, command: str) -> dict[str, Any]:
    """Everything measured, as plain data (infinite errors as null)."""
    families = [
        {
            "name": family.name,
            "formula": family.formula,
            "tolerance": family.tolerance,
            "rungs": [_finite(rung.as_dict()) for rung in family.rungs],
            "peers": [
                {"name": name, "exam": _finite(vars_of(exam)), "hard": _finite(vars_of(hard))}
                for name, exam, hard in family.peers
            ],
        }
        for family in report.families
    ]
    knobs = {key: [curve.as_dict() for curve in curves] for key, curves in report.knobs}
    return {
        "format": "quizgen-tradeoff/1",
        "command": command,
        "machine": report.machine,
        "measure": "forward error in doubles from the correctly rounded value; bits = log2(1 + n)",
        "ladder_seconds": report.ladder_seconds,
        "figure_seconds": report.figure_seconds,
        "families": families,
        "knobs": knobs,
    }


def vars_of(accuracy: Accuracy) -> dict[str, Any]:
    """Fields of one accuracy."""
    from dataclasses import asdict

    return asdict(accuracy)


def _finite(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    return None if isinstance(data, float) and math.isinf(data) else data


def html(report: Report, command: str) -> str:
    """The whole page."""
    switch = "".join(
        f'<input type="radio" name="lang" id="{lang}"{" checked" * (lang == "en")}>'
        f'<label for="{lang}" lang="{lang}">{language(lang).name}</label>'
        for lang in languages()
    )
    body = "".join(
        f'<div class="{lang}" lang="{lang}">{_body(report, command, lang)}</div>'
        for lang in languages()
    )
    title = escape(words("en")["page"]["title"])
    return (
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{title}</title><style>{_font_face()}{CSS}{_language_rules()}{STYLE}</style></head>"
        f"<body>{switch}<main>{body}</main></body></html>\n"
    )


def _language_rules() -> str:
    """One language is seen at a time, in letters that its script has."""
    bangla = [lang for lang in languages() if language(lang).script == "Beng"]
    lettered = ",".join(f"[lang={lang}],[lang={lang}] .tp text" for lang in bangla)
    fonts = 'font-family:"Hind Siliguri","Noto Sans Bengali",system-ui,sans-serif'
    hidden = (f"#{lang}:checked~main>:not(.{lang})" for lang in languages())
    return f"{lettered}{{{fonts}}}\n{','.join(hidden)}{{display:none}}\n"


def _font_face() -> str:
    """Bangla letters travel with the page."""
    from quizgen.render.fonts import bangla_uri

    face = (
        '@font-face{font-family:"Hind Siliguri";font-display:block;font-weight:%s;'
        'src:url(%s) format("woff2")}'
    )
    return "".join(
        face % (weight, bangla_uri(name)) for name, weight in (("Regular", 400), ("Bold", 700))
    )


def markdown(report: Report, command: str) -> str:
    """A short table in English: the printed formula beside the stable and the proven ways."""
    text = words("en")
    head = "| question | printed formula, float64 | stable form, float64 | exact or Arb |"
    lines = [f"`{command}` on {report.machine}", "", head, "|---|---|---|---|"]
    for family in report.families:
        rungs = {rung.key: rung for rung in family.rungs}
        proven = min((r for k, r in rungs.items() if k in EXACT), key=lambda r: r.nanoseconds)
        cells = [_cell(rung) for rung in (rungs["float64"], rungs["stable"], proven)]
        lines.append(f"| {text['family'][family.name]['title']} | {' | '.join(cells)} |")
    verdict = text["page"]["verdict"].format(
        ladder=time_text(report.ladder_seconds * 1e9), figure=time_text(report.figure_seconds * 1e9)
    )
    note = "Time per value; largest error in doubles on exam inputs, on hard inputs."
    return "\n".join([*lines, "", note, "", verdict, ""])


def _cell(rung: Measured) -> str:
    errors = ", ".join(_plain(each.max_steps) for each in (rung.exam, rung.hard))
    return f"{time_text(rung.nanoseconds)}; {errors}"


def _plain(steps: float) -> str:
    return f"{steps:.0f}" if steps < 10000 else f"{steps:.0e}".replace("e+", "e")


def _body(report: Report, command: str, lang: str) -> str:
    page = words(lang)["page"]
    effort = report.effort
    intro = escape(page["intro"]).format(
        machine=escape(report.machine), command=f"<code>{escape(command)}</code>"
    )
    verdict = page["verdict"].format(
        ladder=time_text(report.ladder_seconds * 1e9), figure=time_text(report.figure_seconds * 1e9)
    )
    measure = page["measure"].format(exam=effort.inputs, hard=effort.inputs, scalars=effort.scalars)
    parts = [
        f"<h1>{escape(page['title'])}</h1><p>{intro}</p>",
        f'<p class="verdict">{escape(verdict)}</p><p>{escape(page["reading"])}</p>',
        _contents(report, lang),
        *[_family(family, lang, measure) for family in report.families],
    ]
    if report.knobs:
        parts.append(f"<h1>{escape(page['knobs'])}</h1><p>{escape(page['knobs_intro'])}</p>")
        parts += [_knob(key, curves, lang) for key, curves in report.knobs]
    return "".join(parts)


def _contents(report: Report, lang: str) -> str:
    titles = [(f.name, words(lang)["family"][f.name]["title"]) for f in report.families]
    titles += [(key, words(lang)["knob"][key]["title"]) for key, _ in report.knobs]
    items = "".join(f'<li><a href="#{k}-{lang}">{escape(t)}</a></li>' for k, t in titles)
    return f'<nav aria-label="{escape(words(lang)["page"]["contents"])}"><ul>{items}</ul></nav>'


def _family(family: FamilyReport, lang: str, measure: str) -> str:
    text, page = words(lang)["family"][family.name], words(lang)["page"]
    formula = f"<p>{escape(page['formula'])}: <code>{escape(family.formula)}</code></p>"
    return (
        f'<section id="{family.name}-{lang}"><h2>{escape(text["title"])}</h2>'
        f"<p>{escape(text['lesson'])}</p>{formula if family.formula else ''}"
        f"<figure>{family_plot(family, lang)}</figure>{_rung_table(family, lang)}"
        f"{_peer_table(family, lang)}"
        f'<p class="note">{escape(measure)}</p></section>'
    )


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
    points = [(rung.nanoseconds, getattr(rung, which).max_bits) for rung in rungs]
    front = set(pareto(points))
    return [
        Mark(i + 1, x, y, rungs[i].kind == "scalar", i in front) for i, (x, y) in enumerate(points)
    ]


def _rung_table(family: FamilyReport, lang: str) -> str:
    head, rung_words = words(lang)["table"], words(lang)["rung"]
    front = set(pareto([(r.nanoseconds, r.hard.max_bits) for r in family.rungs]))
    rows = "".join(
        f"<tr{' class=front' * (i in front)}><td>{i + 1}</td>"
        f'<td class="words">{escape(rung_words[rung.key])}</td>'
        f"<td>{time_text(rung.nanoseconds)}</td><td>{_count(rung.exam.max_steps, lang)}</td>"
        f"<td>{_count(rung.hard.max_steps, lang)}</td><td>{rung.hard.mean_bits:.1f}</td>"
        f"<td>{rung.hard.lost:.0%}</td>"
        f'<td class="words">{escape(words(lang)["guarantee"][rung.key])}</td></tr>'
        for i, rung in enumerate(family.rungs)
    )
    keys = ("number", "way", "time", "exam_max", "hard_max", "hard_mean", "lost", "guarantee")
    return _table([head[key] for key in keys], rows, {1, 7})


def _peer_table(family: FamilyReport, lang: str) -> str:
    if not family.peers:
        return ""
    head = words(lang)["table"]
    rows = "".join(
        f'<tr><td class="words">{escape(name)}</td><td>{_count(exam.max_steps, lang)}</td>'
        f"<td>{_count(hard.max_steps, lang)}</td><td>{hard.mean_bits:.1f}</td>"
        f"<td>{hard.lost:.0%}</td></tr>"
        for name, exam, hard in family.peers
    )
    keys = ("peer", "exam_max", "hard_max", "hard_mean", "lost")
    return _table([head[key] for key in keys], rows, {0})


def _table(head: list[str], rows: str, left: set[int]) -> str:
    cells = "".join(
        f'<th scope="col"{" class=words" * (i in left)}>{escape(text)}</th>'
        for i, text in enumerate(head)
    )
    return f"<table><thead><tr>{cells}</tr></thead><tbody>{rows}</tbody></table>"


def _count(steps: float, lang: str) -> str:
    if math.isinf(steps):
        return escape(words(lang)["page"]["failed"])
    if steps < 10000:
        return f"{steps:.3g}" if steps < 1 else f"{steps:.0f}"
    leading, exponent = f"{steps:.0e}".split("e+")
    return f"{leading}·10<sup>{int(exponent)}</sup>"


def knob_plot(key: str, curves: tuple[Curve, ...], lang: str) -> str:
    """Work-precision plot of one setting."""
    text = words(lang)["knob"][key]
    lines = [(c.label, [(p.label, p.seconds, p.error) for p in c.points]) for c in curves]
    return document(work_panel(lines, text["error"]), PANEL + 180, HEIGHT, text["title"])


def _knob(key: str, curves: tuple[Curve, ...], lang: str) -> str:
    text, head = words(lang)["knob"][key], words(lang)["table"]
    rows = "".join(
        f'<tr><td class="words">{escape(curve.label)}</td><td>{escape(point.label)}</td>'
        f"<td>{time_text(point.seconds * 1e9)}</td><td>{point.error:.2g}</td></tr>"
        for curve in curves
        for point in curve.points
    )
    columns = ["", head["setting"], head["work"], head["error"]]
    return (
        f'<section id="{key}-{lang}"><h2>{escape(text["title"])}</h2>'
        f"<p>{escape(text['lesson'])}</p><figure>{knob_plot(key, curves, lang)}</figure>"
        f"<details><summary>{escape(text['error'])}</summary>{_table(columns, rows, {0})}"
        "</details></section>"
    )
