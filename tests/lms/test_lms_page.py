"""The table of docs/export.md is what becomes of every kind of answer in the bank."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import pytest

from quizgen.kinds import KINDS
from quizgen.lms.interactions import _interactions_of
from quizgen.lms.items import ExportItem, manual_parts
from quizgen.question.compose import compose_question

PAGE = Path(__file__).parents[2] / "docs" / "export.md"


@pytest.fixture(scope="module")
def plain(bank) -> list[ExportItem]:
    """Every template once, without its figures."""
    return [
        ExportItem(
            f"{name}.1.en", name, *compose_question(bank.template(name), 1, "en", figures=False)
        )
        for name in bank.template_paths
    ]


def row(items: list[ExportItem], kind: str) -> str:
    """What becomes of a kind: it is marked, an essay for a person, or some of both."""
    reasons, marked = set(), False
    for item in items:
        why = dict(manual_parts(item))
        for part, spec in zip(item.question.parts, item.key.specs, strict=True):
            if spec.kind == kind:
                marked |= part.field.id not in why
                reasons |= {why.get(part.field.id, "")} - {""}
    if not reasons:
        return "marked"
    told = ", ".join(sorted(reasons - {kind}))
    return (f"marked, some essay ({told})" if marked else f"essay ({told})").replace(" ()", "")


def test_the_table_of_the_page(plain):
    found = defaultdict(list)
    for item in plain:
        for kind in {spec.kind for spec in item.key.specs}:
            found[kind].append(item)
    lines = [f"| `{kind}` | {row(found[kind], kind)} |" for kind in sorted(found)]
    text = PAGE.read_text(encoding="utf-8")
    assert "\n".join(lines) in text, "\n".join(lines)


def test_kinds_that_the_bank_does_not_ask_for_are_named_as_essays(plain):
    asked = {spec.kind for item in plain for spec in item.key.specs}
    essay = _interactions_of.registry[object]
    others = [
        name
        for name in sorted(KINDS)
        if name not in asked and _interactions_of.dispatch(KINDS[name].spec) is essay
    ]
    *names, last = (f"`{name}`" for name in others)
    assert f"So are {', '.join(names)} and {last}," in PAGE.read_text(encoding="utf-8")
