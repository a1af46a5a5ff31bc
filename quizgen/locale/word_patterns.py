"""Words by which typed answers are read, of all languages at once, and patterns made of them.

They stand in ``answers.toml`` of each language, most of them in its table ``[reading]``. Somebody
may write German words in an English paper, so the words of every language hold in each.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

from quizgen.locale import cache_words, list_languages, load_words

_BLANK = re.compile("«([^»]+)»")
_NUMBER_BEFORE = re.compile(r"^[\d/]+ ")
_NOTHING = "(?!)"


@cache_words
def list_tables(table: str) -> tuple[dict[str, Any], ...]:
    """Return a table of ``answers.toml`` in each language."""
    return tuple(load_words(lang, "answers").get(table, {}) for lang in list_languages())


@cache_words
def list_words(name: str) -> tuple[str, ...]:
    """Return the words of a key in every language, the longest first.

    Parameters
    ----------
    name : str
        A key of ``[reading]``, another table and its key, ``factors.signs``, or a whole table whose
        keys are the words, ``functions.``.
    """
    table, _, key = name.rpartition(".")
    tables = list_tables(table or "reading")
    found = dict.fromkeys(word for own in tables for word in (own[key] if key else own))
    return tuple(sorted(found, key=len, reverse=True))


def list_rows(name: str) -> tuple[tuple[str, str], ...]:
    """Return the rows of a key in every language, parted at the first blank: 1000, thousand.

    A row without one is passed over; lint reports those of a bank.
    """
    parted = (row.partition(" ") for row in list_words(name))
    return tuple((before, behind) for before, _, behind in parted if behind)


@cache_words
def set_of_words(name: str) -> frozenset[str]:
    """Return the words of a key in every language, to look them up."""
    return frozenset(list_words(name))


def join_words(name: str) -> str:
    """Return the words of a key in every language as a group of a pattern.

    Of a row with a number before its word, ``1000 thousand``, the word stands in the pattern.
    """
    words = (_NUMBER_BEFORE.sub("", word) for word in list_words(name))
    listed = "|".join(map(re.escape, sorted(filter(None, words), key=len, reverse=True)))
    return f"(?:{listed})" if listed else _NOTHING


class WordPattern:
    """A regular expression in which ``«and»`` is any word that a language has under that name.

    Compiled when it is first used: most commands read no answer, and need no words for it. It has
    those methods of a compiled expression that readers use.

    Parameters
    ----------
    pattern : str
        The expression with the names of words, as ``list_words`` takes them, in ``«»``.
    flags : int
        As ``re.compile`` takes them.

    Examples
    --------
    >>> WordPattern(r" «and» ").split("3 und 4")
    ['3', '4']
    """

    def __init__(self, pattern: str, flags: int = 0) -> None:
        """Take the expression; nothing is read yet."""
        self.pattern, self.flags = pattern, flags
        self._compiled: Callable[[], re.Pattern[str]] = cache_words(self._compile)

    def _compile(self) -> re.Pattern[str]:
        """Return the expression with its words."""
        return re.compile(_BLANK.sub(lambda blank: join_words(blank[1]), self.pattern), self.flags)

    def search(self, text: str, start: int = 0) -> re.Match[str] | None:
        """Return the first match in a text."""
        return self._compiled().search(text, start)

    def match(self, text: str, start: int = 0) -> re.Match[str] | None:
        """Return the match at the start of a text."""
        return self._compiled().match(text, start)

    def fullmatch(self, text: str) -> re.Match[str] | None:
        """Return the match of a whole text."""
        return self._compiled().fullmatch(text)

    def finditer(self, text: str) -> Iterator[re.Match[str]]:
        """Yield all matches in a text."""
        return self._compiled().finditer(text)

    def findall(self, text: str) -> list[Any]:
        """Return what all matches hold."""
        return self._compiled().findall(text)

    def split(self, text: str) -> list[Any]:
        """Return the pieces of a text between matches."""
        return self._compiled().split(text)

    def sub(self, new: str | Callable[[re.Match[str]], str], text: str) -> str:
        """Return a text with something else in the place of each match."""
        return self._compiled().sub(new, text)
