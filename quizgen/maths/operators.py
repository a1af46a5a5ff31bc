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


class OperatorSyntax(Enum):
    """How an operator is typed."""

    FUNCTION = "name(a, b)"
    SIGN = "a + b"
    PREFIX = "-a"
    RELATION = "a < b"
    WORD = "a and b"
    CONSTANT = "pi"
    LIST = "mean(x)"


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
    typed: OperatorSyntax = OperatorSyntax.FUNCTION
    signs: tuple[str, ...] = ()
    token: str = ""
    folds: bool = False
    called: Mapping[str, str] = msgspec.field(default_factory=dict)
    absent: frozenset[str] = frozenset()

    def function_in(self, system: str) -> str:
        """Return the name of its function in a number system."""
        return self.called.get(system, self.name)


def _make_function_operator(
    name: str, library: str = "", least: int = 1, most: int = 1, **other: str
) -> Operator:
    """Return a function, under the name that libraries share and those in ``other`` systems."""
    libraries = dict.fromkeys(("floats", "arrays", "sympy"), library or name)
    return Operator(name, least, most, folds=most == MANY, called=libraries | other)


def _make_relation_operator(name: str, *signs: str, exact: str, sympy: str) -> Operator:
    """Return a relation of two sides, with its signs."""
    called = {"exact": exact, "sympy": sympy}
    return Operator(name, 2, 2, OperatorSyntax.RELATION, signs, "RELATION", called=called)


def _make_word_operator(name: str, most: int, python: str, arrays: str, sympy: str) -> Operator:
    """Return a word between conditions, or before one."""
    called = dict.fromkeys(SYSTEMS, python) | {"arrays": arrays, "sympy": sympy}
    return Operator(
        name, min(2, most), most, OperatorSyntax.WORD, (name,), name.upper(),
        folds=most == MANY, called=called,
    )  # fmt: skip


def _make_list_operator(name: str, count: int = 1, *signs: str) -> Operator:
    """Return an operator on lists; only exact numbers and floats have such operators."""
    return Operator(
        name, count, count, OperatorSyntax.LIST, signs or (name,),
        absent=frozenset(SYSTEMS) - {"exact", "floats"},
    )  # fmt: skip


def _make_special_operator(
    name: str, count: int = 1, *, sympy: str = "", exact: str = ""
) -> Operator:
    """Return an operator whose floats take the value of the ball: no library has it."""
    called = {"sympy": sympy or name, "exact": exact or name}
    return Operator(name, count, count, called=called)


FURTHER = {
    **dict.fromkeys(
        ("Ei", "Li", "Si", "Ci", "Shi", "Chi", "li", "erfi", "fresnels", "fresnelc", "airyai",
         "airybi", "airyaiprime", "airybiprime", "loggamma", "digamma", "elliptic_k",
         "elliptic_e", "dirichlet_eta"), (1, 1),
    ),
    **dict.fromkeys(("expint", "polylog", "polygamma", "elliptic_f"), (2, 2)),
    **dict.fromkeys(("legendre", "chebyshevt", "chebyshevu", "hermite", "laguerre"), (2, 2)),
    **dict.fromkeys(
        ("fibonacci", "lucas", "tribonacci", "bernoulli", "euler", "bell", "genocchi", "partition",
         "factorial2", "subfactorial", "primorial", "totient", "reduced_totient", "mobius",
         "primenu", "primeomega", "primepi", "prime", "nextprime", "prevprime", "isprime", "numer",
         "denom"), (1, 1),
    ),
    **dict.fromkeys(
        ("jacobi_symbol", "legendre_symbol", "mod_inverse", "n_order", "multiplicity"), (2, 2)
    ),
    "harmonic": (1, 2),
    "divisor_sigma": (1, 2),
    "stirling": (2, 2),
    **dict.fromkeys(("gcd", "lcm"), (2, MANY)),
}  # fmt: skip
"""Functions that some subject needs, under SymPy's names, with numbers of arguments.

``quizgen.maths.further`` has each of them. Their names may name quantities, too: Si is silicon.
"""

_DIVIDED = dict.fromkeys(SYSTEMS, "truediv") | {"exact": "divide"}

_ROWS = (
    Operator("add", 2, MANY, OperatorSyntax.SIGN, ("+",), "PLUS", folds=True),
    Operator("sub", 2, 2, OperatorSyntax.SIGN, ("-", "−"), "MINUS"),
    Operator("mul", 2, MANY, OperatorSyntax.SIGN, ("*", "·", "×"), "TIMES", folds=True),
    Operator("div", 2, 2, OperatorSyntax.SIGN, ("/",), "SLASH", called=_DIVIDED),
    Operator("neg", 1, 1, OperatorSyntax.PREFIX, ("-", "−"), "MINUS"),
    Operator("pow", 2, 2, OperatorSyntax.SIGN, ("^", "**"), "POWER", called={"exact": "power"}),
    Operator("abs", 1, 1, called={"sympy": "Abs"}),
    _make_function_operator("sqrt", exact="square_root"),
    _make_function_operator("exp", exact="exponential"),
    _make_function_operator("ln", "log", exact="natural_log"),
    _make_function_operator("log2", exact="binary_log"),
    _make_function_operator("log10", exact="decimal_log"),
    *map(_make_function_operator, ("sin", "cos", "tan")),
    _make_function_operator("asin", arrays="arcsin"),
    _make_function_operator("acos", arrays="arccos"),
    _make_function_operator("atan", arrays="arctan"),
    _make_function_operator("atan2", least=2, most=2, arrays="arctan2"),
    _make_function_operator("erf", exact="error_function"),
    _make_function_operator("erfc", exact="complementary_error_function"),
    _make_function_operator("sign"),
    _make_function_operator("floor"),
    _make_function_operator("ceil", sympy="ceiling"),
    _make_function_operator("round", "round_float_half_away", exact="round_half_away"),
    _make_function_operator("mod", least=2, most=2, exact="remainder", sympy="Mod"),
    _make_function_operator("min", most=MANY, exact="minimum", arrays="minimum", sympy="Min"),
    _make_function_operator("max", most=MANY, exact="maximum", arrays="maximum", sympy="Max"),
    *map(_make_list_operator, ("mean", "var", "sd", "pvar", "psd", "median", "len", "sort")),
    *(_make_list_operator(name, 2) for name in ("quantile", "cov", "corr", "slope", "at")),
    *(_make_list_operator(f"list_{name}", 1, name) for name in ("sum", "min", "max")),
    *map(_make_function_operator, ("sinh", "cosh", "tanh")),
    _make_function_operator("asinh", arrays="arcsinh"),
    _make_function_operator("acosh", arrays="arccosh"),
    _make_function_operator("atanh", arrays="arctanh"),
    *map(_make_special_operator, ("sec", "csc", "cot", "factorial", "gamma", "erfinv", "zeta")),
    *(_make_special_operator(name, 2) for name in ("binomial", "beta")),
    _make_special_operator("besselj", 2, exact="bessel_first_kind"),
    _make_special_operator("bessely", 2, exact="bessel_second_kind"),
    _make_special_operator("besseli", 2, exact="bessel_modified_first_kind"),
    _make_special_operator("besselk", 2, exact="bessel_modified_second_kind"),
    _make_special_operator("lambertw", sympy="LambertW"),
    _make_special_operator("lowergamma", 2),
    _make_special_operator("uppergamma", 2),
    *(_make_special_operator(name, 1) for name in ("normal_cdf", "normal_quantile")),
    *(
        _make_special_operator(name, 2)
        for name in ("t_cdf", "t_quantile", "chi2_cdf", "chi2_quantile")
    ),
    *(_make_special_operator(name, 3) for name in ("f_cdf", "f_quantile")),
    *(
        Operator(name, *count, folds=count[1] == MANY, called={"exact": name})
        for name, count in FURTHER.items()
    ),
    *(Operator(name, 4, 4, absent=frozenset(SYSTEMS)) for name in ("sum", "product", "integral")),
    Operator("pi", 0, 0, OperatorSyntax.CONSTANT, ("pi", "π"), "CONSTANT"),
    Operator("piecewise", 3, MANY - 1, absent=frozenset(SYSTEMS) - {"arrays"}),
    _make_relation_operator("eq", "=", "==", exact="equal", sympy="Eq"),
    _make_relation_operator("ne", "!=", "≠", exact="unequal", sympy="Ne"),
    _make_relation_operator("lt", "<", exact="is_less", sympy="Lt"),
    _make_relation_operator("le", "<=", "≤", exact="is_at_most", sympy="Le"),
    _make_relation_operator("gt", ">", exact="is_more", sympy="Gt"),
    _make_relation_operator("ge", ">=", "≥", exact="is_at_least", sympy="Ge"),
    _make_word_operator("and", MANY, "logical_and", arrays="logical_and", sympy="And"),
    _make_word_operator("or", MANY, "logical_or", arrays="logical_or", sympy="Or"),
    _make_word_operator("not", 1, "not_", arrays="logical_not", sympy="Not"),
)

OPERATORS = {row.name: row for row in _ROWS}
"""Every operator by name. ``piecewise`` picks its branch while a formula runs, except on arrays."""

DISTRIBUTIONS = frozenset(name for name in OPERATORS if name.endswith(("_cdf", "_quantile")))
"""Operators for which SymPy has no class: ``Function("t_quantile")`` writes one."""

UNEVALUATED = DISTRIBUTIONS | {
    "stirling", "gcd", "lcm", "primorial", "prime", "nextprime", "prevprime", "isprime",
    "mod_inverse", "n_order", "multiplicity", "numer", "denom",
}  # fmt: skip
"""Operators that SymPy can only write as functions without a meaning: it has no class for them."""

BINDERS = frozenset({"sum", "product", "integral"})
"""Operators of a bound name, its first and last value, and what is computed for each of them."""

CHECKED = frozenset({"integral"})
"""Operators whose value is computed twice and compared, but not proved."""

LIST_OPERATORS = frozenset(
    row.name for row in OPERATORS.values() if row.typed is OperatorSyntax.LIST
)
"""Operators that take lists."""

CONDITIONS = frozenset(
    row.name
    for row in OPERATORS.values()
    if row.typed in {OperatorSyntax.RELATION, OperatorSyntax.WORD}
)
"""Operators that give true or false."""


def operators_with_syntax(way: OperatorSyntax) -> tuple[Operator, ...]:
    """Return the operators that are typed in one way."""
    return tuple(row for row in OPERATORS.values() if row.typed is way)
