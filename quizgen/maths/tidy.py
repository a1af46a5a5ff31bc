"""Formulas with numbers in place, as a person writes them: no ``1*x``, no ``+ -3``, no ``x^1``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from math import isqrt

from quizgen.maths.tree import Call, Expr, Num, Sym

_ZERO, _ONE = Num(Fraction(0)), Num(Fraction(1))
LARGEST_EXPONENT = 64
"""Largest exponent to which a number is raised."""
LARGEST_RADICAND = 10**12
"""Largest number under a root from which squares are taken out."""


PI = Call("pi", ())
_HALF = Fraction(1, 2)
_TWELFTH = 12
"""Parts of pi that angles are counted in."""
_COSINES = {0: (Fraction(1), 1), 2: (_HALF, 3), 3: (_HALF, 2), 4: (_HALF, 1), 6: (Fraction(0), 1)}
"""Twelfth of pi to (a, b): its cosine is a times the square root of b."""
_TANGENTS = {0: (Fraction(0), 1), 2: (Fraction(1, 3), 3), 3: (Fraction(1), 1), 4: (Fraction(1), 3)}


def split_constant(expr: Expr) -> tuple[Fraction, Expr] | None:
    """Return a constant as a fraction and pi or a root, else None: ``-5*pi/4`` is (-5/4, pi)."""
    if not isinstance(expr, Call):
        return None
    if expr == PI or (expr.op == "sqrt" and isinstance(expr.args[0], Num)):
        return Fraction(1), expr
    factor, body = _split_factor(expr)
    inner = split_constant(body) if factor else None
    return inner and (inner[0] * factor, inner[1])


def _split_factor(expr: Call) -> tuple[Fraction, Expr]:
    """Return the number before or below a product, and the rest; 0 if there is none."""
    none = Fraction(0), expr
    if expr.op == "neg":
        return Fraction(-1), expr.args[0]
    if expr.op not in {"mul", "div"} or len(expr.args) != len(("one", "other")):
        return none
    first, second = expr.args
    if expr.op == "mul":
        return (first.value, second) if isinstance(first, Num) else none
    return (1 / second.value, first) if isinstance(second, Num) and second.value else none


def write_multiple(number: Fraction, rest: Expr) -> Expr:
    """Return a fraction times a constant: (-5/4, pi) is ``-5*pi/4``."""
    if not number:
        return Num(Fraction(0))
    top, below = abs(number.numerator), number.denominator
    factors = rest.args if isinstance(rest, Call) and rest.op == "mul" else (rest,)
    over = rest if top == 1 else Call("mul", (Num(Fraction(top)), *factors))
    value = over if below == 1 else Call("div", (over, Num(Fraction(below))))
    return value if number > 0 else Call("neg", (value,))


def find_special_value(op: str, angle: Expr) -> Expr | None:
    """Return sine, cosine or tangent of an angle, where it is a fraction times a root."""
    parts = (Fraction(0), PI) if angle == Num(Fraction(0)) else split_constant(angle)
    if parts is None or parts[1] != PI or (times := parts[0] * _TWELFTH).denominator != 1:
        return None
    turn = int(times)
    if op == "tan":
        turn %= _TWELFTH
        mirrored = turn > _TWELFTH // 2
        found = _TANGENTS.get(_TWELFTH - turn if mirrored else turn)
    else:
        turn = (turn if op == "cos" else turn - _TWELFTH // 2) % (2 * _TWELFTH)
        turn = min(turn, 2 * _TWELFTH - turn)
        mirrored = turn > _TWELFTH // 2
        found = _COSINES.get(_TWELFTH - turn if mirrored else turn)
    if found is None:
        return None
    number = -found[0] if mirrored else found[0]
    return _write_root(number, found[1])


def find_special_angle(op: str, value: Expr) -> Expr | None:
    """Return the angle of an inverse sine, cosine or tangent, where it is a fraction of pi."""
    table = _TANGENTS if op == "atan" else _COSINES
    parts = (value.value, None) if isinstance(value, Num) else split_constant(value)
    if parts is None:
        return None
    number, rest = parts
    for turn, (size, under) in table.items():
        if abs(number) == size and _write_root(size, under) == _write_size(size, rest):
            angle = turn if op != "asin" else _TWELFTH // 2 - turn
            turned = angle if number >= 0 else (_TWELFTH - angle if op == "acos" else -angle)
            return write_multiple(Fraction(turned, _TWELFTH), PI)
    return None


def _write_root(number: Fraction, under: int) -> Expr:
    """Return a fraction times a square root."""
    if under == 1 or not number:
        return Num(number)
    return write_multiple(number, Call("sqrt", (Num(Fraction(under)),)))


def _write_size(size: Fraction, rest: Expr | None) -> Expr:
    """Return a fraction times what else there is."""
    return Num(size) if rest is None else write_multiple(size, rest)


def tidy_formula(expr: Expr) -> Expr:
    """Return an equal formula with its numbers reckoned together and nothing idle in it.

    Products stay products and sums stay sums: what was factored stays so.
    """
    if not isinstance(expr, Call):
        return expr
    args = tuple(tidy_formula(arg) for arg in expr.args)
    rule = _RULES.get(expr.op)
    return Call(expr.op, args) if rule is None else rule(args)


def _is_value(expr: Expr, value: int) -> bool:
    """Return whether a formula is this number."""
    return isinstance(expr, Num) and expr.value == value


def negate_formula(expr: Expr) -> Expr:
    """Return the opposite, with the sign where a person writes it."""
    if isinstance(expr, Num):
        return Num(-expr.value, expr.decimal)
    if isinstance(expr, Call) and expr.op == "neg":
        return expr.args[0]
    if isinstance(expr, Call) and expr.op in {"mul", "div"} and isinstance(expr.args[0], Num):
        return tidy_formula(Call(expr.op, (negate_formula(expr.args[0]), *expr.args[1:])))
    return Call("neg", (expr,))


def _tidy_negative(args: tuple[Expr, ...]) -> Expr:
    """Return the opposite of a formula, without a second minus sign."""
    return negate_formula(args[0])


def _tidy_sum(args: tuple[Expr, ...]) -> Expr:
    """Return a sum with its numbers added up, in the place of the first of them.

    So are multiples of pi, of one root, and of one power of a name: ``x^2 - 3*x - 2*x``.
    """
    args = _join_like_terms(args)
    terms: list[Expr] = []
    total, place = Fraction(0), -1
    sums: dict[Expr, Fraction] = {}
    for term in _iter_terms(args):
        if isinstance(term, Num):
            total += term.value
            place = len(terms) if place < 0 else place
        elif constant := split_constant(term):
            number, rest = constant
            if rest not in sums:
                terms.append(rest)
            sums[rest] = sums.get(rest, Fraction(0)) + number
        else:
            terms.append(term)
    terms = [write_multiple(sums[term], term) if term in sums else term for term in terms]
    terms = [term for term in terms if not _is_value(term, 0)]
    place = min(place, len(terms))
    if total:
        terms.insert(place, Num(total))
    if not terms:
        return _ZERO
    return _join_terms(terms)


def _join_like_terms(terms: tuple[Expr, ...]) -> tuple[Expr, ...]:
    """Return the terms of a sum, multiples of one product of powers put together if there are any.

    They stand where the first of them stood; without any the sum stays as it was written.
    """
    found = [(term, _split_monomial(term)) for term in _iter_signed_terms(terms)]
    sums = dict[Expr, Fraction]()
    for _, monomial in found:
        if monomial:
            sums[monomial[1]] = sums.get(monomial[1], Fraction(0)) + monomial[0]
    if len(sums) == sum(monomial is not None for _, monomial in found):
        return terms
    joined = list[Expr]()
    for term, monomial in found:
        if monomial is None:
            joined.append(term)
        elif monomial[1] in sums:
            joined.append(_tidy_product((Num(sums.pop(monomial[1])), monomial[1])))
    return tuple(joined)


def _iter_signed_terms(terms: Iterable[Expr]) -> Iterable[Expr]:
    """Yield the terms of a sum and of the sums and differences in it, each with its sign."""
    for term in _flatten("add", terms):
        if isinstance(term, Call) and term.op == "sub":
            yield from _iter_signed_terms(term.args[:1])
            yield from map(negate_formula, _iter_signed_terms(term.args[1:]))
        else:
            yield term


def _split_monomial(term: Expr) -> tuple[Fraction, Expr] | None:
    """Return factor and rest of a number times powers of names; None if it is anything else."""
    minus, size = _split_minus(term)
    factor = Fraction(-1 if minus else 1)
    if isinstance(size, Call) and size.op == "div" and isinstance(size.args[1], Num):
        factor, size = factor / size.args[1].value, size.args[0]
    if isinstance(size, Call) and size.op == "mul" and isinstance(size.args[0], Num):
        factor *= size.args[0].value
        size = size.args[1] if len(size.args) == 2 else Call("mul", size.args[1:])
    powers = size.args if isinstance(size, Call) and size.op == "mul" else (size,)
    bases = [one.args[0] if isinstance(one, Call) and one.op == "pow" else one for one in powers]
    return (factor, size) if all(isinstance(base, Sym) for base in bases) else None


def _iter_terms(args: Iterable[Expr]) -> Iterable[Expr]:
    """Yield the terms of a sum, also of sums and differences of constants within it."""
    for term in _flatten("add", args):
        if isinstance(term, Call) and term.op == "sub" and all(map(_is_constant, term.args)):
            yield from (*_iter_terms(term.args[:1]), negate_formula(term.args[1]))
        else:
            yield term


def _is_constant(expr: Expr) -> bool:
    """Return whether a formula is a number, or a multiple of pi or of a root."""
    return isinstance(expr, Num) or split_constant(expr) is not None


def _join_terms(terms: list[Expr]) -> Expr:
    """Return a sum from left to right, with a minus where a term is negative."""
    result, *rest = terms
    run = False
    for term in rest:
        minus, value = _split_minus(term)
        if minus:
            result, run = Call("sub", (result, value)), False
        elif run and isinstance(result, Call):
            result = Call("add", (*result.args, value))
        else:
            result, run = Call("add", (result, value)), True
    return result


def _split_minus(term: Expr) -> tuple[bool, Expr]:
    """Whether a term is negative at sight, and its opposite if so."""
    if isinstance(term, Num):
        return term.value < 0, negate_formula(term) if term.value < 0 else term
    if not isinstance(term, Call) or term.op not in {"neg", "mul", "div"}:
        return False, term
    if term.op == "neg":
        return True, term.args[0]
    minus, first = _split_minus(term.args[0])
    return minus, tidy_formula(Call(term.op, (first, *term.args[1:]))) if minus else term


def _tidy_difference(args: tuple[Expr, ...]) -> Expr:
    """Return a difference without zeros and without a minus sign on the second term."""
    first, second = args
    if isinstance(first, Num) and isinstance(second, Num):
        return Num(first.value - second.value)
    if _is_value(second, 0):
        return first
    if _is_value(first, 0):
        return negate_formula(second)
    if isinstance(second, Num) and second.value < 0:
        return _tidy_sum((first, negate_formula(second)))
    minus, value = _split_minus(second)
    signed = first, negate_formula(second)
    if all(map(_is_constant, args)) or _join_like_terms(signed) != signed:
        return _tidy_sum(signed)
    return _tidy_sum((first, value)) if minus else Call("sub", args)


def _flatten(op: str, args: Iterable[Expr]) -> Iterable[Expr]:
    """Yield the arguments of an operator, with those of the same operator within them."""
    for arg in args:
        if isinstance(arg, Call) and arg.op == op:
            yield from _flatten(op, arg.args)
        else:
            yield arg


def _tidy_product(args: tuple[Expr, ...]) -> Expr:
    """Return a product with one number in front, and the minus sign in front of that."""
    factors: list[Expr] = []
    number, minus = Fraction(1), False
    for arg in _flatten("mul", args):
        factor = arg
        if isinstance(factor, Call) and factor.op == "neg":
            minus, factor = not minus, factor.args[0]
        if isinstance(factor, Num):
            number *= factor.value
        elif constant := split_constant(factor):
            number *= constant[0]
            factors.append(constant[1])
        else:
            factors.append(factor)
    number = -number if minus else number
    number, factors = _join_roots(number, factors)
    if not number:
        return _ZERO
    if not factors:
        return Num(number)
    if all(map(_is_constant, factors)):
        rest = factors[0] if len(factors) == 1 else Call("mul", tuple(factors))
        return write_multiple(number, rest)
    constants = [factor for factor in factors if _is_constant(factor)]
    if constants and number.denominator > 1:
        rest = constants[0] if len(constants) == 1 else Call("mul", tuple(constants))
        others = (factor for factor in factors if factor not in constants)
        whole = Call("mul", (write_multiple(abs(number), rest), *others))
        return whole if number > 0 else Call("neg", (whole,))
    if abs(number) != 1:
        factors.insert(0, Num(abs(number)))
    product = factors[0] if len(factors) == 1 else Call("mul", tuple(factors))
    return product if number > 0 else Call("neg", (product,))


def _join_roots(number: Fraction, factors: list[Expr]) -> tuple[Fraction, list[Expr]]:
    """Return a number and factors that hold one root of a number at most."""
    under, rest = Fraction(1), list[Expr]()
    for factor in factors:
        if isinstance(factor, Call) and factor.op == "sqrt" and isinstance(factor.args[0], Num):
            under *= factor.args[0].value
        else:
            rest.append(factor)
    if under == 1 or len(factors) - len(rest) == 1:
        return number, factors
    root = _tidy_root((Num(under),))
    if isinstance(root, Num):
        return number * root.value, rest
    size, one = split_constant(root) or (Fraction(1), root)
    return number * size, [one, *rest]


def _tidy_quotient(args: tuple[Expr, ...]) -> Expr:
    """Return a quotient with numbers divided, and a minus sign in front of all of it."""
    top, bottom = args
    if isinstance(bottom, Num) and bottom.value:
        if isinstance(top, Num):
            return Num(top.value / bottom.value)
        return _divide_by_number(top, bottom.value)
    if _is_value(top, 0):
        return _ZERO
    if (below := split_constant(bottom)) and below[0] and _is_constant(top):
        size, rest = below
        if isinstance(rest, Call) and rest.op == "sqrt" and isinstance(rest.args[0], Num):
            return _tidy_product((top, Num(1 / size / rest.args[0].value), rest))
    if isinstance(bottom, Call) and bottom.op == "neg":
        return negate_formula(Call("div", (top, bottom.args[0])))
    return Call("div", (top, bottom))


def _divide_by_number(top: Expr, bottom: Fraction) -> Expr:
    """Return a formula over a number: ``6*x/4`` becomes ``3*x/2``."""
    minus = isinstance(top, Call) and top.op == "neg"
    inner = top.args[0] if minus and isinstance(top, Call) else top
    first, rest = Fraction(1), tuple[Expr, ...]((inner,))
    if isinstance(inner, Call) and inner.op == "mul" and isinstance(inner.args[0], Num):
        first, rest = inner.args[0].value, inner.args[1:]
    factor = (-first if minus else first) / bottom
    over = _tidy_product((Num(Fraction(abs(factor.numerator))), *rest))
    below = factor.denominator
    quotient = over if below == 1 else Call("div", (over, Num(Fraction(below))))
    return quotient if factor > 0 else Call("neg", (quotient,))


def _tidy_power(args: tuple[Expr, ...]) -> Expr:
    """Return a power without the exponents 0, 1 and 1/2 and without negative ones.

    0^0 and large powers of numbers remain as they are.
    """
    base, exponent = args
    if isinstance(exponent, Num):
        if exponent.value == 1:
            return base
        if exponent.value == 0 and not _is_value(base, 0):
            return _ONE
        whole = exponent.value.denominator == 1 and abs(exponent.value) <= LARGEST_EXPONENT
        if whole and isinstance(base, Num) and (base.value or exponent.value > 0):
            return Num(base.value ** int(exponent.value))
        if exponent.value == Fraction(1, 2):
            return _tidy_root((base,))
        if exponent.value < 0 and not isinstance(base, Num):
            return Call("div", (_ONE, _tidy_power((base, negate_formula(exponent)))))
    return Call("pow", args)


def _tidy_root(args: tuple[Expr, ...]) -> Expr:
    """Take squares out: ``sqrt(27/4)`` becomes ``3*sqrt(3)/2``."""
    (body,) = args
    if not isinstance(body, Num) or body.value < 0 or body.value.numerator > LARGEST_RADICAND:
        return Call("sqrt", args)
    top, bottom = body.value.numerator, body.value.denominator
    outside, inside = _take_squares_out(top * bottom)
    factor = Fraction(outside, bottom)
    if inside == 1:
        return Num(factor)
    root = Call("sqrt", (Num(Fraction(inside)),))
    over = _tidy_product((Num(Fraction(factor.numerator)), root))
    below = factor.denominator
    return over if below == 1 else Call("div", (over, Num(Fraction(below))))


def _take_squares_out(value: int) -> tuple[int, int]:
    """Return (a, b) so that the value is a² b, with b as free of squares as is easily found.

    Prime factors below 10,000 are tried, so that a large number costs little.
    """
    outside, inside, divisor = 1, value, 2
    while divisor * divisor <= inside and divisor < 10_000:
        while inside % (divisor * divisor) == 0:
            inside, outside = inside // (divisor * divisor), outside * divisor
        divisor += 1
    root = isqrt(inside)
    return (outside * root, 1) if root * root == inside else (outside, inside)


def _make_point_rule(op: str, at: int, value: int) -> Callable[[tuple[Expr, ...]], Expr]:
    """Return the rule that gives an operator's value at one point, as ln(1) = 0."""

    def rule(args: tuple[Expr, ...]) -> Expr:
        """Return the value if the argument is that point, else the call as it was."""
        return Num(Fraction(value)) if _is_value(args[0], at) else Call(op, args)

    return rule


def _make_special_rule(
    op: str, find: Callable[[str, Expr], Expr | None]
) -> Callable[[tuple[Expr, ...]], Expr]:
    """Return the rule for a function with exact values at special places."""

    def rule(args: tuple[Expr, ...]) -> Expr:
        """Return the exact value where there is one, else the call as it was."""
        found = find(op, args[0])
        return Call(op, args) if found is None else found

    return rule


_RULES: dict[str, Callable[[tuple[Expr, ...]], Expr]] = {
    "neg": _tidy_negative,
    "add": _tidy_sum,
    "sub": _tidy_difference,
    "mul": _tidy_product,
    "div": _tidy_quotient,
    "pow": _tidy_power,
    "sqrt": _tidy_root,
    "exp": _make_point_rule("exp", 0, 1),
    "ln": _make_point_rule("ln", 1, 0),
    **{op: _make_special_rule(op, find_special_value) for op in ("sin", "cos", "tan")},
    **{op: _make_special_rule(op, find_special_angle) for op in ("asin", "acos", "atan")},
}
