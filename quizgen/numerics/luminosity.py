"""Luminous efficiency of the eye by day and by night.

Sources: CIE 018 (V(lambda), V'(lambda), linear between table points, zero outside).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quizgen.numerics.domain import NONNEGATIVE, Array, FloatOrArray, Numbers
from quizgen.numerics.tables import read_numeric_table
from quizgen.numerics.ufunc import StableUfunc


class EfficiencyTable(NamedTuple):
    """A table of luminous efficiency: first wavelength and step in whole nm, and the values."""

    first: int
    step: int
    values: Array

    def interpolate(self, wavelength: Array) -> Array:
        """Return the efficiency (0 to 1) at wavelengths in nm, linear between points, 0 outside.

        Two positive terms with exact factors: nothing cancels.
        """
        last = self.step * (self.values.size - 1)
        above = np.clip(wavelength - self.first, 0, last)
        # Differences of whole numbers and wavelengths are exact; a quotient by the step is not.
        i = np.minimum((above / self.step).astype(np.intp), self.values.size - 2)
        i -= above < i * self.step
        t = above - i * self.step
        value = (self.values[i] * (self.step - t) + self.values[i + 1] * t) / self.step
        return np.where((wavelength >= self.first) & (above == wavelength - self.first), value, 0.0)


_CIE, _STEP, _PEAK = read_numeric_table("cie.json"), 5, 507


def _build_night_table() -> EfficiencyTable:
    """Return V'(lambda) at every nanometre, as its peak lies between two points of the table."""
    values = _CIE["night"]
    at = 380 + _STEP * np.arange(len(values))
    peak = np.searchsorted(at, _PEAK)
    points = np.insert(at, peak, _PEAK), np.insert(values, peak, 1.0)
    every = np.arange(at[0], at[-1] + 1)
    return EfficiencyTable(int(at[0]), 1, np.interp(every, *points))


DAY = EfficiencyTable(360, _STEP, np.array(_CIE["day"]))
"""V(lambda), CIE 1924: every 5 nm from 360 to 830 nm."""

NIGHT = _build_night_table()
"""V'(lambda), CIE 1951: every 5 nm from 380 to 780 nm, and the peak at 507 nm."""


def luminous_efficiency(wavelength: Numbers, curve: EfficiencyTable = DAY) -> FloatOrArray:
    """Return the luminous efficiency, 0 to 1, of light of one wavelength.

    Parameters
    ----------
    wavelength : array_like
        Nanometres, >= 0.
    curve : EfficiencyTable
        The table, by default that of the eye by day.

    Returns
    -------
    float or array
        0 to 1; linear between table points, 0 outside.
    """
    return StableUfunc(curve.interpolate, (NONNEGATIVE,))(wavelength)
