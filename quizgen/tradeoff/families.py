"""The families: formula, inputs as an exam draws them, inputs aimed at the weak spot, peers.

A formula comes from the solver's own chain where there is one, else it is written here in the
notation of the answer grammar. Names are in the order in which the array function takes them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

import numpy as np

from quizgen.arrays import (
    depth_of_field,
    distortion,
    gamma,
    gaussian,
    poisson,
    projection,
)
from quizgen.arrays.aliases import Result
from quizgen.maths.tree import Call, Expr, Num, substitute
from quizgen.tradeoff import plain
from quizgen.tradeoff.rung import Column

Random = np.random.Generator
Columns = list[Column]
Inputs = Callable[[Random, int], Columns]
"""Random generator and count to columns of doubles."""


@dataclass(frozen=True)
class Family:
    """One solver on the page.

    Parameters
    ----------
    name : str
        Name on the command line; the words stand in ``words/*.toml``.
    names : tuple of str
        Quantities in the order of the array function's arguments.
    source : str or tuple
        Formula text, or solver and quantity of its chain.
    stable : callable
        The array function, or one plain line of NumPy where that is as accurate.
    printed : callable, optional
        The formula as a textbook prints it, where a chain says it in another way.
    exam, hard : callable
        Inputs.
    tolerance : float
        Relative tolerance of grading, for the line in the plot.
    given : mapping
        Chain quantities replaced before anything is evaluated (a formula text or a number).
    rational : bool
        Whether exact inputs give an exact rational.
    decimal : bool
        Whether inputs mean the decimals they print as.
    whole_turn : float
        360 for angles, whose error is judged on the circle.
    """

    name: str
    names: tuple[str, ...]
    source: str | tuple[str, str]
    stable: Callable[..., Result]
    exam: Inputs
    hard: Inputs
    tolerance: float = 0.005
    given: Mapping[str, str] = field(default_factory=dict)
    rational: bool = True
    decimal: bool = False
    whole_turn: float = 0.0
    printed: Callable[..., Column] | None = None

    @property
    def one_line(self) -> bool:
        """Whether one plain line is as accurate as a function could be."""
        return self.stable.__module__ == plain.__name__

    @cached_property
    def formula(self) -> Expr | None:
        """The textbook formula as a tree, or None for a family without one."""
        from quizgen.maths.notation import parse

        if self.source == "":
            return None
        if isinstance(self.source, str):
            return parse(self.source)
        replaced: dict[str, Expr] = {name: parse(text) for name, text in self.given.items()}
        return _without_ones(substitute(_flat(*self.source), replaced))


def _flat(solver: str, quantity: str) -> Expr:
    """One formula from given quantities to a quantity of a solver's chain."""
    from quizgen.bank.folder import builtin

    known: dict[str, Expr] = {}
    for step in builtin().chain(solver)[0].steps:
        known[step.name] = substitute(step.expr, known)
    return known[quantity]


def _without_ones(expr: Expr) -> Expr:
    """Leave out divisions by a quantity that was replaced by 1."""
    if not isinstance(expr, Call):
        return expr
    args = tuple(map(_without_ones, expr.args))
    return args[0] if expr.op == "div" and args[1] == Num(Fraction(1)) else Call(expr.op, args)


def _near(rng: Random, x: Column, nearest: float = -14, farthest: float = -2) -> Column:
    """Values at log-uniform relative distance from x, on both sides."""
    size = 10 ** rng.uniform(nearest, farthest, x.size)
    near: Column = x * (1 + rng.choice([-1, 1], x.size) * size)
    return near


def _pick(rng: Random, values: tuple[float, ...], count: int) -> Column:
    return rng.choice(np.array(values, dtype=np.float64), count)


_FOCAL = (24.0, 28.0, 35.0, 50.0, 85.0, 100.0)
_STOPS = (1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0)


def _lens_exam(rng: Random, n: int) -> Columns:
    f = _pick(rng, _FOCAL, n)
    return [f, f * rng.integers(3, 40, n) / 2]


def _lens_hard(rng: Random, n: int) -> Columns:
    f = _pick(rng, _FOCAL, n)
    return [f, f * (1 + 10 ** rng.uniform(-14, -3, n))]


def _blur_exam(rng: Random, n: int) -> Columns:
    f, s = _pick(rng, _FOCAL, n), 100.0 * rng.integers(10, 60, n)
    return [f, _pick(rng, _STOPS, n), s, s * rng.integers(3, 19, n) / 10 + 50]


def _blur_hard(rng: Random, n: int) -> Columns:
    f, N, s, _ = _blur_exam(rng, n)
    return [f, N, s, _near(rng, s)]


def _field_exam(rng: Random, n: int) -> Columns:
    f = _pick(rng, _FOCAL, n)
    return [f, _pick(rng, _STOPS, n), np.full(n, 0.03), f * rng.integers(10, 40, n) / 2]


def _field_hard(rng: Random, n: int) -> Columns:
    f, N, c, _ = _field_exam(rng, n)
    H = f + f * f / (N * c)
    return [f, N, c, H * (1 - 10 ** rng.uniform(-14, -2, n))]


def _stops_hard(rng: Random, n: int) -> Columns:
    a = _pick(rng, _STOPS, n)
    return [a, _near(rng, a)]


def _inverse_exam(rng: Random, n: int) -> Columns:
    fold = 2 / (3 * math.sqrt(0.6))
    return [fold * rng.uniform(0.05, 0.5, n), np.full(n, -0.2), np.zeros(n)]


def _inverse_hard(rng: Random, n: int) -> Columns:
    fold = 2 / (3 * math.sqrt(0.6))
    return [fold * (1 - 10 ** rng.uniform(-6, -0.5, n)), np.full(n, -0.2), np.zeros(n)]


def _colour_exam(rng: Random, n: int) -> Columns:
    levels = np.array([rng.permutation(11)[:3] for _ in range(n)]) / 10
    return list(levels.T.copy())


def _colour_hard(rng: Random, n: int) -> Columns:
    base = rng.uniform(0.1, 0.9, n)
    return [base, _near(rng, base, -14, -3), _near(rng, base, -14, -3)]


def _range_exam(rng: Random, n: int) -> Columns:
    low, high = 10.0 * rng.integers(0, 6, n), 10.0 * rng.integers(15, 26, n)
    return [low + rng.integers(5, 95, n), low, high, np.full(n, -1.0), np.full(n, 1.0)]


def _range_hard(rng: Random, n: int) -> Columns:
    _, low, high, a, b = _range_exam(rng, n)
    return [_near(rng, (low + high) / 2), low, high, a, b]


def _pixel_exam(rng: Random, n: int) -> Columns:
    x, z = rng.integers(-20, 21, n) / 20, rng.integers(10, 60, n) / 10
    return [np.full(n, 0.004), np.full(n, 5e-6), x, z, np.full(n, 320.0)]


def _pixel_hard(rng: Random, n: int) -> Columns:
    """Points whose pixel is next to 0: -o p z/f in short decimals."""
    f, pitch, _, z, o = _pixel_exam(rng, n)
    x = np.round(-o * pitch * z / f + 10.0 ** rng.integers(-9, -4, n), 9)
    return [f, pitch, x, z, o]


def _tail_exam(rng: Random, n: int) -> Columns:
    return [rng.integers(2, 13, n) / 4]


def _tail_hard(rng: Random, n: int) -> Columns:
    return [rng.uniform(5, 37, n)]


def _poisson_exam(rng: Random, n: int) -> Columns:
    lam = rng.integers(1, 21, n) * 5.0
    return [rng.poisson(lam).astype(np.float64), lam]


def _poisson_hard(rng: Random, n: int) -> Columns:
    lam = np.round(10 ** rng.uniform(3, 12, n))
    return [np.floor(lam + rng.uniform(-3, 3, n) * np.sqrt(lam)), lam]


def _depths_hard(rng: Random, n: int) -> Columns:
    zbar = rng.integers(5, 60, n) * 1.0
    return [_near(rng, zbar), zbar]


def _gap_exam(rng: Random, n: int) -> Columns:
    return [rng.integers(1, 5, n) / 10, rng.integers(5, 10, n) / 10]


def _gap_hard(rng: Random, n: int) -> Columns:
    a = rng.uniform(0.05, 0.95, n)
    return [a, _near(rng, a, -8, -1)]


FAMILIES = (
    Family(
        "gaussian-tail", ("k",), ("noise/gaussian_tails", "P_1"), gaussian.two_sided_tail,
        _tail_exam, _tail_hard, given={"t_1": "k", "sigma": "1"}, rational=False,
    ),
    Family(
        "thin-lens", ("f", "z"), ("optics/thin_lens", "z'"), plain.image_distance,
        _lens_exam, _lens_hard,
    ),
    Family(
        "blur-disc", ("f", "N_1", "s", "z"), ("optics/blur_disc", "c"), plain.blur_disc,
        _blur_exam, _blur_hard,
        given={"z'_s": "1/(1/f - 1/s)", "z'_p": "1/(1/f - 1/z)"},
    ),
    Family(
        "far-limit", ("f", "N", "c", "s"),
        "s*((f^2/(N*c) + f) - f)/((f^2/(N*c) + f) - s)",
        depth_of_field.far_limit, _field_exam, _field_hard,
    ),
    Family(
        "stops", ("a", "b"), "2*(log2(b) - log2(a))", plain.stops,
        lambda rng, n: [_pick(rng, _STOPS[:4], n), _pick(rng, _STOPS[4:], n)],
        _stops_hard, rational=False,
    ),
    Family(
        "inverse-distortion", ("r_d", "k_1", "k_2"), "", distortion.inverse_radius,
        _inverse_exam, _inverse_hard, rational=False,
    ),
    Family(
        "hue", ("R", "G", "B"), ("colour/rgb_to_hsv", "H"), plain.hue,
        _colour_exam, _colour_hard, whole_turn=360.0, printed=plain.hue,
    ),
    Family(
        "normalisation", ("I", "I_min", "I_max", "N_min", "N_max"),
        ("normalisation/linear_normalisation", "N_b"), plain.normalise,
        _range_exam, _range_hard,
    ),
    Family(
        "pixel", ("f", "s", "p_x", "p_z", "o_x"), ("projection/pixel_coordinates", "u"),
        projection.pixel, _pixel_exam, _pixel_hard, decimal=True,
    ),
    Family(
        "weak-perspective", ("z", "zbar"), "(1/z - 1/zbar)/(1/z)",
        plain.scale_error,
        lambda rng, n: [rng.integers(90, 99, n) / 10, rng.integers(100, 111, n) / 10],
        _depths_hard,
    ),
    Family(
        "snr-loss", ("N", "s"), "1 - (N/sqrt(N + s^2))/sqrt(N)", plain.snr_loss,
        lambda rng, n: [100.0 * rng.integers(1, 50, n), rng.integers(2, 12, n) * 1.0],
        lambda rng, n: [10 ** rng.uniform(6, 18, n), rng.uniform(1, 10, n)],
        rational=False,
    ),
    Family(
        "poisson", ("k", "lam"), "", poisson.pmf, _poisson_exam, _poisson_hard,
        rational=False,
    ),
    Family(
        "gamma-gap", ("a", "b"),
        "((a + b)/2)^(5/11) - (a^(5/11) + b^(5/11))/2", gamma.gap,
        _gap_exam, _gap_hard, tolerance=0.02, rational=False,
    ),
    Family(
        "vignetting", ("r", "f"), "1 - (1/(1 + (r/f)^2))^2", plain.falloff,
        lambda rng, n: [rng.integers(5, 22, n) * 1.0, _pick(rng, _FOCAL, n)],
        lambda rng, n: [10 ** rng.uniform(-7, -1, n), _pick(rng, _FOCAL, n)],
    ),
)  # fmt: skip
"""Every family, in the order of the page."""

BY_NAME = {family.name: family for family in FAMILIES}
