"""Several values as people join them: ``10 -> 5``, ``from 10 mm to 5 mm``, ``[[1, 2], [3, 4]]``.

Each is written as the list with semicolons that ``read_list`` reads, if it has as many values as
are asked. What may be a fraction, a difference or a range by itself is split only where several
values are asked, so nothing that one number can mean is lost.

Among words that say whose they are, ``the first becomes 141, the second 56``, what stands beside a
number is looked through for the one name that it means: a word of the question, an ordinal, a
number behind a noun (``pixel 2``). Nothing is bound where two numbers claim one name, or where a
word denies or compares.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from quizgen.grading.reading.labels import SIGNS, AskedNames, find_name
from quizgen.locale import cache_words
from quizgen.locale.word_patterns import WordPattern, list_tables, set_of_words

_VALUE = r"[-+−]?(?:\d+(?:[.,]\d+)?|[.,]\d+)(?: ?/ ?\d+)?"
_NUMBER = re.compile(_VALUE)
_WHOLE = re.compile(
    rf"(?:{_VALUE}|√?\d+|\d*[¼-¾])(?: ?(?:[^\W\d_]|[%°µ/^²³])(?:[^\W\d_]|[\u0980-\u09ff²³/^])*)?"
)
_ARRAY = re.compile(
    r"(?:(?:np|numpy)\.)?(?:array|matrix)\((.+?)(?:, *dtype *=[^()]*)?\)", re.DOTALL
)
_NESTED = re.compile(r"([\[({]) *[\[({].*[\])}] *[\])}]|.*[\])}] *[,;\n]? *[\[({].*", re.DOTALL)
_LEADING = WordPattern(r"(?:«list-openers» |\d?«row-places» «rows»:? )", re.IGNORECASE)
_JOINTS = tuple(
    WordPattern(joint, re.IGNORECASE)
    for joint in (
        r" *(?:[-–—=]+>|[→⇒]) *",
        r",? +(?:«and» )?«then» +",
        r" +«versus» +",
        r" +(?:«and»|«and-in-latin») +",
        r" */ *",
    )
)
_TO = WordPattern(r" +«to» +", re.IGNORECASE)
_TO_BEHIND = WordPattern(r" +«to-behind»$", re.IGNORECASE)
_BETWEEN = re.compile(r" *[<≤] *[^\W\d_]\w* *[<≤] *")
_DASH = re.compile(r" +[-–—] +| *[–—] *")
_DASHES = re.compile(r" *[-–—] *")
_AROUND = re.compile(rf"({_VALUE}) *(?:±|\+/-|\+-) *({_VALUE})")
_EACH = WordPattern(
    rf"({_WHOLE.pattern}),? «each»|«both» ({_WHOLE.pattern})",
    re.IGNORECASE,
)
"""One value for all that is asked: ``50 each``."""
_PAIR = 2


def repeat_value(text: str, count: int) -> Iterator[str]:
    """Yield ``50; 50`` for ``both 50`` and ``50 each``."""
    alike = _EACH.fullmatch(text.rpartition("=")[2].strip(" ."))
    if alike and count >= _PAIR:
        yield "; ".join([alike[1] or alike[2]] * count)


def rejoin_values(text: str, count: int, *, ranges: bool = False) -> Iterator[str]:
    """Yield a typed text as a list with semicolons, if it joins ``count`` values otherwise.

    Parameters
    ----------
    text : str
        As it was typed, without what stands around it.
    count : int
        How many values are asked.
    ranges : bool
        Whether two of them may be given as from one to the other.

    Yields
    ------
    str
        The same values, in order.
    """
    if count < _PAIR:
        return
    array = _ARRAY.fullmatch(text)
    if array:
        text = array[1]
        yield text
    yield from _flatten_rows(text, count)
    text = _LEADING.sub("", text)
    for joint in _JOINTS:
        yield from _cut_at(joint, text, count)
    if count == _PAIR and ranges:
        yield from _cut_at(_TO, _TO_BEHIND.sub("", text), count)
        yield from _cut_at(_BETWEEN, text, count)
        yield from _cut_range(text)
    if count > _PAIR and not re.search(r"[;,\s]", text):
        yield from _cut_at(_DASHES, text, count)


def _flatten_rows(text: str, count: int) -> Iterator[str]:
    """Yield the numbers of nested brackets, or of rows below each other."""
    if not (_NESTED.fullmatch(text) or "\n" in text):
        return
    values = re.sub(r"[\[\](){};|]", " ", text).split()
    values = [piece for value in values for piece in value.split(",") if piece]
    if len(values) == count and all(map(_NUMBER.fullmatch, values)):
        yield "; ".join(values)


def _cut_at(joint: re.Pattern[str] | WordPattern, text: str, count: int) -> Iterator[str]:
    """Yield the pieces between joints, if each is one value."""
    pieces = [_LEADING.sub("", piece.strip()) for piece in joint.split(text)]
    if len(pieces) == count and all(map(_WHOLE.fullmatch, pieces)):
        yield "; ".join(pieces)


def _cut_range(text: str) -> Iterator[str]:
    """Yield both ends of a range that goes up, ``34.7 - 45.3`` or ``40 ± 5.3``.

    ``12 - 15.6`` may be the two values 12 and -15.6; only a dash that is no hyphen, or blanks on
    both sides of it, make it a range.
    """
    middle = _AROUND.fullmatch(text)
    if middle is not None and "/" not in text:
        yield f"{middle[1]} - {middle[2]}; {middle[1]} + {middle[2]}"
    ends = [piece.strip() for piece in _DASH.split(text)]
    if len(ends) == _PAIR and all(map(_WHOLE.fullmatch, ends)):
        low, high = (_NUMBER.match(end) for end in ends)
        if low and high and "/" not in text and _to_float(low[0]) < _to_float(high[0]):
            yield "; ".join(ends)


def _to_float(text: str) -> float:
    """Return a plain number with either decimal sign."""
    return float(text.replace(",", ".").replace("−", "-"))


NumberScan = Callable[[str], tuple[list[str], list[str]]]
"""From a text to the numbers in it, and the pieces of text around them."""

_LETTER = rf"(?:[^\W\d_]|[{SIGNS}])"
_NUMBERED = WordPattern(
    rf"({_LETTER}{{2,}}|[Pp](?=\d)) ?(\d)(?= ?[:=]|,? «becomes»(?!\w)"
    rf"|(?: {_LETTER}{{2,}})? [-+−]?\d)"
)
"""A noun with its number before a value, ``pixel 1: 141``."""
_NUMBERED_BEHIND = WordPattern(rf"«at» ({_LETTER}{{2,}}) (\d)(?= *(?:[,;)\n]|«and» |$))")
_COUNTED_OFF = re.compile(r"(?:(?<=[\s,;])|^)\(?(\d)(?:[.)]|:(?! *\d+ *:)) +(?=[-+−~≈]?[.,]?\d)")
_ASSIGNED = re.compile(r"[=:≈] *$")
_PARTED = WordPattern(r"[;\n]|,(?!\d)| / |,? (?:«and»|«with») ")
_WORDS = re.compile(rf"{_LETTER}+(?:'|_?\d|_{_LETTER}+)*(?![^\W_])|_\d")
_UNFINISHED = re.compile(r"[-+−*/^·×÷=] *(?:[;,\n]|$)")
"""A formula that somebody has not finished."""
_MARK = "_"
"""Before the number of a place, which is no value then."""
_MOST_WORDS = 6
_LONGEST_NAME = 3


@cache_words
def _list_ordinals() -> dict[str, str]:
    """Return the words for first, second, ... of every language, with their digits."""
    return {
        word: str(place)
        for table in list_tables("ordinals")
        for place, words in enumerate(table["counted"], 1)
        for word in words.split("|")
    }


def bind_values(text: str, names: AskedNames, scan: NumberScan) -> Iterator[str]:
    """Yield ``name = value; ...`` if every number of a text is said to be another asked value.

    Parameters
    ----------
    text : str
    names : sequence or mapping
        Names asked, maybe with the words by which the question calls them.
    scan : callable
        Finds the numbers of a text, each with its unit.
    """
    asked = list(names)
    if len(asked) < len(("one", "more")) or _UNFINISHED.search(text):
        return
    marked = _mark_ordinals(text)
    for labelled in _list_labelled(marked, len(asked), scan):
        bound = [_find_meant(words, names, asked) for _, words in labelled]
        placed = _complete(bound, [words for _, words in labelled], asked)
        if placed:
            yield "; ".join(
                f"{name} = {value}" for name, (value, _) in zip(placed, labelled, strict=True)
            )
            return


def _mark_ordinals(text: str) -> str:
    """Return the text with the number of each place marked: it is no value then."""
    text = _NUMBERED.sub(rf"\1 {_MARK}\2", text)
    text = _NUMBERED_BEHIND.sub(rf"for \1 {_MARK}\2", text)
    return _COUNTED_OFF.sub(rf"{_MARK}\1 ", text)


def _list_labelled(
    text: str, count: int, scan: NumberScan
) -> Iterator[list[tuple[str, list[str]]]]:
    """Yield each way to give every number the words beside it.

    In pieces between separators these are all of a piece; else those before it, or behind it.
    """
    pieces = [piece for piece in _PARTED.split(text) if piece and piece.strip()]
    scanned = [scan(piece) for piece in pieces]
    if any(_ASSIGNED.search(around[0]) and _list_words(around[-1]) for _, around in scanned):
        return  # a word behind ``S = 2`` says something about it
    if len(pieces) == count and all(len(found) == 1 for found, _ in scanned):
        yield [(found[0], _list_words(" ".join(around))) for found, around in scanned]
        yield [  # what was taken for a unit may be the name: ``2 bytes``
            (found[0], _list_words(" ".join([*around, *found[0].split(" ")[1:]])))
            for found, around in scanned
        ]
        return
    found, around = scan(text)
    if len(found) != count:
        return
    if _list_words(around[0]):
        yield [(value, _list_words(words)) for value, words in zip(found, around[:-1], strict=True)]
    else:
        yield [(value, _list_words(words)) for value, words in zip(found, around[1:], strict=True)]


def _list_words(text: str) -> list[str]:
    """Return the words of a piece of text in small letters, with the marks of ordinals."""
    return [word[0].lower() for word in _WORDS.finditer(text)]


def _find_meant(words: list[str], names: AskedNames, asked: list[str]) -> str | None:
    """Return the name that words mean, '' if none; None if several, or if they say otherwise."""
    if len(words) > _MOST_WORDS or {*words} & set_of_words("ordinals.refused"):
        return None
    found = set()
    for size in range(min(_LONGEST_NAME, len(words)), 0, -1):
        for start in range(len(words) - size + 1):
            said = " ".join(words[start : start + size])
            if said not in set_of_words("letters-as-words") or len(words) == 1:
                found.add(find_name(said, names))
        if found - {""}:
            break
    found |= {_find_by_place(word, names, asked) for word in words}
    found -= {""}
    strange = any(len(word) == 1 and word not in set_of_words("letters-as-words") for word in words)
    return None if len(found) > 1 or (strange and len(words) > 1) else next(iter(found), "")


def _find_by_place(word: str, names: AskedNames, asked: list[str]) -> str:
    """Return the name of an ordinal: by its index where the names have some, else by its place."""
    digit = word[1:] if word.startswith(_MARK) else _list_ordinals().get(word, "")
    if not digit:
        return ""
    indexed = find_name(digit, names)
    if indexed or any(name[-1:].isdigit() for name in asked):
        return indexed
    return asked[int(digit) - 1] if 0 < int(digit) <= len(asked) else ""


def _complete(bound: list[str | None], words: list[list[str]], asked: list[str]) -> list[str]:
    """Return the name of each value; the only one without a name gets the one that is left over.

    That is so where it stands in its place and its words are none of one letter, which would be a
    name that is not asked for. Nothing is returned where names are missing or meant twice.
    """
    named = [name for name in bound if name]
    if None in bound or len({*named}) < len(named) or len(named) < len(asked) - 1 or not named:
        return []
    if len(named) == len(asked):
        return [name for name in bound if name]
    place = bound.index("")
    left = next(name for name in asked if name not in named)
    short = any(
        len(word) < len("max") and word not in set_of_words("short-words") for word in words[place]
    )
    return [name or left for name in bound] if asked.index(left) == place and not short else []
