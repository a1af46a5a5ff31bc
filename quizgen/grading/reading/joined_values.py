"""Several values as people join them: ``10 -> 5``, ``from 10 mm to 5 mm``, ``[[1, 2], [3, 4]]``.

Each is written as the list with semicolons that ``read_list`` reads, if it has as many values as
are asked. What may be a fraction, a difference or a range by itself is split only where several
values are asked, so nothing that one number can mean is lost.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from quizgen.locale.word_patterns import WordPattern

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
    alike = _EACH.fullmatch(text.strip(" ."))
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
        yield from _cut_at(_TO, text, count)
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
