"""The one table of operators: name, number of arguments, how it is typed, what does it where.

A new operator is one row. A number system looks a row's function up by name, first among its own
helpers (``exact``, ``floats``), then in its library (``math``, NumPy, SymPy, a ball's methods):
under the name of the operator unless the row says otherwise. So this module imports none of them.
The grammar, the writer and the two ways to SymPy read the table too; only an operator with a look
of its own needs a line in ``typeset.layout``.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum

import msgspec

MANY = 64
"""Most arguments of an operator that takes any number."""

SYSTEMS = ("exact", "floats", "arrays", "sympy")
"""Rationals and balls, Python floats, NumPy arrays, and SymPy."""


class Typed(Enum):
    """How an operator is typed."""

    FUNCTION = "name(a, b)"
    SIGN = "a + b"
    PREFIX = "-a"
    RELATION = "a < b"
    WORD = "a and b"
    CONSTANT = "pi"


class Operator(msgspec.Struct, frozen=True):
    """One operator.

    Parameters
    ----------
    name : str
        What stands in ``Call.op``.
    least, most : int
        Numbers of arguments.
    typed : Typed
        How it is typed.
    signs : tuple of str
        How it is spelled when it is not called by name; written with the first one.
    token : str
        The sign's name in the grammar.
    folds : bool
        Its function takes two arguments; longer lists are folded from the left.
    called : mapping of str to str
        Number system to the name of its function there, where that is another than ``name``.
    absent : frozenset of str
        Number systems that do without it.
    """

    name: str
    least: int
    most: int
    typed: Typed = Typed.FUNCTION
    signs: tuple[str, ...] = ()
    token: str = ""
    folds: bool = False
    called: Mapping[str, str] = msgspec.field(default_factory=dict)
    absent: frozenset[str] = frozenset()

    def function_in(self, system: str) -> str:
        """Name of its function in a number system."""
        return self.called.get(system, self.name)


def _function(
    name: str, library: str = "", least: int = 1, most: int = 1, **other: str
) -> Operator:
    libraries = dict.fromkeys(("floats", "arrays", "sympy"), library or name)
    return Operator(name, least, most, folds=most == MANY, called=libraries | other)


def _relation(name: str, *signs: str, exact: str, sympy: str) -> Operator:
    called = {"exact": exact, "sympy": sympy}
    return Operator(name, 2, 2, Typed.RELATION, signs, "RELATION", called=called)


def _word(name: str, most: int, python: str, arrays: str, sympy: str) -> Operator:
    called = dict.fromkeys(SYSTEMS, python) | {"arrays": arrays, "sympy": sympy}
    return Operator(
        name, min(2, most), most, Typed.WORD, (name,), name.upper(),
        folds=most == MANY, called=called,
    )  # fmt: skip


_DIVIDED = dict.fromkeys(SYSTEMS, "truediv") | {"exact": "divide"}

_ROWS = (
    Operator("add", 2, MANY, Typed.SIGN, ("+",), "PLUS", folds=True),
    Operator("sub", 2, 2, Typed.SIGN, ("-", "−"), "MINUS"),
    Operator("mul", 2, MANY, Typed.SIGN, ("*", "·", "×"), "TIMES", folds=True),
    Operator("div", 2, 2, Typed.SIGN, ("/",), "SLASH", called=_DIVIDED),
    Operator("neg", 1, 1, Typed.PREFIX, ("-", "−"), "MINUS"),
    Operator("pow", 2, 2, Typed.SIGN, ("^", "**"), "POWER", called={"exact": "power"}),
    Operator("abs", 1, 1, called={"sympy": "Abs"}),
    _function("sqrt", exact="square_root"),
    _function("exp", exact="exponential"),
    _function("ln", "log", exact="natural_log"),
    _function("log2", exact="binary_log"),
    _function("log10", exact="decimal_log"),
    *map(_function, ("sin", "cos", "tan")),
    _function("asin", arrays="arcsin"),
    _function("acos", arrays="arccos"),
    _function("atan", arrays="arctan"),
    _function("atan2", least=2, most=2, arrays="arctan2"),
    _function("erf", exact="error_function"),
    _function("erfc", exact="complementary_error_function"),
    _function("sign"),
    _function("floor"),
    _function("ceil", sympy="ceiling"),
    _function("round", "rounded", exact="rounded"),
    _function("mod", least=2, most=2, exact="remainder", sympy="Mod"),
    _function("min", most=MANY, exact="least", arrays="minimum", sympy="Min"),
    _function("max", most=MANY, exact="greatest", arrays="maximum", sympy="Max"),
    Operator("pi", 0, 0, Typed.CONSTANT, ("pi", "π"), "CONSTANT"),
    Operator("piecewise", 3, MANY - 1, absent=frozenset(SYSTEMS) - {"arrays"}),
    _relation("eq", "=", "==", exact="equal", sympy="Eq"),
    _relation("ne", "!=", "≠", exact="unequal", sympy="Ne"),
    _relation("lt", "<", exact="less", sympy="Lt"),
    _relation("le", "<=", "≤", exact="at_most", sympy="Le"),
    _relation("gt", ">", exact="more", sympy="Gt"),
    _relation("ge", ">=", "≥", exact="at_least", sympy="Ge"),
    _word("and", MANY, "both", arrays="logical_and", sympy="And"),
    _word("or", MANY, "either", arrays="logical_or", sympy="Or"),
    _word("not", 1, "not_", arrays="logical_not", sympy="Not"),
)

OPERATORS = {row.name: row for row in _ROWS}
"""Every operator by name. ``piecewise`` picks its branch while a formula runs, except on arrays."""

CONDITIONS = frozenset(
    row.name for row in OPERATORS.values() if row.typed in {Typed.RELATION, Typed.WORD}
)
"""Operators that give true or false."""


def typed_as(way: Typed) -> tuple[Operator, ...]:
    """The operators that are typed in one way."""
    return tuple(row for row in OPERATORS.values() if row.typed is way)
