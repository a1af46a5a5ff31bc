"""Random numbers for data: streams that never change.

``numpy.random.Generator`` may give other numbers in a later NumPy, ``RandomState`` may not (NEP
19). So this one serves the few methods that an author's ``data.py`` gets and that ``[draw]``
uses, seeded from the SHA-256 of what every other draw is a function of.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

Size = int | tuple[int, ...] | None


class FrozenGenerator:
    """A generator whose numbers are a function of a key alone, on any machine and for good.

    Parameters
    ----------
    key : str
        What is drawn and for which try.

    Notes
    -----
    Methods and arguments are those of ``numpy.random.Generator``; there are no others.
    """

    def __init__(self, key: str) -> None:
        import numpy as np

        words = np.frombuffer(hashlib.sha256(key.encode()).digest(), dtype=">u4")
        self._state = np.random.RandomState(words.astype(np.uint32))

    def random(self, size: Size = None) -> Any:
        """Return floats from 0 to below 1."""
        return self._state.random_sample(size)

    def uniform(self, low: float = 0.0, high: float = 1.0, size: Size = None) -> Any:
        """Return floats from ``low`` to below ``high``."""
        return self._state.uniform(low, high, size)

    def normal(self, loc: float = 0.0, scale: float = 1.0, size: Size = None) -> Any:
        """Return normally distributed floats with this mean and standard deviation."""
        return self._state.normal(loc, scale, size)

    def integers(self, low: int, high: int | None = None, size: Size = None) -> Any:
        """Return whole numbers from ``low`` to below ``high``, or from 0 to below ``low``."""
        found = self._state.randint(low, high, size, dtype="int64")
        return int(found) if size is None else found

    def choice(self, a: Any, size: Size = None, replace: bool = True, p: Any = None) -> Any:
        """Return elements of a list, or whole numbers below ``a``."""
        return self._state.choice(a, size, replace, p)

    def permutation(self, x: Any) -> np.ndarray[Any, Any]:
        """Return the elements in another order."""
        return self._state.permutation(x)

    def shuffle(self, x: Any) -> None:
        """Put the elements of a list into another order, in place."""
        self._state.shuffle(x)

    def poisson(self, lam: float = 1.0, size: Size = None) -> Any:
        """Return whole numbers of a Poisson distribution."""
        return self._state.poisson(lam, size)

    def binomial(self, n: int, p: float, size: Size = None) -> Any:
        """Return whole numbers of a binomial distribution."""
        return self._state.binomial(n, p, size)

    def exponential(self, scale: float = 1.0, size: Size = None) -> Any:
        """Return floats of an exponential distribution with this mean."""
        return self._state.exponential(scale, size)

    def multinomial(self, n: int, pvals: Any, size: Size = None) -> Any:
        """Return how often each of several outcomes comes in ``n`` trials."""
        return self._state.multinomial(n, pvals, size)
