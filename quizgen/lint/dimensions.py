"""Whether units fit formulas: the dimension of every step, and of what is asked.

Values are in base units, so a formula of a step must have the dimension of the unit that the step
is shown in. Things that are counted (pixels, bits, grey levels, ...) come and go in formulas, and
so do degrees: only kinds of quantities with a size are compared, and a formula of plain numbers
alone may give any (one second by the number on a dial).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction

from quizgen.bank.template import Template
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.kinds.contract import asked_quantities
from quizgen.maths.chain import ChainStep
from quizgen.maths.notation import format_tree
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in
from quizgen.maths.units import UnitRegistry

COUNTED = frozenset({"px", "bit", "DN", "e-", "photon", "stop", "dB", "row", "frame", "lp", "deg"})
"""Base units that formulas do not keep."""

Dimension = Mapping[str, Fraction]

_ALIKE = frozenset({"add", "sub", "min", "max", "mod", "atan2", "eq", "ne", "lt", "le", "gt", "ge"})
"""Operators whose arguments are of one kind."""
_KEPT = frozenset({"add", "sub", "min", "max", "mod", "neg", "abs", "floor", "ceil", "round"})
"""Operators that give what they get."""
_NUMBERS = frozenset({"exp", "ln", "log2", "log10", "sin", "cos", "tan", "asin", "acos", "atan",
                      "erf", "erfc"})  # fmt: skip
"""Functions of plain numbers."""
_ROOT = Fraction(1, 2)


class _ClashError(Exception):
    """Two kinds of quantities where one is needed."""


def check_dimensions(template: Template) -> Iterator[Diagnostic]:
    """Yield units that do not fit: of drawn values, of steps, of what is asked."""
    units = template.about.system
    for name, unit in template.chain.given.items():
        drawn = template.units[name]
        if _parse_unit_dimension(units, drawn) != _parse_unit_dimension(units, unit):
            what = f"draw.{name}: unit {drawn!r} is of another kind than {unit!r} in the solver"
            yield diagnose("QG201", template.file, what, ("draw", name, "unit"))
    known = {
        name: _parse_unit_dimension(units, unit) for name, unit in template.chain.given.items()
    }
    wrong = set[str]()
    for step in template.chain.steps:
        for problem in _check_step(units, step, known):
            wrong.add(step.name)
            file = template.solver_file or template.file
            yield diagnose("QG203", file, problem, ("Step", step.name))
        known[step.name] = _parse_unit_dimension(units, step.unit)
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
                place = ("part", index, "answer", "unit")
                yield diagnose("QG202", template.file, f"part {index + 1}: {what}", place)


def _check_step(
    units: UnitRegistry, step: ChainStep, known: Mapping[str, Dimension]
) -> Iterator[str]:
    """Yield what is wrong with the dimension of one step; ``known`` are the names before it."""
    written = f"step {step.name!r} = {format_tree(step.expr)}"
    try:
        found = _infer_dimension(step.expr, known)
    except _ClashError as error:
        yield f"{written}: {error}"
        return
    plain = not any(known[name] for name in names_in(step.expr))
    if found is not None and not plain and found != _parse_unit_dimension(units, step.unit):
        yield (
            f"{written} is in {_format_dimension(found)}, and "
            f"the step says {step.unit or 'a plain number'!r}"
        )


def _parse_unit_dimension(units: UnitRegistry, text: str) -> Dimension:
    """Return base units and exponents of a unit, without those that are counts."""
    powers = units.unit(text).dimension
    return {base: Fraction(power) for base, power in powers if base not in COUNTED}


def _format_dimension(dimension: Dimension) -> str:
    """Return a dimension in plain text, such as ``m*s^-1``."""
    powers = (base if power == 1 else f"{base}^{power}" for base, power in dimension.items())
    return "*".join(powers) or "plain numbers"


def _infer_dimension(expr: Expr, known: Mapping[str, Dimension]) -> Dimension | None:
    """Return the dimension of a formula; None if it fits any (as zero does).

    Raises ``_ClashError`` where two kinds of quantities are combined.
    """
    if isinstance(expr, Num):
        return None if expr.value == 0 else {}
    if isinstance(expr, Sym):
        return known[expr.name]
    return _infer_call_dimension(expr, [_infer_dimension(arg, known) for arg in expr.args])


def _infer_call_dimension(call: Call, args: list[Dimension | None]) -> Dimension | None:
    """Return the dimension of a call from those of its arguments, as ``_infer_dimension``."""
    if call.op == "piecewise":
        return _require_common_dimension(call, args[::2])
    if call.op in _ALIKE:
        one = _require_common_dimension(call, args)
        return one if call.op in _KEPT else {}
    if call.op in _KEPT:
        return args[0]
    if call.op in _NUMBERS:
        if args[0]:
            raise _ClashError(
                f"{call.op} of {_format_dimension(args[0])}, where a plain number is needed"
            )
        return {}
    return _infer_product_dimension(call, args)


def _require_common_dimension(call: Call, args: list[Dimension | None]) -> Dimension | None:
    """Return the one dimension of all arguments; None if they fit any.

    Raises ``_ClashError`` if two differ.
    """
    found = [arg for arg in args if arg is not None]
    for other in found[1:]:
        if other != found[0]:
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
        return _multiply_dimensions(known, -1 if call.op == "div" else 1)
    return {}


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
