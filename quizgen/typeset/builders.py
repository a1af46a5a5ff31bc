"""Building blocks for printed formulas: numbers, quantities, chains of relations, brackets."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from quizgen.core.errors import RenderError
from quizgen.maths.notation import pretty
from quizgen.maths.notation.pretty import LOWERED
from quizgen.maths.numbers import count_decimals
from quizgen.typeset.nodes import (
    NEGATIVE,
    PRODUCT,
    RELATION,
    Digits,
    Fenced,
    Frac,
    MathRow,
    Node,
    NumberWithUnit,
    OperatorSign,
    Scripts,
    UnitText,
)

RELATIONS = frozenset([*"=≠<≤>≥≈∝→∈±~≪≫⇒⇔:"])
EQUALS = (OperatorSign("="), OperatorSign("≈"))
"""The signs of a worked line."""
_DIGITS = r"\d[\d\u0020\u00a0\u2009\u202f]*(?:[.,]\d+)?"
_NUMBER = re.compile(
    rf"(?P<sign>[-−+]?)(?P<digits>{_DIGITS})"
    rf"(?:/(?P<bottom>{_DIGITS})|(?:[eE]|\s*[·×*]\s*10\^)(?P<power>[-−+]?\d+)"
    r"|·10(?P<raised>[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+))?"
)


def number(value: Fraction | int | str, lang: str = "en") -> Node:
    """Return the layout of a number.

    Parameters
    ----------
    value : Fraction, int or str
        A rational is shown exactly (as an integer or a fraction). A text keeps its digits:
        ``2.50``, ``-3``, ``20/3``, ``1.2e-5``. Long ones are grouped either way.
    lang : str
        Language of the reader. English and Bangla both write Western digits and a point.

    Raises
    ------
    RenderError
        If a text is not a number.
    """
    del lang  # both languages write numbers alike; the parameter keeps callers honest
    if not isinstance(value, str):
        return _build_rational(Fraction(value))
    match = _NUMBER.fullmatch(value.strip())
    if match is None:
        raise RenderError(f"cannot show {value!r} as a number")
    node: Node = _group_digit_text(match["digits"])
    if match["bottom"]:
        node = Frac(node, _group_digit_text(match["bottom"]))
    elif power := match["power"] or match["raised"]:
        exponent = power.translate(LOWERED).replace("−", "-")
        node = MathRow((node, OperatorSign("·"), power_of_ten(int(exponent))), PRODUCT)
    return negative(node) if match["sign"] in {"-", "−"} else node


def _group_digit_text(text: str) -> Digits:
    """Return digits in groups, however they were grouped before."""
    return Digits(pretty.group_digits("".join(text.split())))


def _build_rational(value: Fraction) -> Node:
    """Return a rational as digits or a fraction, with a minus sign before all of it."""
    top: Node = _group_digit_text(str(abs(value.numerator)))
    node = top if value.denominator == 1 else Frac(top, _group_digit_text(str(value.denominator)))
    return negative(node) if value < 0 else node


def decimal(value: Fraction) -> str:
    """Return a rational as a finite decimal, or as a fraction if it has none.

    Sizes below 0.0001 are written with a power of ten, for example ``2.5e-6``.
    """
    count = count_decimals(value)
    return str(value) if count is None else _insert_decimal_point(int(value * 10**count), count)


def _insert_decimal_point(digits: int, count: int) -> str:
    """Return digits with a point before the last ``count`` of them."""
    sign, text = "-" * (digits < 0), str(abs(digits))
    if count == 0:
        return sign + text
    if count - len(text) >= 4:
        mantissa = text[0] + ("." + text[1:] if len(text) > 1 else "")
        return f"{sign}{mantissa}e-{count - len(text) + 1}"
    text = text.zfill(count + 1)
    return f"{sign}{text[:-count]}.{text[-count:]}"


def power_of_ten(exponent: int) -> Node:
    """Return the layout of 10 to an integer power."""
    return Scripts(Digits("10"), None, _build_rational(Fraction(exponent)))


def negative(node: Node) -> MathRow:
    """Return a node with a minus sign before it."""
    return MathRow((OperatorSign("neg"), node), NEGATIVE)


def quantity(value: Node | str, unit: str) -> Node:
    """Return the layout of a number with its unit, for example ``quantity("2.5", "um/px")``.

    An empty unit (or ``1``) gives the number alone.

    Raises
    ------
    RenderError
        If a text is not a number.
    """
    node = number(value) if isinstance(value, str) else value
    if unit in {"", "1"}:
        return node
    if isinstance(node, MathRow) and node.items[0] == OperatorSign("neg"):
        return MathRow(
            (OperatorSign("neg"), NumberWithUnit(node.items[1], UnitText(unit))), NEGATIVE
        )
    return NumberWithUnit(node, UnitText(unit))


def relation_chain(signs: Sequence[str], nodes: Sequence[Node]) -> MathRow:
    """Return nodes chained by relation signs, one sign fewer than nodes.

    Parameters
    ----------
    signs : sequence of str
        Each one of ``= ≠ < ≤ > ≥ ≈ ∝ → ∈ ± ~ ≪ ≫ ⇒ ⇔``, or ``:`` behind a name.
    nodes : sequence of Node
        The sides, for example symbol, formula, numbers in place, result.

    Raises
    ------
    RenderError
        If a sign is unknown or the counts do not fit.
    """
    if len(nodes) != len(signs) + 1:
        raise RenderError(f"{len(nodes)} sides need {len(nodes) - 1} signs, not {len(signs)}")
    items = [nodes[0]]
    for sign, node in zip(signs, nodes[1:], strict=True):
        if sign not in RELATIONS:
            raise RenderError(f"unknown relation sign {sign!r}")
        items += [OperatorSign("colon" if sign == ":" else sign), node]
    return MathRow(tuple(items), RELATION)


def split_chain(node: Node) -> tuple[Node, ...]:
    """Return the pieces of a chain of equal sides, each but the first begun by its sign.

    Where nothing is equal to anything, the node itself is the one piece.
    """
    if not isinstance(node, MathRow):
        return (node,)
    signs = [place for place, item in enumerate(node.items) if item in EQUALS]
    places = [0, *signs[1:], len(node.items)]
    return tuple(
        MathRow(node.items[begin:end], node.level) for begin, end in pairwise(places) if signs
    ) or (node,)


def fence(nodes: Sequence[Node], kind: str = "()") -> Fenced:
    """Return a comma-separated list in brackets: points, tuples, intervals, sets."""
    return Fenced(kind, comma_list(nodes))


def comma_list(nodes: Sequence[Node]) -> Node:
    """Return nodes separated by commas; a single one is itself."""
    if len(nodes) == 1:
        return nodes[0]
    items = [nodes[0]]
    for node in nodes[1:]:
        items += [OperatorSign(","), node]
    return MathRow(tuple(items), RELATION)
