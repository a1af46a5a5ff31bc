"""What an exact answer costs a question, and in how many another arithmetic would be wrong.

Like for like: one Python call that solves one question's whole chain, in each arithmetic in turn.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.resources import files
from itertools import repeat

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.variant import Variant, draw_variant
from quizgen.core.decoding import decode_json
from quizgen.maths.chain import Chain
from quizgen.maths.values import AnyNumber
from quizgen.numerics.distortion import inverse_radius
from quizgen.numerics.gamma import srgb_decode
from quizgen.numerics.hsv import hsv_to_rgb
from quizgen.tradeoff.rivals import Timing, in_turns
from quizgen.tradeoff.solving import ARITHMETICS, FAILURES, Arithmetic, draws_list, solve_in

_RUNS = 15
_ALONE: tuple[Callable[[], object], ...] = (
    partial(srgb_decode, 0.5),
    partial(inverse_radius, 0.3, -0.2),
    partial(hsv_to_rgb, 200.0, 0.5, 0.5),
)
"""Array functions called for one value."""


@dataclass(frozen=True)
class Cost:
    """What one arithmetic costs over all questions: seconds, and how many times float64's.

    Parameters
    ----------
    seconds : float
        The median question's, each at its least.
    times, low, high : float
        Median and quartiles of the ratios, question by question; 1 for float64 itself.
    more : float
        Seconds more than float64, the median question's.
    """

    seconds: float
    times: float
    low: float
    high: float
    more: float


class Counted(msgspec.Struct, frozen=True):
    """Wrong keys of each arithmetic, as they were last counted.

    Parameters
    ----------
    date : str
    templates : int
        Over how many the questions are spread.
    drawn : int
    wrong : dict of str to dict of str to int
        Arithmetic to template to the number of its questions with a wrong key.
    """

    date: str
    templates: int
    drawn: int
    wrong: dict[str, dict[str, int]]

    def questions(self, system: str) -> int:
        """Return how many questions an arithmetic gets wrong."""
        return sum(self.wrong.get(system, {}).values())


@dataclass(frozen=True)
class Questions:
    """Timed questions, one of each template that computes: costs, and recorded wrong keys."""

    count: int
    costs: dict[str, Cost]
    alone: tuple[Timing, ...]
    counted: Counted


def measure_questions(bank: Bank) -> Questions:
    """Return the times of a bank's questions in each arithmetic, and the recorded counts."""
    computing = [one for one in map(bank.template, bank.template_paths) if one.chain.steps]
    drawn = [one for one in map(draw_variant, computing, repeat(0)) if _is_solved(one, "balls")]
    systems = [name for name in ARITHMETICS if name != "rounded"]  # float64, rounded afterwards
    spent = [in_turns([_prepare_solving(one, name) for name in systems], _RUNS) for one in drawn]
    least = {name: [times[i].least for times in spent] for i, name in enumerate(systems)}
    costs = {name: _summarise_cost(seconds, least["float64"]) for name, seconds in least.items()}
    alone = in_turns(_ALONE, 10 * _RUNS)
    return Questions(
        len(drawn), costs | {"rounded": costs["float64"]}, tuple(alone), load_recorded_counts()
    )


def _is_solved(drawn: Variant, system: str) -> bool:
    """Return whether an arithmetic has an answer.

    Balls cannot tell that two colours are equal; what is drawn as a list is not timed.
    """
    if draws_list(drawn):
        return False
    try:
        solve_in(drawn, system)
    except FAILURES:
        return False
    return True


def _prepare_solving(drawn: Variant, system: str) -> Callable[[], object]:
    """Return a function that solves the question once, to be timed."""
    way, chain = ARITHMETICS[system], drawn.template.chain
    given = way.convert_given({quantity: drawn.values[quantity] for quantity in chain.given})
    return partial(_solve_chain, way, chain, given)


def _solve_chain(way: Arithmetic, chain: Chain, given: dict[str, AnyNumber]) -> object:
    """Return every quantity of a chain, computed in an arithmetic from a copy of what is given."""
    return way.run(chain, dict(given))


def _summarise_cost(seconds: Sequence[float], doubles: Sequence[float]) -> Cost:
    """Return the cost of one arithmetic from seconds per question, and those of float64."""
    ratios = [one / other for one, other in zip(seconds, doubles, strict=True)]
    low, times, high = statistics.quantiles(ratios, n=4, method="inclusive")
    more = statistics.median(one - other for one, other in zip(seconds, doubles, strict=True))
    return Cost(statistics.median(seconds), times, low, high, more)


def load_recorded_counts() -> Counted:
    """Return the wrong keys as they were last counted in full."""
    return decode_json((files("quizgen.tradeoff") / "counted.json").read_bytes(), Counted)
