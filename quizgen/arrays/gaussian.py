"""The Gaussian: density, tails, intervals, far out as well as at the centre.

Sources: Abramowitz & Stegun, Handbook of Mathematical Functions (1964), chapter 26; how the
values are computed stands in ``gaussian_kernels``.
"""

from __future__ import annotations

from quizgen.arrays import gaussian_kernels as kernels
from quizgen.arrays.aliases import Numbers, Result
from quizgen.arrays.domain import NONNEGATIVE, POSITIVE, REAL, Rule, Span
from quizgen.arrays.kernel import Kernel, Short

_CORRELATION = Span(low=-1.0, high=1.0, reason="not-a-correlation", closed=True)
_PDF = Kernel(
    kernels.pdf,
    (REAL, REAL, POSITIVE),
    short=Short(kernels.pdf_near_centre, 2.0**300, tiny=True, fits=kernels.near_centre),
)
_UPPER = Kernel(kernels.upper_tail, (REAL,))
_BOTH = Kernel(kernels.two_sided, (REAL,))
_LOG = Kernel(kernels.log_tail, (REAL,))
_INVERSE = Kernel(kernels.inverse_tail, (Span(low=0.0, high=1.0, reason="not-a-probability"),))
_INTERVAL = Kernel(kernels.interval, (REAL, REAL), (Rule("reversed", lambda a, b: b < a),))
_EXPECTED = Kernel(kernels.expected, (NONNEGATIVE, NONNEGATIVE))
_DETERMINANT = Kernel(kernels.determinant, (POSITIVE, POSITIVE, _CORRELATION))
_PEAK_2D = Kernel(kernels.peak, (POSITIVE, POSITIVE, _CORRELATION))


def pdf(x: Numbers, mu: Numbers = 0.0, sigma: Numbers = 1.0) -> Result:
    """Density exp(-(x - mu)**2/(2 sigma**2))/(sqrt(2 pi) sigma).

    Parameters
    ----------
    x, mu, sigma : array_like
        Same unit; sigma > 0.

    Returns
    -------
    float or array
        Per unit of x.
    """
    return _PDF(x, mu, sigma)


def upper_tail(k: Numbers) -> Result:
    """Probability Q(k) that a standard normal value exceeds k.

    Parameters
    ----------
    k : array_like
        Standard deviations, either sign.

    Returns
    -------
    float or array
        Between 0 and 1; rounds to 0 above 38.57 (use ``log_tail``).
    """
    return _UPPER(k)


def two_sided_tail(k: Numbers) -> Result:
    """Probability that a standard normal value is farther than k from 0.

    Parameters
    ----------
    k : array_like
        Standard deviations; the answer is 1 when negative.

    Returns
    -------
    float or array
        Between 0 and 1.
    """
    return _BOTH(k)


def log_tail(k: Numbers) -> Result:
    """Natural logarithm of Q(k), also where Q(k) itself is below the smallest double.

    Parameters
    ----------
    k : array_like
        Standard deviations, either sign.

    Returns
    -------
    float or array
        At most 0; minus infinity where -k**2/2 exceeds the range.
    """
    return _LOG(k)


def inverse_tail(p: Numbers) -> Result:
    """The k with Q(k) = p.

    Parameters
    ----------
    p : array_like
        Probability, 0 < p < 1.

    Returns
    -------
    float or array
        Standard deviations.

    Raises
    ------
    DomainError
        ``not-a-probability``.
    """
    return _INVERSE(p)


def interval(a: Numbers, b: Numbers) -> Result:
    """Probability that a standard normal value lies between a and b.

    Parameters
    ----------
    a, b : array_like
        Standard deviations, a <= b; far out and narrow is fine.

    Returns
    -------
    float or array
        Between 0 and 1; at most 8 units in the last place off.

    Raises
    ------
    DomainError
        ``reversed`` (b < a).
    """
    return _INTERVAL(a, b)


def expected_beyond(pixels: Numbers, k: Numbers) -> Result:
    """Expected number of pixels farther than k standard deviations from the mean.

    Parameters
    ----------
    pixels : array_like
        Number of pixels, >= 0.
    k : array_like
        Standard deviations, >= 0.

    Returns
    -------
    float or array
        Expected count, not rounded.
    """
    return _EXPECTED(pixels, k)


def determinant(s1: Numbers, s2: Numbers, rho: Numbers) -> Result:
    """Determinant s1**2 s2**2 (1 - rho**2) of a 2-D covariance matrix.

    Parameters
    ----------
    s1, s2 : array_like
        Standard deviations, > 0.
    rho : array_like
        Correlation, -1 to 1.

    Returns
    -------
    float or array
        Product of the squared units.

    Raises
    ------
    DomainError
        ``not-a-correlation``.
    """
    return _DETERMINANT(s1, s2, rho)


def peak_2d(s1: Numbers, s2: Numbers, rho: Numbers = 0.0) -> Result:
    """Largest density 1/(2 pi s1 s2 sqrt(1 - rho**2)) of a 2-D Gaussian.

    Parameters
    ----------
    s1, s2, rho : array_like
        As for ``determinant``.

    Returns
    -------
    float or array
        Per product of the units; infinity at the pole rho = -1 or 1.

    Raises
    ------
    DomainError
        ``not-a-correlation``.
    """
    return _PEAK_2D(s1, s2, rho)
