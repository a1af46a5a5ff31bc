"""Kind ``text``: key points are looked for and suggested; a person decides, never the program."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import lru_cache

from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.spelling import allowed_typos, fold_word, typo_distance
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.normalise import LONGEST_PROSE, refuse_invisible
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, ambiguous
from quizgen.kinds.asking import make_spec
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    FieldProblem,
    InputControl,
    PartContext,
    find_name_problems,
)
from quizgen.locale import translate
from quizgen.maths.notation import FormulaReadError


class AuthoredText(AuthoredAnswer, kw_only=True, tag="text", frozen=True):
    """A sentence or two."""

    points: tuple[str, ...]
    needed: int | None = None

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong with the names of key points."""
        yield from find_name_problems("points", self.points, 0)


class TextSpec(WordSpec, kw_only=True, frozen=True):
    """Text: ``points`` = key points, each a list of words of which one must occur.

    ``points`` may be a table from a point's name to its words. ``needed`` of them (default: all)
    give full marks.
    """

    points: list[list[str] | str] | dict[str, list[str]]
    needed: int | None = None

    def key_points(self) -> Mapping[str, list[str]]:
        """Return the name of each key point and its words."""
        if isinstance(self.points, dict):
            return self.points
        groups = [[group] if isinstance(group, str) else group for group in self.points]
        return {group[0]: group for group in groups if group}

    def validate(self) -> None:
        """Check that every key point has a word.

        Raises
        ------
        ValueError
            If one has none.
        """
        if not self.points or len(self.key_points()) != len(self.points) or not all(self.points):
            raise ValueError("every key point needs at least one word")

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Return which key points a text contains, for a person who decides.

        Raises
        ------
        FormulaReadError
            If it is empty, too long, or holds invisible characters.
        """
        if len(typed) > LONGEST_PROSE:
            raise FormulaReadError("too-long", LONGEST_PROSE + 1, str(LONGEST_PROSE))
        if not typed.strip():
            raise FormulaReadError("no-answer", 1)
        refuse_invisible(SourceText.of(typed.strip("\u200e\u200f\ufeff")), "\r\n\t\u200c\u200d")
        words = [fold_word(word) for word in _WORD.findall(typed)]
        groups = self.key_points()
        found = [name for name, terms in groups.items() if any(_has_term(t, words) for t in terms)]
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

    def keyword_positions(self, typed: str) -> tuple[tuple[int, int], ...]:
        """Return where words of key points stand in a text: first character, and the one behind."""
        found = list(_WORD.finditer(typed))
        folded = [fold_word(match[0]) for match in found]
        terms = [term for group in self.key_points().values() for term in group]
        places = {place for term in terms for place in _iter_term_positions(term, folded)}
        return tuple((found[place].start(), found[place].end()) for place in sorted(places))

    def show(self) -> str:
        """Return the key points."""
        return "; ".join(self.key_points())


_WORD = re.compile(r"[^\s.,;:!?()\"।/]+")


def _has_term(term: str, words: list[str]) -> bool:
    """Return whether a term's words occur in a row, endings and small slips aside."""
    return any(True for _ in _iter_term_positions(term, words))


def _iter_term_positions(term: str, words: list[str]) -> Iterator[int]:
    """Yield the indices of the words in a row that are a term's."""
    wanted = _fold_words(term)
    for start in range(len(words) - len(wanted) + 1 if wanted else 0):
        if all(_is_alike(words[start + i], word) for i, word in enumerate(wanted)):
            yield from range(start, start + len(wanted))


@lru_cache(maxsize=4096)
def _fold_words(term: str) -> tuple[str, ...]:
    """Return the words of a term, as they are compared."""
    return tuple(fold_word(word) for word in _WORD.findall(term))


@lru_cache(maxsize=8192)
def _is_alike(word: str, wanted: str) -> bool:
    """Return whether a word is the wanted one, one of its forms, or a slip of the fingers."""
    if len(wanted) >= 4 and word.startswith(wanted):
        return True
    allowed = allowed_typos(wanted)
    return word == wanted or typo_distance(word, wanted, allowed) <= allowed


def ask(part: PartContext) -> AskedPart[TextSpec]:
    """Return the key points; a model sentence states each."""
    points = part.answer["points"]
    spec = make_spec(TextSpec, part, points={name: part.accepted_words(name) for name in points})
    right = tuple(("points", name) for name in points)
    needed = spec.needed or len(points)
    shares = (Fraction(1, max(needed, 1)),) * len(points)
    return AskedPart(spec, InputControl("lines", lines=4), right=right, shares=shares)


FEW = 2
"""Key points that one or two sentences can hold."""


def input_hints(spec: TextSpec, lang: str) -> tuple[str, ...]:
    """Return the sentence on own words, as short as the key points allow."""
    count = spec.needed or len(spec.points)
    return (
        translate(lang, "ask.text")
        if count <= FEW
        else translate(lang, "ask.text_many").format(n=count),
    )


def explain_key(_spec: TextSpec, _lang: str) -> str:
    """Return nothing: the model sentences state the answer."""
    return ""


KIND = AnswerKind(AuthoredText, TextSpec, ask, input_hints, explain_key, input_hints)
