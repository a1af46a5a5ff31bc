"""From a formula tree to its layout: brackets, dots, signs and fractions are decided here, once.

All four outputs print the same layout, so none can disagree with another on what is bracketed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from msgspec.structs import replace

from quizgen.core.errors import RenderError
from quizgen.maths.operators import MANY, Operator, OperatorSyntax, operators_with_syntax
from quizgen.maths.tree import Call, Expr, Num, Sym
from quizgen.typeset.builders import decimal, negative, number
from quizgen.typeset.names import lay_out_name
from quizgen.typeset.nodes import (
    ATOM,
    FRACTION,
    MODULO,
    NEGATIVE,
    POWER,
    PRODUCT,
    QUANTITY,
    RELATION,
    SUM,
    WORDS,
    Accent,
    Binomial,
    Cases,
    Digits,
    Fenced,
    Frac,
    Func,
    Ident,
    LargeOperator,
    MathRow,
    Matrix,
    Node,
    NumberWithUnit,
    OperatorSign,
    ReaderWord,
    Root,
    Scripts,
    Word,
)

_READ_AS_FUNCTION = frozenset("fghPVEFGNLφψ")
"""Letters before a bracket that readers take for a function: they get a dot."""

_TIMES, _DOT = OperatorSign(""), OperatorSign("·")


def needs_dot(left: Node, right: Node) -> OperatorSign:
    """Put a dot where juxtaposed factors would be misread."""
    before, after = _find_last_visible(left), _find_first_visible(right)
    if _starts_number(after) or isinstance(before, NumberWithUnit):
        return _DOT
    if isinstance(before, Word) or isinstance(after, Word) or _has_slash_between(left, right):
        return _DOT
    return _DOT if isinstance(after, Fenced) and _has_call_look(before, after) else _TIMES


def _has_slash_between(left: Node, right: Node) -> bool:
    """Return whether one factor is a quotient with a slash, whose end would be unclear."""
    ends = _find_last_visible(left), right
    return any(isinstance(node, Frac) and node.inline for node in ends)


def _has_call_look(before: Node, after: Fenced) -> bool:
    """Return whether a factor before a bracket looks like a function, or bars like one pair."""
    if isinstance(before, Digits | Func):
        return after.kind == "()"
    if isinstance(before, Ident):
        return after.kind == "()" and before.text in _READ_AS_FUNCTION
    return isinstance(before, Fenced) and "|" in (before.kind[0], after.kind[0])


def _find_first_visible(node: Node) -> Node:
    """Return what a reader meets first in a factor."""
    while True:
        match node:
            case MathRow():
                node = node.items[0]
            case Scripts() | Accent():
                node = node.base
            case Frac():
                node = node.top
            case _:
                return node


def _find_last_visible(node: Node) -> Node:
    """Return what a reader meets last in a factor."""
    while True:
        match node:
            case MathRow():
                node = node.items[-1]
            case Scripts(sup=None) | Accent():
                node = node.base
            case _:
                return node


def _starts_number(node: Node) -> bool:
    """Return whether a factor is a number, maybe in brackets with a sign or a unit."""
    if isinstance(node, Fenced):
        node = node.body
        if isinstance(node, MathRow) and node.level == NEGATIVE:
            node = node.items[1]
    return isinstance(node, Digits | NumberWithUnit)


SIGNS = {"eq": "=", "ne": "≠", "lt": "<", "le": "≤", "gt": ">", "ge": "≥"}
FENCES = {"abs": "||", "floor": "⌊⌋", "ceil": "⌈⌉"}
HEADS: dict[str, Node] = {
    "log2": Scripts(Word("log"), Digits("2")),
    "log10": Scripts(Word("log"), Digits("10")),
    "asin": Word("arcsin"),
    "acos": Word("arccos"),
    "atan": Word("arctan"),
    "asinh": Word("arsinh"),
    "acosh": Word("arcosh"),
    "atanh": Word("artanh"),
    "sign": Word("sgn"),
    "gamma": Word("Γ"),
    "lowergamma": Word("γ"),
    "uppergamma": Word("Γ"),
    "zeta": Word("ζ"),
    "beta": Word("B"),
    "lambertw": Word("W"),
    "totient": Word("φ"),
    "mobius": Word("μ"),
    "digamma": Word("ψ"),
    "normal_cdf": Word("Φ"),
    "normal_quantile": Scripts(
        Word("Φ"), None, MathRow((OperatorSign("neg"), Digits("1")), NEGATIVE)
    ),
}
"""Functions that are printed under another name than they are typed."""
_WITH_ORDER = {
    "besselj": "J", "bessely": "Y", "besseli": "I", "besselk": "K", "legendre": "P",
    "chebyshevt": "T", "chebyshevu": "U", "hermite": "H", "laguerre": "L",
}  # fmt: skip
"""Functions whose order is printed as an index, by their letters."""
_DISTRIBUTIONS = {"t": "t", "chi2": "χ", "f": "F"}
"""Distributions with degrees of freedom, by the letters that they are called."""

_POWER_ON_NAME = frozenset({"sin", "cos", "tan"})
_OPPOSITES = {"eq": "ne", "ne": "eq", "lt": "ge", "ge": "lt", "gt": "le", "le": "gt"}

_NEG = OperatorSign("neg")
_ONE = Fraction(1)
_MINUS_ONES = (Num(-_ONE), Call("neg", (Num(_ONE),)))


def lay_out(expr: Expr, *, leaves: Mapping[str, Node] | None = None, inline: bool = False) -> Node:
    """Return the layout of a formula in the order in which it is written.

    Parameters
    ----------
    expr : Expr
        The formula tree.
    leaves : mapping of str to Node, optional
        What to print instead of a symbol, for example the drawn number with its unit. It gets
        brackets where a negative number or a unit would be misread.
    inline : bool
        Print divisions with a slash.

    Raises
    ------
    RenderError
        If an operator is unknown or has the wrong number of arguments.
    """
    return _Layout(leaves or {}, inline=inline).lay(expr)


class _Layout:
    """One run of the layout: the printed leaves, and whether divisions take a slash.

    The rules below take a run and the arguments of a call. They may unpack too few or too many, or
    raise ValueError: ``lay`` makes a RenderError of it.
    """

    __slots__ = ("inline", "leaves")

    def __init__(self, leaves: Mapping[str, Node], *, inline: bool) -> None:
        """Store the leaves and the style of divisions."""
        self.leaves = leaves
        self.inline = inline

    def lay(self, expr: Expr) -> Node:
        """Return the layout of one node of the tree.

        Raises
        ------
        RenderError
            If an operator is unknown or has the wrong number of arguments.
        """
        if isinstance(expr, Sym):
            return self.leaf(expr.name)
        if isinstance(expr, Num):
            return self.allow_slash(number(decimal(expr.value) if expr.decimal else expr.value))
        rule = _RULES.get(expr.op)
        if rule is None:
            raise RenderError(f"no way to write the operator {expr.op!r}")
        try:
            return rule(self, expr.args)
        except (ValueError, IndexError) as error:
            raise RenderError(f"{expr.op!r} cannot have {len(expr.args)} arguments") from error

    def leaf(self, symbol: str) -> Node:
        """Return the drawn number of a symbol, or its name."""
        node = self.leaves.get(symbol)
        return lay_out_name(symbol) if node is None else self.allow_slash(node)

    def allow_slash(self, node: Node) -> Node:
        """Return a node in which a fraction of two numbers follows the style around it."""
        if self.inline and isinstance(node, Frac):
            return replace(node, inline=True)
        if self.inline and isinstance(node, MathRow) and isinstance(node.items[-1], Frac):
            return replace(node, items=(*node.items[:-1], replace(node.items[-1], inline=True)))
        return node

    def small(self, expr: Expr) -> Node:
        """Return an exponent, which is set on one line."""
        return self.lay(expr) if self.inline else _Layout(self.leaves, inline=True).lay(expr)

    def lay_out_bracketed(self, expr: Expr, level: int) -> Node:
        """Return a layout, in brackets unless it holds together at ``level``."""
        return add_brackets(self.lay(expr), level)


LayoutRule = Callable[[_Layout, tuple[Expr, ...]], Node]


def add_brackets(node: Node, level: int) -> Node:
    """Return a node, in round brackets if it is weaker than ``level``."""
    return node if node.level >= level else Fenced("()", node)


# Sums


def _lay_out_sum(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return a sum in one row; terms with a minus sign are subtracted."""
    if not args:
        raise ValueError
    items = [run.lay_out_bracketed(args[0], SUM)]
    for arg in args[1:]:
        minus, term = split_sign(arg)
        items += (
            [OperatorSign("-"), _lay_out_subtrahend(run, term)]
            if minus
            else [OperatorSign("+"), _lay_out_term(run, term)]
        )
    return MathRow(_flatten_rows(items, SUM), SUM)


def _lay_out_difference(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return a difference, in one row with the sums in it."""
    first, second = args
    return MathRow(
        _flatten_rows(
            [
                run.lay_out_bracketed(first, SUM),
                OperatorSign("-"),
                _lay_out_subtrahend(run, second),
            ],
            SUM,
        ),
        SUM,
    )


def _lay_out_subtrahend(run: _Layout, expr: Expr) -> Node:
    """Return what is subtracted, in brackets if it is a sum."""
    node = run.lay(expr)
    return node if node.level == MODULO else add_brackets(node, PRODUCT)


def _lay_out_term(run: _Layout, expr: Expr) -> Node:
    """Return a later term of a sum: a sum needs no brackets, a minus sign does."""
    node = run.lay(expr)
    return (
        node
        if node.level in {SUM, MODULO} and not _has_leading_minus(node)
        else add_brackets(node, PRODUCT)
    )


def _has_leading_minus(node: Node) -> bool:
    """Return whether a node begins with a minus sign."""
    while isinstance(node, MathRow):
        node = node.items[0]
    return node == _NEG


def _lay_out_negative(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return a minus sign before the argument, a sum in brackets."""
    (arg,) = args
    return negative(run.lay_out_bracketed(arg, PRODUCT))


def split_sign(expr: Expr) -> tuple[bool, Expr]:
    """Return whether a term of a sum has a leading minus sign, and the term without it."""
    if isinstance(expr, Num) and expr.value < 0:
        return True, Num(-expr.value, expr.decimal)
    if not isinstance(expr, Call) or not expr.args:
        return False, expr
    if expr.op == "neg":
        return True, expr.args[0]
    if expr.op not in {"mul", "div"}:
        return False, expr
    minus, first = split_sign(expr.args[0])
    return minus, _with_first(expr, first) if minus else expr


def _with_first(expr: Call, first: Expr) -> Expr:
    """Return a call with another first factor; a factor 1 is not written."""
    rest = expr.args[1:]
    if expr.op == "mul" and first == Num(_ONE) and rest:
        return rest[0] if len(rest) == 1 else Call("mul", rest)
    return Call(expr.op, (first, *rest))


def _flatten_rows(items: list[Node], level: int) -> tuple[Node, ...]:
    """Return the items with rows of the same kind merged into one row."""
    flat: list[Node] = []
    for item in items:
        if isinstance(item, MathRow) and item.level == level:
            flat += item.items
        else:
            flat.append(item)
    return tuple(flat)


# Products and quotients


def _lay_out_product(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return a product in one row, with dots where factors would run together."""
    if args[0] in _MINUS_ONES and len(args) > 1:
        return negative(run.lay_out_bracketed(_with_first(Call("mul", args), Num(_ONE)), PRODUCT))
    items = [run.lay_out_bracketed(args[0], NEGATIVE)]
    for arg in args[1:]:
        factor = run.lay_out_bracketed(arg, PRODUCT)
        items += [needs_dot(items[-1], factor), factor]
    level = NEGATIVE if items[0].level == NEGATIVE else PRODUCT
    return MathRow(_flatten_rows(items, PRODUCT), level)


def _lay_out_quotient(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return a quotient with a bar, or with a slash and the brackets that it needs."""
    top, bottom = (run.lay(arg) for arg in args)
    if run.inline:
        over = Fenced("()", top) if _has_slash(top) else add_brackets(top, NEGATIVE)
        return Frac(over, add_brackets(bottom, QUANTITY), inline=True)
    return Frac(add_brackets(top, SUM), add_brackets(bottom, SUM))


def _has_slash(node: Node) -> bool:
    """Return whether a division with a slash stands in a node outside brackets."""
    if isinstance(node, MathRow):
        return node.level >= NEGATIVE and any(map(_has_slash, node.items))
    return isinstance(node, Frac) and node.inline


def _lay_out_modulo(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return a remainder with its word between both sides."""
    left, right = (run.lay_out_bracketed(arg, FRACTION) for arg in args)
    return MathRow((left, OperatorSign("mod"), right), MODULO)


# Powers and functions


def _lay_out_power_of(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return a power, of some functions on their name."""
    base, exponent = args
    return lay_out_power(run.lay(base), run.small(exponent), on_name=_takes_power(base))


def _takes_power(base: Expr) -> bool:
    """Return whether a power stands on a function's name: sin²(x)."""
    return isinstance(base, Call) and base.op in _POWER_ON_NAME


def lay_out_power(base: Node, exponent: Node, *, on_name: bool = False) -> Node:
    """Return a node raised, merged with its subscript; ``on_name`` writes sin²(x)."""
    if on_name and isinstance(base, Func):
        return Func(lay_out_power(base.head, exponent), base.args)
    base = Fenced("()", base) if isinstance(base, Func) else add_brackets(base, ATOM)
    if isinstance(base, Scripts):
        return replace(base, sup=exponent)
    return Scripts(base, None, exponent)


def _lay_out_exponential(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return e to a power."""
    (exponent,) = args
    return Scripts(Ident("e"), None, run.small(exponent))


def _lay_out_square_root(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return a square root."""
    (body,) = args
    return Root(run.lay(body))


def _lay_out_factorial(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a factorial; all but a single thing gets brackets."""
    (arg,) = args
    return MathRow((run.lay_out_bracketed(arg, ATOM), OperatorSign("!")), POWER)


def _lay_out_binomial(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a binomial coefficient."""
    top, bottom = args
    return Binomial(run.lay(top), run.lay(bottom))


def _make_series_rule(sign: str) -> LayoutRule:
    """Return the rule of a sum or product: a name, its first and last value, what is combined."""

    def rule(run: _Layout, args: tuple[Expr, ...]) -> Node:
        """Return the layout of a sum or a product with its bounds."""
        name, first, last, body = args
        start = MathRow((run.lay(name), OperatorSign("="), run.small(first)), RELATION)
        operator = LargeOperator(sign, start, run.small(last))
        return MathRow((operator, run.lay_out_bracketed(body, PRODUCT)), PRODUCT)

    return rule


def _lay_out_integral(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a definite integral, closed by its differential."""
    name, first, last, body = args
    sign = LargeOperator("∫", run.small(first), run.small(last))
    over = MathRow((OperatorSign(" "), Ident("d"), run.lay(name)))
    return MathRow((sign, run.lay_out_bracketed(body, PRODUCT), over), PRODUCT)


def _make_fence_rule(kind: str) -> LayoutRule:
    """Return the rule for a function that is written as brackets of a kind, such as |x|."""

    def rule(run: _Layout, args: tuple[Expr, ...]) -> Node:
        """Return the argument in the brackets."""
        (body,) = args
        return Fenced(kind, run.lay(body))

    return rule


def _make_function_rule(row: Operator) -> LayoutRule:
    """Return the rule for a function that is written by its name."""
    head = HEADS.get(row.name, Word(row.name))

    def rule(run: _Layout, args: tuple[Expr, ...]) -> Node:
        """Return the function; ValueError for a wrong number of arguments."""
        if not row.least <= len(args) <= row.most:
            raise ValueError
        return Func(head, tuple([run.lay(arg) for arg in args]))

    return rule


def _make_order_rule(letter: str) -> LayoutRule:
    """Return the rule for a function whose first argument is its index: J₀(x)."""

    def rule(run: _Layout, args: tuple[Expr, ...]) -> Node:
        """Return the function of its second argument."""
        order, of = args
        return Func(Scripts(Word(letter), run.small(order)), (run.lay(of),))

    return rule


def _make_distribution_rules(name: str, letter: str) -> dict[str, LayoutRule]:
    """Return the rules for a distribution function, P(T₉ ≤ x), and for its quantile, t₉ with p."""
    square = Digits("2") if letter == "χ" else None

    def lay_out_freedoms(run: _Layout, freedoms: Sequence[Expr]) -> Node:
        """Return the degrees of freedom in a row."""
        return _join_nodes([run.small(one) for one in freedoms], ",")

    def cdf(run: _Layout, args: tuple[Expr, ...]) -> Node:
        """Return the probability of a value up to the first argument."""
        value, *freedoms = args
        variable = Ident("T" if letter == "t" else letter)  # t is what it is compared with
        named = Scripts(variable, lay_out_freedoms(run, freedoms), square)
        below = (named, OperatorSign("≤"), run.lay_out_bracketed(value, SUM))
        return Func(Ident("P"), (MathRow(below, RELATION),))

    def quantile(run: _Layout, args: tuple[Expr, ...]) -> Node:
        """Return the value with the first argument as the share below it."""
        share, *freedoms = args
        indices = _join_nodes([lay_out_freedoms(run, freedoms), run.small(share)], ";")
        return Scripts(Ident(letter), indices, square)

    return {f"{name}_cdf": cdf, f"{name}_quantile": quantile}


# Relations and choices


def _make_relation_rule(sign: str) -> LayoutRule:
    """Return the rule for a relation of two sides."""

    def rule(run: _Layout, args: tuple[Expr, ...]) -> Node:
        """Return both sides with the sign between them."""
        left, right = (run.lay_out_bracketed(arg, SUM) for arg in args)
        return MathRow((left, OperatorSign(sign), right), RELATION)

    return rule


def _make_connective_rule(word: str) -> LayoutRule:
    """Return the rule for conditions joined by a word."""

    def rule(run: _Layout, args: tuple[Expr, ...]) -> Node:
        """Return the conditions; two bounds of one quantity as 0 ≤ x < 1."""
        between = _between_bounds(run, args) if word == "and" and len(args) == 2 else None
        if between is not None:
            return between
        items = [run.lay_out_bracketed(args[0], RELATION)]
        for arg in args[1:]:
            items += [ReaderWord(word), run.lay_out_bracketed(arg, RELATION)]
        return MathRow(tuple(items), WORDS)

    return rule


def _between_bounds(run: _Layout, args: tuple[Expr, ...]) -> Node | None:
    """Return ``x >= 0 and x < 1`` as 0 ≤ x < 1; None if it is no pair of bounds."""
    first, second = map(_order_comparison, args)
    if first is None or second is None:
        return None
    if first[2] != second[1]:
        first, second = second, first
    if first[2] != second[1]:
        return None
    parts = [run.lay_out_bracketed(expr, SUM) for expr in (first[1], first[2], second[2])]
    return MathRow(
        (parts[0], OperatorSign(first[0]), parts[1], OperatorSign(second[0]), parts[2]), RELATION
    )


def _order_comparison(expr: Expr) -> tuple[str, Expr, Expr] | None:
    """Return sign, lower and upper side of a comparison; None if it is none."""
    if not isinstance(expr, Call) or expr.op not in {"lt", "le", "gt", "ge"}:
        return None
    low, high = expr.args if expr.op in {"lt", "le"} else expr.args[::-1]
    return ("<" if expr.op in {"lt", "gt"} else "≤"), low, high


def _lay_out_negation(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the opposite relation, or *not* before what has none."""
    (arg,) = args
    if isinstance(arg, Call) and arg.op in _OPPOSITES:
        return run.lay(Call(_OPPOSITES[arg.op], arg.args))
    return MathRow((ReaderWord("not"), Fenced("()", run.lay(arg))), RELATION)


def _lay_out_cases(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the branches, the last one without a condition."""
    if len(args) % 2 == 0:
        raise ValueError
    pairs = zip(args[:-1:2], args[1::2], strict=True)
    rows = [(run.lay(value), run.lay(condition)) for value, condition in pairs]
    return Cases((*rows, (run.lay(args[-1]), None)))


def _lay_out_mean(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a mean: a bar above one letter, else the word."""
    nodes = tuple(map(run.lay, args))
    letter = len(args) == 1 and isinstance(args[0], Sym)
    return Accent("bar", nodes[0]) if letter else Func(Word("mean"), nodes)


def _lay_out_item(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a value at a place of a list, which is its index."""
    values, place = args
    return Scripts(add_brackets(run.lay(values), ATOM), run.small(place))


def _lay_out_pi(_run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the letter π."""
    if args:
        raise ValueError
    return Ident("π")


# Sums with bounds, and forms: matrices, sets, complex numbers


def _lay_out_matrix(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a matrix from its rows."""
    rows = [row.args for row in args if isinstance(row, Call)]
    return Matrix(tuple(tuple(map(run.lay, row)) for row in rows))


def _lay_out_vector(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a vector, as a column."""
    return Matrix(tuple((run.lay(arg),) for arg in args))


def _list_items(run: _Layout, args: tuple[Expr, ...], sign: str = ";") -> Node:
    """Return a row of arguments with a sign between them."""
    return _join_nodes(list(map(run.lay, args)), sign)


def _join_nodes(nodes: Sequence[Node], sign: str) -> Node:
    """Return nodes in a row with a sign between them; one alone as it is."""
    items = [item for node in nodes for item in (OperatorSign(sign), node)][1:]
    return items[0] if len(items) == 1 else MathRow(tuple(items), WORDS)


def _lay_out_set(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a finite set."""
    return Fenced("{}", _list_items(run, args))


def _lay_out_interval(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of an interval, whose last two arguments say if its ends belong to it."""
    low, high, *sides = args
    left, right = (isinstance(side, Num) and side.value for side in sides)
    fence = f"{'[' if left else '('}{']' if right else ')'}"
    return Fenced(fence, _list_items(run, (low, high), ","))


def _lay_out_union(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a union: "or" between its parts, empty braces for none."""
    if not args:
        return Fenced("{}", OperatorSign(" "))
    items = [run.lay(args[0])]
    for arg in args[1:]:
        items += [ReaderWord("or"), run.lay(arg)]
    return MathRow(tuple(items), WORDS)


def _lay_out_complex(run: _Layout, args: tuple[Expr, ...]) -> Node:
    """Return the layout of a complex number, without a part that is 0 or a factor 1."""
    real, imaginary = args
    unit: Expr = Call("mul", (imaginary, Sym("i")))
    minus, size = split_sign(imaginary)
    if size == Num(_ONE):
        unit = Call("neg", (Sym("i"),)) if minus else Sym("i")
    if real == Num(Fraction(0)):
        return run.lay(unit)
    return _lay_out_sum(run, (real, unit))


def _lay_out_infinity(_run: _Layout, _args: tuple[Expr, ...]) -> Node:
    """Return the layout of the sign of infinity."""
    return Ident("∞")


_RULES: dict[str, LayoutRule] = {
    **{
        row.name: _make_function_rule(row) for row in operators_with_syntax(OperatorSyntax.FUNCTION)
    },
    **{
        row.name: _make_function_rule(replace(row, name=row.signs[0], most=MANY))
        for row in operators_with_syntax(OperatorSyntax.LIST)
    },
    **{name: _make_order_rule(letter) for name, letter in _WITH_ORDER.items()},
    **{
        name: rule
        for called, letter in _DISTRIBUTIONS.items()
        for name, rule in _make_distribution_rules(called, letter).items()
    },
    "mean": _lay_out_mean,
    "at": _lay_out_item,
    "add": _lay_out_sum,
    "sub": _lay_out_difference,
    "neg": _lay_out_negative,
    "mul": _lay_out_product,
    "div": _lay_out_quotient,
    "mod": _lay_out_modulo,
    "pow": _lay_out_power_of,
    "exp": _lay_out_exponential,
    "sqrt": _lay_out_square_root,
    "not": _lay_out_negation,
    "piecewise": _lay_out_cases,
    "pi": _lay_out_pi,
    "factorial": _lay_out_factorial,
    "binomial": _lay_out_binomial,
    "sum": _make_series_rule("∑"),
    "product": _make_series_rule("∏"),
    "integral": _lay_out_integral,
    "and": _make_connective_rule("and"),
    "or": _make_connective_rule("or"),
    **{op: _make_relation_rule(sign) for op, sign in SIGNS.items()},
    **{op: _make_fence_rule(kind) for op, kind in FENCES.items()},
    "matrix": _lay_out_matrix,
    "vector": _lay_out_vector,
    "set": _lay_out_set,
    "interval": _lay_out_interval,
    "union": _lay_out_union,
    "complex": _lay_out_complex,
    "infinity": _lay_out_infinity,
}
