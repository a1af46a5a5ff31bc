"""Whether one draw of a question is harder than another.

Who gets which numbers is left to chance, so students with one value of a drawn quantity are as
good as those with another; if their points differ by more than chance explains, the draw did it.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from quizgen.classes.statistics import holm_correction, kruskal_wallis, spearman
from quizgen.core.errors import FormulaError
from quizgen.maths.numbers import parse_written_number

MOST_GROUPS = 6
"""Different values up to which a quantity is compared value by value."""
FEWEST = 5
"""Students with a value, for it to be compared."""

_PIECE = re.compile(r"([^\s(,=]+)=([^,)]*)")


@dataclass(frozen=True)
class ValueGroup:
    """Students who had the same drawn value, or values of one range.

    Parameters
    ----------
    name : str
    students : int
    share : float
        Their mean share of the points.
    error : float
        Standard error of it.
    """

    name: str
    students: int
    share: float
    error: float


@dataclass(frozen=True)
class VariantEffect:
    """How the points of one question depend on the value of one drawn quantity.

    Parameters
    ----------
    template, quantity : str
    levels : tuple of ValueGroup
    chance : float
        Probability of so great a difference if the value does not matter.
    corrected : float
        The same, as one of many tests (Holm).
    trend : float or None
        Spearman's correlation where values are ordered and many.
    """

    template: str
    quantity: str
    levels: tuple[ValueGroup, ...]
    chance: float
    corrected: float = 1.0
    trend: float | None = None


def parse_identity(identity: str) -> list[tuple[str, str]]:
    """Return name and value of each quantity in the identity of a variant."""
    return _PIECE.findall(identity.partition("(")[2])


class VariantDifficulty:
    """Collects values and points, and tests whether some values were harder."""

    def __init__(self) -> None:
        self.values: dict[tuple[str, str], tuple[list[str], list[float]]] = defaultdict(
            lambda: ([], [])
        )

    def add(self, template: str, identity: str, share: float) -> None:
        """Add one student's question: identity of the variant, share of the points (0 to 1)."""
        for quantity, value in parse_identity(identity):
            values, shares = self.values[template, quantity]
            values.append(value)
            shares.append(share)

    def find_effects(self) -> list[VariantEffect]:
        """Return the effect of each quantity, with Holm's correction; smallest p-value first."""
        found = [
            effect
            for (template, quantity), (values, shares) in sorted(self.values.items())
            if (effect := _test_effect(template, quantity, values, np.array(shares)))
        ]
        corrected = holm_correction([effect.chance for effect in found])
        pairs = zip(found, corrected, strict=True)
        return sorted(
            (replace(effect, corrected=chance) for effect, chance in pairs),
            key=lambda effect: effect.chance,
        )


def _test_effect(
    template: str, quantity: str, values: Sequence[str], shares: NDArray[np.float64]
) -> VariantEffect | None:
    """Return the effect of one quantity; None if too few students share values.

    Many numbers are tested for a trend, few values group against group.
    """
    names, places = np.unique(np.array(values), return_inverse=True)
    numbers = _parse_all_numbers(names)
    if len(names) > MOST_GROUPS and numbers is not None:
        return _test_trend(template, quantity, numbers[places], shares)
    counts = np.bincount(places)
    common = [place for place in range(len(names)) if counts[place] >= FEWEST]
    if numbers is not None:
        common.sort(key=lambda place: numbers[place])
    if len(common) < 2:
        return None
    groups = {str(names[place]): shares[places == place] for place in common}
    chance = kruskal_wallis(list(groups.values()))
    return (
        None if chance is None else VariantEffect(template, quantity, _build_levels(groups), chance)
    )


def _parse_all_numbers(names: Iterable[str]) -> NDArray[np.float64] | None:
    """Return the values as floats; None if any is no number."""
    try:
        return np.array([float(parse_written_number(str(name))) for name in names])
    except (FormulaError, OverflowError):
        return None


def _test_trend(
    template: str, quantity: str, numbers: NDArray[np.float64], shares: NDArray[np.float64]
) -> VariantEffect | None:
    """Return the rank correlation of points with a number, with quartiles as groups."""
    found = spearman(numbers, shares)
    if found is None or len(numbers) < 4 * FEWEST:
        return None
    ends = np.quantile(numbers, [0.25, 0.5, 0.75])
    places = np.searchsorted(ends, numbers)
    groups = {
        f"{own.min():g} … {own.max():g}": shares[places == place]
        for place in range(4)
        if len(own := numbers[places == place])
    }
    return VariantEffect(template, quantity, _build_levels(groups), found[1], trend=found[0])


def _build_levels(groups: Mapping[str, NDArray[np.float64]]) -> tuple[ValueGroup, ...]:
    """Return the mean share and its standard error for each group."""
    return tuple(
        ValueGroup(name, len(own), float(own.mean()), _compute_standard_error(own))
        for name, own in groups.items()
    )


def _compute_standard_error(own: NDArray[np.float64]) -> float:
    """Return the standard error of the mean; 0 for a single value."""
    return float(own.std(ddof=1) / np.sqrt(len(own))) if len(own) > 1 else 0.0
