"""Splitting typed lists. A comma is a separator or a decimal sign, never both."""

from __future__ import annotations

import re
from collections.abc import Iterator

from quizgen.grading.reading.labels import NAME
from quizgen.grading.reading.normalise import LONGEST, LONGEST_PROSE, normalise_typed
from quizgen.grading.reading.source_map import SourceText
from quizgen.locale.word_patterns import WordPattern
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.notation.names import FUNCTIONS

BRACKETS = {"(": ")", "[": "]", "{": "}", "<": ">"}
_HARD = re.compile(r"[;|\n]")
_COMMA = re.compile(r",")
_COMMA_BLANK = re.compile(r", +")
_COMMA_DECIMAL = re.compile(
    rf"(?:{NAME} ?[=:≈] ?|[^\W\d_]{{3,}}(?: [^\W\d_]{{2,}}){{0,2}}[ =:]+)?"
    r"[-+−]?\d+(?:,\d+)?(?: ?[^\W\d][^\d,]*|%)?"
)
"""An item between commas with blanks, whose own comma is decimal: ``near 3,84 m``."""
_SLASH = re.compile(r" / ")
_BLANK_BEFORE = re.compile(r" +(?=[,;|])")
_JOINING = WordPattern(r"[,;]? (?:«and»|&) ")
_UNIT_BEHIND = re.compile(r"[^;,|\d(\[{]*| ?[\[(][^;,|\d\[\](){}]+[\])]")
_NAMES = re.compile(rf"\(? ?({NAME}(?: ?[,;|] ?{NAME})+) ?\)? ?(?::=|[=:≈]) ?(?=\S)")
_NAME_ENDS = re.compile("[,;|]")
_FRONT = re.compile(rf"({NAME})(?: {NAME})* ?(?::=|[=:≈])? ?(?=[(\[{{<])")
NAMED_NEXT = re.compile(
    rf"(?:[,;]? +|[,;])(?={NAME} ?(?::=|[=:≈]|->|→) ?\S)"
    rf"|[,;] *(?={NAME}(?:[ +-]{NAME}){{1,3}} ?(?::=|[=:≈]|->|→) ?\S)"
)
"""Where the next of several named values begins."""
_TORN = re.compile(r"\d+ +\d+(?<! \d{3})")
_SPACED = re.compile(r"(?<=[\d)%°A-Za-z]) +(?=[-+]?[\d.(])")


def read_list(typed: str, count: int | None, decimal: str) -> tuple[list[SourceText], SourceText]:
    """Return the items of a typed list, and what stood behind its closing bracket (a unit).

    Parameters
    ----------
    typed : str
        ``(320; 240)``, ``[1.5, 2.5]``, ``1,5 2,5``, one item per line, ...
    count : int or None
        How many items are expected; None for sets.
    decimal : str
        The learner's decimal sign.

    Raises
    ------
    FormulaReadError
        If commas separate and mark decimals at once, or the number of items is wrong.
    """
    plain = _plain_items(typed, count)
    if plain:
        return plain, _NOTHING
    source = normalise_separators(
        normalise_typed(re.sub(r"\r?\n", ";", typed[:LONGEST_PROSE].strip()))
    )
    names, source = split_prefix(source)
    source, tail = _strip_outer_brackets(source)
    items = _split_items(source, len(names) or count, decimal)
    if names:
        items = attach_names(names, items)
    if count is not None and len(items) != count:
        raise FormulaReadError("item-count", 1, str(len(items)), [str(count)])
    return items, tail


_EITHER_SIGN = re.compile(r"-?[0-9]+(?:[.,][0-9]+)?")
_POINT = re.compile(r"-?[0-9]+(?:\.[0-9]+)?")
_PLAIN = re.compile(
    rf"(\()?(?:{_EITHER_SIGN.pattern}(?:; ?{_EITHER_SIGN.pattern})+"
    rf"|({_POINT.pattern}(?:(?:, {_POINT.pattern})+|(?:,{_POINT.pattern})+)))(?(1)\))"
)
_NOTHING = SourceText("", ())


def _plain_items(typed: str, count: int | None) -> list[SourceText]:
    """Return the items of ``(1.5; 2)`` and ``1.5, 2``, which need no rewriting; else none."""
    match = _PLAIN.fullmatch(typed) if len(typed) <= LONGEST else None
    if match is None or (match[2] and count is None):
        return []
    items = [
        SourceText(item[0], tuple(range(item.start() + 1, item.end() + 1)))
        for item in (_POINT if match[2] else _EITHER_SIGN).finditer(typed)
    ]
    return items if count in {None, len(items)} else []


def normalise_separators(source: SourceText) -> SourceText:
    """Return a text without blanks before separators, and one in place of a joining word."""
    if " ," in source.text or " ;" in source.text or " |" in source.text:
        source = source.substitute(_BLANK_BEFORE, lambda _m: "")
    if source.text.count(" ") < 2:
        return source
    listed = ", " in source.text and not _HARD.search(source.text)
    return source.substitute(_JOINING, lambda _m: ", " if listed else "; ")


def split_prefix(source: SourceText) -> tuple[list[SourceText], SourceText]:
    """Return the names before a point and the rest: ``p' = (..)``, ``P(..)``, ``(u, v) = (..)``.

    Only the names of coordinates are returned; that of the whole point is dropped.
    """
    several = _NAMES.match(source.text)
    if several is not None:
        names = source.slice(several.start(1), several.end(1))
        return list(_split_at_separator(names, _NAME_ENDS)), source.slice(several.end())
    one = _FRONT.match(source.text)
    if one is None or one[1] in FUNCTIONS:
        return [], source
    rest = source.slice(one.end())
    return [], rest if strip_brackets(rest)[0] is not rest else source


def attach_names(names: list[SourceText], items: list[SourceText]) -> list[SourceText]:
    """Return the items, each with its name before it.

    Raises
    ------
    FormulaReadError
        If there are not as many.
    """
    if len(names) != len(items):
        raise FormulaReadError("item-count", 1, str(len(items)), [str(len(names))])
    return [
        SourceText(
            f"{name.text} = {item.text}", (*name.columns, *[item.column(0)] * 3, *item.columns)
        )
        for name, item in zip(names, items, strict=True)
    ]


def _strip_outer_brackets(source: SourceText) -> tuple[SourceText, SourceText]:
    """Return a text without all pairs of brackets around it, and what followed one of them."""
    inner, tail = strip_brackets(source)
    while True:
        again, behind = strip_brackets(inner)
        if again is inner or (tail.text and behind.text):
            return inner, tail
        inner, tail = again, behind if behind.text else tail


def strip_brackets(source: SourceText) -> tuple[SourceText, SourceText]:
    """Return a text without one pair of brackets around it, and what follows the pair.

    A text that no pair encloses is returned as it is.
    """
    close = BRACKETS.get(source.text[:1])
    if close is None:
        return source, source.slice(0, 0)
    end = _find_closing_bracket(source.text, close)
    if end < 0 or not _UNIT_BEHIND.fullmatch(source.text, end + 1):
        return source, source.slice(0, 0)
    return source.slice(1, end).strip(), source.slice(end + 1).strip()


def _find_closing_bracket(text: str, close: str) -> int:
    """Return the position of the bracket that closes the first character; -1 if none does."""
    depth = 0
    for position, character in enumerate(text):
        depth += (character == text[0]) - (character == close)
        if depth == 0:
            return position
    return -1


def _split_items(source: SourceText, count: int | None, decimal: str) -> list[SourceText]:
    """Return the items, cut at the strongest separator: semicolons, names, then blanks or commas.

    Raises
    ------
    FormulaReadError
        If commas separate and mark decimals at once, or an item is empty.
    """
    if _HARD.search(source.text):
        return [
            named
            for part in _split_at_separator(source, _HARD)
            for named in _split_at_separator(part, NAMED_NEXT)
        ]
    if "=" in source.text or ":" in source.text:
        named = list(_split_at_separator(source, NAMED_NEXT))
        if len(named) > 1 and (count is None or len(named) == count):
            return named
    slashed = source.text.split(" / ")
    if count == len(slashed) > 1 and all(map(str.strip, slashed)):
        return list(_split_at_separator(source, _SLASH))
    commas = source.text.count(",")
    if not commas:
        spaced = list(_split_at_separator(source, _SPACED))
        return spaced if count is None or len(spaced) == count else [source]
    if count == 1:
        return [source]
    return _by_commas(source, commas, count, decimal)


def _by_commas(
    source: SourceText, commas: int, count: int | None, decimal: str
) -> list[SourceText]:
    """Return the items of a list in which commas stand, as separators or as decimal signs.

    ``count`` decides where it can: as many commas as separators are needed, or as many pieces
    between blanks as items.

    Raises
    ------
    FormulaReadError
        ``comma-twice`` if both readings are possible.
    """
    spaced = list(_split_at_separator(source, re.compile(r",? +")))
    pieces = list(_split_at_separator(source, _COMMA_BLANK))
    plain = all(_COMMA_DECIMAL.fullmatch(piece.text) for piece in pieces)
    if plain and count == len(pieces) != commas + 1:
        return pieces  # 0,15, 0,14, 0,02
    if _mixed_commas(source.text):
        raise FormulaReadError("comma-twice", source.column(source.text.index(",")), source.text)
    if count is not None and commas + 1 == count:
        parts = list(_split_at_separator(source, _COMMA))
        torn = any(map(_TORN.fullmatch, (part.text for part in parts)))
        return spaced if torn and len(spaced) == count else parts
    if (
        len(spaced) > 1
        and not re.search(", ", source.text)
        and len(spaced) == (count or len(spaced))
    ):
        return spaced
    if decimal == "comma" and count is None:
        raise FormulaReadError("comma-twice", source.column(source.text.index(",")), source.text)
    return list(_split_at_separator(source, _COMMA))


def _mixed_commas(text: str) -> bool:
    """Return whether some commas stand between digits, others before a blank: ``1,5, 2,5``."""
    return bool(re.search(r"\d,\d", text) and re.search(r", ", text))


def _split_at_separator(source: SourceText, separator: re.Pattern[str]) -> Iterator[SourceText]:
    """Yield the pieces between separators outside brackets; empty ones at the end are dropped.

    Raises
    ------
    FormulaReadError
        If a piece before others is empty.
    """
    start, pieces = 0, []
    for match in separator.finditer(source.text):
        if bracket_depth(source.text, match.start()) == 0:
            pieces.append(source.slice(start, match.start()).strip())
            start = match.end()
    pieces.append(source.slice(start).strip())
    while pieces and not pieces[-1].text:
        pieces.pop()
    for piece in pieces:
        if not piece.text:
            raise FormulaReadError("empty-item", 1)
        yield piece


def bracket_depth(text: str, end: int) -> int:
    """Return how many brackets are open at a position."""
    before = text[:end]
    return sum(before.count(b) for b in "([{") - sum(before.count(b) for b in ")]}")
