"""From a quantity's name in a solver or in typed mathematics to how it is written by hand.

``p_x`` has a subscript, ``p'_x`` a prime, ``k1`` and ``k_1`` an index, ``zbar`` and ``z_bar`` a
bar, ``sigma`` is Greek, ``Delta_z`` has a subscript and ``Deltaz`` is a difference; names of
several letters (``SNR``, the ``max`` of ``I_max``) are upright words.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

from msgspec import Struct

from quizgen.core.errors import RenderError
from quizgen.typeset.nodes import (
    PRODUCT,
    Accent,
    Digits,
    FunctionName,
    Ident,
    MathRow,
    Node,
    OperatorSign,
    Scripts,
    Word,
)

GREEK = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "delta": "δ",
    "epsilon": "ε",
    "zeta": "ζ",
    "eta": "η",
    "theta": "θ",
    "iota": "ι",
    "kappa": "κ",
    "lambda": "λ",
    "lamda": "λ",
    "mu": "μ",
    "nu": "ν",
    "xi": "ξ",
    "pi": "π",
    "rho": "ρ",
    "sigma": "σ",
    "tau": "τ",
    "upsilon": "υ",
    "phi": "φ",
    "chi": "χ",
    "psi": "ψ",
    "omega": "ω",
    "Gamma": "Γ",
    "Delta": "Δ",
    "Theta": "Θ",
    "Lambda": "Λ",
    "Xi": "Ξ",
    "Pi": "Π",
    "Sigma": "Σ",
    "Upsilon": "Υ",
    "Phi": "Φ",
    "Psi": "Ψ",
    "Omega": "Ω",
}
"""Greek letters by their English names."""

KNOWN = frozenset(
    {
        *("sin", "cos", "tan", "arcsin", "arccos", "arctan"),
        *("ln", "log", "exp", "min", "max", "lim", "det"),
        *("cot", "sec", "csc", "sinh", "cosh", "tanh", "lg", "sup", "inf", "arg", "gcd", "dim"),
        *("ker", "deg", "Pr", "hom"),
    }
)
"""Functions that LaTeX and Typst know by name."""
ACCENTS = ("bar", "hat", "tilde")
GREEK_LETTERS = frozenset(GREEK.values())
_AXES = frozenset("xyzuvij")
_SIGNS = {"plus": "+", "minus": "neg"}
_MIXED = re.compile(r"(?P<stem>[^\W\d_][^\W_]*)(?P<digits>)(?P<primes>['′]*)")
_PART = re.compile(r"(?P<stem>[^\W\d_]+)(?P<digits>\d*)(?P<primes>['′]*)")


@lru_cache(maxsize=4096)
def lay_out_name(symbol: str) -> Node:
    """Return the layout of a quantity's name.

    Parameters
    ----------
    symbol : str
        For example ``p'_x``, ``sigma``, ``zbar``, ``I_max``.

    Raises
    ------
    RenderError
        If the name is empty or holds anything but letters, digits, primes and underscores.
    """
    first, *rest = symbol.replace("µ", "μ").split("_")
    match = _PART.fullmatch(first) or _MIXED.fullmatch(first)
    if match is None:
        raise RenderError(f"cannot write the name {symbol!r}: it must begin with a letter")
    base, accent = _lay_out_stem(match["stem"])
    primes = len(match["primes"])
    subs: list[Node] = [Digits(match["digits"])] if match["digits"] else []
    for part in rest:
        body = part.rstrip("'′")
        primes += len(part) - len(body) + (body == "prime")
        if body in ACCENTS:
            accent = body
        elif body and body != "prime":
            subs.append(_lay_out_subscript(body, symbol))
    marked = Accent(accent, base) if accent else base
    return Scripts(marked, _join_subscripts(subs), None, primes) if subs or primes else marked


def _lay_out_stem(stem: str) -> tuple[Node, str]:
    """Return a letter, Greek letter, accented letter, difference or word; and the accent's name.

    The accent is empty if there is none.
    """
    letter = GREEK.get(stem, stem)
    if len(letter) == 1:
        return Ident(letter), ""
    for accent in ACCENTS:
        head = stem.removesuffix(accent)
        if head != stem and len(GREEK.get(head, head)) == 1:
            return Ident(GREEK.get(head, head)), accent
    tail = stem.removeprefix("Delta").removeprefix("Δ")
    if tail != stem and len(GREEK.get(tail, tail)) == 1:
        return MathRow((Ident("Δ"), Ident(GREEK.get(tail, tail))), PRODUCT), ""
    return Word(stem), ""


def _lay_out_subscript(part: str, symbol: str) -> Node:
    """Return one part of a subscript: digits, a sign, letters of axes or a name.

    Raises
    ------
    RenderError
        If it is none of them; ``symbol`` is the whole name, for the message.
    """
    if part.isdigit():
        return Digits(part)
    if part in _SIGNS:
        return OperatorSign(_SIGNS[part])
    if len(part) > 1 and _AXES.issuperset(part):
        return MathRow(tuple(Ident(letter) for letter in part))
    match = _PART.fullmatch(part)
    if match is None and _MIXED.fullmatch("x" + part):
        return Word(part)
    if match is None:
        raise RenderError(f"cannot write the name {symbol!r}: subscript {part!r}")
    base, accent = _lay_out_stem(match["stem"])
    marked = Accent(accent, base) if accent else base
    return MathRow((marked, Digits(match["digits"]))) if match["digits"] else marked


def _join_subscripts(subs: list[Node]) -> Node | None:
    """Return the parts of a subscript with commas between; None if there are none."""
    if len(subs) < 2:
        return subs[0] if subs else None
    items: list[Node] = [subs[0]]
    for sub in subs[1:]:
        items += [OperatorSign(","), sub]
    return MathRow(tuple(items))


_ASCII = {char: word for word, char in GREEK.items() if word != "lamda"}


def iter_names_written(part: object) -> Iterator[str]:
    """Yield the names of the quantities that a layout shows, spelled as in solvers: ``mu_1``."""
    if isinstance(part, Scripts) and (name := _spell_name(part)):
        yield name
        yield from iter_names_written(part.sup)
    elif isinstance(part, Ident | Accent) and (name := _spell_name(part)):
        yield name
    elif isinstance(part, Struct):
        for field in part.__struct_fields__:
            yield from iter_names_written(getattr(part, field))
    elif isinstance(part, tuple):
        for one in part:
            yield from iter_names_written(one)


def _spell_name(node: Node) -> str:
    """Return a name as solvers spell it; empty if a node is no name."""
    match node:
        case Ident(text):
            return _ASCII.get(text, text)
        case Digits(text) | Word(text) | FunctionName(text):
            return text
        case Accent(kind, base) if kind in ACCENTS and (name := _spell_name(base)):
            return f"{name}{kind}"
        case Scripts(base, sub, _, primes) if name := _spell_name(base):
            low = "" if sub is None else _spell_name(sub)
            return f"{name}{chr(39) * primes}" + (f"_{low}" if low else "")
    return ""
