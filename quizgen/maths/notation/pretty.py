"""How numbers, names and formulas are written for people: decided here, for every output.

What comes in is what programs write (``-1228800``, ``2.2e-41``, ``p'_x``, ``f*X/Z``); what goes out
is plain Unicode (``−1 228 800``, ``2.2·10⁻⁴¹``, ``p′ₓ``, ``f·X/Z``), which is read back when it is
typed. Layouts take the same groups of digits and the same powers of ten. Program text, codes,
seeds and stored keys never pass through here.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable
from functools import lru_cache

from quizgen.maths.notation.names import FUNCTIONS, GREEK, KEYWORDS

_PLAIN_SIGNS, _RAISED_SIGNS = "+-0123456789", "⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹"

RAISED = str.maketrans(_PLAIN_SIGNS, _RAISED_SIGNS)
"""Signs and digits to superscripts: ``text.translate(RAISED)``."""

LOWERED = str.maketrans(_RAISED_SIGNS, _PLAIN_SIGNS)
"""Superscripts back to signs and digits."""

GAP = "\u202f"
"""Between groups of three digits: narrow, and no line ends at it."""
MINUS = "\u2212"
LONGEST_UNGROUPED = 4
"""Digits up to which a number has no groups: ``1024`` is read at a glance, and so is a year."""
SMALLEST_ZEROS = 4
"""Noughts behind the point from which a small number is written with a power of ten."""

_RAISED = "[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+"
_DIGITS = r"\d+(?:\.\d+)?"
_NUMBER = re.compile(
    rf"(?P<sign>[-−+]?)(?P<top>{_DIGITS})(?:/(?P<bottom>\d+)|[eE](?P<power>[-−+]?\d+))?"
)
_SMALL = re.compile(rf"0\.(?P<zeros>0{{{SMALLEST_ZEROS},}})(?P<first>[1-9])(?P<rest>\d*)")
POWER = re.compile(rf"(?P<sign>[-−]?)(?P<mantissa>{_DIGITS})·10(?P<power>{_RAISED})")
"""A number with a power of ten, as it is written here."""


def group_digits(digits: str) -> str:
    """Return digits in groups of three, from five on; those behind a point stay together.

    Few stand there, and a blank among them would end the number for many a reader.

    Examples
    --------
    >>> group_digits("1228800.5"), group_digits("1024")
    ('1\u202f228\u202f800.5', '1024')
    """
    whole, point, behind = digits.partition(".")
    if len(whole) > LONGEST_UNGROUPED:
        whole = whole.lstrip("0") or "0"
        first = len(whole) % 3 or 3
        starts = range(first, len(whole), 3)
        whole = GAP.join([whole[:first], *(whole[start : start + 3] for start in starts)])
    return f"{whole}{point}{behind}"


def format_power_of_ten(exponent: str | int) -> str:
    """Return a power of ten as ``10⁻⁵``."""
    text = str(exponent)
    digits = text.lstrip(f"+-{MINUS}").lstrip("0")
    sign = "-" if digits and text[0] in {"-", MINUS} else ""
    return f"10{(sign + (digits or '0')).translate(RAISED)}"


@lru_cache(maxsize=4096)
def format_number(text: str) -> str:
    """Return a number for people; a text that is no number only gets its minus sign.

    Examples
    --------
    >>> format_number("-0.25"), format_number("2.2e-41"), format_number("0.00005")
    ('−0.25', '2.2·10⁻⁴¹', '5·10⁻⁵')
    >>> format_number("-7/1550")
    '−7/1550'
    """
    match = _NUMBER.fullmatch(text)
    if match is None:
        return MINUS + text[1:] if text.startswith("-") else text
    sign = MINUS if match["sign"] in {"-", MINUS} else ""
    top, power = match["top"], match["power"]
    if match["bottom"]:
        return f"{sign}{group_digits(top)}/{group_digits(match['bottom'])}"
    if power:
        return f"{sign}{group_digits(top)}·{format_power_of_ten(power)}"
    small = _SMALL.fullmatch(top)
    return sign + (group_digits(top) if small is None else _with_power(small))


def _with_power(small: re.Match[str]) -> str:
    """Return a small decimal as a mantissa with its power of ten."""
    mantissa = f"{small['first']}.{small['rest']}" if small["rest"] else small["first"]
    return f"{mantissa}·{format_power_of_ten(-len(small['zeros']) - 1)}"


_ON_LINE, BELOW = "0123456789aehijklmnoprstuvx+-", "₀₁₂₃₄₅₆₇₈₉ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ₊₋"
"""Every character that Unicode has as a subscript, and its subscript."""
TO_BELOW, FROM_BELOW = str.maketrans(_ON_LINE, BELOW), str.maketrans(BELOW, _ON_LINE)
LETTERS = {word: letter for letter, word in GREEK.items() if letter not in "µ∆"}
_ACCENTS = {"bar": "\u0304", "hat": "\u0302", "tilde": "\u0303"}
_SIGNS = {"plus": "+", "minus": "-"}
_BASE = re.compile(r"(?P<stem>[^\W\d_]+)(?P<digits>\d*)(?P<primes>['′]*)")
# gamma and beta are functions before a bracket alone: elsewhere they are letters.
_GREEK_FUNCTIONS = sorted(FUNCTIONS.keys() & set(GREEK.values()))
_KEPT = frozenset({*FUNCTIONS, *KEYWORDS}) - {*_GREEK_FUNCTIONS}


@lru_cache(maxsize=4096)
def format_name(symbol: str) -> str:
    """Return a quantity's name, with the characters that Unicode has for it.

    A subscript that Unicode has no letters for stays behind its underscore.

    Examples
    --------
    >>> format_name("n_1"), format_name("p'_x"), format_name("sigma_1"), format_name("zbar")
    ('n₁', 'p′ₓ', 'σ₁', 'z̄')
    >>> format_name("p'_y"), format_name("red")
    ('p′_y', 'red')
    """
    first, *rest = symbol.split("_")
    match = _BASE.fullmatch(first)
    if match is None:
        return symbol.replace("'", "′")
    low = [match["digits"]] if match["digits"] else []
    primes, stem = len(match["primes"]), _format_stem(match["stem"])
    for part in rest:
        bare = part.rstrip("'′")
        primes += len(part) - len(bare)
        if bare in _ACCENTS:
            stem = unicodedata.normalize("NFC", stem + _ACCENTS[bare])
        else:
            low.append(_SIGNS.get(bare, LETTERS.get(bare, bare)))
    return f"{stem}{'′' * primes}{_format_subscript(low)}"


def _format_subscript(low: list[str]) -> str:
    """Return a subscript in small letters if Unicode has all of them, else behind underscores."""
    if len(low) == 1 and set(low[0]) <= set(_ON_LINE):
        return low[0].translate(TO_BELOW)
    return "".join(f"_{part}" for part in low)


def _format_stem(stem: str) -> str:
    """Return a letter, Greek letter, letter with an accent, or difference; else the word."""
    for accent, mark in _ACCENTS.items():
        head = stem.removesuffix(accent)
        if head != stem and len(LETTERS.get(head, head)) == 1:
            return unicodedata.normalize("NFC", LETTERS.get(head, head) + mark)
    tail = stem.removeprefix("Delta")
    if tail != stem and len(LETTERS.get(tail, tail)) == 1:
        return f"Δ{LETTERS.get(tail, tail)}"
    return LETTERS.get(stem, stem)


_FORMULA = re.compile(
    r"`(?P<quoted>[^`]+)`"
    r"|(?P<log>log(?:2|10)(?=\())"
    r"|(?P<root>(?<![^\W_])sqrt(?=\())"
    rf"|(?P<function>(?<![^\W_])(?:{'|'.join(_GREEK_FUNCTIONS)})(?=\())"
    r"|(?P<pi>(?<![^\W_])pi(?![\w']))"
    r"|(?P<name>[^\W\d_][^\W_]*['′]*(?:_[^\W_]+['′]*)*)"
    r"|\^(?:(?P<exponent>\d+)(?![\d.])|\{(?P<literal>-?\d+)/1\}|\((?P<inside>-\d+)\))"
    r"|\{(?P<constant>-?\d[\d./]*)\}"
    rf"|(?P<number>(?<![\d.{GAP}]){_DIGITS}(?:[eE][-+]?\d+)?)"
    r"|(?P<sign><=|>=|!=|\*|-)"
)
_DOUBLED = re.compile(r"\(\(([^()]+)\)\)")
"""Brackets in brackets, where a number stands alone in those of a function."""
_ALONE = re.compile(rf"(?<=[=<>≤≥≠≈] )\(({MINUS}[^()]+)\)(?=$| [=<>≤≥≠≈])")
"""A number with a sign that is a whole side."""
_SPELLED = {"<=": "≤", ">=": "≥", "!=": "≠", "*": "·", "-": MINUS}


def format_formula(text: str) -> str:
    """Return a formula in the grammar, or a worked line of them, for people.

    Examples
    --------
    >>> format_formula("p'_x = -f*X/Z^2 <= 1e-5")
    'p′ₓ = −f·X/Z² ≤ 1·10⁻⁵'
    """
    return _ALONE.sub(r"\1", _DOUBLED.sub(r"(\1)", _FORMULA.sub(_rewrite_match, text)))


def format_constant(text: str) -> str:
    """Return an exact number as it is written by hand.

    Examples
    --------
    >>> format_constant("-9*sqrt(2)/2")
    '−9√2/2'
    """
    return _BEFORE_ROOT.sub("", _ROOT.sub(r"√\1", format_formula(text)))


_ROOT = re.compile(r"√\((\d+)\)(?![\d⁰¹²³⁴-⁹])")
_BEFORE_ROOT = re.compile(r"(?<=\d)·(?=[√π])")


def _rewrite_match(match: re.Match[str]) -> str:
    """Return one piece of a formula as people write it."""
    kind = str(match.lastgroup)
    return _WRITERS[kind](match[kind])


def _format_symbol(word: str) -> str:
    """Return a name as people write it; those of functions and words stay."""
    return "∞" if word == "inf" else word if word in _KEPT else format_name(word)


def _format_braced_constant(text: str) -> str:
    """Return the number that stood in braces; one with a sign or a bar gets round brackets."""
    value = format_number(text.removesuffix("/1").removesuffix("."))
    return f"({value})" if {MINUS, "/"} & {*value} else value


def _to_superscript(exponent: str) -> str:
    """Return an exponent in raised digits."""
    return exponent.translate(RAISED)


_WRITERS: dict[str, Callable[[str], str]] = {
    "name": _format_symbol,
    "quoted": format_name,
    "pi": lambda _text: "π",
    "root": lambda _text: "√",
    "function": str,
    "log": lambda text: "log" + text[3:].translate(TO_BELOW),
    "exponent": _to_superscript,
    "literal": _to_superscript,
    "inside": _to_superscript,
    "constant": _format_braced_constant,
    "number": format_number,
    "sign": _SPELLED.__getitem__,
}


_WITH_INDEX = re.compile(r"[^\W\d_]+['′]*_[^\W_]+['′]*|(?<![^\W_])[^\W\d_]'(?![^\W_])")
_INDEXED = "_'"
"""One of which every such name has."""


def format_names_in(text: str) -> str:
    """Return a sentence in which names with an index or a prime are written for people.

    Examples
    --------
    >>> format_names_in("z'_p in front of λ_1 and z'")
    'z′ₚ in front of λ₁ and z′'
    """
    if not any(sign in text for sign in _INDEXED):  # looking for names takes long
        return text
    return _WITH_INDEX.sub(lambda m: format_name(m[0]), text)


_SIGNED = re.compile(r"(?<![\w)\]}.,'\"−-])-(?=\d)|(?<=\d )-(?= \d)")
_LONG = re.compile(rf"(?<![\w.,{GAP}])\d{{{LONGEST_UNGROUPED + 1},}}(?![\w{GAP}])")


def format_numbers_in_prose(text: str) -> str:
    r"""Return a sentence with a real minus before its numbers, and groups in the long ones.

    Examples
    --------
    >>> format_numbers_in_prose("between -1 and 65535")
    'between −1 and 65\u202f535'
    """
    return _LONG.sub(lambda m: group_digits(m[0]), _SIGNED.sub(MINUS, text))
