"""Gamma: linear light encoded for display."""

from __future__ import annotations

import math

from msgspec.structs import replace

from quizgen.camera.blocks import Work
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint, Rung
from quizgen.camera.facts import CERTAIN, DEVIATIONS, REACH, Error, Facts
from quizgen.camera.power import CURVE_ERROR, TABLE, by_table, encode_number, encoder
from quizgen.camera.settings import Rule, Setting, Settings
from quizgen.camera.values import number
from quizgen.camera.view import View


def _read(value: object) -> str | float:
    return str(value) if value in ("srgb", "linear") else number(value)


def _known(gamma: str | float, _: Settings) -> bool:
    if isinstance(gamma, str):
        return gamma in ("linear", "srgb")
    return 1.0 <= gamma <= 100.0


GAMMA = Setting[str | float](
    "gamma", _read, "linear", (Rule(_known, "must be 'linear', 'srgb' or a number from 1 to 100"),)
)


def work(view: View, rung: str = "") -> Work:
    """Encode linear light for display; clips to [0, 1]. The rung ``table`` rounds to 16 bits."""
    if rung == "table":
        return by_table(view.camera[GAMMA], view.precision)
    return encoder(view.camera[GAMMA], view.precision)


def _gap(width: float, bottom: float, view: View) -> float:
    """Largest difference after encoding of values that differ by at most ``width``.

    Tone curves are concave, so the gap is largest at the dark end.
    """
    start, gamma = max(0.0, bottom), view.camera[GAMMA]
    return encode_number(start + width, gamma) - encode_number(start, gamma)


def skipped(facts: Facts, view: View) -> Error:
    """Largest distance of the curve from the diagonal over the range, and what it clips."""
    low, high = max(0.0, min(facts.bottom, 1.0)), min(1.0, max(facts.top, 0.0))
    gamma = view.camera[GAMMA]
    # a concave curve is farthest from the diagonal where it is as steep, or at the nearest end
    farthest = min(max(low, _as_steep(gamma)), high)
    gap = encode_number(farthest, gamma) - farthest
    return facts.outside(0.0, 1.0).plus(Error(gap + CURVE_ERROR))


def _as_steep(gamma: str | float) -> float:
    """Where a tone curve rises as steeply as the diagonal."""
    if gamma == "srgb":
        return (1.055 / 2.4) ** (2.4 / 1.4)
    exponent = float(gamma)
    return math.exp(-exponent / (exponent - 1.0) * math.log(exponent))


def table(facts: Facts, view: View) -> Error:
    """Half a step of the table, spread most at the dark end."""
    half = 0.5 / TABLE + 1e-7
    return Error(_gap(half, facts.bottom - half, view))


def _spread(error: Error, bottom: float, view: View) -> Error:
    """An error after encoding."""
    sure, sigma = _ends(error.total, error.sigma, bottom, view.camera[GAMMA])
    return replace(error, sure=sure, sigma=sigma)


def _ends(far: float, sigma: float, bottom: float, gamma: str | float) -> tuple[float, float]:
    """What is sure and what is random of an error after encoding.

    Above a concave curve lies its tangent where the error ends. With a chord instead, small luck
    would be spread by more than its share.
    """
    start = max(0.0, bottom)
    dark = encode_number(start, gamma)
    total = encode_number(start + far, gamma) - dark
    if not sigma:
        return total, 0.0
    shorter = encode_number(start + far * (1.0 - _SHORT), gamma) - dark
    slope = (total - shorter) / (far * _SHORT)
    return total - slope * DEVIATIONS * sigma + CURVE_ERROR, slope * sigma


_SHORT = 2.0**-10


def carried(error: Error, facts: Facts, view: View) -> Error:
    """The darkest values are spread most, of all or of those in the light; both are clipped."""
    error = error.clipped()
    bottom, bare = facts.bottom - error.certain, _bare(error)
    spread = _spread(bare, bottom, view)
    if bare is error:
        return spread
    if error.root:
        spread = _by_level(error, facts, view, spread)
    bright = _gap(error.bright, error.level, view) if error.bright else 0.0
    rare = _gap(error.rare, bottom, view) + CURVE_ERROR if error.rare else 0.0
    return replace(spread, sure=spread.sure + bright, rare=rare, level=math.inf)


def _bare(error: Error) -> Error:
    """What is everywhere and as large as it may be."""
    if not error.bright and not error.rare and not error.root:
        return error
    return replace(error, bright=0.0, rare=0.0, flat=0.0, root=0.0)


def _by_level(error: Error, facts: Facts, view: View, least: Error) -> Error:
    """An error that grows with the light after encoding, which spreads it less there.

    From bright to dark, up to where the value with all its noise may be black, unless that gives no
    less than what is known already. One picture lacks the noise that grows: what carries it down is
    no more than at the darkest place, and the other one is no farther below it than the error.
    """
    (tail, noise), gamma, bare = facts.down, view.camera[GAMMA], _bare(error)
    own = tail + REACH * noise
    everywhere, elsewhere = bare.total - DEVIATIONS * bare.sigma, error.certain
    elsewhere -= CERTAIN * error.sigma
    bottom, limit, enough = facts.bottom, facts.limits[1], least.total
    light, most, sure, sigma = facts.high, error.deviation(facts.high), 0.0, 0.0
    while sure + DEVIATIONS * sigma < enough:
        dark = light / _APART
        lowest = max(bottom, min(dark - own, limit))
        certain = elsewhere + CERTAIN * most
        last = lowest - certain <= 0.0 or dark <= facts.low
        start = (bottom if last else lowest) - certain
        ends = _ends(everywhere + DEVIATIONS * most, most, start, gamma)
        sure, sigma = max(sure, ends[0]), max(sigma, ends[1])
        if last:
            found = replace(bare, sure=sure, sigma=sigma)
            return min(least, found, key=lambda way: way.total)
        light, most = dark, error.deviation(dark)
    return least


_APART = 1.5
"""How many times as bright one end of a range of values is as the other."""


def after(facts: Facts, view: View) -> Facts:
    """Encoded range; steps as far as the dark end spreads them."""
    gamma, bottom = view.camera[GAMMA], facts.bottom
    low, high = encode_number(facts.low, gamma), encode_number(facts.high, gamma)
    jump = (_gap(facts.jump[0], bottom, view), _gap(facts.jump[1], bottom, view))
    noise = _spread(Error(facts.tail, facts.noise), bottom, view)
    limits = encode_number(facts.limits[0], gamma), encode_number(facts.limits[1], gamma)
    return Facts(low, high, facts.layers, noise.sigma, noise.sure, limits).with_jump(jump)


EFFECT = Effect(
    name="gamma",
    stage="processing",
    decides=("gamma",),
    settings=(GAMMA,),
    present=lambda view: view.camera[GAMMA] not in ("linear", 1.0),
    run=PointByPoint(work),
    cost=measured((1.8, 86), table=(1.52, 76.5)),
    skipped=skipped,
    carried=carried,
    knows_where=True,
    after=after,
    rungs=(Rung("table", table),),
)
