"""What is wrong with the files of a bank that belong to no template, and between templates."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from quizgen.bank.bank import LOCALE, PROSE, Bank
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.errors import QuizgenError
from quizgen.core.positions import TEXT
from quizgen.lint.leaks import QuestionContent, find_bank_leaks
from quizgen.locale import check_translations
from quizgen.paper.blueprint import load_blueprint

# A sentence is quoted by its first letters: further on it may hold values, which the file has not.
QUOTED = 30


def check_bank_files(bank: Bank) -> Iterator[Diagnostic]:
    """Yield what is wrong in ``bank.toml``, the curriculum, blueprints, units and words.

    Each file is read by itself, so that one that cannot be read does not hide the others.
    """
    looks: list[Callable[[], object]] = [
        lambda: (bank.metadata, bank.template_paths),
        lambda: bank.curriculum.inventory,
        lambda: bank.quantities,
        *(partial(load_blueprint, name, bank) for name in bank.blueprints),
    ]
    for look in looks:
        try:
            look()
        except QuizgenError as error:
            yield error.diagnostic(bank.folder / "bank.toml")
    yield from check_translations(bank.folder / LOCALE)
    try:
        yield from find_missing_files(bank)
    except QuizgenError as error:
        yield error.diagnostic(bank.folder / "bank.toml")


def find_missing_files(bank: Bank) -> Iterator[Diagnostic]:
    """Yield prose without ``template.toml``, topics without a template, and an empty bank."""
    if not bank.template_paths:
        yield diagnose("QG501", bank.folder / "bank.toml", "the bank has no template")
        return
    # Words of a question that nobody would ever see: its rules are missing, or misspelt.
    pages = [page for page in bank.folder.glob("*/*/*.md") if PROSE.fullmatch(page.name)]
    for folder in sorted({page.parent for page in pages}):
        file = folder / "template.toml"
        if not file.exists():
            yield diagnose("QG502", file, "there is no template.toml beside the words")
    yield from _find_empty_topics(bank)


def _find_empty_topics(bank: Bank) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each topic of ``bank.toml`` that no template has."""
    try:
        held = {bank.rules(name).topic for name in bank.template_paths}
    except QuizgenError:  # the template is told of by itself
        return
    for topic in bank.metadata.topics:
        if topic not in held:
            file, place = bank.folder / "bank.toml", ("topics", topic)
            yield diagnose("QG503", file, f"topic {topic!r} has no template", place)


def check_leaks(bank: Bank, questions: Sequence[QuestionContent]) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each question that gives away the answer of another one."""
    for leak, lang in find_bank_leaks(bank, questions).items():
        if "QG218" in bank.rules(leak.teller).ignore:
            continue
        part = f" in part {leak.label}" if leak.label else ""
        what = f"tells what {leak.asker!r} asks{part}: {leak.what}"
        file = bank.template_paths[leak.teller] / f"{lang}.md"
        yield diagnose("QG218", file, what, (TEXT, leak.text[:QUOTED]))
