"""Showing marked papers: a table for one student, CSV for a class."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from quizgen.columns import width
from quizgen.locale import numbers_in
from quizgen.marking.echo import safe
from quizgen.marking.messages import read_back, words
from quizgen.outside import csv_text
from quizgen.paper.marking import PaperResult, PartResult

COLOURS = {
    "correct": "green",
    "partial": "yellow",
    "wrong": "red",
    "unreadable": "magenta",
    "ambiguous": "magenta",
    "open": "cyan",
    "blank": "bright_black",
}

MOST_UNKNOWN = 10
"""Answers to parts that the paper does not have, of one form, that are named."""


def points_text(value: Fraction | None) -> str:
    """Write marks: ``2``, ``1.75``; a dash where a person decides."""
    return "–" if value is None else f"{float(value):g}"


def rows(result: PaperResult, lang: str) -> list[tuple[str, list[str]]]:
    """Return the status and the cells of each part's row."""
    return [(part.status, _row(part, lang)) for part in result.parts]


def _row(part: PartResult, lang: str) -> list[str]:
    shown = words(lang).get(part.status, part.status)
    marks = numbers_in(lang, f"{points_text(part.marks)} / {points_text(part.points)}")
    remark = "" if part.blank else part.verdict.message
    read_as = read_back(part.kind, part.verdict.read_as, lang) or safe(part.typed)
    return [part.id, shown, marks, read_as, remark]


def table_lines(result: PaperResult, lang: str, columns: int, paint: bool) -> Iterable[str]:
    """Lay the table out: remarks go on lines of their own so that nothing is cut off."""
    import click

    table = words(lang)
    heads = [table["part"], table["verdict"], table["marks"], table["read"]]
    body = rows(result, lang)
    sizes = [max(width(row[i]) for row in [heads, *[r for _, r in body]]) for i in range(3)]
    yield click.style(_line(heads, sizes), bold=True) if paint else _line(heads, sizes)
    for status, cells in body:
        line = _line(cells[:4], sizes)
        yield click.style(line, fg=COLOURS[status]) if paint else line
        if cells[4]:
            yield from _wrapped(cells[4], columns)
    total = f"{table['total']}: {points_text(result.marks)} / {points_text(result.points)}"
    yield numbers_in(lang, total)
    if result.asked_back:
        name = "asked-back-one" if result.asked_back == 1 else "asked-back"
        yield table[name].format(count=result.asked_back)
    for part in result.unknown[:MOST_UNKNOWN]:
        yield table["unknown-part"].format(part=safe(part))
    if len(result.unknown) > MOST_UNKNOWN:
        yield f"... (+{len(result.unknown) - MOST_UNKNOWN})"


def _line(cells: list[str], sizes: list[int]) -> str:
    padded = [cell + " " * (size - width(cell)) for cell, size in zip(cells, sizes, strict=False)]
    return "  ".join([*padded, *cells[len(sizes) :]]).rstrip()


def _wrapped(text: str, columns: int) -> Iterable[str]:
    line = "     "
    for word in text.split():
        if width(line) + 1 + width(word) > max(columns, 40) and line.strip():
            yield line
            line = "     "
        line += f" {word}" if line.strip() else word
    yield line


def class_csv(results: list[tuple[str, str, str, PaperResult]]) -> str:
    """Write one row per student: marks, then notes, of every part.

    Parameters
    ----------
    results : list of (file, name, matriculation number, result)
        All of one paper.
    """
    ids = [part.id for part in results[0][3].parts] if results else []
    head = ["file", "name", "matriculation", "marks", "points", "asked_back", "to_decide"]
    titles = [f"{name} {what}" for what in ("marks", "note") for name in ids]
    rows = ([*student, *_class_row(result)] for *student, result in results)
    return csv_text([[*head, *titles], *rows])


def _class_row(result: PaperResult) -> list[str]:
    totals = [points_text(result.marks), points_text(result.points)]
    counts = [str(result.asked_back), str(result.to_decide)]
    marks = ["" if part.marks is None else points_text(part.marks) for part in result.parts]
    return [*totals, *counts, *marks, *map(note, result.parts)]


def note(part: PartResult) -> str:
    """What is to be said of a part in one word."""
    return part.status if part.blank else part.verdict.note or part.verdict.verdict
