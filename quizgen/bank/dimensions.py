"""Whether units fit formulas: the dimension of every step, and of what is asked.

Values are in base units, so a formula of a step must have the dimension of the unit that the step
is shown in. Things that are counted (pixels, bits, grey levels, ...) come and go in formulas:
only kinds of quantities with a size are compared, and a formula of plain numbers alone may give any
(one second by the number on a dial), if its unit is a base unit: else a number that was meant in
that unit would be off by a factor.

Angles have a rule of their own, since a wrong one is off by 57 and looks well: inverse functions
give radians, as SymPy's do, and functions take them. ``180/pi`` times radians is degrees. So a step
in degrees may not be an angle in radians, nor a quotient of two lengths, which is one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction

from quizgen.bank.template import Template
from quizgen.core.errors import BankError
from quizgen.kinds.contract import asked_form, asked_quantities
from quizgen.maths.chain import ChainStep
from quizgen.maths.notation import format_tree, pretty
from quizgen.maths.operators import BINDERS, OPERATORS, OperatorSyntax, operators_with_syntax
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in
from quizgen.maths.units import UnitRegistry

COUNTED = frozenset({"px", "bit", "DN", "e-", "photon", "stop", "dB", "row", "frame", "lp"})
"""Base units that formulas do not keep."""

Dimension = Mapping[str, Fraction]

_ALIKE = frozenset({"add", "sub", "min", "max", "mod", "atan2", "eq", "ne", "lt", "le", "gt", "ge"})
"""Operators whose arguments are of one kind."""
_KEPT = frozenset({"add", "sub", "min", "max", "mod", "neg", "abs", "floor", "ceil", "round"})
"""Operators that give what they get."""
_LONGEST_FORMULA = 200
"""Most letters of a formula in a message."""
_TRIGONOMETRIC = frozenset({"sin", "cos", "tan"})
_INVERSE = frozenset({"asin", "acos", "atan", "atan2"})
_NUMBERS = frozenset({"exp", "ln", "log2", "log10", "asin", "acos", "atan", "erf", "erfc"})
"""Functions of plain numbers."""
_PLAIN = frozenset(
    row.name
    for row in operators_with_syntax(OperatorSyntax.FUNCTION)
    if row.name not in _ALIKE | _KEPT | _TRIGONOMETRIC | _INVERSE | _NUMBERS | BINDERS
    and row.name not in {"sqrt", "sign", "piecewise"}
)
"""The other functions of plain numbers: hyperbolic ones, factorials, distributions, ..."""
_DEGREES, _RADIANS = {"deg": Fraction(1)}, {"rad": Fraction(1)}
_PART_OF_TURN = 45
"""Degrees are made by 180/π, and half or double an angle by 90/π or 360/π."""
_ROOT = Fraction(1, 2)


_ENTRIES = frozenset({"complex", "matrix", "vector"})
"""Kinds whose answers are several numbers in one unit."""


class _ClashError(Exception):
    """Two kinds of quantities where one is needed."""


def find_unit_errors(template: Template) -> Iterator[BankError]:
    """Yield units that do not fit: of what is drawn, of steps, of what is asked.

    Each is an error with its code, file and place, for ``lint`` to list and for whatever draws
    numbers to raise; those that the template ignores are left out.
    """
    ignored = template.rules.ignore
    yield from (error for error in _iter_unit_errors(template) if error.rule not in ignored)


def _iter_unit_errors(template: Template) -> Iterator[BankError]:
    """Yield all errors in units, also those that the template ignores.

    A step that is wrong itself is reported once: a part that asks for it is passed over.
    """
    units = template.about.system
    for name, unit in template.chain.given.items():
        drawn = template.units[name]
        if _parse_unit_dimension(units, drawn) != _parse_unit_dimension(units, unit):
            what = f"draw.{name}: unit {drawn!r} is of another kind than {unit!r} in the solver"
            place = ("draw", name, "unit")
            yield BankError(what, rule="QG201", file=template.file, place=place)
    known = {
        name: _parse_unit_dimension(units, unit) for name, unit in template.chain.given.items()
    }
    wrong = set[str]()
    for step in template.chain.steps:
        for problem in _check_step(units, step, known):
            wrong.add(step.name)
            file = template.solver_file or template.file
            yield BankError(problem, rule="QG203", file=file, place=("Step", step.name))
        known[step.name] = _parse_unit_dimension(units, step.unit)
    for other in template.chain.alternatives:
        step = ChainStep(other.name, other.expr, template.chain.by_name[other.name].unit)
        for problem in _check_step(units, step, known):
            file, at = template.solver_file or template.file, ("alternatives", step.name)
            yield BankError(problem, rule="QG203", file=file, place=at)
    yield from _check_entries(template, known)
    for index, part in enumerate(template.rules.part):
        asked = part.answer.get("unit")
        for name in asked_quantities(part.answer) if isinstance(asked, str) else ():
            shown = template.units.get(name, "")
            fits = (
                _parse_unit_dimension(units, str(asked)) == _parse_unit_dimension(units, shown)
                or asked == "%"
                or name in wrong
            )
            if not fits:
                what = f"{name} is asked in {asked!r}, and its step is in {shown!r}"
                where = ("part", index, "answer", "unit")
                what = f"part {index + 1}: {what}"
                yield BankError(what, rule="QG202", file=template.file, place=where)


def _check_entries(template: Template, known: Mapping[str, Dimension]) -> Iterator[BankError]:
    """Yield complex numbers, vectors and matrices whose unit is not that of their formula.

    A matrix of different kinds of quantities has no unit.
    """
    for index, part in enumerate(template.rules.part):
        form = template.chain.form_by_name.get(asked_form(part.answer))
        if part.answer.get("kind") not in _ENTRIES or form is None:
            continue
        unit = str(part.answer.get("unit", ""))
        wanted = _remove_angles(_parse_unit_dimension(template.about.system, unit))
        try:
            inferred = [_infer_dimension(entry, known) for entry in _list_entries(form.expr)]
        except _ClashError as error:
            what = str(error)
        else:
            found = [_remove_angles(one) for one in inferred if one is not None]
            odd = [one for one in found if one != wanted]
            if not odd or (not unit and any(one != odd[0] for one in found)):
                continue
            what = f"is in {_format_dimension(odd[0])}, and is asked in {unit or 'no unit'!r}"
        said = f"part {index + 1}: {form.name} {what}"
        place = ("part", index, "answer")
        yield BankError(said, rule="QG202", file=template.file, place=place)


def _list_entries(expr: Expr) -> tuple[Expr, ...]:
    """Return the real numbers of a matrix, a vector or a complex number but zeros.

    Where drawn numbers choose among several, those of all of them.
    """
    if not isinstance(expr, Call):
        return () if expr == Num(Fraction(0)) else (expr,)
    if expr.op == "piecewise":
        return tuple(one for value in expr.args[::2] for one in _list_entries(value))
    if expr.op in {"complex", "matrix", "vector", "row"}:
        return tuple(one for arg in expr.args for one in _list_entries(arg))
    return (expr,)


def _check_step(
    units: UnitRegistry, step: ChainStep, known: Mapping[str, Dimension]
) -> Iterator[str]:
    """Yield what is wrong with the dimension of one step; ``known`` are the names before it."""
    formula = format_tree(step.expr)
    if len(formula) > _LONGEST_FORMULA:
        formula = f"{formula[:_LONGEST_FORMULA]} ..."
    written = f"step {step.name!r} = {formula}"
    try:
        found = _infer_dimension(step.expr, known)
    except _ClashError as error:
        yield f"{written}: {error}"
        return
    shown = _parse_unit_dimension(units, step.unit)
    plain = not any(known[name] for name in names_in(step.expr))
    if shown == _DEGREES and (found == _RADIANS or (found == {} and _is_angle(step.expr, plain))):
        yield f"{written} is in radians, and the step says {step.unit!r}: write 180/pi*(...)"
    elif found is not None and not plain and _remove_angles(found) != _remove_angles(shown):
        yield (
            f"{written} is in {_format_dimension(found)}, and "
            f"the step says {step.unit or 'a plain number'!r}"
        )
    elif plain and found == {} and shown and units.factor(step.unit) != 1:
        yield (
            f"{written} is a plain number, and formulas are in base units: 1 would be "
            f"{pretty.format_number(str(1 / units.factor(step.unit)))} {step.unit}. "
            f"Draw its numbers with their units"
        )
    elif shown == _RADIANS and found == _DEGREES:
        yield f"{written} is in degrees, and the step says {step.unit!r}: write pi/180*(...)"


def _is_angle(expr: Expr, plain: bool) -> bool:
    """Return whether a formula without a unit must be an angle in radians.

    So is what has lengths that cancel (an arc by its radius) or a π in it. ``360/n`` is not.
    """
    return not plain or "pi" in {call.op for call in _iter_calls(expr)}


def _iter_calls(expr: Expr) -> Iterator[Call]:
    """Yield every operation of a formula, from the outside in."""
    if isinstance(expr, Call):
        yield expr
        for arg in expr.args:
            yield from _iter_calls(arg)


def _remove_angles(dimension: Dimension) -> Dimension:
    """Return a dimension without degrees and radians, which are plain numbers to the others."""
    return {base: power for base, power in dimension.items() if base not in {"deg", "rad"}}


def _parse_unit_dimension(units: UnitRegistry, text: str) -> Dimension:
    """Return base units and exponents of a unit, without those that are counts."""
    powers = units.unit(text).dimension
    return {base: Fraction(power) for base, power in powers if base not in COUNTED}


def _format_dimension(dimension: Dimension) -> str:
    """Return a dimension in plain text, such as ``m*s^-1``."""
    powers = (base if power == 1 else f"{base}^{power}" for base, power in dimension.items())
    hint = (
        ' (draw it in K, too: T = { is = "t + 273.15", unit = "K" })' if "°C" in dimension else ""
    )
    return ("*".join(powers) or "plain numbers") + hint


def _infer_dimension(expr: Expr, known: Mapping[str, Dimension]) -> Dimension | None:
    """Return the dimension of a formula; None if it fits any (as zero does).

    Raises ``_ClashError`` where two kinds of quantities are combined.
    """
    if isinstance(expr, Num):
        return None if expr.value == 0 else {}
    if isinstance(expr, Sym):
        return known[expr.name]
    if expr.op in BINDERS and isinstance(expr.args[0], Sym):
        return _infer_binder_dimension(expr, {**known, expr.args[0].name: {}})
    if expr.op in _PLAIN:
        args = [_infer_dimension(arg, known) for arg in expr.args]
        if any(args):
            raise _ClashError(f"{expr.op} needs plain numbers")
        return {}
    if OPERATORS[expr.op].typed is OperatorSyntax.LIST:
        return _infer_list_dimension(expr, [_infer_dimension(arg, known) for arg in expr.args])
    return _infer_call_dimension(expr, [_infer_dimension(arg, known) for arg in expr.args])


def _infer_binder_dimension(call: Call, known: Mapping[str, Dimension]) -> Dimension | None:
    """Return the dimension of a sum; of a product or an integral only that of plain numbers."""
    found = _infer_dimension(call.args[3], known)
    if call.op == "integral":
        bounds = _require_common_dimension(
            call, [_infer_dimension(a, known) for a in call.args[1:3]]
        )
        return _add_dimensions(found, bounds)
    if call.op == "product" and found:
        raise _ClashError("a product over units whose number is not fixed")
    return found


def _add_dimensions(first: Dimension | None, second: Dimension | None) -> Dimension | None:
    """Return the dimension of a product of two; one that is not known (None) counts as plain."""
    if first is None or second is None:
        return first if second is None else second
    total = {base: first.get(base, Fraction(0)) + second.get(base, Fraction(0))
             for base in {*first, *second}}  # fmt: skip
    return {base: power for base, power in total.items() if power}


def _infer_call_dimension(call: Call, args: list[Dimension | None]) -> Dimension | None:
    """Return the dimension of a call from those of its arguments, as ``_infer_dimension``."""
    if call.op == "piecewise":
        return _require_common_dimension(call, args[::2])
    if call.op in _ALIKE:
        one = _require_common_dimension(call, args)
        if call.op in _INVERSE:
            return _RADIANS
        return one if call.op in _KEPT else {}
    if call.op in _KEPT:
        return args[0]
    if call.op in _TRIGONOMETRIC:
        if args[0] == _DEGREES:
            raise _ClashError(f"{call.op} of degrees, where radians are needed: write pi/180*(...)")
        args = [_remove_angles(args[0]) if args[0] else args[0]]
    if call.op in _NUMBERS or call.op in _TRIGONOMETRIC:
        if args[0]:
            raise _ClashError(
                f"{call.op} of {_format_dimension(args[0])}, where a plain number is needed"
            )
        return _RADIANS if call.op in _INVERSE else {}
    return _infer_product_dimension(call, args)


def _infer_list_dimension(call: Call, args: list[Dimension | None]) -> Dimension | None:
    """Return the dimension of a figure of lists: that of their values unless it says otherwise."""
    if call.op in {"len", "corr"}:
        return {}
    first, other = args[0], args[-1]
    if first is None or other is None:
        return None
    if call.op in {"var", "pvar"}:
        return _scale_dimension(first, Fraction(2))
    if call.op in {"cov", "slope"}:
        sign = 1 if call.op == "cov" else -1
        return _multiply_dimensions([other, first], sign)
    return first


def _require_common_dimension(call: Call, args: list[Dimension | None]) -> Dimension | None:
    """Return the one dimension of all arguments; None if they fit any.

    Raises ``_ClashError`` if two differ.
    """
    found = [arg for arg in args if arg is not None]
    for other in found[1:]:
        if other != found[0] and _remove_angles(other) != _remove_angles(found[0]):
            both = f"{_format_dimension(found[0])} and {_format_dimension(other)}"
            raise _ClashError(f"{both} cannot be put together by {call.op!r}")
    return found[0] if found else None


def _infer_product_dimension(call: Call, args: list[Dimension | None]) -> Dimension | None:
    """Return the dimension of a power, root, product or quotient; None if it fits any."""
    if any(arg is None for arg in args):
        return None
    known = [arg for arg in args if arg is not None]
    if call.op == "pow":
        power = call.args[1]
        if isinstance(power, Num):
            return _scale_dimension(known[0], power.value)
        return None if known[0] else {}
    if call.op == "sqrt":
        return _scale_dimension(known[0], _ROOT)
    if call.op in {"mul", "div"}:
        product = _multiply_dimensions(known, -1 if call.op == "div" else 1)
        return _convert_angle(call, product)
    return {}


def _convert_angle(call: Call, product: Dimension) -> Dimension:
    """Return degrees for 180/π times radians, radians for π/180 times degrees, else ``product``."""
    ratio, pi_power = _extract_constant_factor(call)
    if product == _RADIANS and pi_power == -1 and ratio.numerator % _PART_OF_TURN == 0:
        return _DEGREES
    if product == _DEGREES and pi_power == 1 and ratio.denominator % _PART_OF_TURN == 0:
        return _RADIANS
    return product


def _extract_constant_factor(expr: Expr) -> tuple[Fraction, int]:
    """Return the numbers that a product holds, multiplied, and its power of π."""
    if isinstance(expr, Num):
        return (expr.value or Fraction(1)), 0
    if not isinstance(expr, Call):
        return Fraction(1), 0
    if expr.op == "pi":
        return Fraction(1), 1
    if expr.op == "neg":
        return _extract_constant_factor(expr.args[0])
    if expr.op not in {"mul", "div"}:
        return Fraction(1), 0
    ratio, power = _extract_constant_factor(expr.args[0])
    for arg in expr.args[1:]:
        other, pis = _extract_constant_factor(arg)
        ratio, power = (
            (ratio * other, power + pis) if expr.op == "mul" else (ratio / other, power - pis)
        )
    return ratio, power


def _scale_dimension(dimension: Dimension, power: Fraction) -> Dimension:
    """Return a dimension with each exponent multiplied by ``power``."""
    return {base: size * power for base, size in dimension.items() if power}


def _multiply_dimensions(factors: list[Dimension], sign: int) -> Dimension:
    """Return the dimension of a product (``sign`` 1) or quotient (``sign`` -1)."""
    total = dict(factors[0])
    for other in factors[1:]:
        for base, size in other.items():
            total[base] = total.get(base, Fraction(0)) + sign * size
    return {base: size for base, size in total.items() if size}
