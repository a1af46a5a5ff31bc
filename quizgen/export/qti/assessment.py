"""A test: a section for each slot, from which one variant is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from markupsafe import Markup

from quizgen.export.items import Item
from quizgen.export.qti.dialect import Dialect
from quizgen.export.qti.item import name_of

_ALL = ("SCORE", "MAXSCORE")
"""Outcomes of items whose sums are those of the test."""


def assessment(lang: str, items: list[Item], dialect: Dialect) -> bytes:
    """The test of the questions in one language, slot after slot."""
    tag = dialect.tag
    control = tag("itemSessionControl", {"showFeedback": "true", "allowReview": "true"})
    part = {
        "identifier": "part",
        "navigationMode": "nonlinear",
        "submissionMode": "simultaneous",
    }
    sections = Markup("").join(_sections(items, dialect))
    named = {"identifier": f"test-{lang}", "title": f"quizgen ({lang})", "toolName": "quizgen"}
    return dialect.file(
        "assessmentTest",
        named,
        *(dialect.outcome(name, "single float", {}) for name in _ALL),
        tag("testPart", part, control, sections),
        tag("outcomeProcessing", {}, *(_sum(name, dialect) for name in _ALL)),
    )


def _sections(items: list[Item], dialect: Dialect) -> Iterator[Markup]:
    slots = groupby(items, key=lambda item: item.slot)
    for number, (slot, found) in enumerate(slots, 1):
        named = {"identifier": f"slot-{number}", "title": slot, "visible": "false"}
        refs = (_reference(item, dialect) for item in found)
        yield dialect.tag(
            "assessmentSection", named, dialect.tag("selection", {"select": 1}), *refs
        )


def _reference(item: Item, dialect: Dialect) -> Markup:
    name = name_of(item)
    named = {"identifier": name, "href": f"items/{name}.xml", "category": item.question.topic}
    return dialect.tag("assessmentItemRef", named)


def _sum(name: str, dialect: Dialect) -> Markup:
    values = dialect.tag("testVariables", {"variableIdentifier": name})
    total = dialect.tag("sum", {}, values)
    return dialect.tag("setOutcomeValue", {"identifier": name}, total)
