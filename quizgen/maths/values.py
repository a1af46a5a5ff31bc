"""Names for the values that formulas take."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

from flint import arb, fmpq

Value: TypeAlias = fmpq | arb
"""An exact rational, or a certified ball where the value is irrational."""

Values: TypeAlias = Mapping[str, Value]
"""Quantities by name, in base units unless said otherwise."""

AnyNumber: TypeAlias = Any
"""A number of whichever number system a formula runs in: rational, ball, float, array, ...

They share operators but no static type.
"""
