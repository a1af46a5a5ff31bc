"""From any SymPy expression of a solver to what its step is: a number, a formula, a form.

SymPy works here once, when a solver is compiled, and evaluates what a solver left unevaluated:
derivatives, integrals, limits, determinants, operations of sets. A *form* is what is no single
real number: a formula over free names, a complex number, a matrix, a set, an equation. It becomes a
tree, too, whose outermost operators are those of ``FORMS``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import sympy
from sympy.core.function import AppliedUndef
from sympy.core.sympify import _sympify as _make_strict  # takes no text
from sympy.matrices.expressions.matexpr import MatrixExpr

from quizgen.core.errors import BankError
from quizgen.maths.from_sympy import from_sympy
from quizgen.maths.recipes import STRUCTURES, Recipe, Use
from quizgen.maths.tree import Call, Expr, Num, make_number, names_in

_COMPLEX = (sympy.re, sympy.im, sympy.conjugate, sympy.arg)
_UNWORKABLE = (BankError, AttributeError, TypeError, ValueError, RuntimeError)
"""What is raised where SymPy cannot do what a solver asks, or comes to what is no formula."""
_LARGEST_ENTRIES = 9
"""Most entries of a matrix that is worked with entry by entry, as unknowns."""
_EVALUATED = (sympy.Derivative, sympy.Integral, sympy.Limit, sympy.Subs)


class FormResolver:
    """The steps of one model, each seen with the forms before it in place.

    Parameters
    ----------
    free : collection of str
        Names that no draw gives: the variables of formulas.
    """

    def __init__(self, free: tuple[str, ...]) -> None:
        self.free = frozenset(free)
        self.forms: dict[str, sympy.Basic] = {}
        self.trees: dict[str, Expr] = {}

    def resolve(self, expression: sympy.Basic) -> tuple[Expr, bool]:
        """Return the tree of an expression, and whether it is a form.

        Raises
        ------
        BankError
            If SymPy cannot bring it to one.
        """
        with sympy.evaluate(True):
            try:
                written = _make_strict(expression)
                whole = self._divide_polynomials(self._put_forms_in(written))
                return self._convert(whole)
            except BankError:
                raise
            except _UNWORKABLE[1:] as error:
                what = f"SymPy cannot work {expression} out: {type(error).__name__}: {error}"
                raise BankError(f"{what} (compute it before `with evaluate(False)`)") from error

    def _divide_polynomials(self, whole: sympy.Basic) -> sympy.Basic:
        """Return an expression with ``gcd``, ``numer`` and the like of formulas worked out."""
        calls = [
            call for call in getattr(whole, "atoms", lambda *_: ())(AppliedUndef)
            if call.func.__name__ in {"gcd", "lcm", "numer", "denom"} and self._is_free(*call.args)
        ]  # fmt: skip
        found = {call: getattr(sympy, call.func.__name__)(*call.args) for call in calls}
        return whole.xreplace(found) if found else whole

    def copy(self) -> FormResolver:
        """Return another one that has seen the same steps, to go on from here in a wrong way."""
        found = FormResolver(tuple(self.free))
        found.forms.update(self.forms)
        found.trees.update(self.trees)
        return found

    def remember(self, name: str, expression: sympy.Basic, tree: Expr) -> None:
        """Have later steps see a form under its name, with the tree that it came to."""
        self.trees[name] = tree
        with sympy.evaluate(True):
            self.forms[name] = self._put_forms_in(_make_strict(expression))

    def find_forms(self, written: sympy.Basic) -> tuple[str, ...]:
        """Return the names of the forms of earlier steps that an expression uses."""
        calls = getattr(written, "atoms", lambda *_: ())(AppliedUndef)
        names = [call.func.__name__ for call in calls]
        names += [getattr(symbol, "name", "") for symbol in getattr(written, "free_symbols", ())]
        return tuple(name for name in self.forms if name in names)

    def find_recipe(self, written: sympy.Basic) -> Recipe | None:
        """Return how a step follows from the forms in it; None where SymPy solved for something."""
        names = self.find_forms(written)
        with sympy.evaluate(True), suppress(*_UNWORKABLE):
            uses = _Uses(self.trees, self.free)
            whole = uses.put_in(_take_ends(_make_strict(written)), names)
            whole = whole.doit() if whole.has(sympy.MatrixBase, MatrixExpr) else whole
            if whole.has(sympy.Integral, sympy.Sum, sympy.Product):
                return Recipe(from_sympy(whole), tuple(uses.found))
            return Recipe(self._convert(whole)[0], tuple(uses.found))
        return None

    def _put_forms_in(self, written: sympy.Basic) -> sympy.Basic:
        """Return an expression with the forms of earlier steps in place of their names.

        A form that is called, ``f(2)``, is taken at these arguments.
        """
        if not self.forms or not hasattr(written, "free_symbols"):
            return written
        calls = [
            call
            for call in getattr(written, "atoms", lambda *_: ())(AppliedUndef)
            if call.func.__name__ in self.forms
        ]
        names = [
            symbol for symbol in written.free_symbols if getattr(symbol, "name", "") in self.forms
        ]
        if not calls and not names:
            return written
        place = {call: self._apply_form(call) for call in calls}
        place |= {symbol: self.forms[symbol.name] for symbol in names}
        found = written.subs(place)
        return found.doit() if hasattr(found, "doit") else found

    def _apply_form(self, call: sympy.Basic) -> sympy.Basic:
        """Return a form at the arguments of a call; its free names are filled by alphabet."""
        form = self.forms[call.func.__name__]
        names = sorted((s for s in form.free_symbols if s.name in self.free), key=lambda s: s.name)
        return form.subs(dict(zip(names, call.args, strict=False)), simultaneous=True)

    def _convert(self, whole: sympy.Basic) -> tuple[Expr, bool]:
        """Return the tree of an expression, and whether it is a form rather than a number."""
        if isinstance(whole, sympy.Piecewise) and not self._is_free(
            *(condition for _, condition in whole.args)
        ):
            return self._convert_cases(whole)
        found = _convert_structure(whole, self._convert_entry)
        if found is not None:
            return found, True
        if _has_complex(whole):
            return self._convert_complex(whole)
        free = [s for s in getattr(whole, "free_symbols", ()) if s.name in self.free]
        tree = _convert_evaluated(whole, free)
        if free and not _is_written(whole):
            tree = _put_free_first(tree, self.free)
        return tree, bool(free)

    def _convert_entry(self, whole: sympy.Basic) -> Expr:
        """Return the tree of an entry of a matrix, which may be complex."""
        return self._convert_complex(whole)[0] if _has_complex(whole) else _convert_evaluated(whole)

    def _is_free(self, *parts: sympy.Basic) -> bool:
        """Return whether any of these holds a name that no draw gives."""
        return any(s.name in self.free for part in parts for s in part.free_symbols)

    def _convert_cases(self, whole: sympy.Piecewise) -> tuple[Expr, bool]:
        """Return what the drawn numbers choose among, each branch as it would be alone.

        A draw thereby asks one of several formulas, or for matrices of one of several sizes.
        """
        found = [self._convert(value) for value, _ in whole.args]
        if not any(is_form for _, is_form in found):
            return _convert_evaluated(whole), False
        numbers = sympy.Piecewise(*((n, c) for n, (_, c) in enumerate(whole.args)), evaluate=False)
        cases = from_sympy(numbers)
        if not isinstance(cases, Call):
            return found[0]
        args = [
            found[place // 2][0] if place % 2 == 0 else arg for place, arg in enumerate(cases.args)
        ]
        return Call("piecewise", tuple(args)), True

    def _convert_complex(self, whole: sympy.Basic) -> tuple[Expr, bool]:
        """Return a complex number as its real and imaginary part; a real one as itself."""
        real = {s: sympy.Dummy(s.name, real=True) for s in whole.free_symbols if s.is_real is None}
        back = {dummy: symbol for symbol, dummy in real.items()}
        value = whole.subs(real).doit()
        value = value.replace(sympy.arg, lambda w: sympy.atan2(sympy.im(w), sympy.re(w))).doit()
        parts = [sympy.simplify(part).subs(back) for part in value.as_real_imag()]
        names = {symbol.name for symbol in whole.free_symbols}
        if parts[1] == 0:
            return from_sympy(parts[0]), bool(names & self.free)
        return Call("complex", tuple(map(from_sympy, parts))), True


class _Uses:
    """Names put in place of forms in an expression.

    Parameters
    ----------
    trees : mapping of str to Expr
        What each form came to.
    free : collection of str
        Names that no draw gives.
    """

    def __init__(self, trees: Mapping[str, Expr], free: frozenset[str]) -> None:
        self.trees, self.free = trees, free
        self.found: list[Use] = []

    def put_in(self, written: sympy.Basic, forms: Sequence[str]) -> sympy.Basic:
        """Return an expression with names for what it takes of forms.

        Raises ``BankError`` if a form in it is none whose parts can be named.
        """
        symbols = {str(getattr(s, "name", "")): s for s in getattr(written, "free_symbols", ())}
        place = {
            symbols[name]: self._name_form(name, symbols[name]) for name in forms if name in symbols
        }
        whole = written.subs(place) if place else written
        for kind in (sympy.Subs, sympy.Derivative, AppliedUndef):
            calls = [one for one in whole.atoms(kind) if self._find_call(one) in forms]
            whole = whole.xreplace({one: self._name_call(one) for one in calls})
        return whole

    def _find_call(self, one: sympy.Basic) -> str:
        """Return the form that is called, maybe within a derivative."""
        while isinstance(one, sympy.Subs | sympy.Derivative):
            one = one.expr
        return str(one.func.__name__) if isinstance(one, AppliedUndef) else ""

    def _add(self, of: str, **how: Any) -> sympy.Symbol:
        """Return a new name for a use of a form."""
        name = f"carried{len(self.found) + 1}"
        self.found.append(Use(name, of, **how))
        return sympy.Symbol(name)

    def _name_form(self, name: str, symbol: sympy.Basic) -> sympy.Basic:
        """Return names for the numbers of a matrix or complex number, one for a formula."""
        tree = self.trees[name]
        if isinstance(tree, Call) and tree.op in {"matrix", "vector"}:
            rows = [
                [(r, c) for c in range(len(row.args))] if isinstance(row, Call) and row.op == "row"
                else [(r,)] for r, row in enumerate(tree.args)
            ]  # fmt: skip
            if sum(map(len, rows)) > _LARGEST_ENTRIES:
                raise BankError(f"{name} is too large to be worked with entry by entry")
            return sympy.Matrix([[self._add(name, entry=one) for one in row] for row in rows])
        if isinstance(tree, Call) and tree.op == "complex":
            real, imaginary = (self._add(name, entry=(part,)) for part in (0, 1))
            return real + sympy.I * imaginary
        if (isinstance(tree, Call) and tree.op in STRUCTURES) or isinstance(symbol, MatrixExpr):
            raise BankError(f"{name} is no formula")
        return self._add(name)

    def _name_call(self, one: sympy.Basic) -> sympy.Symbol:
        """Return a name for ``f(x)``, ``f(2)``, its derivative, or the derivative at a place."""
        later: dict[str, sympy.Basic] = {}
        if isinstance(one, sympy.Subs):
            later = {s.name: value for s, value in zip(one.variables, one.point, strict=True)}
            one = one.expr
        variables: tuple[sympy.Symbol, ...] = ()
        if isinstance(one, sympy.Derivative):
            variables, one = one.variables, one.expr
        form = self.trees[one.func.__name__]
        names = dict(zip(sorted(names_in(form) & self.free), one.args, strict=False))
        by = tuple(next(n for n, arg in names.items() if arg == variable) for variable in variables)
        ends = {n: later.get(getattr(arg, "name", ""), arg) for n, arg in names.items()}
        moved = {n: arg for n, arg in ends.items() if getattr(arg, "name", "") != n}
        at = tuple((n, from_sympy(arg)) for n, arg in moved.items())
        return self._add(one.func.__name__, by=by, at=at)


def _take_ends(written: sympy.Basic) -> sympy.Basic:
    """Return an expression in which integrals have bounds, and limits are values at the place.

    So they follow from any form: an antiderivative is right up to a constant, and where a form has
    no value at the place of a limit, nothing follows from it. Raises ``BankError`` for a limit at
    infinity.
    """
    if not hasattr(written, "atoms"):
        return written
    place = {}
    for one in written.atoms(sympy.Limit):
        if one.args[2].is_infinite:
            raise BankError("a limit at infinity of a form is not known")
        place[one] = one.args[0].subs(one.args[1], one.args[2])
    for one in written.atoms(sympy.Integral):
        if [len(limit) for limit in one.limits] == [1]:
            (name,) = one.limits[0]
            along = sympy.Symbol("along")
            place[one] = sympy.Integral(one.function.subs(name, along), (along, 1, name))
    return written.xreplace(place)


def _convert_structure(whole: sympy.Basic, convert: Callable[[sympy.Basic], Expr]) -> Expr | None:
    """Return the tree of a matrix, a set, a vector, an equation or inequality, else None."""
    if isinstance(whole, sympy.MatrixBase | MatrixExpr):
        return _convert_matrix(whole, convert)
    if isinstance(whole, sympy.Set):
        return _convert_set(whole.doit())
    if isinstance(whole, sympy.Tuple | list | tuple):
        return Call("vector", tuple(map(convert, whole)))
    if isinstance(whole, sympy.Eq | sympy.Lt | sympy.Le | sympy.Gt | sympy.Ge):
        return from_sympy(whole)
    return None


def _has_complex(whole: sympy.Basic) -> bool:
    """Return whether an expression has the imaginary unit, or a function such as ``re``."""
    return bool(hasattr(whole, "has") and whole.has(sympy.I, *_COMPLEX))


def _evaluate(whole: sympy.Basic) -> sympy.Basic:
    """Work derivatives, integrals and limits out; sums stay as they are written."""
    if not hasattr(whole, "has"):
        return whole
    if whole.has(*_EVALUATED, sympy.Determinant, sympy.Trace):
        whole = whole.doit()
    if any(_is_infinite(part) for part in whole.atoms(sympy.Sum, sympy.Product)):
        whole = whole.doit()
    return whole


def _assume_real(whole: sympy.Basic) -> sympy.Basic:
    """Return an expression whose names are real numbers: ``a < oo`` holds, and is left out."""
    real = {s: sympy.Dummy(s.name, real=True) for s in whole.free_symbols if s.is_real is None}
    return whole.xreplace(real).doit().xreplace({dummy: name for name, dummy in real.items()})


def _order_powers(whole: sympy.Basic, free: Sequence[sympy.Symbol]) -> sympy.Basic:
    """Return a polynomial from its highest power down, as it is written by hand.

    SymPy keeps the terms of a sum in an order of its own, often the other way round. A sum that
    an author wrote in another order, under ``evaluate(False)``, stays as it is.
    """
    is_sum = bool(free) and isinstance(whole, sympy.Add) and whole.is_polynomial(*free)
    if not is_sum or whole.args != sympy.Add(*whole.args).args:
        return whole
    terms = sorted(
        whole.as_ordered_terms(), key=lambda term: -sympy.Poly(term, *free).total_degree()
    )
    return sympy.Add(*terms, evaluate=False)


def _convert_evaluated(whole: sympy.Basic, free: Sequence[sympy.Symbol] = ()) -> Expr:
    """Return the tree of what an expression comes to; an integral without a formula stays one."""
    try:
        return from_sympy(_order_powers(_evaluate(whole), free))
    except BankError:
        if not (hasattr(whole, "has") and whole.has(sympy.Integral, sympy.oo)):
            raise
        return from_sympy(whole if whole.has(sympy.Integral) else _assume_real(whole))


def _put_free_first(expr: Expr, free: frozenset[str]) -> Expr:
    """Return a formula with ``x + b`` for ``b + x``: in sums, what varies goes first."""
    if not isinstance(expr, Call):
        return expr
    args = tuple(_put_free_first(arg, free) for arg in expr.args)
    varies = [bool(names_in(arg) & free) for arg in args]
    if expr.op == "add" and True in varies and not _is_negative(args[varies.index(True)]):
        args = tuple(sorted(args, key=lambda arg: not names_in(arg) & free))
    return Call(expr.op, args)


def _is_negative(expr: Expr) -> bool:
    """Return whether a formula has a minus sign in front."""
    return isinstance(expr, Call) and expr.op == "neg"


def _is_written(whole: sympy.Basic) -> bool:
    """Return whether an author wrote the terms of a sum in an order that is not SymPy's own."""
    sums = whole.atoms(sympy.Add) if hasattr(whole, "atoms") else ()
    return any(one.args != sympy.Add(*one.args).args for one in sums)


def _is_infinite(part: sympy.Basic) -> bool:
    """Return whether a sum, a product or an integral has an infinite bound."""
    return any(not bound.is_finite for limit in part.limits for bound in limit[1:])


def _convert_matrix(whole: sympy.Basic, convert: Callable[[sympy.Basic], Expr]) -> Expr:
    """Return a matrix with evaluated entries; one of a single column is a vector."""
    explicit = whole.doit().as_explicit() if isinstance(whole, MatrixExpr) else whole
    rows = explicit.tolist()
    if explicit.shape[1] == 1:
        return Call("vector", tuple(convert(row[0]) for row in rows))
    return Call(
        "matrix",
        tuple(Call("row", tuple(convert(x) for x in row)) for row in rows),
    )


def _convert_set(whole: sympy.Basic) -> Expr:
    """Return a finite set, or a union of intervals."""
    if isinstance(whole, sympy.FiniteSet):
        return Call("set", tuple(map(from_sympy, whole.args)))
    pieces = list(_iter_intervals(whole))
    return Call("union", tuple(pieces))


def _iter_intervals(whole: sympy.Basic) -> Iterator[Expr]:
    """Yield the intervals that a set consists of; a single point is a closed one.

    Raises ``BankError`` for any other set.
    """
    if whole is sympy.S.EmptySet:
        return
    if whole is sympy.S.Reals:
        whole = sympy.Interval(-sympy.oo, sympy.oo)
    if isinstance(whole, sympy.Union):
        for part in whole.args:
            yield from _iter_intervals(part)
    elif isinstance(whole, sympy.Interval):
        sides = [make_number(int(not side)) for side in (whole.left_open, whole.right_open)]
        yield Call("interval", (_convert_bound(whole.start), _convert_bound(whole.end), *sides))
    elif isinstance(whole, sympy.FiniteSet):
        one: tuple[Num, Num] = (make_number(1), make_number(1))
        for point in whole.args:
            yield Call("interval", (from_sympy(point), from_sympy(point), *one))
    else:
        raise BankError(f"{whole} is no finite set and no union of intervals")


def _convert_bound(value: sympy.Basic) -> Expr:
    """Return the bound of an interval, which may be infinite."""
    if value.is_infinite:
        return Call("infinity", ()) if value > 0 else Call("neg", (Call("infinity", ()),))
    return from_sympy(value)


def step_name(symbol: sympy.Basic | str) -> str:
    """Return the name that a step defines: of a symbol, a function, a matrix, or a text."""
    if isinstance(symbol, str):
        return symbol
    if isinstance(symbol, AppliedUndef):
        return str(symbol.func.__name__)
    name: Mapping[str, str] | str = getattr(symbol, "name", "")
    if not name or not isinstance(name, str):
        raise BankError(f"{symbol} is no name for a step")
    return name
