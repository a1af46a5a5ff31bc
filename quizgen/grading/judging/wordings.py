"""Which of several wordings is meant: options, sides of pairs, steps typed by their words.

A wording is meant if the answer has a word that only this one has, and none that speaks against
it: no word of another one that this one lacks, no denial, nothing that changes what it says.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Sequence
from functools import lru_cache, partial
from itertools import pairwise

from quizgen.grading.judging.likeness import (
    are_opposed,
    find_likest,
    list_ordinals,
    list_senses,
    tells_all,
)
from quizgen.grading.judging.spelling import (
    allowed_typos,
    find_translation,
    fold_doubles,
    fold_word,
    typo_distance,
)
from quizgen.grading.judging.statements import list_clause_words
from quizgen.grading.reading.answer_reader import casts_doubt, is_doubted, says_otherwise
from quizgen.grading.reading.number_words import list_number_words
from quizgen.locale import cache_words
from quizgen.locale.word_patterns import (
    WordPattern,
    list_rows,
    list_tables,
    set_of_words,
)

_TOKEN = re.compile(
    r"[-+−]?(?:\d+/)?√?\d+(?:[.,]\d+)?(?:/√?\d+)?|[^\W\d_]+/\d+|(?:[^\W\d_]|[\u0980-\u09ff])+\d*"
)
_ROOT = re.compile(r"(?:sqrt|√|wurzel|root(?: of)?) ?\(? ?(\d+) ?\)?")
_SHARE = WordPattern(r"\b«wordings.shares»\b")
_SIGNS = (
    (WordPattern(r"∞|(?<!\S)«wordings.infinity»(?!\S)"), "infinity"),
    (re.compile(r"(?<![^\W_])([a-z])_(?=\w)"), r"\1"),
    (re.compile(r"(?<=\d) ?\.{2,}(?=[-\d ])"), " to "),
    (re.compile(r"(?<![\d\w])\.(?=\d)"), "0."),
    (re.compile(r"(?<=\d),(?=\d)"), "."),
    (re.compile(r"\b50 ?%"), "1/2"),
    (re.compile(r"\b25 ?%"), "1/4"),
    (re.compile(r"\b75 ?%"), "3/4"),
    (re.compile(r"(?<=\d)[.,]0+(?!\d)"), ""),
    (re.compile(r"(?<![^\W_])([a-z]{3,})(?=\d)"), r"\1 "),
    (re.compile(r"(?<=\d) ?[-–—] ?(?=\d)"), " to "),
    (WordPattern(r"\b«minus» (?=\d)"), "-"),
    (re.compile(r"(?<!\S)\+(?=\d)"), ""),
    (WordPattern(r"\b«between» (.+) «and» "), r"from \1 to "),
    (WordPattern(r"\b«from»\b"), "from"),
    (WordPattern(r"(?<![^\W\d_])«to»(?!\w)"), "to"),
)
"""Other ways to say what a wording has."""
_MOST_WORDS_MORE = 8
"""Words of an answer that the meant wording has not."""


def find_wording(typed: str, wordings: Sequence[str], *, all_named: bool = False) -> int:
    """Return the place (from 1) of the wording that is meant; 0 if none or several may be.

    Parameters
    ----------
    typed : str
    wordings : sequence of str
        What there is to choose from.
    all_named : bool
        Whether each of them is named in the answer, so that a word of it is enough.
    """
    if is_doubted(typed) and not any(map(is_doubted, wordings)):
        return 0
    spoken = _split_words(typed)
    listed = [frozenset(_split_words(wording)) for wording in wordings]
    called = _find_by_name(typed, wordings)
    if called:
        return called
    known = frozenset().union(*listed)
    meant = frozenset(
        one for word in _join_compounds(spoken, known) for one in _find_known_words(word, known)
    )
    hits = [place for place, words in enumerate(listed, 1) if _own_words(words, listed) & meant]
    if len(hits) != 1:
        hits = [
            place
            for place in _find_nearest(meant & known, listed)
            if all_named or 3 * len(listed[place - 1]) <= 4 * len(meant & known)
        ]
    if len(hits) != 1:
        return 0
    wanted = listed[hits[0] - 1]
    more = meant - wanted
    if len(meant & wanted) >= FEWEST_PIECES:  # ``equal but new``, not ``anything but green``
        more -= set_of_words("choices.but")
    counted = any(list_number_words().get(word, 0) > 1 or word.isdecimal() for word in more)
    if (
        counted
        or more & known
        or more & set_of_words("wordings.against")
        or len(more) > _MOST_WORDS_MORE
    ):
        return 0
    meant_text = wordings[hits[0] - 1]
    names = frozenset(_fold(name.casefold()) for name in _NAME.findall(meant_text))
    if not all_named and not _says_enough(_split_words(meant_text), meant, listed, names):
        return 0
    denied = (
        says_otherwise(" ".join(more))
        or casts_doubt(" ".join(more))
        or _denies(wanted) != _denies(meant)
        or are_opposed(meant, wanted)
    )
    return 0 if denied else hits[0]


_NAME = re.compile(r"(?<=[^\W\d_] )[A-Z][a-z]{3,}")
"""A name: a word with a capital behind another one."""


def find_wording_in(
    typed: str, languages: Sequence[Sequence[str]], *, all_named: bool = False
) -> int:
    """Return the place of the wording that is meant in any of some languages; 0 if none is.

    German words that are no language of the bank are tried as what they say in English. Places
    that differ between languages mean none.
    """
    return _find_meant(typed, tuple(map(tuple, languages)), all_named)


@partial(cache_words, most=4096)
def _find_meant(typed: str, languages: tuple[tuple[str, ...], ...], all_named: bool) -> int:
    """Return what ``find_wording_in`` does; a pair is cut at many places to find its sides."""
    verbatim = {find_verbatim(typed, wordings) for wordings in languages} - {0}
    if len(verbatim) == 1:
        return verbatim.pop()
    if is_doubted(typed) and not any(is_doubted(one) for texts in languages for one in texts):
        return 0
    spoken = {*_split_words(typed)}
    if any(_is_shared(spoken, wordings) for wordings in languages):
        return 0
    found = {find_wording(typed, wordings, all_named=all_named) for wordings in languages} - {0}
    if not found and len(languages) > 1:  # people mix them: ``অনেক বেশি dark``
        mixed = [" ".join(texts) for texts in zip(*languages, strict=True)]
        found = {find_wording(typed, mixed, all_named=all_named)} - {0}
    for said in () if found else list_translated(typed):
        found |= {find_wording(said, languages[0], all_named=all_named)} - {0}
    if len(found) == 1:
        return found.pop()
    split = [
        [[_split_words(part) for part in _CLAUSE.split(wording)] for wording in wordings]
        for wordings in languages
    ]
    return find_likest(_split_words(typed), split, all_named=all_named)


def says_whole(typed: str, wordings: Sequence[str]) -> bool:
    """Return whether an answer has all words of one of some wordings, or words like them."""
    said = _split_words(typed)
    return any(tells_all(said, _split_words(wording)) for wording in wordings)


def find_verbatim(typed: str, wordings: Sequence[str]) -> int:
    """Return the place of the only wording that has these signs in it, ``y = -x``; 0 if none is.

    They must not be words alone, which other words around them may turn, nor a number in another.
    """
    piece = _squeeze(typed)
    least = LEAST_TOLD - piece.isupper()
    if _denies(frozenset(_split_words(typed))):
        return 0
    if len(piece) < least or not (_SIGN.search(piece) or piece.isupper()):
        return 0
    shape = re.compile(rf"(?<![\w.]){re.escape(piece)}(?![\w.]|[*/^]|\()")
    found = [place for place, one in enumerate(wordings, 1) if shape.search(_squeeze(one))]
    same = [place for place, one in enumerate(wordings, 1) if _squeeze(one) == piece]
    return next((some[0] for some in (same, found) if len(some) == 1), 0)


def _squeeze(text: str) -> str:
    """Return a text as its signs are compared: without blanks around them, powers as ``^``."""
    for old, new in (("−", "-"), ("²", "^2"), ("³", "^3"), ("**", "^"), ("·", "*"), ("√", "sqrt")):
        text = text.replace(old, new)
    text = re.sub(r"\|([^|\s]+)\|", r"abs(\1)", text.strip(" .!?।"))
    return re.sub(r" ?([-+*/^=<>(),;:|]) ?", r"\1", text)


_SIGN = re.compile(r"[=^(_<>+*/]|\w\.\w|[a-z][A-Z]|\d-?[A-Za-z]")
"""What words do not have: a sign of a formula or of a program."""
_CLAUSE = re.compile(r"[:;,.](?= |$)")


def _is_shared(said: Collection[str], wordings: Sequence[str], called: int = 0) -> bool:
    """Return whether all words of an answer stand in several wordings, and it is none of them.

    Without a wording that is ``called`` so this holds of single words only; what stands before a
    bracket is all of a wording, *Gigabit Ethernet (1 Gbit/s)*.
    """
    split, told = [{*_split_words(one)} for one in wordings], {*said}
    whole = {*_split_words(wordings[called - 1].partition("(")[0])} if called else set[str]()
    if (len(told) > 1 and not called) or told in split or told == whole:
        return False
    return sum(told <= one for one in split) > 1


def share_words(typed: str, wordings: Sequence[str]) -> bool:
    """Return whether an answer has a word of some wordings that says something."""
    return bool({*_split_words(typed)} & {word for one in wordings for word in _split_words(one)})


def list_translated(typed: str) -> list[str]:
    """Return a text with its known words of other languages in English; none if it has none."""
    pieces = re.split(r"([\s,;:()-]+)", typed)
    known = [find_translation(piece) if piece else () for piece in pieces]
    most = max((len(said) for said in known if said), default=0)
    return [
        "".join(
            said[min(turn, len(said) - 1)] if said else piece
            for piece, said in zip(pieces, known, strict=True)
        )
        for turn in range(most)
    ]


def holds_wording(text: str, wording: str) -> bool:
    """Return whether a sentence has all of a wording in it, as words of its own."""
    said, wanted = (" ".join(_ANY_WORD.findall(one.casefold())) for one in (text, wording))
    return len(wanted) >= LEAST_TOLD and f" {wanted} " in f" {said} "


_ANY_WORD = re.compile(r"[\w\u0980-\u09ff]+")
LEAST_TOLD = 3
"""Letters of a wording that can be recognised in a sentence."""


@lru_cache(maxsize=4096)
def _list_names_of(wording: str) -> frozenset[frozenset[str]]:
    """Return the words of a wording, and of what stands for all of it beside a comma or a bracket.

    ``the long ones, 600 to 700 nm (red)`` has three names.
    """
    parts = _APART.split(wording) if _APART.search(wording) else []
    return frozenset(frozenset(_split_words(part)) for part in (wording, *parts)) - {frozenset()}


_APART = re.compile(r"(?<!\d)[,;](?= )|(?<=\d)[,;](?= [^\W\d])|[()]|:(?= )")


def _find_nearest(meant: frozenset[str], listed: list[frozenset[str]]) -> list[int]:
    """Return the places of wordings that have all these words, without those that say more."""
    having = {place: words for place, words in enumerate(listed, 1) if meant and meant <= words}
    return [
        place for place, words in having.items() if not any(one < words for one in having.values())
    ]


def _find_by_name(typed: str, wordings: Sequence[str]) -> int:
    """Return the place of the only wording that is called so, by all of it or by its parts."""
    if casts_doubt(typed) and not any(map(casts_doubt, wordings)):
        return 0
    said = frozenset(_split_words(typed))
    names = _list_names_of(typed) - {said}
    known = frozenset().union(*map(_split_words, wordings))
    joining = set_of_words("wordings.joining")
    for found in (
        [place for place, one in enumerate(wordings, 1) if said and said in _list_names_of(one)],
        [place for place, one in enumerate(wordings, 1) if names and names <= _list_names_of(one)],
        _find_same_pieces(typed, wordings),
        [
            place
            for place, one in enumerate(wordings, 1)
            if any(
                name and (said & known) - joining == name and _is_little_more(said - known)
                for name in _list_names_of(one)
            )
        ],
    ):
        if len(found) == 1:
            meant = {one for word in said for one in _find_known_words(word, known)}
            return 0 if _is_shared(meant & known, wordings, found[0]) else found[0]
    return 0


def _is_little_more(words: frozenset[str]) -> bool:
    """Return whether words beside a name neither deny it nor count anything."""
    return len(words) <= MOST_WORDS_BESIDE and not (
        words & set_of_words("wordings.against")
        or _denies(words)
        or says_otherwise(" ".join(words))
        or any(word.isdecimal() or word in list_number_words() for word in words)
        or words & list_ordinals().keys()
    )


def _find_same_pieces(typed: str, wordings: Sequence[str]) -> list[int]:
    """Return the places of wordings of the same pieces, in any order: ``night 1, day 2``."""
    listed = [_list_pieces(one) for one in wordings]
    known = frozenset(word for pieces in listed for piece in pieces for word in piece)
    said = _list_pieces(typed, known)
    if len(said) < FEWEST_PIECES:
        return []
    return [place for place, pieces in enumerate(listed, 1) if pieces == said] or [
        place for place, pieces in enumerate(listed, 1) if _are_within(said, pieces)
    ]


def _are_within(said: frozenset[frozenset[str]], pieces: frozenset[frozenset[str]]) -> bool:
    """Return whether each piece of a wording has just one of an answer in it."""
    within = {one: [piece for piece in pieces if one and one <= piece] for one in said}
    return len(said) == len(pieces) == len(
        {*(p for some in within.values() for p in some)}
    ) and all(len(some) == 1 for some in within.values())


def _list_pieces(text: str, known: frozenset[str] = frozenset()) -> frozenset[frozenset[str]]:
    """Return the words of each piece between commas and joining words; known ones, if some are."""
    joining = set_of_words("wordings.joining")
    pieces = ({*_split_words(piece)} - joining for piece in _JOINED.split(text))
    return frozenset(
        frozenset(one for word in piece for one in _find_known_words(word, known))
        if known
        else frozenset(piece)
        for piece in pieces
    )


_JOINED = WordPattern(r"[,;] |,? (?:«and»|«choices.but») ")


def _join_compounds(spoken: tuple[str, ...], known: frozenset[str]) -> tuple[str, ...]:
    """Return the words with those put together that are one: ``attribute error``."""
    for first, second in pairwise(spoken):
        if first + second in known:
            rest = " ".join(spoken).replace(f"{first} {second}", first + second)
            return tuple(rest.split(" "))
    return spoken


def _says_enough(
    wording: tuple[str, ...],
    meant: frozenset[str],
    listed: list[frozenset[str]],
    names: frozenset[str],
) -> bool:
    """Return whether an answer has enough of a wording: ``barrel``, not ``pixels`` for hot ones.

    It has all numbers and letters that tell it from others, and at least half of the words that no
    other one has; a word of its own only with two thirds of these, more of them only with all.
    A name that only it has, ``Reykjavik``, is enough.
    """
    exact = {
        word
        for word in {*wording} - frozenset.intersection(*listed)
        if len(word) == 1 or any(map(str.isdigit, word))
    }
    own = _own_words(frozenset(wording), listed)
    own = own - set_of_words("wordings.joining") or own
    said = own & meant
    if exact - meant or (2 * len(said) < len(own) and not said & names):
        return False
    if said == own or said & names or any(len(word) >= LONG and word.isalpha() for word in said):
        return True
    more = len(meant - {*wording})
    if more == 1 and len(said) > 1 and 3 * len(said) >= 2 * len(own):
        return True
    return not more and not (wording[-1].isalpha() and said == {wording[-1]})


def _own_words(words: frozenset[str], listed: list[frozenset[str]]) -> frozenset[str]:
    """Return the words that no other wording has."""
    return frozenset(word for word in words if sum(word in other for other in listed) == 1)


def _denies(words: frozenset[str]) -> bool:
    """Return whether a word of denial is among some."""
    return bool(words & (set_of_words("wordings.denying") | list_clause_words("denials")))


def _find_known_words(word: str, known: frozenset[str]) -> frozenset[str]:
    """Return the known words that a typed one is, or says in another language; else itself."""
    found = _find_known_word(word, known)
    if found in known:
        return frozenset({found})
    senses = [frozenset(_split_words(" ".join(said))) for said in list_senses(word)]
    told = next((sense for sense in senses if sense and sense <= known), None)
    alike = _load_alike().get(word, frozenset()) & known
    if told is None and len(alike) == 1:
        return alike
    return told or next(filter(None, senses), frozenset({found}))


@cache_words
def _load_alike() -> dict[str, frozenset[str]]:
    """Return what says nearly the same as a word, by the word: larger for *enlarged*."""
    found: dict[str, set[str]] = {}
    for table in list_tables("alike"):
        for first, words in table.items():
            for word in words:
                found.setdefault(fold_word(word), set()).add(fold_word(first))
    return {word: frozenset(same) for word, same in found.items()}


def _find_known_word(word: str, known: frozenset[str]) -> str:
    """Return the known word that a typed one is, maybe with slips in spelling; else itself.

    ``two`` is the known 2, and the other way round.
    """
    if word in known:
        return word
    number = list_number_words().get(word, "")
    spelt = (
        [one for one in known if list_number_words().get(one) == int(word)]
        if word.isdecimal()
        else [str(number)]
    )
    if {*spelt} & known:
        return next(one for one in spelt if one in known)
    if not word.isalpha():
        return word
    near = [one for one in known if _stem(one) == _stem(word)] or [
        one
        for one in known
        if one[:1] == word[:1]
        and allowed_typos(one)
        and (typo_distance(word, one, 1) <= 1 or fold_doubles(word) == fold_doubles(one))
    ]
    return near[0] if len(near) == 1 else word


@partial(cache_words, most=4096)
def _stem(word: str) -> str:
    """Return an English word without the ending of its verb: ``averag`` of ``averaging``."""
    short = _VERB_ENDING.sub("", word)
    return short if len(short) >= LEAST_STEM else word


MOST_WORDS_BESIDE, FEWEST_PIECES = 3, 2
LONG = 9
"""Letters of a word that tells a wording by itself."""
_VERB_ENDING = WordPattern(r"«wordings.verb-endings»$")
LEAST_STEM = 4
"""Letters that are left of a word whose ending does not matter."""


@partial(cache_words, most=1024)
def _split_words(text: str) -> tuple[str, ...]:
    """Return the words of a text by which wordings are told apart, in order."""
    text = _ROOT.sub(r"√\1", unicodedata.normalize("NFC", text).casefold().replace("−", "-"))
    text = _SHARE.sub(lambda one: _load_shares()[one[0]], text)
    for pattern, sign in _SIGNS:
        text = pattern.sub(sign, text)
    text = _same_pattern().sub(lambda one: _load_same_words()[one[0]], text)
    folded = (_fold(token) for token in _TOKEN.findall(text))
    return tuple(word for word in folded if word and word not in set_of_words("wordings.idle"))


_ENDING = WordPattern(r"(?<=..)«wordings.endings»$")
"""What a case, a number or a stress adds to a word."""


@cache_words
def _load_shares() -> dict[str, str]:
    """Return the shares in words of all languages to fractions."""
    return {word: share for share, word in list_rows("wordings.shares")}


@cache_words
def _load_same_words() -> dict[str, str]:
    """Return the words and phrases that say the same as another one, of all languages."""
    return {
        word: said
        for table in list_tables("same")
        for said, words in table.items()
        for word in words
    }


@cache_words
def _same_pattern() -> re.Pattern[str]:
    """Return the pattern of everything that says the same as another word."""
    listed = "|".join(map(re.escape, sorted(_load_same_words(), key=len, reverse=True)))
    return re.compile(rf"(?<![\w\u0980-\u09ff])(?:{listed})(?![\w\u0980-\u09ff])")


def _fold(token: str) -> str:
    """Return a word without the ending of its plural and without spelling variants."""
    short = _ENDING.sub("", token)
    if short != token:
        return short
    if not token.isalpha() or token in list_number_words():
        return token
    word = fold_word(token)
    return (
        word.removesuffix("s") if len(word) > len("axis") - 1 and not word.endswith("ss") else word
    )
