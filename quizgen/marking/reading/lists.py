"""Splitting typed lists. A comma is a separator or a decimal sign, never both."""

from __future__ import annotations

import re
from collections.abc import Iterator

from quizgen.marking.reading.named import NAME
from quizgen.marking.reading.rewrites import LONGEST, LONGEST_PROSE, normalise
from quizgen.marking.reading.source import Source
from quizgen.maths.notation import ReadError
from quizgen.maths.notation.names import FUNCTIONS

BRACKETS = {"(": ")", "[": "]", "{": "}", "<": ">"}
_HARD = re.compile(r"[;|\n]")
_COMMA = re.compile(r",")
_BLANK_BEFORE = re.compile(r" +(?=[,;|])")
_JOINING = re.compile(r"[,;]? (?:and|und|&|এবং|ও) ")
_UNIT_BEHIND = re.compile(r"[^;,|\d(\[{]*| ?[\[(][^;,|\d\[\](){}]+[\])]")
_NAMES = re.compile(rf"\(? ?({NAME}(?: ?[,;|] ?{NAME})+) ?\)? ?(?::=|[=:≈]) ?(?=\S)")
_FRONT = re.compile(rf"({NAME})(?: {NAME})* ?(?::=|[=:≈])? ?(?=[(\[{{<])")
NAMED_NEXT = re.compile(rf"(?:[,;]? +|[,;])(?={NAME} ?(?::=|[=:≈]|->|→) ?\S)")
"""Where the next of several named values begins."""
_TORN = re.compile(r"\d+ +\d+(?<! \d{3})")
_SPACED = re.compile(r"(?<=[\d)%°A-Za-z]) +(?=[-+]?[\d.(])")


def read_list(typed: str, count: int | None, decimal: str) -> tuple[list[Source], Source]:
    """Split a typed list.

    Parameters
    ----------
    typed : str
        ``(320; 240)``, ``[1.5, 2.5]``, ``1,5 2,5``, one item per line, ...
    count : int or None
        How many items are expected; None for sets.
    decimal : str
        The learner's decimal sign.

    Returns
    -------
    list of Source, Source
        The items, and what stood behind the closing bracket (a unit).

    Raises
    ------
    ReadError
        If commas separate and mark decimals at once, or the number of items is wrong.
    """
    plain = _plain_items(typed, count)
    if plain:
        return plain, _NOTHING
    source = even(normalise(re.sub(r"\r?\n", ";", typed[:LONGEST_PROSE].strip())))
    names, source = fronted(source)
    source, tail = _opened(source)
    items = _items(source, len(names) or count, decimal)
    if names:
        items = with_names(names, items)
    if count is not None and len(items) != count:
        raise ReadError("item-count", 1, str(len(items)), [str(count)])
    return items, tail


_EITHER_SIGN = re.compile(r"-?[0-9]+(?:[.,][0-9]+)?")
_POINT = re.compile(r"-?[0-9]+(?:\.[0-9]+)?")
_PLAIN = re.compile(
    rf"(\()?(?:{_EITHER_SIGN.pattern}(?:; ?{_EITHER_SIGN.pattern})+"
    rf"|({_POINT.pattern}(?:(?:, {_POINT.pattern})+|(?:,{_POINT.pattern})+)))(?(1)\))"
)
_NOTHING = Source("", ())


def _plain_items(typed: str, count: int | None) -> list[Source]:
    """The items of ``(1.5; 2)`` and ``1.5, 2``, where nothing has to be rewritten; else none."""
    match = _PLAIN.fullmatch(typed) if len(typed) <= LONGEST else None
    if match is None or (match[2] and count is None):
        return []
    items = [
        Source(item[0], tuple(range(item.start() + 1, item.end() + 1)))
        for item in (_POINT if match[2] else _EITHER_SIGN).finditer(typed)
    ]
    return items if count in {None, len(items)} else []


def even(source: Source) -> Source:
    """Take away blanks before separators, and put one for a word that joins values."""
    if " ," in source.text or " ;" in source.text or " |" in source.text:
        source = source.sub(_BLANK_BEFORE, lambda _m: "")
    if source.text.count(" ") < 2:
        return source
    listed = ", " in source.text and not _HARD.search(source.text)
    return source.sub(_JOINING, lambda _m: ", " if listed else "; ")


def fronted(source: Source) -> tuple[list[str], Source]:
    """Cut off what stands before a point: ``p' = (..)``, ``P(..)``, ``(u, v) = (..)``.

    Returns
    -------
    list of str, Source
        The names of the coordinates, if they are given, and the rest.
    """
    several = _NAMES.match(source.text)
    if several is not None:
        names = [name.strip() for name in re.split("[,;|]", several[1])]
        return names, source.cut(several.end())
    one = _FRONT.match(source.text)
    if one is None or one[1] in FUNCTIONS:
        return [], source
    rest = source.cut(one.end())
    return [], rest if unbracketed(rest)[0] is not rest else source


def with_names(names: list[str], items: list[Source]) -> list[Source]:
    """Put each name before its value.

    Raises
    ------
    ReadError
        If there are not as many.
    """
    if len(names) != len(items):
        raise ReadError("item-count", 1, str(len(items)), [str(len(names))])
    return [
        Source(f"{name} = {item.text}", ((item.column(0),) * (len(name) + 3)) + item.columns)
        for name, item in zip(names, items, strict=True)
    ]


def _opened(source: Source) -> tuple[Source, Source]:
    """Remove all pairs of brackets around everything."""
    inner, tail = unbracketed(source)
    while True:
        again, behind = unbracketed(inner)
        if again is inner or (tail.text and behind.text):
            return inner, tail
        inner, tail = again, behind if behind.text else tail


def unbracketed(source: Source) -> tuple[Source, Source]:
    """Remove one pair of brackets around everything; what follows it is returned apart."""
    close = BRACKETS.get(source.text[:1])
    if close is None:
        return source, source.cut(0, 0)
    end = _closing(source.text, close)
    if end < 0 or not _UNIT_BEHIND.fullmatch(source.text, end + 1):
        return source, source.cut(0, 0)
    return source.cut(1, end).strip(), source.cut(end + 1).strip()


def _closing(text: str, close: str) -> int:
    depth = 0
    for position, character in enumerate(text):
        depth += (character == text[0]) - (character == close)
        if depth == 0:
            return position
    return -1


def _items(source: Source, count: int | None, decimal: str) -> list[Source]:
    if _HARD.search(source.text):
        return [named for part in _parts(source, _HARD) for named in _parts(part, NAMED_NEXT)]
    if "=" in source.text or ":" in source.text:
        named = list(_parts(source, NAMED_NEXT))
        if len(named) > 1 and (count is None or len(named) == count):
            return named
    commas = source.text.count(",")
    if not commas:
        spaced = list(_parts(source, _SPACED))
        return spaced if count is None or len(spaced) == count else [source]
    if count == 1:
        return [source]
    return _by_commas(source, commas, count, decimal)


def _by_commas(source: Source, commas: int, count: int | None, decimal: str) -> list[Source]:
    spaced = list(_parts(source, re.compile(r",? +")))
    if _mixed_commas(source.text):
        raise ReadError("comma-twice", source.column(source.text.index(",")), source.text)
    if count is not None and commas + 1 == count:
        parts = list(_parts(source, _COMMA))
        torn = any(map(_TORN.fullmatch, (part.text for part in parts)))
        return spaced if torn and len(spaced) == count else parts
    if (
        len(spaced) > 1
        and not re.search(", ", source.text)
        and len(spaced) == (count or len(spaced))
    ):
        return spaced
    if decimal == "comma" and count is None:
        raise ReadError("comma-twice", source.column(source.text.index(",")), source.text)
    return list(_parts(source, _COMMA))


def _mixed_commas(text: str) -> bool:
    """``1,5, 2,5``: some commas stand between digits, others before a blank."""
    return bool(re.search(r"\d,\d", text) and re.search(r", ", text))


def _parts(source: Source, separator: re.Pattern[str]) -> Iterator[Source]:
    """Cut at separators outside brackets; empty pieces at the ends are dropped."""
    start, pieces = 0, []
    for match in separator.finditer(source.text):
        if depth(source.text, match.start()) == 0:
            pieces.append(source.cut(start, match.start()).strip())
            start = match.end()
    pieces.append(source.cut(start).strip())
    while pieces and not pieces[-1].text:
        pieces.pop()
    for piece in pieces:
        if not piece.text:
            raise ReadError("empty-item", 1)
        yield piece


def depth(text: str, end: int) -> int:
    """Brackets that are open at a position."""
    before = text[:end]
    return sum(before.count(b) for b in "([{") - sum(before.count(b) for b in ")]}")
