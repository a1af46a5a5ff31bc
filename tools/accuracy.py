"""Measure again what accuracy costs: sentences, tables and the plot of ``docs/accuracy.md``."""

from __future__ import annotations

import re
from pathlib import Path

from quizgen.bank.bank import builtin_bank
from quizgen.tradeoff.page import describe_arrays, describe_digits, describe_questions, draw_digits
from quizgen.tradeoff.report import TradeoffReport, measure_tradeoff
from quizgen.tradeoff.texts import words

PAGE = Path("docs/accuracy.md")
MEASURED = re.compile(r"(?<=<!-- measured -->\n).*?(?=<!-- end -->)", re.DOTALL)


def format_measurements(report: TradeoffReport) -> str:
    """Return the measured part of ``docs/accuracy.md`` as Markdown."""
    text, questions = words("en"), describe_questions(report, "en")
    arrays = describe_arrays(report, "en")
    parts = [
        text["page"]["measured"].format(machine=report.machine, date=report.date)[:-1] + ".",
        questions["lead"],
        questions["sentence"],
        format_markdown_table(text["questions"]["columns"], [
            (f"{name} ({fails})" if fails else name, *cells)
            for name, fails, *cells in questions["rows"]
        ]),
        describe_digits(report, "en"),
        f"![{text['plot']['alt']}](accuracy/digits.svg)",
        format_markdown_table(text["arrays"]["columns"], [
            (f"{title}: {name}", *cells)
            for title, group in arrays["groups"] for name, _, *cells in group
        ]),
        f"{text['arrays']['how']} {arrays['alone']}",
    ]  # fmt: skip
    return "\n\n".join(parts) + "\n\n"


def format_markdown_table(columns: list[str], lines: list[tuple[str, ...]]) -> str:
    """Return a Markdown table."""
    head = ["| " + " | ".join(columns) + " |", "|---" * len(columns) + "|"]
    return "\n".join([*head, *("| " + " | ".join(line) + " |" for line in lines)])


def main() -> None:
    """Measure, and write the results into the page and its plot."""
    report = measure_tradeoff(builtin_bank())
    plot = draw_digits(report, words("en")["plot"]["alt"], "en")
    PAGE.with_suffix("").joinpath("digits.svg").write_bytes(plot.standalone_svg)
    text = PAGE.read_text("utf-8")
    PAGE.write_text(MEASURED.sub(lambda _: format_measurements(report), text, count=1), "utf-8")


if __name__ == "__main__":
    main()
