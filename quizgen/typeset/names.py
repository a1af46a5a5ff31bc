"""From a quantity's name in a solver or in typed mathematics to how it is written by hand.

``p_x`` has a subscript, ``p'_x`` a prime, ``k1`` and ``k_1`` an index, ``zbar`` and ``z_bar`` a
bar, ``sigma`` is Greek, ``Delta_z`` has a subscript and ``Deltaz`` is a difference; names of
several letters (``SNR``, the ``max`` of ``I_max``) are upright words.
"""

from __future__ import annotations

import re
from functools import lru_cache

from quizgen.core.errors import RenderError
from quizgen.typeset.nodes import (
    PRODUCT,
    Accent,
    Digits,
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
    "phi": "φ",
    "chi": "χ",
    "psi": "ψ",
    "omega": "ω",
    "Gamma": "Γ",
    "Delta": "Δ",
    "Theta": "Θ",
    "Lambda": "Λ",
    "Sigma": "Σ",
    "Phi": "Φ",
    "Psi": "Ψ",
    "Omega": "Ω",
}
"""Greek letters by their English names."""

KNOWN = frozenset(
    {
        *("sin", "cos", "tan", "arcsin", "arccos", "arctan"),
        *("ln", "log", "exp", "min", "max", "lim", "det"),
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
