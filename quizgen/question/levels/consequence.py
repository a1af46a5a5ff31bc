"""What one change does: a factor where it is the same for all numbers, else the new value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

from quizgen import typeset
from quizgen.bank.sampler import shuffle
from quizgen.bank.variant import Variant
from quizgen.grading.spec import decode_spec
from quizgen.kinds import KINDS
from quizgen.kinds.asking import misconception_specs
from quizgen.kinds.contract import AskedPart
from quizgen.kinds.number import NumberSpec
from quizgen.maths.notation import format_tree, pretty
from quizgen.maths.numbers import (
    format_exact,
    format_for_key,
    format_rounded,
    is_short_decimal,
    to_rational,
)
from quizgen.maths.tree import Call, Num, Sym
from quizgen.maths.units import format_unit
from quizgen.maths.values import Value
from quizgen.question.interpolation import NBSP, Interpolator, inlines_to_text, join_unit
from quizgen.question.levels.contract import LevelPart
from quizgen.question.levels.perturbations import (
    Perturbation,
    Perturbations,
    askable_results,
    required_steps,
)
from quizgen.question.levels.steps import level_seed, step_value_spec
from quizgen.question.solution import (
    PartSolution,
    SolutionStep,
    SolvedMisconception,
    solution_step,
    solved_misconceptions,
)
from quizgen.question.worked_steps import quantity_inlines
from quizgen.typeset.prose import (
    Block,
    Emphasis,
    Inline,
    Paragraph,
    PlainText,
    TypesetMaths,
    to_inlines,
    translate_inlines,
)


@dataclass(frozen=True)
class Consequence:
    """A change, and in which way its effect is asked."""

    change: Perturbation
    way: str

    def __call__(self, lang: str) -> LevelPart:
        """Return the part in a language."""
        if self.way == "factor":
            return _ask_factor(self.change, lang)
        return _ask_new_value(self.change, lang)


def choose_consequence(changes: Perturbations) -> Consequence | None:
    """Return what is asked about one change; None if no change makes sense."""
    drawn = changes.drawn
    other: list[Perturbation] = []
    for index, target in shuffle(f"{level_seed(drawn)}/effect", list(askable_results(drawn))):
        for change in changes.of(index, target):
            if change.factor is not None:
                return Consequence(change, "factor")
            if change.power is None and change.before > 0:
                other.append(change)
    return Consequence(other[0], "value") if other else None


@dataclass(frozen=True)
class WayBack:
    """A wanted factor of a result, and the factor of one quantity that brings it about."""

    change: Perturbation

    def __call__(self, lang: str) -> LevelPart:
        """Return the part in a language."""
        change, wanted = self.change, self.change.factor or Fraction(1)
        slips = {"upside-down": 1 / change.scale, "plain": wanted, "unchanged": Fraction(1)}
        both = _name_target_and_given(change, lang)
        number = (PlainText(pretty.format_number(_format_number(to_rational(wanted)))),)
        body = translate_inlines(lang, "transfer.way_back", number=number, **both)
        asked = Emphasis("strong", translate_inlines(lang, "transfer.factor_of", **both))
        hint = translate_inlines(lang, "transfer.factor_hint")
        return _make_factor_part(
            change, change.scale, slips, "back",
            (Paragraph((*body, PlainText(" "), asked, PlainText(" "), *hint)),), lang,
        )  # fmt: skip


def choose_way_back(changes: Perturbations, asked: Consequence | None) -> WayBack | None:
    """Return what is asked the other way round; None where no power other than 0 is proved.

    Never of the pair of quantities whose change is asked about already.
    """
    drawn = changes.drawn
    taken = asked and (asked.change.target, asked.change.given)
    for index, target in shuffle(f"{level_seed(drawn)}/back", list(askable_results(drawn))):
        for change in changes.of(index, target):
            if change.factor not in {None, 1} and (change.target, change.given) != taken:
                return WayBack(change)
    return None


def _build_effect_body(
    change: Perturbation, lang: str, key: str, hint: str = ""
) -> tuple[Block, ...]:
    """Return the paragraph that states a change and asks for its effect."""
    only = translate_inlines(lang, "transfer.only", change=change.describe(lang))
    asked = translate_inlines(lang, key, target=quantity_inlines(change.drawn, change.target, lang))
    tail = (PlainText(" "), *translate_inlines(lang, hint)) if hint else ()
    return (Paragraph((*only, PlainText(" "), Emphasis("strong", asked), *tail)),)


def _ask_factor(change: Perturbation, lang: str) -> LevelPart:
    """Return a part that asks by what factor a result changes.

    The key follows from the power that the formulas prove.
    """
    found = change.factor or Fraction(1)
    body = _build_effect_body(change, lang, "transfer.factor", "transfer.factor_hint")
    slips = dict(_iter_factor_slips(change.scale, found))
    return _make_factor_part(change, found, slips, "trap", body, lang)


def _make_factor_part(
    change: Perturbation,
    found: Fraction,
    slips: Mapping[str, Fraction],
    told: str,
    body: tuple[Block, ...],
    lang: str,
) -> LevelPart:
    """Return a part whose answer is a factor, with the wrong ones that learners give.

    ``told`` begins the names of the sentences on them.
    """
    traps: dict[str, str] = {}
    for name, wrong in slips.items():
        if wrong != found and str(wrong) not in traps.values():
            traps[name] = str(wrong)
    langs = change.drawn.template.languages
    notes = {
        each: {
            trap: inlines_to_text(_build_slip_sentence(change, f"{told}_{trap}", each))
            for trap in traps
        }
        for each in langs
    }
    table = {"kind": "number", "value": format_for_key(to_rational(found)), "rel": "0.005"}
    spec = decode_spec(NumberSpec, {**table, "traps": traps, "notes": notes} if traps else table)
    solved = PartSolution(
        label="",
        lines=tuple(_iter_proof_lines(change, change.factor or Fraction(1), lang)),
        shown=to_inlines(KINDS["number"].explain_key(spec, lang)),
        mistakes=tuple(
            SolvedMisconception(
                trap,
                _build_slip_sentence(change, f"{told}_{trap}", lang),
                to_inlines(_format_number(to_rational(wrong))),
            )
            for trap, wrong in traps.items()
        ),
    )
    return LevelPart(Fraction(1), body, spec, solved)


def _iter_factor_slips(scale: Fraction, found: Fraction) -> Iterator[tuple[str, Fraction]]:
    """Yield the wrong factors that learners give, each with its name.

    The inverse, the factor of the given quantity itself, and no change at all.
    """
    yield "upside-down", 1 / found
    yield "plain", scale
    yield "unchanged", Fraction(1)


def _build_slip_sentence(change: Perturbation, trap: str, lang: str) -> tuple[Inline, ...]:
    """Return the sentence for somebody who gave a wrong factor."""
    return translate_inlines(lang, f"transfer.{trap}", **_name_target_and_given(change, lang))


def _name_target_and_given(change: Perturbation, lang: str) -> dict[str, tuple[Inline, ...]]:
    """Return the names of the result and of the changed quantity, for the blanks of a sentence."""
    drawn = change.drawn
    return {
        "target": quantity_inlines(drawn, change.target, lang),
        "given": quantity_inlines(drawn, change.given, lang),
    }


def _iter_proof_lines(change: Perturbation, found: Fraction, lang: str) -> Iterator[SolutionStep]:
    """Yield the power that the result is proportional to, and the same with numbers."""
    both = _name_target_and_given(change, lang)
    if not change.power:
        yield SolutionStep(
            _typeset_ratio(change, found), translate_inlines(lang, "transfer.cancels", **both)
        )
        return
    base = Sym(change.given)
    expr = base if change.power == 1 else Call("pow", (base, Num(change.power)))
    node = typeset.relation_chain(
        ["∝"], [typeset.lay_out_name(change.target), typeset.lay_out(expr)]
    )
    maths = TypesetMaths(node, f"{change.target} ∝ {format_tree(expr)}")
    yield SolutionStep(maths, translate_inlines(lang, "transfer.power", **both))
    yield SolutionStep(_typeset_ratio(change, found), translate_inlines(lang, "transfer.ratio"))


def _typeset_ratio(change: Perturbation, found: Fraction) -> TypesetMaths:
    """Return the new value over the old one, typeset."""
    draws = {"new": change.changed, "old": change.drawn}
    values = {name: draw.shown_values[change.target] for name, draw in draws.items()}
    unit = format_unit(change.drawn.template.units[change.target])
    texts = {name: _format_decimal(value) for name, value in values.items()}
    leaves = {name: typeset.quantity(text, unit) for name, text in texts.items()}
    typed = {name: f"({join_unit(text, unit)})" if unit else text for name, text in texts.items()}
    quotient, text = Call("div", (Sym("new"), Sym("old"))), _format_number(to_rational(found))
    sign = "=" if all(map(is_short_decimal, values.values())) else "≈"
    node = typeset.relation_chain(
        [sign], [typeset.lay_out(quotient, leaves=leaves), typeset.number(text)]
    )
    return TypesetMaths(node, f"{format_tree(quotient, typed)} {sign} {text}")


def _format_number(value: Value) -> str:
    """Return a number as text: exact if it is short, else rounded."""
    return format_exact(value) or format_rounded(value)


def _format_decimal(value: Value) -> str:
    """Return a number as a decimal: exact if it is short, else rounded."""
    return (format_exact(value) if is_short_decimal(value) else None) or format_rounded(value)


def value_inlines(drawn: Variant, name: str) -> tuple[Inline, ...]:
    """Return a quantity's value with its unit, with ≈ in front where it is rounded."""
    value, unit = drawn.shown_values[name], drawn.template.units[name]
    text = join_unit(_format_decimal(value), unit)
    return to_inlines(text if is_short_decimal(value) else f"≈{NBSP}{text}")


def _ask_new_value(change: Perturbation, lang: str) -> LevelPart:
    """Return a part that asks for the new value, graded as the authored part grades the old one."""
    step = change.drawn.template.chain.by_name[change.target]
    spec = step_value_spec(change.changed, change.index, step)
    filler = Interpolator(change.changed, lang)
    solved = PartSolution(
        label="",
        lines=_build_solution_lines(change, lang),
        shown=to_inlines(KINDS[spec.kind].explain_key(spec, lang)),
        mistakes=tuple(
            solved_misconceptions(
                filler, AskedPart(spec, mistakes=misconception_specs(spec, "value"))
            )
        ),
    )
    return LevelPart(Fraction(1), _build_effect_body(change, lang, "transfer.value"), spec, solved)


def _build_solution_lines(change: Perturbation, lang: str) -> tuple[SolutionStep, ...]:
    """Return all steps after the change."""
    filler = Interpolator(change.changed, lang)
    return tuple(
        solution_step(filler, one) for one in required_steps(change.changed, change.target)
    )
