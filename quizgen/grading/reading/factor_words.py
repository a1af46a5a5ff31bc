"""Factors, shares and bounds in words: ``twice as wide``, ``one fortieth``, ``at most 1.25 ms``."""

from __future__ import annotations

import re
from functools import cache

from quizgen.grading.reading.number_words import list_number_words, replace_number_word
from quizgen.locale import list_languages, load_words

_BEFORE = re.compile(
    r"^(?:(?:they|it|this|es|sie) (?:(?:gets?|grows?|becomes?|is|are|wird|werden) )?)?"
    r"(?:by )?(?:(?:a |the )?factor (?:of )?|times |[x×*] ?(?=\d))?",
    re.IGNORECASE,
)
_NUMBER = r"(?P<number>\d+(?:[.,]\d+)?(?: ?/ ?\d+)?)"
_FACTOR = re.compile(
    rf"{_NUMBER}(?: ?[-x×]?|[- ](?=[^\W\d]))(?P<sign>times|fold|fach(?:e[rsnm]?)?|mal|x|×|গুণ)?"
    r"(?P<rest>(?: .+)?)",
    re.IGNORECASE,
)


_DASH_BETWEEN = re.compile("(?<=[\u0980-\u09ff])[-‐-–](?=[\u0980-\u09ff])")
_PART_OF = re.compile(
    r"(\d+ ?/ ?\d+) (?:of|von) (?:the|its|that|der|des|dem) [^\W\d_]+(?: [^\W\d_]+)?"
)
"""A share of something: ``1/24 of the size``."""


@cache
def _load_factor_words() -> dict[str, list[str]]:
    """Return the words of factors, shares and bounds, of all languages."""
    found: dict[str, list[str]] = {}
    for lang in list_languages():
        for name, words in load_words(lang, "answers")["factors"].items():
            found.setdefault(name, []).extend(words)
    return found


@cache
def _compile(name: str) -> re.Pattern[str]:
    """Return the pattern of a whole text that is one of the words of a list."""
    words = sorted(_load_factor_words()[name], key=len, reverse=True)
    return re.compile("|".join(map(re.escape, words)), re.IGNORECASE)


@cache
def _list_shares() -> dict[str, str]:
    """Return shares in words to fractions: ``a quarter``, ``one fortieth``, ``ein Dreißigstel``."""
    rows = (row.split(" ", 1) for row in _load_factor_words()["shares"])
    ordinals = {
        f"{word.removesuffix('y')}{'ie' if word.endswith('y') else ''}{ending}": f"1/{value}"
        for word, value in list_number_words().items()
        for ending in ("th", "tel", "stel")
        if value >= len("1234")
    }
    compound = {
        f"{tens}-{word}": f"1/{value + int(share[2:])}"
        for tens, value in list_number_words().items()
        if value in range(20, 100, 10) and tens.isascii()
        for share, word in (("1/1", "first"), ("1/2", "second"), ("1/3", "third"), ("1/5", "fifth"),
                            ("1/8", "eighth"), ("1/9", "ninth"))
    }  # fmt: skip
    listed = {word.casefold(): value for value, word in rows}
    return {**{word.casefold(): value for word, value in (ordinals | compound).items()}, **listed}


def read_factor(typed: str) -> str:
    """Return the number that a factor or share in words means; empty if it is none.

    ``4 times shorter`` is a quarter, ``twice as wide`` is 2. What is compared is not looked at,
    but in which direction is.
    """
    text = _DASH_BETWEEN.sub(" ", " ".join(typed.split()).strip(" .!").casefold())
    share = _list_shares().get(text) or _list_shares().get(
        re.sub(r"^(?:a|an|one|ein|eine) ", "", text)
    )
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
    if not rest or _compile("growing").match(rest):
        return match["number"]
    return f"1/({match['number']})" if _compile("shrinking").match(rest) else ""


def is_shrinking(words: str) -> bool:
    """Whether a word says that something is the smaller one: ``shorter``."""
    shrinking = {*_load_factor_words()["shrinking"]}
    return any(word in shrinking for word in words.casefold().split())


@cache
def _split_multiples() -> list[tuple[str, str]]:
    """Return words that are a factor by themselves, longest first: ``twice``, ``vierfach``."""
    rows = [row.split(" ", 1) for row in _load_factor_words()["multiples"]]
    return sorted(((word, number) for number, word in rows), key=lambda row: -len(row[0]))


def _spell_out(text: str) -> str:
    """Return ``fourfold`` and ``viermal`` as ``4 fold`` and ``4 mal``, ``four times`` in digits."""
    for ending in ("fold", "fache", "fach", "mal"):
        head, found, rest = text.partition(ending)
        number = list_number_words().get(head.strip(" -")) if found else None
        if number is not None:
            return f"{number} {ending}{rest}"
    return replace_number_word(text)


@cache
def _compile_bound(bound: str) -> re.Pattern[str]:
    """Return the pattern of what stands before a number that is the most or the least."""
    words = sorted(_load_factor_words()[bound], key=len, reverse=True)
    signs = r"[≤⩽]|<=|\\leq?|±|\+/?-" if bound == "most" else r"[≥⩾]|>=|\\geq?"
    listed = "|".join(map(re.escape, words))
    return re.compile(rf"^(?:[^\W\d_]\w* ?)?(?:{signs})|^(?:{listed})(?![^\W\d_])", re.IGNORECASE)


def drop_bound(typed: str, bound: str) -> str:
    """Return ``at most 1.25 ms`` where the most is asked without its words; empty if without."""
    text = typed.strip()
    match = _compile_bound(bound).match(text)
    return text[match.end() :].strip() if match and match.end() < len(text) else ""


def find_bound(question: str) -> str:
    """Return whether a question asks what something is at most or at least; empty for neither."""
    asked = re.findall(r"[^.?!]*\?", question)
    question = " ".join(asked) or question
    for bound in ("most", "least"):
        words = "|".join(map(re.escape, _load_factor_words()[f"asking-{bound}"]))
        if re.search(
            rf"(?<![\w\u0980-\u09ff])(?:{words})(?![\w\u0980-\u09ff])", question, re.IGNORECASE
        ):
            return bound
    return ""
