"""A paper's code: blueprint, seed, languages and a digest of the files behind it.

``mock-1234-both-0a1b2c`` is all that is needed to make the same bytes again; the digest tells
whether templates, solvers, blueprint or engine are still those that the paper was made with.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeAlias

import msgspec

from quizgen.bank.levels import CHOICES, EXAM
from quizgen.core.errors import InvalidChoiceError, PaperCodeError
from quizgen.locale import BOTH
from quizgen.locale.custom import TAG

if TYPE_CHECKING:
    from quizgen.bank.template import Template

DigestedQuestion: TypeAlias = tuple[str, str, str, list[tuple[str, str]]]
"""Number, template and variant of a question; its parts with their points."""

ENGINE = "1"
"""Rises when the same code would give another paper; part of every digest."""
REFERENCE = "reference"
"""Stands for the seed in the code of a paper with the numbers of the notes."""
LARGEST_SEED = 10**9
DIGEST_LENGTH = 6

GRADED, SIGNS, GROUPS, GROUP = "G", "0123456789ABCDEFGHJKMNPQRSTVWXYZ", 4, 4
"""What a graded paper's code begins with, and its signs: groups of them, none like another."""
_GRADED = re.compile(rf"{GRADED}(-[{SIGNS}]{{{GROUP}}}){{{GROUPS}}}", re.IGNORECASE)

_LEVELS = "|".join(level for level in CHOICES if level != EXAM)
_CODE = re.compile(
    rf"(.+)-(\d{{1,10}}|{REFERENCE})-({TAG}|{BOTH})(?:-({_LEVELS}))?-([0-9a-f]{{{DIGEST_LENGTH}}})"
)


class PaperCode(msgspec.Struct, frozen=True):
    """The fields of a paper's code; its text is what is printed.

    Parameters
    ----------
    blueprint : str
        Name of the blueprint.
    seed : str
        Digits, or ``reference``.
    choice : str
        A language, or ``both``.
    digest : str
        Of the files behind the paper.
    level : str
        What its questions are asked at; that of the exam is not printed.
    """

    blueprint: str
    seed: str
    choice: str
    digest: str = ""
    level: str = EXAM

    def __str__(self) -> str:
        """Return the code as it is printed; the level of an exam is not written."""
        level = "" if self.level == EXAM else f"-{self.level}"
        return f"{self.blueprint}-{self.seed}-{self.choice}{level}-{self.digest}"

    @property
    def is_reference(self) -> bool:
        """Return whether the paper has the numbers printed in the notes."""
        return self.seed == REFERENCE


def is_class_code(text: str) -> bool:
    """Return whether a code is one of a class: it leads to a student, not to questions."""
    return _GRADED.fullmatch(text.strip()) is not None


def parse_code(text: str) -> PaperCode:
    """Return the fields of a paper's code.

    Raises
    ------
    PaperCodeError
        If it is not a code, or that of a graded paper.
    """
    if is_class_code(text):
        raise PaperCodeError(
            f"{text!r} is the code of a graded paper: it says whose paper it is and leads to no "
            "questions; those follow from the secret in the class's folder (quizgen class code)"
        )
    match = _CODE.fullmatch(text.strip())
    if match is None:
        raise PaperCodeError(f"{text!r} is not a paper's code (like mock-1234-en-0a1b2c)")
    blueprint, seed, choice, level, digest = match.groups()
    return PaperCode(blueprint, seed, choice, digest, level or EXAM)


def check_seed(seed: int) -> int:
    """Return a seed that a code can hold.

    Raises
    ------
    InvalidChoiceError
        If it is no whole number, or too small or too large.
    """
    if isinstance(seed, int) and not isinstance(seed, bool) and 0 <= seed <= LARGEST_SEED:
        return seed
    raise InvalidChoiceError(f"seed: {seed!r} (allowed: whole numbers from 0 to {LARGEST_SEED})")


def content_digest(code: str, questions: Iterable[DigestedQuestion]) -> str:
    """Return the digest of what a paper asks and marks."""
    lines = [
        f"{number}|{template}|{identity}|" + ",".join(f"{part}={worth}" for part, worth in parts)
        for number, template, identity, parts in questions
    ]
    return hashlib.sha256("\n".join([code, *lines]).encode()).hexdigest()[:16]


def source_digest(source: str, templates: Iterable[Template], levels: Iterable[str]) -> str:
    """Return the digest of engine, blueprint, and the files of the templates in a paper.

    Parameters
    ----------
    source : str
        Text of the blueprint.
    templates : iterable of Template
    levels : iterable of str
        At which each of them is asked: those made from the chain name its quantities.
    """
    total = hashlib.sha256(f"{ENGINE}\n{source}".encode())
    for template, level in zip(templates, levels, strict=True):
        names = "" if level == EXAM else f":{level}:{template.quantities.digest}"
        total.update(f"{template.id}:{template.digest}{names}\n".encode())
    return total.hexdigest()[:DIGEST_LENGTH]
