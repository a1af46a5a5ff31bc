"""Steps over lists as people write them out: (3.1 + 2.4 + … + 5.0)/9."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import msgspec
from flint import fmpq

from quizgen import typeset
from quizgen.bank.variant import Variant
from quizgen.maths.list_operators import compute_mean
from quizgen.maths.notation import pretty
from quizgen.maths.numbers import format_decimal, format_rounded, is_short_decimal
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import Call, Expr, Num, Sym
from quizgen.typeset.nodes import Word

MOST_WRITTEN = 6
"""Values of a list that are written out; of a longer one the first two and the last."""
_GAP = "…"
_ORDERED = frozenset({"median", "sort"})
_TWO = Num(Fraction(2))


class WrittenLists(msgspec.Struct):
    """A formula whose lists are written out, and what stands for the names put in."""

    expr: Expr
    nodes: dict[str, typeset.Node]
    texts: dict[str, str]
    rounded: bool = False


def write_out_lists(expr: Expr, drawn: Variant) -> WrittenLists:
    """Return a step's formula with the values of its lists in place.

    Sums, means and variances become sums of their terms; any other function keeps its name
    before the values, ordered where it orders them.
    """
    written = WrittenLists(expr, {}, {})
    written.expr = _write_out(expr, drawn, written)
    return written


def _write_out(expr: Expr, drawn: Variant, written: WrittenLists) -> Expr:
    """Return a step with the values of its lists in place, such as a sum in full for a mean."""
    if isinstance(expr, Sym) and expr.name in drawn.lists:
        return _put_list(expr.name, drawn, written)
    if not isinstance(expr, Call):
        return expr
    rule = _RULES.get(expr.op)
    listed = expr.args[0] if expr.args else expr
    if rule and isinstance(listed, Sym) and listed.name in drawn.lists:
        return rule(listed.name, drawn, written)
    if expr.op == "at" and isinstance(listed, Sym) and isinstance(expr.args[1], Num):
        place = int(expr.args[1].value)
        return _put_value(drawn.format_list(listed.name)[place - 1], written)
    if isinstance(listed, Sym) and listed.name in drawn.lists and len(expr.args) == 1:
        return Call(expr.op, tuple(_put_values(listed.name, drawn, written, expr.op in _ORDERED)))
    return Call(expr.op, tuple(_write_out(arg, drawn, written) for arg in expr.args))


def _put_value(text: str, written: WrittenLists) -> Sym:
    """Return a leaf that is one value of a list; only the result has a unit, not each value."""
    return _put_leaf(written, typeset.number(text), text)


def _put_leaf(written: WrittenLists, node: typeset.Node, text: str) -> Sym:
    """Return a new leaf, having noted how it is typeset and how it is typed.

    Its text has brackets unless it is a plain number or the gap that stands for values left out.
    """
    name = f"value {len(written.texts)}"
    written.nodes[name] = node
    plain = all(sign.isdigit() or sign in f".{pretty.GAP}" for sign in text)
    written.texts[name] = text if plain or text == _GAP else f"({text})"
    return Sym(name)


def _put_list(name: str, drawn: Variant, written: WrittenLists) -> Sym:
    """Return a leaf that is the whole list."""
    texts = _shorten(drawn.format_list(name))
    items = [Word(text) if text == _GAP else typeset.number(text) for text in texts]
    return _put_leaf(written, typeset.fence(items), "; ".join(texts))


def _shorten(texts: tuple[str, ...]) -> tuple[str, ...]:
    """Return the values that are written of a list: if it is long the first, a gap and the last."""
    most = 2 * MOST_WRITTEN
    return texts if len(texts) <= most else (*texts[:MOST_WRITTEN], _GAP, texts[-1])


def _put_values(name: str, drawn: Variant, written: WrittenLists, ordered: bool) -> list[Sym]:
    """Return a leaf for each value, smallest first if ``ordered``."""
    texts = drawn.format_list(name)
    if ordered:
        values = drawn.lists[name]
        texts = tuple(texts[place] for place in sorted(range(len(texts)), key=values.__getitem__))
    return [
        _put_leaf(written, Word(_GAP), _GAP) if text == _GAP else _put_value(text, written)
        for text in _shorten(texts)
    ]


def _choose_terms(name: str, drawn: Variant, written: WrittenLists) -> list[Expr]:
    """Return a leaf for each value, or for the first two, a gap and the last."""
    texts = drawn.format_list(name)
    if len(texts) <= MOST_WRITTEN:
        return [_put_value(text, written) for text in texts]
    first, second, last = (_put_value(texts[at], written) for at in (0, 1, -1))
    return [first, second, _put_leaf(written, Word(_GAP), _GAP), last]


def _write_sum(name: str, drawn: Variant, written: WrittenLists) -> Expr:
    """Return the sum of a list in full; one value stands alone."""
    terms = _choose_terms(name, drawn, written)
    return Call("add", tuple(terms)) if len(terms) > 1 else terms[0]


def _write_mean(name: str, drawn: Variant, written: WrittenLists) -> Expr:
    """Return the mean of a list: its sum in full over the number of values."""
    return Call("div", (_write_sum(name, drawn, written), _count_values(name, drawn)))


def _count_values(name: str, drawn: Variant, less: int = 0) -> Num:
    """Return how many values a drawn list has, minus ``less``: the 1 of n - 1."""
    return Num(Fraction(len(drawn.lists[name]) - less))


def _write_variance(less: int) -> Callable[[str, Variant, WrittenLists], Expr]:
    """Return the rule for a variance that divides by the number of values less so many."""

    def rule(name: str, drawn: Variant, written: WrittenLists) -> Expr:
        """Return the sum of squared deviations from the mean over the number of values.

        Notes if the mean is rounded in it.
        """
        with working_precision():
            mean: fmpq = compute_mean(drawn.lists[name])
        is_short = is_short_decimal(mean)
        written.rounded |= not is_short
        text = format_decimal(mean) if is_short else format_rounded(mean, figures=6)
        centre = _put_value(text, written)
        squares = [
            term if written.texts[term.name] == _GAP
            else Call("pow", (Call("sub", (term, centre)), _TWO))
            for term in _choose_terms(name, drawn, written) if isinstance(term, Sym)
        ]  # fmt: skip
        return Call("div", (Call("add", tuple(squares)), _count_values(name, drawn, less)))

    return rule


def _write_root(less: int) -> Callable[[str, Variant, WrittenLists], Expr]:
    """Return the rule for a standard deviation, the root of a variance."""
    variance = _write_variance(less)
    return lambda name, drawn, written: Call("sqrt", (variance(name, drawn, written),))


_RULES: dict[str, Callable[[str, Variant, WrittenLists], Expr]] = {
    "list_sum": _write_sum,
    "mean": _write_mean,
    "len": lambda name, drawn, _written: _count_values(name, drawn),
    "var": _write_variance(1),
    "pvar": _write_variance(0),
    "sd": _write_root(1),
    "psd": _write_root(0),
}
"""Functions of a list that are written out as terms."""
