"""Questions to export: some of every kind by default, all of them in the slow tests."""

from __future__ import annotations

import pytest

from quizgen.export.items import Item, of_templates
from quizgen.question.compose import compose


@pytest.fixture(scope="session")
def items(bank) -> list[Item]:
    """Some of the bank in each language, not the same one."""
    names = list(bank.paths)
    single = ["imread-missing-file", "luminous-flux-over-bands", "demosaic-at-border"]
    english = of_templates(bank, [*names[::10], *single], 1, 1, ["en"])
    return [*english, *of_templates(bank, names[4::12], 2, 1, ["bn"])]


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
