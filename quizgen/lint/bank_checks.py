"""What a bank lacks although its folder or ``bank.toml`` promises it."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.bank.bank import PROSE, Bank
from quizgen.core.errors import QuizgenError


def find_missing_files(bank: Bank) -> Iterator[str]:
    """Questions without rules, topics without a question, and a bank that has none at all."""
    if not bank.template_paths:
        yield f"{bank.folder}: the bank has no template"
        return
    yield from _without_rules(bank)
    yield from _without_templates(bank)


def _without_rules(bank: Bank) -> Iterator[str]:
    """Words of a question that nobody would ever see: its rules are missing, or misspelt."""
    pages = [page for page in bank.folder.glob("*/*/*.md") if PROSE.fullmatch(page.name)]
    for folder in sorted({page.parent for page in pages}):
        if not (folder / "template.toml").exists():
            yield f"{folder}/template.toml: there is no template.toml beside the words"


def _without_templates(bank: Bank) -> Iterator[str]:
    """Topics of ``bank.toml`` that no paper can be made of."""
    try:
        held = {bank.rules(name).topic for name in bank.template_paths}
    except QuizgenError:  # the template is told of by itself
        return
    for topic in bank.metadata.topics:
        if topic not in held:
            yield f"{bank.folder}/bank.toml: topic {topic!r} has no template"
