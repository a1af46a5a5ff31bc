"""Which templates of a bank cannot be asked at all, so that the others still can."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.combined import CombinedBank
from quizgen.bank.discovery import python_digest
from quizgen.core.cache import compute_digest, read_cached, write_cached
from quizgen.core.errors import BankError, QuizgenError
from quizgen.question.compose import compose_question

_KIND = "sound-templates"
"""What the cache keeps them under: a picture takes too long to be drawn at each command."""
UNTRUSTED = "QG128"


def find_broken_templates(bank: Bank) -> dict[str, QuizgenError]:
    """Return what is wrong with each template that cannot be read or asked once, by name.

    Python that may not run breaks nothing: whoever asks such a question is told to trust it.
    """
    python = python_digest(bank.root).encode()
    found: dict[str, QuizgenError] = {}
    for name in bank.template_paths:
        try:
            _ask_once(bank, name, python)
        except QuizgenError as error:
            if error.rule != UNTRUSTED:
                found[name] = error
    return found


def _ask_once(bank: Bank, name: str, python: bytes) -> None:
    """Compose one question of a template, unless the same files have been found sound before.

    Raises ``QuizgenError`` if that cannot be done.
    """
    template = bank.template(name)
    key = compute_digest(template.digest.encode(), python, version("quizgen").encode())
    if not template.languages:
        raise BankError(
            "it has no words: no en.md or such beside it", rule="QG210", file=template.file
        )
    if read_cached(_KIND, key) is None:
        compose_question(template, lang=template.languages[0])
        write_cached(_KIND, key, b"sound")


def leave_out_broken(bank: Bank) -> tuple[Bank, Mapping[str, QuizgenError]]:
    """Return a bank without its broken templates, and what is wrong with each of them.

    The built-in bank is taken as it is: its own tests prove it.
    """
    parts: list[Bank] = []
    broken: dict[str, QuizgenError] = {}
    for part in bank.members:
        found = {} if part is builtin_bank() else find_broken_templates(part)
        parts.append(part.without(found) if found else part)
        broken |= found
    if not broken:
        return bank, broken
    return (CombinedBank(tuple(parts)) if len(parts) > 1 else parts[0]), broken
