"""What bounds need to know of a picture, and the arithmetic of errors.

A `Facts` holds upper bounds only: range, largest step (jump) and largest second difference (bend)
per layer, and the random part. Effects turn the facts of their input into facts of their output,
so every bound is computed without running anything.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable

import msgspec
from msgspec.structs import replace

EXCEEDED = 1e-4
"""Share of values by which a bound on something random may be exceeded."""

DEVIATIONS = 4.15
"""Standard deviations of a normal value exceeded with probability 3.4e-5, two-sided.

Noise that is clipped and then joined by other noise exceeds them 1.16 times as often. The rest of
`EXCEEDED` is for single values of which nothing is known (`ODD`), and for three noises out of
their `REACH`.
"""
_NORMAL = 3.9e-5
"""Share of values for which deviations account."""

REACH = 4.5
"""Standard deviations exceeded with probability 7e-6: how far noise carries a value."""

ODD = 4e-5
"""Share of values that may be anything besides, more by `_NORMAL` where nothing is random."""

CERTAIN = 5.0
"""Standard deviations exceeded with probability 6e-7: where a random part decides what is clipped,
or several values decide together, so that deviations can no longer be added in quadrature."""

BEYOND_CERTAIN = 1e-6
"""Share of values beyond `CERTAIN` deviations, clipped noise beside other noise included."""

COLUMN = 6.5
"""Deviations by which the mean size of any column's normal values misses its expectation, times
the root of their number: once in 10^9 columns."""

LARGEST = 1e30
"""Signals beyond this are no picture."""
UNLIMITED = (-LARGEST, LARGEST)


class Error(msgspec.Struct, frozen=True, gc=False):
    """How far two pictures can be apart: a sure part and a random part, 1 = white.

    Parameters
    ----------
    sure : float
        Bound on the difference of the means.
    sigma : float
        Bound on the standard deviation of a normal value that the rest is a share of.
    flat, root : float
        Where ``root`` is not 0, that deviation is no more than ``flat + root sqrt(x)`` either, at a
        place with the noise-free value x in the one of the two pictures that has everything.
    odd : float
        Share of values of which nothing of this is true.
    beyond : float
        By how much more one picture may stand beyond 0 or 1: between the two pictures clipped to
        [0, 1], the other parts are bounds on their own.
    bright : float
        Bound on what comes on top where both pictures are at least as bright as ``level``.
    level : float
        Infinite where nothing comes on top.
    rare : float
        Bound on what comes on top at few places, and nothing at all elsewhere.
    share : float
        Chance of that at each place, whatever the luck that comes later.
    dither : float
        Standard deviation of the normal luck that has come since, the same in both pictures.

    No error is ever negative; what cannot be computed is infinite.
    """

    sure: float = 0.0
    sigma: float = 0.0
    odd: float = 0.0
    beyond: float = 0.0
    bright: float = 0.0
    level: float = math.inf
    rare: float = 0.0
    share: float = 0.0
    dither: float = 0.0
    flat: float = 0.0
    root: float = 0.0

    def __post_init__(self) -> None:
        if self.sure >= 0.0 and self.sigma >= 0.0 and self.beyond >= 0.0 and self.bright >= 0.0:
            return
        for part in ("sure", "sigma", "beyond", "bright"):
            value = getattr(self, part)
            known = math.inf if math.isnan(value) else max(0.0, value)
            msgspec.structs.force_setattr(self, part, known)

    @property
    def total(self) -> float:
        """Difference exceeded by at most the share `EXCEEDED` of the values."""
        if self.odd or self.rare:
            return self._total_with_few()
        return self.sure + self.beyond + self.bright + DEVIATIONS * self.sigma

    def _total_with_few(self) -> float:
        allowed = ODD + (0.0 if self.sigma else _NORMAL)
        if self.odd > allowed:
            return math.inf
        rare = self.rare if self.odd + self.share > allowed else 0.0
        return self.sure + self.beyond + self.bright + rare + DEVIATIONS * self.sigma

    @property
    def certain(self) -> float:
        """Difference that all but 6e-7 of the values keep, however they are mixed afterwards."""
        return self.sure + self.beyond + self.bright + self.rare + CERTAIN * self.sigma

    def plus(self, other: Error) -> Error:
        """Both errors of different luck: random parts add in quadrature."""
        return self._with(other, math.hypot)

    def along(self, other: Error) -> Error:
        """Both errors of the same luck: random parts add."""
        return self._with(other, operator.add)

    def more(self, by: float) -> Error:
        """With so much more that is sure, everywhere."""
        return replace(self, sure=self.sure + by)

    def wider(self, sigma: float) -> Error:
        """With so much more noise of the same luck."""
        flat = self.flat + sigma if self.root else 0.0
        return replace(self, sigma=self.sigma + sigma, flat=flat)

    def _with(self, other: Error, added: Callable[[float, float], float]) -> Error:
        sure, sigma = self.sure + other.sure, added(self.sigma, other.sigma)
        both = Error(sure, sigma, self.odd + other.odd, self.beyond + other.beyond)
        if self.bright or other.bright:
            level = min(self.level, other.level)
            both = replace(both, bright=self.bright + other.bright, level=level)
        if self.rare or other.rare:
            rare, share = self.rare + other.rare, self.share + other.share
            dither = min([error.dither for error in (self, other) if error.rare])
            both = replace(both, rare=rare, share=share, dither=dither)
        if self.root or other.root:
            flat = added(*[one.flat if one.root else one.sigma for one in (self, other)])
            both = replace(both, flat=flat, root=added(self.root, other.root))
        return both

    def times(self, factor: float) -> Error:
        """Scaled by a factor >= 0, wherever it is."""
        error = self.everywhere()
        return Error(error.sure * factor, error.sigma * factor, error.odd)

    def amplified(self, least: float, most: float) -> Error:
        """After gains >= 0: what is beyond 1 stays there if none of them makes anything darker."""
        error = self if least >= 1.0 else self.within()
        sure, sigma, beyond = error.sure * most, error.sigma * most, error.beyond * most
        level = error.level * least if error.bright else math.inf
        bright = error.bright * most
        more = Error(sure, sigma, error.odd, beyond, bright, level)
        if error.rare:
            rare, dither = error.rare * most, error.dither * least
            more = replace(more, rare=rare, share=error.share, dither=dither)
        if error.root:
            more = replace(more, flat=error.flat * most, root=error.root * math.sqrt(most))
        return more

    def everywhere(self) -> Error:
        """What may stand beyond 0 or 1, in the light or at few places counts like all else."""
        if not self.beyond and not self.bright and not self.rare and not self.root:
            return self
        return Error(self.sure + self.beyond + self.bright + self.rare, self.sigma, self.odd)

    def within(self) -> Error:
        """What may stand beyond 0 or 1 counts like all else."""
        return replace(self, sure=self.sure + self.beyond, beyond=0.0) if self.beyond else self

    def deviation(self, value: float) -> float:
        """Largest standard deviation where the noise-free value is at most this one."""
        if not self.root:
            return self.sigma
        return min(self.sigma, self.flat + self.root * math.sqrt(max(0.0, value)))

    def capped(self, high: float) -> Error:
        """After what was at most so bright without noise is cut at 1."""
        return replace(self, root=self.root * math.sqrt(high)) if self.root and high > 1.0 else self

    def clipped(self) -> Error:
        """After both pictures are clipped to [0, 1]."""
        return replace(self, beyond=0.0) if self.beyond else self

    def rounded(self, by: float) -> Error:
        """With what single precision adds where the pictures differ: equal values stay equal."""
        if self.sure or self.sigma:
            return replace(self, sure=self.sure + by)
        error = replace(self, rare=self.rare + by) if self.rare else self
        if self.bright:
            return replace(error, bright=self.bright + by)
        return replace(error, beyond=self.beyond + by) if self.beyond else error


def _share_beyond(room: float, noise: float) -> float:
    """Share of normal values above a limit, which is 0 at least."""
    return math.erfc(max(0.0, room) / noise / math.sqrt(2.0)) / 2.0 if noise else float(room < 0.0)


def mean_size(sigma: float, count: int) -> float:
    """Bound on the mean size of so many normal values: their expectation, and by how much more.

    A mean of sizes changes by at most 1/sqrt(count) per step in the space of all values, so it is
    as concentrated as a single normal value of that deviation.
    """
    return sigma * (math.sqrt(2.0 / math.pi) + COLUMN / math.sqrt(count))


NO_ERROR = Error()


Limits = tuple[float, float]


class LayerFacts(msgspec.Struct, frozen=True, gc=False):
    """Largest step and bend of a layer along x and y, as they can show in the finished stack."""

    jump: tuple[float, float]
    bend: tuple[float, float]

    def times(self, x: float, y: float) -> LayerFacts:
        """Steps scaled along x and y; second differences become at most two steps."""
        jump = self.jump[0] * x, self.jump[1] * y
        return LayerFacts(jump, (2 * jump[0], 2 * jump[1]))


class Facts(msgspec.Struct, frozen=True, gc=False):
    """Upper bounds on a picture.

    Parameters
    ----------
    low, high : float
        Range of the noise-free values, 1 = white.
    layers : tuple of LayerFacts
        One per layer of the stack, a single one after it is flattened.
    noise : float
        Largest standard deviation of the random part.
    tail : float
        How far the random part may lie beyond any multiple of that: electrons are counted, and
        counts are not normal.
    limits : (float, float)
        Values that nothing exceeds, noise included, since a photosite or a converter clipped them;
        what noise came later is in it.
    rounded : float
        Share by which single precision may have carried a value beyond all this.
    dip : (float, float), optional
        As ``tail`` and ``noise``, of how far below ``low`` a value is carried: what is brighter
        may be noisier, but gets no lower. The same as above where nothing is known.
    """

    low: float
    high: float
    layers: tuple[LayerFacts, ...]
    noise: float = 0.0
    tail: float = 0.0
    limits: Limits = UNLIMITED
    rounded: float = 0.0
    dip: tuple[float, float] | None = None

    @property
    def span(self) -> float:
        """Largest minus smallest value."""
        return self.high - self.low

    @property
    def reach(self) -> float:
        """How far noise carries a value (all but 7e-6 of them)."""
        return self.tail + REACH * self.noise

    @property
    def down(self) -> tuple[float, float]:
        """Tail and deviation by which noise carries values below the smallest."""
        return (self.tail, self.noise) if self.dip is None else self.dip

    @property
    def top(self) -> float:
        """Largest value including noise."""
        (low, high), far = self.limits, self.high + self.reach
        return high if far > high else max(far, low)

    @property
    def bottom(self) -> float:
        """Smallest value including noise."""
        (low, high), (tail, noise) = self.limits, self.dip or (self.tail, self.noise)
        far = self.low - tail - REACH * noise
        return low if far < low else min(far, high)

    @property
    def size(self) -> float:
        """Largest magnitude of a noise-free value."""
        low, high = self.low, self.high
        return high if 0.0 <= low <= high else max(abs(low), abs(high))

    @property
    def jump(self) -> tuple[float, float]:
        """Largest step of the flattened picture along x and y."""
        span = self.high - self.low
        if len(self.layers) == 1:
            across, down = self.layers[0].jump
        else:
            across = sum(layer.jump[0] for layer in self.layers)
            down = sum(layer.jump[1] for layer in self.layers)
        if across <= span and down <= span:
            return across, down
        return min(across, span), min(down, span)

    @property
    def bend(self) -> tuple[float, float]:
        """Largest second difference of the flattened picture along x and y."""
        steps = self.jump
        if len(self.layers) > 1:
            return 2 * steps[0], 2 * steps[1]
        bend = self.layers[0].bend
        return min(bend[0], 2 * steps[0]), min(bend[1], 2 * steps[1])

    def flat(self) -> Facts:
        """Facts of the flattened stack."""
        if len(self.layers) == 1:
            (across, down), bend = self.layers[0].jump, self.layers[0].bend
            steps = across <= (span := self.high - self.low) and down <= span
            if steps and bend[0] <= 2 * across and bend[1] <= 2 * down:
                return self
        return replace(self, layers=(LayerFacts(self.jump, self.bend),))

    def stepped(self, x: float, y: float) -> Facts:
        """Every layer's steps scaled."""
        return replace(self, layers=tuple(layer.times(x, y) for layer in self.layers))

    def scaled(self, factor: float) -> Facts:
        """Everything times a factor >= 0."""
        layers = tuple(
            LayerFacts(
                (layer.jump[0] * factor, layer.jump[1] * factor),
                (layer.bend[0] * factor, layer.bend[1] * factor),
            )
            for layer in self.layers
        )
        ends = self.low * factor, self.high * factor
        limits = self.limits[0] * factor, self.limits[1] * factor
        noise, tail = self.noise * factor, self.tail * factor
        dip = None if self.dip is None else (self.dip[0] * factor, self.dip[1] * factor)
        return Facts(*ends, layers, noise, tail, limits, dip=dip)

    def gained(self, least: float, most: float) -> Facts:
        """Every channel times a factor of its own, >= 0, between the least and the most."""
        low = min(self.low * least, self.low * most)
        high = max(self.high * least, self.high * most)
        limits = min(self.limits[0] * least, self.limits[0] * most), self.limits[1] * most
        return replace(self.scaled(most), low=low, high=high, limits=limits)

    def lifted(self, by: float) -> Facts:
        """Everything brighter by a value, darker if it is negative."""
        limits = self.limits[0] + by, self.limits[1] + by
        return replace(self, low=self.low + by, high=self.high + by, limits=limits)

    def outside(self, low: float, high: float) -> Error:
        """What stands beyond two values: how far, or how seldom if that is seldom enough."""
        far = max(self.top - high, low - self.bottom, 0.0)
        if not far or not self.noise:
            return Error(far)
        tail, noise = self.down
        odd = _share_beyond(high - self.high - self.tail, self.noise)
        odd += _share_beyond(min(self.low - tail - low, REACH * noise), noise)
        return Error(odd=odd) if odd < ODD else Error(far)

    def just_above(self, limit: float) -> float:
        """How far above a limit rounding alone carries what should end there or below."""
        slack = self.rounded * max(self.size, abs(self.top))
        return slack if limit - slack < self.top <= limit else 0.0

    def between(self, low: float, high: float) -> Facts:
        """Clipped, noise and all."""
        low, high = max(low, self.limits[0]), min(high, self.limits[1])
        return replace(self, limits=(low, high))

    def amplified(self, factor: float) -> Error:
        """What a gain that is off by a factor >= 0 changes: value and noise alike."""
        noisy = Error(self.size + self.tail, self.noise)
        most = Error(max(-self.limits[0], self.limits[1]))
        return min(noisy, most, key=lambda error: error.total).times(factor)

    def in_columns(self, height: int) -> float:
        """Largest mean of a column, noise included."""
        return self.size + self.tail + mean_size(self.noise, height)

    def with_jump(self, jump: tuple[float, float]) -> Facts:
        """One layer with these steps and whatever bends they allow."""
        return replace(self, layers=(LayerFacts(jump, (2 * jump[0], 2 * jump[1])),))
