"""What a solver's Python makes of letters where numbers are meant, found out in one place.

A solver is run once, with letters for what is drawn. Most of SymPy says the same of letters as of
the numbers in their place. ``gcd(a, b)`` is 1 of letters, ``numer(a/b)`` is ``a``, ``A.rank()``
full and ``a == b`` false: a key that nobody would notice. So what can wait for the drawn numbers
waits; of anything else that is called with letters, it is tried whether numbers in their place
change what it gives, and if so, the solver is refused with its line.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from typing import Any, NamedTuple

from quizgen.core.errors import BankError
from quizgen.maths.operators import DISTRIBUTIONS, UNEVALUATED

RULE = "QG330"
_CALLED_HERE = {"igcd": "gcd", "ilcm": "lcm", "divisor_count": "divisor_sigma"}
"""Functions of SymPy to those of ours that say the same."""
WAITING = UNEVALUATED | {*_CALLED_HERE}
"""Functions of SymPy that need numbers, and get names where a solver is compiled."""
_LIKE_NUMBERS = frozenset({
    "apart", "as_coefficients_dict", "as_real_imag", "atoms", "cancel", "cbrt", "charpoly",
    "collect", "copy", "diff", "doit", "dsolve", "eigenvals", "eigenvects", "evalf", "expand",
    "factor", "find", "free_symbols", "has", "integrate", "inverse_laplace_transform",
    "lambdify", "laplace_transform", "latex", "limit", "linsolve", "match", "nonlinsolve",
    "nsolve", "pprint", "replace", "residue", "rewrite", "roots", "rsolve", "series",
    "simplify", "solve", "solveset", "sqrt", "srepr", "subs", "summation", "symbols",
    "sympify", "together", "trigsimp", "xreplace",
})  # fmt: skip
"""Functions and methods that are not tried: algebra that holds of numbers, and looks at letters."""
_LARGEST_RANKED = 4
"""Most rows and columns of a matrix whose rank waits for numbers."""
_TRIED: tuple[tuple[str, ...], ...] = (
    ("6", "4", "10", "15", "9", "14", "21", "8"), ("12",), ("3/2", "5/4", "7/2", "9/4"),
)  # fmt: skip
"""Numbers put in the place of letters, in turn: with common factors, all alike, fractions."""
_NEAR = 1e-9


class LetterCall(NamedTuple):
    """A call with letters: of what, with what, what it gave, and where it stands."""

    function: Callable[..., Any]
    args: tuple[Any, ...]
    more: Mapping[str, Any]
    found: Any
    file: Path
    line: int


_CALLS: ContextVar[list[LetterCall] | None] = ContextVar("calls with letters", default=None)


@contextmanager
def watch_calls() -> Iterator[list[LetterCall]]:
    """Note each call of SymPy's with letters that a solver makes."""
    calls: list[LetterCall] = []
    token = _CALLS.set(calls)
    try:
        yield calls
    finally:
        _CALLS.reset(token)


def _has_letters(value: Any) -> bool:
    """Return whether a value of SymPy's, or a list of them, has letters in it."""
    if isinstance(value, list | tuple):
        return any(map(_has_letters, value))
    return bool(getattr(value, "free_symbols", ())) and not isinstance(value, type)


def leave_symbolic(function: Any) -> Any:
    """Return what is called in a solver so that it waits for drawn numbers, or is noted.

    Of names, ``gcd(a, b)`` is 1, as of polynomials, and ``isprime(a)`` fails. What is not SymPy's
    comes back as it is.
    """
    name = getattr(function, "__name__", "")
    module = getattr(function, "__module__", None)
    is_theirs = isinstance(module, str) and module.startswith("sympy.") and isinstance(name, str)
    if not is_theirs or not name or isinstance(function, type) or name in _LIKE_NUMBERS:
        return function
    owner = getattr(function, "__self__", None)

    def call(*args: Any, **more: Any) -> Any:
        """Return the value, or the call as it is written if it has names in it."""
        if not any(map(_has_letters, (owner, *args))):
            return function(*args, **more)
        waits = _wait(name, owner, args)
        if waits is not None:
            return waits
        found = function(*args, **more)
        calls = _CALLS.get()
        if calls is not None:
            calls.append(LetterCall(function, args, more, found, *_find_line()))
        return found

    return call


def _find_line() -> tuple[Path, int]:
    """Return file and line of the solver that is running."""
    frame = sys._getframe(2)  # noqa: SLF001 - of what was called here
    while frame.f_back and frame.f_globals.get("__name__", "").startswith("sympy."):
        frame = frame.f_back
    return Path(frame.f_code.co_filename), frame.f_lineno


def _wait(name: str, owner: Any, args: tuple[Any, ...]) -> Any:
    """Return a call that waits for numbers; None if there is no such."""
    from sympy import Function, I, MatrixBase

    if owner is None and name in WAITING:
        more = (0,) if name == "divisor_count" else ()
        return Function(_CALLED_HERE.get(name, name))(*args, *more)
    is_ranked = name == "rank" and isinstance(owner, MatrixBase) and not owner.has(I)
    if is_ranked and max(owner.shape) <= _LARGEST_RANKED:
        return _count_rank(owner)
    return None


def _count_rank(matrix: Any) -> Any:
    """Return the rank of a matrix by its minors: the size of the largest one that is not zero."""
    from itertools import combinations

    from sympy import Ne, Piecewise, evaluate, expand

    cases = []
    with evaluate(True):
        for size in range(min(matrix.shape), 0, -1):
            minors = (
                expand(matrix.extract(list(rows), list(columns)).det())
                for rows in combinations(range(matrix.rows), size)
                for columns in combinations(range(matrix.cols), size)
            )
            squares = sum(minor**2 for minor in dict.fromkeys(minors))
            cases.append((size, Ne(squares, 0)))
        return Piecewise(*cases, (0, True))


def compare_written(sign: str, left: Any, right: Any) -> Any:
    """Return ``left == right`` or ``left != right``, which waits where letters may become equal.

    Python compares how formulas are written: ``Piecewise((1, a == b), (2, True))`` would be 2.
    """
    same = left == right
    values = (left, right)
    if same is False and any(map(_has_letters, values)) and all(map(_is_formula, values)):
        from sympy import Eq, Ne

        return Eq(left, right) if sign == "==" else Ne(left, right)
    return same if sign == "==" else left != right


def _is_formula(value: Any) -> bool:
    """Return whether a value is a number or a formula."""
    from sympy import Expr

    return isinstance(value, int | float | Expr) and not isinstance(value, bool)


def ask_property(owner: Any, name: str) -> Any:
    """Return ``owner.is_prime`` and the like.

    Raises
    ------
    BankError
        If that is not known of a letter.
    """
    found = getattr(owner, name)
    if found is None and _has_letters(owner):
        file, line = _find_line()
        what = f"{name} of {owner} is not known before numbers are drawn"
        raise BankError(what, rule=RULE, file=file, line=line)
    return found


def check_calls(calls: list[LetterCall], drawn: Collection[str]) -> None:
    """Try what was called with letters with numbers in place of those that are drawn.

    Raises
    ------
    BankError
        That names the line, if numbers give something else.
    """
    from sympy import evaluate

    for call in calls:
        with evaluate(True):
            different = next((one for one in _TRIED if not _holds_of(call, drawn, one)), None)
        if different is not None:
            name = getattr(call.function, "__name__", "")
            what = f"{name} gives something else of numbers than of the letters that stand here"
            raise BankError(what, rule=RULE, file=call.file, line=call.line)


def _holds_of(call: LetterCall, drawn: Collection[str], numbers: tuple[str, ...]) -> bool:
    """Return whether a call gives the same of numbers; True where it cannot be told."""
    from sympy import MatrixBase, Rational

    owner = getattr(call.function, "__self__", None)
    every = _find_letters((owner, *call.args))
    letters = sorted((one for one in every if one.name in drawn), key=str)
    if letters and isinstance(owner, MatrixBase) and isinstance(call.found, bool):
        return False  # such as is_diagonalizable: no few numbers settle it
    place = {one: Rational(numbers[n % len(numbers)]) for n, one in enumerate(letters)}
    with suppress(Exception):  # SymPy may raise anything where a letter must stand
        args = [_put_in(arg, place) for arg in call.args]
        function = call.function
        if owner is not None:
            function = getattr(_put_in(owner, place), function.__name__)
        return _is_same(_put_in(call.found, place), _put_in(function(*args, **call.more), place))
    return True


def _find_letters(values: Any) -> set[Any]:
    """Return the letters in values of SymPy's, or in lists of them."""
    if isinstance(values, list | tuple):
        return {one for value in values for one in _find_letters(value)}
    found = getattr(values, "free_symbols", ())
    return {one for one in found if hasattr(one, "name")} if not isinstance(values, type) else set()


def _put_in(value: Any, place: Mapping[Any, Any]) -> Any:
    """Return a value, a list or a table with numbers in place of letters."""
    if isinstance(value, list | tuple | set | frozenset):
        return type(value)(_put_in(one, place) for one in value)
    if isinstance(value, dict):
        return {_put_in(key, place): _put_in(one, place) for key, one in value.items()}
    return _stop_waiting(value.subs(place).doit()) if hasattr(value, "subs") else value


def _stop_waiting(value: Any) -> Any:
    """Return a value with calls that wait for numbers worked out by SymPy, as numbers are there."""
    import sympy
    from sympy.core.function import AppliedUndef

    if isinstance(value, sympy.MatrixBase):
        return value.applyfunc(_stop_waiting)
    calls = [c for c in value.atoms(AppliedUndef) if c.func.__name__ in UNEVALUATED - DISTRIBUTIONS]
    place = {}
    for call in calls:
        name = call.func.__name__
        place[call] = (getattr(sympy, name, None) or getattr(sympy.ntheory, name))(*call.args)
    return value.xreplace(place)


def _is_same(one: Any, other: Any) -> bool:
    """Return whether two values are the same, or the same numbers but for rounding."""
    from sympy import Expr, MatrixBase, simplify

    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(_is_same, one, other))
    if isinstance(one, MatrixBase) and isinstance(other, MatrixBase):
        return one.shape == other.shape and _is_same(one.flat(), other.flat())
    if one == other:
        return True
    if not isinstance(one, Expr) or not isinstance(other, int | float | Expr):
        return False
    rest = simplify(one - other)
    return bool(rest == 0 or (rest.is_number and abs(complex(rest)) < _NEAR))
