"""What kinds share when they ask: from the numbers of a variant to a spec, and how to type them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, TypeAlias, TypeVar

import msgspec
from flint import fmpq

from quizgen.core.complaints import complaint_of
from quizgen.core.decoding import convert
from quizgen.core.errors import FormulaError
from quizgen.grading.judge import show_spec
from quizgen.grading.spec import AnySpec, NumericSpec, ScalarSpec, VectorSpec
from quizgen.kinds.contract import (
    AskedPart,
    LabelledName,
    PartContext,
    S,
    asked_form,
    asked_quantities,
)
from quizgen.locale import localise_numbers, translate
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.notation import pretty
from quizgen.maths.numbers import (
    format_for_key,
    is_short_decimal,
    to_float,
)
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.units import format_unit
from quizgen.maths.values import Value

# Grading loads every kind, and never sets a sentence: what typesets is imported where it is used.
if TYPE_CHECKING:
    from quizgen.typeset.prose import Inline, TextOrInlines

LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
ROUNDED_MISTAKE = 4
"""Significant figures of a mistake's answer that has no short exact form."""

KeyNumbers: TypeAlias = Scalar | list[Scalar] | dict[str, Scalar]
"""The numbers of a key or of a mistake: one, several in order, or several by name."""
T = TypeVar("T", bound="TextOrInlines")


def make_spec(shape: type[S], part: PartContext, **given: object) -> S:
    """Return the spec of a part: the authored keys, and what the variant gives.

    Raises
    ------
    BankError
        If the answer has a key that the kind does not define, or one of the wrong type.
    """
    answer = part.answer
    fields = {*shape.__struct_encode_fields__} - {"of"}
    table = {name: value for name, value in answer.items() if name in fields}
    if form := asked_form(answer):
        given = {"of": [form], **given}
    if "accept" in answer:
        table["accept"] = [format_for_key(part.evaluate(str(bound))) for bound in answer["accept"]]
    try:
        spec = convert({**table, **given}, shape)
        with spec.known_units().activate():
            spec.validate()
    except (msgspec.ValidationError, FormulaError, ValueError) as error:
        raise part.error(complaint_of(error, shape).message) from error
    return spec


def ask_numeric(
    shape: type[S],
    part: PartContext,
    write: Callable[[tuple[Value, ...]], KeyNumbers] | None = None,
    **given: object,
) -> AskedPart[S]:
    """Return a part whose key and mistakes are numbers of the chain.

    Parameters
    ----------
    shape : type
        The kind's ``Spec``.
    part : PartContext
    write : callable, optional
        From the components of an answer to what the key holds; by default the one number of a
        ``value``, a list of ``values``.
    **given
        Further fields of the spec.

    Raises
    ------
    BankError
        If the authored answer is not complete.
    """
    key = "value" if "value" in shape.__struct_fields__ else "values"
    write = write or (_format_single_value if key == "value" else _format_values)
    wrong = {trap: write(values) for trap, values in part.misconception_answers().items()}
    found = {"of": list(asked_quantities(part.answer)), key: write(part.answer_values())}
    if key == "value" and part.answer.get("exact") and part.exact_texts()[0]:
        found["value"] = part.exact_texts()[0]
    found |= {"define": list(part.defined_units)} if part.defined_units else {}
    found |= part.count_nouns() if "counts" in shape.__struct_fields__ else {}
    found |= {"bound": bound} if key == "value" and (bound := part.asked_bound()) else {}
    traps = {"traps": wrong, "notes": part.misconception_notes(wrong)} if wrong else {}
    spec = make_spec(shape, part, **{**found, **traps, **given})
    return AskedPart(spec, mistakes=misconception_specs(spec, key))


def _format_single_value(values: tuple[Value, ...]) -> str:
    """Return the one component of an answer as a key holds it."""
    (value,) = values
    return format_for_key(value)


def _format_values(values: tuple[Value, ...]) -> list[Scalar]:
    """Return the components of an answer as a key holds them."""
    return [format_for_key(value) for value in values]


def append_source(said: Mapping[str, Mapping[str, str]], source: str) -> dict[str, dict[str, str]]:
    """Return the reasons by language and mark, each with its source behind it if there is one."""
    tail = f" [{source}]" if source else ""
    return {
        lang: {mark: f"{sentence}{tail}" for mark, sentence in reasons.items()}
        for lang, reasons in said.items()
    }


def misconception_specs(spec: S, key: str) -> dict[str, S]:
    """Return each mistake of a spec with the spec of which its answer would be the key.

    ``key`` is the field that holds the key.
    """
    return {
        trap: msgspec.structs.replace(spec, traps={}, notes={}, **{key: wrong})
        for trap, wrong in spec.traps.items()
    }


def assign_letters(names: Iterable[str]) -> tuple[LabelledName, ...]:
    """Return the names under A, B, C, ..."""
    return tuple(zip(LETTERS, names, strict=False))


def show_exact_first(spec: ScalarSpec | VectorSpec, lang: str) -> str:
    """Return the key with its exact value before the rounded one, where that differs."""
    rounded = show_spec(spec, lang)
    if spec.decimals is not None or not _help_as_fractions(spec):
        return rounded
    exactly = show_spec(
        msgspec.structs.replace(
            spec, exact=True, abs=None, rel=None, sigfigs=None, within=1, accept=None
        ),
        lang,
    )
    return f"{exactly} ≈ {rounded}" if exactly != rounded and _FRACTION.search(exactly) else rounded


_SHORT = re.compile(r"-?\d{1,3}(/[2-9])?")
_FRACTION = re.compile(r"\d/\d")


def _help_as_fractions(spec: ScalarSpec | VectorSpec) -> bool:
    """Return whether fractions say more than a number of three figures: 200/3, not 353/23.

    A value that is read off a plot or estimated is no fraction at all.
    """
    key = _get_key_numbers(spec)
    rule, number = spec.stated_rule or spec.unstated
    if rule == "rel" and parse_exact(str(number)) > ESTIMATED:
        return False
    return are_readable_fractions(key) and all(map(_SHORT.fullmatch, number_texts(key)))


ESTIMATED = fmpq(1, 100)
"""Share beyond which a number is an estimate."""


def are_readable_fractions(key: KeyNumbers) -> bool:
    """Return whether numbers are whole and short fractions, some fraction among them."""
    texts = number_texts(key)
    return all(re.fullmatch(r"-?\d{1,6}(/\d{1,3})?", t) for t in texts) and any(
        "/" in t for t in texts
    )


def as_student_writes(wrong: AnySpec, answer: KeyNumbers) -> AnySpec:
    """Return a wrong answer's spec in the form of the key, rounded where that is exact.

    Parameters
    ----------
    wrong : AnySpec
        Has the wrong answer as its key.
    answer : number, list or mapping
        The wrong answer.
    """
    if not isinstance(wrong, NumericSpec):
        return wrong
    freed: dict[str, object] = {"accept": None}
    if "form" in wrong.__struct_fields__:
        freed["form"] = ""
    if wrong.exact and not all(map(_is_short_text, number_texts(answer))):
        freed |= {"exact": False, "sigfigs": ROUNDED_MISTAKE}
    return msgspec.structs.replace(wrong, **freed)


def _is_short_text(text: str) -> bool:
    """Return whether a number, as text, is a decimal with few digits."""
    value = parse_exact(text)
    return is_short_decimal(value)


def number_texts(key: KeyNumbers) -> list[str]:
    """Return the numbers of a key as a list of texts."""
    if isinstance(key, dict):
        return [str(value) for value in key.values()]
    return [str(value) for value in key] if isinstance(key, list) else [str(key)]


def _get_key_numbers(spec: ScalarSpec | VectorSpec) -> KeyNumbers:
    """Return the number or numbers that a spec has as its key."""
    return spec.value if isinstance(spec, ScalarSpec) else spec.values


def numeric_hints(spec: ScalarSpec | VectorSpec, lang: str, *sentences: str) -> tuple[str, ...]:
    """Return the sentences that are not empty, and how exactly the numbers must be given."""
    return nonempty(*sentences, rounding_hint(spec, _get_key_numbers(spec), lang))


def precision_on_paper(spec: Tolerance, lang: str) -> tuple[str, ...]:
    """Return how exactly the numbers must be given, where the cover does not say it already."""
    return nonempty(rule_on_paper(spec, lang))


def rule_on_paper(spec: Tolerance, lang: str) -> str:
    """Return in few words how exactly an answer must be given; empty if three figures do."""
    rule, number = spec.stated_rule or ("", "")
    if rule == "decimals":
        name = f"on_paper.decimals_{number}" if number in {0, 1} else "on_paper.decimals"
        return translate(lang, name, n=number)
    if rule == "sigfigs" and number != USUAL_FIGURES:
        return translate(lang, "on_paper.sigfigs", n=number)
    if rule == "exact":
        return translate(lang, "on_paper.exact")
    if rule == "rel" and parse_exact(str(number)) < USUAL_SHARE:
        percent = pretty.format_number(f"{to_float(parse_exact(str(number)) * 100):g}")
        return f"±\u00a0{percent} %"
    return f"±\u00a0{pretty.format_number(str(number))}" if rule == "abs" else ""


def accept_within_tolerance(spec: NumericSpec, lang: str) -> str:
    """Return what a marker accepts of a number: from where to where, or how near."""
    if spec.strict or _has(spec, "form"):
        return ""
    if spec.exact:
        key = getattr(spec, "value", None) or getattr(spec, "values")  # noqa: B009
        is_whole = not any("/" in text for text in number_texts(key))
        return "" if is_whole else translate(lang, "scheme.exact")
    found = _accepted_range(spec) if isinstance(spec, ScalarSpec) else None
    if found is not None:
        low, high = (pretty.format_number(text) for text in found)
        unit = f" {format_unit(spec.printed_unit)}" if spec.printed_unit else ""
        return localise_numbers(lang, translate(lang, "scheme.range", low=low, high=high)) + unit
    rule, number = spec.stated_rule or spec.unstated
    if rule == "rel":
        percent = pretty.format_number(f"{to_float(parse_exact(str(number)) * 100):g}")
        return localise_numbers(lang, translate(lang, "scheme.within", percent=percent))
    if rule == "abs":
        return localise_numbers(lang, f"±\u00a0{pretty.format_number(str(number))}")
    return translate(lang, "scheme.last_place")


def _has(spec: NumericSpec, name: str) -> bool:
    """Return whether a spec has a field of this name that is set: not every kind knows all."""
    return bool(getattr(spec, name, False))


def _accepted_range(spec: ScalarSpec) -> tuple[str, str] | None:
    """Return the least and the greatest number that is accepted, rounded inwards; None if large."""
    key = parse_exact(spec.value) * (100 if _has(spec, "percent") else 1)
    width, near = to_float(spec.half_width(key)), to_float(key)
    if not 0 < width < LARGEST_IN_RANGE or not LEAST_IN_RANGE < abs(near) < LARGEST_IN_RANGE:
        return None
    bounds = [near - width, near + width]
    if spec.accept:
        bounds += [to_float(parse_exact(bound)) for bound in spec.accept]
    first = math.floor(math.log10(width))
    places = max(0, (width < FINE * 10.0**first) - first)
    unit = 10.0**-places
    low = math.ceil(min(bounds) / unit - SLIP) * unit
    high = math.floor(max(bounds) / unit + SLIP) * unit
    return f"{low:.{places}f}", f"{high:.{places}f}"


LEAST_IN_RANGE, LARGEST_IN_RANGE = 1e-3, 1e6
"""Sizes of numbers that are written without a power of ten."""
FINE = 4
"""First digit of a width below which one more place is written: rounding takes little of it."""
SLIP = 1e-9
"""How far a bound may be from the last place by its arithmetic alone."""
USUAL_FIGURES, USUAL_SHARE = 3, fmpq(1, 200)
"""What the cover asks for, and how far a number of so many figures may be from its value."""


def say_on_paper(*keys: str) -> Callable[[AnySpec, str], tuple[TextOrInlines, ...]]:
    """Return the function ``paper_hints`` of a kind with the same sentences for every key."""

    def paper_hints(_spec: AnySpec, lang: str) -> tuple[TextOrInlines, ...]:
        """Return the sentences in a language."""
        return tuple(translate(lang, key) for key in keys)

    return paper_hints


def hint(key: str, **program: str) -> Callable[[AnySpec, str], tuple[TextOrInlines, ...]]:
    """Return the function ``input_hints`` of a kind with one sentence, whatever its key.

    Parameters
    ----------
    key : str
        Of the sentence in the locales, such as ``ask.code``.
    **program
        Program text for its blanks.
    """

    def input_hints(_spec: AnySpec, lang: str) -> tuple[TextOrInlines, ...]:
        """Return the one sentence in a language."""
        return (sentence_with_code(lang, key, **program) if program else translate(lang, key),)

    return input_hints


def sentence_with_code(lang: str, key: str, **program: str) -> tuple[Inline, ...]:
    """Return a sentence of the locales with program text in its blanks."""
    from quizgen.typeset.prose import InlineCode, translate_inlines

    return translate_inlines(
        lang, key, **{name: (InlineCode(text),) for name, text in program.items()}
    )


def explain_as_code(spec: AnySpec, lang: str) -> TextOrInlines:
    """Return the key as it is typed, as program text."""
    from quizgen.typeset.prose import InlineCode

    return (InlineCode(show_spec(spec, lang)),)


def explain_assigned(values: Iterable[tuple[str, str]]) -> TextOrInlines:
    """Return names with their values: ``n₁ = 128; n₂ = 3``."""
    from quizgen.typeset.prose import assignment_inlines

    return assignment_inlines(values)


def nonempty(*sentences: T) -> tuple[T, ...]:
    """Return the sentences that are not empty."""
    return tuple(sentence for sentence in sentences if sentence)


def unit_hint(text: str, lang: str) -> str:
    """Return the sentence on the unit that an answer is meant in; empty if it has none."""
    return translate(lang, "ask.unit", unit=format_unit(text)) if text else ""


def rounding_hint(spec: Tolerance, key: KeyNumbers, lang: str) -> str:
    """Return how exactly an answer must be given; empty if the author stated nothing."""
    rule, number = spec.stated_rule or ("", "")
    if rule == "decimals":
        name = f"ask.decimals_{number}" if number in {0, 1} else "ask.decimals"
        return translate(lang, name, n=number)
    if rule == "sigfigs":
        return translate(lang, "ask.sigfigs", n=number)
    if rule == "exact":
        return translate(lang, "ask.whole" if _is_whole(spec, key) else "ask.exact")
    if rule == "rel":
        percent = pretty.format_number(f"{to_float(parse_exact(str(number)) * 100):g}")
        return translate(lang, "ask.rel", percent=percent)
    return (
        translate(lang, "ask.abs", abs=pretty.format_number(str(number))) if rule == "abs" else ""
    )


def _is_whole(spec: Tolerance, key: KeyNumbers) -> bool:
    """Return whether things are counted, or key and mistakes all are whole, without fractions."""
    if not isinstance(spec, NumericSpec) or _has(spec, "counts"):
        return True
    answers = [key, *spec.traps.values()]
    return not any("/" in text for answer in answers for text in number_texts(answer))
