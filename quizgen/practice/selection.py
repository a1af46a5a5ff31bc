"""Which questions fit, and those of a seed: every template once, before one returns."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from quizgen.bank.bank import Bank
from quizgen.practice.session_state import PracticeRequest


def matching_templates(bank: Bank, wish: PracticeRequest) -> tuple[str, ...]:
    """Return the names of the templates that have the topic, tier and language requested."""
    return tuple(
        name for name in bank.template_paths
        if wish.topic in (None, bank.rules(name).topic)
        and wish.tier in (None, bank.rules(name).tier)
        and wish.lang in bank.template_languages(name)
    )  # fmt: skip


def template_at(bank: Bank, names: Sequence[str], seed: str, number: int) -> str:
    """Return the template of question ``number`` (from 1) of a session.

    In each round every template comes once, in an order that the seed decides.
    """
    cycle, index = divmod(number - 1, len(names))

    def rank(name: str) -> bytes:
        """Return the key that orders templates within a round."""
        return hashlib.sha256(f"practice/{seed}/{cycle}/{bank.origin(name)}".encode()).digest()

    return sorted(names, key=rank)[index]


def question_seed(seed: str, number: int) -> str:
    """Return the seed of question ``number`` (from 1) of a session: 8 hexadecimal digits."""
    return hashlib.sha256(f"{seed}/{number}".encode()).hexdigest()[:8]
