"""No warning, no NaN, no hang for any finite input: the full range of doubles, hypothesis."""

from __future__ import annotations

import math
import warnings
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from functions import function
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from oracle import FORMULAS
from ulp import ulps

from quizgen.arrays import bayer, statistics, stops
from quizgen.arrays.domain import DomainError, answered

ANY = st.floats(allow_nan=False, allow_infinity=False)
EDGES = st.sampled_from([0.0, -0.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 1.0])
NEAR_ONE = st.integers(-4, 4).map(lambda n: 1 + n * 2**-52)
UNIT = st.floats(0, 1)
NUMBER = st.one_of(ANY, ANY.map(abs), EDGES, NEAR_ONE, UNIT)
ARGUMENTS = {name: formula.__code__.co_argcount for name, formula in FORMULAS.items()}
ARGUMENTS |= {"projection.pixel": 5, "hsv.red": 3, "hsv.green": 3, "hsv.blue": 3}
OTHERS = {
    "stops.nominal": (stops.nominal, 1),
}
CASES = {name: (function(name), count) for name, count in ARGUMENTS.items()} | OTHERS


def columns(values):
    return list(values) if isinstance(values, tuple) else [values]


@pytest.mark.parametrize("name", CASES)
@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_any_finite_input(name, data):
    call, count = CASES[name]
    args = data.draw(st.tuples(*[NUMBER] * count))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        values = columns(call(*[np.array([arg, 1.0]) for arg in args]))
        try:
            scalars = columns(call(*args))
        except DomainError as error:
            refused = error.reason
        else:
            refused = ""
    if refused:
        assert refused != "not-finite"
        assert not all(answered(value)[0] for value in values)
        return
    for value, scalar in zip(values, scalars, strict=True):
        assert answered(value)[0]
        assert not math.isnan(scalar)
        assert float(value[0]) == scalar or abs(float(value[0]) - scalar) <= 8 * math.ulp(scalar)


@settings(max_examples=100, deadline=None)
@given(st.lists(ANY, min_size=1, max_size=30))
def test_statistics_of_anything(values):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        centre = statistics.mean(values)
        spread = statistics.variance(values, ddof=0)
    assert min(values) - math.ulp(min(values)) <= centre <= max(values) + math.ulp(max(values))
    assert spread >= 0


RNG = np.random.default_rng(7)
NOISE = RNG.normal(0, 3, 5000)
IMAGES = {
    **{f"offset {offset:g}": offset + NOISE for offset in (0, 1e6, 1e8, 1e12, 1e15, -1e15)},
    "bytes": RNG.integers(0, 256, (60, 70), dtype=np.uint8),
    "bright 16 bit": RNG.integers(60000, 60010, (60, 70), dtype=np.uint16),
    "float32": (1e6 + NOISE).astype(np.float32),
    "both signs": np.concatenate([NOISE, -NOISE, [1e-9]]),
    "cancels": np.array([1e16, 1.0, -1e16, 3.0]),
    "one bright": np.append(np.ones(3000), 1e9),
    "constant": np.full(3000, 0.1),
    "huge": 1e150 * (NOISE + 9),
    "tiny": 1e-150 * NOISE,
}


@pytest.mark.parametrize("name", IMAGES)
def test_statistics_of_images(name):
    """Against exact fractions: a large offset, cancellation, small integers."""
    image = IMAGES[name]
    exact = [Fraction(float(value)) for value in image.ravel()]
    centre = sum(exact) / len(exact)
    spread = sum((value - centre) ** 2 for value in exact) / (len(exact) - 1)
    with mp.workdps(45):
        for value, truth in (
            (statistics.mean(image), centre), (statistics.variance(image), spread),
        ):  # fmt: skip
            assert ulps(value, mp.mpf(truth.numerator) / truth.denominator) <= 4


@given(st.lists(st.integers(0, 255), min_size=1, max_size=4))
def test_bayer_mean_of_bytes(values):
    sites = [np.array([value], dtype=np.uint8) for value in values]
    exact = sum(values) / len(values)
    assert bayer.neighbour_mean(*sites)[0] == exact
    assert bayer.neighbour_mean(*sites, rule="half-up")[0] == math.floor(exact + 0.5)
    assert bayer.neighbour_mean(*sites, rule="half-even")[0] == round(exact)
    assert bayer.neighbour_mean(*sites, rule="down")[0] == int(exact)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["thin_lens.image_distance", "gaussian.upper_tail", "snr.snr"])
def test_not_finite_is_named(name, value):
    call, count = CASES[name]
    with pytest.raises(DomainError, match="not-finite"):
        call(*[value] * count)
