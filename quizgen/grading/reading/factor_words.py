"""Factors, shares and bounds in words: ``twice as wide``, ``one fortieth``, ``at most 1.25 ms``."""

from __future__ import annotations

import re

from quizgen.grading.reading.number_words import list_number_words, replace_number_word
from quizgen.locale import cache_words
from quizgen.locale.word_patterns import WordPattern, list_rows, list_words, set_of_words

_BEFORE = WordPattern(
    r"^(?:«factors.subjects» (?:«factors.verbs» )?)?"
    r"(?:«factors.by» )?(?:«factors.before» |[x×*] ?(?=\d))?",
    re.IGNORECASE,
)
_NUMBER = r"(?P<number>\d+(?:[.,]\d+)?(?: ?/ ?\d+)?)"
_FACTOR = WordPattern(
    rf"{_NUMBER}(?: ?-?|[- ](?=[^\W\d]))(?P<sign>«factors.signs»|x|×)?"
    r"(?P<rest>(?: .+)?)",
    re.IGNORECASE,
)


_DASH_BETWEEN = re.compile("(?<=[\u0980-\u09ff])[-‐-–](?=[\u0980-\u09ff])")
_HALF_AS = WordPattern(r"^(?:«factors.subjects» (?:«factors.verbs» )?)?«factors.half-as» \S")
_ONE_SHARE = WordPattern(r"^«numbers.a» ")
_ONE_OF_PARTS = WordPattern(r"(?P<count>[^\s]+) «factors.one-of-parts»")
"""A share as Bangla says it: one part of six."""
_PART_OF = WordPattern(r"(\d+ ?/ ?\d+) «of» «articles» [^\W\d_]+(?: [^\W\d_]+)?")
"""A share of something: ``1/24 of the size``."""


_GROWING = WordPattern("«factors.growing»", re.IGNORECASE)
_SHRINKING = WordPattern("«factors.shrinking»", re.IGNORECASE)


@cache_words
def _list_shares() -> dict[str, str]:
    """Return shares in words to fractions: ``a quarter``, ``one fortieth``, ``ein Dreißigstel``."""
    ordinals = {
        f"{word.removesuffix(old)}{new}": f"1/{value}"
        for old, new in list_rows("numbers.share-endings")
        for word, value in list_number_words().items()
        if value >= len("1234") and word.endswith(old)
    }
    compound = {
        f"{tens}-{word}": f"1/{value + int(added)}"
        for tens, value in list_number_words().items()
        if value in range(20, 100, 10)
        for added, word in list_rows("numbers.shares-behind-tens")
    }
    listed = {word.casefold(): share for share, word in list_rows("factors.shares")}
    return {**{word.casefold(): value for word, value in (ordinals | compound).items()}, **listed}


def read_factor(typed: str) -> str:
    """Return the number that a factor or share in words means; empty if it is none.

    ``4 times shorter`` is a quarter, ``twice as wide`` is 2. What is compared is not looked at,
    but in which direction is.
    """
    text = _DASH_BETWEEN.sub(" ", " ".join(typed.split()).strip(" .!").casefold())
    share = "1/2" if _HALF_AS.match(text) else ""
    share = share or _list_shares().get(text) or _list_shares().get(_ONE_SHARE.sub("", text), "")
    share = share or _read_one_of_parts(text)
    if share:
        return share
    part = _PART_OF.fullmatch(text)
    if part:
        return part[1]
    for word, number in _split_multiples():
        if text == word or text.startswith(f"{word} "):
            text = f"{number} times{text[len(word) :]}"
            break
    plain = _BEFORE.sub("", text)
    match = _FACTOR.fullmatch(_spell_out(plain))
    if match is None or "/" in match["number"]:
        return ""
    rest = match["rest"].strip()
    if not match["sign"] and (rest or plain == text):
        return ""
    if not rest or _GROWING.match(rest):
        return match["number"]
    return f"1/({match['number']})" if _SHRINKING.match(rest) else ""


def _read_one_of_parts(text: str) -> str:
    """Return ``1/6`` for one of six parts, as Bangla says it; empty for anything else."""
    parts = _ONE_OF_PARTS.fullmatch(text)
    said = parts["count"].strip() if parts else ""
    count = list_number_words().get(said) or (int(said) if said.isdecimal() else 0)
    return f"1/{count}" if count else ""


def is_shrinking(words: str) -> bool:
    """Whether a word says that something is the smaller one: ``shorter``."""
    return any(word in set_of_words("factors.shrinking") for word in words.casefold().split())


@cache_words
def _split_multiples() -> list[tuple[str, str]]:
    """Return words that are a factor by themselves, longest first: ``twice``, ``vierfach``."""
    rows = list_rows("factors.multiples")
    return sorted(((word, number) for number, word in rows), key=lambda row: -len(row[0]))


def _spell_out(text: str) -> str:
    """Return ``fourfold`` and ``viermal`` as ``4 fold`` and ``4 mal``, ``four times`` in digits."""
    for ending in list_words("factors.signs"):
        head, found, rest = text.partition(ending)
        number = list_number_words().get(head.strip(" -")) if found else None
        if number is not None:
            return f"{number} {ending}{rest}"
    return replace_number_word(text)


_BOUNDS = {
    bound: WordPattern(
        rf"^(?:[^\W\d_]\w* ?)?(?:{signs})|^«factors.{bound}»(?![^\W\d_])", re.IGNORECASE
    )
    for bound, signs in {"most": r"[≤⩽]|<=|\\leq?|±|\+/?-", "least": r"[≥⩾]|>=|\\geq?"}.items()
}
"""What stands before a number that is the most or the least."""
_ASKED_BOUNDS = {
    bound: WordPattern(
        rf"(?<![\w\u0980-\u09ff])«factors.asking-{bound}»(?![\w\u0980-\u09ff])", re.IGNORECASE
    )
    for bound in _BOUNDS
}


def drop_bound(typed: str, bound: str) -> str:
    """Return ``at most 1.25 ms`` where the most is asked without its words; empty if without."""
    text = typed.strip()
    match = _BOUNDS[bound].match(text)
    return text[match.end() :].strip() if match and match.end() < len(text) else ""


def find_bound(question: str) -> str:
    """Return whether a question asks what something is at most or at least; empty for neither."""
    asked = re.findall(r"[^.?!]*\?", question)
    question = " ".join(asked) or question
    return next((bound for bound, asked in _ASKED_BOUNDS.items() if asked.search(question)), "")
