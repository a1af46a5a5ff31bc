"""Whether a formula has the form asked: factored, expanded, in lowest terms."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.grading.judging.algebraic_equality import convert_to_quotient, is_rational
from quizgen.maths.tree import Call, Expr, Num, names_in, walk_tree

_SUMS = frozenset({"add", "sub"})


def has_form(tree: Expr, form: str) -> bool:
    """Whether a formula is written in a form; of a form without a name it always is."""
    if form == "factored":
        return all(map(_is_irreducible, _iter_factors(tree)))
    if form == "expanded":
        return not any(map(_multiplies_sums, walk_tree(tree)))
    return form != "lowest" or _is_in_lowest_terms(tree)


def _iter_factors(tree: Expr) -> Iterator[Expr]:
    """Yield the factors of a product, whatever their powers."""
    if isinstance(tree, Call) and tree.op in {"mul", "div", "neg"}:
        for arg in tree.args:
            yield from _iter_factors(arg)
    elif isinstance(tree, Call) and tree.op == "pow" and isinstance(tree.args[1], Num):
        yield from _iter_factors(tree.args[0])
    else:
        yield tree


def _is_irreducible(factor: Expr) -> bool:
    """Whether a sum cannot be written as a product; of functions only that it is none.

    A whole number that all its terms have is a factor, too: ``2x + 2`` is not finished.
    """
    if not isinstance(factor, Call) or factor.op not in _SUMS:
        return True
    if not is_rational(factor):
        return True
    try:
        top, _ = convert_to_quotient(factor, tuple(sorted(names_in(factor))))
        content, factors = top.factor()
    except (ValueError, ZeroDivisionError):
        return True
    return abs(content.numer()) == 1 and sum(int(power) for _, power in factors) <= 1


def _multiplies_sums(node: Expr) -> bool:
    """Whether brackets with a sum could still be multiplied out."""
    if not isinstance(node, Call):
        return False
    if node.op == "mul":
        return any(_is_sum(arg) for arg in node.args)
    if node.op == "neg":
        return _is_sum(node.args[0])
    whole = node.op == "pow" and isinstance(node.args[1], Num) and node.args[1].value > 1
    return whole and _is_sum(node.args[0])


def _is_sum(node: Expr) -> bool:
    """Return whether a formula is a sum or a difference."""
    return isinstance(node, Call) and node.op in _SUMS


def _is_in_lowest_terms(tree: Expr) -> bool:
    """Return whether numerator and denominator have no common factor.

    A formula that is no quotient of polynomials has nothing to cancel, so it passes.
    """
    if not is_rational(tree):
        return True
    try:
        top, bottom = convert_to_quotient(tree, tuple(sorted(names_in(tree))))
        return bool(top.gcd(bottom).is_constant())
    except (ValueError, ZeroDivisionError):
        return True
