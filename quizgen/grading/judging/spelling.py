"""Comparing words: folding case, hyphens and spelling variants; the nearest of known terms."""

from __future__ import annotations

import operator
import re
import unicodedata
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, lru_cache, partial
from typing import NamedTuple

from quizgen.locale import cache_words
from quizgen.locale.word_patterns import WordPattern, list_tables, list_words

_ARTICLES = WordPattern(r"^«spelling.articles» (?=\S)")
_DASH = re.compile(r"[-‐‑‒–—−_/]")
_DASHES = re.compile(r"(?<=[^\W_])[-‐‑‒–—−_/]|[-‐‑‒–—−_/](?!\d)")
"""Hyphens and dashes, but not the sign of a number."""


@partial(cache_words, most=4096)
def fold_word(text: str) -> str:
    """Return a word answer without what does not matter in it.

    Case, blanks, hyphens, punctuation at the ends, articles, British spelling, digits of any
    script, umlauts written out and decomposed letters are folded.
    """
    text = unicodedata.normalize("NFC", text)
    text = unicodedata.normalize("NFKC", text).casefold()
    if not text.isascii():
        text = "".join(str(unicodedata.decimal(c, c)) for c in text)
    if _DASH.search(text):
        text = _DASHES.sub(" ", text).replace("−", "-")
    text = " ".join(text.split()).strip(" .,;:!?\"'()।")
    text = _ARTICLES.sub("", text)
    for old, new in _list_variants():
        text = text.replace(old, new)
    return text.replace(" ", "")


@cache_words
def _list_variants() -> tuple[tuple[str, str], ...]:
    """Return spellings of every language with those in whose place they stand: colour, color."""
    pairs = (row.partition("=") for row in list_words("spelling.variants"))
    return tuple((old, new) for old, _, new in pairs)


class _Words(NamedTuple):
    """The words of a language with what they say in English, and how its words are put together."""

    said: dict[str, tuple[str, ...]]
    endings: tuple[str, ...]
    plain: tuple[str, ...]
    links: tuple[str, ...]


@cache_words
def _load_known_words() -> tuple[_Words, ...]:
    """Return the words of each language, folded, with what they say in English."""
    tables = zip(list_tables("said"), list_tables("spelling"), strict=True)
    return tuple(_read_known_words(said, spelling) for said, spelling in tables)


def _read_known_words(
    table: Mapping[str, Sequence[str]], spelling: Mapping[str, Sequence[str]]
) -> _Words:
    """Return the words of one language, and its endings from the longest."""
    said: dict[str, list[str]] = {}
    for english, words in table.items():
        for word in words:
            said.setdefault(fold_word(word), []).append(english)
    return _Words(
        {word: tuple(senses) for word, senses in said.items()},
        tuple(sorted(map(fold_word, spelling["said-endings"]), key=len, reverse=True)),
        ("", *spelling["dictionary-endings"]),
        tuple(spelling["links"]),
    )


@partial(cache_words, most=4096)
def find_translation(word: str) -> tuple[str, ...]:
    """Return what a word of another language says in English, each of its senses; none if unknown.

    It may have an ending of its language, and be put together of two words where that is done.
    """
    folded, tables = fold_word(word), _load_known_words()
    found = (
        find(words, folded) for find in (_find_with_ending, _find_compound) for words in tables
    )
    return next(filter(None, found), ())


def _find_with_ending(words: _Words, folded: str) -> tuple[str, ...]:
    """Return the senses of a word, as it stands or without an ending; none if unknown."""
    if folded in words.said:
        return words.said[folded]
    for ending in words.endings:
        stem = folded.removesuffix(ending)
        plain = (f"{stem}{end}" for end in words.plain if f"{stem}{end}" in words.said)
        found = next(plain, "") if stem != folded and len(stem) >= LEAST_STEM else ""
        if found:
            return words.said[found]
    return ()


def _find_compound(words: _Words, folded: str) -> tuple[str, ...]:
    """Return the sense of two known words written as one; none where that is not done."""
    for cut in range(LEAST_STEM, len(folded) - LEAST_STEM + 1) if words.links else ():
        last = _find_with_ending(words, folded[cut:])
        stems = (folded[:cut].removesuffix(link) for link in words.links)
        first = next((words.said[stem] for stem in stems if stem in words.said), ())
        if first and last:
            return (f"{first[0]} {last[0]}",)
    return ()


LEAST_STEM = 4
"""Letters that are left of a word whose ending does not count."""


def sounds_alike(word: str, english: str) -> bool:
    """Return whether a word in another script is an English one by its sound: ``ব্যারেল``, barrel."""
    sounds = _list_sounds()
    letters = re.findall("|".join(sounds), word) if sounds else []
    heard = _DOUBLE.sub(r"\1", "".join(map(sounds.__getitem__, letters)))
    return len(heard) >= LEAST_SOUNDS and heard == _spell_sounds(english)


@cache_words
def _list_sounds() -> dict[str, str]:
    """Return the letters of other scripts, longest first, with the consonants they stand for."""
    return dict(row.split("=") for row in list_words("spelling.sounds"))


@lru_cache(maxsize=4096)
def _spell_sounds(english: str) -> str:
    """Return the consonants of an English word as they sound, none twice."""
    text = english.casefold()
    for shape, sound in _SPELT:
        text = shape.sub(sound, text)
    return _DOUBLE.sub(r"\1", text)


_SPELT = tuple(
    (re.compile(shape), sound)
    for shape, sound in (
        (r"ph", "f"), (r"gn(?=[aeiou])", "n"), (r"[tsc]ion", "sn"), (r"[sc]h", "s"), (r"ck", "k"),
        (r"c(?=[eiy])", "s"), (r"[cq]", "k"), (r"x", "ks"), (r"z", "s"), (r"w", "v"),
        (r"ng", "n"), (r"[aeiouyh]", ""),
    )
)  # fmt: skip
_DOUBLE = re.compile(r"(.)\1+")


@lru_cache(maxsize=4096)
def fold_doubles(word: str) -> str:
    """Return a word with each letter once where it is doubled: which one is, is often mistaken."""
    return _DOUBLE.sub(r"\1", word)


LEAST_SOUNDS = 3
"""Consonants by which a word is known."""


SHORT = 4
"""Letters of a word in which two that are exchanged, ``hihg``, are the only slip."""
MOST = 2
"""Most typing slips allowed in any word."""


@lru_cache(maxsize=4096)
def allowed_typos(term: str) -> int:
    """Return the typing slips allowed: 0 to four letters or with digits, 1 to eight, else 2."""
    return 0 if len(term) <= 4 or any(map(str.isdigit, term)) else 1 if len(term) <= 8 else MOST


def typo_distance(first: str, second: str, most: int) -> int:
    """Return the typing slips between two words: letters put in, left out, changed or exchanged.

    Returns
    -------
    int
        ``most + 1`` if there are more than ``most``.
    """
    if _is_too_different(first, second, most):
        return most + 1
    return int(_load_edit_distance()(first, second, score_cutoff=most))


def _is_too_different(first: str, second: str, most: int) -> bool:
    """Return whether letters alone, wherever they stand, show more slips than ``most``."""
    if abs(len(first) - len(second)) > most or len({*first} ^ {*second}) > 2 * most:
        return True
    return max(len(first), len(second)) - (Counter(first) & Counter(second)).total() > most


@cache
def _load_edit_distance() -> Callable[..., int]:
    """Return the distance function of RapidFuzz, imported on first use."""
    from rapidfuzz.distance import OSA  # loaded when a word is not known as it stands

    return OSA.distance


def nearest_terms(typed: str, terms: Iterable[str]) -> tuple[list[str], int]:
    """Return the known terms nearest to a typed one, within the budget of each, and the distance.

    A term that is near only because *another* known term is as near is not chosen: ties are
    returned together.
    """
    folded = fold_word(typed)
    best: list[str] = []
    least = 3
    for term in terms:
        target = fold_word(term)
        if abs(len(target) - len(folded)) > MOST or _list_digits(target) != _list_digits(folded):
            continue  # read.csv2 is no slip of read.csv
        distance = typo_distance(folded, target, MOST)
        exchanged = distance == 1 and len(target) == SHORT and sorted(folded) == sorted(target)
        if distance <= least and (exchanged or distance <= allowed_typos(target)):
            best = [term] if distance < least else [*best, term]
            least = distance
    return best, least


def _list_digits(word: str) -> str:
    """Return the digits of a word, in which there are no slips of spelling."""
    return "".join(filter(str.isdigit, word))


_PREFIXES = WordPattern(r"^«spelling.prefixes»(?=.{3})")


def is_another_word(typed: str, term: str, known: Iterable[str]) -> bool:
    """Return whether what was typed is a word of its own rather than a slip in spelling a term.

    That is an opposite (``un-``, ``de-``, ``an-``), one of the ``known`` words, a term with two
    letters replaced, or the term next to a short word (``increases no``).
    """
    word, wanted = fold_word(typed), fold_word(term)
    pieces = typed.split()
    if any(fold_word(" ".join(pieces[:i] + pieces[i + 1 :])) == wanted for i in range(len(pieces))):
        return True
    stem, wanted_stem = _strip_word_prefix(word), _strip_word_prefix(wanted)
    if stem == wanted or wanted_stem == word or word in map(fold_word, known):
        return True
    if word[:2] != wanted[:2] and stem == wanted_stem:
        return True
    if len(word) != len(wanted):
        return False
    changed = sum(map(operator.ne, word, wanted))
    return changed == 2 and sorted(word) != sorted(wanted)


@partial(cache_words, most=4096)
def _strip_word_prefix(word: str) -> str:
    """Return a folded word without a prefix that turns or shifts its meaning."""
    return _PREFIXES.sub("", word)


def confusable_terms(terms: Iterable[str], words: Iterable[str]) -> list[str]:
    """Return the terms that look like a slip in spelling one of some words, and are none."""
    known, right = tuple(terms), {fold_word(word) for word in words}
    near = set().union(*(_find_similar_terms(known, word) for word in right))
    return [term for term in known if term in near and fold_word(term) not in right]


@lru_cache(maxsize=256)
def _find_similar_terms(terms: tuple[str, ...], word: str) -> frozenset[str]:
    """Return those of some terms that may be slips in spelling a word.

    They are cached, since each paper of a class needs the same.
    """
    few = allowed_typos(word)
    return frozenset(term for term in terms if typo_distance(fold_word(term), word, few) <= few)
