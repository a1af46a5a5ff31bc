"""Kind ``witness``: any example or counterexample; it is tested, never compared."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

import msgspec

from quizgen.core.errors import FormulaError
from quizgen.grading.diagnosis.carry_forward import to_constant
from quizgen.grading.judge import show_spec
from quizgen.grading.judging.sampled_equality import BITS, Domain, compile_exact
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.equalities import most_precise_side, read_sides
from quizgen.grading.reading.formulas import parse_authored
from quizgen.grading.reading.labels import NAME, find_name, name_key, split_name
from quizgen.grading.reading.lists import (
    NAMED_NEXT,
    bracket_depth,
    normalise_separators,
    read_list,
    split_prefix,
    strip_brackets,
)
from quizgen.grading.reading.normalise import normalise_typed
from quizgen.grading.reading.numbers import (
    ReadNumber,
    as_percent,
    percent_to_fraction,
    scale_number,
)
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import listed_unit
from quizgen.grading.rounding import format_exact_or_figures
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import (
    Verdict,
    ambiguous,
    attach_values,
    correct,
    verdict_by_share,
    wrong,
)
from quizgen.kinds.asking import explain_assigned, make_spec, sentence_with_code
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredAnswer,
    FieldProblem,
    InputBox,
    InputControl,
    PartContext,
    SymbolDomain,
)
from quizgen.kinds.work import Work
from quizgen.maths.constants import Scalar, evaluate_constant, parse_exact
from quizgen.maths.notation import FormulaReadError, format_tree, parse_formula, pretty
from quizgen.maths.notation.names import FUNCTIONS
from quizgen.maths.numbers import format_exact, format_for_key
from quizgen.maths.operators import CONDITIONS
from quizgen.maths.precision import working_precision
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tree import Call, Expr, Num, names_in, substitute
from quizgen.maths.units import format_unit

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines


class Demand(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A relation that a design has to satisfy, and what it weighs among the others."""

    holds: str
    worth: int = 1


class AuthoredWitness(AuthoredAnswer, kw_only=True, tag="witness", frozen=True):
    """Any values that meet a condition, or as many of several demands as they can."""

    symbols: dict[str, SymbolDomain] | tuple[str, ...]
    predicate: str = ""
    demands: dict[str, Demand] = msgspec.field(default_factory=dict)
    where: tuple[str, ...] = ()
    let: dict[str, str] = msgspec.field(default_factory=dict)
    units: dict[str, str] = msgspec.field(default_factory=dict)
    traps: dict[str, str] = msgspec.field(default_factory=dict)
    example: dict[str, Scalar] = msgspec.field(default_factory=dict)

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong apart from types."""
        if bool(self.predicate) == bool(self.demands):
            yield ("predicate",), "QG112", "predicate or demands, one of them"
        for name, one in self.demands.items():
            if one.worth < 1:
                yield ("demands", name, "worth"), "QG112", "a whole number above 0"
        for name in self.units:
            if name not in self.symbols:
                yield ("units", name), "QG112", "no symbol has this name"


class WitnessSpec(WordSpec, kw_only=True, frozen=True):
    """Witness: ``predicate`` or ``demands`` to satisfy; ``symbols`` to give; ``where`` = limits.

    ``symbols`` is a list of names, or a table from names to ``real``, ``positive`` or
    ``[low, high]``. Names such as ``a_1 a_2 a_3`` can be typed together: ``a = (1; 0; 0)``.
    ``let`` = names with formulas over the symbols, to be used in all of these.
    ``demands`` = relations by name, each earning its share. ``units`` = the unit of a symbol, in
    which it is taken where none is typed. A trap is a condition that a mistaken answer fulfils.
    ``example`` is one right answer to show; typed answers are never compared with it.
    """

    written_as: ClassVar[AnswerForm] = "formula"

    predicate: str = ""
    symbols: dict[str, Domain] | list[str]
    demands: dict[str, Demand] = msgspec.field(default_factory=dict)
    where: list[str] = msgspec.field(default_factory=list)
    let: dict[str, str] = msgspec.field(default_factory=dict)
    units: dict[str, str] = msgspec.field(default_factory=dict)
    traps: dict[str, str] = msgspec.field(default_factory=dict)
    example: dict[str, Scalar] = msgspec.field(default_factory=dict)

    def names(self) -> tuple[str, ...]:
        """Return the names to give, in order."""
        return tuple(self.symbols)

    def usable_names(self) -> tuple[str, ...]:
        """Return the names that conditions may use."""
        return (*self.symbols, *self.let)

    def validate(self) -> None:
        """Check that the predicate and every constraint are relations over the names.

        Raises
        ------
        FormulaError
            If one is not, or cannot be read.
        ValueError
            If a domain or the example is not complete.
        """
        for text in self.let.values():
            parse_authored(text, self.usable_names())
        if bool(self.predicate) == bool(self.demands):
            raise ValueError("predicate or demands, one of them")
        for unit in self.units.values():
            listed_unit(unit)
        demanded = [one.holds for one in self.demands.values()]
        wanted = demanded or [self.predicate]
        for text in (*wanted, *self.where, *self.traps.values()):
            tree = parse_authored(text, self.usable_names())
            if not isinstance(tree, Call) or tree.op not in CONDITIONS:
                raise FormulaError(f"{text!r} is not a relation")
        domains = self.symbols.values() if isinstance(self.symbols, dict) else ()
        if not all(
            len(domain) == len(("low", "high")) for domain in domains if isinstance(domain, list)
        ):
            raise ValueError("symbols: a range is [low, high]")
        if self.example and {*self.example} != {*self.names()}:
            raise ValueError("example must give every symbol")

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on a typed example, which is tested and never compared.

        Raises
        ------
        FormulaReadError
            If it cannot be read, or a value is missing.
        """
        numbers = _read_example(self, typed, options.decimal)
        env = {name: number.value for name, number in numbers.items()}
        read_as = "; ".join(
            f"{pretty.format_name(n)} = {number.read_as}" for n, number in numbers.items()
        )
        with working_precision(BITS):
            verdict = _judge_conditions(self, _add_let_values(self, env), read_as)
        return attach_values(verdict, *env.values())

    def show(self) -> str:
        """Return one right example if there is one, else what an example must satisfy."""
        if self.example:
            return "; ".join(f"{pretty.format_name(n)} = {v}" for n, v in self.iter_example())
        demanded = [one.holds for one in self.demands.values()] or [self.predicate]
        return "; ".join(map(pretty.format_formula, (*demanded, *self.where)))

    def iter_example(self) -> Iterator[tuple[str, str]]:
        """Yield the values of the example by name, with their units."""
        for name in self.names():
            number = pretty.format_number(str(self.example[name]))
            yield name, f"{number} {format_unit(self.units.get(name, ''))}".strip()


@lru_cache(maxsize=1024)
def _compile_formula(text: str, symbols: tuple[str, ...]) -> Any:
    """Return a formula for bounded exact evaluation, compiled once for a class."""
    return compile_exact(parse_authored(text, symbols))


def _add_let_values(spec: WitnessSpec, env: dict[str, Any]) -> dict[str, Any]:
    """Return the values with the quantities that ``let`` derives, in order."""
    full = dict(env)
    for name, text in spec.let.items():
        full[name] = _compile_formula(text, spec.usable_names())(full)
    return full


def _judge_conditions(spec: WitnessSpec, env: dict[str, Any], read_as: str) -> Verdict:
    """Return the verdict on an example: domains first, then constraints, then the predicate.

    It is ambiguous where the predicate cannot be decided; a constraint must certainly hold.
    """
    for text, shown in _iter_domain_constraints(spec):
        if _is_relation_true(spec, text, env) is not True:
            return wrong(read_as, "constraint", constraint=shown)
    for text in spec.where:
        if _is_relation_true(spec, text, env) is not True:
            return wrong(read_as, "constraint", claim=_format_failed_relation(spec, text, env))
    if spec.demands:
        return _judge_demands(spec, env, read_as)
    held = _is_relation_true(spec, spec.predicate, env)
    if held is True:
        return correct(read_as)
    if held is None:
        return ambiguous("undecided", read_as)
    return wrong(read_as, "predicate", claim=_format_failed_relation(spec, spec.predicate, env))


def _judge_demands(spec: WitnessSpec, env: dict[str, Any], read_as: str) -> Verdict:
    """Return the verdict by the demands that are met; what is missed is named with its values."""
    held = {name: _is_relation_true(spec, one.holds, env) for name, one in spec.demands.items()}
    if None in held.values():
        return ambiguous("undecided", read_as)
    missed = tuple(name for name, met in held.items() if not met)
    worth = {name: one.worth for name, one in spec.demands.items()}
    credit = Fraction(sum(worth[name] for name, met in held.items() if met), sum(worth.values()))
    trap = next((name for name, text in spec.traps.items()
                 if missed and _is_relation_true(spec, text, env)), "")  # fmt: skip
    failed = (_format_failed_relation(spec, spec.demands[name].holds, env) for name in missed)
    return verdict_by_share(
        credit,
        read_as,
        f"trap:{trap}" if trap else "demands",
        right=len(held) - len(missed),
        of=len(held),
        claim=", ".join(filter(None, failed)),
        because=missed,
    )


def _is_relation_true(spec: WitnessSpec, text: str, env: dict[str, Any]) -> bool | None:
    """Return whether a relation holds; False where it has no value, None if that is undecided."""
    result = _compile_formula(text, spec.usable_names())(env)
    if isinstance(result, type):
        return _compare_as_formulas(spec, text, env)
    return bool(result)


def _compare_as_formulas(spec: WitnessSpec, text: str, env: dict[str, Any]) -> bool | None:
    """Return whether sides that no digits tell apart are the same formula; None if undecided.

    With ``a = 0`` the sides of ``(a + b)^p = a^p + b^p`` are, for a positive p.
    """
    tree = parse_authored(text, spec.usable_names())
    if not isinstance(tree, Call) or tree.op not in {"eq", "ne", "lt", "gt", "le", "ge"}:
        return None
    numbers = {name: to_constant(value) for name, value in env.items() if name in names_in(tree)}
    left, right = (tidy_formula(_drop_zero_powers(substitute(side, numbers))) for side in tree.args)
    return tree.op in {"eq", "le", "ge"} if left == right else None


_ZERO = Num(Fraction(0))


def _drop_zero_powers(tree: Expr) -> Expr:
    """Return a formula with 0 in place of a positive power of 0."""
    if not isinstance(tree, Call):
        return tree
    args = tuple(map(_drop_zero_powers, tree.args))
    if tree.op == "pow" and args[0] == _ZERO:
        with suppress(FormulaReadError):
            if not names_in(args[1]) and evaluate_constant(args[1]) > 0:
                return _ZERO
    return Call(tree.op, args)


def _iter_domain_constraints(spec: WitnessSpec) -> Iterator[tuple[str, str]]:
    """Yield the constraints that the symbols' domains state, and how they are shown."""
    if not isinstance(spec.symbols, dict):
        return
    for name, domain in spec.symbols.items():
        if domain == "positive":
            yield f"{name} > 0", pretty.format_formula(f"{name} > 0")
        elif isinstance(domain, list):
            low, high = (format_exact_or_figures(parse_exact(bound), 12) for bound in domain)
            relation = f"{_parenthesise_negative(low)} <= {name} <= {_parenthesise_negative(high)}"
            yield relation, pretty.format_formula(f"{low} ≤ {name} ≤ {high}")


def _parenthesise_negative(text: str) -> str:
    """Return a number in brackets if it begins with a minus sign."""
    return f"({text})" if text.startswith("-") else text


_SIGNS = {"lt": "<", "le": "≤", "gt": ">", "ge": "≥", "eq": "=", "ne": "≠"}


def _format_failed_relation(spec: WitnessSpec, text: str, env: dict[str, Any]) -> str:
    """Return a failing relation with both sides' values, ``4 < 2``; empty if they say nothing.

    The relation itself is program text and may hold names that no question mentions.
    """
    tree = parse_authored(text, spec.usable_names())
    sides = tree.args if isinstance(tree, Call) and tree.op in _SIGNS else ()
    values = [_format_side_value(side, env) for side in sides]
    if len(values) != 2 or None in values:
        return ""
    return f"{values[0]} {_SIGNS[tree.op]} {values[1]}"  # type: ignore[union-attr]


def _format_side_value(side: Expr, env: dict[str, Any]) -> str | None:
    """Return the value of one side with six figures; None if it has none that can be shown."""
    value = compile_exact(side)(env)
    if value is None or isinstance(value, (type, bool)):
        return None
    return pretty.format_number(format_exact_or_figures(value, 6))


_FRONT = re.compile(rf"({NAME}) ?(?=[(\[])")
_CALLED = re.compile(r"([^\W\d_]{2,}(?= ?\d)|[^\W\d_](?= \d)) ?")
"""A name right before its value, ``ISO 4000``, ``f 28 mm``."""
_FRACTION = re.compile(r"\d+/\d+")
_ENGRAVED = re.compile(r"[fF] ?/ ?(?=[\d.])")
_SEPARATOR = re.compile(rf"[;|\n]|,(?= )|(?<=\)),?|{NAMED_NEXT.pattern}")


def _read_example(spec: WitnessSpec, typed: str, decimal: str) -> dict[str, ReadNumber]:
    """Return the typed number of every name: given by name, in groups, or all in order.

    Raises
    ------
    FormulaReadError
        If one cannot be read, is missing, or not asked for.
    """
    lines = filter(None, map(str.strip, typed.split("\n")))
    source = normalise_separators(normalise_typed("; ".join(lines), longest=400))
    names, placed = list(spec.names()), dict[str, ReadNumber]()
    items = list(_iter_labelled_items(source, names, decimal))
    if len(items) == 1 and not items[0][0]:
        items = [("", piece) for piece in _split_unlabelled_row(items[0][1], len(names))]
    items = _label_by_looks(spec, items)
    for label, item in items:
        targets = _assign_names(label, item, [n for n in names if n not in placed], names)
        for name, piece in targets:
            placed[name] = _read_piece(piece, decimal, spec.units.get(name, ""))
    if len(placed) < len(names):
        missing = [name for name in names if name not in placed]
        raise FormulaReadError("values-missing", 1, "", missing)
    return {name: placed[name] for name in names}


def _label_by_looks(
    spec: WitnessSpec, items: list[tuple[str, SourceText]]
) -> list[tuple[str, SourceText]]:
    """Return the items in any order with their names, if all show what they are.

    They do as a camera shows them: ``f/1.8``, ``1/1600 s``, ``ISO 4000``.
    """
    if all(label for label, _ in items) or len(items) != len(spec.names()):
        return items
    labels = [label or _find_look(spec, item.text) for label, item in items]
    left = [name for name in spec.names() if name not in labels]
    if labels.count("") == len(left) == 1:
        labels[labels.index("")] = left[0]
    return list(zip(labels, (item for _, item in items), strict=True)) if all(labels) else items


def _find_look(spec: WitnessSpec, item: str) -> str:
    """Return the one name whose value looks like this: as engraved, or with its unit."""
    if _ENGRAVED.match(item):
        return "N" if "N" in spec.names() else ""
    unit = re.search(r"[^\W\d_]+$", item)
    try:
        given = listed_unit(unit[0]) if unit else None
    except FormulaError:
        return ""
    fits = [
        name
        for name in spec.names()
        if given and listed_unit(spec.units.get(name, "1")).dimension == given.dimension
    ]
    return fits[0] if len(fits) == 1 else ""


def _split_unlabelled_row(item: SourceText, count: int) -> list[SourceText]:
    """Return values in a row without separators of their own, ``0.2 0.3``, one by one."""
    for separator in (re.compile(r" +"), re.compile(r",")):
        parts = _split_outside_brackets(item, separator)
        if len(parts) == count and bracket_depth(item.text, len(item.text)) == 0:
            return parts
    return [item]


def _read_piece(piece: SourceText, decimal: str, wanted: str) -> ReadNumber:
    """Return one number in the unit that is wanted; a percentage becomes the share that it is.

    Raises
    ------
    FormulaReadError
        If it cannot be read, has two readings, or a unit of another kind.
    """
    side = most_precise_side(read_sides(_without_f(piece), decimal))
    readings, unit = side.readings, side.quantity.unit
    if readings.other is not None and readings.doubt is not None and not readings.doubt.native:
        raise FormulaReadError("two-readings", piece.column(0), piece.text)
    if wanted:
        asked = listed_unit(wanted)
        given = unit or asked
        if given.dimension != asked.dimension:
            raise FormulaReadError("unit-other", piece.column(0), given.text, [asked.text])
        number = scale_number(readings.main, given.factor / asked.factor)
        return msgspec.structs.replace(
            number, read_as=f"{number.read_as} {format_unit(given.text)}"
        )
    percent = readings.main.percent or (unit is not None and unit.text == "%")
    return percent_to_fraction(as_percent(readings.main)) if percent else readings.main


def _without_f(piece: SourceText) -> SourceText:
    """Return the number of an aperture that is written as it is engraved, ``f/8``."""
    match = _ENGRAVED.match(piece.text)
    return piece.slice(match.end()) if match else piece


def _iter_labelled_items(
    source: SourceText, names: list[str], decimal: str
) -> Iterator[tuple[str, SourceText]]:
    """Yield the label of each item, empty if it has none, and the item.

    Raises
    ------
    FormulaReadError
        If names stand before a bracket and there are not as many values in it.
    """
    fronts, rest = split_prefix(source)
    if fronts:
        items, _ = read_list(rest.text, len(fronts), decimal)
        yield from zip((front.text for front in fronts), items, strict=True)
        return
    inner, _ = strip_brackets(source)
    source = inner if inner.text[:1] == "(" else source
    for piece in _split_outside_brackets(source, _SEPARATOR):
        label, rest = split_name(piece)
        label, rest = (label, rest) if label else _split_point_label(piece, names)
        if label or rest.text:
            yield label, rest


def _split_point_label(piece: SourceText, names: list[str]) -> tuple[str, SourceText]:
    """Return the name and the rest of ``A(0.5|0)``; a word that names nothing is dropped."""
    match = _FRONT.match(piece.text)
    plain = _CALLED.match(piece.text)
    if plain and find_name(plain[1], names):
        return plain[1], piece.slice(plain.end())
    if match is None or match[1] in FUNCTIONS:
        return "", piece
    typed, keys = name_key(match[1]), [name_key(name) for name in names]
    known = {key[: len(typed)] for key in keys if key.lower().startswith(typed.lower())}
    label = typed if typed in known else known.pop() if len(known) == 1 else ""
    return label, piece.slice(match.end())


def _split_outside_brackets(source: SourceText, separator: re.Pattern[str]) -> list[SourceText]:
    """Return the pieces between separators outside brackets that are not empty."""
    start, pieces = 0, []
    for match in separator.finditer(source.text):
        if bracket_depth(source.text, match.start()) == 0:
            pieces.append(source.slice(start, match.start()).strip())
            start = match.end()
    pieces.append(source.slice(start).strip(" ,"))
    return [piece for piece in pieces if piece.text]


def _assign_names(
    label: str, item: SourceText, free: list[str], names: list[str]
) -> list[tuple[str, SourceText]]:
    """Return which names an item gives: its own, those of a group, or the next free ones.

    Raises
    ------
    FormulaReadError
        If a label names nothing, or there are more values than names.
    """
    inner, _ = strip_brackets(item)
    parts = _split_components(inner) if inner.text != item.text else [item]
    own = find_name(label, names) if label else ""
    if label and not own:
        return _assign_group(label, item, parts, free)
    if own:
        free = [own]
    if len(parts) > len(free):
        raise FormulaReadError("item-count", item.column(0), str(len(parts)), [str(len(free))])
    return list(zip(free, parts, strict=False))


def _assign_group(
    label: str, item: SourceText, parts: list[SourceText], free: list[str]
) -> list[tuple[str, SourceText]]:
    """Return the names that begin with a label, each with its part: ``a = (1; 0)``.

    Raises
    ------
    FormulaReadError
        If no free names begin with it, or not as many as there are parts.
    """
    members = [name for name in free if name_key(name).startswith(name_key(label))]
    if not members or len(members) != len(parts):
        raise FormulaReadError("unknown-name", item.column(0), label, free)
    return list(zip(members, parts, strict=True))


def _split_components(inner: SourceText) -> list[SourceText]:
    """Return the components in a bracket, cut at the strongest separator that occurs."""
    for separator in (re.compile(r"[;|]"), re.compile(r","), re.compile(r" +")):
        if separator.search(inner.text):
            return _split_outside_brackets(inner, separator)
    return [inner]


def ask(part: PartContext) -> AskedPart[WitnessSpec]:
    """Return conditions and an example with the drawn values in place.

    Raises
    ------
    BankError
        If a drawn quantity is called as a name of the answer.
    """
    answer = part.answer
    known = {n: Num(Fraction(format_for_key(v)), decimal=v.q != 1) for n, v in part.shown.items()}
    let, example = answer.get("let", {}), answer.get("example", {})
    demands, traps = answer.get("demands", {}), answer.get("traps", {})
    symbols = (*answer["symbols"], *let, *known)
    for name in (*answer["symbols"], *let):
        if name in known:
            raise part.error(f"{name!r} is drawn, and a name of the answer as well", "QG125")

    def format_condition(text: object) -> str:
        """Return a condition as text with the drawn values in place of their names."""
        return format_tree(substitute(parse_formula(str(text), symbols=symbols), known))

    spec = make_spec(
        WitnessSpec,
        part,
        example={name: _format_short_number(part, formula) for name, formula in example.items()},
        let={name: format_condition(text) for name, text in let.items()},
        predicate=format_condition(answer["predicate"]) if "predicate" in answer else "",
        demands={
            name: {**one, "holds": format_condition(one["holds"])} for name, one in demands.items()
        },
        traps={name: format_condition(text) for name, text in traps.items()},
        notes=part.misconception_notes(traps) if traps else {},
        why=part.reasons([(name, name) for name in demands]) if demands else {},
        where=[format_condition(text) for text in answer.get("where", ())],
    )
    boxes = tuple(InputBox(name, spec.units.get(name, "")) for name in spec.symbols)
    return AskedPart(spec, InputControl("lines", lines=2, boxes=boxes, named=True))


def _format_short_number(part: PartContext, formula: str | int) -> str:
    """Return a decimal where it is short, else the exact fraction; one that is written stays."""
    if _FRACTION.fullmatch(str(formula)):
        return str(formula)
    value = part.evaluate(str(formula))
    return format_exact(value, minus="-") or format_for_key(value)


def input_hints(spec: WitnessSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return the sentence on which names to give, as they are typed."""
    names = "; ".join(
        f"{name} = ... {format_unit(spec.units.get(name, ''))}".strip() for name in spec.symbols
    )
    return (sentence_with_code(lang, "ask.witness", names=names),)


def explain_key(spec: WitnessSpec, lang: str) -> TextOrInlines:
    """Return one right example, else what an example must satisfy."""
    if not spec.example:
        return show_spec(spec, lang)
    return explain_assigned(spec.iter_example())


def count_demands(answer: Mapping[str, Any], _points: Fraction, _words: int) -> Work:
    """Return the demands to be met, and the values that meet them."""
    return {"demand met": len(answer.get("demands", ())) or 1, "cell": len(answer["symbols"])}


KIND = AnswerKind(
    AuthoredWitness, WitnessSpec, ask, input_hints, explain_key, verb="design", work=count_demands
)
