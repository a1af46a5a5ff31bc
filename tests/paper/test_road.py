"""From printed paper through files to marks: right answers are right, mistakes are named."""

from __future__ import annotations

import json
import re
from itertools import zip_longest
from typing import Any

import pytest
from road import Desk, Printed, all_templates, fields, typed
from sweep import draws

from quizgen.paper.answer_key import write_answer_key

LANGS = ("en", "bn")
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?")
THOUSANDS = re.compile(r"-?[1-9]\d{0,2}\.\d{3}")
SEEDS = [
    pytest.param(seed, marks=[pytest.mark.slow] * (seed > 0)) for seed in range(draws(2, full=50))
]


@pytest.fixture
def desk(bank, tmp_path, seed):
    """Who writes papers of the whole bank; the first one is of every fourth template."""
    return Desk(tmp_path, all_templates(bank, seed, each=1 if seed else 4))


def filled_in(seed: int) -> tuple[str, ...]:
    """The first paper in every language, the others in turn: all of them have the same key."""
    return (LANGS[seed % len(LANGS)],) if seed else LANGS


@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_printed_is_marked_as_it_was_meant(desk, seed):
    """Right answers typed as asked get full marks, known mistakes are named: in every form."""
    papers = {lang: list(fields(desk.paper, lang)) for lang in filled_in(seed)}
    sheets: list[tuple[str, Any]] = []
    for lang, printed in papers.items():
        assert len(printed) >= (230 if seed else 50)
        desk.toml({field.id: typed(field, field.answer) for field in printed})
        desk.json({field.id: typed(field, field.answer, side=1) for field in printed}, lang)
        for _both_separators in range(2):
            desk.csv({field.id: typed(field, field.answer) for field in printed})
        sheets += [("", printed)] * 4
        for sheet in _sheets(printed):
            desk.json({field.id: typed(field, value) for field, _, value in sheet}, lang)
            sheets.append((lang, sheet))
    lost, unnamed = [], []
    for (lang, sheet), found in zip(sheets, desk.marks(), strict=True):
        if lang:
            unnamed += [(one, value, _told(field, found)) for field, one, value in sheet
                        if not _named(field, one, found[field.id])]  # fmt: skip
        else:
            lost += [
                _told(field, found)
                for field in sheet
                if found[field.id]["status"] not in {"correct", "open"}
            ]
    assert not lost
    assert not unnamed


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1])
def test_a_paper_in_one_language_has_the_key_of_all(desk, bank, seed):
    of_all = json.loads(desk.key.read_text())["questions"]
    for lang in LANGS:
        alone = json.loads(write_answer_key(all_templates(bank, seed, lang)))["questions"]
        assert [q["parts"] for q in alone] == [q["parts"] for q in of_all]


def _sheets(printed: list[Printed]) -> Any:
    """Forms in which every question holds one mistake, until all mistakes were made."""
    questions: dict[str, list[tuple[Printed, str, str]]] = {}
    for field in printed:
        number = field.id.rstrip("abcdefghijklmnopqrstuvwxyz")
        questions.setdefault(number, []).extend((field, *one) for one in field.mistakes)
    for row in zip_longest(*questions.values()):
        yield [entry for entry in row if entry]


def _named(field: Printed, mistake: str, part: dict[str, Any]) -> bool:
    by_a_person = part["status"] == "open"
    return by_a_person or part["note"] == f"trap:{mistake}" or _asked_back(field, part)


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


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0])
def test_no_order_is_lost_in_a_reader_that_sorts(desk, tmp_path):
    """Objects of JSON have no order; another program may sort them, and nothing may change."""
    printed = list(fields(desk.paper, LANGS[0]))
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
