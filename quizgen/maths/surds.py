"""Constants that are a fraction times pi or a root, as a person writes them: ``3*sqrt(2)/2``.

Sine, cosine and tangent of multiples of 30° and 45° are such constants, and so are the angles that
belong to them.
"""

from __future__ import annotations

from fractions import Fraction

from quizgen.maths.tree import Call, Expr, Num

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
    if expr.op == "neg":
        inner = split_constant(expr.args[0])
        return inner and (-inner[0], inner[1])
    match expr:
        case Call("mul", (Num(value=factor), other)) if inner := split_constant(other):
            return inner[0] * factor, inner[1]
        case Call("div", (other, Num(value=divisor))) if divisor and (
            inner := split_constant(other)
        ):
            return inner[0] / divisor, inner[1]
    return None


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
