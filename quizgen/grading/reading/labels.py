"""Items that carry their names: ``u = 420; v = 290``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from quizgen.grading.judging.spelling import find_translation, fold_word
from quizgen.grading.reading.source_map import SourceText
from quizgen.locale import cache_words, list_languages, load_words
from quizgen.locale.word_patterns import set_of_words
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.notation.names import GREEK, fold_name

SIGNS = "\u0981-\u0983\u09bc\u09be-\u09cd\u09d7"
"""Signs of Bangla vowels and joined letters: parts of words that are no letters of their own."""

NAME = rf"[^\W\d_](?:[^\W_]|[{SIGNS}])*(?:'+\d*)?(?:_[^\W_]+'*)*"
"""A name as it is typed: ``u``, ``p'_x``, ``k_1``, ``মান``."""

_WORD = rf"(?:[^\W\d_]|[{SIGNS}]){{2,}}"
WORDS = rf"{_WORD}(?: {_WORD})+"
"""A name in several words: ``focal length``."""

AskedNames: TypeAlias = Sequence[str] | Mapping[str, Sequence[str]]
"""Names of the values asked, maybe each with the words by which the question calls it."""

_INSIDE = re.compile(r"[\s_.-]")
_NAME = re.compile(rf"([^\W\d][\w' ./{SIGNS}-]*?) ?(?::=|[=:≈]|->|→) ?")


def split_name(item: SourceText) -> tuple[str, SourceText]:
    """Return the name and the rest of ``u = 420``; the name is empty if there is none."""
    match = _NAME.match(item.text)
    if match is None or match.end() == len(item.text):
        return "", item
    return match[1].strip(), item.slice(match.end())


def put_names_first(typed: str, names: AskedNames) -> str:
    """Return ``v = 700; u = 576`` for ``700 = v; 576 = u``, if all of it is written so."""
    if "=" not in typed:
        return typed
    pieces = [_NAME_LAST.fullmatch(piece.strip()) for piece in re.split(r"[;\n]|,(?!\d)", typed)]
    found = [piece for piece in pieces if piece]
    if len(found) < len(pieces) or not all(find_name(piece[2], names) for piece in found):
        return typed
    return "; ".join(f"{piece[2]} = {piece[1]}" for piece in found)


_NAME_LAST = re.compile(rf"([-+−]?\d[^=:;]*?) ?= ?({NAME})")


def name_key(name: str) -> str:
    """Return the spelling that names are compared by."""
    return _INSIDE.sub("", fold_name(name))


def _prime_last(name: str) -> str:
    """Return the spelling by which a prime may stand before or behind an index: ``px'``."""
    key = name_key(name).lower()
    return key.replace("'", "") + "'" * key.count("'")


@cache_words
def _letters_of_words() -> dict[str, str]:
    """Return the letters that a word may stand for, from every language.

    A learner at a German university writes any of them in an English paper.
    """
    found: dict[str, str] = {}
    for lang in list_languages():
        for word, letters in load_words(lang, "answers")["letters"].items():
            found[word] = "".join(sorted({*found.get(word, ""), *letters}))
    return found


@cache_words
def _same_labels() -> tuple[frozenset[str], ...]:
    """Return the words that are one label in several languages: before, vorher, আগে."""
    found: dict[str, set[str]] = {}
    for lang in list_languages():
        for label, words in load_words(lang, "answers")["labels"].items():
            found.setdefault(label, set()).update(words)
    return tuple(map(frozenset, found.values()))


_SHORTENED = re.compile(r"([^\W_]+)('*)(?:_(.+))?")


_PIXEL_AXES = {"x": "u", "y": "v"}
"""What the axes of a picture are called where pixels are asked as u and v."""


def find_name(typed: str, names: AskedNames) -> str:
    """Return the declared name that a typed one means, or '' if it means none or several.

    Case counts only if it must. Where the names differ in their letter or in their index alone,
    that is enough (``x`` for ``p'_x``, ``u`` for ``u_A``), and so is the word for it (``red``), or
    what the question calls it (``levels`` where it asks for the levels n).
    """
    for same in (name_key, lambda name: name_key(name).lower(), _prime_last):
        wanted = same(typed)
        found = [name for name in names if same(name) == wanted]
        if len(found) == 1:
            return found[0]
    short = typed.strip().lower()
    for words in _same_labels():
        if short in words and (found := [name for name in names if name.lower() in words]):
            return _find_unique(found)
    if {*names} == {*_PIXEL_AXES.values()}:
        short = _PIXEL_AXES.get(short, short)
    return (
        _find_short_name(short, names)
        or _find_unique(
            _find_short_name(letter, names) for letter in _letters_of_words().get(short, "")
        )
        or _find_called_name(short, names)
    )


def _find_called_name(typed: str, names: AskedNames) -> str:
    """Return the one name whose words in the question hold all of a typed label.

    A Greek letter may be called by its first Latin one, where no other name has it.
    """
    greek = [name for name in names if fold_name(name).lower() in GREEK.values()]
    if len(typed) == 1 and greek:
        return _find_unique(name for name in greek if fold_name(name).lower().startswith(typed))
    if not isinstance(names, Mapping):
        return ""
    same = next((words for words in _same_labels() if typed in words), {typed})
    same = {*same, *find_translation(typed)}
    fitting = [
        name
        for name, called in names.items()
        if any(_is_held_by(word, words) for word in same for words in called)
    ]
    return _find_unique(fitting)


def _is_held_by(label: str, words: str) -> bool:
    """Return whether all words of a label stand among others."""
    wanted, known = {*_split_label(label)}, _split_label(words)
    if len(wanted) == 1 and len(label) >= LEAST_SHORTENED:  # ``sat`` is the saturation
        return any(word.startswith(one) for one in wanted for word in known)
    return bool(wanted) and wanted <= {*known}


LEAST_SHORTENED = 3
"""Letters of a word that are enough of it."""


def _split_label(text: str) -> list[str]:
    """Return the words of a label, without what every label may have."""
    words = [fold_word(word).removesuffix("s") for word in re.split(r"[\s/-]+", text)]
    return [word for word in words if word and word not in set_of_words("label-fillers")] or words


def _find_short_name(typed: str, names: AskedNames) -> str:
    """Return the one name whose letter, or whose index, is ``typed``, where all differ in it."""
    split = [_SHORTENED.fullmatch(name.lower()) for name in names]
    if typed.endswith("'") and all(match and typed.endswith(match[2]) for match in split):
        typed = typed.rstrip("'")  # x' for the index of p'_x, where all have the prime
    found = []
    for group in (1, 3):
        parts = [match[group] if match else None for match in split]
        if None not in parts and len(set(parts)) == len(names) and typed in parts:
            found.append([*names][parts.index(typed)])
    return _find_unique(found)


def _find_unique(found: Iterable[str]) -> str:
    """Return the only name among some, '' if there are none or several."""
    several = {name for name in found if name}
    return several.pop() if len(several) == 1 else ""


def place_by_name(items: list[SourceText], names: AskedNames) -> dict[str, SourceText] | None:
    """Return each value under the declared name it carries; None if no item carries a name.

    Raises
    ------
    FormulaReadError
        If a name is not asked for, or used twice.
    """
    pairs = [split_name(item) for item in items]
    if not any(name for name, _ in pairs):
        return None
    placed: dict[str, SourceText] = {}
    for (typed, rest), item in zip(pairs, items, strict=True):
        name = find_name(typed, names)
        if not name or name in placed:
            code = "used-twice" if name else "unknown-name"
            raise FormulaReadError(code, item.column(0), typed, list(names))
        placed[name] = rest
    return placed


def reorder_by_name(items: list[SourceText], names: AskedNames) -> list[SourceText]:
    """Return the values in the declared order; items without names keep theirs.

    Raises
    ------
    FormulaReadError
        If a name is not asked for or used twice, or one is missing.
    """
    if not names:
        return [rest for _, rest in map(split_name, items)]
    placed = place_by_name(items, names)
    if placed is None:
        return items
    if len(placed) != len(names):
        raise FormulaReadError("item-count", 1, str(len(placed)), [str(len(names))])
    return [placed[name] for name in names]


def are_counted_off(items: list[SourceText]) -> bool:
    """Return whether the names of values only count them off: x, y, z; S1, S2, S3."""
    names = [split_name(item)[0] for item in items]
    last = "".join(name[-1:] for name in names)
    alike = all(names) and len({name[:-1] for name in names}) == 1
    return alike and any(counted.startswith(last) for counted in ("xyz", "123456789"))


_LEADING = re.compile(rf"(?:{NAME}|{WORDS}) ?(?:=|≈|:|:=) ?")


def drop_name(source: SourceText) -> SourceText:
    """Return a text without a leading ``u =``."""
    match = _LEADING.match(source.text)
    return source.slice(match.end()) if match and match.end() < len(source.text) else source
