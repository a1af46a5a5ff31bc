"""Bright tiles do without more, within the promise, and dark ones do not."""

import json

import noisy_at_random as at_random
import numpy as np
import pytest
from click.testing import CliRunner
from msgspec.structs import replace
from scipy import ndimage, stats
from sweep import draws

from quizgen.camera import Camera, Scene, blocks, levels
from quizgen.camera.blocks import in_turn, tiles, times
from quizgen.camera.decision import NO_LEVELS, Level, Levels
from quizgen.camera.facts import EXCEEDED
from quizgen.camera.plan import Prepared, decided, everything, plan
from quizgen.camera.simulate import is_broken, run
from quizgen.cli.simulate import simulate

CHANCE = 1e-9
NUMBERS = [
    pytest.param(0, 300),
    pytest.param(300, draws(2500), marks=pytest.mark.slow),
]
RULED = Levels("shot noise", 0, (Level(0.25, {"read noise": "skip"}, 0.1),))


@pytest.fixture
def many_tiles(monkeypatch):
    """Small tiles, and plans by level of pictures of any size."""
    monkeypatch.setattr(blocks, "SIDES", (4, 8))
    monkeypatch.setattr(levels, "LEAST_MS", 0.0)


def ramp(width=64, height=12, **settings):
    """From black at the left to white at the right."""
    light = np.linspace(0, 1, width, dtype=np.float32)
    image = np.repeat(np.tile(light, (height, 1))[..., None], 3, axis=2)
    camera = Camera(full_well=50000.0, gamma="srgb", **settings)
    return Prepared(Scene(width, height, image=image, seed=3), camera)


def apart(one, other):
    return np.abs(one.values.astype(np.float64) - other.values) * 255


@pytest.mark.usefixtures("many_tiles")
@pytest.mark.parametrize(("first", "last"), NUMBERS)
def test_every_tile_keeps_the_promise_scene_by_scene(first, last):
    by_level = mosaics = 0
    for seed in range(first, last):
        source = np.random.default_rng([seed, 99])
        camera = at_random.camera(source).but(gamma="srgb", smear=0.0, blooming=False, binning=1)
        prepared = Prepared(at_random.scene(source), camera)
        whole = run(prepared, everything(prepared))
        for budget in 10 ** source.uniform(-1, 2, 4):
            what = plan(prepared, budget=float(budget))
            if not what.levels.each:
                continue
            by_level, mosaics = by_level + 1, mosaics + bool(what.levels.around)
            assert what.predicted_error_dn <= budget
            photo = run(prepared, what)
            beyond = int((apart(photo, whole) > what.predicted_error_dn + 1e-4).sum())
            chance = stats.binom.sf(beyond - 1, whole.values.size, EXCEEDED) if beyond else 1.0
            assert chance > CHANCE, (seed, budget, what.levels, beyond)
            assert not is_broken(photo, whole)
    assert by_level > (last - first) // 4
    assert mosaics > (last - first) // 50


@pytest.mark.usefixtures("many_tiles")
def test_read_noise_runs_in_the_dark_and_not_in_the_light():
    """Gamma rises 12.92 times as fast as the light in black and 0.44 times as fast in white."""
    prepared = ramp(read_noise=8.0)
    what = decided(prepared, budget=1.0)
    assert [way for level in what.levels.each for way in level.ways.items()] == [
        ("read noise", "skip")
    ]
    photo, noisy = run(prepared, what), run(prepared, replace(what, levels=NO_LEVELS))
    same = (photo.values == noisy.values).all(axis=(0, 2)).reshape(-1, 8).all(axis=1)
    assert same[0]
    assert not same[-1]
    darkest = what.levels.each[0].above
    columns = np.linspace(0, 1, 64, dtype=np.float32)[::8] >= darkest  # of each tile the first
    assert np.array_equal(same, ~columns)
    assert photo.shares == pytest.approx((1 - columns.mean(), columns.mean()))
    assert photo.share("read noise") == pytest.approx(1 - columns.mean())
    assert photo.share("shot noise") == 1.0


def test_small_pictures_are_planned_as_a_whole():
    assert decided(ramp(read_noise=8.0), budget=1.0).levels == NO_LEVELS


@pytest.mark.usefixtures("many_tiles")
@pytest.mark.parametrize(
    "settings",
    [{"blooming": True}, {"smear": 0.01}, {"binning": 2}],
)
def test_what_looks_far_around_needs_one_plan_for_all(settings):
    what = decided(ramp(read_noise=8.0, **settings), budget=1.0)
    assert not what.levels.each


@pytest.mark.usefixtures("many_tiles")
def test_what_is_asked_about_runs_in_every_tile():
    what = decided(ramp(read_noise=8.0), ("read noise", "shot noise"), budget=1.0)
    assert not any({"read noise", "shot noise"} & set(level.ways) for level in what.levels.each)


@pytest.mark.usefixtures("many_tiles")
@pytest.mark.parametrize("around", [0, 1])
def test_a_dark_place_beside_a_tile_counts_where_neighbours_are_looked_at(around):
    picture = np.ones((24, 48, 3), np.float32)
    picture[9, 17] = 0.1
    near = ndimage.minimum_filter(picture.min(axis=2), 4 * around + 1)
    dark = near.reshape(6, 4, 6, 8).min(axis=(1, 3)) < 0.25
    places = levels.by_level(picture, Levels("", around, RULED.each))
    numbers = [[tile.number for tile in among] for among in places]
    assert numbers[0] == np.flatnonzero(dark).tolist()
    assert numbers[1] == np.flatnonzero(~dark).tolist()


@pytest.mark.usefixtures("many_tiles")
def test_a_picture_is_the_same_in_whatever_order_its_tiles_are_made():
    picture = np.random.default_rng(1).random((13, 21, 3), np.float32)
    result = np.zeros_like(picture)
    for tile in reversed(list(tiles(picture.shape))):
        in_turn(picture, [times(2.0)], into=result, among=[tile])
    assert np.array_equal(result, picture * np.float32(2))
    assert sum(tile.pixels for tile in tiles(picture.shape)) == 13 * 21


def test_the_report_says_where_an_effect_ran(tmp_path):
    """A dark house before a bright sky, 3 megapixels: read noise shows in the house alone."""
    large = tmp_path / "large.toml"
    large.write_text(
        "[scene]\nwidth = 2048\nheight = 1536\nbackground = [0.5, 0.6, 0.7]\n"
        '[camera]\nfull_well = "20000 e-"\nread_noise = "4 e-"\ngamma = "srgb"\n'
        '[[thing]]\nshape = "box"\nwidth = "512 px"\nheight = "512 px"\n'
        "colour = [0.01, 0.01, 0.01]\n",
        "utf-8",
    )
    found = CliRunner().invoke(simulate, [str(large), "--json", "--all"], catch_exceptions=False)
    report = json.loads(found.output)
    assert report["promise_kept"]
    without = [level for level in report["levels"] if level["ways"].get("read noise") == "skip"]
    assert max(level["bound_dn"] for level in without) <= report["predicted_error_dn"] <= 0.5
    shares = {step["effect"]: step["share"] for step in report["steps"]}
    assert shares.pop("read noise") == pytest.approx(1 - sum(level["share"] for level in without))
    assert set(shares.values()) == {1.0}
    printed = CliRunner().invoke(simulate, [str(large)], catch_exceptions=False).output
    assert "read noise  ran in 8%" in printed  # 512^2 of 2048 x 1536 pixels
    told = [line for line in printed.splitlines() if line.startswith("tiles with")]
    assert "no read noise" in told[-1]
