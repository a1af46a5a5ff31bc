"""The measurements as plain data, as a table for spreadsheets and as a short text."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import asdict
from typing import Any

from quizgen.locale import table
from quizgen.tradeoff.measure import Measured, Timing
from quizgen.tradeoff.numbers import short
from quizgen.tradeoff.overview import (
    cost,
    cost_text,
    digits_text,
    factor_text,
    middle,
    proven,
    road,
)
from quizgen.tradeoff.plot import time_text
from quizgen.tradeoff.product import PHASES, Product
from quizgen.tradeoff.report import FamilyReport, Report
from quizgen.tradeoff.solving import FAULTS

HEAD = (
    "family", "number", "way", "median_ns", "low_ns", "high_ns",
    "exam_digits", "exam_max_ulp", "exam_mean_bits", "exam_lost",
    "hard_digits", "hard_max_ulp", "hard_mean_bits", "hard_lost",
)  # fmt: skip
"""Columns of ``tradeoff.csv``; digits of 17 mean all, an empty error means that the way fails."""


def words(lang: str) -> dict[str, Any]:
    """All sentences of the page in one language."""
    return table(lang, "tradeoff")


def as_data(report: Report, command: str) -> dict[str, Any]:
    """Everything measured, as plain data (infinite errors as null)."""
    return {
        "format": "quizgen-tradeoff/2",
        "command": command,
        "machine": report.machine,
        "date": report.date,
        "effort": asdict(report.effort),
        "measure": "correct decimal digits of the worst result, 17 for all; forward error in "
        "doubles from the correctly rounded value; bits = log2(1 + n); seconds as median and "
        "quartiles",
        "figure": asdict(report.figure),
        "families": [_finite(asdict(family)) for family in report.families],
        "product": None if report.product is None else asdict(report.product),
        "knobs": {key: [asdict(curve) for curve in curves] for key, curves in report.knobs},
    }


def _finite(data: object) -> object:
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, tuple | list):
        return [_finite(value) for value in data]
    return None if isinstance(data, float) and math.isinf(data) else data


def as_csv(report: Report) -> str:
    """One row per way of computing a formula."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEAD)
    for number, family in enumerate(report.families, 1):
        for rung in family.rungs:
            writer.writerow([family.name, number, rung.key, *_times(rung.time), *_errors(rung)])
    return text.getvalue()


PRODUCT = ("arithmetic", "drawing_ms", "solving_ms", "collisions_ms", "marking_ms", "paper_ms",
           "drawn", "digit", "accepted", "rejected", "unanswered")  # fmt: skip
"""Columns of ``product.csv``: medians per paper, then faults among the questions drawn."""


def product_csv(product: Product) -> str:
    """One row per arithmetic."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(PRODUCT)
    for row in product.rows:
        spent = [1e3 * row.phases[phase].median for phase in PHASES] + [1e3 * row.whole.median]
        found = product.counted.faults.get(row.system, {})
        counts = [product.counted.drawn, *(found.get(fault, 0) for fault in FAULTS)]
        writer.writerow([row.system, *(f"{ms:.4g}" for ms in spent), *counts])
    return text.getvalue()


def _times(time: Timing) -> list[str]:
    return [f"{1e9 * seconds:.4g}" for seconds in (time.median, time.low, time.high)]


def _errors(rung: Measured) -> list[str]:
    return [
        "" if math.isinf(value) else f"{value:.4g}"
        for found in (rung.exam, rung.hard)
        for value in (found.digits, found.max_steps, found.mean_bits, found.lost)
    ]


def markdown(report: Report, command: str) -> str:
    """In English the sentence, and a table: each step on hard inputs, and the verdict."""
    text = words("en")
    head = "| formula | printed to stable | stable to exact | verdict |"
    lines = [f"`{command}` on {report.machine}", "", f"> {sentence(report, 'en')}", ""]
    lines += [head, "|---|---|---|---|"]
    for family in report.families:
        title = text["family"][family.name]["title"]
        steps = " | ".join(steps_text(family, "hard", text))
        lines.append(f"| {title} | {steps} | {verdict_text(family, report, text)} |")
    return "\n".join([*lines, "", text["overview"]["measure"], ""])


def sentence(report: Report, lang: str) -> str:
    """The picture in words."""
    text = words(lang)["overview"]
    roads = [road(family, "hard") for family in report.families]
    median = middle(roads)
    slower = cost(median.printed, median.stable).slower
    said: str = text["sentence"].format(
        count=len(roads),
        before=digits_text(median.printed.digits, text["every"]),
        stable=digits_text(median.stable.digits, text["every"]),
        slower=factor_text(slower),
        times=factor_text(median.proven.time / median.stable.time),
        proven=time_text(median.proven.time),
        share=short(median.proven.time / report.figure.median / 1e7),
        figure=time_text(1e9 * report.figure.median),
    )
    return said


def steps_text(family: FamilyReport, inputs: str, text: dict[str, Any]) -> tuple[str, str]:
    """Both steps of a family in words."""
    one = road(family, inputs)
    steps = cost(one.printed, one.stable), cost(one.stable, one.proven)
    first, second = (cost_text(step, text["overview"]) for step in steps)
    return first, second


def verdict_text(family: FamilyReport, report: Report, text: dict[str, Any]) -> str:
    """What is graded, what it costs, and what pictures use."""
    spent = proven(family).nanoseconds
    share = 100 * spent / (1e9 * report.figure.median)
    said: str = text["overview"]["verdict"].format(cost=time_text(spent), share=short(share))
    return said


def digits_said(count: float, lang: str) -> str:
    """Correct digits for a table."""
    return digits_text(count, words(lang)["overview"]["every"])
