"""No value of a picture changes by more than said when effects are left out."""

import math

import noisy_at_random
import numpy as np
import pytest
import scenes_at_random
from scipy import stats
from sweep import draws, together

from quizgen.camera import Camera, PreparedScene, Scene, SceneError, plan_budget, run_plan
from quizgen.camera.effects import EFFECTS, gamma, shot_noise
from quizgen.camera.pixels.noise import FARTHEST, farthest_count
from quizgen.camera.setup.view import Signal, View
from quizgen.camera.simulation import is_within, measure_difference

SCENES = [pytest.param(0, 20), pytest.param(20, draws(150, full=5000), marks=pytest.mark.slow)]


def draw_case(seed):
    """Half of the cases are small scenes of every kind, half are sensors where counts are few."""
    source = np.random.default_rng([seed, 91])
    if seed % 2:
        return source, PreparedScene(noisy_at_random.scene(source), noisy_at_random.camera(source))
    scene = scenes_at_random.scene(source)
    return source, PreparedScene(scene, scenes_at_random.camera(source, noise=seed % 4 == 0))


def choose_omissions(source, prepared):
    """Each effect alone, two mixtures, and what two budgets leave out."""
    units = {}
    for effect in prepared.present:
        units.setdefault(effect.pair or effect.name, []).append(effect.name)
    units = [unit for unit in units.values() if unit != ["projection"]]
    yield from units
    for _ in range(2):
        yield [name for unit in units if source.random() < 0.5 for name in unit]
    for budget in 10 ** source.uniform(-1, 2, 2):
        yield [choice.effect for choice in plan_budget(prepared, float(budget)).left_out]


@pytest.mark.parametrize(("first", "last"), SCENES)
def test_no_value_differs_by_more(first, last):
    for seed in range(first, last):
        source, prepared = draw_case(seed)
        try:
            whole = run_plan(prepared)
        except SceneError:
            continue
        names = [effect.name for effect in prepared.present]
        for out in choose_omissions(source, prepared):
            bound = prepared.bound_omission(out)
            photo = run_plan(prepared, [name for name in names if name not in out])
            assert is_within(bound, photo, whole), (seed, out, measure_difference(photo, whole))


@pytest.mark.parametrize(("first", "last"), SCENES)
def test_every_value_lies_where_its_signal_says(first, last):
    for seed in range(first, min(last, 400)):
        _, prepared = draw_case(seed)
        names = [effect.name for effect in prepared.present]
        for place, signal in enumerate(prepared.signals[1:], 1):
            values = run_plan(prepared, names[:place]).values
            assert signal.low <= values.min(), (seed, names[place - 1])
            assert values.max() <= signal.high, (seed, names[place - 1])


@together("mean", [0.0, 1e-3, 0.1, 1.0, 3.0, 12.0, 16.3, 100.0, 1e4])
@together("more", [1e-6, 1e-4, 0.03, 1.0, 7.0, 1e3])
def test_another_signal_has_other_counts_by_no_more_than_said(mean, more):
    """Counts of the same luck, against the exact law's quantiles."""
    well = 1e6
    signal = Signal(mean / well, (mean + more) / well)
    bound = shot_noise.carry_error(more / well, signal, View(Scene(), Camera(full_well=well)))
    luck = np.linspace(-FARTHEST, FARTHEST, 401)
    counts = [quantiles(max(one, 1e-12), luck) for one in (mean, mean + more)]
    assert (counts[1] - counts[0]).max() <= bound * well + 1e-9


def quantiles(mean, luck):
    high, low = (
        stats.poisson.isf(stats.norm.sf(luck), mean),
        stats.poisson.ppf(stats.norm.cdf(luck), mean),
    )
    return np.where(luck > 0, high, low)


@together("most", [1e-9, 1e-3, 0.3, 2.5, 15.9, 16.2, 400.0, 1e6])
def test_no_count_lies_farther_from_its_mean(most):
    luck = np.linspace(-FARTHEST, FARTHEST, 401)
    for mean in most * np.geomspace(1e-3, 1, 8):
        assert np.abs(quantiles(mean, luck) - mean).max() <= farthest_count(most)


@together("tone", ["srgb", 2.2, 1.5])
@together(("low", "high"), [(0.0, 1.0), (0.2, 0.3), (-0.4, 0.1), (0.9, 1.7)])
def test_a_tone_curve_left_out_against_every_value(tone, low, high):
    """The published curves, tried at 100 001 values."""
    x = np.linspace(low, high, 100_001)
    light = x.clip(0, 1)
    curve = light ** (1 / tone) if tone != "srgb" else np.where(
        light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055
    )  # fmt: skip
    bound = gamma.omission_bound(Signal(low, high), View(Scene(), Camera(gamma=tone)))
    assert np.abs(curve - x).max() <= bound


def test_a_gain_multiplies_what_is_missing():
    """Offsets of 100 electrons at a full well of 10 000, left out before two stops of gain."""
    scene = Scene(8, 8, background=(0.25, 0.25, 0.25))
    prepared = PreparedScene(scene, Camera(full_well=1e4, shot_noise=False, bias=100.0, iso=400.0))
    assert prepared.bound_omission(["fixed pattern"]) == pytest.approx(4 * 0.01 * 255, rel=1e-3)


def test_what_the_full_well_never_meets_changes_nothing():
    camera = Camera(full_well=1e4, shot_noise=False)
    dim = PreparedScene(Scene(8, 8, background=(0.9, 0.9, 0.9)), camera)
    bright = PreparedScene(Scene(8, 8, background=(1.5, 1.5, 1.5)), camera)
    assert dim.bound_omission(["full well"]) == 0.0
    assert bright.bound_omission(["full well"]) == pytest.approx(0.5 * 255, rel=1e-4)


def test_a_difference_becomes_a_whole_code():
    """A pedestal of a thousandth of a code, left out before a converter of 4 bits: 255/15."""
    camera = Camera(full_well=1e4, shot_noise=False, bias=1e4 / 15000, bit_depth=4)
    prepared = PreparedScene(Scene(8, 8, background=(0.5, 0.5, 0.5)), camera)
    assert prepared.bound_omission(["fixed pattern"]) == pytest.approx(17, rel=1e-3)


def test_signals_without_end_are_refused():
    camera = Camera(exposure=40.0, white_balance=(1e12, 1e12, 1e12))
    with pytest.raises(SceneError, match=r"more than 1e\+30"):
        plan_budget(PreparedScene(Scene(background=(1e6, 1e6, 1e6)), camera))


def test_a_broken_bound_is_noticed():
    prepared = PreparedScene(Scene(8, 8, background=(0.5, 0.5, 0.5)), Camera(exposure=-1.0))
    whole, without = run_plan(prepared), run_plan(prepared, [])
    assert measure_difference(without, whole) == pytest.approx(0.25 * 255)
    assert not is_within(60.0, without, whole)
    assert is_within(64.0, without, whole)


def test_every_effect_but_the_projection_has_a_bound():
    signal, lens = (
        Signal(0.0, 1.0),
        Camera(0.05, 5e-6, 2.0, 3.0, full_well=1e4, mosaic="RGGB", dark_frames=4, gamma="srgb"),
    )
    view = View(
        Scene(32, 24), lens.replace(k1=-0.01, shutter=0.01, velocity=(9.0, 0.0), light=3000.0)
    )
    for effect in EFFECTS[1:]:
        assert 0.0 <= effect.omission_bound(signal, view) < math.inf, effect.name
