"""What the draws of a closed part look like over many seeds: its answers, places and lengths."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from quizgen.bank.pools import matching_pairs, select_from_pool
from quizgen.bank.variant import Variant
from quizgen.kinds import choice, true_false
from quizgen.question.interpolation import Interpolator, inlines_to_text
from quizgen.question.part_context import VariantPart, ask_part

CLOSED = frozenset({"choice", "multi", "tf", "match", "order", "gap"})
"""Kinds whose answer is picked out of what is shown, or is a word that is known before."""
CLEARLY = 1.1
"""An option is noticed as the longest if it has a tenth more letters than any other."""


@dataclass
class AnswerTally:
    """One closed part over many draws.

    Parameters
    ----------
    kind : str
    draws : int
    answers : Counter
        What is right, by name; for pairs, steps and gaps also what is shown.
    shown, right : Counter
        How often each option came up, and was right.
    most : int
        Options shown at once.
    places : Counter
        Where the right option stood, from 1.
    longest : Counter
        Language to the draws in which a right option was clearly the longest.
    """

    kind: str
    draws: int = 0
    answers: Counter[str] = field(default_factory=Counter)
    shown: Counter[str] = field(default_factory=Counter)
    right: Counter[str] = field(default_factory=Counter)
    most: int = 0
    places: Counter[int] = field(default_factory=Counter)
    longest: Counter[str] = field(default_factory=Counter)
    _lengths: dict[tuple[str, str], int] = field(default_factory=dict)

    @property
    def bits(self) -> float:
        """Entropy of the answers."""
        return entropy_bits(self.answers.values())

    @property
    def most_bits(self) -> float:
        """The same, and how far it may be off because the draws are few: two deviations."""
        shares = [count / self.draws for count in self.answers.values()]
        squares = sum(share * math.log2(share) ** 2 for share in shares)
        return self.bits + 2 * math.sqrt(max(0.0, squares - self.bits**2) / self.draws)

    def add(self, drawn: Variant, index: int, fillers: Sequence[Interpolator]) -> None:
        """Take a draw into account."""
        self.draws += 1
        if self.kind not in {"choice", "multi"}:
            self.answers[_describe_answer(self.kind, drawn, index)] += 1
            return
        names, right = choice.option_order(VariantPart(drawn, index))
        if self.kind == "choice" and len(right) != 1:
            ask_part(drawn, index)  # says what is wrong
        self.answers["+".join(sorted(right))] += 1
        self.most = max(self.most, len(names))
        for place, name in enumerate(names, 1):
            self.shown[name] += 1
            if name in right:
                self.right[name] += 1
                self.places[place] += 1
        for filler in fillers:
            lengths = {name: self._measure_option(filler, name) for name in names}
            self.longest[filler.lang] += _find_longest_option(lengths) in right

    def _measure_option(self, filler: Interpolator, name: str) -> int:
        """Letters of an option; of one that is the same in every draw they are counted once."""
        known = self._lengths.get((filler.lang, name))
        if known is None:
            known = len(inlines_to_text(filler.sentence("options", name)))
            if ("options", name) in filler.text.unslotted_sentences:
                self._lengths[filler.lang, name] = known
        return known


def _find_longest_option(lengths: dict[str, int]) -> str:
    """The option that is clearly the longest; empty if none is."""
    name = max(lengths, key=lambda one: lengths[one])
    others = [length for other, length in lengths.items() if other != name]
    return name if lengths[name] >= CLEARLY * max(others, default=0) else ""


def _describe_answer(kind: str, drawn: Variant, index: int) -> str:
    """What a learner would have to know in this draw: words, pairs or an order."""
    if kind == "tf":
        part = VariantPart(drawn, index)
        return str(part.condition_holds(true_false.selected_statement(part)[1]))
    shown = select_from_pool(drawn, index)
    names = [*shown.names, *shown.extra]
    if kind == "match":
        pairs = matching_pairs(drawn, index)
        names = [f"{name}={pairs.get(name, '')}" for name in names]
    if kind == "gap":
        names = [drawn.words.get(name, name) for name in names]
        return "+".join(names if len({*shown.names}) == len(names) else sorted(names))
    return "+".join(sorted(names))


def entropy_bits(counts: Iterable[int]) -> float:
    """Bits that one answer is worth to whoever has seen all others."""
    found = [count for count in counts if count]
    total = sum(found)
    return math.log2(total) - sum(n * math.log2(n) for n in found) / total if found else 0.0
