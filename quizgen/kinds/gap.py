"""Kind ``gap``: words; the nearest of all known terms decides, not a similarity threshold."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from itertools import chain
from typing import ClassVar

import msgspec
from flint import fmpq
from msgspec import structs

from quizgen.core.errors import FormulaError
from quizgen.grading.echo import safe_echo
from quizgen.grading.judging.spelling import (
    confusable_terms,
    find_translation,
    fold_word,
    is_another_word,
    nearest_terms,
)
from quizgen.grading.judging.wordings import find_wording_in, says_whole
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import (
    AnswerForm,
    casts_doubt,
    is_denied,
    says_otherwise,
)
from quizgen.grading.reading.normalise import ANSWER, PICTURES, apply_rewrite, refuse_invisible
from quizgen.grading.reading.number_words import list_number_words
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import read_unit
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, ambiguous, correct, unreadable, verdict_by_share, wrong
from quizgen.kinds.asking import make_spec
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredPooled,
    InputBox,
    InputControl,
    PartContext,
)
from quizgen.kinds.work import count_listed
from quizgen.locale import (
    FIRST,
    fallback_language,
    is_written_in,
    list_languages,
    load_words,
    translate,
)
from quizgen.locale.word_patterns import WordPattern, list_words
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.units import Dimension
from quizgen.maths.values import Value


class AuthoredGap(AuthoredPooled, kw_only=True, tag="gap", frozen=True):
    """Words that are missing in a text."""

    listed = "gaps"
    gaps: tuple[str, ...]
    among: tuple[str, ...] = ()


class GapSpec(WordSpec, kw_only=True, frozen=True):
    """Gap: ``accept`` = synonyms per gap; ``among`` = the topic's other terms.

    ``names`` are what the question calls the gaps, in each language: ``V: picture 4``.
    ``terms`` are further words of the subject, which are nobody's slip in spelling. The first
    synonym of a gap is the one shown. A single gap may be given as a plain list.
    """

    written_as: ClassVar[AnswerForm] = "word"

    accept: list[list[str] | str]
    among: list[str] = msgspec.field(default_factory=list)
    terms: list[str] = msgspec.field(default_factory=list)
    names: list[list[str]] = msgspec.field(default_factory=list)

    def gaps(self) -> list[list[str]]:
        """Return the synonyms of each gap."""
        if all(isinstance(gap, str) for gap in self.accept):
            return [[str(word) for word in self.accept]]
        return [[gap] if isinstance(gap, str) else gap for gap in self.accept]

    def validate(self) -> None:
        """Check that every gap has a word.

        Raises
        ------
        ValueError
            If one has none.
        """
        if not self.accept or not all(self.gaps()):
            raise ValueError("accept needs at least one word per gap")

    def judge(self, typed: str, _options: GradingOptions, /) -> Verdict:
        """Return the verdict on typed words, one per gap.

        Raises
        ------
        FormulaReadError
            If there are not as many words as gaps, or nothing at all.
        """
        gaps = self.gaps()
        words = (
            _split_digits(typed, gaps) or _split_by_name(self, typed) or _read_words(typed, gaps)
        )
        if len(words) != len(gaps):
            raise FormulaReadError("item-count", 1, str(len(words)), [str(len(gaps))])
        cells = [_judge_gap(self, gap, word) for gap, word in zip(gaps, words, strict=True)]
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
        return _combine_gap_verdicts(cells, read_as, because)

    def _add_reason(self, only: Verdict) -> Verdict:
        """Return the verdict of the only gap, with what a reason can be given for."""
        if only.credit == 1 or not only.is_graded:
            return only
        because = (self.reason_key(1, only.read_as),)
        return structs.replace(only, fields={**only.fields, "because": because})

    def reason_key(self, place: int, word: str) -> str:
        """Return the label of a reason: for this word in this gap, else for any wrong one in it."""
        label = f"{place}={fold_word(word)}"
        return label if any(label in reasons for reasons in self.why.values()) else str(place)

    def tells(self, _label: str, _reason: str, /) -> bool:
        """Return that a reason holds the word that is missing."""
        return True

    def show(self) -> str:
        """Return the words as printed in the first language."""
        return self.show_in(FIRST)

    def show_in(self, lang: str, /) -> str:
        """Return the words as printed: each in the language's letters if it has such a synonym."""
        return "; ".join(_format_gap(gap, lang) for gap in self.gaps())


_JOINERS = "\u200c\u200d"
_SEPARATORS = tuple(
    map(
        WordPattern,
        (
            r"[;\n|]",
            r"[;\n|,/]|\s→\s",
            r"\s*(?:[,;&]|\s«and»\s)\s*",
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
LONG = 6
"""Letters of a term that may take an ending."""
_ENDS = " \t\r\n,;="
_GAS_AND_SOLID = dict.fromkeys(map(ord, "↑↓"))
"""Signs behind a substance that leaves a solution; no term has them."""
_QUOTES = "[]{}“”„‘’«»\"'"
_JOINED = WordPattern(r"\s«and»$")
_MEASURE = re.compile(r"\d+ ?[a-zµ]{2,3}")
_PICTURE = "\N{FRAME WITH PICTURE}"
_PICTURE_IS = re.compile(rf"{_PICTURE} *\d+ *(?:[:=→⇒]|-+>)")
"""Something said of a picture, where its number is what is asked."""
_LABEL = re.compile(r"\s*[^\W\d_]{1,12}\s*(?:[:=→⇒]|->)\s*\S")


def _read_words(typed: str, gaps: list[list[str]]) -> list[str]:
    """Return the typed words in the order of the gaps, maybe too many or too few.

    Raises
    ------
    FormulaReadError
        If the text is empty, too long, or holds invisible characters.
    """
    if len(typed) > 1000:
        raise FormulaReadError("too-long", 1001, "1000")
    if not typed.strip():
        raise FormulaReadError("no-answer", 1)
    refuse_invisible(SourceText.of(typed.strip("\u200e\u200f\ufeff \r\n")), "\r\n\t" + _JOINERS)
    typed = typed.translate(_GAS_AND_SOLID).strip()
    if " " in typed or ":" in typed:
        typed = _strip_gap_word(ANSWER.sub("", typed), gaps)
    count = len(gaps)
    if count == 1:
        return [_NUMBERED.sub("", typed).strip(_ENDS + _QUOTES)]
    return _split_by_number(apply_rewrite("digits", typed), count) or _split_in_order(typed, count)


def _strip_gap_word(typed: str, gaps: list[list[str]]) -> str:
    """Return ``photo 3`` without its word, if each gap takes a number.

    Raises
    ------
    FormulaReadError
        For ``photo 1: 2``, which has two readings.
    """
    if not all(any(word.isdigit() for word in gap) for gap in gaps):
        return typed
    text = apply_rewrite("digits", typed)
    if _PICTURE_IS.search(PICTURES.sub(_PICTURE, text)):
        raise FormulaReadError("words-around", 1, typed)
    return PICTURES.sub(" ", text).strip()


def _split_digits(typed: str, gaps: list[list[str]]) -> list[str]:
    """Return the digits of ``324``, if each gap takes a single one; else none."""
    digits = typed.strip()
    single = all(any(len(word) == 1 and word.isdigit() for word in gap) for gap in gaps)
    return list(digits) if single and digits.isdigit() and len(digits) == len(gaps) > 1 else []


def _split_by_name(spec: GapSpec, typed: str) -> list[str]:
    """Return the numbers of gaps that are called by their names, ``H in 4, V in 2``; else none."""
    gaps = spec.gaps()
    if not spec.names or not all(any(word.isdigit() for word in gap) for gap in gaps):
        return []
    found: dict[int, str] = {}
    for piece in _NAMED_PIECES.split(apply_rewrite("digits", typed)):
        numbers = re.findall(r"(?<![\w.,])\d+(?![\w.,]*\w)", piece)
        words = re.sub(r"\d+", " ", piece)
        place = find_wording_in(words, spec.names, all_named=True) if len(numbers) == 1 else 0
        if not place or place in found or is_denied(piece):
            return []
        found[place] = numbers[0]
    return [found[place] for place in sorted(found)] if len(found) == len(gaps) else []


_NAMED_PIECES = WordPattern(r"\s*(?:[,;\n/]|\s«and»\s)+\s*|(?<=\d)\s+(?=[^\W\d_]\w*\s*[=:])")


def _split_by_number(typed: str, count: int) -> list[str]:
    """Return the words behind the gaps' own numbers, ``(1) ... (2) ...``; none without numbers."""
    pairs = dict(_PAIR.findall(typed))
    if {*pairs} == {*map(str, range(1, count + 1))} and not re.search(r"\w", _PAIR.sub("", typed)):
        return [pairs[str(number)] for number in range(1, count + 1)]
    found = list(_NUMBER.finditer(typed))
    marked = [mark for mark in found if not mark[0].strip().isdigit()]
    marks = next((some for some in (marked, found) if _is_each_gap_once(some, count)), [])
    if not marks or marks[0].start():
        return []
    names = list(map(_parse_gap_number, marks))
    ends = [*(mark.start() for mark in marks[1:]), len(typed)]
    words = {
        name: _JOINED.sub("", typed[mark.end() : end].strip(_ENDS)).strip(_ENDS)
        for name, mark, end in zip(names, marks, ends, strict=True)
    }
    return [words[str(number)] for number in range(1, count + 1)]


def _parse_gap_number(mark: re.Match[str]) -> str:
    """Return the number of a gap as text, of ``2)`` and of ``b)`` alike."""
    return mark[1] or str("abcdefgh".index(mark[2]) + 1)


def _is_each_gap_once(marks: list[re.Match[str]], count: int) -> bool:
    """Return whether the marks are the numbers of all gaps, each once."""
    return sorted(map(_parse_gap_number, marks)) == sorted(map(str, range(1, count + 1)))


def _split_in_order(typed: str, count: int) -> list[str]:
    """Return the words in the order of the gaps, cut at the strongest separator that fits.

    Raises
    ------
    FormulaReadError
        If several pieces have a label of their own, which nobody asked for.
    """
    pieces = _cut_pieces(typed, count)
    if len(pieces) != count and typed.isalpha() and len(typed) == count:
        return list(typed)
    if sum(map(bool, map(_LABEL.match, pieces))) > 1:
        raise FormulaReadError("words-around", 1, typed)
    return [_NUMBERED.sub("", piece).strip(_QUOTES) for piece in pieces]


def _cut_pieces(typed: str, count: int) -> list[str]:
    """Return ``count`` pieces, by the first separator that gives them; else all words."""
    plain = typed.split()
    for separator in _SEPARATORS:
        pieces = [piece.strip() for piece in separator.split(typed)]
        while pieces and not pieces[-1]:
            pieces.pop()
        if len(pieces) == count:
            return pieces
    return plain


def _judge_gap(spec: GapSpec, gap: list[str], word: str) -> Verdict:
    """Return the verdict on one gap, by the word itself or the term that it is nearest to."""
    known = [*gap, *(term for one in spec.gaps() for term in one), *spec.among]
    either = _EITHER.search(word) or (
        " / " in word and not _is_all_right(word, {*map(fold_word, gap)})
    )
    if either and fold_word(word) not in map(fold_word, known):
        return unreadable("words-around", safe_echo(word))
    return _judge_word(spec, gap, _drop_idle_words(_drop_around(word, known), known[len(gap) :]))


def _drop_around(word: str, known: list[str]) -> str:
    """Return a term of any language in English, without what is denied, a reason or a remark."""
    apart = _NOT_BUT.fullmatch(word)
    terms = {*map(fold_word, known)}
    if apart and {fold_word(apart["out"]), fold_word(apart["kept"])} <= terms:
        word = apart["kept"]
    for shape in (_CORRECTED, _PRODUCT, _CALLED):
        found = shape.fullmatch(word)
        head = word[: found.start("term")] if found else ""
        is_term = _holds_a_term(head, known) or fold_word(head.strip(" :=")) in terms
        stands = shape is _CORRECTED or not (casts_doubt(head) or (shape is _CALLED and is_term))
        term = fold_word(_translate_word(found["term"], known)) if found else ""
        if found and term in terms and stands:
            word = found["term"]
    return _drop_remark(_drop_reason(_translate_word(word, known), known), known)


def _judge_word(spec: GapSpec, gap: list[str], word: str) -> Verdict:
    """Return the verdict on the word of one gap, without what stands around it."""
    right = {fold_word(term) for term in gap}
    folded = fold_word(word)
    if not folded:
        return wrong("", "gap-empty") if not word else unreadable("no-answer")
    folded = _ZEROS.sub("", folded)
    spelt = (str(list_number_words().get(term.casefold(), "")) for term in gap)
    numbers = [term for term in (*gap, *spelt) if term[:1].isdigit()]
    if numbers and _is_number_said_otherwise(word, numbers):
        return correct(safe_echo(word))
    if folded in right or _fold_spelt_out(word) in right or _is_inflection(word, right):
        return correct(safe_echo(" ".join(word.split())))
    others = [o for g in spec.gaps() for o in g if fold_word(o) not in right] + spec.among
    if _is_all_right(word, right) or _is_in_company(word, gap, others):
        return correct(safe_echo(" ".join(word.split())))
    if folded in map(fold_word, others):
        return wrong(safe_echo(word), "other-term")
    return _judge_by_nearest_term(spec, word, gap, others)


def _translate_word(word: str, terms: list[str]) -> str:
    """Return the term that a word of another language says, ``dunkler``; else the word as it is.

    So does a list, ``Rot, Grün und Blau``, if all of it together is a term.
    """
    known = {fold_word(term): term for term in reversed(terms)}
    pieces = [piece for piece in _LISTED.split(word) if piece]
    if fold_word(word) in known or len(pieces) > MOST_PIECES:
        return word
    whole = find_translation(word)
    said = [(find_translation(piece) or (piece,))[0] for piece in pieces]
    found = (known.get(fold_word(one)) for one in (*whole, " ".join(said)))
    return next(filter(None, found), word)


_LISTED = WordPattern(r"\s*(?:[,;/&\s]|(?<!\S)«and»(?!\S))\s*")
MOST_PIECES = 6
"""Words that can be a list of them."""


def _is_number_said_otherwise(word: str, numbers: list[str]) -> bool:
    """Return whether a word is a number in letters, or a quantity in another unit.

    ``four`` stands for 4, and ``0.507 µm`` for 507 nm.
    """
    said = apply_rewrite("digits", word).casefold()
    if str(list_number_words().get(said)) in numbers or said in numbers:
        return True
    typed = _read_quantity(word)
    return typed is not None and typed in map(_read_quantity, numbers)


def _read_quantity(text: str) -> tuple[Value, Dimension] | None:
    """Return a value in base units and its dimension; None for anything else."""
    match = _QUANTITY.fullmatch(apply_rewrite("digits", text))
    if match is None:
        return None
    try:
        unit = read_unit(match["unit"])
    except FormulaError:
        return None
    number = Fraction(match["number"].replace(",", "."))
    value = fmpq(number.numerator, number.denominator) * unit.factor
    return value, unit.dimension


_QUANTITY = re.compile(r"(?P<number>\d+(?:[.,]\d+)?) ?(?P<unit>[^\W\d_]{1,3})")
_ZEROS = re.compile(r"(?<=\d)[.,]0+(?!\d)")
"""Decimals that say nothing: ``507.0``."""


@cache
def _load_idle_words() -> frozenset[str]:
    """Return the words beside a term that say nothing more, of all languages."""
    return frozenset(
        word for lang in list_languages() for word in load_words(lang, "answers")["around"]["idle"]
    )


def _drop_reason(word: str, terms: list[str]) -> str:
    """Return the term in front of its reason, ``black, since it absorbs``; else all of it.

    Several words behind a comma are a reason, too, as long as they offer no other word.
    """
    plain = _REASON.sub("", word).strip()
    nearly = _NEARLY.sub("", plain)
    before, comma, reason = word.partition(", ")
    known = {*map(fold_word, terms)}
    other = [one for one in terms if fold_word(one) != fold_word(before)]
    told = _OFFERED.search(reason) or casts_doubt(reason) or _TAKES_BACK.match(reason)
    names = {fold_word(piece) for piece in re.split(r"[\s,;/()]+", reason)}
    another = told or names & {*map(fold_word, other)} or any(one in reason for one in other)
    explained = before if comma and " " in reason and not another else word
    tried = (plain, nearly, explained)
    return next((one for one in tried if one != word and fold_word(one) in known), word)


_CALLED = WordPattern(r"(?P<head>[^,;:=]+?)(?: «is»:? | ?[:=] ?)(?P<term>[^,;:=]+)", re.IGNORECASE)
"""A term behind what it is of, ``the code is SN``."""
_TAKES_BACK = WordPattern(
    r"(?:«choices.correcting»|«choices.false»|«choices.actually»)(?!\w)", re.IGNORECASE
)
"""What begins words that put another term in place of one."""
_CORRECTED = WordPattern(
    r".+?[,;.…]+ ?(?:(?:«choices.correcting»)[,:;]? |(?:«choices.false»)[,:;] ?)(?P<term>[^,;:]+)",
    re.IGNORECASE,
)
"""A term in place of one that is taken back, ``red, no: black``."""
_PRODUCT = re.compile(r".*(?:->|→|⟶|=>|⇒) *(?P<term>[^<>→⟶⇒]+)")
"""What comes out, behind the arrow of a reaction: ``N2 + 3 H2 -> 2 NH3``."""
_NOT_BUT = WordPattern(r"«choices.not» (?P<out>.+?),? «choices.but» (?P<kept>.+)", re.IGNORECASE)
_REASON = WordPattern(r"[,;.(]? ?(?<!\w)«choices.because»(?!\w).+", re.IGNORECASE | re.DOTALL)
_NEARLY = WordPattern(r"^\(?(?:«nearly»|«about»)\)? ", re.IGNORECASE)


def _drop_remark(word: str, terms: list[str]) -> str:
    """Return a term without what stands behind it in brackets, ``subtractive (CMYK)``.

    Nothing is dropped that offers another word or takes it back.
    """
    outside, bracket, remark = word.partition("(")
    if not bracket or is_denied(outside) or _OFFERED.search(remark):
        return word
    plain = _drop_idle_words(_translate_word(outside.strip(), terms), terms)
    if fold_word(plain) in map(fold_word, terms):
        return plain
    inside = _translate_word(remark.strip(" )"), terms)
    translated = _BANGLA.search(outside) and not _BANGLA.search(remark)
    foreign = translated and not _holds_a_term(outside, terms)
    return inside if foreign and fold_word(inside) in map(fold_word, terms) else word


_BANGLA = re.compile("[\u0980-\u09ff]")
_EITHER = WordPattern(r"(?<!\S)«choices.or»(?!\S)", re.IGNORECASE)
"""A word between several that are offered."""

_OFFERED = WordPattern(r"^ ?«choices.offered»|(?:^|[ ,])«choices.or» ", re.IGNORECASE)


def _drop_idle_words(word: str, terms: list[str]) -> str:
    """Return the term among words that say nothing, ``still green``; else all of it."""
    words = word.split()
    kept = [one for one in words if one.casefold().strip(".,") not in _load_idle_words()]
    term = " ".join(kept)
    return term if len(kept) < len(words) and fold_word(term) in map(fold_word, terms) else word


def _is_all_right(word: str, right: set[str]) -> bool:
    """Return whether several right terms are joined, ``streaks / smear``."""
    pieces = [piece for piece in _ALONGSIDE.split(word) if piece.strip()]
    said = ({fold_word(piece), *map(fold_word, find_translation(piece))} for piece in pieces)
    return len(pieces) > 1 and all(one & right for one in said)


_ALONGSIDE = WordPattern(r" ?/ ?|, | (?:«and»|&) ")


def _is_in_company(word: str, gap: Sequence[str], others: Sequence[str]) -> bool:
    """Return whether a right term stands among words that neither change nor contradict it.

    A term of one word goes before a noun, ``high price``, or before a remark in brackets; one of
    several may stand anywhere: ``all rows at the same time``.
    """
    pieces = re.split(r"[\s,;]+", _TIMES_AHEAD.sub("", word))
    idle = _load_idle_words() - {fold_word(one) for one in gap}
    words = [fold_word(piece) for piece in pieces if fold_word(piece) and piece not in idle]
    if "".join(words) in map(fold_word, gap):
        return True
    if len(words) < len(("term", "noun")) or not word[:1].isalpha():
        return False
    wrong = {fold_word(term) for term in others}
    for term in gap:
        wanted = [fold_word(piece) for piece in term.split()]
        places = [i for i in range(len(words)) if words[i : i + len(wanted)] == wanted]
        rest = [*words[: places[0]], *words[places[0] + len(wanted) :]] if places else []
        alone = len(wanted) == 1 and (places != [0] or len(rest) > len(("fill", "factor")))
        known = wrong & {*rest, "".join(rest)}
        few = rest and not alone and not known and len(rest) <= MOST_COMPANY
        if few and not says_otherwise(" ".join(one for one in rest if one != "power")):
            return not casts_doubt(word)
    return False


_TIMES_AHEAD = WordPattern(r"^\d+ ?(?:«choices.times»|x|×) ", re.IGNORECASE)
"""By how much something is ``10 times less``."""
MOST_COMPANY = 3
"""Words beside a term that are no sentence yet."""


def _judge_by_nearest_term(spec: GapSpec, word: str, gap: list[str], others: list[str]) -> Verdict:
    """Return the verdict on a word that is no term, by the terms that it is nearest to.

    It is asked back when a wrong term is as near as a right one, or when it is a word of its own.
    """
    near, _ = nearest_terms(word, [*gap, *others])
    if not near and len(listed := [piece for piece in _LISTED.split(word) if piece]) > 1:
        near, _ = nearest_terms(" ".join(listed), [*gap, *others])
    if not near:
        near = _find_misspelt_last(word, [*gap, *others])
    meant = not near and _says_otherwise(spec, word, gap, others)
    if meant:
        return correct(safe_echo(word))
    if not near and "+" not in word and _holds_a_term(word, [*gap, *others]):
        return unreadable("words-around", safe_echo(word))
    hits = {term in gap for term in near}
    if hits == {True, False}:
        return ambiguous("which-term", safe_echo(word), terms=tuple(near))
    if hits != {True}:
        return wrong(safe_echo(near[0] if near else word), "other-term" if near else "unknown-term")
    if all(is_another_word(word, term, spec.terms) for term in near):
        return ambiguous("another-word", safe_echo(word))
    return correct(safe_echo(near[0]), "spelling", typed=word)


def _find_misspelt_last(word: str, terms: list[str]) -> list[str]:
    """Return the terms nearest to the last of a few idle words, ``it looks blak``."""
    before, _, last = word.rpartition(" ")
    few = 0 < len(before.split()) <= MOST_COMPANY
    if (
        not few
        or len(fold_word(last)) < LEAST_MISSPELT
        or says_otherwise(before)
        or casts_doubt(before)
    ):
        return []
    near, distance = nearest_terms(last, terms)
    return near if distance and not is_denied(before) else []


LEAST_MISSPELT = 4
"""Letters of a word in which a slip is looked for."""


def _says_otherwise(spec: GapSpec, word: str, gap: list[str], others: list[str]) -> bool:
    """Return whether words say a right term otherwise, and no wrong one: ``lower fill factor``.

    Numbers are no words, and neither are the terms that only look like one of these.
    """
    terms = {fold_word(term) for term in spec.terms}
    spoken = {fold_word(piece) for piece in re.split(r"[\s,;/()]+", word)}
    terms |= {fold_word(term) for term in others if " " not in term}
    if spoken & terms or not others or any(map(str.isdigit, word)):
        return False
    sides = [["; ".join(gap), "; ".join(others)]]
    return find_wording_in(word, sides, all_named=True) == 1 and says_whole(word, gap)


def _fold_spelt_out(word: str) -> str:
    """Return ``C, M, Y, K`` as the folded CMYK; empty if nothing is spelt out."""
    spelt = re.search(r"[,.·+&]", word) and not re.search(r"\d", word)
    return fold_word(re.sub(r"[\s,./·+&-]", "", word)) if spelt else ""


def _is_inflection(word: str, right: set[str]) -> bool:
    """Return whether a word is a right one with an ending: ``additively`` for ``additive``.

    German adjectives lose their noun that way, ``additive`` for ``additive Mischung``.
    """
    whole = fold_word(word)
    return any(
        whole.endswith(end) and len(whole) - len(end) >= LONG and whole[: -len(end)] in right
        for end in list_words("choices.word-endings")
    )


def _holds_a_term(word: str, terms: list[str]) -> bool:
    """Return whether a term stands among other words; a number with a unit is none."""
    if _MEASURE.fullmatch(word):
        return False
    words = [fold_word(piece) for piece in re.split(r"[\s,;/]+", word) if fold_word(piece)]
    return len(words) > 1 and any(fold_word(term) in words for term in terms)


def _combine_gap_verdicts(cells: list[Verdict], read_as: str, because: tuple[str, ...]) -> Verdict:
    """Return the verdict on several gaps: the mean of their credits, and which are wrong."""
    credit = sum((cell.credit for cell in cells), Fraction(0)) / len(cells)
    missed = tuple(str(i + 1) for i, cell in enumerate(cells) if cell.credit < 1)
    verdict = verdict_by_share(credit, read_as, "gaps", names=missed, because=because)
    if credit == 1 and any(cell.note == "spelling" for cell in cells):
        slips = [str(cell.fields["typed"]) for cell in cells if cell.note == "spelling"]
        return correct(read_as, "spelling", typed=", ".join(slips))
    return verdict


def _format_gap(gap: list[str], lang: str) -> str:
    """Return the synonym of a gap that is written in a language's letters, else the first."""
    if not any(letter.isalpha() for letter in gap[0]):
        return gap[0]
    return next((word for word in gap if is_written_in(fallback_language(lang), word)), gap[0])


def ask(part: PartContext) -> AskedPart[GapSpec]:
    """Return the words of every gap in all languages; of a pool also the sentences around them."""
    gaps = part.selection()[0]
    words = [part.words.get(name, name) for name in gaps]
    known = part.reason_names()
    told = [name if name in known else term for name, term in zip(gaps, words, strict=True)]
    wrong = list(_iter_wrong_words(part, gaps, words))
    among = [*part.answer.get("among", ()), *(term for _, _, terms in wrong for term in terms)]
    named = [(str(place), name) for place, name in enumerate(told, 1)]
    slips = [(f"{mark}={fold_word(term)}", name) for mark, name, terms in wrong for term in terms]
    accept = [part.accepted_words(name) for name in words]
    numbered = len(gaps) > 1 and all(term[0].isdigit() for term in accept)
    names = part.numbered_words(len(gaps)) if numbered else []
    spec = make_spec(
        GapSpec,
        part,
        accept=accept,
        among=list(dict.fromkeys(among)),
        terms=confusable_terms(part.terms, chain(*accept)),
        **({"names": names} if names else {}),
        why=part.reasons([*named, *slips]),
    )
    return AskedPart(
        spec,
        InputControl("gaps", boxes=tuple(InputBox("") for _ in gaps) if len(gaps) > 1 else ()),
        statements=tuple(("options", name) for name in gaps) if "take" in part.answer else (),
        right=tuple(("reasons", name) for _, name in part.with_reason(named)),
        reasons=tuple((f"({mark}) {terms[0]}", name) for mark, name, terms in wrong),
    )


def _iter_wrong_words(
    part: PartContext, gaps: Sequence[str], words: Sequence[str]
) -> Iterator[tuple[str, str, list[str]]]:
    """Yield a gap's number, ``gap = word`` as reasons name it, and how the word may be typed."""
    for place, (gap, right) in enumerate(zip(gaps, words, strict=True), 1):
        for name in part.reason_names():
            first, equals, term = name.partition(" = ")
            if equals and first in {gap, right} and term != right:
                # Another gap's word comes with its synonyms.
                yield str(place), name, part.accepted_words(term) if part.has_gap(term) else [term]


def accept_synonyms(spec: GapSpec, lang: str) -> str:
    """Return other words for each gap, those in other letters aside."""
    found = []
    for gap in spec.gaps():
        _, *others = [word for word in gap if is_written_in(lang, word)] or [""]
        found.append(", ".join(others[:MOST_SYNONYMS]))
    return "; ".join(filter(None, found))


MOST_SYNONYMS = 3


def input_hints(spec: GapSpec, lang: str) -> tuple[str, ...]:
    """Return how to fill in several gaps: with numbers where no gap takes another word."""
    gaps = spec.gaps()
    if len(gaps) == 1:
        return (translate(lang, "ask.gap_one"),)
    numbers = all(gap[0].isdecimal() for gap in gaps)
    return (translate(lang, "ask.gap_numbers" if numbers else "ask.gap"),)


KIND = AnswerKind(
    AuthoredGap,
    GapSpec,
    ask,
    input_hints,
    accepted=accept_synonyms,
    verb="tick",
    work=count_listed("cell", "gaps"),
)
