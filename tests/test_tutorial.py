"""The tutorial: ten questions of two subjects, each as it stands on the page.

``test_docs.py`` follows the page from top to bottom, as all others: lint, papers, cards.
"""

from __future__ import annotations

import re
from collections import Counter

import consoles
import pytest

from quizgen.bank.bank import Bank
from quizgen.lint.broken_templates import find_broken_templates

PAGE = consoles.ROOT / "docs" / "tutorial.md"
LISTING = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tutorial")
    for step in consoles.steps(PAGE):
        if step.file:
            consoles.save(step, folder)
    return Bank(folder / "starter" / "bank_of_starter", trusted=True)


def test_five_questions_of_each_subject_can_be_asked(bank):
    assert find_broken_templates(bank) == {}
    topics = Counter(bank.rules(name).topic for name in bank.template_paths)
    assert topics == {"statistics": 5, "circuits": 5}


def test_each_question_has_a_section_of_its_own(bank):
    headings = re.findall(r"^## (\w+/[\w-]+):", PAGE.read_text("utf-8"), re.MULTILINE)
    assert sorted(headings) == sorted(
        f"{bank.rules(name).topic}/{name}" for name in bank.template_paths
    )


def test_it_is_short_and_claims_no_time_that_nobody_measured():
    text = PAGE.read_text("utf-8")
    assert len(LISTING.sub("", text).split()) <= 800
    assert len(text.split()) <= 2800
    assert "measured by an outsider" in " ".join(text.split())
