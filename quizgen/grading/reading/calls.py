"""Functions as people write them: ``cos^4 θ``, ``sin² x``, ``sqrt N``.

A power on the name belongs to the value, and an argument without brackets ends with its name or
number. What follows may belong to the argument as well (``cos θ sin θ``, ``cos x/2``, ``cos θ^4``):
such a text has two readings and is asked back.
"""

from __future__ import annotations

import re

from quizgen.grading.reading.source_map import SourceText
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.notation.names import FUNCTIONS, GREEK

MOST = 40
"""Most functions read in one formula."""

_GREEK = "".join(GREEK)
_PLAIN = "|".join(
    sorted((name for name, (_, most) in FUNCTIONS.items() if most == 1), key=len, reverse=True)
)
_CALL = re.compile(
    rf"(?<![^\W\d_])(?P<name>{_PLAIN})(?![^\W\d_{_GREEK}]) ?"
    r"(?:(?:\^|\*\*) ?(?:(?P<power>\d+)|\((?P<signed>-?\d+)\)|(?P<minus>-\d+)) ?)?"
    rf"(?P<bare>(?<= )(?:\d+(?:[.,]\d+)? ?)?[^\W\d]\w*'*|(?<= )\d+(?:[.,]\d+)?|\d*[{_GREEK}]\w*'*)?"
)
_GOES_ON = re.compile(r" ?(?:[\w({\[√|/:^°']|\*\*)")
_DEGREES = re.compile(r" ?°")


def add_call_brackets(source: SourceText, declared: frozenset[str]) -> SourceText:
    """Put brackets where only one reading exists.

    Raises
    ------
    ReadError
        If there are two.
    """
    start = 0
    for _ in range(MOST):
        match = _CALL.search(source.text, start)
        if match is None:
            break
        start = match.end("name")
        if match["name"] not in declared:
            source = _rewrite_call(source, match)
    return source


def _rewrite_call(source: SourceText, match: re.Match[str]) -> SourceText:
    power = match["power"] or match["signed"] or match["minus"]
    if power == "-1":
        raise FormulaReadError("two-readings", source.column(match.start()), match[0])
    if match["bare"]:
        return _bracket_bare_argument(source, match, power)
    if power and source.text[match.end() : match.end() + 1] == "(":
        end = _find_closing_bracket(source.text, match.end())
        if end:
            return _write_call(source, match, source.slice(match.end() + 1, end - 1), end, power)
    return source


def _bracket_bare_argument(
    source: SourceText, match: re.Match[str], power: str | None
) -> SourceText:
    end = match.end()
    degrees = _DEGREES.match(source.text, end)
    end = degrees.end() if degrees else end
    if match["bare"] in FUNCTIONS:
        return source
    if _GOES_ON.match(source.text, end):
        raise FormulaReadError("two-readings", source.column(match.start()), match[0])
    return _write_call(source, match, source.slice(match.start("bare"), end), end, power)


def _write_call(
    source: SourceText, match: re.Match[str], argument: SourceText, end: int, power: str | None
) -> SourceText:
    """``cos^4 θ`` becomes ``cos(θ)^(4)``."""
    behind = f")^({power})" if power else ")"
    at = source.column(match.start())
    text = f"{match['name']}({argument.text}{behind}"
    columns = (at,) * (len(match["name"]) + 1) + argument.columns + (at,) * len(behind)
    return SourceText(
        source.text[: match.start()] + text + source.text[end:],
        source.columns[: match.start()] + columns + source.columns[end:],
    )


def _find_closing_bracket(text: str, start: int) -> int:
    """Position behind the bracket that closes the one at a position; 0 if none does."""
    depth = 0
    for position in range(start, len(text)):
        depth += (text[position] == "(") - (text[position] == ")")
        if depth == 0:
            return position + 1
    return 0
