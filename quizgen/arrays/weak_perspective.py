"""Relative error of the scale when all depths are replaced by one.

Source: (f/z - f/zbar)/(f/z) = (zbar - z)/zbar; the left side subtracts nearly equal scales.
"""

from __future__ import annotations

from quizgen.arrays.aliases import Numbers, Result
from quizgen.arrays.domain import POSITIVE
from quizgen.arrays.kernel import Kernel

_OF_TRUE = Kernel(lambda z, zbar: (zbar - z) / zbar, (POSITIVE, POSITIVE))
_OF_WEAK = Kernel(lambda z, zbar: (zbar - z) / z, (POSITIVE, POSITIVE))


def scale_error(z: Numbers, zbar: Numbers) -> Result:
    """Error of the weak-perspective scale relative to the true scale, (zbar - z)/zbar.

    Parameters
    ----------
    z, zbar : array_like
        Depth of the point and mean depth, > 0, same unit.

    Returns
    -------
    float or array
        Pure number below 1; positive when the point is nearer than zbar.
    """
    return _OF_TRUE(z, zbar)


def scale_error_of_weak(z: Numbers, zbar: Numbers) -> Result:
    """The same difference of scales relative to the weak-perspective scale, (zbar - z)/z.

    Parameters
    ----------
    z, zbar : array_like
        Depth of the point and mean depth, > 0, same unit.

    Returns
    -------
    float or array
        Pure number above -1.
    """
    return _OF_WEAK(z, zbar)
