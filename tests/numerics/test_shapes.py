"""Every array function takes what NumPy functions take, and leaves it alone."""

from __future__ import annotations

import numpy as np
import pytest
from find_worst import SPACES
from functions import function
from sweep import together

from quizgen.numerics import ufunc

COUNT = 12
CLOSE = 2e-15
"""Longer and shorter ways may differ by a few units in the last place."""


def drawn(name):
    rng = np.random.default_rng(23)
    rows = [SPACES[name](rng) for _ in range(COUNT)]
    columns = [np.array(column, dtype=np.float64) for column in zip(*rows, strict=True)]
    for column in columns:
        column.flags.writeable = False
    return columns


def filled(result):
    return np.ma.filled(result, 0.0)


@together("name", SPACES)
def test_any_shape(name):
    call, columns = function(name), drawn(name)
    base = filled(call(*columns))
    spread = call(*[np.repeat(c.reshape(3, 4), 2, axis=1)[:, ::2] for c in columns])
    np.testing.assert_allclose(filled(spread).ravel(), base, rtol=CLOSE)
    assert call(*[c[:0] for c in columns]).shape == (0,)
    np.testing.assert_allclose(filled(call(*[c[:1] for c in columns])), base[:1], rtol=CLOSE)
    np.testing.assert_allclose(filled(call(*[c.tolist() for c in columns])), base, rtol=CLOSE)
    assert call(*[np.full(7, c[0]) for c in columns]).shape == (7,)


@pytest.mark.parametrize("name", [n for n in SPACES if len(drawn(n)) > 1])
def test_arguments_broadcast(name):
    call, (first, *others) = function(name), drawn(name)
    base = filled(call(first, *others))
    grid = filled(call(first[:, None], *[c[None, :] for c in others]))
    assert grid.shape == (COUNT, COUNT)
    np.testing.assert_allclose(grid.diagonal(), base, rtol=CLOSE)


@pytest.mark.parametrize("name", SPACES)
def test_any_length(name):
    """Around the length of a block, and with a last block of one element."""
    call, columns = function(name), drawn(name)
    base = filled(call(*columns))
    for length in (ufunc.BLOCK, ufunc.BLOCK + 1):
        values = filled(call(*[np.resize(c, length) for c in columns]))
        np.testing.assert_allclose(values, np.resize(base, length), rtol=CLOSE)
