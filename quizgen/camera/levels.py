"""Plans by brightness: what a tile of the picture needs depends on how dark it is.

A tone curve spreads what is added in the dark up to a dozen times, and far less in the light. From
the first noise on, when all that follows looks at a pixel and its neighbours alone, a plan may
therefore leave out more where a tile and what is beside it are bright. The bounds are those of the
whole picture, with a range that does not begin at its darkest value.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from typing import NamedTuple

from msgspec.structs import replace

from quizgen.camera.blocks import Image, Tile, tiles
from quizgen.camera.chain import EXACT, SKIP, Chain
from quizgen.camera.decision import NO_LEVELS, Level, Levels, Unit
from quizgen.camera.effect import PointByPoint
from quizgen.camera.facts import Error
from quizgen.camera.spending import Choice, Costs, spend_more

LEVELS = tuple(2.0**-stops for stops in range(1, 9))
"""Darkest values from which on a tile may need less, 1 = white."""
LEAST_MS = 50.0
"""What the effects that a tile could do without must take for that to be tried: deciding takes
about 1 ms, and few tiles of a small picture are bright all over."""


class _Tail(NamedTuple):
    """The effects from the first noise on: what is known, decided and still to be decided."""

    chain: Chain
    """Of the whole picture, all effects."""
    first: int
    around: int
    """How far around they look, px."""
    arrived: Error
    known: Choice
    """Counted from the first, like the members of the units."""
    free: tuple[Unit, ...]

    def where(self, level: float) -> Chain:
        """The same effects of what is at least so bright.

        The picture that is measured has the error that has arrived, the one it is compared with
        has not.
        """
        chain, first = self.chain, self.first
        facts = chain.before[first]
        facts = replace(facts, low=max(facts.low, level - self.arrived.certain))
        return Chain(chain.present[first:], chain.view, facts, chain.views[first:], self.arrived)


def by_brightness(
    chain: Chain,
    choice: Choice,
    units: tuple[Unit, ...],
    costs: Costs,
    budget: float,
) -> Levels:
    """What more is left out in bright tiles, from dark to bright.

    Parameters
    ----------
    chain : Chain
        Of the whole picture.
    choice : dict of int to str
        What is made of each effect where nothing more is known.
    units : tuple of Unit
    costs : list of dict
        Of each effect, by the way it is made, ms.
    budget : float
        Grey levels.
    """
    tail = _tail(chain, choice, units, costs)
    if tail is None or not tail.arrived.total < LEVELS[0]:
        return NO_LEVELS
    each = _each(tail, costs[tail.first :], budget)
    return Levels(chain.present[tail.first].name, tail.around, tuple(reversed(each)))


def _each(tail: _Tail, costs: Costs, budget: float) -> list[Level]:
    """From bright to dark: what is darker can do without no more."""
    each: list[Level] = []
    more = tail.known
    for level in LEVELS:
        if level - tail.arrived.certain > tail.chain.before[tail.first].high:
            continue
        bright = tail.where(level)
        if more == tail.known or bright.dn(more) > budget:
            more = spend_more(bright, tail.free, costs, tail.known, budget)
        if more == tail.known:
            break
        ways = {bright.present[i].name: made for i, made in more.items() if made != tail.known[i]}
        if each and each[-1].ways == ways:
            each.pop()
        each.append(Level(level, ways, bright.dn(more)))
    return each


def _tail(chain: Chain, choice: Choice, units: tuple[Unit, ...], costs: Costs) -> _Tail | None:
    """The effects from the first noise on, if they are dear and it is known how far each looks."""
    first = next((i for i, effect in enumerate(chain.present) if effect.random), None)
    if first is None:
        return None
    free = tuple(_free(chain, choice, units, first))
    if sum(costs[first + i][EXACT] for unit in free for i in unit.members) < LEAST_MS:
        return None
    arounds = [effect.around for effect in chain.present[first:]]
    if None in arounds:
        return None
    known = {i - first: made for i, made in choice.items() if i >= first}
    around = sum(around for around in arounds if around)
    return _Tail(chain, first, around, chain.error(choice, first), known, free)


def _free(chain: Chain, choice: Choice, units: tuple[Unit, ...], first: int) -> Iterator[Unit]:
    """What a tile may still do without: effects that work on it alone."""
    for unit in units:
        if unit.fixed or unit.members[0] < first or choice[unit.members[0]] == SKIP:
            continue
        if all(isinstance(chain.present[i].run, PointByPoint) for i in unit.members):
            yield replace(unit, members=tuple(i - first for i in unit.members))


def by_level(picture: Image, levels: Levels) -> list[list[Tile]]:
    """The tiles of a picture: those darker than the first level, then those of each.

    What a pixel comes to be is made of its neighbours, whose errors are made of theirs: so far
    around, and as far again, a tile counts as dark as the darkest place.
    """
    limits, far = [level.above for level in levels.each], 2 * levels.around
    found: list[list[Tile]] = [[] for _ in range(len(limits) + 1)]
    for tile in tiles(picture.shape):
        rows, columns = (slice(max(part.start - far, 0), part.stop + far) for part in tile.place)
        found[bisect_right(limits, float(picture[rows, columns].min()))].append(tile)
    return found
