"""What a draw takes of the pools of its parts: claims, options, pairs, steps, gaps.

Like every value of a draw it is a function of (origin, version, seed, slot, part, name) through
SHA-256: names are ranked by their own hash, so an entry that is added or taken away leaves the
order of all others as it was.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import lru_cache
from itertools import combinations
from math import comb, prod
from types import MappingProxyType
from typing import Any, Protocol

import msgspec
from flint import fmpq

from quizgen.bank.rules import get_claim
from quizgen.bank.sampler import pick_index
from quizgen.bank.template import Template
from quizgen.core.errors import BankError
from quizgen.maths.numbers import format_for_key
from quizgen.maths.values import Value

MIXED = 3
"""Claims of one draw from which on they are neither all true nor all false."""


class PoolVariant(Protocol):
    """What a selection depends on: a variant, which this module is too low to know."""

    @property
    def template(self) -> Template:
        """What it was drawn of."""

    @property
    def seed(self) -> str:
        """The paper's seed."""

    @property
    def slot(self) -> str:
        """Its place in the paper."""

    @property
    def shown(self) -> Mapping[str, fmpq]:
        """Drawn quantities in the units they are shown in."""

    @property
    def lists(self) -> Mapping[str, tuple[fmpq, ...]]:
        """Drawn lists in the units they are shown in."""

    @property
    def words(self) -> Mapping[str, str]:
        """Drawn phrases, by their name in the language files."""

    def evaluate(self, formula: str) -> Value:
        """Value of a formula over the quantities in shown units."""

    def __hash__(self) -> int:
        """By itself: a selection is kept for each variant."""


class PoolSelection(msgspec.Struct, frozen=True):
    """What one part shows in a draw.

    Parameters
    ----------
    names : tuple of str
        Options, left sides, steps or gaps; in the listed order unless some are left out.
    extra : tuple of str
        Right sides or steps that fit nowhere.
    """

    names: tuple[str, ...]
    extra: tuple[str, ...] = ()


def condition_holds(drawn: PoolVariant, condition: object) -> bool:
    """Whether an authored condition, a truth or a formula, holds in this draw."""
    return condition if isinstance(condition, bool) else bool(drawn.evaluate(str(condition)))


@lru_cache(maxsize=128)
def select_from_pool(drawn: PoolVariant, index: int) -> PoolSelection:
    """What a part shows in this draw; all that is listed where it has no pool.

    Raises
    ------
    BankError
        If the pool cannot give what is asked of it.
    """
    answer = drawn.template.rules.part[index].answer
    if "options" in answer:
        return PoolSelection(_select_options(drawn, index, answer["options"]))
    if "pairs" in answer:
        return _select_pairs(drawn, index)
    listed = tuple(answer.get("steps", answer.get("gaps", ())))
    names = _select_names(drawn, index, listed, answer.get("take"))
    if "steps" in answer:
        names = tuple(name for name in listed if name in names)
    strangers = tuple(answer.get("distractors", ()))
    return PoolSelection(names, _select_names(drawn, index, strangers, answer.get("extra")))


@lru_cache(maxsize=128)
def selected_claims(drawn: PoolVariant) -> Mapping[int, str]:
    """Each part that asks a claim of the pool, and the claim; no claim comes twice.

    Whether a claim is true is drawn first, as a fair coin, then which one it is.
    """
    rules = drawn.template.rules
    parts = [index for index, part in enumerate(rules.part) if "from" in part.answer]
    if not parts:
        return MappingProxyType({})
    key = _build_selection_key(drawn, "claims")
    sides: dict[bool, list[str]] = {True: [], False: []}
    for name in _rank_by_hash(key, rules.claims):
        sides[condition_holds(drawn, get_claim(rules, name).true)].append(name)
    wanted = [bool(pick_index(f"{key}/true/{place}", 2)) for place in range(len(parts))]
    if len(parts) >= MIXED and len(set(wanted)) == 1:
        wanted[pick_index(f"{key}/other", len(parts))] ^= True
    asked = {
        index: (sides[truth] or sides[not truth]).pop(0)
        for index, truth in zip(parts, wanted, strict=True)
    }
    return MappingProxyType(asked)


def count_pool_variants(drawn: PoolVariant) -> int:
    """How many different questions its pools can make of the numbers of a draw."""
    parts = range(len(drawn.template.rules.part))
    return _claim_sets(drawn) * prod(_count_selections(drawn, index) for index in parts)


def build_identity(drawn: PoolVariant) -> str:
    """Name of a variant: two ask the same if and only if this is the same."""
    numbers = [f"{name}={format_for_key(value)}" for name, value in sorted(drawn.shown.items())]
    numbers += [
        f"{name}=[{'; '.join(map(format_for_key, values))}]"
        for name, values in sorted(drawn.lists.items())
    ]
    words = [f"{name}={value}" for name, value in sorted(drawn.words.items())]
    return f"{drawn.template.id}({', '.join([*numbers, *words, *_selected_names(drawn)])})"


def _selected_names(drawn: PoolVariant) -> Iterator[str]:
    """What its pools gave."""
    asked = sorted(selected_claims(drawn).values())
    if asked:
        yield f"claims={'+'.join(asked)}"
    for index, part in enumerate(drawn.template.rules.part):
        if "take" in part.answer or "extra" in part.answer:
            shown = select_from_pool(drawn, index)
            label = drawn.template.labels[index] or "part"
            yield f"{label}={'+'.join(sorted((*shown.names, *shown.extra)))}"


def _build_selection_key(drawn: PoolVariant, place: object) -> str:
    template = drawn.template
    return f"{template.origin}/{template.rules.version}/{drawn.seed}/{drawn.slot}/take/{place}"


def _rank_by_hash(key: str, names: Iterable[str]) -> list[str]:
    return sorted(names, key=lambda name: hashlib.sha256(f"{key}/{name}".encode()).digest())


def _select_names(
    drawn: PoolVariant, index: int, names: Collection[str], count: int | None
) -> tuple[str, ...]:
    """So many of the names, or all of them in their order."""
    if count is None:
        return tuple(names)
    return tuple(_rank_by_hash(_build_selection_key(drawn, index), names)[:count])


def _select_options(
    drawn: PoolVariant, index: int, options: Mapping[str, object]
) -> tuple[str, ...]:
    take = drawn.template.rules.part[index].answer.get("take")
    if take is None:
        return tuple(options)
    right, wrong = _split_right_and_wrong(drawn, options)
    counts = _right_counts(drawn, index, len(right), len(wrong))
    key = _build_selection_key(drawn, index)
    count = counts[pick_index(f"{key}/right", len(counts))]
    chosen = {*_rank_by_hash(key, right)[:count], *_rank_by_hash(key, wrong)[: take - count]}
    return tuple(name for name in options if name in chosen)


def _split_right_and_wrong(
    drawn: PoolVariant, options: Mapping[str, object]
) -> tuple[list[str], list[str]]:
    right = [name for name, condition in options.items() if condition_holds(drawn, condition)]
    return right, [name for name in options if name not in right]


def _right_counts(drawn: PoolVariant, index: int, right: int, wrong: int) -> list[int]:
    """The numbers of right options that a draw can have."""
    answer = drawn.template.rules.part[index].answer
    take = answer["take"]
    least, most = answer.get("right", (1, take)) if answer["kind"] == "multi" else (1, 1)
    found = list(range(max(least, take - wrong), min(most, right, take) + 1))
    if not found:
        what = f"part {index + 1}: take: {right} right and {wrong} wrong options are too few"
        file, at = drawn.template.file, ("part", index, "answer", "take")
        raise BankError(what, rule="QG115", file=file, place=at)
    return found


def matching_pairs(drawn: PoolVariant, index: int) -> dict[str, str]:
    """Left side to right side of a matching, whatever is taken; a drawn phrase names what it is."""
    pairs = drawn.template.rules.part[index].answer["pairs"]
    return {name: drawn.words.get(target, target) for name, target in pairs.items()}


def _select_pairs(drawn: PoolVariant, index: int) -> PoolSelection:
    answer, pairs = drawn.template.rules.part[index].answer, matching_pairs(drawn, index)
    ranked = _rank_by_hash(_build_selection_key(drawn, index), pairs)
    take = answer.get("take", len(pairs))
    once = {pairs[name]: name for name in reversed(ranked)}
    if len(once) < len(pairs) and len(once) <= take:
        ranked.sort(key=lambda name: once[pairs[name]] != name)
    names = ranked[:take]
    used = {pairs[name] for name in names}
    strangers = [*answer.get("distractors", ())]
    if "extra" in answer:
        strangers = [*dict.fromkeys((*strangers, *pairs.values()))]
    spare = _select_names(
        drawn, index, [s for s in strangers if s not in used], answer.get("extra")
    )
    return PoolSelection(tuple(name for name in pairs if name in names), spare)


def _claim_sets(drawn: PoolVariant) -> int:
    rules = drawn.template.rules
    count = sum("from" in part.answer for part in rules.part)
    true = sum(condition_holds(drawn, get_claim(rules, name).true) for name in rules.claims)
    false = len(rules.claims) - true
    alike = comb(true, count) + comb(false, count) if count >= MIXED and true and false else 0
    return comb(true + false, count) - alike


def _count_selections(drawn: PoolVariant, index: int) -> int:
    answer: Mapping[str, Any] = drawn.template.rules.part[index].answer
    if "options" in answer and "take" in answer:
        right, wrong = map(len, _split_right_and_wrong(drawn, answer["options"]))
        counts = _right_counts(drawn, index, right, wrong)
        return sum(comb(right, n) * comb(wrong, answer["take"] - n) for n in counts)
    if "pairs" in answer:
        return _pair_sets(answer, matching_pairs(drawn, index))
    listed = answer.get("steps", answer.get("gaps", ()))
    strangers = len(answer.get("distractors", ()))
    return comb(len(listed), answer.get("take", len(listed))) * comb(
        strangers, answer.get("extra", strangers)
    )


def _pair_sets(answer: Mapping[str, Any], pairs: Mapping[str, str]) -> int:
    """Sets of pairs, counted with those of the right sides that fit nowhere."""
    strangers, targets = {*answer.get("distractors", ())}, {*pairs.values()}
    take = answer.get("take", len(pairs))
    if len(targets) == len(pairs):
        return comb(len(pairs), take) * _count_extra_choices(
            answer, len(strangers | targets) - take
        )
    sets = [{pairs[name] for name in chosen} for chosen in combinations(pairs, take)]
    whole = [used for used in sets if used == targets or len(targets) > take]
    return sum(_count_extra_choices(answer, len((strangers | targets) - used)) for used in whole)


def _count_extra_choices(answer: Mapping[str, Any], left: int) -> int:
    return comb(left, answer["extra"]) if "extra" in answer else 1
