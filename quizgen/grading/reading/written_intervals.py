r"""Intervals as people write them: ``x > 0 and x <= 1``, ``1 ≥ x > 0``, ``R \ (4; 14)``.

Each is written as the chains and brackets that the kind reads. ``0 to 1`` stays as it is: whether
its ends belong to it is what is asked.
"""

from __future__ import annotations

import re

from quizgen.grading.reading.normalise import LONGEST
from quizgen.locale.word_patterns import WordPattern

_NAME = r"(?!inf|oo)[^\W\d_]\w*"
_BOUND = r"[^<>≤≥=,;|&∧()\[\]]+?"
_LESS, _MORE = r"(?:<=|<|≤)", r"(?:>=|>|≥)"
_BUILDER = re.compile(rf"\{{ ?{_NAME} ?(?:(?:∈|\\in|in) ?[ℝRQ] ?)?[|:] ?(.+?) ?\}}")
_FALLING = re.compile(
    rf"(?P<high>{_BOUND}) ?(?P<first>{_MORE}) ?(?P<name>{_NAME})"
    rf" ?(?P<second>{_MORE}) ?(?P<low>{_BOUND})"
)
_ABOVE, _BELOW = (
    re.compile(
        rf"{_NAME} ?(?P<sign>{sign}) ?(?P<bound>{_BOUND})"
        rf"|(?P<bound2>{_BOUND}) ?(?P<sign2>{turned}) ?{_NAME}"
    )
    for sign, turned in ((_MORE, _LESS), (_LESS, _MORE))
)
_BOTH = WordPattern(r" «and» | ?(?:&&?|∧) ?|[;,] (?=\D)", re.IGNORECASE)
_BEHIND = WordPattern(" «spoken.interval-behind»$", re.IGNORECASE)
_BUT = WordPattern(r"«spoken.everything-but» (.+)", re.IGNORECASE)
_WITHOUT = re.compile(r"[Rℝ] ?(?:\\setminus|\\\\|\\|−|-) ?(?=[\[\](])")
_PIECE = re.compile(
    rf"(?P<left>[\[\](]) ?(?P<low>{_BOUND}) ?[;,] ?(?P<high>{_BOUND}) ?(?P<right>[\])\[])"
    rf"|(?P<low2>{_BOUND}) ?(?P<from>{_LESS}) ?{_NAME} ?(?P<to>{_LESS}) ?(?P<high2>{_BOUND})"
)
_END = r"[-+−]?(?:\d+(?:[.,/]\d+)?|∞)"
_IN_WORDS = WordPattern(
    rf"(?:«spoken.interval-all» )?(?:«spoken.interval-from» )?(?P<low>{_END})"
    r"(?: ?\(?(?P<first>(?P<in1>«spoken.inclusive»)|«spoken.exclusive»)\)?)?"
    r",? «spoken.interval-to» "
    r"(?:(?P<before>(?P<in2>«spoken.inclusive»)|«spoken.exclusive») )?"
    rf"(?P<high>{_END})"
    r"(?:,? ?\(?(?P<last>(?P<in3>«spoken.inclusive»)|«spoken.exclusive»)\)?)?",
    re.IGNORECASE,
)


def write_interval(typed: str) -> str:
    """Return an interval in words, or of two conditions, as a chain or in brackets.

    Anything else is returned as it is, and so is what is too long to be read as numbers.
    """
    if len(typed) > LONGEST:
        return typed
    text = re.sub(r"= ?<|< =", "<=", re.sub(r"> =", ">=", typed.strip()))
    text = _BEHIND.sub("", text)
    builder = _BUILDER.fullmatch(text)
    text = builder[1] if builder else text
    falling = _FALLING.fullmatch(text)
    if falling:
        first, second = (
            falling[part].replace(">", "<").replace("≥", "≤") for part in ("first", "second")
        )
        return f"{falling['low']} {second} {falling['name']} {first} {falling['high']}"
    return _join_conditions(text) or _turn_inside_out(text) or _read_words(text) or text


def _join_conditions(text: str) -> str:
    """Return ``0 < x <= 1`` for both of its conditions; a union where they exclude each other."""
    parts = [part.strip() for part in _BOTH.split(text)]
    if len(parts) != len(("low", "high")):
        return ""
    for one, other in (parts, parts[::-1]):
        above, below = _ABOVE.fullmatch(one), _BELOW.fullmatch(other)
        if above and below:
            low, high = (match["bound"] or match["bound2"] for match in (above, below))
            if _is_above(low, high) and re.search("[,;]", text):
                return f"{one} or {other}"
            more, less = (match["sign"] or match["sign2"] for match in (above, below))
            return f"{low} {_less_than(more)} x {_less_than(less)} {high}"
    return ""


def _less_than(sign: str) -> str:
    """Return the sign of a rising chain that has its bound as another sign has it."""
    return "<=" if sign[-1] in "=≥≤" else "<"


def _is_above(low: str, high: str) -> bool:
    """Return whether a lower bound is above an upper one, as far as both are plain numbers."""
    try:
        first, second = (float(one.replace(",", ".").replace("−", "-")) for one in (low, high))
    except ValueError:
        return False
    return first > second


def _turn_inside_out(text: str) -> str:
    r"""Return what is left over by ``R \ (4; 14)`` and ``everything except 4 < x < 14``."""
    taken = _WITHOUT.sub("", text) if _WITHOUT.match(text) else ""
    taken = taken or _BUT.sub(r"\1", text)
    piece = _PIECE.fullmatch(taken) if taken != text else None
    if piece is None:
        return ""
    low, high = piece["low"] or piece["low2"], piece["high"] or piece["high2"]
    with_low = piece["left"] == "[" or piece["from"] in {"<=", "≤"}
    with_high = piece["right"] == "]" or piece["to"] in {"<=", "≤"}
    return f"]-inf; {low}{'[' if with_low else ']'} or {']' if with_high else '['}{high}; inf["


def _read_words(text: str) -> str:
    """Return ``[-1; 5]`` for ``from -1 to 5 inclusive``; empty if nothing is said of its ends."""
    match = _IN_WORDS.fullmatch(text)
    if match is None:
        return ""
    last, with_high = match["before"] or match["last"], match["in2"] or match["in3"]
    # One word behind the last end is about both.
    first, with_low = (match["first"], match["in1"]) if match["first"] else (last, with_high)
    if not (first and last):
        return ""
    return f"{'[' if with_low else ']'}{match['low']}; {match['high']}{']' if with_high else '['}"
