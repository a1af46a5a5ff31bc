"""A test: a section for each slot, from which one variant is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from markupsafe import Markup

from quizgen.lms.items import ExportItem
from quizgen.lms.qti.dialect import Dialect
from quizgen.lms.qti.item import item_identifier

# Outcomes of items that are summed up over the test.
_SUMMED = ("SCORE", "MAXSCORE")


def write_assessment(lang: str, items: list[ExportItem], dialect: Dialect) -> bytes:
    """Return the test of the questions in one language, slot after slot."""
    tag = dialect.tag
    control = tag("itemSessionControl", {"showFeedback": "true", "allowReview": "true"})
    part = {
        "identifier": "part",
        "navigationMode": "nonlinear",
        "submissionMode": "simultaneous",
    }
    sections = Markup("").join(_write_sections(items, dialect))
    named = {"identifier": f"test-{lang}", "title": f"quizgen ({lang})", "toolName": "quizgen"}
    return dialect.file(
        "assessmentTest",
        named,
        *(dialect.outcome(name, "single float", {}) for name in _SUMMED),
        tag("testPart", part, control, sections),
        tag("outcomeProcessing", {}, *(_sum_outcome(name, dialect) for name in _SUMMED)),
    )


def _write_sections(items: list[ExportItem], dialect: Dialect) -> Iterator[Markup]:
    slots = groupby(items, key=lambda item: item.slot)
    for number, (slot, found) in enumerate(slots, 1):
        named = {"identifier": f"slot-{number}", "title": slot, "visible": "false"}
        refs = (_item_reference(item, dialect) for item in found)
        yield dialect.tag(
            "assessmentSection", named, dialect.tag("selection", {"select": 1}), *refs
        )


def _item_reference(item: ExportItem, dialect: Dialect) -> Markup:
    name = item_identifier(item)
    named = {"identifier": name, "href": f"items/{name}.xml", "category": item.question.topic}
    return dialect.tag("assessmentItemRef", named)


def _sum_outcome(name: str, dialect: Dialect) -> Markup:
    values = dialect.tag("testVariables", {"variableIdentifier": name})
    total = dialect.tag("sum", {}, values)
    return dialect.tag("setOutcomeValue", {"identifier": name}, total)
