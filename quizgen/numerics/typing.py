"""Names of the types that pass between the functions of this package."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

Numbers = npt.ArrayLike
"""What the public functions take: a number, a list, an array."""

FloatOrArray = Any
"""What they return: a float for scalar arguments, else an array (masked without an answer)."""

Array = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.intp]
Counts = npt.NDArray[np.int64]

ArrayLike = Array | tuple[Array, ...]
"""A block of the result, or one block of every result."""

Limits = tuple[float, float]
"""Least and largest value of a block (NaN when there is one)."""

ArrayFormula = Callable[..., ArrayLike]
"""A formula on blocks; a block of one element stands for all elements."""

Exact = Callable[..., Any]
"""The same quantity for fractions; returns fractions, or floats that stand for themselves."""
