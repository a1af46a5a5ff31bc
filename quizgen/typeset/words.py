"""The words in and around formulas; each language fills one ``Words`` table to be read aloud."""

from __future__ import annotations

from dataclasses import dataclass

TEXTS = {
    "en": {
        "if": "if {}",
        "otherwise": "otherwise",
        "and": "and",
        "or": "or",
        "not": "not",
    },
    "bn": {
        "if": "যদি {} হয়",
        "otherwise": "অন্যথায়",
        "and": "এবং",
        "or": "অথবা",
        "not": "সত্য নয়:",
    },
}
"""Words printed inside formulas."""


@dataclass(frozen=True)
class Words:
    """How one language reads a formula aloud. Braces mark where the parts go."""

    letters: dict[str, str]
    capital: str
    greek: dict[str, str]
    names: dict[str, str]
    operators: dict[str, str]
    brackets: dict[str, str]
    intervals: dict[str, str]
    functions: dict[str, tuple[str, str]]
    accents: dict[str, str]
    signs: dict[str, tuple[str, str, str, str]]
    powers: dict[str, str]
    short: dict[str, str]
    long: dict[str, str]
    prefixes: dict[str, str]
    units: dict[str, tuple[str, str]]
    unit_joints: dict[str, str]
