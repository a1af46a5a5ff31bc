"""Words in another language than their file says: a translation that was never made."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from quizgen.bank.template import Template
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.errors import BankError
from quizgen.core.untrusted import read_text
from quizgen.locale import SHIPPED, get_language, list_languages

_NO_WORDS = re.compile(
    r"```.*?```|`[^`\n]*`|\$[^$]*\$|\{\{.*?\}\}|!\[[^\]\n]*\]\([^)\n]*\)|^#+ [a-z]+$"
    r"|^- [^:\n]*:(?=\s)",
    re.DOTALL | re.MULTILINE,
)
"""Programs, formulas, values, pictures, names of sections and of sentences."""
FEWEST, LEAST_SHARE = 2, 0.15
"""Common words of another language in a line that is in it, and their share: sentences have more,
and a line that only quotes one has fewer."""
QUOTED = 40


def find_foreign_words(template: Template) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each file of words with lines in another language.

    It looks at languages that quizgen speaks itself: of others it knows no words, and a file that
    it began in one of those has English words on purpose.
    """
    for lang in template.languages:
        if not (SHIPPED / lang).is_dir():
            continue
        file = template.path / f"{lang}.md"
        lines = _iter_lines(file)
        found = [(line, other) for line, words in lines if (other := _find_language(words, lang))]
        if found:
            line, other = found[0]
            text = read_text(file, BankError).splitlines()[line - 1].strip()
            said = f"{text[:QUOTED]!r}{'...' if len(text) > QUOTED else ''}"
            more = f", the first of {len(found)} such lines" if len(found) > 1 else ""
            name, own = (get_language(one).english for one in (other, lang))
            what = f"{said} is {name}, not {own}{more}"
            yield diagnose("QG220", file, what, line=line)


def _iter_lines(file: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield the number of each line and its words, in small letters."""
    text = read_text(file, BankError)
    bare = _NO_WORDS.sub(lambda found: re.sub(r"[^\n]+", " ", found[0]), text)
    for number, line in enumerate(bare.splitlines(), 1):
        yield number, [word.strip(".,;:!?()*_“”„\"'").lower() for word in line.split()]


def _find_language(words: list[str], lang: str) -> str:
    """Return the language that words are in if it is clearly not ``lang``; else empty."""
    own = {*get_language(lang).common}
    at_home = sum(word in own for word in words)
    for other in list_languages():
        strange = {*get_language(other).common} - own
        count = sum(word in strange for word in words)
        if other != lang and count >= max(FEWEST, LEAST_SHARE * len(words), at_home + 1):
            return other
    return ""
