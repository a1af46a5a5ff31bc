"""Count how many keys go wrong in each arithmetic: ``quizgen/tradeoff/counted.json``.

Run: ``uv run python tools/do.py counts`` after a change of number systems, marking or many
templates; ``tests/tradeoff/test_wrong_keys.py`` says when. A draw is kept, its numbers are solved
again, and its key is made and marked by the product's own code. Nothing else differs.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Iterator
from datetime import UTC, datetime
from decimal import Decimal
from pathlib import Path

import msgspec
from flint import fmpq

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.variant import Variant, draw_variant
from quizgen.grading.spec import AnySpec
from quizgen.kinds.grade import grade_answer, show_key
from quizgen.maths.numbers import round_to, to_rational
from quizgen.maths.precision import working_precision
from quizgen.maths.values import Value
from quizgen.question.part_context import ask_part
from quizgen.tradeoff.questions import Counted
from quizgen.tradeoff.solving import ARITHMETICS, FAILURES, draws_list, solve_in

COUNTED = Path(__file__).parents[1] / "quizgen" / "tradeoff" / "counted.json"
ROUND = 10_000
"""Questions that are drawn."""
FREE = frozenset({"program", "text", "witness", "sketch"})
"""Kinds without one printed answer."""
_NUMBER = re.compile(r"[-−]?\d[\d\u202f]*(?:\.\d+)?(?:/\d+)?(?:·10[⁻⁰¹²³⁴-⁹]+)?")
_PLAIN = str.maketrans("−⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "--0123456789", "\u202f")


def count_wrong(bank: Bank, drawn: int = ROUND) -> Counted:
    """Count the wrong keys of each arithmetic, in questions spread evenly over the templates.

    Templates without a computation, or with one from a list, count and have none.
    """
    wrong: dict[str, Counter[str]] = {system: Counter() for system in ARITHMETICS}
    names = list(bank.template_paths)
    for i in range(drawn):
        name = names[i % len(names)]
        template = bank.template(name)
        if not template.chain.steps:
            continue
        one = draw_variant(template, i // len(names))
        if draws_list(one):
            continue
        for system, counts in wrong.items():
            counts[name] += is_wrong(one, system)
    kept = {system: dict(sorted((+counts).items())) for system, counts in wrong.items()}
    return Counted(datetime.now(UTC).date().isoformat(), len(names), drawn, kept)


def is_wrong(drawn: Variant, system: str) -> bool:
    """Return whether an arithmetic prints or marks a question wrongly, or has no key for it.

    For plain doubles only the digits count: nobody marks by equality with them.
    """
    found = find_faults(drawn, system)
    return bool(found - {"accepted", "rejected"} if system == "float64" else found)


def list_specs(drawn: Variant) -> list[AnySpec]:
    """Return the specification of each part of a question."""
    return [ask_part(drawn, index).spec for index in range(len(drawn.template.rules.part))]


def find_faults(drawn: Variant, name: str) -> set[str]:
    """Return what goes wrong with a question in arithmetic ``name``, compared to the exact key.

    Returns
    -------
    set of str
        ``digit``: the printed key has a wrong one. ``accepted``, ``rejected``: a wrong answer would
        be, a right one. ``unanswered``: there is no key, as something cannot be decided.
    """
    found: set[str] = set()
    try:
        others = list_specs(solve_in(drawn, name))
        for index, (right, other) in enumerate(zip(list_specs(drawn), others, strict=True)):
            if right.kind not in FREE and other != right:
                found |= _compare_part(drawn, index, right, other)
    except FAILURES:
        return {"unanswered"}
    return found


def _compare_part(drawn: Variant, index: int, right: AnySpec, other: AnySpec) -> set[str]:
    """Return the faults of one part: ``digit``, ``accepted``, ``rejected``."""
    printed, made = show_key(right), show_key(other)
    tried = dict.fromkeys(
        [printed, made, *_iter_neighbours(printed), *_iter_mistaken_answers(drawn, index)]
    )
    verdicts = {(_is_accepted(right, typed), _is_accepted(other, typed)) for typed in tried}
    found = {
        "digit": printed != made and not _has_right_digits(drawn, index, printed, made),
        "accepted": (False, True) in verdicts,
        "rejected": (True, False) in verdicts,
    }
    return {fault for fault, true in found.items() if true}


def _is_accepted(spec: AnySpec, typed: str) -> bool:
    """Return whether a specification accepts what was typed."""
    return grade_answer(spec, typed, decimal="point").verdict == "correct"


def _iter_mistaken_answers(drawn: Variant, index: int) -> Iterator[str]:
    """Yield the answers of those who make a known mistake."""
    for spec in ask_part(drawn, index).mistakes.values():
        yield show_key(spec)


def _iter_neighbours(printed: str) -> Iterator[str]:
    """Yield the printed answer with its first number one higher or lower in the last place."""
    found = _NUMBER.search(printed)
    if found is None or "/" in found[0] or "·" in found[0]:
        return
    number = Decimal(found[0].translate(_PLAIN))
    unit = Decimal(1).scaleb(int(number.as_tuple().exponent))
    for near in (number - unit, number + unit):
        yield f"{printed[: found.start()]}{near:f}{printed[found.end() :]}"


def _has_right_digits(drawn: Variant, index: int, printed: str, made: str) -> bool:
    """Return whether every number of a key is its value rounded to the places it shows."""
    numbers = [found[0].translate(_PLAIN) for found in _NUMBER.finditer(made)]
    percent = 100 if drawn.sampler.parts[index].answer.get("percent") else 1
    values = [value * percent for value in drawn.answer_of_part(index)]
    if len(numbers) != len(values) or _remove_numbers(printed) != _remove_numbers(made):
        return False
    return all(map(_rounds_to, values, numbers))


def _remove_numbers(text: str) -> str:
    """Return a printed key without its numbers."""
    return _NUMBER.sub("", text)


def _rounds_to(value: Value, number: str) -> bool:
    """Return whether a value rounded to the places of a printed number is that number."""
    if "/" in number:
        return isinstance(value, fmpq) and value == to_rational(number)
    mantissa, _, power = number.partition("·10")
    size = fmpq(10) ** int(power or 0)
    places = -int(Decimal(mantissa).as_tuple().exponent)
    with working_precision():
        return bool(round_to(value / size, places) == to_rational(mantissa))


def main() -> int:
    """Count, and write ``counted.json``."""
    found = msgspec.json.format(msgspec.json.encode(count_wrong(builtin_bank())))
    COUNTED.write_bytes(found + b"\n")
    print(COUNTED)
    return 0


if __name__ == "__main__":
    sys.exit(main())
