"""What one change does: a factor where it is the same for all numbers, else value or direction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice

from quizgen import typeset
from quizgen.bank.draw import Draw
from quizgen.bank.plan import pick, shuffled
from quizgen.bank.prose import Block, Inline, Paragraph, Styled, Words
from quizgen.marking.kinds.number import Spec
from quizgen.marking.specs import decode
from quizgen.maths.notation import to_text
from quizgen.maths.numbers import exact_text, key_text, rational, rounded_text, short_decimal
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import Call, Num, Sym
from quizgen.maths.values import Value
from quizgen.question.contract import Built
from quizgen.question.filling import NBSP, Filler, plain, with_unit
from quizgen.question.kinds import KINDS
from quizgen.question.levels.asking import Asked
from quizgen.question.levels.changes import Change, Changes, needed, targets
from quizgen.question.levels.options import Option, choice
from quizgen.question.levels.steps import key_of, value_spec
from quizgen.question.shown import Maths, pieces, said
from quizgen.question.solution import Line, Mistake, PartSolution, line_of, mistakes_of
from quizgen.question.specs import mistaken
from quizgen.question.worked import drawn_node, drawn_typed, thing

DIRECTIONS = ("larger", "smaller", "unchanged")


@dataclass(frozen=True)
class Effect:
    """A change, and in which way its effect is asked."""

    change: Change
    way: str

    def __call__(self, lang: str) -> Asked:
        """The part in a language."""
        if self.way == "factor":
            return _factor(self.change, lang)
        return _value(self.change, lang) if self.way == "value" else _direction(self.change, lang)


def effect(changes: Changes) -> Effect | None:
    """What is asked about one change; None if no change makes sense."""
    drawn = changes.drawn
    other: list[Change] = []
    for index, target in shuffled(f"{key_of(drawn)}/effect", list(targets(drawn))):
        for change in changes.of(index, target):
            if change.factor is not None:
                return Effect(change, "factor")
            if change.power is None and change.before > 0:
                other.append(change)
    if not other:
        return None
    if pick(f"{key_of(drawn)}/effect/way", 2):
        return Effect(_one_way(changes, other), "direction")
    return Effect(other[0], "value")


def _one_way(changes: Changes, moving: list[Change]) -> Change:
    """A change in a drawn direction, if one is left: also of what the result does not rest on."""
    idle = changes.of(moving[0].index, moving[0].target, idle=True)
    first: dict[str, Change] = {}
    for change in (*moving, *islice(idle, 1)):
        first.setdefault(_way_of(change), change)
    ways = [way for way in DIRECTIONS if way in first]
    return first[ways[pick(f"{key_of(changes.drawn)}/effect/direction", len(ways))]]


def _way_of(change: Change) -> str:
    """In which direction a result moves."""
    with working_precision():
        if change.after == change.before:
            return "unchanged"
        return "larger" if change.after > change.before else "smaller"


def _body(change: Change, lang: str, key: str, hint: str = "") -> tuple[Block, ...]:
    only = said(lang, "transfer.only", change=change.said(lang))
    asked = said(lang, key, target=thing(change.drawn, change.target, lang))
    tail = (Words(" "), *said(lang, hint)) if hint else ()
    return (Paragraph((*only, Words(" "), Styled("strong", asked), *tail)),)


def _factor(change: Change, lang: str) -> Asked:
    """By what factor? The key follows from the power that the formulas prove."""
    found = change.factor or Fraction(1)
    traps: dict[str, str] = {}
    for name, wrong in _slips(change.scale, found):
        if wrong != found and str(wrong) not in traps.values():
            traps[name] = str(wrong)
    langs = change.drawn.template.languages
    notes = {each: {trap: plain(_slip(change, trap, each)) for trap in traps} for each in langs}
    table = {"kind": "number", "value": key_text(rational(found)), "rel": "0.005"}
    spec = decode(Spec, {**table, "traps": traps, "notes": notes} if traps else table)
    solved = PartSolution(
        label="",
        lines=tuple(_proof(change, found, lang)),
        shown=pieces(KINDS["number"].printed(spec, lang)),
        mistakes=tuple(
            Mistake(trap, _slip(change, trap, lang), pieces(_number(rational(wrong))))
            for trap, wrong in traps.items()
        ),
    )
    body = _body(change, lang, "transfer.factor", "transfer.factor_hint")
    return Asked(Fraction(1), body, spec, solved)


def _slips(scale: Fraction, found: Fraction) -> Iterator[tuple[str, Fraction]]:
    yield "upside-down", 1 / found
    yield "plain", scale
    yield "unchanged", Fraction(1)


def _slip(change: Change, trap: str, lang: str) -> tuple[Inline, ...]:
    return said(lang, f"transfer.trap_{trap}", **_both(change, lang))


def _both(change: Change, lang: str) -> dict[str, tuple[Inline, ...]]:
    drawn = change.drawn
    return {"target": thing(drawn, change.target, lang), "given": thing(drawn, change.given, lang)}


def _proof(change: Change, found: Fraction, lang: str) -> Iterator[Line]:
    """To which power of the quantity the result is proportional, and the same with numbers."""
    both = _both(change, lang)
    if not change.power:
        yield Line(_ratio(change, found), said(lang, "transfer.cancels", **both))
        return
    base = Sym(change.given)
    expr = base if change.power == 1 else Call("pow", (base, Num(change.power)))
    node = typeset.relation(["∝"], [typeset.name(change.target), typeset.layout(expr)])
    maths = Maths(node, f"{change.target} ∝ {to_text(expr)}")
    yield Line(maths, said(lang, "transfer.power", **both))
    yield Line(_ratio(change, found), said(lang, "transfer.ratio"))


def _ratio(change: Change, found: Fraction) -> Maths:
    """The new value over the old one."""
    draws = {"new": change.changed, "old": change.drawn}
    leaves = {name: drawn_node(draw, change.target) for name, draw in draws.items()}
    typed = {name: drawn_typed(draw, change.target) for name, draw in draws.items()}
    quotient, text = Call("div", (Sym("new"), Sym("old"))), _number(rational(found))
    sign = "≈" if any(draw.is_rounded(change.target) for draw in draws.values()) else "="
    node = typeset.relation([sign], [typeset.layout(quotient, leaves=leaves), typeset.number(text)])
    return Maths(node, f"{to_text(quotient, typed)} {sign} {text}")


def _number(value: Value) -> str:
    return exact_text(value) or rounded_text(value)


def shown_value(drawn: Draw, name: str) -> tuple[Inline, ...]:
    """A quantity with its unit in a sentence, with ≈ in front where it is rounded."""
    value, unit = drawn.shown_values[name], drawn.template.units[name]
    exactly = exact_text(value) if short_decimal(value) else None
    text = with_unit(exactly or rounded_text(value), unit)
    return pieces(text if exactly else f"≈{NBSP}{text}")


def _value(change: Change, lang: str) -> Asked:
    """The new value, marked as the part marks the old one."""
    step = change.drawn.template.chain.by_name[change.target]
    spec = value_spec(change.changed, change.index, step)
    filler = Filler(change.changed, lang)
    solved = PartSolution(
        label="",
        lines=_worked(change, lang),
        shown=pieces(KINDS[spec.kind].printed(spec, lang)),
        mistakes=tuple(mistakes_of(filler, Built(spec, mistakes=mistaken(spec, "value")))),
    )
    return Asked(Fraction(1), _body(change, lang, "transfer.value"), spec, solved)


def _worked(change: Change, lang: str) -> tuple[Line, ...]:
    """All steps after the change."""
    filler = Filler(change.changed, lang)
    return tuple(line_of(filler, one) for one in needed(change.changed, change.target))


def _direction(change: Change, lang: str) -> Asked:
    """Larger, smaller or the same? Each option is answered with both values."""
    right = _way_of(change)

    def because(each: str) -> tuple[Inline, ...]:
        return said(
            each, "transfer.before_after",
            target=thing(change.drawn, change.target, each),
            before=shown_value(change.drawn, change.target),
            after=shown_value(change.changed, change.target),
        )  # fmt: skip

    def option(way: str) -> Option:
        return Option(lambda each: said(each, f"transfer.{way}"), way == right, because, way)

    options = [option(way) for way in DIRECTIONS]
    body = _body(change, lang, "transfer.direction")
    return choice(change.drawn, lang, body, options, _worked(change, lang))
