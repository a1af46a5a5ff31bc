"""A text that remembers, for every character, the column it was typed in."""

from __future__ import annotations

import re
from collections.abc import Callable

import msgspec

from quizgen.locale.word_patterns import WordPattern

Rewrite = tuple[re.Pattern[str] | WordPattern, Callable[[re.Match[str]], str]]
"""What is looked for, and what stands in its place."""


class SourceText(msgspec.Struct, frozen=True):
    """A text and the column (from 1) each of its characters came from."""

    text: str
    columns: tuple[int, ...]

    @classmethod
    def of(cls, text: str) -> SourceText:
        """Return a typed text with its own columns."""
        return cls(text, tuple(range(1, len(text) + 1)))

    def column(self, position: int) -> int:
        """Return the column in the typed text of a position in the rewritten one."""
        if position < len(self.columns):
            return self.columns[position]
        return self.columns[-1] + 1 if self.columns else 1

    def slice(self, start: int, end: int | None = None) -> SourceText:
        """Return a part, with its columns."""
        return SourceText(self.text[start:end], self.columns[start:end])

    def substitute(
        self, pattern: re.Pattern[str] | WordPattern, new: Callable[[re.Match[str]], str]
    ) -> SourceText:
        """Return a text with matches replaced, each at the column where the match began."""
        if pattern.search(self.text) is None:
            return self
        text, columns, last = [], list[int](), 0
        for match in pattern.finditer(self.text):
            put = new(match)
            text += [self.text[last : match.start()], put]
            columns += self.columns[last : match.start()]
            columns += [self.column(match.start())] * len(put)
            last = match.end()
        return SourceText("".join([*text, self.text[last:]]), (*columns, *self.columns[last:]))

    def strip(self, characters: str = " ") -> SourceText:
        """Return a text without some characters at both ends."""
        if self.text[:1] not in characters and self.text[-1:] not in characters:
            return self
        left = len(self.text) - len(self.text.lstrip(characters))
        right = len(self.text.rstrip(characters))
        return self.slice(left, max(left, right))
