"""One plain line of NumPy per formula, without a look at its arguments: what accuracy itself costs.

Where a line keeps its digits on hard inputs too, nothing more is needed; what it gives where there
is no answer (a pole, a grey) is not defined.
"""

from __future__ import annotations

import numpy as np

from quizgen.tradeoff.rung import Column


def image_distance(f: Column, z: Column) -> Column:
    """Image distance of a thin lens; z - f is exact where the digits are at stake."""
    return f * (z / (z - f))


def blur_disc(f: Column, N: Column, s: Column, z: Column) -> Column:
    """Diameter of the blur disc of a point at z, focused at s."""
    return (f / N) * (f / (s - f)) * (np.abs(z - s) / z)


def stops(a: Column, b: Column) -> Column:
    """Stops between two f-numbers whose quotient is a double."""
    more: Column = b - a  # over the smaller one: over the larger the digits would go near -1
    return np.copysign(np.log1p(np.abs(more) / np.minimum(a, b)), more) * (2 / np.log(2))


def scale_error(z: Column, zbar: Column) -> Column:
    """Relative error of weak perspective."""
    return (zbar - z) / zbar


def snr_loss(N: Column, s: Column) -> Column:
    """Share of the signal-to-noise ratio lost to read noise."""
    return -np.expm1(-0.5 * np.log1p(s * s / N))


def falloff(r: Column, f: Column) -> Column:
    """Light lost at r from the centre: 1 - cos^4."""
    sine = r / np.hypot(r, f)  # squares of r and f might leave the range
    p = sine * sine
    return p * (2 - p)


def hue(R: Column, G: Column, B: Column) -> Column:
    """Hue in degrees, as textbooks write it; a grey has none."""
    most = np.maximum(np.maximum(R, G), B)
    span = most - np.minimum(np.minimum(R, G), B)
    sector = np.where(most == R, (G - B) / span, (B - R) / span + 2)
    sector = np.where((most == B) & (most != R) & (most != G), (R - G) / span + 4, sector)
    return 60 * np.where(sector < 0, sector + 6, sector)


def normalise(I: Column, low: Column, high: Column, a: Column, b: Column) -> Column:  # noqa: E741
    """Intensities to a .. b; for whole intensities the numerator is exact."""
    return (b * (I - low) - a * (I - high)) / (high - low)
