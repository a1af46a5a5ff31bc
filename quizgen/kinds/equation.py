"""Kind ``equation``: any equation with the same solutions, equal up to a factor that is not 0."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import msgspec
from flint import fmpq

from quizgen.grading.judging.algebraic_equality import prove_equal
from quizgen.grading.judging.sampled_equality import Domain, compare_by_sampling, values_agree
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.formulas import parse_authored, read_formula
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import Verdict, ambiguous, correct, wrong
from quizgen.kinds.asking import hint, make_spec, misconception_specs
from quizgen.kinds.contract import AnswerKind, AskedPart, AuthoredAnswer, PartContext
from quizgen.kinds.forms import require_form, typeset_key
from quizgen.maths.notation import FormulaReadError, format_tree, pretty
from quizgen.maths.tree import Call, Expr, names_in

if TYPE_CHECKING:
    from quizgen.question.inlines import TextOrInlines


class AuthoredEquation(AuthoredAnswer, kw_only=True, tag="equation", frozen=True):
    """An equation of the solver."""

    of: str
    symbols: tuple[str, ...] = ()


class EquationSpec(WordSpec, kw_only=True, frozen=True):
    """Equation: ``value`` such as ``(x - 1)^2 + y^2 = 4``; ``symbols`` that it may hold."""

    written_as: ClassVar[AnswerForm] = "formula"

    value: str
    symbols: list[str]
    traps: dict[str, str] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Require the key and the mistakes to be equations."""
        for text in (self.value, *self.traps.values()):
            _split_authored(text, tuple(self.symbols))

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Judge a typed equation."""
        sides = typed.replace("==", "=").split("=")
        if len(sides) != 2 or not all(side.strip() for side in sides):
            raise FormulaReadError("equation-expected", 1, typed.strip()[:60])
        left, right = (read_formula(side, self.symbols, options.decimal).tree for side in sides)
        equation = Call("eq", (left, right))
        read_as = pretty.format_formula(format_tree(equation))
        same = self._is_same(self.value, equation)
        if same is None:
            return ambiguous("undecided", read_as)
        if same:
            return correct(read_as, ground="sampled")
        for name, text in self.traps.items():
            if self._is_same(text, equation):
                return wrong(read_as, f"trap:{name}")
        return wrong(read_as)

    def _is_same(self, key: str, equation: Call) -> bool | None:
        """Whether two equations differ by a constant factor; None if that cannot be told."""
        first = _split_authored(key, tuple(self.symbols))
        mine, typed = Call("sub", first), Call("sub", equation.args)
        domains: dict[str, Domain] = dict.fromkeys(self.symbols, "real")
        if prove_equal(mine, typed):
            return True
        found = compare_by_sampling(mine, typed, domains)
        if found.equal is None:
            return None
        ratio = found.ratio
        return found.equal or (ratio is not None and values_agree(ratio, fmpq(0)) is False)

    def show(self) -> str:
        """Return the key as it is printed, and as it can be typed back."""
        return pretty.format_formula(format_tree(parse_authored(self.value, tuple(self.symbols))))


def _split_authored(text: str, symbols: tuple[str, ...]) -> tuple[Expr, ...]:
    """Return left and right side of an equation in a bank; ``ValueError`` if it is none."""
    tree = parse_authored(text, symbols)
    if not isinstance(tree, Call) or tree.op != "eq":
        raise ValueError(f"{text!r} is no equation")
    return tree.args


def ask(part: PartContext) -> AskedPart[EquationSpec]:
    """Return the equation of the solver, and what each mistake makes of it."""
    forms = {"": part.answer_form(), **part.misconception_forms()}
    texts = {name: format_tree(require_form(part, form, "eq")) for name, form in forms.items()}
    value = texts.pop("")
    names = sorted(set().union(*map(names_in, forms.values())))
    symbols = list(dict.fromkeys([*part.answer.get("symbols", ()), *names]))
    notes = part.misconception_notes(texts) if texts else {}
    spec = make_spec(EquationSpec, part, value=value, symbols=symbols, traps=texts, notes=notes)
    return AskedPart(spec, mistakes=misconception_specs(spec, "value"))


def explain_key(spec: EquationSpec, _lang: str) -> TextOrInlines:
    """The equation as it is written by hand."""
    return typeset_key(parse_authored(spec.value, tuple(spec.symbols)))


KIND = AnswerKind(AuthoredEquation, EquationSpec, ask, hint("ask.equation"), explain_key)
