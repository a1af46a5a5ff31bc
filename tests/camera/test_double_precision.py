"""The same picture in float32 and in float64: the same luck, the same effects, other rounding."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scenes_at_random as at_random
from click.testing import CliRunner
from sweep import draws, together

from quizgen.camera import Camera, PreparedScene, Scene, SceneError
from quizgen.camera.effects import EFFECTS
from quizgen.camera.pixels.filters import numpy_only
from quizgen.camera.pixels.noise import EffectRandom
from quizgen.camera.pixels.tone_curve import encode_value
from quizgen.camera.scene_file import load_scene
from quizgen.camera.simulation import run_plan
from quizgen.cli.simulate import simulate
from quizgen.figures.svg import encode_png
from quizgen.numerics.gamma import srgb_decode

SCENE = Path(__file__).parents[2] / "quizgen/camera/scenes/texture.toml"
SEEDS = [range(20), pytest.param(range(20, draws(100, full=400)), marks=pytest.mark.slow)]
JUMPS = {"quantisation", "shot noise", "impulse noise", "dark current", "blooming"}
"""Where the last bit may make a whole code or electron, so that pictures are not compared."""


def pictures(scene, camera, what=None):
    """With OpenCV and with NumPy alone."""
    made = []
    for alone in (False, True):
        if alone:
            with numpy_only():
                made.append(photo(scene, camera, what))
        else:
            made.append(photo(scene, camera, what))
    return made


def photo(scene, camera, names=None):
    return run_plan(PreparedScene(scene, camera), names).values


def in_both(seed, *, noise):
    source = np.random.default_rng([seed, 15])
    scene = at_random.scene(source)
    camera = at_random.camera(source, noise=noise)
    return scene, replace(scene, precision="float64"), camera


@pytest.mark.parametrize("seeds", SEEDS)
def test_nothing_on_the_way_is_rounded_to_float32(seeds):
    """Two independent ways to convolve and resample agree to fifteen digits or so."""
    compared = 0
    for seed in seeds:
        _, scene, camera = in_both(seed, noise=seed % 4 == 0)
        names = {
            effect.name
            for effect in EFFECTS
            if effect.is_present(PreparedScene(scene, camera).given)
        }
        one, other = pictures(scene, camera)
        assert one.dtype == other.dtype == np.float64, seed
        if not names & JUMPS:
            compared += 1
            size = max(1.0, float(np.abs(other).max()))
            assert np.abs(one - other).max() < 1e-9 * size, (seed, names)
    assert compared > len(seeds) / 4


@pytest.mark.parametrize("seeds", SEEDS)
def test_pictures_see_the_same_luck(seeds):
    """Noise is a hundred times what rounding is: with other luck no picture would agree."""
    for seed in seeds:
        single, double, camera = in_both(seed, noise=True)
        one, other = photo(single, camera), photo(double, camera)
        assert one.dtype == np.float32
        size = max(1.0, float(np.abs(other).max()))
        assert np.median(np.abs(one - other)) < 2e-5 * size, seed


def test_normal_values_are_the_same_in_both_precisions():
    luck = EffectRandom(12345)
    single, double = luck.draw_normal(7, 5000), luck.draw_normal(7, 5000, np.float64)
    assert double.dtype == np.float64
    assert np.array_equal(double.astype(np.float32), single)
    assert not np.array_equal(double, single)


@pytest.mark.parametrize("gamma", ["srgb", "linear", 1.8, 2.2])
def test_tone_curves_in_double_precision(gamma):
    linear = np.linspace(-0.2, 1.3, 3 * 40 * 50).reshape(40, 50, 3)
    scene = Scene(50, 40, image=linear, precision="float64")
    seen = photo(scene, Camera(gamma=gamma)) if gamma != "linear" else linear.clip(0, 1)
    expected = [encode_value(float(value), gamma) for value in linear.reshape(-1)]
    assert seen.reshape(-1) == pytest.approx(expected, abs=5e-16)


def test_a_disc_far_out_of_focus_keeps_its_light():
    """Weights sum to one: in float64 the mean of an even picture moves by its last bits only."""
    even = np.full((60, 80, 3), 0.1)
    even[20:40, 30:50] = 0.7
    camera = Camera(0.05, 5e-6, 2.0, 1.0, natural_vignetting=False)
    for values in pictures(Scene(80, 60, image=even, depth=1.0, precision="float64"), camera):
        assert np.array_equal(values, even)
    for values in pictures(Scene(80, 60, image=even, depth=1.01, precision="float64"), camera):
        assert abs(values[25:35, 35:45] - 0.7).max() < 1e-14


def test_the_scene_file_and_the_command_say_the_precision(tmp_path):
    text = '[scene]\nwidth = 40\nheight = 30\nprecision = "{}"\nbackground = [0.1, 0.2, 0.3]\n'
    file = tmp_path / "scene.toml"
    file.write_text(text.format("float64") + '[camera]\ngamma = "srgb"\n', "utf-8")
    assert load_scene(file)[0].precision == "float64"
    assert load_scene(file, "float32")[0].precision == "float32"
    file.write_text(text.format("float16"), "utf-8")
    with pytest.raises(SceneError, match=r"scene.toml:4: precision: expected one of float32"):
        load_scene(file)


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_the_command_says_what_float32_is_off_by(precision):
    told = CliRunner().invoke(simulate, ["texture", "--json", "--precision", precision])
    report = json.loads(told.stdout)
    assert report["precision"] == precision
    if precision == "float32":
        assert "float32_difference_dn" not in report
    else:
        prepared = {
            kind: PreparedScene(*load_scene(SCENE, kind)) for kind in ("float32", "float64")
        }
        names = report["ran"]
        one, other = (run_plan(prepared[kind], names).values for kind in prepared)
        off = 255 * np.abs(one - other).max()
        assert 0 < report["float32_difference_dn"] == pytest.approx(off, rel=1e-5)


def test_both_precisions_read_a_photograph_to_its_last_digit(tmp_path):
    codes = np.arange(6 * 4 * 3, dtype=np.uint8).reshape(6, 4, 3)
    (tmp_path / "photo.png").write_bytes(encode_png(codes))
    file = tmp_path / "scene.toml"
    file.write_text('[scene]\nimage = "photo.png"\n', "utf-8")
    right = np.asarray(srgb_decode(codes / 255))
    assert np.array_equal(load_scene(file, "float64")[0].image, right)
    assert np.array_equal(load_scene(file)[0].image, right.astype(np.float32))


WIDTH, HEIGHT, FOCAL = 61, 41, 100.0
ACROSS, DOWN = np.meshgrid(np.arange(WIDTH) - 30.0, np.arange(HEIGHT) - 20.0)
RADIUS = np.hypot(ACROSS, DOWN)
RAMP = np.stack([0.5 + ACROSS / 70, 0.5 + DOWN / 70, 0.5 + (ACROSS + DOWN) / 120], axis=2)
"""Bilinear reading of a slope gives the place that was read, to the last digit."""


def slid(shift):
    """Two discs that slide apart by a share of their diameter."""
    return 2 / np.pi * (np.arccos(shift) - shift * np.sqrt(1 - shift**2))


def read_at(across, down):
    return np.stack([0.5 + across / 70, 0.5 + down / 70, 0.5 + (across + down) / 120], axis=2)


def undistorted():
    """Newton's method on r (1 - 0.2 r^2) in long double."""
    far = RADIUS.astype(np.longdouble) / FOCAL
    radius = far.copy()
    for _ in range(50):
        radius -= (radius * (1 - 0.2 * radius**2) - far) / (1 - 0.6 * radius**2)
    scale = (radius / np.where(far > 0, far, 1)).astype(float)
    scale[20, 30] = 1.0
    return read_at(scale * ACROSS, scale * DOWN)


def magnified(share):
    red, green, blue = (read_at(ACROSS / k, DOWN / k) for k in (1 + share, 1, 1 - share))
    return np.stack([red[..., 0], green[..., 1], blue[..., 2]], axis=2)


EXPECTED = {
    "vignetting": (
        {"natural_vignetting": True},
        lambda: RAMP / (1 + (RADIUS[..., None] / FOCAL) ** 2) ** 2,
    ),
    "two discs": (
        {"mechanical_vignetting": 0.6},
        lambda: RAMP * slid(0.6 * RADIUS / RADIUS.max())[..., None],
    ),
    "exposure": ({"exposure": 0.3}, lambda: RAMP * 2**0.3),
    "white balance": ({"white_balance": (1.1, 0.9, 1.3)}, lambda: RAMP * [1.1, 0.9, 1.3]),
    "flare": ({"flare": 0.13}, lambda: 0.87 * RAMP + 0.13 * RAMP.mean(axis=(0, 1))),
    "normalisation": (
        {"normalise": (0.13, 0.87, 0.1, 0.7)},
        lambda: 0.1 + 0.6 * np.clip((RAMP - 0.13) / 0.74, 0, 1),
    ),
    "distortion": ({"k1": -0.2}, undistorted),
    "lateral colour": ({"lateral_colour": 1.7}, lambda: magnified(1.7 / RADIUS.max())),
    "fixed pattern": ({"full_well": 1e3, "shot_noise": False, "bias": 37.7}, lambda: RAMP + 0.0377),
}


@together("name", EXPECTED)
def test_an_effect_in_float64_is_its_formula(name):
    settings, expected = EXPECTED[name]
    camera = Camera(0.05, 0.05 / FOCAL, **settings)
    scene = Scene(WIDTH, HEIGHT, image=RAMP, precision="float64")
    inner = slice(3, -3), slice(4, -4)  # beyond the edge the edge is read
    for values in pictures(scene, camera):
        assert values[inner] == pytest.approx(expected()[inner], rel=0, abs=3e-13)
