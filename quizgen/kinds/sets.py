"""Kind ``set``: numbers in any order; duplicates are ignored."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import ClassVar

import msgspec

from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.equalities import read_items
from quizgen.grading.reading.lists import read_list
from quizgen.grading.reading.numbers import ReadNumber
from quizgen.grading.reading.spoken_values import separate_elements
from quizgen.grading.rounding import format_key
from quizgen.grading.spec import VectorSpec, matches_target
from quizgen.grading.verdict import Verdict, correct, verdict_by_share, wrong
from quizgen.kinds.asking import (
    ask_numeric,
    make_spec,
    misconception_specs,
    numeric_hints,
    precision_on_paper,
    show_exact_first,
    unit_hint,
)
from quizgen.kinds.contract import (
    MOST_OPTIONS,
    AnswerKind,
    AskedPart,
    AuthoredNumeric,
    PartContext,
    asked_form,
)
from quizgen.kinds.forms import format_plain, require_form
from quizgen.kinds.number import is_number
from quizgen.locale import translate
from quizgen.locale.word_patterns import set_of_words
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.notation import FormulaReadError, pretty
from quizgen.maths.tolerance import RULES
from quizgen.maths.tree import Call, Expr, Sym
from quizgen.maths.values import Value


class AuthoredSet(AuthoredNumeric, tag="set", frozen=True):
    """Numbers in any order."""

    most = MOST_OPTIONS
    unit: str = ""


class SetSpec(VectorSpec, kw_only=True, frozen=True):
    """Set: ``values``; ``unit`` of all; ``letters`` that belong to it beside the numbers."""

    letters: list[str] = msgspec.field(default_factory=list)

    written_as: ClassVar[AnswerForm] = "values"

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on a typed set, in any order.

        Raises
        ------
        FormulaReadError
            If an element cannot be read, or ``{0,5}`` can be one or two.
        """
        if typed.strip() in _EMPTY | set_of_words("empty-set"):
            return _judge(self, [])
        if self.letters:
            return _judge_with_letters(self, typed, options)
        typed = separate_elements(typed)
        if not _ONE_COMMA.fullmatch(typed.strip()):
            return _judge(self, _elements(self, typed, None, options))
        return self._judge_one_comma(typed, options)

    def _judge_one_comma(self, typed: str, options: GradingOptions) -> Verdict:
        """Return the verdict on ``{0,5}``, which is one decimal or two whole numbers.

        Raises
        ------
        FormulaReadError
            If both readings are possible and are not marked alike.
        """
        two = _judge(self, _elements(self, typed, 2, options))
        one = _judge(self, _elements(self, typed, 1, options))
        own = one if options.decimal == "comma" else two
        if options.decimal == "auto" and _NOUGHT.search(typed) and (one.credit or two.credit):
            raise FormulaReadError("comma-twice", 1, typed)
        if own.credit == 1 or not (one.credit or two.credit):
            return own
        if own is one and one.credit:
            return one
        raise FormulaReadError("comma-twice", 1, typed)

    def replace_key(self, form: Expr, /) -> SetSpec:
        """Return the specification with other elements as its key, and without mistakes."""
        args = form.args if isinstance(form, Call) else ()
        letters = [arg.name for arg in args if isinstance(arg, Sym)]
        values: list[Scalar] = [format_plain(arg) for arg in args if not isinstance(arg, Sym)]
        return msgspec.structs.replace(self, values=values, letters=letters, traps={})

    def show(self) -> str:
        """Return the key as printed and as it can be typed back."""
        written = is_number if self.exact else lambda _value: True
        numbers = [
            pretty.format_number(format_key(self, key))
            if written(value)
            else pretty.format_constant(str(value))
            for value, key in zip(self.values, self.keys(), strict=True)
        ]
        return "{" + "; ".join([*numbers, *self.letters]) + "}"


_ONE_COMMA = re.compile(r"[^\W\d]?[^,;|\d]*[\[({]? *[-+−–]?\d+,\d+ *[\])}]?[^,;|\d]*")
_NOUGHT = re.compile(r"(?<!\d)[0০],")
"""How decimals begin: ``0,5`` may be one even where 0 and 5 are asked."""
_EMPTY = frozenset({"{}", "∅", "{ }", "()"})


def _elements(
    spec: SetSpec, typed: str, count: int | None, options: GradingOptions
) -> list[ReadNumber]:
    """Return the typed elements in the asked unit; ``count`` of them, or any number if None."""
    items, _ = read_list(typed, count, options.decimal)
    return read_items(items, spec.unit, None, options.decimal)[0]


def _judge_with_letters(spec: SetSpec, typed: str, options: GradingOptions) -> Verdict:
    """Judge numbers and letters together: each element counts alike."""
    items, _ = read_list(typed, None, options.decimal)
    known = {letter.casefold(): letter for letter in spec.letters}
    letters = {known[text] for text in (item.text.strip().casefold() for item in items)
               if text in known}  # fmt: skip
    rest = [item for item in items if item.text.strip().casefold() not in known]
    strangers = [item for item in rest if item.text.strip().isalpha()]
    numbers = read_items([item for item in rest if item not in strangers], spec.unit, None,
                         options.decimal)[0]  # fmt: skip
    found, extra, twice = _match_elements(spec, numbers, spec.keys())
    extra, right = extra + len(strangers), len(found) + len(letters)
    wanted = len(spec.keys()) + len(spec.letters)
    read_as = "{" + "; ".join([*(n.read_as for n in numbers), *sorted(letters)]) + "}"
    if right == wanted and not extra:
        return correct(read_as, "duplicates" if twice else "")
    credit = max(Fraction(right - extra, wanted), Fraction(0))
    note = "set-extra" if extra else "set-missing"
    return verdict_by_share(credit, read_as, note, right=right, of=wanted)


def _judge(spec: SetSpec, numbers: list[ReadNumber]) -> Verdict:
    """Return the verdict on elements: those found less those that do not belong, of all."""
    read_as = "{" + "; ".join(number.read_as for number in numbers) + "}"
    keys = spec.keys()
    found, extra, twice = _match_elements(spec, numbers, keys)
    if len(found) == len(keys) and not extra:
        return correct(read_as, "duplicates" if twice else "")
    for name, values in spec.traps.items():
        wanted = [parse_exact(value) for value in values]
        if _covers(spec, numbers, wanted):
            return wrong(read_as, f"trap:{name}")
    credit = max(Fraction(len(found) - extra, max(len(keys), 1)), Fraction(0))
    note = "set-extra" if extra else "set-missing"
    return verdict_by_share(credit, read_as, note, right=len(found), of=len(keys))


def _match_elements(
    spec: SetSpec, numbers: list[ReadNumber], keys: list[Value]
) -> tuple[set[int], int, bool]:
    """Return the indices found, how many do not belong, and whether one came twice."""
    found: set[int] = set()
    extra, twice = 0, False
    for number in numbers:
        hits = [i for i, key in enumerate(keys) if spec.accepts(number.value, key)]
        if not hits:
            extra += 1
        elif set(hits) <= found:
            twice = True
        else:
            found.add(next(i for i in hits if i not in found))
    return found, extra, twice


def _covers(spec: SetSpec, numbers: list[ReadNumber], wanted: list[Value]) -> bool:
    """Return whether the numbers are those of a mistake, in any order."""
    return len(numbers) == len(wanted) and all(
        any(matches_target(spec, n, n.value, value) for n in numbers) for value in wanted
    )


def ask(part: PartContext) -> AskedPart[SetSpec]:
    """Return the elements, and those that each mistake gives."""
    if not asked_form(part.answer):
        return ask_numeric(SetSpec, part)
    values, letters = _list_elements(part, part.answer_form())
    traps = {name: _list_elements(part, f)[0] for name, f in part.misconception_forms().items()}
    notes = part.misconception_notes(traps) if traps else {}
    given = {"values": values, "letters": letters, "traps": traps, "notes": notes}
    rule = {} if RULES_GIVEN & part.answer.keys() else {"exact": True}
    spec = make_spec(SetSpec, part, **given, **rule)
    return AskedPart(spec, mistakes=misconception_specs(spec, "values"))


def _list_elements(part: PartContext, form: Expr) -> tuple[list[str], list[str]]:
    """Return numbers and letters of a set of the solver."""
    if isinstance(form, Call) and form == Call("union", ()):
        return [], []
    args = require_form(part, form, "set").args
    letters = [arg.name for arg in args if isinstance(arg, Sym)]
    return [format_plain(arg) for arg in args if not isinstance(arg, Sym)], letters


RULES_GIVEN = frozenset(RULES)


def input_hints(spec: SetSpec, lang: str) -> tuple[str, ...]:
    """Return the sentences on shape, unit and rounding."""
    return numeric_hints(spec, lang, translate(lang, "ask.set"), unit_hint(spec.unit, lang))


def paper_hints(spec: SetSpec, lang: str) -> tuple[str, ...]:
    """Return that all values are asked, and how exactly."""
    return (translate(lang, "on_paper.set"), *precision_on_paper(spec, lang))


KIND = AnswerKind(AuthoredSet, SetSpec, ask, input_hints, show_exact_first, paper_hints)
