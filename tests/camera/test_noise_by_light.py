"""Noise by the light of its place: how dark it gets, and what a tone curve makes of it."""

import math

import numpy as np
import pytest
from scipy import stats

from quizgen.camera import Camera, Scene, View
from quizgen.camera.chain import SKIP, Chain
from quizgen.camera.effects import EFFECTS, dark_current, read_noise, shot_noise
from quizgen.camera.facts import DEVIATIONS, Error, Facts, LayerFacts
from quizgen.camera.look import measured
from quizgen.camera.plan import Prepared


def test_counts_of_each_place_against_its_own_deviation():
    """Where the brightest has many electrons, every darker place keeps to its own root."""
    well = 1e6
    error = shot_noise.skipped(Facts(0.0, 1.0, ()), View(Scene(), Camera(full_well=well)))
    luck = np.linspace(-5, 5, 201)
    for mean in np.append(np.geomspace(1e-3, well, 400), np.linspace(0.1, 60, 600)):
        high = stats.poisson.isf(stats.norm.sf(luck), mean)
        low = stats.poisson.ppf(stats.norm.cdf(luck), mean)
        off = np.abs(np.where(luck > 0, high, low) - mean)
        assert (off <= well * (error.sure + error.deviation(mean / well) * np.abs(luck))).all(), (
            mean
        )
    few = shot_noise.skipped(Facts(0.0, 10.0 / well, ()), View(Scene(), Camera(full_well=well)))
    assert few.root == 0.0


@pytest.mark.parametrize("electrons", [0.0, 0.3, 2.0, 7.0, 30.0, 100.0, 3000.0])
@pytest.mark.parametrize("read", [0.0, 0.5, 3.0, 20.0])
def test_no_place_gets_darker_than_the_bottom(electrons, read):
    """Whatever is brighter than the darkest place: exact counts, with read noise beside them."""
    well = 1e4
    look = View(Scene(), Camera(full_well=well, read_noise=read, shutter=1.0, dark_current=2.0))
    facts = shot_noise.after(Facts(electrons / well, 1.0, ()), look)
    facts = read_noise.after(dark_current.after(facts, look), look)
    for mean in electrons + np.append(0.0, np.geomspace(0.1, 3000.0, 40)):
        counts = np.arange(int(mean + 12 * math.sqrt(mean) + 30))
        below = facts.bottom * well - counts
        share = stats.norm.cdf(below / read) if read else below > 0
        assert stats.poisson.pmf(counts, mean) @ share < 7e-6, mean
    if electrons > 1000 and read < 5:
        assert facts.bottom * well > electrons - 5.5 * math.sqrt(electrons)


def test_counts_lie_less_than_an_electron_below_what_the_normal_law_says():
    luck = np.linspace(-6, 0, 121)
    for mean in np.geomspace(1e-3, 1e6, 400):
        gap = mean + luck * math.sqrt(mean) - stats.poisson.ppf(stats.norm.cdf(luck), mean)
        assert gap.max() < 1.0


def test_what_the_converter_would_clip_is_no_more_than_the_darkest_places_noise():
    """Light from a tenth to all of the well: far from black, though white is noisy."""
    camera = Camera(full_well=1000.0, read_noise=5.0, bit_depth=12, gamma="srgb")
    image = np.broadcast_to(np.linspace(0.1, 0.5, 64, dtype=np.float32)[:, None, None], (64, 64, 3))
    prepared = Prepared(Scene(64, 64, image=image.copy()), camera)
    present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
    chain = Chain(present, prepared.view, measured(prepared.stack, prepared.view))
    facts = chain.before[[effect.name for effect in present].index("quantisation")]
    exact = stats.norm.ppf(7e-6, 100, math.hypot(math.sqrt(100), 5)) / 1000
    assert exact - 3 / 1000 < facts.bottom < exact
    assert facts.outside(0.0, 2.0).total == 0.0


def srgb(light):
    """IEC 61966-2-1, in grey levels."""
    light = np.clip(light, 0.0, 1.0)
    above = 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
    return 255 * np.where(light <= 0.0031308, 12.92 * light, above)


@pytest.mark.parametrize(("well", "read", "low"), [(1e3, 0.0, 0.0), (2e4, 0.0, 0.0), (2e4, 9.0, 0.0), (2e4, 3.0, 0.05), (1e5, 0.0, 0.3)])  # fmt: skip
def test_shot_noise_that_is_left_out_before_a_tone_curve_counts_by_its_own_level(well, read, low):
    """Exact counts of every level; read noise stays in both, as low as 4.15 deviations."""
    camera = Camera(full_well=well, read_noise=read, gamma="srgb")
    prepared = Prepared(Scene(8, 8, background=(0.5, 0.5, 0.5)), camera)
    present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
    chain = Chain(present, prepared.view, Facts(low, 1.0, (LayerFacts((0.0, 0.0), (0.0, 0.0)),)))
    bound = chain.dn({0: SKIP})
    luck, worst = np.linspace(-DEVIATIONS, DEVIATIONS, 101), 0.0
    for level in np.append(low, np.geomspace(max(low, 1e-5), 1.0, 200)):
        mean = level * well
        counts = np.where(
            luck > 0,
            stats.poisson.isf(stats.norm.sf(luck), mean),
            stats.poisson.ppf(stats.norm.cdf(luck), mean),
        )
        for beside in (0.0, -DEVIATIONS * read / well):
            apart = np.abs(srgb(counts / well + beside) - srgb(level + beside))
            worst = max(worst, apart.max())
    assert worst <= bound < 4 * worst
    flat = 255 * (chain.off(0, SKIP).sure + DEVIATIONS / math.sqrt(well))
    assert bound < srgb(low + flat / 255) - srgb(low)


def test_the_root_of_the_light_follows_gains_sums_and_clips():
    """A deviation of 0.1 sqrt(x), times 4 where x is four times as large; cut light was brighter."""
    error = Error(0.0, 0.1, root=0.1)
    assert error.deviation(0.25) == pytest.approx(0.05)
    assert error.amplified(4.0, 4.0).deviation(1.0) == pytest.approx(4 * 0.05)
    assert error.amplified(1.0, 4.0).deviation(1.0) >= max(0.1, 4 * 0.05)
    assert error.amplified(1.0, 4.0).deviation(0.01) >= 0.1 * math.sqrt(0.01)
    both = error.plus(Error(0.0, 0.02))
    assert both.deviation(0.25) >= math.hypot(0.05, 0.02)
    assert both.deviation(0.25) <= 0.05 + 0.02
    assert error.along(Error(0.0, 0.02)).deviation(0.25) == pytest.approx(0.07)
    bright = Error(0.0, 0.2, root=0.1)  # up to four times white, with 0.2 there
    assert bright.capped(4.0).deviation(1.0) == pytest.approx(0.2)
    assert error.everywhere() == Error(0.0, 0.1)
