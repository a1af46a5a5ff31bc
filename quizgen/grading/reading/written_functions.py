"""Factorials, roots, logarithms as people write them: ``(n+1)!``, ``root(x, 3)``, ``lg(x, 3)``."""

from __future__ import annotations

import re

from quizgen.grading.reading.source_map import SourceText
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.notation.names import FUNCTIONS, spellings

MOST = 40
"""Most signs and calls rewritten in one formula."""

_FACTORIAL = re.compile(r"(?<=[\w')])!(?![!=])")
_LAST_WORD = re.compile(r"(?:\d+|[^\W\d_][\w']*)$")
_CALL = re.compile(
    r"(?<![^\W_])(?P<name>root|cbrt|cosech|csch|sech|coth|log10|log2|log|ln) ?(?=\()"
)
_LOGS = frozenset({"log10", "log2", "log", "ln"})
_RECIPROCALS = {"cosech": "sinh", "csch": "sinh", "sech": "cosh", "coth": "tanh"}


def write_factorials(
    source: SourceText, declared: frozenset[str], *, emphatic: bool = True
) -> SourceText:
    """Return the text with ``n!`` as ``factorial(n)``, where one operand stands before the sign.

    Any other sign stays, and cannot be read: ``ab!`` is two things. Where formulas have no
    factorials an ``emphatic`` sign at the end, which is the only one, is none either.
    """
    if emphatic and source.text.find("!") == len(source.text.rstrip()) - 1:
        return source
    for _ in range(MOST):
        sign = _FACTORIAL.search(source.text)
        if sign is None:
            break
        start = _find_operand(source.text[: sign.start()], declared)
        if start is None:
            break
        source = _replace(
            source, start, sign.end(), f"factorial({source.text[start : sign.start()]})"
        )
    return source


def _find_operand(text: str, declared: frozenset[str]) -> int | None:
    """Return where the operand at the end of a text begins; None if it is not a single one."""
    if text.endswith(")"):
        return _find_opening_bracket(text)
    word = _LAST_WORD.search(text)
    if word is None or text[: word.start()].endswith((".", ",")):
        return None
    known = word[0].isdigit() or word[0] in spellings(declared)
    return word.start() if known else None


def _find_opening_bracket(text: str) -> int | None:
    """Return where the bracket at the end was opened, or the function's name in front of it."""
    depth = 0
    for position in range(len(text) - 1, -1, -1):
        depth += (text[position] == ")") - (text[position] == "(")
        if depth == 0:
            name = _LAST_WORD.search(text[:position])
            return name.start() if name and name[0] in FUNCTIONS else position
    return None


def write_roots_and_logs(source: SourceText, declared: frozenset[str], decimal: str) -> SourceText:
    """Return the text with ``root(x, n)`` and ``cbrt(x)`` as powers, ``sech(x)`` as a quotient.

    Raises
    ------
    FormulaReadError
        ``two-readings`` for a logarithm of two things, whose base stands first in some programs and
        last in others; and for a root of ``8,3``.
    """
    start = 0
    for _ in range(MOST):
        call = _CALL.search(source.text, start)
        if call is None:
            break
        start = call.end("name")
        end = find_closing_bracket(source.text, call.end())
        if end and call["name"] not in declared:
            inside = source.text[call.end() + 1 : end - 1]
            arguments = _split_arguments(inside, decimal)
            if call["name"] == "root" and len(_split_arguments(inside, "point")) > len(arguments):
                raise FormulaReadError("two-readings", source.column(call.start()), call[0])
            written = _write_out(call["name"], arguments, source.column(call.start()))
            source = _replace(source, call.start(), end, written) if written else source
    return source


def _write_out(name: str, arguments: list[str], column: int) -> str:
    """Return a call as a power or quotient; nothing for a logarithm of one thing.

    Raises
    ------
    FormulaReadError
        ``two-readings`` for a logarithm of two.
    """
    if name in _LOGS:
        if len(arguments) == 2:
            first, second = arguments
            readings = [f"ln({first})/ln({second})", f"ln({second})/ln({first})"]
            raise FormulaReadError("two-readings", column, "", readings)
        return ""
    if name == "root" and len(arguments) == 2:
        return f"(({arguments[0]})^(1/({arguments[1]})))"
    if len(arguments) != 1:
        return ""
    if name in _RECIPROCALS:
        return f"(1/{_RECIPROCALS[name]}({arguments[0]}))"
    return f"sqrt({arguments[0]})" if name == "root" else f"(({arguments[0]})^(1/3))"


def _split_arguments(inside: str, decimal: str) -> list[str]:
    """Return what stands between the outer commas of a call, which are not decimal signs."""
    pieces, depth, last = [], 0, 0
    for position, sign in enumerate(inside):
        depth += (sign == "(") - (sign == ")")
        if depth or sign not in {",", ";"}:
            continue
        between = re.match(r"\d,\d", inside[max(0, position - 1) :]) is not None
        if between and (decimal == "comma" or (decimal == "auto" and "." not in inside)):
            continue
        pieces.append(inside[last:position].strip())
        last = position + 1
    return [*pieces, inside[last:].strip()]


def find_closing_bracket(text: str, start: int) -> int:
    """Return the position behind the bracket that closes the one at ``start``; 0 if none does."""
    depth = 0
    for position in range(start, len(text)):
        depth += (text[position] == "(") - (text[position] == ")")
        if depth == 0:
            return position + 1
    return 0


def _replace(source: SourceText, start: int, end: int, text: str) -> SourceText:
    """Return a text with one part replaced, at the column where that part began."""
    columns = (source.column(start),) * len(text)
    return SourceText(
        source.text[:start] + text + source.text[end:],
        source.columns[:start] + columns + source.columns[end:],
    )
