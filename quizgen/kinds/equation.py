"""Kind ``equation``: any equation, or inequality, with the same solutions.

Equations may differ by a factor that is not 0, inequalities by a positive one.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, ClassVar

import msgspec
from flint import fmpq

from quizgen.grading.judging.algebraic_equality import prove_equal
from quizgen.grading.judging.relations import as_fraction
from quizgen.grading.judging.sampled_equality import Domain, compare_by_sampling, values_agree
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.formulas import parse_authored, read_formula
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import HALF, Verdict, ambiguous, correct, partial, wrong
from quizgen.kinds.asking import make_spec, misconception_specs
from quizgen.kinds.contract import AnswerKind, AskedPart, AuthoredAnswer, PartContext
from quizgen.kinds.forms import require_form, typeset_key
from quizgen.kinds.work import count_once
from quizgen.locale import translate
from quizgen.maths.constants import evaluate_constant
from quizgen.maths.notation import FormulaReadError, format_tree, pretty
from quizgen.maths.tree import Call, Expr, make_number, names_in

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines


class AuthoredEquation(AuthoredAnswer, kw_only=True, tag="equation", frozen=True):
    """An equation or inequality of the solver."""

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
            _parse_authored_relation(text, tuple(self.symbols))

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Judge a typed equation or inequality."""
        first, *rest = _SIGN.split(typed)
        if len(rest) != len(("sign", "side")) or not (first.strip() and rest[1].strip()):
            raise FormulaReadError("equation-expected", 1, typed.strip()[:60])
        left, right = (
            read_formula(s, self.symbols, options.decimal).tree for s in (first, rest[1])
        )
        equation = Call(_OPERATORS[rest[0]], (left, right))
        read_as = pretty.format_formula(format_tree(equation))
        same = self._is_same(self.value, equation)
        if same is None:
            return ambiguous("undecided", read_as)
        if same:
            return correct(read_as, ground="sampled")
        note = next(
            (f"trap:{name}" for name, text in self.traps.items() if self._is_same(text, equation)),
            "",
        )
        if equation.op in _OTHER_BORDER and self._is_same(
            self.value, Call(_OTHER_BORDER[equation.op], equation.args)
        ):
            return partial(HALF, read_as, note or "border")
        return wrong(read_as, note)

    def _is_same(self, key: str, equation: Call) -> bool | None:
        """Whether both have the same solutions, by a constant factor; None if undecided."""
        own = _parse_authored_relation(key, tuple(self.symbols))
        if _kind_of(own) != _kind_of(equation):
            return False
        if own.op == "eq" and not names_in(own) | names_in(equation):
            return _is_true(own) == _is_true(equation)
        mine, typed = _take_difference(own), _take_difference(equation)
        domains: dict[str, Domain] = dict.fromkeys(self.symbols, "real")
        if own.op == "eq":
            mine, typed = (as_fraction(_multiply_conjugates(side))[0] for side in (mine, typed))
        if prove_equal(mine, typed):
            return True
        found = compare_by_sampling(mine, typed, domains)
        if found.equal is None:
            return None
        if found.equal or found.ratio is None:
            return found.equal
        same = values_agree(found.ratio, fmpq(0)) is False
        return same and (own.op == "eq" or bool(found.ratio > 0))

    def replace_key(self, form: Expr, /) -> EquationSpec:
        """Return the specification with another equation as its key, and without mistakes."""
        return msgspec.structs.replace(self, value=format_tree(form), traps={})

    def show(self) -> str:
        """Return the key as it is printed, and as it can be typed back."""
        return pretty.format_formula(format_tree(parse_authored(self.value, tuple(self.symbols))))


_SIGN = re.compile(r"(<=|>=|==|[<>=≤≥])")
_OPERATORS = {
    "=": "eq",
    "==": "eq",
    "<": "lt",
    "<=": "le",
    "≤": "le",
    ">": "gt",
    ">=": "ge",
    "≥": "ge",
}
_OTHER_BORDER = {"lt": "le", "le": "lt", "gt": "ge", "ge": "gt"}
"""The same inequality with its border, or without it: half of the points."""
RELATIONS = ("eq", "lt", "le", "gt", "ge")


def _parse_authored_relation(text: str, symbols: tuple[str, ...]) -> Call:
    """Return an equation or inequality in a bank; ``ValueError`` if it is none."""
    tree = parse_authored(text, symbols)
    if not isinstance(tree, Call) or tree.op not in RELATIONS:
        raise ValueError(f"{text!r} is no equation")
    return tree


def _kind_of(relation: Call) -> str:
    """Return ``=``, ``<`` or ``<=``, whichever way round."""
    return {"eq": "=", "lt": "<", "gt": "<"}.get(relation.op, "<=")


def _take_difference(relation: Call) -> Expr:
    """Return what is 0, or at least 0, where an equation or inequality holds."""
    left, right = relation.args
    return Call("sub", (right, left) if relation.op in {"lt", "le"} else (left, right))


def _is_true(equation: Call) -> bool:
    """Return whether an equation between numbers holds: one that does not has no solution."""
    return evaluate_constant(equation.args[0]) == evaluate_constant(equation.args[1])


def _multiply_conjugates(tree: Expr) -> Expr:
    """Return a formula with ``(a - √b)(a + √b)`` as ``a² - b``, which is 0 for the same numbers.

    For a negative b the product has no value, and the difference is positive.
    """
    if not isinstance(tree, Call):
        return tree
    args = tuple(map(_multiply_conjugates, tree.args))
    if tree.op == "mul" and [getattr(arg, "op", "") for arg in args] in _CONJUGATES:
        (a, root), (same, other) = (arg.args for arg in args if isinstance(arg, Call))
        if a == same and root == other and isinstance(root, Call) and root.op == "sqrt":
            return Call("sub", (Call("pow", (a, make_number(2))), root.args[0]))
    return Call(tree.op, args)


_CONJUGATES = (["sub", "add"], ["add", "sub"])


def ask(part: PartContext) -> AskedPart[EquationSpec]:
    """Return the equation of the solver, and what each mistake makes of it."""
    forms = {"": part.answer_form(), **part.misconception_forms()}
    texts = {
        name: format_tree(require_form(part, form, *RELATIONS)) for name, form in forms.items()
    }
    value = texts.pop("")
    names = sorted(set().union(*map(names_in, forms.values())))
    symbols = list(dict.fromkeys([*part.answer.get("symbols", ()), *names]))
    notes = part.misconception_notes(texts) if texts else {}
    spec = make_spec(EquationSpec, part, value=value, symbols=symbols, traps=texts, notes=notes)
    return AskedPart(spec, mistakes=misconception_specs(spec, "value"))


def input_hints(spec: EquationSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return how an equation or an inequality is typed, whichever is asked."""
    is_equation = _parse_authored_relation(spec.value, tuple(spec.symbols)).op == "eq"
    return (translate(lang, "ask.equation" if is_equation else "ask.inequality"),)


def explain_key(spec: EquationSpec, _lang: str) -> TextOrInlines:
    """The equation as it is written by hand."""
    return typeset_key(parse_authored(spec.value, tuple(spec.symbols)))


KIND = AnswerKind(
    AuthoredEquation,
    EquationSpec,
    ask,
    input_hints,
    explain_key,
    work=count_once("line derived", 2),
)
