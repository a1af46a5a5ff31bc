"""The measurements as plain data and as a short table."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from quizgen.locale import table
from quizgen.tradeoff.measure import Measured
from quizgen.tradeoff.plot import time_text
from quizgen.tradeoff.report import EXACT, Report


def words(lang: str) -> dict[str, Any]:
    """All sentences of the page in one language."""
    return table(lang, "tradeoff")


def as_data(report: Report, command: str) -> dict[str, Any]:
    """Everything measured, as plain data (infinite errors as null)."""
    families = [
        {
            "name": family.name,
            "formula": family.formula,
            "tolerance": family.tolerance,
            "rungs": [_finite(asdict(rung)) for rung in family.rungs],
            "peers": [
                {"name": name, "exam": _finite(asdict(exam)), "hard": _finite(asdict(hard))}
                for name, exam, hard in family.peers
            ],
        }
        for family in report.families
    ]
    knobs = {key: [asdict(curve) for curve in curves] for key, curves in report.knobs}
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


def _finite(data: object) -> object:
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    return None if isinstance(data, float) and math.isinf(data) else data


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
