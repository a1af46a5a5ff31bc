"""A question as an item."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from markupsafe import Markup

from quizgen.bank.pictures import PictureFile
from quizgen.figures import Figure
from quizgen.lms.interactions import ExtendedTextInteraction, Interaction
from quizgen.lms.items import ExportItem
from quizgen.lms.manifest import ManifestQuestion
from quizgen.lms.manifest_writer import response_field
from quizgen.lms.markup import (
    fill_marks,
    image_path,
    mark_fields,
    pictures_from,
    solution_html,
    stem_html,
    to_course_html,
)
from quizgen.lms.qti.dialect import QTI21, Dialect, format_number_plain
from quizgen.lms.qti.interactions import RenderedInteraction, render_interaction
from quizgen.lms.qti.response_rules import ResponseRules
from quizgen.locale import translate

# The outcome that shows the worked solution, and its value.
SOLVED, WORKED = "SOLUTION", "worked"

_NO_IDENTIFIER = re.compile(r"[^A-Za-z0-9_-]")
_MATHS = re.compile(r"<math(?=[ >])")


@dataclass(frozen=True, slots=True)
class ItemPart:
    """An interaction in an item: its variables, and what it becomes."""

    interaction: Interaction
    rules: ResponseRules
    rendered: RenderedInteraction


def item_identifier(item: ExportItem) -> str:
    """Return the identifier of an item: its id without points, which have a meaning in QTI."""
    name = _NO_IDENTIFIER.sub("_", item.id)
    return name if name[0].isalpha() else f"Q{name}"


def write_item(item: ExportItem, dialect: Dialect) -> bytes:
    """Return a question as the file of an item."""
    with pictures_from(_file_address):
        groups = [
            [ItemPart(one, rules, render_interaction(one, rules)) for one, rules in group]
            for group in _response_rules(item, dialect)
        ]
        rows = [row for group in groups for row in group]
        named = {
            "identifier": item_identifier(item),
            "title": item.title(),
            "xml:lang": item.lang,
            "adaptive": "false",
            "timeDependent": "false",
            "toolName": "quizgen",
        }
        inside = [
            *_declarations(item, rows, dialect),
            _item_body(item, groups, dialect),
            _response_processing(item, groups, dialect),
            *_feedback_elements(item, rows, dialect),
        ]
        return dialect.file("assessmentItem", named, *map(_to_xml, inside))


def qti_manifest(item: ExportItem) -> Iterator[ManifestQuestion]:
    """Yield how the variables of an item are read back; both versions name them alike."""
    groups = zip(item.parts, _response_rules(item, QTI21), strict=True)
    fields = [
        response_field(one, part, item.lang, rules.response_name)
        for (part, _), group in groups
        for one, rules in group
    ]
    yield ManifestQuestion(item.token(), item_identifier(item), fields)


def _response_rules(
    item: ExportItem, dialect: Dialect
) -> Iterator[list[tuple[Interaction, ResponseRules]]]:
    """Yield the interactions of each part with their variables.

    Each of several values counts 1: marks such as 2/3 would not sum up where outcomes are rounded.
    """
    for part, interactions in item.parts:
        label = f"_{part.label}" if part.label else ""
        points = float(part.points)
        yield [
            (one, ResponseRules(dialect, f"{label}_{i}", 1.0, item.lang, f"{i}. "))
            if len(interactions) > 1
            else (one, ResponseRules(dialect, label, points, item.lang))
            for i, one in enumerate(interactions, 1)
        ]


def _declarations(item: ExportItem, rows: list[ItemPart], dialect: Dialect) -> Iterator[Markup]:
    """Yield the declarations of responses and outcomes, in the order that the schema wants."""
    total = float(item.question.points)
    yield from (row.rendered.declaration for row in rows)
    for row in rows:
        is_manual = isinstance(row.interaction, ExtendedTextInteraction)
        yield _score_outcome(row.rules.score_name, row.rules.points, dialect, is_manual=is_manual)
    if not _is_single(rows):
        yield _score_outcome("SCORE", total, dialect)
    yield dialect.outcome("MAXSCORE", "single float", {}, _default_value(total, dialect))
    yield dialect.outcome(SOLVED, "single identifier", {})
    yield from (row.rendered.outcomes for row in rows)


def _is_single(rows: list[ItemPart]) -> bool:
    """Return whether the marks of the one interaction are those of the item."""
    return [row.rules.score_name for row in rows] == ["SCORE"]


def _score_outcome(name: str, most: float, dialect: Dialect, *, is_manual: bool = False) -> Markup:
    """Return the declaration of an outcome with marks up to ``most``."""
    # QTI 3.0 alone says that a person gives the marks.
    human = {"externalScored": "human"} if dialect.prefixed and is_manual else {}
    return dialect.outcome(
        name, "single float", {"normalMaximum": most, **human}, _default_value(0, dialect)
    )


def _default_value(value: float, dialect: Dialect) -> Markup:
    """Return the default value of a declaration."""
    return dialect.tag("defaultValue", {}, dialect.tag("value", {}, format_number_plain(value)))


def _item_body(item: ExportItem, groups: list[list[ItemPart]], dialect: Dialect) -> Markup:
    """Return what a learner sees: stem, parts and their interactions."""
    in_line = [
        Markup("; ").join(row.rendered.inline for row in group)
        if part.field.near is not None and all(row.rendered.inline for row in group)
        else ""
        for (part, _), group in zip(item.parts, groups, strict=True)
    ]
    below = [Markup("").join(row.rendered.body for row in group) for group in groups]
    placed = {place for place, field in enumerate(in_line) if field}
    text = mark_fields(item.parts, item.lang, _file_address, placed)
    fields = [field or other for field, other in zip(in_line, below, strict=True)]
    return dialect.tag("itemBody", {}, stem_html(item, _file_address) + fill_marks(text, fields))


def _response_processing(
    item: ExportItem, groups: list[list[ItemPart]], dialect: Dialect
) -> Markup:
    """Return the rules that grade an item: for each given response, the sum, the solution."""
    rows = [row for group in groups for row in group]
    steps = [
        row.rules.if_answered(row.rendered.processing) for row in rows if row.rendered.processing
    ]
    rules = rows[0].rules
    if not _is_single(rows):
        points = [part.points for part in item.question.parts]
        marks = map(_part_score, groups, points)
        steps.append(rules.set_outcome("SCORE", dialect.tag("sum", {}, *marks)))
    steps.append(rules.set_feedback(SOLVED, WORKED))
    return dialect.tag("responseProcessing", {}, *steps)


def _part_score(group: list[ItemPart], points: Fraction) -> Markup:
    """Return the expression of a part's marks.

    Of one interaction its own score, of several values the part's share of right ones.
    """
    rules = group[0].rules
    scores = [rules.tag("variable", {"identifier": row.rules.score_name}) for row in group]
    if len(scores) == 1:
        return scores[0]
    share = rules.constant("float", float(points / len(scores)))
    return rules.tag("product", {}, rules.tag("sum", {}, *scores), share)


def _feedback_elements(
    item: ExportItem, rows: list[ItemPart], dialect: Dialect
) -> Iterator[Markup]:
    """Yield the feedback on each misconception, and the worked solution."""
    for one in (one for row in rows for one in row.rendered.feedback):
        words = to_course_html(one.words, item.lang)
        yield _modal_feedback(dialect, one.outcome, one.value, words)
    title = translate(item.lang, "solution.steps")
    yield _modal_feedback(dialect, SOLVED, WORKED, solution_html(item, _file_address), title)


def _modal_feedback(
    dialect: Dialect, outcome: str, value: str, words: Markup, title: str = ""
) -> Markup:
    """Return feedback that is shown when an outcome has a value."""
    named = {"outcomeIdentifier": outcome, "identifier": value, "showHide": "show"}
    return dialect.flow("modalFeedback", {**named, **({"title": title} if title else {})}, words)


def _file_address(shown: Figure | PictureFile) -> str:
    """Return the address of a package's file from the folder of items."""
    return f"../{image_path(shown)}"


def _to_xml(page: Markup) -> Markup:
    """Return well-formed HTML as XML: with a namespace for formulas and ``xml:lang``."""
    shown = _MATHS.sub('<math xmlns="http://www.w3.org/1998/Math/MathML"', page)
    return Markup(shown.replace(' lang="', ' xml:lang="'))  # noqa: S704 - a rewritten page
