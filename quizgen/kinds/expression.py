"""Kind ``expression``: a formula over declared names; equality, with its ground stated."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from fractions import Fraction
from typing import TYPE_CHECKING, ClassVar, Literal

import msgspec
from flint import arb, fmpq

from quizgen.core.errors import FormulaError, MathError
from quizgen.grading.judging.algebraic_equality import prove_equal
from quizgen.grading.judging.numeric import choose_reading
from quizgen.grading.judging.sampled_equality import (
    Domain,
    SamplingResult,
    are_equal,
    compare_by_sampling,
    values_agree,
)
from quizgen.grading.judging.sympy_equality import decide_by_sympy
from quizgen.grading.judging.written_form import has_form
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.formulas import TypedFormula, parse_authored, read_formula
from quizgen.grading.rounding import format_exact_or_figures
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import HALF, Verdict, ambiguous, correct, partial, wrong
from quizgen.kinds.asking import hint, make_spec, misconception_specs
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    FieldProblem,
    PartContext,
    SymbolDomain,
)
from quizgen.kinds.forms import split_sides, typeset_key
from quizgen.kinds.work import count_once
from quizgen.locale import translate
from quizgen.maths.constants import parse_exact
from quizgen.maths.derivative import differentiate
from quizgen.maths.notation import FormulaReadError, format_tree, pretty
from quizgen.maths.numbers import format_for_key
from quizgen.maths.operators import BINDERS
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tree import Expr, Num, names_in, operators_in, substitute
from quizgen.maths.values import Value

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

EXAMPLE = "(a+b)^2/2"
"""A formula as it is typed, and no answer to any question."""
CONSTANT = "C"
"""The constant of integration, as it may be typed."""
_CONSTANT_LAST = re.compile(r"[-+−–] ?(?P<name>[ckK]|[cC]_?\{?[0-9]\}?|[Cc]onst\.?)\s*$")
_ZERO, _ONE = Num(Fraction(0)), Num(Fraction(1))


class AuthoredExpression(AuthoredAnswer, kw_only=True, tag="expression", frozen=True):
    """A formula: as it is written here, or one of the solver's."""

    of: str = ""
    value: str = ""
    symbols: dict[str, SymbolDomain | Literal["whole"]] = msgspec.field(default_factory=dict)
    traps: dict[str, str] = msgspec.field(default_factory=dict)
    form: Literal["", "any", "factored", "expanded", "lowest"] = ""
    up_to: Literal["", "constant", "factor"] = ""

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield a problem unless there is a formula, and one alone."""
        if bool(self.of) == bool(self.value):
            yield (("of",) if self.of else ()), "QG112", "give either value or of"
        elif self.value and not self.symbols:
            yield (), "QG112", "value needs symbols"


class ExpressionSpec(WordSpec, kw_only=True, frozen=True):
    """Expression: ``value``; ``symbols`` = {name: "real", "positive", "whole" or [low, high]}.

    ``form`` = factored, expanded or lowest; ``up_to`` = constant (``+ C`` may be typed) or factor.
    ``calls`` are values of an unknown function, such as ``f(n - 1)``, by the names that they have
    in formulas.
    """

    written_as: ClassVar[AnswerForm] = "formula"

    value: str
    symbols: dict[str, Domain]
    traps: dict[str, str] = msgspec.field(default_factory=dict)
    form: Literal["", "any", "factored", "expanded", "lowest"] = ""
    up_to: Literal["", "constant", "factor"] = ""
    calls: dict[str, str] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check the key, its names and the domains.

        Raises
        ------
        FormulaError
            If a formula cannot be read or uses names that are not declared.
        ValueError
            If a domain is none.
        """
        used = names_in(_parse_key(self.value, self.symbols))
        unknown = used - self.symbols.keys()
        if unknown:
            raise FormulaError(f"value uses undeclared names {', '.join(sorted(unknown))}")
        for name, domain in self.symbols.items():
            _check_domain(name, domain)
        for trap in self.traps.values():
            _parse_key(trap, self.symbols)
        if not used:
            parse_exact(self.value)

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on a typed formula: equal to the key over the domain, or why not.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        free = self.up_to == "constant" and CONSTANT not in self.symbols
        names = (*self.symbols, CONSTANT) if free else self.symbols
        emphatic = "factorial" not in self.value
        if free:
            typed = self._name_constant(typed)
        for name, call in self.calls.items():
            typed = _match_call(call).sub(name, typed)
        verdicts = [
            self._judge_formula(
                read_formula(side, names, options.decimal, emphatic=emphatic), options, free=free
            )
            for side in split_sides(typed, names)
        ]
        if len({bool(verdict.credit) for verdict in verdicts}) > 1:
            raise FormulaReadError("sides-differ", 1, typed.strip()[:60])
        last = verdicts[-1]
        return msgspec.structs.replace(last, read_as=self._name_calls(last.read_as))

    def read_form(self, typed: str, options: GradingOptions, /) -> Expr:
        """Return the last side of a typed formula; errors as ``judge``."""
        names = (*self.symbols, CONSTANT) if self.up_to == "constant" else tuple(self.symbols)
        if CONSTANT in names and CONSTANT not in self.symbols:
            typed = self._name_constant(typed)
        side = split_sides(typed, names)[-1]
        tree = read_formula(side, names, options.decimal).tree
        return tree if CONSTANT in self.symbols else substitute(tree, {CONSTANT: _ZERO})

    def replace_key(self, form: Expr, /) -> ExpressionSpec:
        """Return the specification with another formula as its key, and without mistakes."""
        symbols = dict.fromkeys(names_in(form), "real") | self.symbols
        return msgspec.structs.replace(self, value=format_tree(form), traps={}, symbols=symbols)

    def _name_constant(self, typed: str) -> str:
        """Return a formula with ``C`` for another usual name of the constant that is added last."""
        match = _CONSTANT_LAST.search(typed)
        if match is None or match["name"] in self.symbols:
            return typed
        return f"{typed[: match.start('name')]}{CONSTANT}"

    def _name_calls(self, text: str) -> str:
        """Return a formula for people with the calls of functions as they are written."""
        for name, call in self.calls.items():
            text = text.replace(pretty.format_name(name), pretty.format_formula(call))
        return text

    def _judge_formula(
        self, formula: TypedFormula, options: GradingOptions, *, free: bool
    ) -> Verdict:
        """Return the verdict on one formula, whose numbers may have two readings."""
        if free:
            kept = tidy_formula(substitute(formula.tree, {CONSTANT: _ONE}))
            formula = msgspec.structs.replace(
                formula, tree=tidy_formula(substitute(formula.tree, {CONSTANT: _ZERO}))
            )
            verdict = _judge(self, kept, options)
            if not verdict.credit:  # C x is no constant
                return verdict
        verdict = _judge(self, formula.tree, options)
        if formula.other is None or formula.doubt is None:
            return verdict
        return _choose(self, formula, verdict, options)

    def show(self) -> str:
        """Return the key as it can be typed."""
        key = format_tree(_parse_key(self.value, self.symbols))
        return self._name_calls(pretty.format_formula(key))


_CALL = re.compile(r"(?P<name>[^\W\d_]\w*)\((?P<of>.+)\)")


def _match_call(call: str) -> re.Pattern[str]:
    """Return what finds ``f(n-1)`` as people type it, ``f_{n - 1}`` and ``f[n−1]`` too."""
    found = _CALL.fullmatch(call)
    if found is None:
        return re.compile(re.escape(call))
    signs = "".join(found["of"].split())
    inside = r"\s*".join("[-−–]" if sign in "-−" else re.escape(sign) for sign in signs)
    return re.compile(rf"(?<![^\W\d_]){found['name']}\s*_?\s*[({{\[]\s*{inside}\s*[)}}\]]")


_BOUND = re.compile(rf"\b(?:{'|'.join(sorted(BINDERS))})\((\w+),")
"""What finds the name that a sum or an integral runs over."""


def _parse_key(formula: str, symbols: Iterable[str]) -> Expr:
    """Return the tree of a key or a mistake, which may have sums and integrals in it."""
    return parse_authored(formula, (*symbols, *_BOUND.findall(formula)))


def _check_domain(name: str, domain: Domain) -> None:
    """Check the domain of one name.

    Raises
    ------
    ValueError
        If it is not ``real``, ``positive``, ``whole`` or two bounds in order.
    """
    if isinstance(domain, str):
        if domain not in {"real", "positive", "whole"}:
            what = f"{domain!r} is not real, positive, whole or [low, high]"
            raise ValueError(f"symbols.{name}: {what}")
    elif len(domain) != 2 or not parse_exact(domain[0]) < parse_exact(domain[1]):
        raise ValueError(f"symbols.{name}: [low, high] needs low < high")


def _judge(spec: ExpressionSpec, tree: Expr, options: GradingOptions) -> Verdict:
    """Return the verdict on one reading of a formula.

    It is ambiguous where neither sampling nor, if it is allowed, SymPy can decide.
    """
    read_as = pretty.format_formula(format_tree(tree))
    key = _parse_key(spec.value, spec.symbols)
    if tree == key:
        return _judge_form(spec, tree, correct(read_as, ground="proved"))
    if spec.up_to == "constant" and "integral" in operators_in(key):
        with suppress(MathError):  # without a rule, values of the integral decide
            return _judge_rates(spec, key, tree)
    found = compare_by_sampling(key, tree, spec.symbols)
    if _is_equal_enough(spec, found):
        return _judge_form(spec, tree, correct(read_as, ground=found.ground, points=found.points))
    if found.equal is None and options.settle:
        found = _settle_equality(key, tree, spec, found)
    if found.equal is None:
        return ambiguous("undecided", read_as)
    if found.equal:
        ground = "proved" if prove_equal(key, tree) else found.ground
        return _judge_form(spec, tree, correct(read_as, ground=ground, points=found.points))
    return _wrong(spec, tree, found, read_as)


def _judge_rates(spec: ExpressionSpec, key: Expr, tree: Expr) -> Verdict:
    """Return the verdict on an antiderivative by its derivative, which the key's integral has.

    Raises ``MathError`` if there is no rule for one of them.
    """
    read_as = pretty.format_formula(format_tree(tree))
    names = names_in(key) | names_in(tree)
    rates = [(differentiate(key, name), differentiate(tree, name)) for name in sorted(names)]
    found = [are_equal(*pair, spec.symbols) for pair in rates]
    if None in found:
        return ambiguous("undecided", read_as)
    if all(found):
        return _judge_form(spec, tree, correct(read_as, ground="sampled"))
    differs = SamplingResult(equal=False, points=1, ground="differs")
    return _wrong(spec, tree, differs, read_as)


def _is_equal_enough(spec: ExpressionSpec, found: SamplingResult) -> bool:
    """Whether a formula differs from the key by no more than is asked."""
    if spec.up_to == "constant":
        return found.difference is not None
    return spec.up_to == "factor" and found.ratio is not None and bool(found.ratio != 0)


def _judge_form(spec: ExpressionSpec, tree: Expr, right: Verdict) -> Verdict:
    """Return half of the marks for a right formula that has not the form asked."""
    if has_form(tree, spec.form):
        return right
    return partial(HALF, right.read_as, f"form-{spec.form}")


def _choose(
    spec: ExpressionSpec, formula: TypedFormula, verdict: Verdict, options: GradingOptions
) -> Verdict:
    """Return the verdict on a formula with two readings, or ask back."""
    if formula.other is None or formula.doubt is None or (formula.doubt.native and verdict.credit):
        return verdict
    echoes = (formula.read_as, pretty.format_formula(format_tree(formula.other)))
    return choose_reading(verdict, _judge(spec, formula.other, options), formula.doubt, echoes)


def _settle_equality(
    key: Expr, tree: Expr, spec: ExpressionSpec, found: SamplingResult
) -> SamplingResult:
    """Return what SymPy decides where sampling could not."""
    return msgspec.structs.replace(
        found, equal=decide_by_sympy(key, tree, spec.symbols), ground="settled"
    )


def _wrong(spec: ExpressionSpec, tree: Expr, found: SamplingResult, read_as: str) -> Verdict:
    """Return the wrong verdict: a known mistake, a factor or offset, or a name that is missing."""
    for name, trap in spec.traps.items():
        mistake = _parse_key(trap, spec.symbols)
        related = bool(spec.up_to) and _is_equal_enough(
            spec, compare_by_sampling(mistake, tree, spec.symbols)
        )
        if related or are_equal(mistake, tree, spec.symbols):
            return wrong(read_as, f"trap:{name}")
    if found.ground == "domain":
        return wrong(read_as, "domain")
    if found.ratio is not None:
        note = "sign" if values_agree(found.ratio, fmpq(-1)) else "constant-factor"
        return wrong(read_as, note, factor=_short(found.ratio))
    if found.difference is not None:
        return wrong(read_as, "constant-offset", offset=_short(found.difference))
    return wrong(read_as, _missing(spec, tree))


def _missing(spec: ExpressionSpec, tree: Expr) -> str:
    """Return the note for a quantity of the key that does not occur at all, else an empty text."""
    key = names_in(_parse_key(spec.value, spec.symbols))
    return "name-missing" if key - names_in(tree) else ""


def _short(value: Value) -> str:
    """Return a number for a sentence: exact if it is short, else with four figures."""
    if isinstance(value, fmpq) and value.q < 1000:
        return pretty.format_number(str(value))
    exact = value.mid().fmpq() if isinstance(value, arb) else value
    return pretty.format_number(format_exact_or_figures(exact, 4))


def ask(part: PartContext) -> AskedPart[ExpressionSpec]:
    """Return the formula as it is written, or of the solver, with the drawn numbers in place."""
    traps = part.answer.get("traps", {})
    given: dict[str, object] = {}
    if value := part.answer.get("value"):
        calls = {
            f"{found['name']}_at{place}": call
            for place, call in enumerate(part.answer["symbols"], 1)
            if (found := _CALL.fullmatch(call))
        }
        traps = {name: _put_numbers_in(part, calls, text) for name, text in traps.items()}
        value = _put_numbers_in(part, calls, value)
        names = {call: name for name, call in calls.items()}
        symbols = {names.get(n, n): d for n, d in part.answer["symbols"].items()}
        given = {"value": value, "traps": traps, "symbols": symbols, "calls": calls}
    if part.answer.get("of"):
        forms = {"": part.answer_form(), **part.misconception_forms()}
        value, *_ = written = [format_tree(form) for form in forms.values()]
        traps = dict(zip([*forms][1:], written[1:], strict=True))
        free = sorted(set().union(*map(names_in, forms.values())))
        symbols = dict.fromkeys(free, "real") | dict(part.answer.get("symbols", {}))
        given = {"value": value, "traps": traps, "symbols": symbols}
    notes = part.misconception_notes(traps) if traps else {}
    spec = make_spec(ExpressionSpec, part, notes=notes, **given)
    return AskedPart(spec, mistakes=misconception_specs(spec, "value"))


def _put_numbers_in(part: PartContext, calls: Mapping[str, str], text: str) -> str:
    """Return a formula with numbers for drawn names that are none of its symbols."""
    for name, call in calls.items():
        text = _match_call(call).sub(name, text)
    symbols = [*part.answer["symbols"].keys() - set(calls.values()), *calls]
    known = {
        name: Num(Fraction(format_for_key(value)))
        for name, value in part.shown.items()
        if name not in symbols
    }
    tree = parse_authored(text, (*symbols, *known))
    if not names_in(tree) & known.keys():
        return text
    return format_tree(tidy_formula(substitute(tree, known)))


def explain_key(spec: ExpressionSpec, _lang: str) -> TextOrInlines:
    """Return the formula as it is written by hand."""
    key = _parse_key(spec.value, spec.symbols)
    if not spec.calls:
        return typeset_key(key)
    from quizgen.typeset import lay_out
    from quizgen.typeset.from_latex import lay_out_latex
    from quizgen.typeset.prose import TypesetMaths

    leaves = {name: lay_out_latex(call) for name, call in spec.calls.items()}
    return (TypesetMaths(lay_out(key, leaves=leaves, inline=True), spec.show()),)


HOW_TO_TYPE = hint("ask.expression", example=EXAMPLE)


def input_hints(spec: ExpressionSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return how a formula is typed, and the form that is asked."""
    return (*HOW_TO_TYPE(spec, lang), *paper_hints(spec, lang))


def accept_equivalent(spec: ExpressionSpec, lang: str) -> str:
    """Return that other ways to write it count, unless one is asked."""
    return translate(lang, "scheme.equivalent") if spec.form in {"", "any"} else ""


def paper_hints(spec: ExpressionSpec, lang: str) -> tuple[str, ...]:
    """Return the form that is asked, and what may be added to it."""
    form = f"ask.form_{spec.form}" if spec.form not in {"", "any"} else ""
    free = f"ask.up_to_{spec.up_to}" if spec.up_to else ""
    return tuple(translate(lang, name) for name in (form, free) if name)


KIND = AnswerKind(
    AuthoredExpression,
    ExpressionSpec,
    ask,
    input_hints,
    explain_key,
    paper_hints,
    accept_equivalent,
    work=count_once("line derived", 2),
)
