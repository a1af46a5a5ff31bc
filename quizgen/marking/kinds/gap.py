"""Kind ``gap``: words; the nearest of all known terms decides, not a similarity threshold."""

from __future__ import annotations

import re
from fractions import Fraction

import msgspec

from quizgen.locale import FIRST, in_letters_of, known
from quizgen.marking.echo import safe
from quizgen.marking.judging.wording import fold, nearest_terms
from quizgen.marking.options import Options
from quizgen.marking.reading.rewrites import Source, refuse_invisible
from quizgen.marking.specs import Worded
from quizgen.marking.verdict import Verdict, ambiguous, correct, shared, unreadable, wrong
from quizgen.maths.notation import ReadError


class Spec(Worded, kw_only=True, frozen=True):
    """Gap: ``accept`` = synonyms per gap; ``among`` = the topic's other terms.

    The first synonym of a gap is the one shown. A single gap may be given as a plain list.
    """

    accept: list[list[str] | str]
    among: list[str] = msgspec.field(default_factory=list)

    def gaps(self) -> list[list[str]]:
        """Synonyms per gap."""
        if all(isinstance(gap, str) for gap in self.accept):
            return [[str(word) for word in self.accept]]
        return [[gap] if isinstance(gap, str) else gap for gap in self.accept]

    def validate(self) -> None:
        """Every gap needs a word."""
        if not self.accept or not all(self.gaps()):
            raise ValueError("accept needs at least one word per gap")

    def judge(self, typed: str, _options: Options, /) -> Verdict:
        """Judge typed words, one per gap."""
        gaps = self.gaps()
        words = _words(typed, len(gaps))
        if len(words) != len(gaps):
            raise ReadError("item-count", 1, str(len(words)), [str(len(gaps))])
        cells = [_one(self, gap, word) for gap, word in zip(gaps, words, strict=True)]
        read_as = "; ".join(cell.read_as for cell in cells)
        stopped = next((cell for cell in cells if cell.verdict == "ambiguous"), None)
        if stopped is not None:
            return ambiguous(stopped.note, read_as, **stopped.fields)
        if len(cells) == 1:
            return cells[0]
        return _together(cells, read_as)

    def show(self) -> str:
        """Return the words as printed in the first language."""
        return self.show_in(FIRST)

    def show_in(self, lang: str, /) -> str:
        """Return the words as printed: each in the language's letters if it has such a synonym."""
        return "; ".join(_shown(gap, lang) for gap in self.gaps())


_JOINERS = "\u200c\u200d"
_STRONG = re.compile(r"[;\n|]")
_WEAK = re.compile(r"[;\n|,/]|\s→\s")
_NUMBERED = re.compile(r"^\s*(?:\(?\d{1,2}[).:]|[a-hA-H][).:])\s*")


def _words(typed: str, count: int) -> list[str]:
    if len(typed) > 1000:
        raise ReadError("too-long", 1001, "1000")
    if not typed.strip():
        raise ReadError("no-answer", 1)
    refuse_invisible(Source.of(typed.strip("\u200e\u200f\ufeff \r\n")), "\r\n\t" + _JOINERS)
    if count == 1:
        return [_NUMBERED.sub("", typed).strip()]
    for separator in (_STRONG, _WEAK, re.compile(r"\s+")):
        pieces = [piece.strip() for piece in separator.split(typed.strip())]
        while pieces and not pieces[-1]:
            pieces.pop()
        if len(pieces) == count:
            break
    return [_NUMBERED.sub("", piece) for piece in pieces]


def _one(spec: Spec, gap: list[str], word: str) -> Verdict:
    """Judge one gap: the word itself, or the known term it is nearest to."""
    right = {fold(term) for term in gap}
    if not fold(word):
        return wrong("", "gap-empty") if not word else unreadable("no-answer")
    if fold(word) in right:
        return correct(safe(" ".join(word.split())))
    others = [o for g in spec.gaps() for o in g if fold(o) not in right] + spec.among
    if fold(word) in {fold(term) for term in others}:
        return wrong(safe(word), "other-term")
    near, _ = nearest_terms(word, [*gap, *others])
    hits = {fold(term) in right for term in near}
    if hits == {True}:
        return correct(safe(near[0]), "spelling", typed=word)
    if hits == {True, False}:
        return ambiguous("which-term", safe(word), terms=tuple(near))
    return wrong(safe(near[0] if near else word), "other-term" if near else "unknown-term")


def _together(cells: list[Verdict], read_as: str) -> Verdict:
    credit = sum((cell.credit for cell in cells), Fraction(0)) / len(cells)
    missed = tuple(str(i + 1) for i, cell in enumerate(cells) if cell.credit < 1)
    verdict = shared(credit, read_as, "gaps", names=missed)
    if credit == 1 and any(cell.note == "spelling" for cell in cells):
        return correct(read_as, "spelling", typed="")
    return verdict


def _shown(gap: list[str], lang: str) -> str:
    return next((word for word in gap if in_letters_of(known(lang), word)), gap[0])
