"""Items that carry their names: ``u = 420; v = 290``."""

from __future__ import annotations

import re

from quizgen.grading.reading.source_map import SourceText
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.notation.names import fold_name

SIGNS = "\u0981-\u0983\u09bc\u09be-\u09cd\u09d7"
"""Signs of Bangla vowels and joined letters: parts of words that are no letters of their own."""

NAME = rf"[^\W\d_](?:[^\W_]|[{SIGNS}])*'*(?:_[^\W_]+'*)*"
"""A name as it is typed: ``u``, ``p'_x``, ``k_1``, ``মান``."""

_WORD = rf"(?:[^\W\d_]|[{SIGNS}]){{2,}}"
WORDS = rf"{_WORD}(?: {_WORD})+"
"""A name in several words: ``focal length``."""

_INSIDE = re.compile(r"[\s_.-]")
_NAME = re.compile(rf"([^\W\d][\w' ./{SIGNS}-]*?) ?(?::=|[=:≈]|->|→) ?")


def split_name(item: SourceText) -> tuple[str, SourceText]:
    """Split ``u = 420`` into the name and the rest; the name is empty if there is none."""
    match = _NAME.match(item.text)
    if match is None or match.end() == len(item.text):
        return "", item
    return match[1].strip(), item.slice(match.end())


def name_key(name: str) -> str:
    """Return the spelling that names are compared by."""
    return _INSIDE.sub("", fold_name(name))


def find_name(typed: str, names: list[str]) -> str:
    """Return the declared name that a typed one means (case counts only if it must), or ''."""
    for same in (name_key, lambda name: name_key(name).lower()):
        wanted = same(typed)
        found = [name for name in names if same(name) == wanted]
        if len(found) == 1:
            return found[0]
    return ""


def reorder_by_name(
    items: list[SourceText], names: list[str], error: FormulaReadError
) -> list[SourceText]:
    """Put named items into the declared order; items without names keep theirs.

    Raises
    ------
    FormulaReadError
        If a name is unknown, or used twice.
    """
    pairs = [split_name(item) for item in items]
    if not any(name for name, _ in pairs):
        return items
    if not names:
        return [rest for _, rest in pairs]
    placed: dict[str, SourceText] = {}
    for (typed, rest), item in zip(pairs, items, strict=True):
        name = find_name(typed, names)
        if not name or name in placed:
            code = "used-twice" if name else "unknown-name"
            raise FormulaReadError(code, item.column(0), typed, names)
        placed[name] = rest
    if len(placed) != len(names):
        raise error
    return [placed[name] for name in names]


_LEADING = re.compile(rf"(?:{NAME}|{WORDS}) ?(?:=|≈|:|:=) ?")


def drop_name(source: SourceText) -> SourceText:
    """Drop a leading ``u =``."""
    match = _LEADING.match(source.text)
    return source.slice(match.end()) if match and match.end() < len(source.text) else source
