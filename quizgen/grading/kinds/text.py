"""Kind ``text``: key points are looked for and suggested; a person decides, never the program."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache

from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.spelling import allowed_typos, fold_word, typo_distance
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.normalise import LONGEST_PROSE, refuse_invisible
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, ambiguous
from quizgen.maths.notation import FormulaReadError


class Spec(WordSpec, kw_only=True, frozen=True):
    """Text: ``points`` = key points, each a list of words of which one must occur.

    ``points`` may be a table from a point's name to its words. ``needed`` of them (default: all)
    give full marks.
    """

    points: list[list[str] | str] | dict[str, list[str]]
    needed: int | None = None

    def groups(self) -> Mapping[str, list[str]]:
        """Name of each key point and its words."""
        if isinstance(self.points, dict):
            return self.points
        groups = [[group] if isinstance(group, str) else group for group in self.points]
        return {group[0]: group for group in groups if group}

    def validate(self) -> None:
        """Every key point needs a word."""
        if not self.points or len(self.groups()) != len(self.points) or not all(self.points):
            raise ValueError("every key point needs at least one word")

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Suggest which key points a text contains."""
        if len(typed) > LONGEST_PROSE:
            raise FormulaReadError("too-long", LONGEST_PROSE + 1, str(LONGEST_PROSE))
        if not typed.strip():
            raise FormulaReadError("no-answer", 1)
        refuse_invisible(SourceText.of(typed.strip("\u200e\u200f\ufeff")), "\r\n\t\u200c\u200d")
        words = [fold_word(word) for word in _WORD.findall(typed)]
        groups = self.groups()
        found = [name for name, terms in groups.items() if any(_occurs(t, words) for t in terms)]
        missing = [name for name in groups if name not in found]
        note = "self-mark" if found else "self-mark-none"
        return ambiguous(
            note,
            safe_echo(" ".join(typed.split()), 80),
            right=len(found),
            of=self.needed or len(groups),
            found=tuple(found),
            missing=tuple(missing),
        )

    def spots(self, typed: str) -> tuple[tuple[int, int], ...]:
        """Where words of key points stand in a text: first character, and the one behind."""
        found = list(_WORD.finditer(typed))
        folded = [fold_word(match[0]) for match in found]
        terms = [term for group in self.groups().values() for term in group]
        places = {place for term in terms for place in _places(term, folded)}
        return tuple((found[place].start(), found[place].end()) for place in sorted(places))

    def show(self) -> str:
        """Return the key points."""
        return "; ".join(self.groups())


_WORD = re.compile(r"[^\s.,;:!?()\"।/]+")


def _occurs(term: str, words: list[str]) -> bool:
    """Whether a term's words occur in a row, endings and small slips aside."""
    return any(True for _ in _places(term, words))


def _places(term: str, words: list[str]) -> Iterator[int]:
    """Where a term's words occur in a row."""
    wanted = _folded(term)
    for start in range(len(words) - len(wanted) + 1 if wanted else 0):
        if all(_alike(words[start + i], word) for i, word in enumerate(wanted)):
            yield from range(start, start + len(wanted))


@lru_cache(maxsize=4096)
def _folded(term: str) -> tuple[str, ...]:
    """The words of a term, as they are compared."""
    return tuple(fold_word(word) for word in _WORD.findall(term))


@lru_cache(maxsize=8192)
def _alike(word: str, wanted: str) -> bool:
    """Whether a word is the wanted one, one of its forms, or a slip of the fingers."""
    if len(wanted) >= 4 and word.startswith(wanted):
        return True
    allowed = allowed_typos(wanted)
    return word == wanted or typo_distance(word, wanted, allowed) <= allowed
