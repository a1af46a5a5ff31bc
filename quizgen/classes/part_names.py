"""What people call the parts of a paper in their tables: ``Q7a``, ``Frage 7 b``, ``7.C``."""

from __future__ import annotations

import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping

from quizgen.core.errors import KeyFileError
from quizgen.grading.echo import safe_echo
from quizgen.locale.word_patterns import WordPattern

_NAME = WordPattern(r"\W*(?:«part»\W*)?(\d{1,4})[\W_]*([a-z]*)\W*")


class PartNames:
    """Finds the part that a name means: whatever its case, its blanks, and what stands before it.

    Parameters
    ----------
    parts : iterable of str
        Those of one paper, such as ``7a``, and ``13`` where a question has but one.
    """

    def __init__(self, parts: Iterable[str]) -> None:
        self._parts = {_fold(part): part for part in parts}
        numbers = Counter(number for number, _ in self._parts)
        self._sole = {n: part for (n, _), part in self._parts.items() if numbers[n] == 1}

    def find(self, name: str) -> str:
        """Return the part; empty if the paper has none that could be meant.

        The only part of a question is meant by its number, and by ``a`` after it, too.
        """
        number, label = _fold(name)
        found = self._parts.get((number, label), "")
        return found or (self._sole.get(number, "") if label in {"", "a"} else "")

    def sort_answers(self, typed: Mapping[str, str]) -> tuple[dict[str, str], list[str]]:
        """Return the answers by part, and the names that mean none.

        Raises
        ------
        KeyFileError
            If two names mean one part.
        """
        found: dict[str, str] = {}
        names: dict[str, str] = {}
        unknown = []
        for name, text in typed.items():
            part = self.find(name)
            if not part:
                unknown.append(name)
            elif part in names:
                raise KeyFileError(
                    f"{safe_echo(names[part])} and {safe_echo(name)} are both part {part}"
                )
            else:
                found[part], names[part] = text, name
        return found, unknown


def _fold(name: str) -> tuple[str, str]:
    """Return number and letter of a part; the whole name and nothing if it is no such name."""
    text = unicodedata.normalize("NFKC", name).casefold().strip()
    found = _NAME.fullmatch(text)
    return (str(int(found[1])), found[2]) if found else (text, "")
