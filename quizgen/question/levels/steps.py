"""One step of the chain as a question of its own: its name, its formulas, its value."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from string import ascii_lowercase
from typing import Any, NamedTuple

from flint import fmpq

from quizgen import typeset
from quizgen.bank.form_comparison import APART
from quizgen.bank.markdown import leaves, slot_names
from quizgen.bank.sampler import shuffle
from quizgen.bank.variant import Variant
from quizgen.core.errors import MathError
from quizgen.grading.spec import ScalarSpec, decode_spec
from quizgen.kinds import angle, number, quantity
from quizgen.kinds.contract import asked_quantities
from quizgen.maths.canonical import canonical_forms
from quizgen.maths.chain import ChainStep
from quizgen.maths.notation import format_tree
from quizgen.maths.number_systems import compile_expr, exact_system, select_branch
from quizgen.maths.numbers import format_for_key, is_short_decimal, to_float
from quizgen.maths.precision import working_precision
from quizgen.maths.tolerance import RULES
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in, walk_tree
from quizgen.maths.values import Value
from quizgen.question.interpolation import format_quantity
from quizgen.question.part_context import VariantPart, authored_answer
from quizgen.question.worked_steps import value_node, value_typed
from quizgen.typeset.names import iter_names_written
from quizgen.typeset.prose import (
    Block,
    CodeBlock,
    Inline,
    InlineCode,
    InlineFormula,
    LaidOutFormula,
    PlainText,
    TypesetMaths,
)

USUAL = {"rel": "0.005"}
"""What is accepted where the rule of the part does not fit the step."""
ROMAN = ("i", "ii", "iii", "iv", "v", "vi", "vii", "viii", "ix", "x", "xi", "xii")
_BANNED = tuple(1000**n for n in range(1, 7))
"""Factors in a wrong formula that only change a unit."""
_DEGREES = Call("div", (Num(Fraction(180)), Call("pi", ())))
"""Radians to degrees."""


class FormulaOption(NamedTuple):
    """A formula that may be taken for a step: the right one, a misconception's, or a slip's."""

    trap: str
    shown: TypesetMaths
    value: Value
    slip: str = ""

    @property
    def is_right(self) -> bool:
        """Return whether it is the right formula."""
        return not self.trap and not self.slip


def has_name(drawn: Variant, name: str) -> bool:
    """Return whether every language says what a quantity is called."""
    known = drawn.template.quantities
    return all(known.name(name, lang) for lang in drawn.template.languages)


def has_sentence(drawn: Variant, section: str, name: str) -> bool:
    """Return whether a sentence is written in every language."""
    return all(text.sentence(section, name) for text in drawn.template.texts.values())


@lru_cache(maxsize=128)
def introduced_names(drawn: Variant) -> frozenset[str]:
    """Return the letters that the question itself uses: in formulas, programs, or as capitals."""
    return frozenset(_iter_mentioned_names(_iter_authored_text(drawn)))


_WORD = re.compile(r"[A-Za-z]\w*")


def _iter_authored_text(drawn: Variant) -> Iterator[Block | Inline]:
    """Yield stem and parts in the first language."""
    text = drawn.template.texts[drawn.template.languages[0]]
    yield from text.stem
    for label in drawn.template.labels:
        yield from text.sections.get(label, ())


@lru_cache(maxsize=128)
def stated_quantities(drawn: Variant) -> frozenset[str]:
    """Return the quantities whose numbers text or figure give, or that follow from these."""
    figure = drawn.template.rules.figure
    found = {*slot_names(_iter_authored_text(drawn)), *(figure.reads if figure else ())}
    for name, rule in drawn.template.rules.draw.items():
        if rule.formula and names_in(drawn.template.parse_formula(rule.formula)) <= found:
            found.add(name)
    chain = drawn.template.chain
    return frozenset(found | {step.name for step in chain.steps if _is_one_over(step, found)})


def _is_one_over(step: ChainStep, found: Collection[str]) -> bool:
    """Return whether the text gives a quantity as one over a number: an exposure of 1/250 s."""
    match step.expr:
        case Call("div", (Num(value=1), Sym(below))):
            return below in found and step.unit == "s"
    return False


@lru_cache(maxsize=128)
def defined_quantities(drawn: Variant) -> frozenset[str]:
    """Return the quantities whose formula the text writes down."""
    return frozenset(
        left.name
        for part in leaves(_iter_authored_text(drawn))
        if isinstance(part, InlineFormula) and isinstance(part.expr, Call) and part.expr.op == "eq"
        for left, right in [part.expr.args]
        if isinstance(left, Sym) and isinstance(right, Call)
    )


_BLANK = re.compile(r"\{\{.*?\}\}")
_CAPITAL = re.compile(r"(?<![\w'])[B-HJ-Z](?!\w)")
"""A letter that is no word of English."""


def _iter_mentioned_names(parts: Iterable[Block | Inline]) -> Iterator[str]:
    """Yield the letters that prose uses, in formulas, programs, and as capitals in words."""
    for part in leaves(parts):
        match part:
            case InlineFormula(expr):
                yield from names_in(expr)
            case LaidOutFormula(node):
                yield from iter_names_written(node)
            case CodeBlock(text) | InlineCode(text):
                yield from _WORD.findall(_BLANK.sub("", text))
            case PlainText(text):
                yield from _CAPITAL.findall(text)
            case _:
                pass


def flatten_sums(expr: Expr) -> Expr:
    """Return the same formula with sums of sums as one sum: no bracket in ((a + b) + c)/3."""
    if not isinstance(expr, Call):
        return expr
    args = tuple(map(flatten_sums, expr.args))
    if expr.op == "add":
        inner = [arg.args if isinstance(arg, Call) and arg.op == "add" else (arg,) for arg in args]
        args = tuple(arg for group in inner for arg in group)
    return Call(expr.op, args)


def step_formula(
    drawn: Variant, step: ChainStep, expr: Expr, known: frozenset[str]
) -> TypesetMaths:
    """Return a step's formula, with numbers for letters that the question does not introduce."""
    expr, strangers = flatten_sums(expr), names_in(expr) - known
    node = typeset.lay_out(expr, leaves={name: value_node(drawn, name) for name in strangers})
    typed = format_tree(expr, {name: value_typed(drawn, name) for name in strangers})
    return TypesetMaths(
        typeset.relation_chain(["="], [typeset.lay_out_name(step.name), node]),
        f"{step.name} = {typed}",
    )


def list_untold_letters(drawn: Variant, step: ChainStep, known: frozenset[str]) -> list[str]:
    """Return the letters of a step's formulas that the text gives numbers for, but does not name.

    They are in the order of the chain.
    """
    formulas = [step.expr, *(expr for _, expr in _iter_step_misconceptions(drawn, step))]
    used = {name for expr in formulas for name in names_in(applicable_branch(drawn, expr))}
    return [name for name in drawn.template.units if name in used - known]


def given_equation(drawn: Variant, name: str) -> TypesetMaths:
    """Return a quantity and its value as an equation."""
    node = typeset.relation_chain(["="], [typeset.lay_out_name(name), value_node(drawn, name)])
    return TypesetMaths(node, f"{name} = {format_quantity(drawn, name)}")


def gives_away(drawn: Variant, step: ChainStep, known: frozenset[str]) -> bool:
    """Return whether a step's formula would print its value, or anything else that is asked."""
    formulas = [step.expr, *(expr for _, expr in _iter_step_misconceptions(drawn, step))]
    strangers = {
        name for expr in formulas for name in names_in(applicable_branch(drawn, expr)) - known
    }
    right = applicable_branch(drawn, step.expr)
    bare = not isinstance(right, Call) and not names_in(step.expr) & known
    return (
        bare
        or bool(strangers & drawn.lists.keys())
        or not strangers <= stated_quantities(drawn)
        or leaks_answer(drawn, step.name, right)
    )


def right_option(drawn: Variant, step: ChainStep, known: frozenset[str]) -> FormulaOption:
    """Return the right formula, in the branch that applies."""
    return FormulaOption(
        "",
        step_formula(drawn, step, applicable_branch(drawn, step.expr), known),
        drawn.values[step.name],
    )


def leaks_answer(drawn: Variant, name: str, expr: Expr) -> bool:
    """Return whether a formula in print tells what another question of the paper asks."""
    asked = drawn.elsewhere.formulas
    return bool(asked) and not asked.isdisjoint(canonical_forms(Call("eq", (Sym(name), expr))))


def applicable_branch(drawn: Variant, expr: Expr) -> Expr:
    """Return a formula in the branch that applies to this variant."""
    with working_precision():
        return select_branch(expr, drawn.values, exact_system())


@lru_cache(maxsize=128)
def wrong_options(
    drawn: Variant, step: ChainStep, known: frozenset[str]
) -> tuple[FormulaOption, ...]:
    """Return formulas of a step's misconceptions with another value, each once, shuffled."""
    right = right_option(drawn, step, known)
    found = {right.shown.typed_text: right}
    for trap, expr in _iter_step_misconceptions(drawn, step):
        value, taken = evaluate_formula(drawn, expr), applicable_branch(drawn, expr)
        if (
            value is None
            or differs_in_unit_only(expr, step.expr)
            or is_same_value(value, right.value)
        ):
            continue
        if leaks_answer(drawn, step.name, taken):
            continue
        shown = step_formula(drawn, step, taken, known)
        found.setdefault(shown.typed_text, FormulaOption(trap, shown, value))
    ways = [way for way in found.values() if way.trap]
    return tuple(shuffle(f"{level_seed(drawn)}/{step.name}/ways", ways))


def part_labels(drawn: Variant, count: int) -> list[str]:
    """Return labels of parts that a level makes: letters, unless the task uses letters itself."""
    if count == 1:
        return [""]
    task = {*_iter_mentioned_names(_iter_authored_text(drawn)), *_iter_table_fields(drawn)}
    letters = list(ascii_lowercase[:count])
    return letters if task.isdisjoint(letters) else list(ROMAN[:count])


def _iter_table_fields(drawn: Variant) -> Iterator[str]:
    """Yield what the authored parts call the fields of a table."""
    for part in drawn.template.rules.part:
        if isinstance(part.answer.get("of"), Mapping):
            yield from part.answer["of"]


def level_seed(drawn: Variant) -> str:
    """Return the text that the choices of a level are drawn from."""
    template = drawn.template
    return f"{template.origin}/{template.rules.version}/{drawn.seed}/{drawn.slot}/levels"


def _iter_step_misconceptions(drawn: Variant, step: ChainStep) -> Iterator[tuple[str, Expr]]:
    """Yield the misconceptions of a step that have a sentence in every language."""
    template = drawn.template
    for trap, steps in template.chain.traps.items():
        wrong = [one.expr for one in steps if one.name == step.name]
        if wrong and trap not in template.rules.drop and has_sentence(drawn, "traps", trap):
            yield from ((trap, expr) for expr in wrong)


def differs_in_unit_only(wrong: Expr, right: Expr) -> bool:
    """Return whether a wrong formula differs by a factor of 1000, or radians for degrees, alone.

    Without numbers nobody can call 2·atan(W/(2·f)) a wrong formula of an angle.
    """

    def numbers(expr: Expr) -> set[object]:
        """Return the numbers that a formula is written with."""
        return {node.value for node in walk_tree(expr) if isinstance(node, Num)}

    odd = numbers(wrong) - numbers(right)
    if _DEGREES in walk_tree(right) and _DEGREES not in walk_tree(wrong):
        return True
    return any(size in (value, 1 / value) for value in odd if value for size in _BANNED)  # type: ignore[operator]


def evaluate_formula(drawn: Variant, expr: Expr) -> Value | None:
    """Return what a formula gives with the right values before it; None if it has no value."""
    with working_precision():
        try:
            value: Value = compile_expr(expr, exact_system())(drawn.values)
        except (MathError, ZeroDivisionError, OverflowError):
            return None
    return value


def is_same_value(a: Value, b: Value) -> bool:
    """Return whether two values are equal but for rounding of the computation."""
    with working_precision():
        return bool(abs(a - b) <= fmpq(1, 10**6) * abs(b))


def step_value_spec(drawn: Variant, index: int, step: ChainStep) -> ScalarSpec:
    """Return what a step's value is graded by: its part's rule, the step's misconceptions."""
    answer, about = _select_answer_rule(drawn, index, step), drawn.template.about
    unit = str(answer.get("unit", step.unit))
    table = _build_answer_table(answer, unit, _find_count_nouns(drawn, index, step))
    table |= {"define": about.units} if about.units else {}
    with working_precision():
        value = drawn.values[step.name] / drawn.template.unit_factor(unit)
        table |= {
            "of": [step.name],
            "value": format_for_key(value),
            **_choose_tolerance(answer, value),
        }
        traps = dict(
            _iter_telling_misconceptions(drawn, step, _decode_step_spec(table), value, unit)
        )
    notes = VariantPart(drawn, index).misconception_notes(traps) if traps else {}
    return _decode_step_spec({**table, "traps": traps, "notes": notes} if traps else table)


def _decode_step_spec(table: Mapping[str, object]) -> ScalarSpec:
    """Return a table as the specification of its kind."""
    return decode_spec(_SHAPES[str(table["kind"])], table)


_SHAPES: dict[str, type[ScalarSpec]] = {
    "number": number.NumberSpec, "quantity": quantity.QuantitySpec, "angle": angle.AngleSpec
}  # fmt: skip


def _iter_telling_misconceptions(
    drawn: Variant, step: ChainStep, spec: ScalarSpec, value: Value, unit: str
) -> Iterator[tuple[str, str]]:
    """Yield misconceptions that differ from the key and from each other, with their answers."""
    width = APART * spec.outer_width(to_float(value))
    taken, factor = [to_float(value)], drawn.template.unit_factor(unit)
    for trap, expr in _iter_step_misconceptions(drawn, step):
        wrong = evaluate_formula(drawn, expr)
        if wrong is None:
            continue
        number = to_float(wrong / factor)
        if all(abs(number - other) > width for other in taken):
            taken.append(number)
            yield trap, format_for_key(wrong / factor)


def _select_answer_rule(drawn: Variant, index: int, step: ChainStep) -> Mapping[str, Any]:
    """Return the part's answer as far as it concerns a step.

    Unit and rule of the part hold for its own quantities alone.
    """
    answer = dict(authored_answer(drawn, index))
    of = answer.get("of", ())
    labels = {name: label for label, name in of.items()} if isinstance(of, Mapping) else {}
    if step.name in asked_quantities(answer):
        cell = answer.get("cells", {}).get(labels.get(step.name), {})
        kept = {k: v for k, v in answer.items() if k not in RULES} if {*RULES} & {*cell} else answer
        return {**kept, **cell, "own": True}
    return {k: v for k, v in answer.items() if k in {*RULES, "kind", "bare", "within"}}


def _find_count_nouns(drawn: Variant, index: int, step: ChainStep) -> dict[str, list[str]]:
    """Return the words for what an asked quantity counts."""
    answer = authored_answer(drawn, index)
    if step.name not in asked_quantities(answer):
        return {}
    found = VariantPart(drawn, index).count_nouns().get("counts", [])
    if isinstance(found, Mapping):
        of = answer["of"]
        labels = [
            label
            for label in found
            if (of.get(label) if isinstance(of, Mapping) else label) == step.name
        ]
        found = found[labels[0]] if labels else []
    return {"counts": found} if found else {}


def _build_answer_table(
    answer: Mapping[str, Any], unit: str, counted: dict[str, list[str]]
) -> dict[str, Any]:
    """Return kind and unit of the value."""
    if unit == "deg":
        return {"kind": "angle", "period": 0}
    if unit and unit != "1":
        bare = answer["kind"] != "quantity" or answer.get("bare", False)
        return {"kind": "quantity", "unit": unit, "bare": bare}
    percent = {"percent": True} if answer.get("percent") else {}
    return {"kind": "number", **percent, **counted}


def _choose_tolerance(answer: Mapping[str, Any], value: Value) -> Mapping[str, Any]:
    """Return the part's tolerance where it fits a step.

    Decimals and absolute distances are meant for the asked quantity alone.
    """
    stated = {rule: answer[rule] for rule in (*RULES, "within") if rule in answer}
    if answer.get("own"):
        return stated or USUAL
    if value == 0:
        return {"exact": True}
    if {"decimals", "abs", "exact"} & {*stated}:
        return {"exact": True} if is_short_decimal(value) else USUAL
    return stated or USUAL
