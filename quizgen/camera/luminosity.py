"""Luminous efficiency of the eye: V(lambda) by day (CIE 1924), V'(lambda) by night (CIE 1951)."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

Curve = NDArray[np.float64]

PHOTOPIC_LM_PER_W = 683.0
SCOTOPIC_LM_PER_W = 1700.0

# Between the steps of 10 nm: the peak of V, and two laser lines (CIE 1924, 1 nm table).
PHOTOPIC_EXTRA = {532.0: 0.8850, 555.0: 1.0, 633.0: 0.2353}
SCOTOPIC_EXTRA = {507.0: 1.0}


@cache
def _table() -> Curve:
    text = files("quizgen.camera").joinpath("luminosity.csv").read_text("utf-8")
    rows = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
    return np.array(rows, np.float64)


@cache
def _curve(column: int) -> tuple[Curve, Curve]:
    table = _table()
    extra = (PHOTOPIC_EXTRA, SCOTOPIC_EXTRA)[column - 1]
    known = {**dict(zip(table[:, 0], table[:, column], strict=True)), **extra}
    points = sorted(known.items())
    return np.array([x for x, _ in points]), np.array([y for _, y in points])


def _read(wavelength: Any, column: int) -> Any:
    places, values = _curve(column)
    where = np.asarray(wavelength, np.float64)
    if not ((where >= places[0]) & (where <= places[-1])).all():
        raise ValueError("luminous efficiency is tabulated from 380 nm to 780 nm")
    return np.interp(where, places, values)[()]


def photopic(wavelength: Any) -> Any:
    """V(lambda), linear between tabulated values.

    Parameters
    ----------
    wavelength : float or array
        380 to 780 nm.

    Returns
    -------
    float or numpy.ndarray
        In (0, 1], 1 at 555 nm; V(700) = 0.004102 (errata E01).

    Raises
    ------
    ValueError
        Outside the table.
    """
    return _read(wavelength, 1)


def scotopic(wavelength: Any) -> Any:
    """V'(lambda), linear between tabulated values, 1 at 507 nm; otherwise as `photopic`."""
    return _read(wavelength, 2)
