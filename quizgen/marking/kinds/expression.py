"""Kind ``expression``: a formula over declared names; equality, with its ground stated."""

from __future__ import annotations

import msgspec
from flint import arb, fmpq

from quizgen.errors import FormulaError
from quizgen.marking.judging.number import settle
from quizgen.marking.judging.proving import proved_equal
from quizgen.marking.judging.sampling import Comparison, Domain, agree, compare, equal
from quizgen.marking.judging.settling import settle_equal
from quizgen.marking.options import Options
from quizgen.marking.reading.formulas import Formula, author, read_formula
from quizgen.marking.rounding import exact_or_figures
from quizgen.marking.specs import Worded
from quizgen.marking.verdict import Verdict, ambiguous, correct, wrong
from quizgen.maths.constants import exact_value
from quizgen.maths.notation import people, to_text
from quizgen.maths.tree import Expr, names
from quizgen.maths.values import Value


class Spec(Worded, kw_only=True, frozen=True):
    """Expression: ``value``; ``symbols`` = {name: "real", "positive" or [low, high]}."""

    value: str
    symbols: dict[str, Domain]
    traps: dict[str, str] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check the key, its names and the domains."""
        used = names(author(self.value, tuple(self.symbols)))
        unknown = used - self.symbols.keys()
        if unknown:
            raise FormulaError(f"value uses undeclared names {', '.join(sorted(unknown))}")
        for name, domain in self.symbols.items():
            _check_domain(name, domain)
        for trap in self.traps.values():
            author(trap, tuple(self.symbols))
        if not used:
            exact_value(self.value)

    def judge(self, typed: str, options: Options, /) -> Verdict:
        """Judge a typed formula."""
        formula = read_formula(typed, self.symbols, options.decimal)
        verdict = _judge(self, formula.tree, options)
        if formula.other is None or formula.doubt is None:
            return verdict
        return _choose(self, formula, verdict, options)

    def show(self) -> str:
        """Return the key as it can be typed."""
        return people.formula(to_text(author(self.value, tuple(self.symbols))))


def _check_domain(name: str, domain: Domain) -> None:
    if isinstance(domain, str):
        if domain not in {"real", "positive"}:
            raise ValueError(f"symbols.{name}: {domain!r} is not real, positive or [low, high]")
    elif len(domain) != 2 or not exact_value(domain[0]) < exact_value(domain[1]):
        raise ValueError(f"symbols.{name}: [low, high] needs low < high")


def _judge(spec: Spec, tree: Expr, options: Options) -> Verdict:
    read_as = people.formula(to_text(tree))
    key = author(spec.value, tuple(spec.symbols))
    if tree == key:
        return correct(read_as, ground="proved")
    found = compare(key, tree, spec.symbols)
    if found.equal is None and options.settle:
        found = _settled(key, tree, spec, found)
    if found.equal is None:
        return ambiguous("undecided", read_as)
    if found.equal:
        ground = "proved" if proved_equal(key, tree) else found.ground
        return correct(read_as, ground=ground, points=found.points)
    return _wrong(spec, tree, found, read_as)


def _choose(spec: Spec, formula: Formula, verdict: Verdict, options: Options) -> Verdict:
    if formula.other is None or formula.doubt is None or (formula.doubt.native and verdict.credit):
        return verdict
    echoes = (formula.read_as, people.formula(to_text(formula.other)))
    return settle(verdict, _judge(spec, formula.other, options), formula.doubt, echoes)


def _settled(key: Expr, tree: Expr, spec: Spec, found: Comparison) -> Comparison:
    return msgspec.structs.replace(
        found, equal=settle_equal(key, tree, spec.symbols), ground="settled"
    )


def _wrong(spec: Spec, tree: Expr, found: Comparison, read_as: str) -> Verdict:
    for name, trap in spec.traps.items():
        if equal(author(trap, tuple(spec.symbols)), tree, spec.symbols):
            return wrong(read_as, f"trap:{name}")
    if found.ground == "domain":
        return wrong(read_as, "domain")
    if found.ratio is not None:
        note = "sign" if agree(found.ratio, fmpq(-1)) else "constant-factor"
        return wrong(read_as, note, factor=_short(found.ratio))
    if found.difference is not None:
        return wrong(read_as, "constant-offset", offset=_short(found.difference))
    return wrong(read_as, _missing(spec, tree))


def _missing(spec: Spec, tree: Expr) -> str:
    """Note that a quantity of the key does not occur at all."""
    key = names(author(spec.value, tuple(spec.symbols)))
    return "name-missing" if key - names(tree) else ""


def _short(value: Value) -> str:
    if isinstance(value, fmpq) and value.q < 1000:
        return people.number(str(value))
    exact = value.mid().fmpq() if isinstance(value, arb) else value
    return people.number(exact_or_figures(exact, 4))
