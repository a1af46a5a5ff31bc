"""Each template of the bank teaches: answers that vary, reasons for what may be ticked, mistakes."""

from __future__ import annotations

import pytest
from sweep import draws, together

from quizgen.bank.bank import builtin_bank
from quizgen.lint.item_quality import review_template

NAMES = list(builtin_bank().template_paths)


def errors(template, seeds):
    return [str(one) for one in review_template(template, seeds) if one.level == "error"]


@together("name", NAMES[::12])
def test_it_teaches(bank, name):
    assert errors(bank.template(name), 200) == []


@pytest.mark.slow
@together("name", NAMES)
def test_it_teaches_in_many_draws(bank, name):
    assert errors(bank.template(name), draws(60, full=1000)) == []
