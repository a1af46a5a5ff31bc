"""Showing marked papers: a table for one student, CSV for a class."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from quizgen.core.text_width import lay_out_table, wrap_lines
from quizgen.core.untrusted import format_csv
from quizgen.grading.echo import safe_echo
from quizgen.grading.feedback import format_read_back, load_words_inside
from quizgen.locale import localise_numbers
from quizgen.paper.grading import PaperResult, PartResult

COLOURS = {
    "correct": "green",
    "partial": "yellow",
    "wrong": "red",
    "unreadable": "magenta",
    "ambiguous": "magenta",
    "open": "cyan",
    "blank": "bright_black",
}

_REMARK = " " * 5  # before each line of a remark
MOST_UNKNOWN = 10
"""Answers to parts that the paper does not have, of one form, that are named."""


def format_points(value: Fraction | None) -> str:
    """Return marks as text: ``2``, ``1.75``; a dash where a person decides."""
    return "–" if value is None else f"{float(value):g}"


def result_rows(result: PaperResult, lang: str) -> list[tuple[str, list[str]]]:
    """Return the status and the cells of each part's row."""
    return [(part.status, _format_result_row(part, lang)) for part in result.parts]


def _format_result_row(part: PartResult, lang: str) -> list[str]:
    """Return the cells of one part: label, verdict, marks, how it was read, remark."""
    shown = load_words_inside(lang).get(part.word, part.word)
    marks = localise_numbers(lang, f"{format_points(part.marks)} / {format_points(part.points)}")
    remark = "" if part.is_blank else part.verdict.message
    read_as = format_read_back(part.kind, part.verdict.read_as, lang) or safe_echo(part.typed)
    return [part.id, shown, marks, read_as, remark]


def format_table(result: PaperResult, lang: str, columns: int, paint: bool) -> Iterable[str]:
    """Yield the results as a table; remarks have lines of their own, so that none is cut off."""
    import click

    table = load_words_inside(lang)
    heads = [table["part"], table["verdict"], table["marks"], table["read"]]
    body = result_rows(result, lang)
    (head,), *lines = lay_out_table([heads, *(cells[:4] for _, cells in body)])
    yield click.style(head, bold=True) if paint else head
    for (status, cells), (line,) in zip(body, lines, strict=True):
        yield click.style(line, fg=COLOURS[status]) if paint else line
        if cells[4]:
            yield from wrap_lines(cells[4], max(columns, 40), _REMARK, _REMARK)
    total = f"{table['total']}: {format_points(result.marks)} / {format_points(result.points)}"
    yield localise_numbers(lang, total)
    if result.asked_back:
        name = "asked-back-one" if result.asked_back == 1 else "asked-back"
        yield table[name].format(count=result.asked_back)
    for part in result.unknown[:MOST_UNKNOWN]:
        yield table["unknown-part"].format(part=safe_echo(part))
    if len(result.unknown) > MOST_UNKNOWN:
        yield f"... (+{len(result.unknown) - MOST_UNKNOWN})"


def write_class_csv(results: list[tuple[str, str, str, PaperResult]]) -> str:
    """Return the CSV table of a class, one row per student: marks, then notes; writes no file.

    Parameters
    ----------
    results : list of (file, name, matriculation number, result)
        All of one paper.
    """
    ids = [part.id for part in results[0][3].parts] if results else []
    head = ["file", "name", "matriculation", "marks", "points", "asked_back", "to_decide"]
    titles = [f"{name} {what}" for what in ("marks", "note") for name in ids]
    rows = ([*student, *_format_class_row(result)] for *student, result in results)
    return format_csv([[*head, *titles], *rows])


def _format_class_row(result: PaperResult) -> list[str]:
    """Return the cells of one student in the table of a class."""
    totals = [format_points(result.marks), format_points(result.points)]
    counts = [str(result.asked_back), str(result.to_decide)]
    marks = ["" if part.marks is None else format_points(part.marks) for part in result.parts]
    return [*totals, *counts, *marks, *map(part_note, result.parts)]


def part_note(part: PartResult) -> str:
    """Return in one word what there is to say of a part."""
    return part.status if part.is_blank else part.verdict.note or part.verdict.verdict
