"""Which of several wordings an answer in own words is nearest to: *blurrier* for more blurred.

A word of the answer tells of the wordings that have a form of it, what it says in another language,
a word that says the same, or one at the same end of a scale. Meant is the only wording that all
telling words tell of. None is where a word denies, counts, weighs or doubts what that one does not.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial

from quizgen.grading.judging.spelling import (
    allowed_typos,
    find_translation,
    fold_word,
    is_another_word,
    sounds_alike,
    typo_distance,
)
from quizgen.grading.judging.statements import Scale, find_scales, is_form_of, list_clause_words
from quizgen.grading.reading.number_words import list_number_words
from quizgen.locale import cache_words
from quizgen.locale.word_patterns import list_tables, list_words, set_of_words

LOOSE_SCALES = frozenset({"sameness", "totality", "loss"})
"""Scales of words that often say little: *all*, *remain*."""
MORE = ("amount", 1)
Clauses = Sequence[Sequence[str]]
"""A wording: the folded words of each of its clauses."""

MOST_WORDS = 20
"""Words of an answer that is more than an option in own words."""
LONG = 8
"""Letters of a word that tells a wording by itself."""
FEW = 3
"""Words of an answer that is one term: another one in it makes it another term, *dead pixels*."""
LEAST = 3
"""Letters of a word that may have other forms."""
BEGINNING = 4
"""Letters by which a word may be begun, ``tele``."""


def find_likest(
    spoken: Sequence[str], languages: Sequence[Sequence[Clauses]], *, all_named: bool = False
) -> int:
    """Return the place (from 1) of the only wording that the words of an answer tell of; else 0.

    Parameters
    ----------
    spoken : sequence of str
        The words of the answer, folded.
    languages : sequence
        The wordings in each language.
    all_named : bool
        Whether each wording is named in the answer, so that one word of it is enough.
    """
    merged = [[clause for one in texts for clause in one] for texts in zip(*languages, strict=True)]
    wordings = [frozenset(word for clause in one for word in clause) for one in merged]
    fillers = list_clause_words("fillers")
    said = [word for word in dict.fromkeys(spoken) if word.isdecimal() or word not in fillers]
    if not said or len(said) > MOST_WORDS:
        return 0
    for related in (_is_same_word, _says_the_same, _is_like_word):
        places = {word: _find_places(word, wordings, related) for word in said}
        telling = {word: found for word, found in places.items() if 0 < len(found) < len(wordings)}
        common = frozenset.intersection(*telling.values()) if telling else frozenset[int]()
        common = common or _find_whole(said, languages, related)
        if len(common) == 1:
            (place,) = common
            strangers = [word for word, found in places.items() if not found]
            words = [[word for clause in texts[place] for word in clause] for texts in languages]
            told = [word for word, found in telling.items() if place in found]
            worded = [
                word for word in told if place in _find_places(word, wordings, _says_the_same)
            ]
            clear = (worded or all_named) and _is_enough(
                told, strangers, words, all_named=all_named
            )
            if clear and all(_agree(said, strangers, texts[place]) for texts in languages):
                return place + 1
    return 0


def _find_whole(
    said: Sequence[str], languages: Sequence[Sequence[Clauses]], related: Callable[[str, str], bool]
) -> frozenset[int]:
    """Return the place of the only wording all of whose words are said: ``infrared light``."""
    fillers = list_clause_words("fillers")
    found = set()
    for texts in languages:
        for place, clauses in enumerate(texts):
            words = {word for clause in clauses for word in clause if word not in fillers}
            if words and all(any(_tells(one, word, related) for one in said) for word in words):
                found.add(place)
    return frozenset(found if len(found) == 1 else ())


def tells_all(said: Sequence[str], wanted: Sequence[str]) -> bool:
    """Return whether an answer has each word of a wording that is no filler, or one like it."""
    fillers = list_clause_words("fillers")
    words = [word for word in wanted if word not in fillers]
    return bool(words) and all(
        any(_tells(one, word, _is_like_word) for one in said) for word in words
    )


def _tells(word: str, wanted: str, related: Callable[[str, str], bool]) -> bool:
    """Return whether a word, or what it says in another language, is related to a wanted one."""
    return related(word, wanted) or any(
        related(fold_word(part), wanted) for said in find_translation(word) for part in said.split()
    )


def _find_places(
    word: str, wordings: Sequence[frozenset[str]], related: Callable[[str, str], bool]
) -> frozenset[int]:
    """Return the places of the wordings that have a word like this one, or all that it says."""
    found = {
        place for place, words in enumerate(wordings) if any(related(word, one) for one in words)
    }
    for parts in list_senses(word):
        found |= {
            place
            for place, words in enumerate(wordings)
            if all(any(related(part, one) for one in words) for part in parts)
        }
    return frozenset(found)


@partial(cache_words, most=4096)
def list_senses(word: str) -> tuple[tuple[str, ...], ...]:
    """Return what a word says in another language, the words of each sense without fillers.

    The word may have lost its ending.
    """
    fillers = list_clause_words("fillers")
    endings = ("s",) if word.isascii() else list_words("wordings.endings")
    senses = (
        tuple(part for part in map(fold_word, said.split()) if part not in fillers)
        for form in (word, *(f"{word}{ending}" for ending in endings))
        for said in find_translation(form)
    )
    return tuple(dict.fromkeys(filter(None, senses)))


@partial(cache_words, most=65536)
def _is_same_word(word: str, other: str) -> bool:
    """Return whether a word is a form of another one, as a number is only of itself."""
    if word == other:
        return True
    if read_count(word) >= 0 or read_count(other) >= 0:
        return read_count(word) == read_count(other)
    if word.isascii() and (min(len(word), len(other)) < LEAST or not (word + other).isalpha()):
        return False
    return is_form_of(word, other, slips=False) or _is_slip(word, other)


def _is_slip(word: str, other: str) -> bool:
    """Return whether a word is another one with a slip of the fingers."""
    few = allowed_typos(other)
    near = few and word[:1] == other[:1] and typo_distance(word, other, few) <= few
    return bool(near) and not is_another_word(word, other, ())


@cache_words
def list_ordinals() -> dict[str, int]:
    """Return what a place is called in any language, with its number: ``first``."""
    return {
        word.casefold(): place
        for table in list_tables("ordinals")
        for place, row in enumerate(table["counted"], 1)
        for word in row.split("|")
    }


@cache_words
def _list_multiples() -> dict[str, int]:
    """Return words that are a factor by themselves, with it: ``twice``."""
    rows = (row.split(" ", 1) for row in list_words("factors.multiples"))
    return {word: int(number) for number, word in rows if " " not in word}


def _is_word(word: str) -> bool:
    """Return whether it is letters, and no number or a sign with one."""
    return word[:1].isalpha() and not any(map(str.isdigit, word))


@partial(cache_words, most=4096)
def read_count(word: str) -> int:
    """Return the whole number that a word is or says; -1 if it is none."""
    if word.isdecimal():
        return int(word)
    known = list_number_words() | _list_multiples()
    said = (sense[0] for sense in list_senses(word) if len(sense) == 1)
    return known.get(word, next((known[one] for one in said if one in known), -1))


@partial(cache_words, most=65536)
def _says_the_same(word: str, other: str) -> bool:
    """Return whether a word says the same as another one, or is its beginning."""
    if _is_same_word(word, other):
        return True
    if not word.isascii() and other.isascii() and sounds_alike(word, other):
        return True
    if len(word) >= BEGINNING and other.startswith(word) and _is_word(word):
        return True
    return not _find_groups(word).isdisjoint(_find_groups(other))


@partial(cache_words, most=16384)
def _find_groups(word: str) -> frozenset[int]:
    """Return the places of the groups of equal words in which a word is."""
    return frozenset(
        place
        for place, group in enumerate(_load_groups())
        if any(_is_same_word(word, one) for one in group)
    )


@partial(cache_words, most=65536)
def _is_like_word(word: str, other: str) -> bool:
    """Return whether a word says the same as another one, or is at the same end of a scale."""
    return _says_the_same(word, other) or bool({*_find_ends(word)} & {*_find_ends(other)})


def _find_ends(word: str) -> tuple[Scale, ...]:
    """Return the ends of scales that a word as it stands is at."""
    return find_scales(word, slips=False)


@cache_words
def _load_groups() -> tuple[frozenset[str], ...]:
    """Return the groups of words that say the same, folded, of all languages."""
    return tuple(
        frozenset(map(fold_word, (first, *words)))
        for table in list_tables("alike")
        for first, words in table.items()
    )


def _is_enough(
    telling: Sequence[str],
    strangers: Sequence[str],
    meant: Sequence[Sequence[str]],
    *,
    all_named: bool,
) -> bool:
    """Return whether an answer tells enough of a wording, and little that is not of it.

    One short word is enough only for half of a wording, or where each of several is named. A digit
    beside other words may be the number of an option, and *pixels* are no *hot pixels*.
    """
    digits = strangers and all(word.isdecimal() for word in telling)
    if digits or len(strangers) > len(telling) + 1:
        return False
    if not strangers and all(read_count(word) >= 0 for word in telling):
        return True
    worded = [word for word in telling if _is_word(word) and read_count(word) < 0]
    lengths = [
        max(map(len, () if word.isascii() else find_translation(word)), default=len(word))
        for word in worded
    ]
    longest = max(lengths, default=0)
    if all_named or longest >= LONG:
        return True
    others = [word for word in strangers if not _find_ends(word)]
    if others and len(telling) + len(others) <= FEW:
        return False
    if len(worded) > 1:
        return True
    fillers = list_clause_words("fillers")
    rest = [[word for word in words if word not in fillers] for words in meant]
    return any(
        2 * len(worded) > len(words)
        or (worded and 2 * len(worded) == len(words) and not _says_the_same(worded[0], words[-1]))
        or all(read_count(word) >= 0 for word in words)
        for words in rest
    )


def _agree(said: Sequence[str], strangers: Sequence[str], meant: Clauses) -> bool:
    """Return whether nothing in an answer speaks against a wording: no denial, number or end.

    A clause of the wording that the answer is silent on may deny something.
    """
    spoken = {*said, *(part for word in said for sense in list_senses(word) for part in sense)}
    touched = {
        word
        for clause in meant
        if any(_is_like_word(a, b) for a in spoken for b in clause)
        for word in clause
    }
    if not touched:
        return True
    if _denies(spoken) != _denies(touched) or are_opposed(spoken, touched):
        return False
    if any(word in list_clause_words("doubts") for word in strangers):
        return False
    if any(not _is_word(word) or read_count(word) > 1 for word in strangers):
        return False
    return _point_one_way(spoken, strangers, {word for clause in meant for word in clause})


def are_opposed(said: Collection[str], wanted: Collection[str]) -> bool:
    """Return whether an answer has one of two opposite words, and a wording only the other one.

    So are the two ends of a scale.
    """
    ends, own = ({end for word in words for end in _find_ends(word)} for words in (wanted, said))
    if any((name, -sign) in ends and (name, sign) not in ends for name, sign in own):
        return True
    for row in _load_opposites():
        told, asked = row & {*said}, row & {*wanted}
        if told and asked and not told & asked:
            return True
    return False


@cache_words
def _load_opposites() -> tuple[frozenset[str], ...]:
    """Return the rows of words of which only one can hold, folded, of all languages."""
    return tuple(frozenset(map(fold_word, row.split())) for row in list_words("wordings.opposites"))


def _denies(words: Collection[str]) -> bool:
    """Return whether one of some words denies, in any language."""
    denials = (
        list_clause_words("denials") | list_clause_words("ahead") | set_of_words("wordings.denying")
    )
    return any(
        word in denials or any({*sense} <= denials for sense in list_senses(word)) for word in words
    )


def _point_one_way(
    spoken: Collection[str], strangers: Collection[str], wanted: Collection[str]
) -> bool:
    """Return whether no word weighs what a wording does not, or the other way round.

    More of what the wording has on another scale is no contradiction: *much darker*.
    """
    ends = {end for word in wanted for end in _find_ends(word)}
    own = {end for word in spoken for end in _find_ends(word)}
    free = {*ends, *({MORE} if {one for one in own & ends if one[0] != MORE[0]} else ())}
    strange = {part for one in strangers for sense in list_senses(one) for part in sense}
    return all(
        {end for end in _find_ends(word) if end[0] not in LOOSE_SCALES} <= free
        for word in {*strangers, *strange}
    )
