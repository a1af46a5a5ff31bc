"""From printed paper through files to marks: right answers are right, mistakes are named."""

from __future__ import annotations

import json
import re
from itertools import zip_longest
from typing import Any

import pytest
from road import Desk, Printed, all_templates, fields, typed

LANGS = ("en", "bn")
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?")
THOUSANDS = re.compile(r"-?[1-9]\d{0,2}\.\d{3}")
SEEDS = [pytest.param(seed, marks=[pytest.mark.slow] * (seed > 1)) for seed in range(1, 51)]

pytestmark = pytest.mark.parametrize("lang", LANGS)


@pytest.fixture
def desk(bank, tmp_path, lang, seed):
    return Desk(tmp_path, all_templates(bank, seed, lang))


@pytest.mark.parametrize("seed", SEEDS)
def test_printed_answers_typed_as_asked_get_full_marks(desk):
    printed = list(fields(desk.paper))
    assert len(printed) >= 230
    desk.toml({field.id: typed(field, field.answer) for field in printed})
    desk.json({field.id: typed(field, field.answer, side=1) for field in printed})
    desk.csv({field.id: typed(field, field.answer) for field in printed})
    desk.csv({field.id: typed(field, field.answer) for field in printed})
    for found in desk.marks():
        lost = [_told(field, found) for field in printed if found[field.id]["status"] != "correct"]
        assert not lost


@pytest.mark.parametrize("seed", SEEDS)
def test_printed_mistakes_typed_as_asked_are_named(desk):
    printed = list(fields(desk.paper))
    sheets = list(_sheets(printed))
    for sheet in sheets:
        desk.json({field.id: typed(field, value) for field, _, value in sheet})
    unnamed = [
        (name, value, _told(field, found))
        for sheet, found in zip(sheets, desk.marks(), strict=True)
        for field, name, value in sheet
        if found[field.id]["note"] != f"trap:{name}" and not _asked_back(field, found[field.id])
    ]
    assert not unnamed


def _sheets(printed: list[Printed]) -> Any:
    """Forms in which every question holds one mistake, until all mistakes were made."""
    questions: dict[str, list[tuple[Printed, str, str]]] = {}
    for field in printed:
        number = field.id.rstrip("abcdefghijklmnopqrstuvwxyz")
        questions.setdefault(number, []).extend((field, *one) for one in field.mistakes)
    for row in zip_longest(*questions.values()):
        yield [entry for entry in row if entry]


def _asked_back(field: Printed, part: dict[str, Any]) -> bool:
    """Whether a mistake is asked back since it could be the right number: 1.275 where it is 1275."""
    right = NUMBER.findall(field.answer.rsplit(" ≈ ", maxsplit=1)[-1])
    both = zip(NUMBER.findall(part["typed"]), right, strict=False)
    twofold = any(
        THOUSANDS.fullmatch(typed)
        and float(typed.replace(".", "")) == pytest.approx(float(number), rel=0.01)
        for typed, number in both
    )
    return twofold and (part["status"], part["note"]) == ("ambiguous", "two-readings")


def _told(field: Printed, found: dict[str, dict]) -> tuple[str, ...]:
    part = found[field.id]
    return (field.template, field.id, field.hint, part["typed"], part["status"], part["message"])


@pytest.mark.parametrize("seed", [1])
def test_no_order_is_lost_in_a_reader_that_sorts(desk, tmp_path):
    """Objects of JSON have no order; another program may sort them, and nothing may change."""
    printed = list(fields(desk.paper))
    desk.toml({field.id: typed(field, field.answer) for field in printed})
    turned = tmp_path / "turned.json"
    for sign in (1, -1):
        turned.write_text(json.dumps(_sorted(json.loads(desk.key.read_text()), sign)))
        (found,), (before,) = desk.marks(turned), desk.marks()
        assert [name for name in before if found[name] != before[name]] == []


def _sorted(value: Any, sign: int) -> Any:
    if isinstance(value, dict):
        names = sorted(value)[::sign]
        return {name: _sorted(value[name], sign) for name in names}
    return [_sorted(one, sign) for one in value] if isinstance(value, list) else value
