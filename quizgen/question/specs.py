"""How each part is marked: from the ``answer`` table and the drawn numbers to a plain table.

The result is JSON: the same table stands in ``key.json`` and is what the checker reads. One builder
per shape of answer; kinds that share a shape share a builder.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from quizgen.bank.draw import Draw, plan_of, shuffled
from quizgen.bank.prose import Code, Formula, Slot, Styled, Words
from quizgen.bank.traps import answer_names, factor
from quizgen.errors import BankError
from quizgen.maths.numbers import exact_text, key_text
from quizgen.maths.systems import compile_expr, exact
from quizgen.maths.tree import Num, substitute

Spec = dict[str, Any]
LETTERS = "ABCDEFGHIJKL"
OWN_KEYS = frozenset({"of", "options", "pairs", "steps", "before", "distractors", "gaps", "true"})
"""Keys of an authored answer that the builder replaces; all others are handed on as they are."""


def build(drawn: Draw, index: int) -> Spec:
    """Specification of one part.

    Raises
    ------
    BankError
        If the part's answer is not complete.
    """
    answer = drawn.template.rules.part[index].answer
    kind = str(answer.get("kind", ""))
    if kind not in BUILDERS:
        raise BankError(
            f"template {drawn.template.id!r}: part {index + 1}: unknown kind {kind!r} "
            f"(allowed: {', '.join(sorted(BUILDERS))})"
        )
    common = {name: value for name, value in answer.items() if name not in OWN_KEYS}
    if "accept" in common:
        common["accept"] = [key_text(_computed(drawn, bound)) for bound in common["accept"]]
    return {**common, **BUILDERS[kind](drawn, index, answer)}


def display(drawn: Draw, index: int) -> tuple[tuple[tuple[str, str], ...], ...]:
    """Marks and sentence names of the options, and of the right side of a matching."""
    answer = drawn.template.rules.part[index].answer
    kind = answer["kind"]
    if kind in {"choice", "multi"}:
        return _marked(_option_order(drawn, index)), ()
    if kind == "order":
        return _marked(_step_order(drawn, index)), ()
    if kind == "match":
        left, right = _match_sides(drawn, index)
        return _marked(left), tuple((str(i + 1), name) for i, name in enumerate(right))
    return (), ()


def _marked(names: list[str]) -> tuple[tuple[str, str], ...]:
    return tuple((LETTERS[i], name) for i, name in enumerate(names))


def value_in(drawn: Draw, name: str, unit_text: str, values: Mapping[str, Any]) -> Any:
    """A quantity of (possibly wrong) values in an answer's unit."""
    value = values[name] if name in values else drawn.shown[name]
    return value / factor(unit_text) if unit_text else value


def _unit_of(drawn: Draw, answer: Mapping[str, Any], name: str) -> str:
    asked = answer.get("unit")
    return str(asked) if asked is not None else drawn.template.units.get(name, "")


def part_values(drawn: Draw, index: int, values: Mapping[str, Any]) -> list[Any]:
    """The answer's components in the answer's unit."""
    answer = drawn.template.rules.part[index].answer
    return [
        value_in(drawn, name, _unit_of(drawn, answer, name), values)
        for name in answer_names(answer)
    ]


def trap_values(drawn: Draw, index: int) -> dict[str, list[Any]]:
    """Each usable mistake and the components it gives."""
    chain = drawn.template.chain
    return {
        trap: part_values(drawn, index, chain.trapped(trap, drawn.values))
        for trap in drawn.traps[index]
    }


def _sentences(drawn: Draw, index: int) -> dict[str, dict[str, str]]:
    """What to tell whoever fell into a trap, as plain text in every language."""
    from quizgen.question.solution import sentence

    texts = drawn.template.texts
    return {
        lang: {trap: plain(sentence(drawn, lang, "traps", trap)) for trap in drawn.traps[index]}
        for lang in texts
    }


def plain(parts: Any) -> str:
    """Text of filled inlines, with formulas spoken as they are typed."""
    if isinstance(parts, tuple):
        return "".join(plain(part) for part in parts)
    if isinstance(parts, Words | Code):
        return parts.text
    if isinstance(parts, Styled):
        return plain(parts.children)
    if isinstance(parts, Slot | Formula):
        raise BankError("a sentence was used before its blanks were filled")
    return str(parts.typed)


def _with_traps(drawn: Draw, index: int, spec: Spec, shape: Callable[[list[Any]], Any]) -> Spec:
    found = trap_values(drawn, index)
    if found:
        spec["traps"] = {trap: shape(values) for trap, values in found.items()}
        spec["notes"] = _sentences(drawn, index)
    spec["of"] = list(answer_names(drawn.template.rules.part[index].answer))
    return spec


def _number(drawn: Draw, index: int, answer: Mapping[str, Any]) -> Spec:
    (value,) = part_values(drawn, index, drawn.values)
    spec: Spec = {"value": key_text(value)}
    if answer["kind"] == "quantity":
        spec["unit"] = _unit_of(drawn, answer, answer_names(answer)[0])
    return _with_traps(drawn, index, spec, lambda values: key_text(values[0]))


def _point(drawn: Draw, index: int, _answer: Mapping[str, Any]) -> Spec:
    values = part_values(drawn, index, drawn.values)
    spec: Spec = {"values": [key_text(value) for value in values]}
    return _with_traps(drawn, index, spec, lambda wrong: [key_text(v) for v in wrong])


def _table(drawn: Draw, index: int, answer: Mapping[str, Any]) -> Spec:
    of = answer["of"]
    labels = list(of) if isinstance(of, Mapping) else list(answer_names(answer))

    def shape(values: list[Any]) -> dict[str, str]:
        return {label: key_text(v) for label, v in zip(labels, values, strict=True)}

    spec: Spec = {"values": shape(part_values(drawn, index, drawn.values))}
    names = zip(labels, answer_names(answer), strict=True)
    units = {label: _unit_of(drawn, answer, name) for label, name in names}
    if any(units.values()):
        spec["units"] = {label: unit for label, unit in units.items() if unit}
    built = _with_traps(drawn, index, spec, shape)
    built["of"] = dict(zip(labels, answer_names(answer), strict=True))
    return built


def _plain_text(drawn: Draw, name: str) -> str:
    from quizgen.question.solution import sentence

    return plain(sentence(drawn, drawn.template.languages[0], "options", name))


def _holds(drawn: Draw, condition: Any) -> bool:
    if isinstance(condition, bool):
        return condition
    return bool(_computed(drawn, condition))


def _computed(drawn: Draw, formula: Any) -> Any:
    """Value of a formula of the answer table over the quantities in shown units."""
    env = plan_of(drawn.template).shown_env(drawn.shown, drawn.values)
    return compile_expr(drawn.template.formula(str(formula)), exact())(env)


def _option_order(drawn: Draw, index: int) -> list[str]:
    options = list(drawn.template.rules.part[index].answer["options"])
    return shuffled(_stem(drawn, index), options)


def _stem(drawn: Draw, index: int) -> str:
    template = drawn.template
    return f"{template.origin}/{template.rules.version}/{drawn.seed}/{drawn.slot}/order/{index}"


def _choice(drawn: Draw, index: int, answer: Mapping[str, Any]) -> Spec:
    order = _option_order(drawn, index)
    correct = [i + 1 for i, name in enumerate(order) if _holds(drawn, answer["options"][name])]
    if answer["kind"] == "choice" and len(correct) != 1:
        raise BankError(
            f"template {drawn.template.id!r}: part {index + 1}: {len(correct)} options are right"
        )
    return {"options": [_plain_text(drawn, name) for name in order], "correct": correct}


def _true_false(drawn: Draw, _index: int, answer: Mapping[str, Any]) -> Spec:
    return {"options": ["true", "false"], "correct": [1 if _holds(drawn, answer["true"]) else 2]}


def _match_sides(drawn: Draw, index: int) -> tuple[list[str], list[str]]:
    answer = drawn.template.rules.part[index].answer
    pairs: Mapping[str, str] = answer["pairs"]
    right = sorted({*pairs.values(), *answer.get("distractors", ())})
    stem = _stem(drawn, index)
    return shuffled(f"{stem}/left", list(pairs)), shuffled(f"{stem}/right", right)


def _match(drawn: Draw, index: int, answer: Mapping[str, Any]) -> Spec:
    left, right = _match_sides(drawn, index)
    pairs = answer["pairs"]
    return {"pairs": {LETTERS[i]: str(right.index(pairs[name]) + 1) for i, name in enumerate(left)}}


def _step_order(drawn: Draw, index: int) -> list[str]:
    answer = drawn.template.rules.part[index].answer
    return shuffled(_stem(drawn, index), [*answer["steps"], *answer.get("distractors", ())])


def _order(drawn: Draw, index: int, answer: Mapping[str, Any]) -> Spec:
    marks = {name: LETTERS[i] for i, name in enumerate(_step_order(drawn, index))}
    return {
        "steps": [marks[name] for name in answer["steps"]],
        "before": [[marks[a], marks[b]] for a, b in answer.get("before", ())],
        "distractors": [marks[name] for name in answer.get("distractors", ())],
    }


def _gap(drawn: Draw, _index: int, answer: Mapping[str, Any]) -> Spec:
    return {"accept": [_synonyms(drawn, drawn.words.get(name, name)) for name in answer["gaps"]]}


def _text(drawn: Draw, _index: int, answer: Mapping[str, Any]) -> Spec:
    return {"points": {name: _synonyms(drawn, name) for name in answer["points"]}}


def _synonyms(drawn: Draw, name: str) -> list[str]:
    """Words of a gap or of a key point, from all languages."""
    synonyms: list[str] = []
    for text in drawn.template.texts.values():
        words = text.sentence("gaps", name)
        if words is None:
            raise BankError(f"template {drawn.template.id!r}: no words for gap {name!r}")
        synonyms += [w.strip() for w in plain(words).split("|")]
    return list(dict.fromkeys(synonyms))


def _code(drawn: Draw, _index: int, answer: Mapping[str, Any]) -> Spec:
    """Printed output and wrong outputs, with the drawn values in place."""
    from quizgen.question.solution import in_program, sentence

    wrong = {t: in_program(str(text), drawn) for t, text in answer.get("traps", {}).items()}
    spec: Spec = {"output": in_program(str(answer["output"]), drawn)}
    usable = {trap: text for trap, text in wrong.items() if text != spec["output"]}
    notes = {
        lang: {trap: plain(sentence(drawn, lang, "traps", trap)) for trap in usable}
        for lang in drawn.template.texts
    }
    return {**spec, "traps": usable, "notes": notes}


def _witness(drawn: Draw, _index: int, answer: Mapping[str, Any]) -> Spec:
    """Conditions with the drawn values in place."""
    from quizgen.maths.notation import parse, to_text

    known = {n: Num(Fraction(key_text(v)), decimal=v.q != 1) for n, v in drawn.shown.items()}

    def stated(text: str) -> str:
        tree = parse(text, symbols=(*answer["symbols"], *let, *known))
        return to_text(substitute(tree, known))

    let: Mapping[str, str] = answer.get("let", {})
    example: Mapping[str, Any] = answer.get("example", {})
    return {
        "example": {name: _short(_computed(drawn, value)) for name, value in example.items()},
        "let": {name: stated(text) for name, text in let.items()},
        "predicate": stated(answer["predicate"]),
        "where": [stated(text) for text in answer.get("where", ())],
    }


def _short(value: Any) -> str:
    """A decimal where it is short, else the exact fraction."""
    return exact_text(value, minus="-") or key_text(value)


def _as_written(_drawn: Draw, _index: int, _answer: Mapping[str, Any]) -> Spec:
    return {}


BUILDERS: dict[str, Callable[[Draw, int, Mapping[str, Any]], Spec]] = {
    "number": _number,
    "quantity": _number,
    "angle": _number,
    "point": _point,
    "set": _point,
    "table": _table,
    "choice": _choice,
    "multi": _choice,
    "tf": _true_false,
    "match": _match,
    "order": _order,
    "gap": _gap,
    "interval": _as_written,
    "expression": _as_written,
    "witness": _witness,
    "code": _code,
    "text": _text,
}
