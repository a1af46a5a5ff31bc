"""Numbers as people say them: ``2 to the 4``, ``eine 125stel Sekunde``, ``208, not 464``.

Each is rewritten in the signs that the other readers know. What could be another number is left
as it was typed, so that it is asked back.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.equalities import read_sides
from quizgen.grading.reading.factor_words import read_factor
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import read_unit
from quizgen.locale import cache_words
from quizgen.locale.word_patterns import WordPattern, list_words
from quizgen.maths.notation import FormulaReadError

_START, _END = r"(?<![\w\u0980-\u09ff])", r"(?![\w\u0980-\u09ff])"
_VALUE = r"[-+−]?[.,]?\d(?:[\d.,/' ]*\d)?(?: ?[^\W\d][^\d\s,;:()]{0,14}| ?[%‰])?"
_PLAIN = r"[-+−]?\d+(?:[.,]\d+)?"
_MOST_ERROR = 0.01
"""Relative error that a value may be said to have, and still be one value."""


_SHARE = WordPattern(
    r"(?<![\w./⁄])(?:«spoken.share-one» )?(\d+)(?: ?-?«spoken.share-endings»)(?![^\W\d_])",
    re.IGNORECASE,
)
_AND_A_HALF = WordPattern(rf"(?<![\d.,])(\d+) «spoken.and-a-half»{_END}", re.IGNORECASE)
_AND_A_SHARE = WordPattern(r"(?<![\d.,])(\d+) «and» (?=\d+ ?/ ?\d)", re.IGNORECASE)
_POWER = WordPattern(rf"(?<=[\d)]) «spoken.power» (?:(-|−)|(«minus») )?(\d+){_END}", re.IGNORECASE)
_TIMES_TEN = WordPattern(r"(?<=\d) «spoken.times-ten» (?=10 ?\^)", re.IGNORECASE)
_AMONG = WordPattern(r"(\d+) «spoken.among» (\d+)", re.IGNORECASE)
_TWICE = WordPattern(
    rf"({_VALUE})[, ]*\(?(?<=[ ,(])«spoken.restating»,? ({_VALUE})\)?", re.IGNORECASE
)
_FORMULA_TIMES = WordPattern(" «spoken.formula-times» ", re.IGNORECASE)
_FORMULA_OVER = WordPattern(" «spoken.formula-over» ", re.IGNORECASE)
_FORMULA_POWER = WordPattern(rf" «spoken.power» («minus» )?([\w./]+){_END}", re.IGNORECASE)
_FORMULA_ROOT = WordPattern(rf"{_START}«spoken.formula-root» ([^\W_]+){_END}", re.IGNORECASE)
_ELEMENT_OR = WordPattern(
    r",? «spoken.element-or» (?=[^\W\d_]\w{0,3} ?=|[-+−√.]?\d)", re.IGNORECASE
)
_UNDECIDED = WordPattern(rf"{_START}«spoken.undecided»{_END}", re.IGNORECASE)
_GIVING_LIST = WordPattern(
    rf".*\w.*{_START}«spoken.giving»:? (\([^()]+\)|\[[^\[\]]+\])", re.IGNORECASE
)
_ONWARD = WordPattern(r"[,;]? *«spoken.onward»,? (?=[^\W\d]\S* ?=)", re.IGNORECASE)
_LEADING = (
    WordPattern(
        rf"(.*\d.*){_START}«spoken.giving»:? ({_VALUE}(?: (?:[^\W\d]|[\u0980-\u09ff])+)?)",
        re.IGNORECASE,
    ),
    re.compile(rf"(?=[^=:;]*\d)(?=[^=:;]*[^\W\d])([^=:;]*): ({_VALUE})"),
    re.compile(rf"({_PLAIN}) ?(?:→|->|=>|⇒) ?({_VALUE})"),
    re.compile(rf"({_PLAIN} ?[<>] ?{_PLAIN}) ?(?:,|→|->|=>|⇒) ?(?:[\d+−*/ -]+= ?)?({_VALUE})"),
)


def write_spoken_value(text: str) -> str:
    """Return a number in words that mean a power, a share or a half in signs; else as it is."""
    text = _POINTLESS.sub("", _write_powers(text))
    text = drop_display(text)
    text = _IN_BASE.sub(lambda m: str(int(m[0], 0)), text)
    text = _SHARE.sub(r"1/\1", text)
    text = _AND_A_SHARE.sub(r"\1 ", _AND_A_HALF.sub(r"\1.5", text))
    halves = dict(row.split(" ", 1)[::-1] for row in list_words("spoken.halves"))
    return _write_share(_HALVES.sub(lambda m: halves[m[0].lower()], text))


_HALVES = WordPattern(rf"{_START}«spoken.halves»{_END}", re.IGNORECASE)


def drop_display(text: str) -> str:
    """Return a number without the call that shows it in a computer algebra system: ``4.09``."""
    before = ""
    while text != before:
        before, text = text, _DISPLAY.sub(r"\1", text)
    return text


_DISPLAY = re.compile(
    r"(?<!\w)(?:disp(?:lay)?[ds][pf]|remove_numerical_inert)\(([^(),\[\]{}]+)(?:, ?\d+)?\)"
)
"""``displaydp(4.09, 2)`` of STACK."""
_IN_BASE = re.compile(r"(?<![\w.])0(?:[xX][0-9a-fA-F]{1,12}|[bB][01]{1,32})(?!\w)")
_POINTLESS = re.compile(r"(?<=\S) *(?::-?\)+|;-?\)|:-?D|:P|\^\^|\\)$")
"""Smileys, and a stroke that a keyboard left behind."""


def _write_powers(text: str) -> str:
    """Return ``2 hoch 4`` as ``2^(4)``, ``3 mal 10 hoch minus 2`` as ``3*10^(-2)``."""
    text = _POWER.sub(lambda m: f"^({'-' if m[1] or m[2] else ''}{m[3]})", text)
    return _TIMES_TEN.sub("*", text)


def _write_share(text: str) -> str:
    """Return ``ein Drittel Blende`` as ``1/3 Blende``, and ``one fifth`` as ``1/5``."""
    if any(map(str.isdigit, text)):
        return text
    share = read_factor(text)
    if share.startswith("1/(") or "/" in share:
        return share.replace("(", "").replace(")", "")
    before, _, last = text.strip(" .").rpartition(" ")
    share = read_factor(before) if before else ""
    return f"{share} {last}" if "/" in share and "(" not in share and _is_unit(last) else text


def _is_unit(text: str) -> bool:
    """Return whether a text is a listed unit."""
    try:
        read_unit(text)
    except FormulaError:
        return False
    return True


def write_spoken_formula(text: str) -> str:
    """Return ``f times X over Z`` and ``root N`` in signs, and ``SQRT`` in small letters."""
    text = _FORMULA_TIMES.sub("*", text)
    text = _FORMULA_OVER.sub("/", text)
    text = _FORMULA_POWER.sub(lambda m: f"^({'-' if m[1] else ''}{m[2]})", text)
    text = _FORMULA_ROOT.sub(r"sqrt(\1)", text)
    text = re.sub(r"(?<![^\W_])sqrt ?\{([^{}]+)\}", r"sqrt(\1)", text)
    return _CAPITALS.sub(lambda m: m[0].lower(), text)


_CAPITALS = re.compile(r"(?<![^\W_])(?:SQRT|SIN|COS|TAN|EXP|LN|LOG|ABS)(?=\()")


def list_meant_values(text: str) -> Iterator[str]:
    """Yield the one value that a text with several numbers means.

    That is the one which another is said not to be, one that is said twice in other units or
    forms, or one with its error.
    """
    for shape in _list_contrasts():
        match = shape.fullmatch(text.strip(" .!"))
        if match:
            yield match["right"]
            return
    yield from _read_same_twice(text)
    around = _ERROR.fullmatch(text.strip())
    if around and _is_small_error(around):
        yield f"{around['value']} {around['unit'] or around['last'] or ''}".strip()
    parted = _PARTED_UNIT.fullmatch(text)
    if parted and _is_unit(parted[2]):
        yield f"{parted[1]} {parted[2]}"


_ERROR = re.compile(
    rf"\(?(?P<value>{_PLAIN}) ?(?P<unit>[^\W\d_]+(?:/[^\W\d_]+)?)? ?(?:±|\+ ?/? ?[-−]) ?"
    rf"(?P<error>\d+(?:[.,]\d+)?)\)? ?(?P<last>[^\W\d_]+(?:/[^\W\d_]+)?|[%°])?"
)
_PARTED_UNIT = re.compile(r"(.*\d)(?: ?[,;_] ?| ?[-–] ?)([^\W\d_][^\d\s]*|[%°])")


def _is_small_error(match: re.Match[str]) -> bool:
    """Return whether an error is small beside its value, and in the same unit."""
    value, error = (
        abs(float(match[part].replace(",", ".").replace("−", "-"))) for part in ("value", "error")
    )
    units = {match["unit"] or match["last"], match["last"] or match["unit"]}
    return error <= _MOST_ERROR * value and len(units) == 1


@cache_words
def _list_contrasts() -> tuple[re.Pattern[str], ...]:
    """Return the patterns of sentences that say which of two values is meant."""
    return tuple(
        re.compile(
            sentence.replace("{wrong}", f"(?:{_VALUE})").replace("{right}", f"(?P<right>{_VALUE})"),
            re.IGNORECASE,
        )
        for sentence in list_words("spoken.contrasts")
    )


def _read_same_twice(text: str) -> Iterator[str]:
    """Yield ``1/125 s = 8 ms`` for ``1/125 s or 8 ms``, if both are one value said differently."""
    match = _TWICE.fullmatch(text)
    if match is None or _form(match[1]) == _form(match[2]):
        return
    chain = f"{match[1].strip()} = {match[2].strip()}"
    try:
        read_sides(SourceText.of(chain), "auto")
    except FormulaReadError:
        return
    yield chain


def _form(value: str) -> tuple[bool, str]:
    """Return how a value is written: as a fraction or not, and with which unit."""
    return "/" in value, value.lstrip("-+−.,/' 0123456789").strip()


def separate_elements(typed: str) -> str:
    """Return ``1; 2`` for ``x = 1 or x = 2`` and ``x ∈ {1, 2}``: a set has all its elements."""
    text = _ELEMENT_OF.sub("", typed.strip())
    return _ELEMENT_OR.sub("; ", text)


_ELEMENT_OF = re.compile(r"^[^\W\d_] ?(?:(?:∈|\\in|in) ?(?=[{\[(])|(?:is|ist) (?=[-+−]?\d))")


def find_converted(text: str) -> str:
    """Return the last side of a chain that goes on in another kind of unit; empty if none does.

    ``10.53 µm ≈ 2.63 px`` converts by what the question gives, which cannot be compared.
    """
    *before, last = (side.strip() for side in re.split("[=≈]", text))
    units = [_UNIT_LAST.search(side) for side in (*before[-1:], last)]
    if len(units) < len(("before", "last")) or not all(units):
        return ""
    try:
        kinds = {read_unit(unit[1]).dimension for unit in units if unit}
    except FormulaError:
        return ""
    return last if len(kinds) > 1 else ""


_UNIT_LAST = re.compile(r"\d ?((?:[^\W\d]|[µ°%])[^\d\s]*)$")


def find_given_value(text: str) -> tuple[str, str]:
    """Return what a text says and the value it leads to: ``4 bits give 16``; empty if none."""
    for shape in _LEADING:
        match = shape.fullmatch(text)
        if match and not _UNDECIDED.search(match[1]):
            return match[1], match[2]
    return "", ""


def list_given_lists(text: str) -> Iterator[str]:
    """Yield the several values that a text leads to, and those with words before their names.

    ``this gives (0.9; 0.7)``, ``half each: 48 black, 48 white``, ``s = 7, then r = 2``.
    """
    listed = _GIVING_LIST.fullmatch(text)
    if listed:
        yield listed[1]
    behind = _BEHIND_COLON.fullmatch(text)
    if behind:
        yield behind[1]
    parted = _ONWARD.sub("; ", text)
    if parted != text:
        yield parted.removeprefix("; ")


_BEHIND_COLON = re.compile(r"(?=[^:\d]*\d[^:]*[^\W\d])[^:]*: ([^:]*\d[^:]*)")


def read_share(typed: str) -> str:
    """Return ``1/5`` for ``1 in 5`` and ``1 out of 5``; empty if it is none."""
    match = _AMONG.fullmatch(typed.strip(" ."))
    return f"{match[1]}/{match[2]}" if match and int(match[1]) < int(match[2]) else ""


def list_other_readings(typed: str) -> tuple[str, ...]:
    """Return what a number may mean that is read as a product or a difference.

    ``1.085*10-2`` and ``1.085x103`` may have an exponent that was not raised; the number in
    brackets of ``16 (17)`` may be a factor or another answer, and a range there a remark.
    """
    text = typed.strip(" .")
    lost, beside = _LOST.fullmatch(text), _BESIDE.fullmatch(text)
    if lost:
        head, sign, digits, unit = lost.groups()
        plain = f"({head}·10) − {digits}" if sign else f"({head})·10{digits}"
        power = f"{head}·10^{'-' if sign else ''}{digits}"
        return f"{plain}{unit}", f"{power}{unit}"
    if not beside:
        return ()
    value, low, high = beside["value"], beside["low"], beside["high"]
    if not high:
        return value, f"({value})·{low}"
    first, *ends = (float(part.replace(",", ".")) for part in (value, low, high))
    inside = min(ends) <= first <= max(ends)  # then it says how sure the value is
    return (value, f"({value})·({low} - {high})") if inside else (value,)


_BESIDE = re.compile(
    r"(?P<value>[-+−]?\d+(?:[.,]\d+)?) \((?P<low>\d+(?:[.,]\d+)?)"
    r"(?: ?(?:[-–]|\.{2,3}) ?(?P<high>\d+(?:[.,]\d+)?))?\)"
)
_LOST = re.compile(r"([-+−]?\d+(?:[.,]\d+)?) ?[*xX×·] ?10 ?([-−–]?) ?(\d{1,2})( ?[^\W\d_][^\d]*|)")
