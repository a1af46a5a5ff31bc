"""The reported bound holds at every pixel of hundreds of random scenes."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import scenes_at_random as at_random

from quizgen.camera import Camera, Scene, SceneError, View, look
from quizgen.camera.chain import SKIP, Chain
from quizgen.camera.decision import Plan, Step
from quizgen.camera.effects import EFFECTS, gamma, questions
from quizgen.camera.effects.binning import BINNING
from quizgen.camera.effects.distortion import K1, K2
from quizgen.camera.facts import DEVIATIONS, EXCEEDED, Error, Facts
from quizgen.camera.look import coarse, glimpsed, measured
from quizgen.camera.plan import GLIMPSES, Prepared, _units, everything, plan
from quizgen.camera.simulate import difference_dn, run

ROUNDING = 1e-5
SCENES = 600
BATCHES = [pytest.param(n, marks=[pytest.mark.slow] * (n > 1)) for n in range(6)]


def photographs(first, last, *, noise):
    """Random scenes that the camera can take at all (no fold inside the picture)."""
    for seed in range(first, last):
        source = np.random.default_rng([seed, noise])
        prepared = Prepared(at_random.scene(source), at_random.camera(source, noise=noise))
        try:
            yield seed, source, prepared, run(prepared, everything(prepared))
        except SceneError:
            assert prepared.given.camera[K1] < 0 or prepared.given.camera[K2] < 0


def apart(one, other):
    return float(np.abs(one.values.astype(np.float64) - other.values).max() * 255)


def batch(number):
    size = SCENES // len(BATCHES)
    return number * size, (number + 1) * size


@pytest.mark.parametrize("number", BATCHES)
def test_planned_and_everything_differ_by_at_most_the_reported_bound(number):
    for seed, _, prepared, whole in photographs(*batch(number), noise=False):
        for budget in (0.5, 2.0, 8.0, 60.0):
            photo = run(prepared, plan(prepared, budget=budget))
            bound = photo.plan.predicted_error_dn
            assert bound <= budget + 1e-9, seed
            assert apart(photo, whole) <= bound + ROUNDING * bool(bound), (seed, budget)
            codes = np.abs(photo.pixels().astype(int) - whole.pixels())
            assert codes.max() <= np.ceil(bound + ROUNDING), (seed, budget)


def _chosen(units, source):
    each = [dict.fromkeys(unit.members, made) for unit in units for made in unit.choices[1:]]
    mixed = []
    for _ in range(2):
        made = [str(source.choice(list(unit.choices))) for unit in units]
        mixed.append({i: way for unit, way in zip(units, made, strict=True) for i in unit.members})
    return each + mixed


@pytest.mark.parametrize("number", BATCHES)
def test_every_single_choice_keeps_its_bound(number):
    """Also choices no budget would allow: each effect skipped alone, each rung, random mixtures."""
    for seed, source, prepared, whole in photographs(*batch(number), noise=False):
        present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
        units = _units(present, frozenset())
        looks = [coarse(prepared.view), measured(prepared.stack, prepared.view)]
        chains = [Chain(present, prepared.view, known) for known in looks]
        for choice in _chosen(units, source):
            made = [(e.name, choice.get(i, "")) for i, e in enumerate(present)]
            steps = tuple(Step(name, way, "", 0, 0) for name, way in made if way != SKIP)
            difference = apart(run(prepared, Plan(steps, (), (), 0, 0, 0)), whole)
            for chain in chains:
                bound = chain.dn(choice)
                assert difference <= bound * (1 + 1e-6) + 1e-9, (seed, made)


def test_bounds_are_not_merely_large():
    """Where theory is exact the bound is met: gain, gamma, quantisation, an edge out of focus."""
    edge = np.zeros((16, 32, 3), np.float32)
    edge[:, 16:] = 1
    ramp = np.repeat(np.linspace(0, 1, 256 * 256, dtype=np.float32).reshape(256, 256, 1), 3, 2)
    cases = [
        (edge, Camera(exposure=-1.0)),
        (edge, Camera(natural_vignetting=True, focal_length=0.05, pixel_pitch=1e-3)),
        (edge, Camera(0.05, 5e-6, 2.8, 2.0001)),
        (ramp, Camera(bit_depth=4)),
        (ramp, Camera(gamma="srgb")),
    ]
    for image, camera in cases:
        scene = Scene(image.shape[1], image.shape[0], image=image, depth=2.0)
        prepared = Prepared(scene, camera)
        present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
        chain = Chain(present, prepared.view, measured(prepared.stack, prepared.view))
        without = tuple(Step(effect.name, "", "", 0, 0) for effect in present[:-1])
        photo = run(prepared, Plan(without, (), (), 0, 0, 0))
        whole = run(prepared, everything(prepared))
        assert apart(photo, whole) > 0.9 * chain.dn({len(present) - 1: SKIP}), camera


def coarsely(kind):
    """Random scenes that the camera can take, and their chains from colours alone."""
    for seed in range(100):
        source = np.random.default_rng([seed, kind])
        prepared = Prepared(at_random.scene(source), at_random.camera(source, noise=True))
        try:
            present, view, seen = prepared.present, prepared.view, prepared.views
            yield seed, source, prepared, Chain(present, view, coarse(view), seen)
        except SceneError:
            continue


def test_steps_tell_nothing_of_effects_that_look_at_no_neighbour():
    """Chains that take their bounds from another one predict what they would on their own."""
    for seed, source, prepared, first in coarsely(5):
        present, facts = first.present, measured(prepared.stack, prepared.view)
        alone = Chain(present, prepared.view, facts, first.views)
        alike = Chain(present, prepared.view, facts, first.views, like=first)
        for choice in _chosen(_units(present, frozenset()), source):
            assert alike.error(choice) == alone.error(choice), (seed, choice)


def test_no_step_is_so_small_that_less_than_the_least_is_lost():
    for seed, source, prepared, first in coarsely(6):
        facts = measured(prepared.stack, prepared.view)
        closer = Chain(first.present, prepared.view, facts, first.views)
        units = _units(first.present, frozenset())
        for choice in _chosen(units, source):
            for unit in units:
                least = first.least(unit.members[-1], choice)
                for made in unit.choices[1:]:
                    lost = closer.dn({**choice, **dict.fromkeys(unit.members, made)})
                    assert least <= lost * (1 + 1e-9), (seed, unit, made)


def test_what_arrives_at_the_converter_takes_no_less_than_the_least():
    for seed, source, _, chain in coarsely(7):
        units = _units(chain.present, frozenset())
        for choice in _chosen(units, source):
            floor = chain.floor(choice)
            for unit in units:
                for made in unit.choices[1:]:
                    if chain.arrives(unit.members[0], made):
                        lost = chain.dn({**choice, **dict.fromkeys(unit.members, made)})
                        assert floor <= lost * (1 + 1e-9), (seed, unit, made)


def test_a_glimpse_never_exceeds_the_facts_nor_a_closer_one():
    for _, _, prepared, _ in photographs(0, 40, noise=False):
        looks = [
            glimpsed(prepared.stack, prepared.view, apart, columns=columns)
            for apart, columns in GLIMPSES
        ]
        looks.append(measured(prepared.stack, prepared.view))
        for less, more in pairwise(looks):
            for every, whole in zip(less.layers, more.layers, strict=True):
                assert max(every.jump[0] - whole.jump[0], every.jump[1] - whole.jump[1]) <= 1e-7
                assert max(every.bend[0] - whole.bend[0], every.bend[1] - whole.bend[1]) <= 1e-7


def test_what_is_asked_about_is_never_skipped():
    for seed in range(120):
        source = np.random.default_rng([seed, 9])
        prepared = Prepared(at_random.scene(source), at_random.camera(source, noise=True))
        kind = str(source.choice(questions()))
        try:
            chosen = plan(prepared, question=kind, budget=1e6)
        except SceneError:
            continue  # the picture folds over
        exact = {step.effect for step in chosen.steps if not step.rung}
        for effect in EFFECTS:
            if kind in effect.decides and effect.present(prepared.given):
                assert effect.name in exact, (seed, kind)


def test_an_ideal_camera_plans_nothing_and_changes_no_bit():
    source = np.random.default_rng(5)
    image = source.normal(0.5, 2, (40, 60, 3)).astype(np.float32)
    prepared = Prepared(Scene(60, 40, image=image), Camera())
    photo = run(prepared, plan(prepared))
    assert photo.plan.steps == photo.plan.skipped == ()
    assert photo.values.tobytes() == image.tobytes()
    assert photo.plan.predicted_ms == photo.plan.predicted_error_dn == 0


def test_plans_are_pure():
    for _, _, prepared, _ in photographs(0, 20, noise=True):
        again = Prepared(prepared.given.scene, prepared.given.camera)
        assert plan(prepared, budget=2) == plan(again, budget=2)


def _share_below(values, limits):
    return np.searchsorted(np.sort(values.reshape(-1)), limits) / values.size


def test_noise_agrees_in_distribution():
    """The two distribution functions stay within the bound sideways and the sampling error."""
    checked = 0
    for seed, source, prepared, _ in photographs(0, 110, noise=True):
        level, size = source.uniform(0, 1, 3).astype(np.float32), 112
        scene = Scene(size, size, image=np.broadcast_to(level, (size, size, 3)).copy(), seed=seed)
        camera = prepared.given.camera
        try:
            chosen = run(Prepared(scene, camera), plan(scene, camera, budget=3.0))
            whole = run(
                Prepared(replace(scene, seed=seed + 10**6), camera), everything(scene, camera)
            )
        except SceneError:
            continue
        changed = chosen.plan.predicted_error_dn
        if not changed:
            continue
        drawn = size / camera[BINNING]  # a block has one value
        shift, slack = changed / 255 + 1e-6, 4.0 / drawn + EXCEEDED
        for channel in range(3):
            one, other = chosen.values[..., channel], whole.values[..., channel]
            limits = np.quantile(other, np.linspace(0.02, 0.98, 49))
            there = _share_below(other, limits)
            assert (_share_below(one, limits - shift) <= there + slack).all(), seed
            assert (_share_below(one, np.nextafter(limits + shift, 9)) >= there - slack).all(), seed
        checked += 1
    assert checked > 30


def test_noisy_photographs_keep_the_bound_but_for_one_value_in_ten_thousand():
    """Both pictures see the same luck; every random choice of the planner, pooled."""
    beyond = counted = 0
    for _, _, prepared, whole in photographs(0, 200, noise=True):
        for budget in (0.5, 4.0, 30.0):
            photo = run(prepared, plan(prepared, budget=budget))
            bound = photo.plan.predicted_error_dn + ROUNDING
            beyond += (np.abs(photo.values - whole.values) * 255 > bound).sum()
            counted += photo.values.size
    assert counted > 500_000
    assert beyond < EXCEEDED * counted


def test_skipped_noise_stays_within_its_share():
    """Values that noise would have carried beyond the bound: at most 1 in 10 000."""
    scene = Scene(400, 300, background=(0.4, 0.5, 0.6), seed=3)
    camera = Camera(full_well=4e6, read_noise=300.0)
    photo = run(Prepared(scene, camera), plan(scene, camera, budget=1.0))
    whole = run(Prepared(scene, camera), everything(scene, camera))
    assert not photo.plan.steps
    beyond = np.abs(photo.values - whole.values) * 255 > photo.plan.predicted_error_dn
    assert 0 < beyond.sum() < EXCEEDED * beyond.size + 5 * (EXCEEDED * beyond.size) ** 0.5
    assert difference_dn(photo, whole) <= photo.plan.predicted_error_dn * 1.05


def test_errors_add_as_stated():
    total = Error(1.0, 3.0).plus(Error(2.0, 4.0))
    assert (total.sure, total.sigma) == (3.0, 5.0)
    assert total.total == pytest.approx(3 + 5 * DEVIATIONS)


@pytest.mark.parametrize("exponent", [1.0001, 1.4, 2.2, 30.0])
@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (0.5, 0.9), (0.01, 0.05), (-0.2, 3.0)])
def test_a_power_is_farthest_from_the_diagonal_where_said(exponent, low, high):
    """Against a fine grid; it can only miss the top by a little."""
    view = View(Scene(), Camera(gamma=exponent))
    grid = np.linspace(max(low, 0.0), min(high, 1.0), 200_001)
    clipped = max(-low, high - 1.0, 0.0)
    apart = float((grid ** (1.0 / exponent) - grid).max())
    assert gamma.skipped(Facts(low, high, ()), view).total == pytest.approx(
        clipped + apart, abs=2e-6
    )


@pytest.mark.parametrize(("gains", "absorbed"), [((1.5, 1.0, 2.0), True), ((0.7, 1.0, 2.0), False)])
def test_what_gamma_clips_anyway_is_not_lost_with_the_converter(gains, absorbed):
    """From -0.3 to 1.4, without the codes of 12 bits: half a code where gamma is steepest, or all."""
    ramp = np.linspace(-0.3, 1.4, 64 * 64 * 3, dtype=np.float32).reshape(64, 64, 3)
    camera = Camera(bit_depth=12, white_balance=gains, gamma="srgb")
    prepared = Prepared(Scene(64, 64, image=ramp), camera)
    present = tuple(effect for effect in EFFECTS if effect.present(prepared.given))
    bound = Chain(present, prepared.view, coarse(prepared.view)).dn({0: SKIP})
    steps = tuple(Step(effect.name, "", "", 0, 0) for effect in present[1:])
    change = apart(run(prepared, Plan(steps, (), (), 0, 0, 0)), run(prepared, everything(prepared)))
    steepest = 12.92 * 0.5 / 4095 * max(gains) * 255
    assert change <= bound
    assert (bound <= 1.01 * steepest) is absorbed
    assert (change <= steepest) is absorbed


def test_nothing_steep_lies_where_a_layer_is_even():
    """Facts of the parts of each layer that are not even are those of the whole layer."""
    for _, _, prepared, _ in photographs(0, 200, noise=False):
        low, high = prepared.view.scene.range
        whole = tuple(
            look._measure(layer, (low + high) / 2, high - low, 1) for layer in prepared.stack
        )
        assert measured(prepared.stack, prepared.view).layers == whole
