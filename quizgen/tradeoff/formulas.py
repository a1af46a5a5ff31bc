"""Fourteen printed formulas of the chapter, each with what makes it difficult and how near that is.

The distance to the difficulty is what a formula's subtraction leaves of 1: with 10^-6 left, six of
sixteen digits are gone. Undistorting subtracts nothing that counts: there it is that to the fold.
"""

# ruff: noqa: ARG005 - every column of a formula has its name

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import array_system, compile_expr
from quizgen.maths.tree import Expr, substitute
from quizgen.numerics.distortion import inverse_radius
from quizgen.numerics.gaussian import inverse_upper_tail
from quizgen.tradeoff import lines
from quizgen.tradeoff.lines import Column

Random = np.random.Generator
Columns = Sequence[Column]
_HARDEST = 1e-15


@dataclass(frozen=True)
class Shown:
    """What the slider of a formula moves, and both ways of writing it as HTML."""

    symbol: str
    unit: str
    value: Callable[..., Column]
    printed: str
    stable: str


@dataclass(frozen=True)
class Formula:
    """One formula of the page: how it is printed, stably computed and made difficult.

    Parameters
    ----------
    name : str
        Its title stands in ``tradeoff.toml``.
    names : str
        Quantities, in the order of the columns.
    source : str or tuple
        The printed formula in the grammar, or a solver and a quantity of its chain.
    exam : callable
        Random generator and count to columns as an exam draws them.
    left : callable
        Columns to the distance to the difficulty, at most 1.
    path : callable
        The way back: distances to columns.
    easiest : float
        Where the path starts.
    stable : callable, optional
        A way of computing that keeps its digits.
    printed : callable, optional
        The printed formula on columns where the grammar cannot say it.
    decimal : bool
        Whether inputs mean the decimals that they print as.
    turn : float
        360 for angles, whose error is judged on the circle.
    shown : Shown, optional
        For the eight that the slider offers.
    """

    name: str
    names: str
    source: str | tuple[str, str]
    exam: Callable[[Random, int], Columns]
    left: Callable[..., Column]
    path: Callable[[Column], Columns]
    easiest: float = 0.9
    stable: Callable[..., Column] | None = None
    printed: Callable[..., Column] | None = None
    decimal: bool = False
    turn: float = 0.0
    shown: Shown | None = None

    @cached_property
    def tree(self) -> Expr:
        """The printed formula; for a chain, one formula from what is given."""
        if isinstance(self.source, str):
            return parse_formula(self.source)
        from quizgen.bank.bank import builtin_bank

        solver, quantity = self.source
        known: dict[str, Expr] = {}
        for step in builtin_bank().chain(solver)[0].steps:
            known[step.name] = substitute(step.expr, known)
        return known[quantity]

    def compute(self, columns: Columns, bits: int = 64) -> Column:
        """Return the printed formula in floating point of 64 or 32 bits."""
        number = np.float32 if bits == 32 else np.float64
        given = [column.astype(number) for column in columns]
        if self.printed is not None:
            return self.printed(*given)
        compiled = compile_expr(self.tree, array_system(bits))
        found: Column = compiled(dict(zip(self.names.split(), given, strict=True)))
        return found

    def places(self, count: int) -> Column:
        """Return distances to the difficulty along the path, from easy to hard."""
        return np.geomspace(self.easiest, _HARDEST, count)


def _fill_column(value: float, like: Column) -> Column:
    """Return a column of one value, as long as another column."""
    return np.full(like.size, value)


def _pick_values(rng: Random, values: tuple[float, ...], count: int) -> Column:
    """Return random picks of the values."""
    return rng.choice(np.array(values), count)


_FOCAL = (24.0, 28.0, 35.0, 50.0, 85.0, 100.0)
_STOPS = (1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0)
_K1 = -0.2
_FOLD = 2 / (3 * math.sqrt(-3 * _K1))
"""The largest distorted radius."""
_H = 50 + 2500 / 0.24
"""Hyperfocal distance of 50 mm, f/8 and 0.03 mm."""


def _draw_lens_inputs(rng: Random, n: int) -> Columns:
    """Return random f and z (mm) of a thin lens, as an exam draws them."""
    f = _pick_values(rng, _FOCAL, n)
    return [f, f * rng.integers(3, 40, n) / 2]


def _draw_blur_inputs(rng: Random, n: int) -> Columns:
    """Return random f, N, s and z (mm) of a blur disc, as an exam draws them."""
    s = 100.0 * rng.integers(10, 60, n)
    z = s * rng.integers(3, 19, n) / 10 + 50
    return [_pick_values(rng, _FOCAL, n), _pick_values(rng, _STOPS, n), s, z]


def _draw_field_inputs(rng: Random, n: int) -> Columns:
    """Return random f, N, c and s (mm) of a depth of field, as an exam draws them."""
    f = _pick_values(rng, _FOCAL, n)
    return [f, _pick_values(rng, _STOPS, n), _fill_column(0.03, f), f * rng.integers(10, 40, n) / 2]


def _draw_colour_inputs(rng: Random, n: int) -> Columns:
    """Return random R, G and B, different tenths from 0 to 1, as an exam draws them."""
    return list((np.array([rng.permutation(11)[:3] for _ in range(n)]) / 10).T.copy())


def _draw_range_inputs(rng: Random, n: int) -> Columns:
    """Return random grey levels with the range they are stretched from, and that to, -1 to 1."""
    low, high = 10.0 * rng.integers(0, 6, n), 10.0 * rng.integers(15, 26, n)
    level = low + rng.integers(5, 95, n)
    return [level, low, high, _fill_column(-1, low), _fill_column(1, low)]


def _draw_pixel_inputs(rng: Random, n: int) -> Columns:
    """Return random f, pitch, x, z (m) and o (px) of points that are in the picture."""
    x, z = rng.integers(-6, 21, n) / 20, rng.integers(10, 60, n) / 10
    return [_fill_column(0.004, x), _fill_column(5e-6, x), x, z, _fill_column(320, x)]


def _draw_count_inputs(rng: Random, n: int) -> Columns:
    """Return random Poisson counts and their means, as an exam draws them."""
    lam = rng.integers(1, 21, n) * 5.0
    return [rng.poisson(lam).astype(np.float64), lam]


def _solve_mean_count(left: Column) -> Column:
    """Return the whole m for which left m ln m = 1: the count whose logarithms lose so much."""
    mean = 1 / left
    for _ in range(60):
        mean = 1 / (left * np.log(mean))
    return np.floor(mean)


def _textbook_poisson(k: Column, lam: Column) -> Column:
    """Return the Poisson probability of k for mean lam, as textbooks write it."""
    return np.exp(k * np.log(lam) - lam - _log_gamma(k + 1).astype(k.dtype))


_log_gamma = np.vectorize(math.lgamma, otypes=[np.float64])


def _make_blur_inputs(left: Column) -> Columns:
    """Return f, N, s, z with z ever closer to s: ``left`` is the distance to the difficulty."""
    f, N, s = (_fill_column(value, left) for value in (50, 2.8, 3000))
    return [f, N, s, f * s * (1 - left) / (f - left * s)]


def _make_grey_inputs(left: Column) -> Columns:
    """Return R, G, B ever closer to a grey."""
    R, B = _fill_column(0.5, left), 0.5 * (1 - left)
    return [R, (R + B) / 2, B]


def _make_gap_inputs(left: Column) -> Columns:
    """Return two intensities ever closer to each other."""
    d = np.sqrt(left / 0.15)
    return [0.5 * (1 - d), 0.5 * (1 + d)]


def _make_loss_inputs(left: Column) -> Columns:
    """Return N and s with an ever smaller loss of signal-to-noise ratio."""
    return [25 / np.expm1(-2 * np.log1p(-left)), _fill_column(5, left)]


def _make_corner_inputs(left: Column) -> Columns:
    """Return r and f with an ever smaller fall-off of light."""
    p = left / (1 + np.sqrt(1 - left))
    return [50 * np.sqrt(p / (1 - p)), _fill_column(50, left)]


FORMULAS = (
    Formula(
        "thin-lens",
        "f z",
        "1/(1/f - 1/z)",
        _draw_lens_inputs,
        lambda f, z: (z - f) / z,
        lambda u: [_fill_column(50, u), 50 / (1 - u)],
        stable=lines.image_distance,
        shown=Shown("z − f", "mm", lambda f, z: z - f, "1/(1/f − 1/z)", "f z/(z − f)"),
    ),
    Formula(
        "gaussian-tail",
        "k",
        "1 - erf(k/sqrt(2))",
        lambda rng, n: [rng.integers(2, 13, n) / 4],
        lines.two_sided_tail,
        lambda u: [inverse_upper_tail(u / 2)],
        stable=lines.two_sided_tail,
        shown=Shown("k", "", lambda k: k, "1 − erf(k/√2)", "erfc(k/√2)"),
    ),
    Formula(
        "blur-disc",
        "f N s z",
        "f/N*abs(1/(1/f - 1/s) - 1/(1/f - 1/z))/(1/(1/f - 1/z))",
        _draw_blur_inputs,
        lambda f, N, s, z: np.abs(f * (z - s) / (s * (z - f))),
        _make_blur_inputs,
        0.012,
        stable=lines.blur_disc,
        shown=Shown(
            "z − s",
            "mm",
            lambda f, N, s, z: z - s,
            "f/N · |s′ − z′|/z′",
            "f/N · f/(s − f) · |z − s|/z",
        ),
    ),
    Formula(
        "far-limit",
        "f N c s",
        "s*((f^2/(N*c) + f) - f)/((f^2/(N*c) + f) - s)",
        _draw_field_inputs,
        lambda f, N, c, s: 1 - s / (f + f * f / (N * c)),
        lambda u: [_fill_column(50, u), _fill_column(8, u), _fill_column(0.03, u), _H * (1 - u)],
        stable=lines.far_limit,
        shown=Shown(
            "H − s",
            "mm",
            lambda f, N, c, s: f + f * f / (N * c) - s,
            "s (H − f)/(H − s)",
            "s f²/(f² − N c (s − f))",
        ),
    ),
    Formula(
        "inverse-distortion",
        "r k",
        "",
        lambda rng, n: [_FOLD * rng.uniform(0.05, 0.5, n), np.full(n, _K1)],
        lambda r, k: 1 - r / (2 / (3 * np.sqrt(-3 * k))),
        lambda u: [_FOLD * (1 - u), _fill_column(_K1, u)],
        stable=inverse_radius,
        printed=lines.fixed_point,
        shown=Shown(
            "1 − r/fold",
            "",
            lambda r, k: 1 - r / _FOLD,
            "r ← r<sub>d</sub>/(1 + k₁r²), × 5",
            "r + k₁r³ = r<sub>d</sub>",
        ),
    ),
    Formula(
        "snr-loss",
        "N s",
        "1 - (N/sqrt(N + s^2))/sqrt(N)",
        lambda rng, n: [100.0 * rng.integers(1, 50, n), rng.integers(2, 12, n) * 1.0],
        lines.snr_loss,
        _make_loss_inputs,
        stable=lines.snr_loss,
        shown=Shown("N", "e⁻", lambda N, s: N, "1 − √N/√(N + s²)", "−expm1(−½ log1p(s²/N))"),
    ),
    Formula(
        "gamma-gap",
        "a b",
        "((a + b)/2)^(5/11) - (a^(5/11) + b^(5/11))/2",
        lambda rng, n: [rng.integers(1, 5, n) / 10, rng.integers(5, 10, n) / 10],
        lambda a, b: lines.gamma_gap(a, b) / ((a + b) / 2) ** (5 / 11),
        _make_gap_inputs,
        0.1,
        stable=lines.gamma_gap,
        shown=Shown(
            "b − a",
            "",
            lambda a, b: b - a,
            "((a + b)/2)^(1/γ) − (a^(1/γ) + b^(1/γ))/2",
            "−m^(1/γ) (expm1(p) + 2 eᵖ sinh²(q/2))",
        ),
    ),
    Formula(
        "vignetting",
        "r f",
        "1 - (1/(1 + (r/f)^2))^2",
        lambda rng, n: [rng.integers(5, 22, n) * 1.0, _pick_values(rng, _FOCAL, n)],
        lines.falloff,
        _make_corner_inputs,
        stable=lines.falloff,
        shown=Shown("r", "mm", lambda r, f: r, "1 − cos⁴θ", "p (2 − p), p = r²/(r² + f²)"),
    ),
    Formula(
        "stops",
        "a b",
        "2*(log2(b) - log2(a))",
        lambda rng, n: [_pick_values(rng, _STOPS[1:4], n), _pick_values(rng, _STOPS[4:], n)],
        lambda a, b: np.log2(b / a) / np.log2(b),
        lambda u: [_fill_column(4, u), 4 ** (1 / (1 - u))],
        0.7,
    ),
    Formula(
        "hue",
        "R G B",
        ("colour/rgb_to_hsv", "H"),
        _draw_colour_inputs,
        lambda *rgb: 1 - np.min(rgb, axis=0) / np.max(rgb, axis=0),
        _make_grey_inputs,
        printed=lines.hue,
        turn=360.0,
    ),
    Formula(
        "normalisation",
        "I low high a b",
        "(I - low)*(b - a)/(high - low) + a",
        _draw_range_inputs,
        lambda I, low, high, a, b: np.abs((2 * I - low - high) / (high - low)),  # noqa: E741
        lambda u: [
            100 + 60 * u,
            _fill_column(40, u),
            _fill_column(160, u),
            _fill_column(-1, u),
            _fill_column(1, u),
        ],
    ),
    Formula(
        "pixel",
        "f s x z o",
        "1/s*f*(x/z) + o",
        _draw_pixel_inputs,
        lambda f, s, x, z, o: np.minimum(np.abs(1 + f * x / (s * z * o)), 1),
        lambda u: [
            _fill_column(0.004, u),
            _fill_column(5e-6, u),
            0.8 * (u - 1),
            _fill_column(2, u),
            _fill_column(320, u),
        ],
        stable=lines.pixel,
        decimal=True,
    ),
    Formula(
        "weak-perspective",
        "z zbar",
        "(1/z - 1/zbar)/(1/z)",
        lambda rng, n: [rng.integers(90, 99, n) / 10, rng.integers(100, 111, n) / 10],
        lambda z, zbar: 1 - z / zbar,
        lambda u: [10 * (1 - u), _fill_column(10, u)],
    ),
    Formula(
        "poisson",
        "k lam",
        "",
        _draw_count_inputs,
        lambda k, lam: 1 / np.maximum(k * np.log(lam), 1),
        lambda u: [_solve_mean_count(u), _solve_mean_count(u)],
        0.2,
        printed=_textbook_poisson,
    ),
)
"""The eight of the slider first."""

BY_NAME = {formula.name: formula for formula in FORMULAS}
