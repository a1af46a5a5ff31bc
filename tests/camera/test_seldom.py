"""Differences at few places: dark electrons, the codes they become, and the places they show in."""

import math

import numpy as np
import pytest
from scipy import stats

from quizgen.camera import Camera, Scene, View, noise
from quizgen.camera.chain import SKIP, Chain
from quizgen.camera.decision import Plan
from quizgen.camera.effects import EFFECTS, dark_current, demosaicing, quantisation
from quizgen.camera.effects.dark_current import counted
from quizgen.camera.facts import EXCEEDED, ODD, REACH, Error, Facts
from quizgen.camera.look import measured
from quizgen.camera.plan import Prepared, everything
from quizgen.camera.simulate import run

CHANCE = 1e-9


@pytest.mark.parametrize("mean", [1e-7, 1e-5, 3.5e-4, 0.003, 0.07, 0.5, 1.0, 4.0, 16.0])
def test_the_largest_count_and_the_share_of_places_with_any(mean):
    """Against the exact law at the last of 2^16 probabilities, and the electrons that are drawn."""
    largest, share = counted(mean)
    drawn = dark_current._poisson(mean, "float64")
    assert largest == stats.poisson.ppf(1 - 0.5 / noise.WORDS, mean) == drawn.max()
    assert np.count_nonzero(drawn) / noise.WORDS <= share <= stats.poisson.sf(0, mean) + 8e-6


def changed(apart, sigma, step, place):
    """Exact chance that normal luck leaves a border between two values, the borders 0, 1, 2... step."""
    borders = step * np.arange(-60, 61)
    return np.diff(stats.norm.cdf(borders[:, None] - place + [-apart, 0.0], scale=sigma)).sum()


@pytest.mark.parametrize("sigma", [0.02, 0.1, 0.25, 0.4, 0.5, 1.0, 3.0, 10.0])
@pytest.mark.parametrize("apart", [1e-3, 0.05, 0.4, 0.9])
def test_how_often_a_border_lies_between_two_values(apart, sigma):
    step = 1 / 255
    places = np.linspace(0, 1, 41)
    worst = max(changed(apart, sigma, 1.0, place) for place in places)
    bound = quantisation.between_codes(apart * step, sigma * step, step)
    assert worst <= bound
    if sigma < 0.4 and apart < 0.1:
        assert worst > 1.2 * apart  # the mean over all places would not do
    luck = np.sort(noise._normals(np.dtype(np.float64)) * sigma)
    for place in places:
        ends = np.arange(-60, 61)[:, None] - place + [-apart, 0.0]
        assert np.diff(np.searchsorted(luck, ends)).sum() <= bound * noise.WORDS


def test_without_luck_after_it_any_difference_may_lie_at_a_border():
    assert quantisation.between_codes(1e-9, 0.0, 1 / 255) == 1.0


def chain_of(prepared):
    present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
    chain = Chain(present, prepared.view, measured(prepared.stack, prepared.view))
    return chain, [effect.name for effect in present]


def without(prepared, names, bound):
    kept = tuple(step for step in everything(prepared).steps if step.effect not in names)
    return run(prepared, Plan(kept, (), (), bound, 0, 0))


def beyond(prepared, names):
    """The bound of leaving these out, and how many values differ by more."""
    chain, present = chain_of(prepared)
    bound = chain.dn({present.index(name): SKIP for name in names})
    whole, less = run(prepared, everything(prepared)), without(prepared, names, bound)
    apart = np.abs(whole.values.astype(np.float64) - less.values) * 255
    return bound, int((apart > bound + 1e-4).sum()), apart.size


def even(level, seed, size=600):
    image = np.full((size, size, 3), level, np.float32)
    return Scene(size, size, image=image, seed=seed)


def noisy(**changes):
    settings = {"full_well": 2000.0, "shot_noise": False, "shutter": 1.0, "bit_depth": 8}
    return Camera(**{**settings, "dark_current": 3e-4, "read_noise": 4.0, **changes})


@pytest.mark.parametrize("mosaic", ["", "RGGB"])
def test_seldom_electrons_with_luck_after_them_change_nothing(mosaic):
    """3 in 10 000 values have an electron, an eighth of a code; each value stands at a border."""
    prepared = Prepared(even(20.5 / 255, 1), noisy(mosaic=mosaic, dark_current=1.5e-4))
    bound, more, count = beyond(prepared, ["dark current"])
    assert bound == 0.0
    assert more > 0
    assert stats.binom.sf(more - 1, count, EXCEEDED) > CHANCE


def test_luck_that_is_left_out_as_well_hides_nothing():
    """Read noise of a fiftieth of a code: both left out may be a code, and where all stand at a border is."""
    camera = noisy(read_noise=0.15, dark_current=0.5)
    prepared = Prepared(even(20.5 / 255, 2), camera)
    bound, more, count = beyond(prepared, ["dark current", "read noise"])
    assert bound >= 1.0
    assert stats.binom.sf(more - 1, count, EXCEEDED) > CHANCE
    chain, names = chain_of(prepared)
    index = names.index("quantisation")
    error = chain.error({names.index("dark current"): SKIP, names.index("read noise"): SKIP})
    assert error.share in (0.0, pytest.approx(counted(0.5)[1]))
    assert chain.before[index].noise > 0.0


@pytest.mark.parametrize("left", [["dark current"], ["shot noise"], ["full well"]])
def test_a_pedestal_moves_both_pictures_alike(left):
    """What is seldom stays so, what goes by the light too; what a well holds back is no longer above 1."""
    camera = noisy(bias=30.0, fixed_pattern=2.0, shot_noise=True, dark_current=1.5e-4, gamma="srgb")
    ramp = np.linspace(0.0, 1.1, 600, dtype=np.float32)[:, None, None]
    scene = Scene(600, 600, image=np.broadcast_to(ramp, (600, 600, 3)).copy(), seed=6)
    bound, more, count = beyond(Prepared(scene, camera), left)
    assert stats.binom.sf(more - 1, count, EXCEEDED) > CHANCE
    assert bound < {"dark current": 1e-9, "shot noise": 70.0, "full well": 200.0}[left[0]]


def test_gain_makes_the_luck_and_the_electrons_larger_alike():
    bounds = [
        chain.error({names.index("dark current"): SKIP}).share
        for iso in (100.0, 400.0)
        for chain, names in [
            chain_of(Prepared(even(0.1, 3, 8), noisy(iso=iso, bit_depth=8 if iso == 100.0 else 6)))
        ]
    ]
    assert bounds[0] < 1e-4
    assert bounds[1] == pytest.approx(bounds[0], rel=0.05)


def test_a_column_that_shares_its_electrons_is_not_seldom():
    """Smear: all values of a column change by the mean of its electrons."""
    prepared = Prepared(
        even(20.5 / 255, 4, 60), noisy(smear=0.5, read_noise=0.0, dark_current=0.01)
    )
    bound, more, count = beyond(prepared, ["dark current"])
    assert bound >= 1.0
    assert stats.binom.sf(more - 1, count, EXCEEDED) > CHANCE


@pytest.mark.parametrize("tile", ["RGGB", "BGGR", "GRBG", "GBRG"])
@pytest.mark.parametrize("shape", [(2, 2), (3, 3), (5, 4), (7, 7), (12, 16)])
def test_how_many_values_a_photosite_shows_in(tile, shape):
    """One photosite after the other is changed, on every kind of border."""
    look = View(Scene(shape[1], shape[0]), Camera(mosaic=tile))
    shown = 0
    for place in np.ndindex(shape):
        raw = np.zeros((*shape, 1), np.float32)
        raw[place] = 1.0
        shown += np.count_nonzero(demosaicing.run(raw, look))
    error = demosaicing.carried(Error(rare=0.1, share=1e-6), Facts(0.0, 1.0, ()), look)
    assert shown / (3 * math.prod(shape)) <= error.share / 1e-6 + 1e-9
    assert shown / (3 * math.prod(shape)) > 1.0


def test_the_codes_of_several_small_differences_are_counted_once():
    """Sure, rare and lucky parts that make up less than a code are one code at most."""
    look = View(Scene(), Camera(bit_depth=8))
    step, facts = 1 / 255, Facts(0.0, 1.0, ())
    error = Error(0.3 * step, 0.05 * step, rare=0.3 * step, share=1.0)
    assert quantisation.carried(error, facts, look).total == pytest.approx(step)
    more = Error(0.3 * step, 0.2 * step, rare=0.3 * step, share=1.0)  # with luck over a code
    assert quantisation.carried(more, facts, look).total >= (0.6 + 4.15 * 0.2) * step
    assert quantisation.carried(more, facts, look).total > 1.5 * step


def test_what_is_seldom_counts_unless_it_is_seldom_enough():
    assert Error(1.0, rare=2.0, share=ODD).total == 1.0
    assert Error(1.0, 0.1, rare=2.0, share=1.1 * ODD).total == pytest.approx(3.0 + 0.1 * 4.15)
    both = Error(rare=2.0, share=0.6 * EXCEEDED).plus(Error(rare=1.0, share=0.6 * EXCEEDED))
    assert both.total == 3.0
    assert Error(rare=2.0, share=1e-6).certain == 2.0
    assert Error(rare=2.0, share=1e-6).everywhere() == Error(2.0)


def test_luck_counts_from_the_later_of_two_differences():
    early, late = Error(rare=1.0, share=0.1, dither=3.0), Error(rare=1.0, share=0.1)
    assert early.plus(late).dither == late.plus(early).dither == 0.0
    assert early.plus(Error(1.0)).dither == 3.0


def test_the_table_of_luck_ends_where_borders_are_counted():
    assert np.abs(noise._normals(np.dtype(np.float64))).max() < REACH
