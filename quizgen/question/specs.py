"""From an authored ``answer`` and a draw to a spec: what the kinds of one shape share."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeAlias, TypeVar

import msgspec

from quizgen.bank.complaints import complaint_of
from quizgen.bank.misconceptions import answer_names
from quizgen.bank.sampler import shuffle
from quizgen.bank.variant import Variant
from quizgen.core.decoding import convert
from quizgen.core.errors import BankError, FormulaError
from quizgen.grading.mark import show_key
from quizgen.grading.spec import AnySpec, NumericSpec
from quizgen.locale import localise_numbers
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import format_for_key, is_short_decimal, to_rational
from quizgen.maths.values import Value
from quizgen.question.contract import Built, Named, S
from quizgen.question.interpolation import Interpolator, inlines_as_typed, inlines_to_text

LETTERS = "ABCDEFGHIJKL"
ROUNDED_MISTAKE = 4
"""Significant figures of a mistake's answer that has no short exact form."""

Numbers: TypeAlias = Scalar | list[Scalar] | dict[str, Scalar]
"""The numbers of a key or of a mistake: one, several in order, or several by name."""
T = TypeVar("T", bound=NumericSpec)


def authored_answer(drawn: Variant, index: int) -> Mapping[str, Any]:
    """The ``answer`` table of a part as authored."""
    return drawn.template.rules.part[index].answer


def part_error(drawn: Variant, index: int, what: str, rule: str = "QG112") -> BankError:
    """An error that names the template and the part."""
    said, place = f"part {index + 1}: {what}", ("part", index, "answer")
    return BankError(said, rule=rule, file=drawn.template.file, place=place)


def specification(shape: type[S], drawn: Variant, index: int, **given: object) -> S:
    """The spec of a part: the authored keys handed on, and what the draw gives.

    Raises
    ------
    BankError
        If the answer has a key that the kind does not know, or one of the wrong type.
    """
    answer = authored_answer(drawn, index)
    fields = {field.encode_name for field in msgspec.structs.fields(shape)} - {"of"}
    table = {name: value for name, value in answer.items() if name in fields}
    if "accept" in answer:
        table["accept"] = [format_for_key(drawn.evaluate(str(bound))) for bound in answer["accept"]]
    try:
        spec = convert({**table, **given}, shape)
        with spec.known_units().activate():
            spec.validate()
    except (msgspec.ValidationError, FormulaError, ValueError) as error:
        raise part_error(drawn, index, complaint_of(error, shape).message) from error
    return spec


def numeric(
    shape: type[S],
    drawn: Variant,
    index: int,
    key: str,
    write: Callable[[tuple[Value, ...]], Numbers],
    **given: object,
) -> Built[S]:
    """A part whose key and mistakes are numbers of the chain.

    Parameters
    ----------
    shape : type
        The kind's ``Spec``.
    drawn : Draw
    index : int
    key : str
        Field of the spec that holds the key.
    write : callable
        From the components of an answer to what stands in that field.
    **given
        Further fields of the spec.
    """
    wrong = {trap: write(values) for trap, values in drawn.misconception_answers(index).items()}
    found = {
        "of": list(answer_names(authored_answer(drawn, index))),
        key: write(drawn.answer_of_part(index)),
    }
    defined = drawn.template.about.units
    found |= {"define": list(defined)} if defined else {}
    found |= count_nouns(drawn, index) if "counts" in shape.__struct_fields__ else {}
    traps = {"traps": wrong, "notes": misconception_notes(drawn, wrong)} if wrong else {}
    spec = specification(shape, drawn, index, **{**found, **traps, **given})
    return Built(spec, mistakes=mistaken(spec, key))


def count_nouns(drawn: Variant, index: int) -> dict[str, Any]:
    """The words for what a part counts: those it names, else the unit that its values have."""
    answer = authored_answer(drawn, index)
    stated = answer.get("counts")
    if isinstance(stated, Mapping):
        return {
            "counts": {
                name: _list_count_nouns(drawn, index, things) for name, things in stated.items()
            }
        }
    units = {drawn.template.units.get(name, "") for name in answer_names(answer)} - {"", "1"}
    if stated is None and (answer["kind"] == "table" or "unit" in answer or len(units) != 1):
        return {}
    return {"counts": _list_count_nouns(drawn, index, stated or [*units])}


def _list_count_nouns(drawn: Variant, index: int, things: str | list[str]) -> list[str]:
    """Listed units as they are, and the bank's words for whatever else is counted."""
    about, found = drawn.template.about, list[str]()
    for thing in [things] if isinstance(things, str) else things:
        if thing not in about.system.simple and thing not in about.counted:
            raise part_error(drawn, index, f"counts: {thing!r} is neither a unit nor in bank.toml")
        found += about.counted.get(thing, (thing,))
    return found


def misconception_notes(drawn: Variant, traps: Iterable[str]) -> dict[str, dict[str, str]]:
    """What to tell whoever fell into a trap, as plain text in every language."""
    fillers = {lang: Interpolator(drawn, lang) for lang in drawn.template.texts}
    return {
        lang: {
            trap: localise_numbers(lang, inlines_to_text(filler.sentence("traps", trap)))
            for trap in traps
        }
        for lang, filler in fillers.items()
    }


def with_reason(drawn: Variant, names: Iterable[Named]) -> tuple[Named, ...]:
    """Those of the marks and names for which a reason is written."""
    texts = drawn.template.texts.values()
    return tuple(
        (mark, name)
        for mark, name in names
        if any(text.sentence("reasons", name) is not None for text in texts)
    )


def reasons(drawn: Variant, names: Iterable[Named]) -> dict[str, dict[str, str]]:
    """The reasons as plain text in every language, by mark.

    Raises
    ------
    BankError
        If a reason is written in one language only.
    """
    found = with_reason(drawn, names)
    fillers = {lang: Interpolator(drawn, lang) for lang in drawn.template.texts} if found else {}
    return {
        lang: {
            mark: localise_numbers(lang, inlines_to_text(filler.sentence("reasons", name)))
            for mark, name in found
        }
        for lang, filler in fillers.items()
    }


def cited(said: Mapping[str, Mapping[str, str]], source: str) -> dict[str, dict[str, str]]:
    """Reasons with their source behind them, if one is known."""
    behind = f" [{source}]" if source else ""
    return {
        lang: {mark: f"{sentence}{behind}" for mark, sentence in reasons.items()}
        for lang, reasons in said.items()
    }


def mistaken(spec: S, key: str) -> dict[str, S]:
    """Each mistake of a spec with the spec of which its answer would be the key."""
    return {
        trap: msgspec.structs.replace(spec, traps={}, notes={}, **{key: wrong})
        for trap, wrong in spec.traps.items()
    }


def order_seed(drawn: Variant, index: int) -> str:
    """What the order of a part's options is drawn from."""
    template = drawn.template
    return f"{template.origin}/{template.rules.version}/{drawn.seed}/{drawn.slot}/order/{index}"


def shuffle_names(drawn: Variant, index: int, names: Iterable[str], side: str = "") -> list[str]:
    """Names in the order in which they are shown: a drawn one, unless the listed one is asked."""
    if authored_answer(drawn, index).get("in_order"):
        return list(names)
    return shuffle(order_seed(drawn, index) + side, list(names))


def lettered(names: Iterable[str]) -> tuple[Named, ...]:
    """Names under A, B, C, ..."""
    return tuple(zip(LETTERS, names, strict=False))


def accepted_words(drawn: Variant, name: str) -> list[str]:
    """Words of a gap or of a key point, from all languages.

    Raises
    ------
    BankError
        If a language has none.
    """
    found: list[str] = []
    for lang in drawn.template.texts:
        words = inlines_as_typed(Interpolator(drawn, lang).raw_sentence("gaps", name))
        found += [word.strip() for word in words.split("|")]
    return list(dict.fromkeys(found))


def exact_first(spec: T, key: Numbers, lang: str) -> str:
    """The key with its exact value before the rounded one, where that says more."""
    rounded = show_key(spec, lang)
    if spec.decimals is not None or not readable_fractions(key):
        return rounded
    exactly = show_key(
        msgspec.structs.replace(
            spec, exact=True, abs=None, rel=None, sigfigs=None, within=1, accept=None
        ),
        lang,
    )
    return f"{exactly} ≈ {rounded}" if exactly != rounded and "/" in exactly else rounded


def readable_fractions(key: Numbers) -> bool:
    """Whether numbers are whole and short fractions, some fraction among them."""
    texts = texts_of(key)
    return all(re.fullmatch(r"-?\d{1,6}(/\d{1,3})?", t) for t in texts) and any(
        "/" in t for t in texts
    )


def written_down(wrong: AnySpec, answer: Numbers) -> AnySpec:
    """A wrong answer as it would be given: like the key, rounded where that is exact.

    Parameters
    ----------
    wrong : Spec
        Has the wrong answer as its key.
    answer : number, list or mapping
        The wrong answer.
    """
    if not isinstance(wrong, NumericSpec):
        return wrong
    freed: dict[str, object] = {"accept": None}
    if "form" in wrong.__struct_fields__:
        freed["form"] = ""
    if wrong.exact and not all(is_short_decimal(to_rational(text)) for text in texts_of(answer)):
        freed |= {"exact": False, "sigfigs": ROUNDED_MISTAKE}
    return msgspec.structs.replace(wrong, **freed)


def texts_of(key: Numbers) -> list[str]:
    """Numbers as a list of texts."""
    if isinstance(key, dict):
        return [str(value) for value in key.values()]
    return [str(value) for value in key] if isinstance(key, list) else [str(key)]
