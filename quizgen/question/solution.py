"""Worked solutions: each step as *formula = numbers in place = exact value ~ rounded value*.

All of it comes from the one chain of the solver: the formula is printed, the same formula is
printed with the drawn numbers in place, and its exact value follows. The language files add one
sentence of why per step.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from quizgen import typeset
from quizgen.bank.draw import Draw, plan_of
from quizgen.bank.prose import Block, CodeBlock, Inline, Slot, Table, Words, fill, fill_text
from quizgen.errors import BankError
from quizgen.locale import word
from quizgen.maths.chain import ChainStep
from quizgen.maths.notation import to_text
from quizgen.maths.numbers import exact_text, rational, rounded_text, short_decimal
from quizgen.maths.precision import working_precision
from quizgen.maths.systems import compile_expr, exact, floats, singles, taken_branch
from quizgen.maths.tree import Expr, Sym, names
from quizgen.maths.units import shown as unit_shown
from quizgen.maths.units import unit

NBSP = "\u00a0"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
STEP_FIGURES = 6
"""Significant figures of an intermediate value that has no short exact form."""


@dataclass(frozen=True, slots=True)
class Maths:
    """A formula ready for printing: its layout, and how it would be typed."""

    node: Any
    typed: str


@dataclass(frozen=True, slots=True)
class Line:
    """One step: the worked formula and why it is taken."""

    maths: Maths
    why: tuple[Inline, ...]


@dataclass(frozen=True, slots=True)
class Mistake:
    """A known mistake: its name, what went wrong, and the answer it would give."""

    name: str
    sentence: tuple[Inline, ...]
    value: str


@dataclass(frozen=True, slots=True)
class PartSolution:
    """The worked solution of one part."""

    label: str
    lines: tuple[Line, ...]
    answer: str
    mistakes: tuple[Mistake, ...]
    options: tuple[tuple[Inline, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class Solution:
    """The worked solution of a question in one language."""

    lang: str
    title: str
    parts: tuple[PartSolution, ...]
    check: tuple[Block, ...]
    note: tuple[Block, ...]
    why: tuple[Block, ...] = ()
    precision: tuple[Block, ...] = ()


def filled(parts: Any, drawn: Draw, lang: str, *, hidden: bool = False) -> Any:
    """Fill the slots of blocks or inlines.

    Parameters
    ----------
    parts : blocks or inlines
    drawn : Draw
    lang : str
    hidden : bool
        Refuse quantities that are solved for, so that a stem cannot give an answer away.

    Raises
    ------
    BankError
        If a slot names nothing that may stand there.
    """

    def value(part: Inline) -> Inline:
        if isinstance(part, Slot):
            return _slot(part.name, drawn, lang, hidden=hidden)
        if isinstance(part, CodeBlock):
            return CodeBlock(in_program(part.text, drawn, hidden=hidden))
        return _inline_maths(part.expr)

    return fill(parts, value)


@lru_cache(maxsize=4096)
def _inline_maths(expr: Expr) -> Maths:
    return Maths(typeset.layout(expr, inline=True), to_text(expr))


def in_program(text: str, drawn: Draw, *, hidden: bool = False) -> str:
    """Program text or its output with the drawn values in place, as a program writes them.

    Raises
    ------
    BankError
        If a blank names a quantity that may not stand there or is not a short decimal.
    """

    def value(name: str) -> str:
        known = drawn.shown if hidden else {**drawn.values, **drawn.shown}
        text = exact_text(drawn.in_unit(name), minus="-") if name in known else None
        if text is None:
            what = f"{{{{ {name} }}}} cannot stand in a program"
            raise BankError(f"template {drawn.template.id!r}: {what}")
        return text

    return fill_text(text, value)


def _slot(name: str, drawn: Draw, lang: str, *, hidden: bool) -> Inline:
    if name in drawn.words:
        found = drawn.template.texts[lang].sentence("words", drawn.words[name])
        if found is None:
            raise BankError(_complaint(drawn, lang, f"no words for {drawn.words[name]!r}"))
        found = filled(found, drawn, lang, hidden=hidden)
        return found if len(found) != 1 else found[0]
    if name in drawn.shown:
        return Words(quantity_text(drawn.shown[name], drawn.template.units.get(name, "")))
    if hidden or name not in drawn.values:
        raise BankError(_complaint(drawn, lang, f"{{{{ {name} }}}} is not a drawn quantity"))
    return Words(quantity_text(drawn.in_unit(name), drawn.template.units[name]))


def _complaint(drawn: Draw, lang: str, what: str) -> str:
    return f"{drawn.template.path / f'{lang}.md'}: {what}"


def quantity_text(value: Any, unit: str) -> str:
    """A value with its unit as text, exact if that is short."""
    text = exact_text(value) or rounded_text(value, figures=STEP_FIGURES)
    return with_unit(text, unit)


def with_unit(text: str, unit: str) -> str:
    """A number and its unit; only the degree sign stands close."""
    shown = unit_shown(unit)
    readable = re.sub(r"e(-?\d+)$", lambda m: f"·10{m[1].translate(SUPERSCRIPTS)}", text)
    return f"{readable}{'' if shown in {'', '°'} else NBSP}{shown}"


def sentence(
    drawn: Draw, lang: str, section: str, name: str, *, hidden: bool = False
) -> tuple[Inline, ...]:
    """A named sentence with its slots filled.

    Raises
    ------
    BankError
        If the language file does not have it.
    """
    found = drawn.template.texts[lang].sentence(section, name)
    if found is None:
        raise BankError(_complaint(drawn, lang, f"section {section!r} lacks {name!r}"))
    result: tuple[Inline, ...] = filled(found, drawn, lang, hidden=hidden)
    return result


def solve(drawn: Draw, lang: str, built: tuple[Mapping[str, Any], ...]) -> Solution:
    """Work an instance out in one language.

    Parameters
    ----------
    drawn : Draw
    lang : str
    built : tuple of mapping
        The specifications of the parts.
    """
    text = drawn.template.texts[lang]
    return Solution(
        lang=lang,
        title=text.title,
        parts=tuple(_part(drawn, lang, i, spec) for i, spec in enumerate(built)),
        check=filled(text.sections.get("check", ()), drawn, lang),
        note=filled(text.sections.get("note", ()), drawn, lang),
        precision=precision_table(drawn, lang),
        why=filled(text.sections.get("why", ()), drawn, lang),
    )


def precision_table(drawn: Draw, lang: str) -> tuple[Block, ...]:
    """What the template's chosen steps come to in float32, in float64 and exactly."""
    chosen = drawn.template.rules.precision
    if not chosen:
        return ()
    head = tuple((Words(word(lang, f"precision.{name}")),) for name in ("way", "value"))
    several = len(chosen) > 1
    rows = []
    for name in chosen:
        for way, text in _ways(drawn, name):
            label = (
                f"{name}: {word(lang, f'precision.{way}')}"
                if several
                else word(lang, f"precision.{way}")
            )
            rows.append(((Words(label),), (Words(text),)))
    return (Table(head, tuple(rows)),)


def _ways(drawn: Draw, name: str) -> Iterator[tuple[str, str]]:
    chain, shown = drawn.template.chain, drawn.template.units.get(name, "")
    for way, number_system in (("float32", singles()), ("float64", floats())):
        env = {n: number_system.constant(_fraction(drawn.values[n])) for n in chain.given}
        try:
            for step in chain.steps:
                env[step.name] = compile_expr(step.expr, number_system)(env)
            text = f"{env[name] / float(unit(shown).factor):.9g}"
            yield way, with_unit(text.replace("e-0", "e-"), shown)
        except (ZeroDivisionError, ValueError, OverflowError):
            yield way, "-"
    yield "exact", with_unit(rounded_text(drawn.in_unit(name), figures=9), shown)


def _fraction(value: Any) -> Fraction:
    return Fraction(int(value.p), int(value.q))


def _part(drawn: Draw, lang: str, index: int, spec: Mapping[str, Any]) -> PartSolution:
    from quizgen.question.specs import display

    plan = plan_of(drawn.template).parts[index]
    shown_names = drawn.template.rules.part[index].show
    steps = [s for s in plan.steps if shown_names is None or s.name in shown_names]
    lines = tuple(Line(worked(drawn, s), _why(drawn, lang, s.name)) for s in steps)
    mistakes = tuple(
        Mistake(trap, sentence(drawn, lang, "traps", trap), _wrong_text(spec, value))
        for trap, value in spec.get("traps", {}).items()
    )
    label = drawn.template.labels[index]
    if spec["kind"] == "text":
        points = tuple(sentence(drawn, lang, "points", name) for name in spec["points"])
        return PartSolution(label, lines, "", mistakes, points)
    options, _ = display(drawn, index)
    right = [options[i - 1][1] for i in spec.get("correct", ())] if options else []
    chosen = tuple(sentence(drawn, lang, "options", name) for name in right)
    return PartSolution(label, lines, printed_answer(spec, lang), mistakes, chosen)


def _why(drawn: Draw, lang: str, name: str) -> tuple[Inline, ...]:
    return sentence(drawn, lang, "steps", name)


def answer_text(spec: Mapping[str, Any], lang: str) -> str:
    """The key as it is printed; typed back, it is correct."""
    from quizgen.marking.mark import show

    return show(spec, lang)


def printed_answer(spec: Mapping[str, Any], lang: str) -> str:
    """The answer as the solution states it: exact first where that says more."""
    rounded = answer_text(spec, lang)
    values = spec.get("values", spec.get("value"))
    if isinstance(values, Mapping) or not readable_fractions(values):
        return rounded
    if "decimals" in spec or spec.get("percent"):
        return rounded
    exactly = answer_text({**_without_rounding(spec), "exact": True}, lang)
    return exactly if exactly == rounded else f"{exactly} ≈ {rounded}"


def readable_fractions(values: Any) -> bool:
    """Whether values are whole numbers and short fractions, some fraction among them."""
    texts = [values] if isinstance(values, str) else list(values or ())
    return all(re.fullmatch(r"-?\d{1,6}(/\d{1,3})?", str(t)) for t in texts) and any(
        "/" in str(t) for t in texts
    )


def _without_rounding(spec: Mapping[str, Any]) -> dict[str, Any]:
    dropped = {"abs", "rel", "sigfigs", "decimals", "within", "accept"}
    return {name: value for name, value in spec.items() if name not in dropped}


def _wrong_text(spec: Mapping[str, Any], value: Any) -> str:
    """A wrong answer as it would be written down: like the key, rounded where it is exact."""
    left_out = {"traps", "notes", "exact", "form", "accept"}
    wrong = {name: entry for name, entry in spec.items() if name not in left_out}
    if spec.get("exact"):
        parts = list(value.values()) if isinstance(value, Mapping) else value
        texts = [parts] if isinstance(parts, str) else parts
        short = all(short_decimal(rational(text)) for text in texts)
        wrong |= {"exact": True} if short else {"sigfigs": len("1.234") - 1}
    wrong[key_field(spec, value)] = value
    return answer_text(wrong, "en")


def key_field(spec: Mapping[str, Any], value: Any) -> str:
    """Name of the field of a specification that holds the key."""
    if spec["kind"] == "code":
        return "output"
    return "value" if isinstance(value, str) else "values"


def worked(drawn: Draw, step: ChainStep) -> Maths:
    """One step, printed from formula to rounded value."""
    with working_precision():
        expr = taken_branch(step.expr, drawn.values, exact())
    ways = [("=", typeset.layout(expr), to_text(expr))]
    if names(expr):
        numbers = typeset.layout(expr, leaves=_leaves(drawn, expr))
        ways.append((_sign(drawn, expr), numbers, _typed_numbers(drawn, expr)))
    for sign, node, text in _value_nodes(drawn.in_unit(step.name), step.unit):
        if text != ways[-1][2]:
            ways.append((sign, node, text))
    signs = [sign for sign, _, _ in ways]
    nodes = [typeset.name(step.name), *(node for _, node, _ in ways)]
    typed = "".join(f" {sign} {text}" for sign, _, text in ways)
    return Maths(typeset.relation(signs, nodes), f"{step.name}{typed}")


def _typed_numbers(drawn: Draw, expr: Expr) -> str:
    """The formula as typed with the numbers in place."""
    units = drawn.template.units

    def text(match: re.Match[str]) -> str:
        if match[0] not in names(expr):
            return match[0]
        shown = quantity_text(drawn.in_unit(match[0]), units.get(match[0], ""))
        simple = re.fullmatch(r"[0-9.]+", shown)
        return shown if simple else f"({shown})"

    return (
        re.sub(r"[A-Za-z][\w']*", text, to_text(expr))
        if not isinstance(expr, Sym)
        else quantity_text(drawn.in_unit(expr.name), units.get(expr.name, ""))
    )


def _sign(drawn: Draw, expr: Expr) -> str:
    """Equal, unless a number put in place had to be rounded for showing."""
    inexact = any(
        exact_text(drawn.in_unit(n)) is None for n in names(expr) if n in drawn.template.units
    )
    return "≈" if inexact else "="


def _leaves(drawn: Draw, expr: Expr) -> dict[str, Any]:
    units = drawn.template.units
    return {name: _leaf(drawn.in_unit(name), units.get(name, "")) for name in sorted(names(expr))}


def _leaf(value: Any, unit: str) -> Any:
    text = exact_text(value) or rounded_text(value, figures=STEP_FIGURES)
    return typeset.quantity(text, unit_shown(unit))


def _value_nodes(value: Any, unit: str) -> list[tuple[str, Any, str]]:
    """The exact value if it can be shown, and the rounded one if that says more."""
    exactly = exact_text(value)
    texts = [("=", exactly)] if exactly is not None else []
    if not short_decimal(value):
        texts.append(("≈", rounded_text(value)))
    shown = unit_shown(unit)
    return [(sign, typeset.quantity(text, shown), with_unit(text, unit)) for sign, text in texts]


__all__ = ["Line", "Maths", "Mistake", "PartSolution", "Solution", "solve"]
