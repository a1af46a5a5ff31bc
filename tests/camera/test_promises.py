"""What a plan promises about noise, scene by scene, and each bound against exact tails."""

import math

import noisy_at_random as at_random
import numpy as np
import pytest
from scipy import stats
from sweep import draws

from quizgen.camera import Camera, Scene, SceneError, View, noise
from quizgen.camera.chain import SKIP, Chain
from quizgen.camera.decision import Plan, Step
from quizgen.camera.effects import (
    EFFECTS,
    dark_current,
    distortion,
    full_well,
    lateral_colour,
    rolling_shutter,
    shot_noise,
)  # fmt: skip
from quizgen.camera.facts import (  # fmt: skip
    CERTAIN,
    DEVIATIONS,
    EXCEEDED,
    NO_ERROR,
    ODD,
    REACH,
    Error,
    Facts,
    mean_size,
)
from quizgen.camera.look import measured
from quizgen.camera.plan import Prepared, _units, everything, plan
from quizgen.camera.simulate import Photo, is_broken, run

CHANCE = 1e-9
SCENES = [
    pytest.param(0, 200),
    pytest.param(200, draws(1500), marks=pytest.mark.slow),
]


def apart(one, other):
    return np.abs(one.values.astype(np.float64) - other.values) * 255


def bad_luck(beyond, count):
    """Chance that a kept promise is missed as often, over all scenes at most `CHANCE` each."""
    return stats.binom.sf(beyond - 1, count, EXCEEDED) if beyond else 1.0


def chosen(source, prepared):
    """Plans of several budgets, and each effect left out alone."""
    for budget in 10 ** source.uniform(-1, 2, 2):
        yield plan(prepared, budget=float(budget))
    present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
    chain = Chain(present, prepared.view, measured(prepared.stack, prepared.view))
    for unit in _units(present, frozenset()):
        made = unit.choices[source.integers(1, len(unit.choices))]
        choice = dict.fromkeys(unit.members, made)
        bound = chain.dn(choice)
        if bound < 255:
            ways = [(effect.name, choice.get(i, "")) for i, effect in enumerate(present)]
            steps = tuple(Step(name, way, "", 0, 0) for name, way in ways if way != SKIP)
            yield Plan(steps, (), (), bound, 0, 0)


@pytest.mark.parametrize(("first", "last"), SCENES)
def test_noise_keeps_its_promise_in_every_scene(first, last):
    for seed in range(first, last):
        source = np.random.default_rng([seed, 77])
        prepared = Prepared(at_random.scene(source), at_random.camera(source))
        whole = run(prepared, everything(prepared))
        for what in chosen(source, prepared):
            assert 0 <= what.predicted_error_dn < math.inf, seed
            beyond = apart(run(prepared, what), whole) > what.predicted_error_dn + 1e-4
            chance = bad_luck(int(beyond.sum()), beyond.size)
            assert chance > CHANCE, (seed, [s.effect for s in what.steps], beyond.sum())


def share_beyond(bound, mean):
    """Exact share of counts whose distance from their mean is larger than a bound, in electrons."""
    high = stats.poisson.sf(math.floor(mean + bound), mean)
    low = stats.poisson.cdf(math.ceil(mean - bound) - 1, mean)
    return high + low


@pytest.mark.parametrize("mean", [1e-3, 0.01, 0.03, 0.1, 0.5, 1.0, 3.0, 20.0, 300.0, 1e5])
def test_skipped_shot_noise_against_the_exact_law(mean):
    well = 2 * mean if mean > 1 else 1.0
    look = View(Scene(), Camera(full_well=well))
    facts = Facts(0.0, mean / well, ())
    assert share_beyond(shot_noise.skipped(facts, look).total * well, mean) < EXCEEDED
    assert share_beyond(shot_noise.skipped(facts, look).certain * well, mean) < 1e-6
    dark = View(Scene(), Camera(full_well=well, shutter=1.0, dark_current=mean))
    lost = dark_current.skipped(facts, dark).total * well
    assert stats.poisson.sf(math.floor(lost), mean) < EXCEEDED


@pytest.mark.parametrize("mean", [0.0, 1e-3, 0.1, 1.0, 3.0, 12.0, 100.0, 1e4])
@pytest.mark.parametrize("more", [1e-4, 0.03, 1.0, 7.0, 1e3])
def test_another_signal_has_other_counts_by_no_more_than_said(mean, more):
    """Counts of the same luck, against the exact law's quantiles."""
    well = 1e6
    look = View(Scene(), Camera(full_well=well))
    facts = Facts(mean / well, (mean + more) / well, ())
    error = shot_noise.carried(Error(more / well), facts, look)
    luck = np.linspace(-6, 6, 121)
    counts = [
        np.where(luck > 0, stats.poisson.isf(stats.norm.sf(luck), m), stats.poisson.ppf(stats.norm.cdf(luck), m))
        for m in (max(mean, 1e-12), mean + more)
    ]  # fmt: skip
    bound = (error.sure + error.sigma * np.abs(luck)) * well
    assert (counts[1] - counts[0] <= bound + 1e-9).all()


@pytest.mark.parametrize("most", [1e-9, 1e-5, 0.01, 0.3, 0.9, 2.5, 7.0, 15.9, 16.0, 400.0])
def test_counts_of_every_darker_place_exceed_their_mean_by_no_more(most):
    """Any luck up to 5 deviations, any mean up to the brightest one: quantiles of the exact law."""
    luck = np.linspace(-5, 5, 101)
    gap = noise.poisson_gap(most)
    for mean in most * np.concatenate([np.geomspace(1e-4, 1, 12), np.linspace(0.3, 1, 8)]):
        high, low = (
            stats.poisson.isf(stats.norm.sf(luck), mean),
            stats.poisson.ppf(stats.norm.cdf(luck), mean),
        )
        counts = np.where(luck > 0, high, low)
        excess = np.abs(counts - mean) - math.sqrt(most) * np.abs(luck)
        assert excess.max() <= gap + 1e-9, mean
    assert gap <= noise.POISSON_GAP + 1e-9


def test_ranges_hold_where_counts_are_few():
    """A full well of 5 electrons: the brightest of 10^6 counts of mean 1 to 4 lie below the top."""
    for mean in (0.01, 1.0, 4.0):
        look = View(Scene(), Camera(full_well=5.0))
        facts = shot_noise.after(Facts(0.0, mean / 5, ()), look)
        assert stats.poisson.sf(math.floor(facts.top * 5), mean) < 7e-6
    assert full_well.skipped(facts, look).total > 0


def test_noise_of_one_luck_adds_and_of_two_goes_by_squares():
    one, other = Error(1.0, 3.0), Error(2.0, 4.0)
    assert (one.along(other).sure, one.along(other).sigma) == (3.0, 7.0)
    assert (one.plus(other).sure, one.plus(other).sigma) == (3.0, 5.0)


def test_white_balance_multiplies_the_noise_that_is_missing():
    """Read noise and a gain of 2, both left out: twice the noise is missing."""
    scene = Scene(8, 8, background=(0.25, 0.25, 0.25))
    prepared = Prepared(scene, Camera(full_well=1e4, shot_noise=False, read_noise=100.0, white_balance=(2.0, 2.0, 2.0)))  # fmt: skip
    present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
    chain = Chain(present, prepared.view, measured(prepared.stack, prepared.view))
    names = [effect.name for effect in present]
    both = {names.index("read noise"): SKIP, names.index("white balance"): SKIP}
    error = chain.error(both)
    assert error.sigma == pytest.approx(2 * 100 / 1e4)
    assert error.sure == pytest.approx(0.25, abs=1e-5)


def test_the_mean_of_a_column_is_said_for_all_columns():
    source = np.random.default_rng(5)
    for rows in (1, 2, 10, 500):
        sizes = np.abs(source.standard_normal((rows, 200_000 // rows))).mean(axis=0)
        assert sizes.max() < mean_size(1.0, rows)


@pytest.mark.parametrize(
    ("deviations", "share"), [(DEVIATIONS, 3.4e-5), (REACH, 7e-6), (CERTAIN, 6e-7)]
)
def test_shares_of_the_normal_law(deviations, share):
    assert 2 * stats.norm.sf(deviations) < share


def test_clipped_noise_beside_other_noise_stays_within_the_share():
    """max(G, 0) + H beyond 4.15 deviations, by integration over G: 1.16 of the normal share."""
    for ratio in (0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0):
        limit = DEVIATIONS * math.hypot(ratio, 1.0)
        g = np.linspace(0, 8 * ratio, 4001)
        inside = np.trapezoid(stats.norm.pdf(g / ratio) / ratio * stats.norm.sf(limit - g), g)
        assert inside + stats.norm.sf(limit) / 2 < 1.17 * stats.norm.sf(DEVIATIONS)
    assert 1.17 * 2 * stats.norm.sf(DEVIATIONS) + ODD + 3 * 2 * stats.norm.sf(REACH) < EXCEEDED


def test_errors_are_never_negative_nor_unknown():
    assert Error(-1.0, -2.0) == NO_ERROR
    assert Error(math.nan, 0.1).sure == math.inf
    assert Error(math.inf).times(0.0).sure == math.inf


@pytest.mark.parametrize("width", [4000, 20_000])
@pytest.mark.parametrize(
    ("effect", "settings"),
    [
        (lateral_colour, {"lateral_colour": 1e-4}),
        (distortion, {"k1": -3e-8}),
        (rolling_shutter, {"velocity": (1e-4, 0.0), "row_time": 0.3}),
    ],
)
def test_positions_of_wide_pictures_are_rounded(width, effect, settings):
    """Shifts of fractions of a thousandth of a pixel, across steps from black to white."""
    image = np.zeros((4, width, 3), np.float32)
    image[:, ::2] = 1
    camera = Camera(0.05, 0.05 / width, **settings)
    prepared = Prepared(Scene(width, 4, image=image), camera)
    whole = run(prepared, everything(prepared))
    bound = effect.skipped(measured(prepared.stack, prepared.view), prepared.view).total
    assert np.abs(whole.values - image).max() <= bound + 5e-7


def test_a_budget_is_finite():
    with pytest.raises(SceneError, match="budget"):
        plan(Scene(), Camera(), budget=math.inf)


def test_signals_without_end_are_refused():
    camera = Camera(exposure=40.0, white_balance=(1e12, 1e12, 1e12))
    with pytest.raises(SceneError, match=r"more than 1e\+30"):
        plan(Scene(background=(1e6, 1e6, 1e6)), camera)


def made(values, bound, *, random):
    steps = (Step("shot noise" if random else "exposure", "", "", 0, 0),)
    skipped = Plan(steps, (), (), bound, 0, 0)
    if random:
        skipped = Plan((Step("shot noise", "gaussian", "", 0, 0),), (), (), bound, 0, 0)
    return Photo(np.float32(values) / 255, skipped, {}, 0.0)


def test_a_broken_promise_is_noticed():
    zero = np.zeros(10_000)
    few, many = zero.copy(), zero.copy()
    few[:3], many[:15] = 9.0, 9.0
    whole = made(zero, 0.0, random=False)
    assert not is_broken(made(zero, 1.0, random=False), whole)
    assert is_broken(made(few, 1.0, random=False), whole)
    assert not is_broken(made(few, 1.0, random=True), whole)
    assert is_broken(made(many, 1.0, random=True), whole)
    assert is_broken(made(many * np.nan, 1.0, random=True), whole)


def test_what_a_full_well_holds_limits_what_comes_after():
    """Shot noise ends at the full well; only the read-out adds to it."""
    scene = Scene(8, 8, background=(0.98, 0.98, 0.98))
    prepared = Prepared(scene, Camera(full_well=1000.0, read_noise=2.0, bit_depth=8))
    present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
    facts = Chain(present, prepared.view, measured(prepared.stack, prepared.view)).before[-1]
    assert facts.high + facts.reach > 1.1
    assert facts.top == pytest.approx(1 + REACH * 2 / 1000)


def test_rounding_may_carry_white_over_the_full_well():
    """A mean of ones over 20 px ends a little above 1 in single precision; the well cuts that."""
    image = np.ones((40, 80, 3), np.float32)
    image[:10] = np.random.default_rng(1).random((10, 80, 3))
    camera = Camera(velocity=(2000.0, 0.0), shutter=0.01, full_well=1e4, shot_noise=False)
    prepared = Prepared(Scene(80, 40, image=image), camera)
    names = [effect.name for effect in EFFECTS if effect.present(prepared.given)]
    assert names == ["motion blur", "full well"]
    chain = Chain(
        tuple(effect for effect in EFFECTS if effect.name in names),
        prepared.view,
        measured(prepared.stack, prepared.view),
    )
    bound = chain.dn({1: SKIP})
    steps = (Step("motion blur", "", "", 0, 0),)
    above = run(prepared, Plan(steps, (), (), bound, 0, 0))
    assert above.values.max() > 1
    assert apart(above, run(prepared, everything(prepared))).max() <= bound < 1e-3


def test_white_as_it_was_drawn_needs_no_full_well():
    prepared = Prepared(
        Scene(8, 8, background=(1.0, 1.0, 1.0)), Camera(full_well=1e4, shot_noise=False)
    )
    assert plan(prepared).predicted_error_dn == 0
    assert [item.effect for item in plan(prepared).skipped] == ["full well"]


def test_a_pedestal_above_the_converter_leaves_a_range():
    """A pedestal of 40 electrons on a well of 3: all is white, and a range of one value is left."""
    camera = Camera(
        full_well=3.0, bit_depth=14, bias=40.0, dark_frames=27, normalise=(0.1, 0.9, 0.0, 1.0),
        white_balance=(0.4, 0.6, 2.7), shot_noise=False,
    )  # fmt: skip
    prepared = Prepared(Scene(8, 8, background=(0.9, 0.9, 0.9)), camera)
    chosen, whole = plan(prepared, budget=1.0), run(prepared, everything(prepared))
    assert apart(run(prepared, chosen), whole).max() <= chosen.predicted_error_dn + 1e-4
    facts = Facts(5.0, 6.0, (), noise=0.1, limits=(0.0, 1.0))
    assert (facts.bottom, facts.top) == (1.0, 1.0)


def test_luck_ends_before_its_reach():
    assert np.abs(noise._normals(np.dtype(np.float64))).max() < REACH


@pytest.mark.parametrize("mosaic", ["", "RGGB"])
def test_what_a_full_well_holds_back_shows_in_the_light_alone(mosaic):
    """Black and white to three times the well: read noise takes white down, gamma is flat there."""
    image = np.zeros((64, 96, 3), np.float32)
    image[:, 32:] = np.linspace(0.95, 3.0, 64, dtype=np.float32)[:, None]
    camera = Camera(
        full_well=5000.0, shot_noise=False, read_noise=10.0, bit_depth=10, mosaic=mosaic,
        white_balance=(1.5, 1.0, 0.8), gamma="srgb",
    )  # fmt: skip
    prepared = Prepared(Scene(96, 64, image=image), camera)
    present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
    chain = Chain(present, prepared.view, measured(prepared.stack, prepared.view))
    bound = chain.dn({0: SKIP})
    steps = tuple(Step(effect.name, "", "", 0, 0) for effect in present[1:])
    change = apart(run(prepared, Plan(steps, (), (), bound, 0, 0)), run(prepared, everything(prepared)))  # fmt: skip
    codes = math.ceil(REACH * 10 / 5000 * 1023)
    steepest = 1.055 / 2.4 * (0.8 * 0.98) ** (1 / 2.4 - 1) * 1.5 / 1023 * 255
    assert present[0].name == "full well"
    assert 0 < change.max() <= bound
    if mosaic:
        assert bound < 5 * codes * steepest
    else:
        assert bound < 1.02 * codes * steepest
