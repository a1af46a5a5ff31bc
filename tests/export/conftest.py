"""Questions to export: some of every kind by default, all of them in the slow tests."""

from __future__ import annotations

from collections import defaultdict

import pytest

from quizgen.export.items import Item, of_templates
from quizgen.question.compose import compose


def some(bank, count: slice) -> list[str]:
    """A few templates of every kind."""
    by_kind = defaultdict(list)
    for name in bank.paths:
        for part in bank.rules(name).part:
            by_kind[part.answer["kind"]].append(name)
    return list(dict.fromkeys(name for names in by_kind.values() for name in names[count]))


@pytest.fixture(scope="session")
def items(bank) -> list[Item]:
    """The first templates of every kind in English, the last ones in Bangla."""
    single = ["imread-missing-file", "luminous-flux-over-bands", "demosaic-at-border"]
    names = dict.fromkeys([*some(bank, slice(2)), *single])
    english = of_templates(bank, list(names), 1, 1, ["en"])
    return [*english, *of_templates(bank, some(bank, slice(-1, None)), 2, 1, ["bn"])]


@pytest.fixture(scope="session")
def everything(bank) -> list[Item]:
    """The whole bank, five times in two languages."""
    return list(of_templates(bank, list(bank.paths), 0, 5, ["en", "bn"]))


@pytest.fixture(scope="session")
def reference(bank):
    """A question with the numbers of the notes."""

    def made(name: str, lang: str = "en") -> Item:
        question, key = compose(bank.template(name), "reference", lang)
        return Item(f"{name}.reference.{lang}", name, question, key)

    return made
