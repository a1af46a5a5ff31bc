"""What a variant takes of the pools of its parts: claims, options, pairs, steps, gaps.

Like every value of a variant it is a function of (origin, version, seed, slot, part, name) through
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
from quizgen.kinds.choice import has_value_options
from quizgen.maths.numbers import format_for_key
from quizgen.maths.values import Value

MIXED = 3
"""Claims of one variant from which on they are neither all true nor all false."""


class PoolVariant(Protocol):
    """What a selection depends on: a variant, which this module is too low to know."""

    @property
    def template(self) -> Template:
        """Return the template that it was drawn from."""

    @property
    def seed(self) -> str:
        """Return the paper's seed."""

    @property
    def slot(self) -> str:
        """Return its place in the paper."""

    @property
    def shown(self) -> Mapping[str, fmpq]:
        """Return the drawn quantities in the units they are shown in."""

    @property
    def lists(self) -> Mapping[str, tuple[fmpq, ...]]:
        """Drawn lists in the units they are shown in."""

    @property
    def words(self) -> Mapping[str, str]:
        """Return the drawn phrases, by their name in the language files."""

    def evaluate(self, formula: str) -> Value:
        """Return the value of a formula over the quantities in shown units."""

    def __hash__(self) -> int:
        """Return the hash of its identity: a selection is cached for each variant."""


class PoolSelection(msgspec.Struct, frozen=True):
    """What one part shows in a variant.

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
    """Return whether an authored condition, a truth or a formula, holds in this variant."""
    return condition if isinstance(condition, bool) else bool(drawn.evaluate(str(condition)))


@lru_cache(maxsize=128)
def select_from_pool(drawn: PoolVariant, index: int) -> PoolSelection:
    """Return what a part shows in this variant; all that is listed where it has no pool.

    Raises
    ------
    BankError
        If the pool cannot give what is asked of it.
    """
    answer = drawn.template.rules.part[index].answer
    if has_value_options(answer):
        return PoolSelection(())  # its options are values, not names of a list
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
    """Return the claim that each part asks, by the part's index; no claim comes twice.

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
    """Return how many different questions its pools can make of the numbers of one variant."""
    parts = range(len(drawn.template.rules.part))
    return _count_claim_sets(drawn) * prod(_count_selections(drawn, index) for index in parts)


def build_identity(drawn: PoolVariant) -> str:
    """Return the name of a variant: two ask the same if and only if this is the same."""
    numbers = [f"{name}={format_for_key(value)}" for name, value in sorted(drawn.shown.items())]
    numbers += [
        f"{name}=[{'; '.join(map(format_for_key, values))}]"
        for name, values in sorted(drawn.lists.items())
    ]
    words = [f"{name}={value}" for name, value in sorted(drawn.words.items())]
    return f"{drawn.template.id}({', '.join([*numbers, *words, *_iter_selected_names(drawn)])})"


def _iter_selected_names(drawn: PoolVariant) -> Iterator[str]:
    """Yield what its pools gave, one ``name=...`` for each of them."""
    asked = sorted(selected_claims(drawn).values())
    if asked:
        yield f"claims={'+'.join(asked)}"
    for index, part in enumerate(drawn.template.rules.part):
        if "take" in part.answer or "extra" in part.answer:
            shown = select_from_pool(drawn, index)
            label = drawn.template.labels[index] or "part"
            yield f"{label}={'+'.join(sorted((*shown.names, *shown.extra)))}"


def _build_selection_key(drawn: PoolVariant, place: object) -> str:
    """Return the text that a selection is hashed from, different for each ``place``."""
    template = drawn.template
    return f"{template.origin}/{template.rules.version}/{drawn.seed}/{drawn.slot}/take/{place}"


def _rank_by_hash(key: str, names: Iterable[str]) -> list[str]:
    """Return names in an order that belongs to the key.

    By hash and not by position: a name that is added to a pool leaves the others in order.
    """
    return sorted(names, key=lambda name: hashlib.sha256(f"{key}/{name}".encode()).digest())


def _select_names(
    drawn: PoolVariant, index: int, names: Collection[str], count: int | None
) -> tuple[str, ...]:
    """Return ``count`` of the names, or all of them in their order for None."""
    if count is None:
        return tuple(names)
    return tuple(_rank_by_hash(_build_selection_key(drawn, index), names)[:count])


def _select_options(
    drawn: PoolVariant, index: int, options: Mapping[str, object]
) -> tuple[str, ...]:
    """Return the options that a part shows, in their listed order.

    How many of them are right is drawn before which: a learner cannot count on it.
    """
    take = drawn.template.rules.part[index].answer.get("take")
    if take is None:
        return tuple(options)
    right, wrong = _split_right_and_wrong(drawn, options)
    counts = _list_right_counts(drawn, index, len(right), len(wrong))
    key = _build_selection_key(drawn, index)
    count = counts[pick_index(f"{key}/right", len(counts))]
    chosen = {*_rank_by_hash(key, right)[:count], *_rank_by_hash(key, wrong)[: take - count]}
    return tuple(name for name in options if name in chosen)


def _split_right_and_wrong(
    drawn: PoolVariant, options: Mapping[str, object]
) -> tuple[list[str], list[str]]:
    """Return the options that are right in this variant, and those that are wrong."""
    right = [name for name, condition in options.items() if condition_holds(drawn, condition)]
    return right, [name for name in options if name not in right]


def _list_right_counts(drawn: PoolVariant, index: int, right: int, wrong: int) -> list[int]:
    """Return the numbers of right options that a variant can have.

    Raises
    ------
    BankError
        If there is none: too few right or wrong options.
    """
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
    """Return the right side of each left side of a matching, whatever is selected of it.

    A drawn phrase as a right side is replaced by what was drawn for it.
    """
    pairs = drawn.template.rules.part[index].answer["pairs"]
    return {name: drawn.words.get(target, target) for name, target in pairs.items()}


def _select_pairs(drawn: PoolVariant, index: int) -> PoolSelection:
    """Return the left sides that a matching shows, and the right sides that fit none of them.

    Where several left sides share a right one, one of each comes first, so that as many right
    sides as possible are in use.
    """
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


def _count_claim_sets(drawn: PoolVariant) -> int:
    """Return how many sets of claims the parts can ask.

    Those all true or all false are left out where ``selected_claims`` never gives them.
    """
    rules = drawn.template.rules
    count = sum("from" in part.answer for part in rules.part)
    true = sum(condition_holds(drawn, get_claim(rules, name).true) for name in rules.claims)
    false = len(rules.claims) - true
    alike = comb(true, count) + comb(false, count) if count >= MIXED and true and false else 0
    return comb(true + false, count) - alike


def _count_selections(drawn: PoolVariant, index: int) -> int:
    """Return how many different selections one part can show."""
    answer: Mapping[str, Any] = drawn.template.rules.part[index].answer
    if "options" in answer and "take" in answer:
        right, wrong = map(len, _split_right_and_wrong(drawn, answer["options"]))
        counts = _list_right_counts(drawn, index, right, wrong)
        return sum(comb(right, n) * comb(wrong, answer["take"] - n) for n in counts)
    if "pairs" in answer:
        return _count_pair_sets(answer, matching_pairs(drawn, index))
    listed = answer.get("steps", answer.get("gaps", ()))
    strangers = len(answer.get("distractors", ()))
    return comb(len(listed), answer.get("take", len(listed))) * comb(
        strangers, answer.get("extra", strangers)
    )


def _count_pair_sets(answer: Mapping[str, Any], pairs: Mapping[str, str]) -> int:
    """Return how many sets of pairs there are, counted with their right sides that fit nowhere."""
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
    """Return in how many ways the extra right sides can be chosen of those ``left``."""
    return comb(left, answer["extra"]) if "extra" in answer else 1
