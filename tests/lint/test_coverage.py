"""The curriculum is covered, and nothing is claimed that it does not have."""

from __future__ import annotations

import re

from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.lint.coverage import curriculum_coverage, verb_coverage


def test_the_inventory_counts_what_the_curriculum_counts(bank):
    counts = {group: len(items) for group, items in bank.curriculum.inventory.items()}
    assert counts == {
        "formulas": 46, "worked examples": 18, "trial exam": 6, "mock questions": 51,
        "sections": 24, "figures": 9, "code": 28, "traps": 28, "statements": 3,
    }  # fmt: skip


def test_no_template_claims_what_is_not_there(bank):
    """A whole question (C12, Q1c) is known by its sub-parts (C12a, Q1c-i)."""
    items = [item for group in bank.curriculum.inventory.values() for item in group]
    known = {*items, *(re.sub(r"(?<=\d)[a-z]$|-.*$", "", item) for item in items)}
    claims = {item for name in bank.template_paths for item in bank.rules(name).covers} - known
    assert {re.sub(r"\d+$", "", item) for item in claims} <= {*bank.curriculum.beyond}


@together("group", list(builtin_bank().curriculum.inventory))
def test_nothing_is_left_out(bank, group):
    (row,) = [row for row in curriculum_coverage(bank) if row.group == group]
    assert row.holes == ()


def test_what_asks_for_words_is_asked_in_words(bank):
    """Each verb of the curriculum is of an item that there is, and so is each of a template."""
    items = {item for group in bank.curriculum.inventory.values() for item in group}
    verbs = bank.curriculum.verbs
    assert {item for listed in verbs.values() for item in listed} <= items
    asked = {pair for name in bank.template_paths for pair in bank.rules(name).verbs.items()}
    assert asked <= {(item, verb) for verb, listed in verbs.items() for item in listed}
    rows = {row.group: row for row in verb_coverage(bank)}
    assert rows["justify"].holes == rows["compare"].holes == ()
