"""Kind ``gap``: words; the nearest of all known terms decides, not a similarity threshold."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import chain
from typing import ClassVar

import msgspec
from msgspec import structs

from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.spelling import (
    confusable_terms,
    fold_word,
    is_another_word,
    nearest_terms,
)
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.normalise import ANSWER, PICTURES, apply_rewrite, refuse_invisible
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, ambiguous, correct, unreadable, verdict_by_share, wrong
from quizgen.kinds.asking import hint, make_spec
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredPooled,
    InputBox,
    InputControl,
    PartContext,
)
from quizgen.locale import FIRST, fallback_language, is_written_in
from quizgen.maths.notation import FormulaReadError


class AuthoredGap(AuthoredPooled, kw_only=True, tag="gap", frozen=True):
    """Words that are missing in a text."""

    listed = "gaps"
    gaps: tuple[str, ...]
    among: tuple[str, ...] = ()


class GapSpec(WordSpec, kw_only=True, frozen=True):
    """Gap: ``accept`` = synonyms per gap; ``among`` = the topic's other terms.

    ``terms`` are further words of the subject, which are nobody's slip in spelling. The first
    synonym of a gap is the one shown. A single gap may be given as a plain list.
    """

    written_as: ClassVar[AnswerForm] = "word"
    reasons_tell: ClassVar[bool] = True

    accept: list[list[str] | str]
    among: list[str] = msgspec.field(default_factory=list)
    terms: list[str] = msgspec.field(default_factory=list)

    def gaps(self) -> list[list[str]]:
        """Synonyms per gap."""
        if all(isinstance(gap, str) for gap in self.accept):
            return [[str(word) for word in self.accept]]
        return [[gap] if isinstance(gap, str) else gap for gap in self.accept]

    def validate(self) -> None:
        """Every gap needs a word."""
        if not self.accept or not all(self.gaps()):
            raise ValueError("accept needs at least one word per gap")

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Judge typed words, one per gap."""
        gaps = self.gaps()
        words = _digits(typed, gaps) or _words(typed, gaps)
        if len(words) != len(gaps):
            raise FormulaReadError("item-count", 1, str(len(words)), [str(len(gaps))])
        cells = [_one(self, gap, word) for gap, word in zip(gaps, words, strict=True)]
        if len(cells) == 1:
            return self._add_reason(cells[0])
        read_as = "; ".join(cell.read_as for cell in cells)
        stopped = next((cell for cell in cells if not cell.is_graded), None)
        if stopped is not None:
            return structs.replace(stopped, read_as=read_as)
        because = tuple(
            self.reason_key(place, cell.read_as)
            for place, cell in enumerate(cells, 1)
            if cell.credit < 1
        )
        return _together(cells, read_as, because)

    def _add_reason(self, only: Verdict) -> Verdict:
        """The verdict of the only gap, with what a reason can be given for."""
        if only.credit == 1 or not only.is_graded:
            return only
        because = (self.reason_key(1, only.read_as),)
        return structs.replace(only, fields={**only.fields, "because": because})

    def reason_key(self, place: int, word: str) -> str:
        """What a reason can be given for: this word in this gap, else any wrong one in it."""
        label = f"{place}={fold_word(word)}"
        return label if any(label in reasons for reasons in self.why.values()) else str(place)

    def show(self) -> str:
        """Return the words as printed in the first language."""
        return self.show_in(FIRST)

    def show_in(self, lang: str, /) -> str:
        """Return the words as printed: each in the language's letters if it has such a synonym."""
        return "; ".join(_format_gap(gap, lang) for gap in self.gaps())


_JOINERS = "\u200c\u200d"
_SEPARATORS = tuple(
    map(
        re.compile,
        (
            r"[;\n|]",
            r"[;\n|,/]|\s→\s",
            r"\s*(?:[,;&]|\b(?:and|und)\b|\s(?:এবং|ও)\s)\s*",
            r"\s+(?:[-–—→]|->|=>)\s+",
            r"\s+",
            r"[-–]",
        ),
    )
)
_NUMBERED = re.compile(r"^\s*(?:\(?\d{1,2}[).:](?!\d)(?=\s*\S)|[a-hA-H][).:](?=\s*\S))\s*")
_NUMBER = re.compile(
    r"(?:^|(?<=[\s,;(]))\(?"
    r"(?:(\d{1,2}) ?(?:[).:]\)?|=|→|-+>|[-–—](?=\D)|(?=[^\W\d]))|([a-h])[).])\s*"
)
_PAIR = re.compile(r"(?<![-–—\d])(\d{1,2})\s*[-–—]\s*(\d{1,2})(?![-–—\d])")
"""A gap's number and a number as its word, ``1-3``."""
_ENDINGS = ("ly", "e", "er", "en", "es", "em")
LONG = 6
"""Letters of a term that may take an ending."""
_ENDS = " \t\r\n,;"
_QUOTES = "[]{}“”„‘’«»\"'"
_JOINED = re.compile(r"\s(?:and|und|এবং|ও)$")
_MEASURE = re.compile(r"\d+ ?[a-zµ]{2,3}")
_PICTURE = "\N{FRAME WITH PICTURE}"
_PICTURE_IS = re.compile(rf"{_PICTURE} *\d+ *(?:[:=→⇒]|-+>)")
"""Something said of a picture, where its number is what is asked."""
_LABEL = re.compile(r"\s*[^\W\d_]{1,12}\s*[:=]\s*\S")


def _words(typed: str, gaps: list[list[str]]) -> list[str]:
    if len(typed) > 1000:
        raise FormulaReadError("too-long", 1001, "1000")
    if not typed.strip():
        raise FormulaReadError("no-answer", 1)
    refuse_invisible(SourceText.of(typed.strip("\u200e\u200f\ufeff \r\n")), "\r\n\t" + _JOINERS)
    typed = typed.strip()
    if " " in typed or ":" in typed:
        typed = _strip_gap_word(ANSWER.sub("", typed), gaps)
    count = len(gaps)
    if count == 1:
        return [_NUMBERED.sub("", typed).strip(_ENDS + _QUOTES)]
    return _by_number(apply_rewrite("digits", typed), count) or _in_a_row(typed, count)


def _strip_gap_word(typed: str, gaps: list[list[str]]) -> str:
    """``photo 3`` without its word, if each gap takes a number; ``photo 1: 2`` has two readings."""
    if not all(any(word.isdigit() for word in gap) for gap in gaps):
        return typed
    text = apply_rewrite("digits", typed)
    if _PICTURE_IS.search(PICTURES.sub(_PICTURE, text)):
        raise FormulaReadError("words-around", 1, typed)
    return PICTURES.sub(" ", text).strip()


def _digits(typed: str, gaps: list[list[str]]) -> list[str]:
    """The digits of ``324``, if each gap takes a single one."""
    digits = typed.strip()
    single = all(any(len(word) == 1 and word.isdigit() for word in gap) for gap in gaps)
    return list(digits) if single and digits.isdigit() and len(digits) == len(gaps) > 1 else []


def _by_number(typed: str, count: int) -> list[str]:
    """The words behind the gaps' own numbers, ``(1) ... (2) ...``; none without numbers."""
    pairs = dict(_PAIR.findall(typed))
    if {*pairs} == {*map(str, range(1, count + 1))} and not re.search(r"\w", _PAIR.sub("", typed)):
        return [pairs[str(number)] for number in range(1, count + 1)]
    found = list(_NUMBER.finditer(typed))
    marked = [mark for mark in found if not mark[0].strip().isdigit()]
    marks = next((some for some in (marked, found) if _all_once(some, count)), [])
    if not marks or marks[0].start():
        return []
    names = list(map(_gap_number, marks))
    ends = [*(mark.start() for mark in marks[1:]), len(typed)]
    words = {
        name: _JOINED.sub("", typed[mark.end() : end].strip(_ENDS)).strip(_ENDS)
        for name, mark, end in zip(names, marks, ends, strict=True)
    }
    return [words[str(number)] for number in range(1, count + 1)]


def _gap_number(mark: re.Match[str]) -> str:
    return mark[1] or str("abcdefgh".index(mark[2]) + 1)


def _all_once(marks: list[re.Match[str]], count: int) -> bool:
    return sorted(map(_gap_number, marks)) == sorted(map(str, range(1, count + 1)))


def _in_a_row(typed: str, count: int) -> list[str]:
    """The words in the order of the gaps, cut at the strongest separator that fits."""
    pieces = _cut(typed, count)
    if len(pieces) != count and typed.isalpha() and len(typed) == count:
        return list(typed)
    if sum(map(bool, map(_LABEL.match, pieces))) > 1:
        raise FormulaReadError("words-around", 1, typed)
    return [_NUMBERED.sub("", piece).strip(_QUOTES) for piece in pieces]


def _cut(typed: str, count: int) -> list[str]:
    plain = typed.split()
    for separator in _SEPARATORS:
        pieces = [piece.strip() for piece in separator.split(typed)]
        while pieces and not pieces[-1]:
            pieces.pop()
        if len(pieces) == count:
            return pieces
    return plain


def _one(spec: GapSpec, gap: list[str], word: str) -> Verdict:
    """Judge one gap: the word itself, or the known term it is nearest to."""
    right = {fold_word(term) for term in gap}
    folded = fold_word(word)
    if not folded:
        return wrong("", "gap-empty") if not word else unreadable("no-answer")
    if folded in right or _compact(word) in right or _is_inflection(word, right):
        return correct(safe_echo(" ".join(word.split())))
    others = [o for g in spec.gaps() for o in g if fold_word(o) not in right] + spec.among
    if folded in map(fold_word, others):
        return wrong(safe_echo(word), "other-term")
    return _nearest(spec, word, gap, others)


def _nearest(spec: GapSpec, word: str, gap: list[str], others: list[str]) -> Verdict:
    """Judge a word that is no known term by the terms it is nearest to."""
    near, _ = nearest_terms(word, [*gap, *others])
    if not near and _holds_a_term(word, [*gap, *others]):
        return unreadable("words-around", safe_echo(word))
    hits = {term in gap for term in near}
    if hits == {True, False}:
        return ambiguous("which-term", safe_echo(word), terms=tuple(near))
    if hits != {True}:
        return wrong(safe_echo(near[0] if near else word), "other-term" if near else "unknown-term")
    if all(is_another_word(word, term, spec.terms) for term in near):
        return ambiguous("another-word", safe_echo(word))
    return correct(safe_echo(near[0]), "spelling", typed=word)


def _compact(word: str) -> str:
    """``C, M, Y, K`` is CMYK."""
    spelt = re.search(r"[,.·]", word) and not re.search(r"\d", word)
    return fold_word(re.sub(r"[\s,./·-]", "", word)) if spelt else ""


def _is_inflection(word: str, right: set[str]) -> bool:
    """An adverb or an ending of German: ``additively``, ``additive Mischung`` without its noun."""
    whole = fold_word(word)
    return whole.endswith(_ENDINGS) and any(
        whole.endswith(end) and len(whole) - len(end) >= LONG and whole[: -len(end)] in right
        for end in _ENDINGS
    )


def _holds_a_term(word: str, terms: list[str]) -> bool:
    """Whether a known term stands among other words; in another unit a number is wrong."""
    if _MEASURE.fullmatch(word):
        return False
    words = [fold_word(piece) for piece in re.split(r"[\s,;/]+", word) if fold_word(piece)]
    return len(words) > 1 and any(fold_word(term) in words for term in terms)


def _together(cells: list[Verdict], read_as: str, because: tuple[str, ...]) -> Verdict:
    credit = sum((cell.credit for cell in cells), Fraction(0)) / len(cells)
    missed = tuple(str(i + 1) for i, cell in enumerate(cells) if cell.credit < 1)
    verdict = verdict_by_share(credit, read_as, "gaps", names=missed, because=because)
    if credit == 1 and any(cell.note == "spelling" for cell in cells):
        slips = [str(cell.fields["typed"]) for cell in cells if cell.note == "spelling"]
        return correct(read_as, "spelling", typed=", ".join(slips))
    return verdict


def _format_gap(gap: list[str], lang: str) -> str:
    if not any(letter.isalpha() for letter in gap[0]):
        return gap[0]
    return next((word for word in gap if is_written_in(fallback_language(lang), word)), gap[0])


def ask(part: PartContext) -> AskedPart[GapSpec]:
    """The words of every gap, of all languages; of a pool also the sentences around them."""
    gaps = part.selection()[0]
    words = [part.words.get(name, name) for name in gaps]
    known = part.reason_names()
    told = [name if name in known else term for name, term in zip(gaps, words, strict=True)]
    wrong = list(_wrong_words(part, gaps, words))
    among = [*part.answer.get("among", ()), *(term for _, _, terms in wrong for term in terms)]
    named = [(str(place), name) for place, name in enumerate(told, 1)]
    slips = [(f"{mark}={fold_word(term)}", name) for mark, name, terms in wrong for term in terms]
    accept = [part.accepted_words(name) for name in words]
    spec = make_spec(
        GapSpec,
        part,
        accept=accept,
        among=list(dict.fromkeys(among)),
        terms=confusable_terms(part.terms, chain(*accept)),
        why=part.reasons([*named, *slips]),
    )
    return AskedPart(
        spec,
        InputControl("gaps", boxes=tuple(InputBox("") for _ in gaps) if len(gaps) > 1 else ()),
        statements=tuple(("options", name) for name in gaps) if "take" in part.answer else (),
        right=tuple(("reasons", name) for _, name in part.with_reason(named)),
        reasons=tuple((f"({mark}) {terms[0]}", name) for mark, name, terms in wrong),
    )


def _wrong_words(
    part: PartContext, gaps: Sequence[str], words: Sequence[str]
) -> Iterator[tuple[str, str, list[str]]]:
    """Number of a gap, ``gap = word`` as the reasons name it, and how the word may be typed."""
    for place, (gap, right) in enumerate(zip(gaps, words, strict=True), 1):
        for name in part.reason_names():
            first, equals, term = name.partition(" = ")
            if equals and first in {gap, right} and term != right:
                # Another gap's word comes with its synonyms.
                yield str(place), name, part.accepted_words(term) if part.has_gap(term) else [term]


KIND = AnswerKind(AuthoredGap, GapSpec, ask, hint("ask.gap"))
