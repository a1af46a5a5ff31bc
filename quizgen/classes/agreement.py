"""How far two markers agree on an item: Cohen's kappa, weighted by the square of the difference.

Source: J. Cohen, "Weighted kappa: nominal scale agreement with provision for scaled disagreement or
partial credit", Psychological Bulletin 70 (1968) 213-220. What was settled afterwards does not
count: each of the two is taken by what was said before.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from quizgen.classes.rulings import DECIDE, SECOND, Ruling, latest_rulings

SETTLED = "settled"
"""Begins the reason of a decision that ended a disagreement."""


@dataclass(frozen=True)
class ItemAgreement:
    """How far two markers agree on one item.

    Parameters
    ----------
    answers : int
        Groups of answers that both have marked.
    kappa : Fraction or None
        Weighted, -1 to 1.
    apart : tuple of (Ruling, Ruling)
        Where they differ and nobody has settled it.
    """

    answers: int
    kappa: Fraction | None
    apart: tuple[tuple[Ruling, Ruling], ...]


def is_settlement(ruling: Ruling) -> bool:
    """Return whether a decision ended a disagreement of two markers."""
    return ruling.because.startswith(SETTLED)


def agreement_by_item(rulings: Sequence[Ruling]) -> dict[str, ItemAgreement]:
    """Return the agreement on each item that two have marked, by the last ruling of each."""
    first = latest_rulings((one for one in rulings if not is_settlement(one)), DECIDE)
    second = latest_rulings(rulings, SECOND)
    last = latest_rulings(rulings, DECIDE)
    by_item: dict[str, list[tuple[Ruling, Ruling]]] = {}
    for group, one in first.items():
        if group in second:
            by_item.setdefault(one.item, []).append((one, second[group]))
    return {item: _compare_markers(pairs, last) for item, pairs in by_item.items()}


def _compare_markers(
    pairs: Sequence[tuple[Ruling, Ruling]], last: dict[str, Ruling]
) -> ItemAgreement:
    """Return the agreement on one item; ``last`` is what counts of each group."""
    said = [(one.points or Fraction(0), two.points or Fraction(0)) for one, two in pairs]
    apart = tuple(
        pair
        for pair, (one, two) in zip(pairs, said, strict=True)
        if one != two and not (pair[0].group in last and is_settlement(last[pair[0].group]))
    )
    return ItemAgreement(len(pairs), weighted_kappa(said), apart)


def weighted_kappa(pairs: Iterable[tuple[Fraction, Fraction]]) -> Fraction | None:
    """Return Cohen's kappa of two markers' points with quadratic weights; None if undetermined.

    Parameters
    ----------
    pairs : iterable
        The points that each of them gave one answer.
    """
    said = [*pairs]
    one, other = (sum((pair[at] for pair in said), Fraction(0)) for at in (0, 1))
    squares = sum((a**2 + b**2 for a, b in said), Fraction(0))
    seen = sum(((a - b) ** 2 for a, b in said), Fraction(0))
    # The square of the difference of any two of them, summed over all pairs, is this over n.
    by_chance = squares - 2 * one * other / max(1, len(said))
    return 1 - seen / by_chance if by_chance else None
